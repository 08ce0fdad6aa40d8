/* SPDX-License-Identifier: MIT
 * Rays through sub-voxel bits, in double precision. */
#ifndef TEST_ORACLE_TRACE_H
#define TEST_ORACLE_TRACE_H

#include "oracle_bits.h"

struct oracle_hit {
    bool hit;
    double distance; /* from the origin, in lengths of `direction`; where the ray enters the set sub-voxel */
    uint32_t coord[3]; /* of that sub-voxel */
    int axis;          /* of the face through which it is entered; -1 if the ray begins inside */
};

/* First set sub-voxel along origin + t * direction, 0 <= t <= limit (Amanatides and Woo 1987). Coordinates
 * are in sub-voxels, voxel i covering [i, i + 1); the origin may lie outside the grid. For grids with unequal
 * steps divide direction by the step along each axis, and distances stay in world lengths. */
struct oracle_hit oracle_trace(const struct oracle_bits *bits, const double origin[static 3],
                               const double direction[static 3], double limit);

/* True if a set sub-voxel lies within `reach` (sub-voxels) of the point along each axis. */
bool oracle_bits_near(const struct oracle_bits *bits, const double point[static 3], double reach);

/* Where the ray first comes within `reach` (sub-voxels) of a set sub-voxel while it crosses a face: a ray
 * that runs exactly through an edge is stopped by any of those around it. INFINITY if nothing comes near. */
double oracle_trace_touch(const struct oracle_bits *bits, const double origin[static 3],
                          const double direction[static 3], double limit, double reach);

/* Range of t in which the ray is inside a closed box; false if it misses. range[0] is at least 0. */
bool oracle_trace_box(const double origin[static 3], const double direction[static 3],
                      const double box_min[static 3], const double box_max[static 3], double range[static 2],
                      int *entry_axis);

#endif
