/* SPDX-License-Identifier: MIT
 * Counters that shaders write and the host reads back every frame; and the records of indirect arguments. */
#ifndef SDFGI_SHARED_COUNTERS_H
#define SDFGI_SHARED_COUNTERS_H

#include "constants.h"

#define SDFGI_COUNTER_TRIANGLES_SKIPPED 0
#define SDFGI_COUNTER_VALUES_CLAMPED    1
#define SDFGI_COUNTER_BOUNCE_CLAMPED    2
#define SDFGI_COUNTER_TRACE_CAPS        3
#define SDFGI_COUNTER_UNLIT_HITS        4
#define SDFGI_COUNTER_RAYS_TRACED       5
#define SDFGI_COUNTER_MAX_CHANGE        6 /* float bits: largest relative change of a texel over a cycle */
#define SDFGI_COUNTER_MAX_DRIFT         7 /* float bits: largest relative change of a probe since its mark */
#define SDFGI_COUNTER_DEAD_PROBES       8
#define SDFGI_COUNTER_VOXELS            9  /* sub-voxel samples that the voxeliser accepted */
#define SDFGI_COUNTER_DISTANCE_CELLS    10 /* cells whose distances the exact search made again */
#define SDFGI_COUNTER_OUT_OF_BOUNDS     11 /* triangles outside their mesh's bounds by more than a cell */
#define SDFGI_COUNTER_SAMPLES_CUT       12 /* samples that a block had no room for */
#define SDFGI_COUNTER_SINGLE_COUNT      16 /* room for counters that are not per cascade */
/* Per cascade: light cells, and those in dirty blocks when they were listed. Neither is clamped to the room
 * in the list. */
#define SDFGI_COUNTER_LIGHT_CELLS 16
#define SDFGI_COUNTER_LIGHT_DIRTY 24
/* Per cascade: light cells that gathers of pictures have seen since these were last forgotten. */
#define SDFGI_COUNTER_CELLS_SEEN 32
/* From here on counters stand at the end of GATHERED, not in COUNTERS, because other passes count beside
 * cell_gather. */
#define SDFGI_COUNTER_GATHER 40
/* Per cascade: float bits of the largest relative change of a light cell over a gather cycle. */
#define SDFGI_COUNTER_CELL_CHANGE 40
/* Per cascade: light cells that changed by SDFGI_SMALL_CHANGE or more over a gather cycle. */
#define SDFGI_COUNTER_CELLS_CHANGING 48
/* Per cascade: float bits of the largest relative change of a light cell since it was marked. */
#define SDFGI_COUNTER_CELL_DRIFT 56
/* Per cascade: light cells that rays of watched cells have hit since marks go to the present part of SEEN. */
#define SDFGI_COUNTER_CELLS_HIT 64
#define SDFGI_COUNTER_COUNT     72

/* X(id, cleared, health): the counters that are not per cascade.
 *   cleared  CHANGE: in a frame that voxelises anything; CYCLE: then, and at the start of every sample cycle
 *   health   the message that reports a count above 0; NONE: no message */
#define SDFGI_COUNTERS(X)                                                                                    \
    X(TRIANGLES_SKIPPED, CHANGE, TRIANGLES_SKIPPED)                                                          \
    X(VALUES_CLAMPED, CYCLE, VALUE_CLAMPED)                                                                  \
    X(BOUNCE_CLAMPED, CYCLE, BOUNCE_CLAMPED)                                                                 \
    X(TRACE_CAPS, CYCLE, TRACE_CAP_REACHED)                                                                  \
    X(UNLIT_HITS, CYCLE, UNLIT_HITS)                                                                         \
    X(RAYS_TRACED, CYCLE, NONE)                                                                              \
    X(MAX_CHANGE, CYCLE, NONE)                                                                               \
    X(MAX_DRIFT, CYCLE, NONE)                                                                                \
    X(DEAD_PROBES, CHANGE, NONE)                                                                             \
    X(VOXELS, CHANGE, NONE)                                                                                  \
    X(DISTANCE_CELLS, CHANGE, NONE)                                                                          \
    X(OUT_OF_BOUNDS, CHANGE, BOUNDS_MISS_VERTICES)                                                           \
    X(SAMPLES_CUT, CHANGE, SURFACES_CROWDED)

/* Records of four words: the three workgroup counts of an indirect dispatch, and a number of items. Passes
 * read the number here and not among the counters, because other passes write counters beside them.
 *
 * - CELLS, per cascade: one thread per dirty light cell. The number is that of all light cells, not clamped.
 * - MASKS, per cascade: eight threads per dirty light cell. The number is that of dirty light cells.
 * - DIRECT, per cascade: six threads per dirty light cell. No number.
 * - RAYS: one thread per ray that this frame traces. The number is that of these rays. */
#define SDFGI_INDIRECT_CELLS   0
#define SDFGI_INDIRECT_MASKS   SDFGI_MAX_CASCADES
#define SDFGI_INDIRECT_DIRECT  (2 * SDFGI_MAX_CASCADES)
#define SDFGI_INDIRECT_RAYS    (3 * SDFGI_MAX_CASCADES)
#define SDFGI_INDIRECT_RECORDS (3 * SDFGI_MAX_CASCADES + 1)

#endif
