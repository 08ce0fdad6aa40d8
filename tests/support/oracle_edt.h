/* SPDX-License-Identifier: MIT
 * Exact Euclidean distances from cell centres to the nearest set sub-voxel centre. */
#ifndef TEST_ORACLE_EDT_H
#define TEST_ORACLE_EDT_H

#include "oracle_bits.h"

/* Sub-voxels along a cell's edge; a grid of 4N sub-voxels has N cells. */
enum { ORACLE_SUB_PER_CELL = 4 };

/* distance_cells[x + N * (y + N * z)] for the N = bits->size / 4 cells a side, in cells (widths of a cell
 * along x); INFINITY everywhere if no bit is set. `y_scale` is the height of a sub-voxel over its width.
 * Separable transform by lower envelopes of parabolas (Felzenszwalb and Huttenlocher 2012), evaluated only
 * where cell centres lie. The caller frees the result. */
float *oracle_edt_cells(const struct oracle_bits *bits, double y_scale);

#endif
