/* SPDX-License-Identifier: MIT
 *
 * Cascades of set sub-voxels, and rays through them.
 *
 * Everything lies on one lattice, the cells of the finest cascade: a cell of cascade c is a cube of 2^c
 * lattice cells. A point belongs to the finest cascade that covers it; what coarser ones hold there is not
 * seen. Outside all of them there is nothing.
 */
#ifndef RAYCAST_VOXEL_GRID_H
#define RAYCAST_VOXEL_GRID_H

#include <stddef.h>
#include <stdint.h>

#include "raycast.h"
#include "vec3.h"

/* Empty space is crossed in cubes of 2^VOXEL_BRICK_BITS cells or more. */
enum { VOXEL_BRICK_BITS = 2 };

struct voxel_cascade {
    int32_t low[3], high[3];           /* lattice cells */
    int32_t hole_low[3], hole_high[3]; /* own cells, a box around those that finer cascades may cover */
    int32_t resolution;
    int shift;    /* a cell is 2^shift lattice cells wide */
    double width; /* the same, 2^shift */
    const uint64_t *bits;
    const struct raycast_block *blocks;
    uint8_t
        *empty; /* per brick: the largest aligned empty cube around it has 2^empty cells a side; 0: none */
};

struct voxel_grid {
    struct voxel_cascade cascades[RAYCAST_MAX_CASCADES];
    uint32_t count;
    double corner[3]; /* of the lattice, in the tracer's space, metres */
    double cell_m[3]; /* of the lattice */
};

struct voxel_place {
    uint32_t cascade;
    int32_t cell[3]; /* in the cascade */
};

struct voxel_hit {
    struct voxel_place place;
    int32_t sub[3]; /* sub-voxel in the cell, [0, 4) */
    int axis;       /* that the face looks along: +x -x +y -y +z -z */
    double t_m;
    double left_m; /* where the ray was out of the set sub-voxels it started in; 0: it started in none */
};

/* False, with one line, if the cascades do not lie on one lattice or memory runs out; to be finished either
 * way. */
bool voxel_grid_init(struct voxel_grid *g, const struct raycast_voxels *voxels, const double origin[3],
                     char *error, size_t error_size);

void voxel_grid_finish(struct voxel_grid *g);

/* The finest cascade that covers a lattice cell; false: none does. */
bool voxel_grid_find(const struct voxel_grid *g, const int32_t lattice[3], struct voxel_place *out);
bool voxel_grid_find_point(const struct voxel_grid *g, struct vec3 position, struct voxel_place *out);

/* The first set sub-voxel along a ray of `length_m`. A ray that starts in a set one first leaves those that
 * follow on from it without a gap; left_m is filled in whether anything is hit or not. */
bool voxel_grid_trace(const struct voxel_grid *g, struct vec3 origin, struct vec3 direction, double length_m,
                      struct voxel_hit *out);

/* 64 bits, x + 4 y + 16 z; no sub-voxel where the cell is not the finest that covers its place. */
uint64_t voxel_grid_bits(const struct voxel_grid *g, const struct voxel_place *at);

static inline const struct raycast_block *voxel_grid_block(const struct voxel_grid *g,
                                                           const struct voxel_place *at)
{
    const struct voxel_cascade *c = &g->cascades[at->cascade];
    const size_t side = (size_t)c->resolution / 2;
    return &c->blocks[(size_t)at->cell[0] / 2 +
                      side * ((size_t)at->cell[1] / 2 + side * ((size_t)at->cell[2] / 2))];
}

/* Metres along an axis of a sub-voxel. */
static inline double voxel_grid_sub_m(const struct voxel_grid *g, uint32_t cascade, int axis)
{
    return g->cell_m[axis] * g->cascades[cascade].width / 4.0;
}

/* Low end of a sub-voxel along an axis, in the tracer's space. */
static inline double voxel_grid_sub_low(const struct voxel_grid *g, const struct voxel_place *at, int sub,
                                        int axis)
{
    const struct voxel_cascade *c = &g->cascades[at->cascade];
    return g->corner[axis] + g->cell_m[axis] * (c->low[axis] + (at->cell[axis] + sub / 4.0) * c->width);
}

#endif
