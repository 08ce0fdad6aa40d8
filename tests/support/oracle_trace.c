/* SPDX-License-Identifier: MIT */
#include "oracle_trace.h"

#include <math.h>

bool oracle_trace_box(const double origin[static 3], const double direction[static 3],
                      const double box_min[static 3], const double box_max[static 3], double range[static 2],
                      int *entry_axis)
{
    range[0] = 0;
    range[1] = INFINITY;
    *entry_axis = -1;
    for (int k = 0; k < 3; k++) {
        if (direction[k] == 0) {
            if (origin[k] < box_min[k] || origin[k] > box_max[k])
                return false;
            continue;
        }
        const double low = (box_min[k] - origin[k]) / direction[k],
                     high = (box_max[k] - origin[k]) / direction[k];
        if (fmin(low, high) > range[0]) {
            range[0] = fmin(low, high);
            *entry_axis = k;
        }
        range[1] = fmin(range[1], fmax(low, high));
    }
    return range[0] <= range[1];
}

struct walker {
    int64_t coord[3];
    int step[3];
    double next[3]; /* t of the next crossing along each axis */
    double t;
    int axis;
};

static struct walker walker_create(uint32_t size, const double origin[static 3],
                                   const double direction[static 3], double t, int entry_axis)
{
    struct walker walker = { .t = t, .axis = entry_axis };
    for (int k = 0; k < 3; k++) {
        double at = floor(origin[k] + t * direction[k]);
        if (k == entry_axis) /* rounding must not put the entry point on the wrong side of the face */
            at = direction[k] > 0 ? 0 : (double)size - 1;
        walker.coord[k] = (int64_t)fmin(fmax(at, 0), (double)size - 1);
        walker.step[k] = direction[k] > 0 ? 1 : -1;
    }
    return walker;
}

/* Crossings are computed from the origin each time, so that errors do not add up along the ray. */
static void walker_advance(struct walker *walker, const double origin[static 3],
                           const double direction[static 3])
{
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        const double face = (double)(walker->coord[k] + (walker->step[k] > 0 ? 1 : 0));
        walker->next[k] = direction[k] == 0 ? INFINITY : (face - origin[k]) / direction[k];
        if (walker->next[k] < walker->next[axis])
            axis = k;
    }
    walker->t = fmax(walker->t, walker->next[axis]);
    walker->coord[axis] += walker->step[axis];
    walker->axis = axis;
}

static bool walker_inside(const struct walker *walker, uint32_t size)
{
    for (int k = 0; k < 3; k++)
        if (walker->coord[k] < 0 || walker->coord[k] >= size)
            return false;
    return true;
}

struct oracle_hit oracle_trace(const struct oracle_bits *bits, const double origin[static 3],
                               const double direction[static 3], double limit)
{
    const double zero[3] = { 0, 0, 0 }, end[3] = { bits->size, bits->size, bits->size };
    double range[2];
    int entry_axis;
    struct oracle_hit miss = { .hit = false, .distance = INFINITY, .axis = -1 };
    if (!oracle_trace_box(origin, direction, zero, end, range, &entry_axis))
        return miss;
    struct walker walker = walker_create(bits->size, origin, direction, range[0], entry_axis);
    while (walker_inside(&walker, bits->size) && walker.t <= limit && walker.t < INFINITY) {
        const uint32_t coord[3] = { (uint32_t)walker.coord[0], (uint32_t)walker.coord[1],
                                    (uint32_t)walker.coord[2] };
        if (oracle_bits_get(bits, coord[0], coord[1], coord[2]))
            return (struct oracle_hit){ true, walker.t, { coord[0], coord[1], coord[2] }, walker.axis };
        walker_advance(&walker, origin, direction);
    }
    return miss;
}

bool oracle_bits_near(const struct oracle_bits *bits, const double point[static 3], double reach)
{
    for (int i = 0; i < 8; i++) {
        int64_t at[3];
        bool inside = true;
        for (int k = 0; k < 3; k++) {
            at[k] = (int64_t)floor(point[k] + (i >> k & 1 ? reach : -reach));
            inside = inside && at[k] >= 0 && at[k] < bits->size;
        }
        if (inside && oracle_bits_get(bits, (uint32_t)at[0], (uint32_t)at[1], (uint32_t)at[2]))
            return true;
    }
    return false;
}

double oracle_trace_touch(const struct oracle_bits *bits, const double origin[static 3],
                          const double direction[static 3], double limit, double reach)
{
    const double zero[3] = { 0, 0, 0 }, end[3] = { bits->size, bits->size, bits->size };
    double range[2];
    int entry_axis;
    if (!oracle_trace_box(origin, direction, zero, end, range, &entry_axis))
        return INFINITY;
    struct walker walker = walker_create(bits->size, origin, direction, range[0], entry_axis);
    while (walker_inside(&walker, bits->size) && walker.t <= limit && walker.t < INFINITY) {
        double point[3];
        for (int k = 0; k < 3; k++)
            point[k] = origin[k] + walker.t * direction[k];
        if (oracle_bits_near(bits, point, reach))
            return walker.t;
        walker_advance(&walker, origin, direction);
    }
    return INFINITY;
}
