/* SPDX-License-Identifier: MIT
 * One row per resource of a volume: allocation, names, bindings, barriers, the memory estimate and report
 * follow from it.
 *
 * X(id, kind, format, category, scope, set, extent, keep)
 *   kind      UNIFORM or STORAGE buffer
 *   format    of an element: RESOURCE_FORMATS
 *   category  of the memory report
 *   scope     who owns it: VOLUME (follows a camera) or VIEW (belongs to one picture)
 *   set       LOOKUP: what hosts bind for sdfgi.glsl; WORK: what only passes bind. Bindings are those of
 *             shaders/shared/bindings.h
 *   extent    elements, from `const struct extent *e`: elements of one cascade, cascades, samples in a cycle
 *   keep      SAVED: cannot be made again from the scene at once, as light gathers over many frames;
 *             DERIVED: made again from the scene and from what is saved; SCRATCH: empty between frames
 *
 * FRAME, LIGHTS, MATERIALS  written by the host when anything in them changes
 * BITS, DISTANCE, EMISSION, ALBEDO, NORMALS  valid until the cascade moves or its geometry changes
 * LIGHT                     outgoing light per light cell and axis, in the order of the list, and as long
 * LIGHT_CELLS               the light list: grows when it is too short
 * DIRECT                    direct light per light cell and the lights that it comes from, in the order of
 *                           the list, and as long. Apart from the list, so that it may change beside passes
 *                           that read the list
 * LIGHT_BLOCKS              where in the list the light cells of a block are
 * SURFACES                  irradiance per light cell and axis, in the order of the list, and as long
 * EMITTERS                  where emitters are in their blocks, and lists of them; none where nothing emits
 * SEEN                      which light cells gathers of pictures have read of late, and which light these;
 *                           then which of them the frame visits; and from where light cells get their
 *                           light, which hosts read as texels in the LOOKUP set: see shared/seen.h
 * SEARCH                    where the distance search finds set bits, and which blocks it makes again
 * GATHERED                  what light cells gathered with rays of their own, in the order of the list
 * RAYS                      where rays end: valid until a cascade that the ray may reach changes; behind the
 *                           rays of each probe its samples towards emitters, if anything emits
 * SUMS                      of this sample cycle; and each probe's history
 * PREVIOUS                  the sample cycle before
 * BOUNDS                    from the start of a change to its end
 * INSTANCES                 a list of slots, which a dispatch draws; then all of the scene by slot, written
 *                           by the host when they change: grows with the scene
 */
#ifndef SDFGI_RESOURCE_TABLE_H
#define SDFGI_RESOURCE_TABLE_H

/* X(id, bytes, texels): what shaders read if they read texels, UNDEFINED if they never do. */
#define RESOURCE_FORMATS(X)                                                      \
    X(U8, 1, R32_UINT)                                                           \
    X(U16, 2, R32_UINT)                                                          \
    X(U32, 4, R32_UINT)                                                          \
    X(U32X2, 8, R32G32_UINT)                                                     \
    X(U32X4, 16, R32G32B32A32_UINT)                                              \
    X(F16X4, 8, R32G32_UINT)                                                     \
    X(F32X4, 16, R32G32B32A32_SFLOAT)                                            \
    X(FRAME_PARAMS, sizeof(struct sdfgi_frame_params), UNDEFINED)                \
    X(LIGHT_PARAMS, sizeof(struct sdfgi_light_params), R32G32B32A32_UINT)        \
    X(MATERIAL_PARAMS, sizeof(struct sdfgi_material_params), R32G32B32A32_UINT)

