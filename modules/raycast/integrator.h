/* SPDX-License-Identifier: MIT
 *
 * Light that leaves or reaches a point, estimated by one path.
 */
#ifndef RAYCAST_INTEGRATOR_H
#define RAYCAST_INTEGRATOR_H

#include "camera.h"
#include "geometry.h"
#include "lights.h"
#include "lobe.h"

struct integrator {
    struct geometry *seen; /* by the camera, and by the sun, point and spot lights of what the camera sees */
    struct geometry
        *geometry; /* what all other rays meet: `seen` itself, or what it looks like to a renderer */
    struct lights lights;
    struct lobe lobe; /* of glossy surfaces */
    uint32_t max_bounces;
    float sky_share;         /* of the samples for sky and emitters; set by integrator_start */
    float min_diffuse_share; /* at the first surface, see bsdf_make */
};

/* One estimate of the light at the first surface of a path. */
struct first_light {
    struct vec3 direct;              /* reflected, from sun, point and spot lights */
    struct vec3 diffuse, reflection; /* reflected, from everything else */
    struct vec3 irradiance;          /* arriving, from everything else */
};

/* One estimate for a camera ray. */
struct path_sample {
    struct vec3 emission; /* of what the camera sees itself, the sky included */
    struct first_light light;
    bool hit;
    struct vec3 position, normal, albedo;
};

/* Call once the other fields are set. */
void integrator_start(struct integrator *it);

void integrator_first_light(const struct integrator *it, const struct surface *s, struct vec3 towards_viewer,
                            struct random *r, uint64_t *rays, struct first_light *out);

void integrator_path(const struct integrator *it, const struct camera_ray *from, struct random *r,
                     uint64_t *rays, struct path_sample *out);

#endif
