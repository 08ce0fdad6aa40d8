/* SPDX-License-Identifier: MIT
 * One row per pass: pipelines, labels, timers, barriers, the plan and the report follow from it. A pass has the name of
 * its shader.
 *
 * X(id, shader, unit, reads, writes, need)
 *   unit    what its work counter counts
 *   reads   resources, as bits; R(NAME) | ...  FRAME is read by all; what is also written may be left out
 *   writes  likewise; tests/layout compares both with what the compiled shaders do
 *   need    the condition of the scene that calls for it, see plan.c
 */
#ifndef SDFGI_PASS_TABLE_H
#define SDFGI_PASS_TABLE_H

/* clang-format off */
#define SDFGI_PASSES(X)                                                                                              \
    X(REGION_CLEAR,    region_clear,    "cells",       0, R(BITS) | R(LIGHT) | R(MASKS) | R(SCRATCH) | R(BOUNDS), GENERATE) \
    X(VOXELIZE,        voxelize,        "triangles",   R(MATERIALS), R(BITS) | R(SCRATCH) | R(LIGHT) | R(COUNTERS), VOXELS)   \
    X(VOXELIZE_RASTER, voxelize_raster, "triangles",   R(MATERIALS), R(BITS) | R(SCRATCH) | R(LIGHT) | R(COUNTERS), VOXELS_RASTER) \
    X(VOXEL_RESOLVE,   voxel_resolve,   "blocks",      R(BITS) | R(SCRATCH), R(LIGHT) | R(ALBEDO) | R(EMISSION) | R(NORMALS) | R(COUNTERS) | R(BOUNDS), GENERATE) \
    X(DISTANCE_PREPARE, distance_prepare, "cells",     R(BITS) | R(DISTANCE) | R(BOUNDS), R(SCRATCH) | R(COUNTERS), EXACT) \
    X(DISTANCE_PLANE,  distance_plane,  "cells",       R(BITS) | R(SCRATCH), R(SCRATCH), EXACT)                      \
    X(DISTANCE_EXACT,  distance_exact,  "cells",       R(SCRATCH), R(DISTANCE), EXACT)                               \
    X(FLOOD_SEED,      flood_seed,      "cells",       R(BITS), R(SCRATCH), FLOOD)                                   \
    X(FLOOD_STEP,      flood_step,      "cells",       R(BITS), R(SCRATCH), FLOOD)                                   \
    X(FLOOD_DISTANCE,  flood_distance,  "cells",       R(SCRATCH), R(DISTANCE), FLOOD)                               \
    X(PROBE_PLACE,     probe_place,     "probes",      R(BITS) | R(DISTANCE), R(PROBES) | R(COUNTERS), COMPLETE)     \
    X(PROBE_SEED,      probe_seed,      "probes",      R(BITS) | R(DISTANCE) | R(PROBES) | R(IRRADIANCE), R(SUMS) | R(PREVIOUS) | R(IRRADIANCE), SEED) \
    X(OCCLUSION_TRACE, occlusion_trace, "rays",        R(BITS) | R(DISTANCE) | R(PROBES), R(OCCLUSION), OCCLUSION)   \
    X(LIGHT_MARK,      light_mark,      "cells",       R(BITS) | R(DISTANCE) | R(LIGHT_CELLS) | R(INDIRECT), R(LIGHT) | R(MASKS) | R(SCRATCH), LIST) \
    X(LIGHT_LIST,      light_list,      "light cells", 0, R(LIGHT) | R(LIGHT_CELLS) | R(SCRATCH) | R(COUNTERS) | R(INDIRECT), LIST) \
    X(CELL_MASK,       cell_mask,       "light cells", R(BITS) | R(DISTANCE) | R(PROBES) | R(SCRATCH) | R(INDIRECT), R(MASKS), MASKS) \
    X(RAY_INVALIDATE,  ray_invalidate,  "rays",        R(PROBES) | R(BOUNDS), R(RAYS), SEED)                                     \
    X(LIGHT_DIRECT,    light_direct,    "light cells", R(BITS) | R(DISTANCE) | R(LIGHTS) | R(ALBEDO) | R(NORMALS) | R(SCRATCH), R(LIGHT_CELLS) | R(COUNTERS), DIRECT) \
    X(LIGHT_BOUNCE,    light_bounce,    "light cells", R(BITS) | R(PROBES) | R(MASKS) | R(OCCLUSION) | R(ALBEDO) | R(EMISSION) | R(NORMALS) | R(LIGHT_CELLS) | R(SCRATCH) | R(IRRADIANCE), R(LIGHT) | R(COUNTERS), LIGHT) \
    X(RAY_LIST,        ray_list,        "rays",        R(PROBES) | R(RAYS), R(SCRATCH) | R(INDIRECT), RAYS) \
    X(PROBE_TRACE,     probe_trace,     "rays",        R(BITS) | R(DISTANCE) | R(PROBES) | R(SCRATCH), R(RAYS) | R(INDIRECT), RAYS) \
    X(PROBE_SUM,       probe_sum,       "rays",        R(PROBES) | R(RAYS) | R(LIGHT) | R(INDIRECT), R(SUMS) | R(COUNTERS), TRACE) \
    X(PROBE_BLEND,     probe_blend,     "probes",      R(PROBES), R(SUMS) | R(PREVIOUS) | R(IRRADIANCE) | R(COUNTERS), BLEND) \
    X(GATHER,          gather,          "pixels",      R(BITS) | R(DISTANCE) | R(LIGHT) | R(PROBES) | R(MASKS) | R(OCCLUSION) | R(IRRADIANCE), 0, GATHER)
/* clang-format on */

enum pass {
#define PASS_ENUM(id, shader, unit, reads, writes, need) PASS_##id,
    SDFGI_PASSES(PASS_ENUM)
#undef PASS_ENUM
    PASS_COUNT,
};

#endif
