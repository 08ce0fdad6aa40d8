/* SPDX-License-Identifier: MIT
 * Everything the library has to say: one row per message, id, level and hint. Tests assert ids, never text.
 */
#ifndef SDFGI_MESSAGES_H
#define SDFGI_MESSAGES_H

/* X(id, level, hint): the hint says what to do about it. */
#define SDFGI_MESSAGES(X)                                                                                    \
    X(INVALID_ARGUMENT, ERROR, "a call broke a documented rule; the message names the field")                \
    X(INVALID_HANDLE, ERROR, "the object was destroyed or never created")                                    \
    X(INVALID_SETTING, ERROR, "see `sdfgi properties` for names and ranges")                                 \
    X(UNSUPPORTED_DEVICE, ERROR, "see sdfgi_get_requirements")                                               \
    X(OUT_OF_HOST_MEMORY, ERROR, "the host allocator returned NULL")                                         \
    X(OUT_OF_DEVICE_MEMORY, ERROR,                                                                           \
      "fewer cascades or a lower resolution need less; see sdfgi_estimate_memory")                           \
    X(DEVICE_LOST, ERROR, "destroy the context and create it on a new device")                               \
    X(VULKAN_FAILURE, ERROR, "a Vulkan call failed in a way that is none of the above")                      \
    X(NO_GEOMETRY, WARNING, "no instance touches any cascade")                                               \
    X(NO_LIGHTS, WARNING, "no light, no emission and no sky: everything is black")                           \
    X(LIGHT_CELLS_OVERFLOW, WARNING,                                                                         \
      "more surface cells than the light list may grow to: larger cells, or fewer surfaces")                 \
    X(TRIANGLES_SKIPPED, WARNING, "triangles with non-finite or out-of-range vertices were skipped")         \
    X(VALUE_CLAMPED, WARNING, "light between surfaces outgrew its formats and was cut")                      \
    X(BOUNCE_CLAMPED, WARNING, "albedo times feedback reached 0.99 and was clamped to stay contractive")     \
    X(TRACE_CAP_REACHED, WARNING, "rays ran out of steps and were counted as hits")                          \
    X(UNLIT_HITS, WARNING, "rays hit surfaces with no light cell nearby")                                    \
    X(UPDATE_LOST, WARNING, "a recorded update never ran; see sdfgi_cancel_update")                          \
    X(BOUNDS_MISS_VERTICES, WARNING,                                                                         \
      "triangles lie outside bounds_min and bounds_max of their mesh, where they may be missing")            \
    X(SURFACES_CROWDED, WARNING, "hundreds of surfaces lie in one another: their mean leaves some out")      \
    X(NO_EMITTER_LISTS, WARNING, "no memory for emission: what emits stays dark")                            \
    X(NO_ROUGH_LOBES, WARNING, "no memory for where light comes from: what is rough reflects irradiance")    \
    X(CREATED, INFO, "version and device")                                                                   \
    X(SWITCHED, INFO, "on or off, and how much memory the volumes take")                                     \
    X(FIRST_LIGHT, INFO, "lookups give light from this update on")                                           \
    X(SETTLED, INFO, "light changes no more until the scene does")

enum sdfgi_message {
#define SDFGI_MESSAGE_ENUM(id, level, hint) SDFGI_MESSAGE_##id,
    SDFGI_MESSAGES(SDFGI_MESSAGE_ENUM)
#undef SDFGI_MESSAGE_ENUM
        SDFGI_MESSAGE_COUNT,
};

#endif
