/* SPDX-License-Identifier: MIT
 * Writes VIEW.json files: a camera with its sky and sun, as `sdfgi render --view` reads them. */
#ifndef SAMPLES_VIEW_FILE_H
#define SAMPLES_VIEW_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cglm/struct.h>

struct view_light {
    vec3s position;
    vec3s intensity; /* W/sr */
};

struct view {
    vec3s position, look_at;
    float yfov_deg;
    bool has_sky, has_sun;
    vec3s sky_zenith, sky_horizon, sky_ground; /* radiance; three equal ones are written as a uniform sky */
    vec3s sun_direction, sun_irradiance;       /* the way the light travels; W/m^2 */
    bool lambert;                              /* every base colour a pure diffuse albedo */
    const struct view_light *lights;
    uint32_t light_count;
};

/* Writes the file whole or not at all; false with one line in `error` on failure. */
bool view_save(const struct view *view, const char *path, char *error, size_t error_size);

struct walk_point {
    vec3s position, look_at;
};

/* Writes a camera path as `sdfgi walk --path` reads it. `view` names the VIEW.json in the same folder that
 * holds sky and sun. */
bool walk_save(const struct walk_point *points, uint32_t count, float speed_m_s, const char *view,
               const char *path, char *error, size_t error_size);

#endif
