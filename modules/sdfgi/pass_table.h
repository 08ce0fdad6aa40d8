/* SPDX-License-Identifier: MIT
 * One row per pass: pipelines, layouts, push constants, dispatch sizes, labels, timers, barriers, the plan
 * and the report follow from it. A pass has the name of its shader. Meson takes the list of shaders from
 * here.
 *
 * X(id, kind, shader, unit, need, phase, made, domain, args, group, set, reads, writes)
 *   kind    COMPUTE: <shader>.comp; RASTER: <shader>.vert and .frag. _TEXTURED: a second variant for
 *           materials with textures; _LOBES: for light cells that keep from where they get their light;
 *           _METAL: for scenes with metal that reflects what it sees
 *   unit    what its work counter counts: enum pass_unit in pass/pass_rows.h
 *   need    the condition of the scene that calls for it: frame/frame_needs.c
 *   phase   where in a frame it runs, in the order of the rows: enum pass_phase in pass/pass_rows.h. A row is
 *           all that a pass needs to be planned; OWN: a function in frame/stage_*.c plans it
 *   made    when its pipeline is made: CREATED with the context or with the settings that call for it, on
 *           DEMAND, or with the RASTER target
 *   domain  what it runs over, from which the size of a dispatch follows: enum domain in pass/work.h
 *   args    its push constants: struct sdfgi_<args>_args of shaders/shared/args.h, or none
 *   group   elements of the domain that a workgroup takes, such as SDFGI_GROUP_* of shared/constants.h
 *   set     beside LOOKUP and WORK: MESH (and MATERIAL), VIEW, or NONE
 *   reads   resources, as bits; R(NAME) | ..., and V(NAME) of what a view owns. FRAME is read by all. What
 *           a pass writes may be left out
 *   writes  likewise
 * tests/layout/test_pass_table.c compares reads and writes with the compiled shaders.
 */
#ifndef SDFGI_PASS_TABLE_H
#define SDFGI_PASS_TABLE_H

