/* SPDX-License-Identifier: MIT
 *
 * Where cascades lie on their lattice, and which parts of them a ray can cross in one step.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "voxel_grid.h"

static bool cascade_check(const struct raycast_voxels *v, uint32_t index, char *error, size_t size)
{
    const struct raycast_cascade *c = &v->cascades[index], *first = &v->cascades[0];
    const struct raycast_cascade *finer = index > 0 ? c - 1 : c;
    const uint32_t n = c->resolution;
    bool ok = c->bits != NULL && c->blocks != NULL && n >= 8 && n <= 1024 && (n & (n - 1)) == 0;
    for (int k = 0; k < 3 && ok; k++) {
        const double blocks = (c->low_m[k] - finer->low_m[k]) / (2.0 * c->cell_m[k]);
        ok = isfinite(c->low_m[k]) && c->cell_m[k] > 0.0 && isfinite(c->cell_m[k]) &&
             fabs(c->cell_m[k] / ldexp(first->cell_m[k], (int)index) - 1.0) < 1e-6 && fabs(blocks) < 1e5 &&
             fabs(blocks - rint(blocks)) < 1e-3;
    }
    if (!ok)
        snprintf(error, size, "reference: cascade %u is not made of blocks of the one before it", index);
    return ok;
}

/* A box around the cells of cascade `index` that finer cascades cover. */
static void hole_find(struct voxel_grid *g, uint32_t index)
{
    struct voxel_cascade *c = &g->cascades[index];
    for (int k = 0; k < 3; k++) {
        int32_t low = INT32_MAX, high = INT32_MIN;
        for (uint32_t i = 0; i < index; i++) {
            low = g->cascades[i].low[k] < low ? g->cascades[i].low[k] : low;
            high = g->cascades[i].high[k] > high ? g->cascades[i].high[k] : high;
        }
        c->hole_low[k] = index > 0 ? (low - c->low[k]) >> c->shift : 0;
        c->hole_high[k] = index > 0 ? ((high - c->low[k] - 1) >> c->shift) + 1 : 0;
    }
}

/* Whether a brick has nothing set and no part in a finer cascade. */
static bool brick_is_empty(const struct voxel_cascade *c, const int32_t brick[3])
{
    const int32_t size = 1 << VOXEL_BRICK_BITS, n = c->resolution;
    bool in_hole = true;
    for (int k = 0; k < 3; k++)
        in_hole = in_hole && brick[k] * size < c->hole_high[k] && (brick[k] + 1) * size > c->hole_low[k];
    uint64_t any = 0;
    for (int32_t i = 0; i < size * size * size; i++) {
        const int32_t x = brick[0] * size + i % size, y = brick[1] * size + i / size % size,
                      z = brick[2] * size + i / (size * size);
        any |= c->bits[(size_t)x + (size_t)n * ((size_t)y + (size_t)n * (size_t)z)];
    }
    return any == 0 && !in_hole;
}

static uint8_t *brick_at(const struct voxel_cascade *c, int32_t x, int32_t y, int32_t z)
{
    const size_t side = (size_t)(c->resolution >> VOXEL_BRICK_BITS);
    return &c->empty[(size_t)x + side * ((size_t)y + side * (size_t)z)];
}

/* Joins eight empty cubes of 2^(bits - 1) cells to one; `at` in bricks. */
static void join(struct voxel_cascade *c, const int32_t at[3], int bits)
{
    const int32_t size = 1 << (bits - VOXEL_BRICK_BITS), half = size / 2;
    for (int i = 0; i < 8; i++)
        if (*brick_at(c, at[0] + half * (i & 1), at[1] + half * (i >> 1 & 1), at[2] + half * (i >> 2)) !=
            bits - 1)
            return;
    for (int32_t i = 0; i < size * size * size; i++)
        *brick_at(c, at[0] + i % size, at[1] + i / size % size, at[2] + i / (size * size)) = (uint8_t)bits;
}

static bool empty_find(struct voxel_cascade *c)
{
    const int32_t side = c->resolution >> VOXEL_BRICK_BITS;
    c->empty = calloc((size_t)side * (size_t)side * (size_t)side, 1);
    if (c->empty == NULL)
        return false;
    for (int32_t z = 0; z < side; z++)
        for (int32_t y = 0; y < side; y++)
            for (int32_t x = 0; x < side; x++)
                if (brick_is_empty(c, (int32_t[]){ x, y, z }))
                    *brick_at(c, x, y, z) = VOXEL_BRICK_BITS;
    for (int bits = VOXEL_BRICK_BITS + 1; 1 << bits <= c->resolution; bits++) {
        const int32_t step = 1 << (bits - VOXEL_BRICK_BITS);
        for (int32_t z = 0; z < side; z += step)
            for (int32_t y = 0; y < side; y += step)
                for (int32_t x = 0; x < side; x += step)
                    join(c, (int32_t[]){ x, y, z }, bits);
    }
    return true;
}

void voxel_grid_finish(struct voxel_grid *g)
{
    for (uint32_t i = 0; i < g->count; i++)
        free(g->cascades[i].empty);
}

bool voxel_grid_init(struct voxel_grid *g, const struct raycast_voxels *voxels, const double origin[3],
                     char *error, size_t error_size)
{
    const struct raycast_cascade *first = &voxels->cascades[0];
    if (voxels->cascade_count < 1 || voxels->cascade_count > RAYCAST_MAX_CASCADES) {
        snprintf(error, error_size, "reference: %u cascades, 1 to %d are possible", voxels->cascade_count,
                 RAYCAST_MAX_CASCADES);
        return false;
    }
    memset(g, 0, sizeof(*g));
    g->count = voxels->cascade_count;
    for (int k = 0; k < 3; k++) {
        g->corner[k] = first->low_m[k] - origin[k];
        g->cell_m[k] = first->cell_m[k];
    }
    for (uint32_t i = 0; i < g->count; i++) {
        const struct raycast_cascade *from = &voxels->cascades[i];
        struct voxel_cascade *c = &g->cascades[i];
        if (!cascade_check(voxels, i, error, error_size))
            return false;
        c->resolution = (int32_t)from->resolution;
        c->shift = (int)i;
        c->width = ldexp(1.0, c->shift);
        c->bits = from->bits;
        c->blocks = from->blocks;
        for (int k = 0; k < 3; k++) {
            c->low[k] = (int32_t)rint((from->low_m[k] - first->low_m[k]) / first->cell_m[k]);
            c->high[k] = c->low[k] + (c->resolution << c->shift);
        }
        hole_find(g, i);
        if (!empty_find(c)) {
            snprintf(error, error_size, "reference: out of memory for the voxels");
            return false;
        }
    }
    return true;
}
