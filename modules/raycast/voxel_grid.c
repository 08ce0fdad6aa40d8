/* SPDX-License-Identifier: MIT */
#include "voxel_grid.h"

enum { SUBVOXELS = 4 };

/* Beyond this many lattice cells a ray is told to miss: its cell would not fit an integer. */
static const double farthest_cell = 1e9;

/* ---- Cells ------------------------------------------------------------------------------------------ */

static bool is_between(const int32_t p[3], const int32_t low[3], const int32_t high[3])
{
    return p[0] >= low[0] && p[0] < high[0] && p[1] >= low[1] && p[1] < high[1] && p[2] >= low[2] &&
           p[2] < high[2];
}

bool voxel_grid_find(const struct voxel_grid *g, const int32_t lattice[3], struct voxel_place *out)
{
    for (uint32_t i = 0; i < g->count; i++) {
        const struct voxel_cascade *c = &g->cascades[i];
        if (!is_between(lattice, c->low, c->high))
            continue;
        out->cascade = i;
        for (int k = 0; k < 3; k++)
            out->cell[k] = (lattice[k] - c->low[k]) >> c->shift;
        return true;
    }
    return false;
}

/* The lattice cell of a point in lattice units; false: too far away to have one. */
static bool lattice_cell(const double p[3], int32_t out[3])
{
    for (int k = 0; k < 3; k++) {
        if (!(fabs(p[k]) < farthest_cell))
            return false;
        out[k] = (int32_t)floor(p[k]);
    }
    return true;
}

static void lattice_point(const struct voxel_grid *g, struct vec3 position, double out[3])
{
    const float p[3] = { position.x, position.y, position.z };
    for (int k = 0; k < 3; k++)
        out[k] = ((double)p[k] - g->corner[k]) / g->cell_m[k];
}

bool voxel_grid_find_point(const struct voxel_grid *g, struct vec3 position, struct voxel_place *out)
{
    double p[3];
    int32_t cell[3];
    lattice_point(g, position, p);
    return lattice_cell(p, cell) && voxel_grid_find(g, cell, out);
}

static uint64_t cell_bits(const struct voxel_cascade *c, const int32_t cell[3])
{
    const size_t n = (size_t)c->resolution;
    return c->bits[(size_t)cell[0] + n * ((size_t)cell[1] + n * (size_t)cell[2])];
}

uint64_t voxel_grid_bits(const struct voxel_grid *g, const struct voxel_place *at)
{
    const struct voxel_cascade *c = &g->cascades[at->cascade];
    int32_t lattice[3];
    struct voxel_place finest;
    for (int k = 0; k < 3; k++) {
        if (at->cell[k] < 0 || at->cell[k] >= c->resolution)
            return 0;
        lattice[k] = c->low[k] + (at->cell[k] << c->shift);
    }
    return voxel_grid_find(g, lattice, &finest) && finest.cascade == at->cascade ? cell_bits(c, at->cell) : 0;
}

/* ---- Rays (Amanatides and Woo 1987), in double precision: a step goes from a sub-voxel to one that shares a
 * face with it, so no 6-separating wall is thin enough to slip through. Each step moves on along one axis and
 * none moves back, which bounds their number.
 * --------------------------------------------------------------------------- */

struct walk {
    const struct voxel_grid *g;
    double o[3], d[3]; /* lattice units; d per metre */
    double t, length;  /* metres */
    struct voxel_place at;
    int axis;        /* crossed last */
    bool is_leaving; /* has met set sub-voxels alone so far */
    double left;     /* when it last did, metres */
};

/* Where the ray leaves a cube in lattice units, and across which axis. */
static int cube_exit(const struct walk *w, const double low[3], double size, double *t)
{
    int axis = 0;
    *t = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (w->d[k] == 0.0)
            continue;
        const double end = (low[k] + (w->d[k] > 0.0 ? size : 0.0) - w->o[k]) / w->d[k];
        if (end < *t) {
            *t = end;
            axis = k;
        }
    }
    return axis;
}

/* Moves to the end of a cube; false: the ray ends before. */
static bool cube_cross(struct walk *w, const double low[3], double size)
{
    double t;
    const int axis = cube_exit(w, low, size, &t);
    if (!(t < w->length))
        return false;
    w->t = t > w->t ? t : w->t;
    w->axis = axis;
    return true;
}

static void leave_start(struct walk *w)
{
    if (w->is_leaving)
        w->left = w->t;
    w->is_leaving = false;
}

static int step_along(const struct walk *w, int axis)
{
    return w->d[axis] > 0.0 ? 1 : -1;
}

static int clamp_int(double value, int low, int high)
{
    return value < low ? low : value > high ? high : (int)value;
}

