/* SPDX-License-Identifier: MIT
 * What a voxeliser has to set, and what it may set, in double precision. */
#ifndef TEST_ORACLE_VOXEL_H
#define TEST_ORACLE_VOXEL_H

#include "meshes.h"
#include "oracle_bits.h"

/* 6-separating voxelisation (Laine 2013, "A topological approach to voxelization", crosshair target): sets
 * every voxel whose centre cross, three axis-parallel segments one voxel long, a triangle crosses. Triangles
 * and segments are closed. Triangles with a vertex that is not finite, or an index out of range, are left
 * out.
 *
 * `shrink` (in voxels, >= 0) asks less: the crossing must be that far inside the triangle's projection and
 * from the ends of the segment. 0 is the definition; 1e-3 is what float arithmetic can be held to. */
void oracle_voxel_separating(struct oracle_bits *bits, const struct oracle_grid *grid,
                             const struct test_mesh *mesh, double shrink);

/* Slope over the dominant axis up to which a triangle is flat. */
#define ORACLE_FLAT_SLOPE (1.0 / 64)

/* The mesh with each triangle moved half a voxel behind its front side, along its dominant axis, and with
 * skirts between the edges of triangles that are not flat and their moved twins. The caller destroys it.
 *
 * `tolerance` (relative) is for slopes near 1, where the dominant axis is in doubt, and slopes near
 * ORACLE_FLAT_SLOPE. Negative: what is in doubt is left out. Positive: it is there each way. */
struct test_mesh oracle_voxel_inset(const struct oracle_grid *grid, const struct test_mesh *mesh,
                                    double tolerance);

/* Every voxel whose closed box, grown by `grow` voxels on each side, a triangle touches. */
void oracle_voxel_touched(struct oracle_bits *bits, const struct oracle_grid *grid,
                          const struct test_mesh *mesh, double grow);

/* True if a closed triangle (in any unit) and a closed axis-aligned box touch; both may be degenerate. */
bool oracle_triangle_touches_box(const double triangle[static 3][3], const double center[static 3],
                                 const double half_extent[static 3]);

#endif