/* clang-format off */
#define SDFGI_PASSES(X)                                                                                      \
    X(REGION_CLEAR, COMPUTE, region_clear, CELLS, GENERATE, VOXELS, CREATED,                                 \
      BOX, region, 4 * SDFGI_GROUP_LINEAR, NONE, 0, R(BITS) | R(BOUNDS))                                     \
    X(VOXELIZE, COMPUTE_TEXTURED, voxelize, TRIANGLES, VOXELS, VOXELS, CREATED,                              \
      INSTANCES, voxelize, SDFGI_GROUP_TRIANGLE, MESH, R(MATERIALS) | R(INSTANCES), R(BITS) | R(SCRATCH) |   \
      R(COUNTERS))                                                                                           \
    X(VOXELIZE_RASTER, RASTER_TEXTURED, voxelize_raster, TRIANGLES, VOXELS_RASTER, VOXELS, RASTER,           \
      INSTANCES, voxelize, 1, MESH, R(MATERIALS) | R(INSTANCES), R(BITS) | R(SCRATCH) | R(COUNTERS))         \
    X(VOXEL_RESOLVE, COMPUTE, voxel_resolve, BLOCKS, GENERATE, VOXELS, CREATED,                              \
      BOX, region, 8 * SDFGI_GROUP_LINEAR, NONE, R(BITS) | R(SCRATCH), R(ALBEDO) |                           \
      R(EMISSION) | R(NORMALS) | R(COUNTERS) | R(BOUNDS) | R(EMITTERS))                                      \
    X(DISTANCE_PREPARE, COMPUTE, distance_prepare, CELLS, EXACT, DISTANCES, CREATED,                         \
      DISTANCE_ROWS, distance_prepare, SDFGI_GROUP_COLUMNS, NONE, R(BITS) | R(DISTANCE) | R(BOUNDS),         \
      R(SEARCH) | R(COUNTERS))                                                                               \
    X(DISTANCE_PLANE, COMPUTE, distance_plane, CELLS, EXACT, DISTANCES, CREATED,                             \
      DISTANCE_LAYERS, distance_search, SDFGI_LINES, NONE, R(BITS) | R(SEARCH), R(SCRATCH))                  \
    X(DISTANCE_EXACT, COMPUTE, distance_exact, CELLS, EXACT, DISTANCES, CREATED,                             \
      DISTANCE_COLUMNS, distance_search, SDFGI_LINES, NONE, R(SCRATCH) | R(SEARCH), R(DISTANCE))             \
    X(FLOOD_SEED, COMPUTE, flood_seed, CELLS, FLOOD, OWN, CREATED,                                           \
      CELLS, flood, SDFGI_GROUP_CELLS, NONE, R(BITS), R(SCRATCH))                                            \
    X(FLOOD_STEP, COMPUTE, flood_step, CELLS, FLOOD, OWN, CREATED,                                           \
      CELLS, flood, SDFGI_GROUP_CELLS, NONE, R(BITS), R(SCRATCH))                                            \
    X(FLOOD_DISTANCE, COMPUTE, flood_distance, CELLS, FLOOD, OWN, CREATED,                                   \
      CELLS, flood, SDFGI_GROUP_CELLS, NONE, R(SCRATCH), R(DISTANCE))                                        \
    X(OCCUPIED_CELLS, COMPUTE, occupied_cells, CELLS, COMPLETE, BOXES, CREATED,                              \
      BLOCKS, cascade, SDFGI_GROUP_LINEAR, NONE, R(BITS), R(SCRATCH))                                        \
    X(EMPTY_CUBES, COMPUTE, empty_cubes, CELLS, COMPLETE, BOXES, CREATED,                                    \
      CUBES, cascade, 1, NONE, 0, R(SCRATCH))                                                                \
    X(EMPTY_BOXES, COMPUTE, empty_boxes, CELLS, COMPLETE, BOXES, CREATED,                                    \
      BLOCKS, cascade, SDFGI_GROUP_BOXES / 2, NONE, R(SCRATCH), R(BITS))                                     \
    X(EMITTER_MARK, COMPUTE, emitter_mark, BLOCKS, EMITTERS, EMITTERS, CREATED,                              \
      BLOCKS, cascade, SDFGI_GROUP_LINEAR, NONE, R(EMITTERS), R(EMISSION) | R(SCRATCH))                      \
    X(EMITTER_LIST, COMPUTE, emitter_list, BLOCKS, EMITTERS, EMITTERS, CREATED,                              \
      CASCADE, cascade, 1, NONE, R(BITS) | R(SCRATCH), R(EMISSION) | R(EMITTERS))                            \
    X(LIGHT_MARK, COMPUTE, light_mark, CELLS, LIST, MARK, CREATED,                                           \
      LIGHT_BLOCKS, light_mark, SDFGI_GROUP_LINEAR, NONE, R(BITS) | R(DISTANCE) | R(LIGHT_CELLS) |           \
      R(LIGHT_BLOCKS) | R(LIGHT) | R(SURFACES) | R(GATHERED) | R(SEEN) | R(INDIRECT) | R(DIRECT),            \
      R(MASKS) | R(SCRATCH))                                                                                 \
    X(PROBE_PLACE, COMPUTE, probe_place, PROBES, COMPLETE, PLACE, CREATED,                                   \
      PROBES, cascade, 1, NONE, R(BITS) | R(DISTANCE), R(PROBES) | R(COUNTERS))                              \
    X(LIGHT_LIST, COMPUTE, light_list, LIGHT_CELLS, LIST, LIST, CREATED,                                     \
      LIGHT_ROWS, cascade, SDFGI_GROUP_LINEAR, NONE, R(BITS), R(LIGHT) | R(LIGHT_CELLS) | R(LIGHT_BLOCKS) |  \
      R(SURFACES) | R(GATHERED) | R(SEEN) | R(SCRATCH) | R(COUNTERS) | R(INDIRECT) | R(DIRECT))              \
    X(LIGHT_DIRECT, COMPUTE, light_direct, LIGHT_CELLS, DIRECT, OWN, CREATED,                                \
      LIGHT_CELLS, light_direct, SDFGI_CELLS_OF_SURFACES, NONE, R(BITS) | R(DISTANCE) | R(LIGHTS) |          \
      R(ALBEDO) | R(NORMALS) | R(SCRATCH) | R(INDIRECT) | R(LIGHT_CELLS), R(DIRECT) | R(COUNTERS))           \
    X(CELL_MASK, COMPUTE, cell_mask, LIGHT_CELLS, MASKS, OWN, CREATED,                                       \
      LIGHT_CELLS, cascade, SDFGI_GROUP_LINEAR / 8, NONE, R(BITS) | R(PROBES) | R(SCRATCH)                   \
      | R(INDIRECT), R(MASKS))                                                                               \
    X(OCCLUSION_TRACE, COMPUTE, occlusion_trace, RAYS, OCCLUSION, SEED, CREATED,                             \
      PROBES, cascade, 1, NONE, R(BITS) | R(PROBES), R(OCCLUSION))                                           \
    X(PROBE_SEED, COMPUTE, probe_seed, PROBES, SEED, SEED, CREATED,                                          \
      PROBES, cascade, 1, NONE, R(BITS) | R(PROBES) | R(IRRADIANCE), R(SUMS) | R(PREVIOUS)                   \
      | R(IRRADIANCE))                                                                                       \
    X(LIGHT_RESCALE, COMPUTE, light_rescale, LIGHT_CELLS, RESCALE, OWN, CREATED,                             \
      STORED_LIGHT, light_rescale, SDFGI_GROUP_LINEAR, NONE, 0, R(LIGHT) | R(DIRECT) | R(SURFACES) |         \
      R(GATHERED) | R(IRRADIANCE) | R(PREVIOUS) | R(SUMS))                                                   \
    X(RAY_INVALIDATE, COMPUTE, ray_invalidate, RAYS, SEED, OWN, CREATED,                                     \
      ALL_PROBES, none, 1, NONE, R(PROBES) | R(BOUNDS), R(RAYS))                                             \
    X(LIGHT_BOUNCE, COMPUTE, light_bounce, LIGHT_CELLS, LIGHT, OWN, CREATED,                                 \
      ALL_LIGHT_CELLS, light_bounce, SDFGI_GROUP_LINEAR, NONE, R(BITS) | R(PROBES) | R(MASKS) |              \
      R(OCCLUSION) | R(ALBEDO) | R(NORMALS) | R(LIGHT_CELLS) | R(LIGHT_BLOCKS) | R(SCRATCH) |                \
      R(IRRADIANCE) | R(SEEN) | R(INDIRECT) | R(DIRECT), R(LIGHT) | R(SURFACES) | R(GATHERED) |              \
      R(COUNTERS))                                                                                           \
    X(RAY_LIST, COMPUTE, ray_list, RAYS, RAYS, RAYS, CREATED,                                                \
      ALL_RAYS, none, SDFGI_LISTED_RAYS * SDFGI_GROUP_RAYS, NONE, R(PROBES) | R(EMITTERS),                   \
      R(RAYS) | R(SCRATCH) | R(INDIRECT))                                                                    \
    X(VISIT_LIST, COMPUTE, visit_list, LIGHT_CELLS, CELLS, OWN, CREATED,                                     \
      SEEN_WORDS, visit_list, SDFGI_GROUP_VISITS, NONE, 0, R(SEEN))                                          \
    X(PROBE_TRACE, COMPUTE, probe_trace, RAYS, RAYS, OWN, CREATED,                                           \
      ALL_RAYS, none, SDFGI_GROUP_LINEAR, NONE, R(BITS) | R(PROBES) | R(SCRATCH)                             \
      | R(INDIRECT) | R(EMITTERS), R(RAYS))                                                                  \
    X(CELL_GATHER, COMPUTE_LOBES, cell_gather, RAYS, CELLS, OWN, CREATED,                                    \
      ALL_LIGHT_CELLS, cell_gather, SDFGI_VISIT_CELLS, NONE, R(BITS) | R(DISTANCE) | R(LIGHT) | R(ALBEDO)    \
      | R(NORMALS) | R(EMISSION) | R(EMITTERS) | R(LIGHT_CELLS) | R(LIGHT_BLOCKS) | R(INDIRECT),             \
      R(SEEN) | R(GATHERED))                                                                                 \
    X(CELL_FILTER, COMPUTE, cell_filter, LIGHT_CELLS, FILTER, OWN, CREATED,                                  \
      ALL_LIGHT_CELLS, cell_filter, SDFGI_FILTER_CELLS, NONE, R(LIGHT_CELLS) | R(LIGHT_BLOCKS) |             \
      R(SEEN) | R(INDIRECT), R(GATHERED))                                                                    \
    X(CELL_FILTER_FAR, COMPUTE, cell_filter_far, LIGHT_CELLS, FILTER, OWN, CREATED,                          \
      ALL_LIGHT_CELLS, cell_filter, SDFGI_FILTER_CELLS, NONE, R(LIGHT_CELLS) | R(LIGHT_BLOCKS) |             \
      R(SEEN) | R(INDIRECT) | R(GATHERED), R(SURFACES))                                                      \
    X(PROBE_SUM, COMPUTE, probe_sum, RAYS, TRACE, SUM, CREATED,                                              \
      ALL_PROBES, none, 1, NONE, R(PROBES) | R(RAYS) | R(LIGHT) | R(LIGHT_BLOCKS) | R(SURFACES) |            \
      R(EMISSION) | R(INDIRECT), R(SUMS) | R(COUNTERS))                                                      \
    X(PROBE_BLEND, COMPUTE, probe_blend, PROBES, BLEND, BLEND, CREATED,                                      \
      ALL_PROBES, probe_blend, 1, NONE, R(PROBES), R(SUMS) | R(PREVIOUS) | R(IRRADIANCE) | R(COUNTERS))      \
    X(GATHER, COMPUTE_LOBES, gather, PIXELS, GATHER, OWN, DEMAND,                                            \
      PIXELS, gather, SDFGI_GROUP_PIXELS, VIEW, R(BITS) | R(DISTANCE) | R(PROBES) | R(IRRADIANCE) |          \
      R(LIGHT_BLOCKS) | R(SURFACES) | V(TILES), R(SEEN) | R(COUNTERS) | V(DIFFUSE) | V(REFLECTION))          \
    X(GATHER_SPARSE, COMPUTE_LOBES, gather_sparse, PIXELS, GATHER_SPARSE, OWN, DEMAND,                       \
      TILES, gather, 1, VIEW, R(BITS) | R(DISTANCE) | R(PROBES) | R(IRRADIANCE) |                            \
      R(LIGHT_BLOCKS) | R(SURFACES) | V(TILES), R(SEEN) | R(COUNTERS) | V(DIFFUSE) | V(REFLECTION))          \
    X(REFLECT_LOBES, COMPUTE, reflect_lobes, PIXELS, ROUGH_LOBES, OWN, DEMAND,                               \
      PIXELS, gather, SDFGI_GROUP_LOBES, VIEW, R(BITS) | R(LIGHT_BLOCKS) | R(SURFACES) | R(SEEN),            \
      V(TILES))                                                                                              \
    X(REFLECT_TILES, COMPUTE, reflect_tiles, PIXELS, REFLECTIONS, OWN, DEMAND,                               \
      PIXELS, gather, SDFGI_GROUP_TILES, VIEW, 0, V(REFLECTION) | V(TILES))                                  \
    X(REFLECT_RAYS, COMPUTE_METAL, reflect_rays, PIXELS, REFLECTIONS, OWN, DEMAND,                           \
      TILE_LIST, gather, 1, VIEW, R(BITS) | R(DISTANCE) | R(PROBES) | R(IRRADIANCE) | R(LIGHT) |             \
      R(LIGHT_BLOCKS) | R(SURFACES) | R(EMISSION) | R(EMITTERS) | R(ALBEDO) | R(NORMALS) | V(TILES),         \
      V(REFLECTION))                                                                                         \
    X(REFLECT_FILTER, COMPUTE, reflect_filter, PIXELS, REFLECTIONS, OWN, DEMAND,                             \
      TILE_LIST, gather, 1, VIEW, V(TILES) | V(DIFFUSE), V(REFLECTION) | V(FILTERED))                        \
    X(DEBUG_VIEW, COMPUTE, debug_view, PIXELS, DEBUG_VIEW, OWN, DEMAND,                                      \
      PIXELS, debug_view, SDFGI_GROUP_PIXELS, VIEW, R(BITS) | R(DISTANCE) | R(LIGHT) | R(PROBES) |           \
      R(IRRADIANCE) | R(LIGHT_BLOCKS) | R(SURFACES) | R(EMISSION) | R(ALBEDO) | R(SUMS) | R(MASKS) |         \
      R(OCCLUSION) | R(GATHERED), V(DIFFUSE))                                                                \
    X(DEBUG_TIER, COMPUTE, debug_tier, PIXELS, DEBUG_TIER, OWN, DEMAND,                                      \
      PIXELS, gather, SDFGI_GROUP_PIXELS, VIEW, 0, V(DIFFUSE))
/* clang-format on */

enum pass {
#define PASS_ENUM(id, kind, shader, unit, need, phase, made, domain, args, group, set, reads, writes)        \
    PASS_##id,
    SDFGI_PASSES(PASS_ENUM)
#undef PASS_ENUM
    PASS_COUNT,
};

#endif
