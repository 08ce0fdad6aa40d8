/* SPDX-License-Identifier: MIT
 * Pictures of what the library holds of the scene, from any camera: to see why light is as it is. A host that
 * only wants light needs none of this. Conventions as in sdfgi.h. */
#ifndef SDFGI_DEBUG_H
#define SDFGI_DEBUG_H

#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

/* X(id, name, text). Rays from the camera march through the cascades, and a view colours what they meet; but
 * REFLECTION_TIER colours what the host has drawn.
 *
 * RED TO GREEN  little to much: red, yellow, green
 * BLUE TO RED   little to much: blue, cyan, green, yellow, red
 * LIGHT         L / (1 + L), where L is light times sdfgi_debug_desc::exposure; irradiance as E / pi
 *
 * What a view cannot tell at a surface, because no light cell is in front of it say, is purple. */
#define SDFGI_DEBUG_VIEWS(X)                                                                                 \
    X(SOLID, "solid", "solid bits, brighter or darker by the face that the ray met")                         \
    X(DISTANCE, "distance", "way to the surface, blue to red from 0.1 to 1000 m by its logarithm")           \
    X(DISTANCE_SLICE, "distance_slice",                                                                      \
      "distance field in a plane before the camera, blue to red from 0 to 16 cells in bands of one; "        \
      "solid bits are white")                                                                                \
    X(CASCADE, "cascade", "cascade that answers: green, blue, orange, violet, cyan, yellow, pink, grey")     \
    X(STEPS, "steps", "steps of the ray, blue to red from 1 to 512 by their logarithm")                      \
    X(ALBEDO, "albedo", "albedo of the block of 2x2x2 cells that the ray met, on the side that it met")      \
    X(EMISSION, "emission", "light that the block emits towards the face that the ray met")                  \
    X(LIGHT, "light", "light that leaves the light cell before the surface, without emission")               \
    X(IRRADIANCE, "irradiance", "light that arrives at the light cell before the surface")                   \
    X(CONFIDENCE, "confidence", "rays behind what the light cell shows, red to green up to a gather cycle")  \
    X(AGE, "age", "visits of the light cell in its gather cycle, blue to red")                               \
    X(VISIBILITY, "visibility", "probes of its cage that the light cell sees, red to green")                 \
    X(PROBES_IRRADIANCE, "probes_irradiance", "probes as balls: light that arrives from each side")          \
    X(PROBES_STATE, "probes_state",                                                                          \
      "probes as balls, through walls too: green steady, yellow warming up, orange new, red dead; white "    \
      "poles: moved off its corner")                                                                         \
    X(LEAKS, "leaks",                                                                                        \
      "light in the air against light that the surface gathered: red more, as if through walls, blue less; " \
      "magenta: a probe near holds NaN or infinity, yellow: light was cut to fit its format")                \
    X(WOKE, "woke",                                                                                          \
      "what changed of late: red voxels of this frame, orange new light cells, yellow light cells whose "    \
      "lights changed, until their next full gather cycle")                                                  \
    X(REFLECTION_TIER, "reflection_tier",                                                                    \
      "how much rays count in reflections of what the host has drawn, red to green; blue: irradiance alone")

enum sdfgi_debug_view {
#define SDFGI_DEBUG_ENUM(id, name, text) SDFGI_DEBUG_##id,
    SDFGI_DEBUG_VIEWS(SDFGI_DEBUG_ENUM)
#undef SDFGI_DEBUG_ENUM
        SDFGI_DEBUG_VIEW_COUNT,
};

/* Stable lower-case name of a view, and what it shows in one line; NULL for what is no view. */
SDFGI_API const char *sdfgi_debug_view_name(enum sdfgi_debug_view view);
SDFGI_API const char *sdfgi_debug_view_text(enum sdfgi_debug_view view);
/* SDFGI_DEBUG_VIEW_COUNT if there is none of that name. */
SDFGI_API enum sdfgi_debug_view sdfgi_debug_view_find(const char *name);

/*   image    format                 layout on entry and exit   usage
 *   output   R16G16B16A16_SFLOAT    GENERAL                    STORAGE
 *
 * Colours are linear, from 0 to 1, with an alpha of 1. */
struct sdfgi_debug_desc {
    VkImageView output;
    uint32_t width, height;            /* pixels: 1 to the device's maxImageDimension2D */
    float inverse_view_projection[16]; /* as sdfgi_gather_desc has it; orthographic ones are fine */
    float background_depth;            /* depth of what is farthest: 1, or 0 for reversed depth */
    enum sdfgi_debug_view view;
    float exposure; /* factor on light before it is shown, >= 0; 0: the hint of the last sdfgi_update */
    float slice_m;  /* DISTANCE_SLICE: from the camera's near plane to the slice, >= 0; 0: a quarter of the
                       finest cascade */
    /* REFLECTION_TIER, which is purple without them: as in struct sdfgi_resolve_desc, and as large as the
     * output. Synchronisation is that of sdfgi_gather. Other views leave them alone. */
    VkImageView depth, normal, roughness;
    VkImageLayout input_layout;
};

/* Records a debug view into `cmd`, after sdfgi_update in the same queue. It shows what that update leaves,
 * and changes nothing. The output is made visible to later compute and fragment reads. Does nothing and
 * returns SDFGI_OK while GI is not active. The first call makes the pipeline of all views of volumes, and the
 * first one for REFLECTION_TIER that view's. */
SDFGI_API enum sdfgi_result sdfgi_debug_draw(sdfgi *gi, VkCommandBuffer cmd,
                                             const struct sdfgi_debug_desc *desc);

#ifdef __cplusplus
}
#endif
#endif