/* Goes on at the border of the coarsest cascade, if the ray meets it yet. */
static bool enter(struct walk *w)
{
    const struct voxel_cascade *c = &w->g->cascades[w->g->count - 1];
    double in = w->t, out = w->length;
    int axis = -1;
    for (int k = 0; k < 3; k++) {
        const double a = (c->low[k] - w->o[k]) / w->d[k], b = (c->high[k] - w->o[k]) / w->d[k];
        if (w->d[k] == 0.0) {
            if (w->o[k] < c->low[k] || w->o[k] >= c->high[k])
                return false;
            continue;
        }
        axis = fmin(a, b) > in ? k : axis;
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    if (axis < 0 || !(in < out))
        return false;
    int32_t cell[3];
    leave_start(w);
    w->t = in;
    w->axis = axis;
    for (int k = 0; k < 3; k++)
        cell[k] = clamp_int(floor(w->o[k] + w->d[k] * in), c->low[k], c->high[k] - 1);
    cell[axis] = w->d[axis] > 0.0 ? c->low[axis] : c->high[axis] - 1;
    return voxel_grid_find(w->g, cell, &w->at);
}

static void cell_low(const struct walk *w, double low[3])
{
    const struct voxel_cascade *c = &w->g->cascades[w->at.cascade];
    for (int k = 0; k < 3; k++)
        low[k] = c->low[k] + (double)(w->at.cell[k] << c->shift);
}

/* To the cell beyond the face just reached, in whichever cascade is the finest there. */
static bool next_cell(struct walk *w)
{
    const struct voxel_cascade *c = &w->g->cascades[w->at.cascade];
    const int step = step_along(w, w->axis), size = 1 << c->shift;
    int32_t cell[3] = { w->at.cell[0], w->at.cell[1], w->at.cell[2] };
    cell[w->axis] += step;
    if (cell[w->axis] >= 0 && cell[w->axis] < c->resolution && !is_between(cell, c->hole_low, c->hole_high)) {
        w->at.cell[w->axis] = cell[w->axis];
        return true;
    }
    int32_t lattice[3];
    for (int k = 0; k < 3; k++) {
        const int low = c->low[k] + (w->at.cell[k] << c->shift);
        lattice[k] = clamp_int(floor(w->o[k] + w->d[k] * w->t), low, low + size - 1);
        if (k == w->axis)
            lattice[k] = step > 0 ? low + size : low - 1;
    }
    return voxel_grid_find(w->g, lattice, &w->at) || enter(w);
}

enum outcome { WALK_HIT, WALK_LEFT, WALK_ENDED };

/* From sub-voxel to sub-voxel through one cell. */
static enum outcome walk_cell(struct walk *w, uint64_t bits, int32_t sub[3])
{
    const double size = w->g->cascades[w->at.cascade].width / SUBVOXELS;
    double low[3], corner[3];
    cell_low(w, low);
    for (int k = 0; k < 3; k++)
        sub[k] = clamp_int(floor((w->o[k] + w->d[k] * w->t - low[k]) / size), 0, SUBVOXELS - 1);
    for (;;) {
        const bool set = bits >> (sub[0] + 4 * sub[1] + 16 * sub[2]) & 1;
        if (set && !w->is_leaving)
            return WALK_HIT;
        if (!set)
            leave_start(w);
        for (int k = 0; k < 3; k++)
            corner[k] = low[k] + sub[k] * size;
        if (!cube_cross(w, corner, size))
            return WALK_ENDED;
        sub[w->axis] += step_along(w, w->axis);
        if (sub[w->axis] < 0 || sub[w->axis] >= SUBVOXELS)
            return WALK_LEFT;
    }
}

/* Cells a side, as a power of two, of the largest empty cube around a cell that is empty itself. */
static int empty_cube(const struct voxel_cascade *c, const int32_t cell[3])
{
    const size_t side = (size_t)(c->resolution >> VOXEL_BRICK_BITS);
    return c->empty[(size_t)(cell[0] >> VOXEL_BRICK_BITS) +
                    side * ((size_t)(cell[1] >> VOXEL_BRICK_BITS) +
                            side * (size_t)(cell[2] >> VOXEL_BRICK_BITS))];
}

/* Crosses an empty cell, or the empty cube around it, to the last cell before its end. */
static enum outcome walk_empty(struct walk *w)
{
    const struct voxel_cascade *c = &w->g->cascades[w->at.cascade];
    const int bits = empty_cube(c, w->at.cell);
    const int32_t size = 1 << bits;
    double low[3];
    for (int k = 0; k < 3; k++)
        w->at.cell[k] &= ~(size - 1);
    cell_low(w, low);
    leave_start(w);
    if (!cube_cross(w, low, size * c->width))
        return WALK_ENDED;
    for (int k = 0; k < 3; k++) {
        const int32_t first = w->at.cell[k];
        const double cells = (w->o[k] + w->d[k] * w->t - c->low[k]) / c->width;
        w->at.cell[k] = clamp_int(floor(cells), first, first + size - 1);
        if (k == w->axis)
            w->at.cell[k] = w->d[k] > 0.0 ? first + size - 1 : first;
    }
    return WALK_LEFT;
}

static bool walk_begin(struct walk *w, const struct voxel_grid *g, struct vec3 origin, struct vec3 direction,
                       double length_m)
{
    const double way[3] = { (double)direction.x, (double)direction.y, (double)direction.z };
    int32_t cell[3];
    *w = (struct walk){ .g = g, .length = length_m, .is_leaving = true };
    lattice_point(g, origin, w->o);
    for (int k = 0; k < 3; k++)
        w->d[k] = way[k] / g->cell_m[k];
    return lattice_cell(w->o, cell) && (voxel_grid_find(g, cell, &w->at) || enter(w));
}

bool voxel_grid_trace(const struct voxel_grid *g, struct vec3 origin, struct vec3 direction, double length_m,
                      struct voxel_hit *out)
{
    struct walk w;
    out->left_m = 0.0;
    if (!walk_begin(&w, g, origin, direction, length_m))
        return false;
    enum outcome outcome;
    do {
        const uint64_t bits = cell_bits(&g->cascades[w.at.cascade], w.at.cell);
        outcome = bits != 0 ? walk_cell(&w, bits, out->sub) : walk_empty(&w);
    } while (outcome == WALK_LEFT && next_cell(&w));
    out->left_m = w.is_leaving ? w.t : w.left;
    if (outcome != WALK_HIT)
        return false;
    out->place = w.at;
    out->axis = 2 * w.axis + (step_along(&w, w.axis) > 0 ? 1 : 0);
    out->t_m = w.t;
    return true;
}
