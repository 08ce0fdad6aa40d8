/* SPDX-License-Identifier: MIT
 * One row per buffer and image of a context that is switched on: allocation, names, the memory estimate and report,
 * bindings and barriers follow from it.
 *
 * X(id, category, size, lifetime)
 *   size      bytes, from `const struct extent *s`: elements of one cascade, cascades, samples in a ring
 *   lifetime  what it holds is valid ...
 * All but FRAME, a uniform buffer, are storage buffers, bound in this order
 * (shaders/shared/bindings.h).
 */
#ifndef SDFGI_RESOURCE_TABLE_H
#define SDFGI_RESOURCE_TABLE_H

/* clang-format off */
#define SDFGI_BUFFERS(X)                                                                                        \
    X(FRAME,       LISTS,   sizeof(struct sdfgi_frame_params),                    "rewritten when anything in it changes") \
    X(LIGHTS,      LISTS,   SDFGI_MAX_LIGHTS * sizeof(struct sdfgi_light_params), "rewritten when a light changes")        \
    X(MATERIALS,   LISTS,   SDFGI_MAX_MATERIALS * sizeof(struct sdfgi_material_params), "rewritten when a material changes") \
    X(BITS,        VOLUMES, 8 * s->cells * s->cascades,                           "until the cascade moves or its geometry changes") \
    X(DISTANCE,    VOLUMES, 2 * s->cells * s->cascades,                           "as BITS")                               \
    X(SCRATCH,     SCRATCH, s->scratch,                                           "one generation of one cascade")         \
    X(ALBEDO,      VOLUMES, 4 * s->blocks * s->cascades,                          "as BITS")                               \
    X(EMISSION,    VOLUMES, 8 * s->blocks * s->cascades,                          "as BITS")                               \
    X(NORMALS,     VOLUMES, 4 * s->blocks * s->cascades,                          "as BITS")                               \
    X(LIGHT,       VOLUMES, 8 * s->cells * s->cascades,                           "relit while not converged; emissive bits during generation") \
    X(LIGHT_CELLS, LISTS,   12 * s->light_cells * s->cascades,                    "as BITS; direct light until a light changes; grows")  \
    X(MASKS,       VOLUMES, s->cells * s->cascades,                               "as BITS")                               \
    X(PROBES,      PROBES,  4 * s->probes * s->cascades,                          "as BITS")                               \
    X(RAYS,        PROBES,  4 * s->probes * s->cascades * s->ring_samples,        "until any cascade it may reach changes") \
    X(SUMS,        PROBES,  16 * SDFGI_SUMS_STRIDE * s->probes * s->cascades,     "one ring")                              \
    X(PREVIOUS,    PROBES,  8 * 25 * s->probes * s->cascades,                     "until the ring after it ends")          \
    X(OCCLUSION,   PROBES,  s->occlusion,                                         "as BITS; 4 bytes unless probe_depth is chosen") \
    X(IRRADIANCE,  PROBES,  8 * 25 * s->probes * s->cascades,                     "what lookups read: until the next frame that blends") \
    X(COUNTERS,    LISTS,   4 * SDFGI_COUNTER_COUNT,                              "one ring or one generation")            \
    X(INDIRECT,    LISTS,   16 * SDFGI_INDIRECT_RECORDS,                          "as LIGHT_CELLS")                        \
    X(BOUNDS,      LISTS,   SDFGI_BOUNDS_BYTES * SDFGI_MAX_CASCADES,             "from the start of a change to its end")
/* clang-format on */

enum resource {
#define RESOURCE_ENUM(id, category, size, lifetime) RESOURCE_##id,
    SDFGI_BUFFERS(RESOURCE_ENUM)
#undef RESOURCE_ENUM
    RESOURCE_COUNT,
};

#endif
