/* SPDX-License-Identifier: MIT
 * Settings and their table: names and ranges as in Godot's Environment.sdfgi_*, defaults that are physically
 * right. modules/sdfgi/properties.c holds one row per setting. */
#ifndef SDFGI_SETTINGS_H
#define SDFGI_SETTINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <sdfgi/version.h>

#ifdef __cplusplus
extern "C" {
#endif

enum sdfgi_y_scale { SDFGI_Y_SCALE_50 = 0, SDFGI_Y_SCALE_75 = 1, SDFGI_Y_SCALE_100 = 2 };
enum sdfgi_visibility { SDFGI_VISIBILITY_CELL_MASK = 0, SDFGI_VISIBILITY_PROBE_DEPTH = 1 };
enum sdfgi_surface_light { SDFGI_SURFACE_LIGHT_PROBES = 0, SDFGI_SURFACE_LIGHT_CELLS = 1 };
enum sdfgi_sdf_method { SDFGI_SDF_EXACT = 0, SDFGI_SDF_FLOOD = 1 };
enum sdfgi_voxelizer { SDFGI_VOXELIZER_COMPUTE = 0, SDFGI_VOXELIZER_RASTER = 1 };

/* Every field is a row of the table: `sdfgi properties` prints range, unit, cost and benefit of each. */
struct sdfgi_settings {
    bool enabled;                           /* sdfgi_enabled */
    bool use_occlusion;                     /* sdfgi_use_occlusion */
    bool read_sky_light;                    /* sdfgi_read_sky_light */
    float bounce_feedback;                  /* sdfgi_bounce_feedback, [0, 1.99] */
    uint32_t cascades;                      /* sdfgi_cascades, [1, 8] */
    float min_cell_size_m;                  /* sdfgi_min_cell_size, [0.01, 64] */
    enum sdfgi_y_scale y_scale;             /* sdfgi_y_scale */
    float energy;                           /* sdfgi_energy, [0, 100] */
    float normal_bias_cells;                /* sdfgi_normal_bias */
    float probe_bias_cells;                 /* sdfgi_probe_bias */
    uint32_t ray_count;                     /* sdfgi_ray_count, rays per probe and frame, [1, 128] */
    uint32_t frames_to_converge;            /* sdfgi_frames_to_converge, [1, 64] */
    uint32_t frames_to_update_lights;       /* sdfgi_frames_to_update_lights, [1, 16] */
    uint32_t resolution;                    /* sdfgi_resolution, cells along a side: 32, 64, 128 or 256 */
    enum sdfgi_visibility visibility;       /* sdfgi_visibility */
    enum sdfgi_sdf_method sdf_method;       /* sdfgi_sdf_method */
    enum sdfgi_voxelizer voxelizer;         /* sdfgi_voxelizer */
    enum sdfgi_surface_light surface_light; /* sdfgi_surface_light */
    uint32_t cell_rays;           /* sdfgi_cell_rays, rays per surface and gather cycle, [16, 2048] */
    uint32_t cell_rays_per_frame; /* sdfgi_cell_rays_per_frame, [1024, 16777216] */
    uint32_t max_scroll_cells;    /* sdfgi_max_scroll_cells_per_frame, [524288, 134217728] */
    float reflection_blend;       /* sdfgi_reflection_blend, roughness, [0, 1] */
    float reflection_end;         /* sdfgi_reflection_end, roughness, [0, 1] */
    bool rough_lobes;             /* sdfgi_rough_lobes */
};

enum sdfgi_property_type {
    SDFGI_PROPERTY_BOOL,
    SDFGI_PROPERTY_INT,
    SDFGI_PROPERTY_FLOAT,
    SDFGI_PROPERTY_ENUM
};

struct sdfgi_property_info {
    const char *name;
    enum sdfgi_property_type type;
    double default_value, minimum, maximum;
    const char *unit; /* "" for none */
    const char
        *choices; /* allowed values separated by commas, of enums in order of value; "" if any in range */
    const char *buys, *costs; /* what more of it buys and what it costs */
    bool recreates;           /* true: a change rebuilds everything; false: live */
    bool derived;             /* computed from others; setting it changes those */
    const char *description;
};

/* The defaults, disabled. */
SDFGI_API void sdfgi_settings_default(struct sdfgi_settings *settings);

/* Rows of the table in a fixed order; NULL past the end. */
SDFGI_API const struct sdfgi_property_info *sdfgi_property_get_info(uint32_t index);

/* Sets the property `name` from text ("true", "0.2", "75%" or a choice's name). On failure returns false,
 * leaves `settings` as they were, and writes one line into `error` (may be NULL) of `error_size` bytes. */
SDFGI_API bool sdfgi_settings_set(struct sdfgi_settings *settings, const char *name, const char *value,
                                  char *error, size_t error_size);

/* Value of a property as a number; NaN if there is no such property. Derived properties included. */
SDFGI_API double sdfgi_settings_get(const struct sdfgi_settings *settings, const char *name);

/* Same as text, as sdfgi_settings_set would take it. Returns false if there is no such property. */
SDFGI_API bool sdfgi_settings_format(const struct sdfgi_settings *settings, const char *name, char *text,
                                     size_t text_size);

/* True if every value is finite and in range; otherwise false and one line in `error` (may be NULL). */
SDFGI_API bool sdfgi_settings_validate(const struct sdfgi_settings *settings, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