/* clang-format off */
#define SDFGI_RESOURCES(X)                                                                                   \
    X(FRAME,       UNIFORM, FRAME_PARAMS,    LISTS,   VOLUME, LOOKUP, 1,                            DERIVED) \
    X(BITS,        STORAGE, U32X2,           VOLUMES, VOLUME, LOOKUP, e->cells * e->cascades,       DERIVED) \
    X(DISTANCE,    STORAGE, U16,             VOLUMES, VOLUME, LOOKUP, e->cells * e->cascades,       DERIVED) \
    X(LIGHT,       STORAGE, U32,             LISTS,   VOLUME, LOOKUP, 6 * ENTRY_COUNT(e),           SAVED)   \
    X(PROBES,      STORAGE, U32,             PROBES,  VOLUME, LOOKUP, e->probes * e->cascades,      DERIVED) \
    X(IRRADIANCE,  STORAGE, F16X4,           PROBES,  VOLUME, LOOKUP, TEXEL_COUNT(e),               SAVED)   \
    X(LIGHT_BLOCKS, STORAGE, U32X2,          LISTS,   VOLUME, LOOKUP, e->cells / 32 * e->cascades,  DERIVED) \
    X(SURFACES,    STORAGE, U32,             LISTS,   VOLUME, LOOKUP, 6 * ENTRY_COUNT(e),           SAVED)   \
    X(EMISSION,    STORAGE, U32X2,           VOLUMES, VOLUME, LOOKUP, e->blocks * e->cascades,      DERIVED) \
    X(LIGHTS,      STORAGE, LIGHT_PARAMS,    LISTS,   VOLUME, WORK,   SDFGI_MAX_LIGHTS,             DERIVED) \
    X(MATERIALS,   STORAGE, MATERIAL_PARAMS, LISTS,   VOLUME, WORK,   SDFGI_MAX_MATERIALS,          DERIVED) \
    X(SCRATCH,     STORAGE, U8,              SCRATCH, VOLUME, WORK,   e->scratch,                   SCRATCH) \
    X(ALBEDO,      STORAGE, U32X2,           VOLUMES, VOLUME, WORK,   e->blocks * e->cascades,      DERIVED) \
    X(NORMALS,     STORAGE, U32,             VOLUMES, VOLUME, WORK,   e->blocks * e->cascades,      DERIVED) \
    X(LIGHT_CELLS, STORAGE, U32,             LISTS,   VOLUME, WORK,   ENTRY_COUNT(e),               DERIVED) \
    X(RAYS,        STORAGE, U32,             PROBES,  VOLUME, WORK,   RAY_COUNT(e),                 DERIVED) \
    X(SUMS,        STORAGE, F32X4,           PROBES,  VOLUME, WORK,   SUM_COUNT(e),                 SAVED)   \
    X(PREVIOUS,    STORAGE, F16X4,           PROBES,  VOLUME, WORK,   TEXEL_COUNT(e),               SAVED)   \
    X(COUNTERS,    STORAGE, U32,             LISTS,   VOLUME, WORK,   SDFGI_COUNTER_GATHER,         DERIVED) \
    X(INDIRECT,    STORAGE, U32X4,           LISTS,   VOLUME, WORK,   SDFGI_INDIRECT_RECORDS,       DERIVED) \
    X(BOUNDS,      STORAGE, U8,              LISTS,   VOLUME, WORK,   BOUNDS_BYTES,                 DERIVED) \
    X(MASKS,       STORAGE, U8,              VOLUMES, VOLUME, WORK,   e->cells * e->cascades,       DERIVED) \
    X(OCCLUSION,   STORAGE, U32,             PROBES,  VOLUME, WORK,   e->occlusion,                 DERIVED) \
    X(GATHERED,    STORAGE, U32,             LISTS,   VOLUME, WORK,   GATHERED_COUNT(e),            SAVED)   \
    X(EMITTERS,    STORAGE, U32,             VOLUMES, VOLUME, WORK,   EMITTER_COUNT(e),             DERIVED) \
    X(SEEN,        STORAGE, U32,             LISTS,   VOLUME, WORK,   SEEN_COUNT(e),                DERIVED) \
    X(SEARCH,      STORAGE, U32,             SCRATCH, VOLUME, WORK,   e->search,                    SCRATCH) \
    X(INSTANCES,   STORAGE, U8,              LISTS,   VOLUME, WORK,   INSTANCES_BYTES(e),           DERIVED) \
    X(DIRECT,      STORAGE, U32,             LISTS,   VOLUME, WORK,   DIRECT_COUNT(e),              DERIVED)
/* clang-format on */

#define ENTRY_COUNT(e)  ((e)->light_cells * (e)->cascades)
#define DIRECT_COUNT(e) (SDFGI_DIRECT_WORDS * ENTRY_COUNT(e))
/* None where light cells read probes alone; a binding needs a word. */
#define GATHERED_COUNT(e) \
    ((e)->gathers ? SDFGI_GATHERED_WORDS * ENTRY_COUNT(e) + SDFGI_COUNTER_COUNT - SDFGI_COUNTER_GATHER : 1)
#define SEEN_COUNT(e)                                                                            \
    ((e)->gathers                                                                                \
         ? sdfgi_seen_end((uint32_t)(e)->light_cells, (uint32_t)(e)->cascades, (e)->low_light) : 1)
/* None where nothing emits. */
#define EMITTER_COUNT(e) ((e)->emits ? (SDFGI_EMITTERS_STRIDE + 2 * (e)->blocks) * (e)->cascades : 1)
#define TEXEL_COUNT(e) (SDFGI_IRRADIANCE_COUNT * (e)->probes * (e)->cascades)
#define SUM_COUNT(e)   (SDFGI_SUMS_STRIDE * (e)->probes * (e)->cascades)
#define RAY_COUNT(e)   ((e)->probes * (e)->cascades * sdfgi_extent_probe_words(e))
#define BOUNDS_BYTES   (SDFGI_BOUNDS_BYTES * SDFGI_MAX_CASCADES)
#define INSTANCES_BYTES(e) \
    (SDFGI_MAX_DRAWS * sizeof(uint32_t) + (e)->instances * sizeof(struct sdfgi_instance_params))

enum resource {
#define RESOURCE_ENUM(id, kind, format, category, scope, set, extent, keep) RESOURCE_##id,
    SDFGI_RESOURCES(RESOURCE_ENUM)
#undef RESOURCE_ENUM
    RESOURCE_COUNT,
};

#endif
