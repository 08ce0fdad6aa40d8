/* SPDX-License-Identifier: MIT
 *
 * Lights without triangles: sun, point, spot, sky.
 */
#ifndef RAYCAST_LIGHTS_H
#define RAYCAST_LIGHTS_H

#include "environment.h"
#include "geometry.h"
#include "raycast.h"

struct gltf_scene;

enum lamp_type { LAMP_SUN, LAMP_POINT, LAMP_SPOT };

struct lamp {
    enum lamp_type type;
    struct vec3 position;  /* relative to the tracer's origin */
    struct vec3 direction; /* unit, the way the light travels */
    struct vec3 intensity; /* W/sr; sun: W/m^2 */
    float cos_inner, cos_outer;
    float radius_m;      /* point, spot */
    float range_m;       /* point, spot: no light beyond; INFINITY: unlimited */
    float one_minus_cos; /* sun: of half its apparent diameter; 0: a point */
};

/* Bands of equal solid angle over d.y: the sky's radiance depends on nothing else. */
#define SKY_BANDS 64

struct sky {
    struct vec3 zenith, horizon, ground;
    struct environment map; /* where there is one, in place of the colours */
    float cdf[SKY_BANDS];   /* upper ends */
    float mean_luminance;
};

struct lights {
    struct lamp *lamps;
    uint32_t lamp_count;
    bool has_discs; /* suns with an apparent size */
    struct sky sky;
};

/* Light that arrives at a point from one direction, if nothing is in the way. */
struct light_sample {
    struct vec3 direction; /* unit, towards the light */
    bool at_infinity;
    struct vec3 target;   /* where the way ends, unless at infinity */
    struct vec3 radiance; /* over pdf; lamps without size: irradiance facing the light, over its chance */
    float pdf;            /* per solid angle; 0: a light without size, which no other ray can meet */
};

bool raycast_lights_init(struct lights *l, const struct gltf_scene *scene, const struct raycast_view *view,
                         const double origin[3]);
void raycast_lights_finish(struct lights *l);

/* Choose a lamp in proportion to what it would give an unshadowed Lambertian point. `total` receives the sum
 * of these weights, which lights_sun_radiance needs. False: no lamp reaches this point. */
bool lights_sample(const struct lights *l, struct vec3 position, struct vec3 normal, struct random *r,
                   float *total, struct light_sample *out);

/* Radiance of the suns' discs in a direction, each weighted against the sampling of lights_sample from a
 * point with this `total`, for a direction chosen with density `pdf`. */
struct vec3 lights_sun_radiance(const struct lights *l, struct vec3 direction, float total, float pdf);

/* Fill in the cdf from the three colours, or the mean from the map. */
void sky_bands_build(struct sky *s);

struct vec3 sky_radiance(const struct sky *s, struct vec3 direction);
bool sky_is_black(const struct sky *s);

/* Density per solid angle of sky_sample. */
float sky_pdf(const struct sky *s, struct vec3 direction);
void sky_sample(const struct sky *s, struct random *r, struct light_sample *out);

/* Weight of a sample of density `a` where density `b` could have given it too: the power heuristic with
 * exponent 2 (Veach 1997). */
static inline float mis_weight(float a, float b)
{
    if (!isfinite(a))
        return 1.0f;
    const float ratio = b / a;
    return 1.0f / (1.0f + ratio * ratio);
}

#endif
