/* SPDX-License-Identifier: MIT */
#ifndef RAYCAST_CAMERA_H
#define RAYCAST_CAMERA_H

#include "raycast.h"
#include "vec3.h"

/* A pinhole, or an orthographic camera; pictures have their first row at the top. */
struct camera {
    double origin[3];               /* of the tracer's space, world */
    struct vec3 position;           /* in the tracer's space; orthographic: in the near plane */
    struct vec3 forward, right, up; /* right and up reach to the edge of the picture at distance 1, or of an
                                       orthographic one */
    bool orthographic;
    float near_m, length_m; /* orthographic: to the near plane, and from there to the far one */
};

void raycast_camera_init(struct camera *c, const struct raycast_camera *view, uint32_t width,
                         uint32_t height);

/* A ray through a point of the picture, x and y in [0, 1] from its top left corner. */
struct camera_ray {
    struct vec3 origin, direction; /* direction of unit length */
    float length_m;
};

static inline struct camera_ray camera_ray(const struct camera *c, float x, float y)
{
    const struct vec3 from = c->orthographic ? c->position : c->forward,
                      to = vec3_mad(vec3_mad(from, c->right, 2.0f * x - 1.0f), c->up, 1.0f - 2.0f * y);
    if (c->orthographic)
        return (struct camera_ray){ to, c->forward, c->length_m };
    return (struct camera_ray){ c->position, vec3_normalize(to), c->length_m };
}

/* Metres along the viewing axis. */
static inline float camera_depth(const struct camera *c, struct vec3 position)
{
    return c->near_m + vec3_dot(vec3_sub(position, c->position), c->forward);
}

#endif
