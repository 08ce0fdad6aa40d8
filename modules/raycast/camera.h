/* SPDX-License-Identifier: MIT */
#ifndef RAYCAST_CAMERA_H
#define RAYCAST_CAMERA_H

#include "raycast.h"
#include "vec3.h"

/* A pinhole; pictures have their first row at the top. */
struct camera {
    double origin[3];               /* of the tracer's space, world */
    struct vec3 position;           /* in the tracer's space */
    struct vec3 forward, right, up; /* right and up reach to the edge of the picture at distance 1 */
};

void raycast_camera_init(struct camera *c, const struct raycast_camera *view, uint32_t width,
                         uint32_t height);

/* Direction through a point of the picture, x and y in [0, 1] from its top left corner. */
static inline struct vec3 camera_direction(const struct camera *c, float x, float y)
{
    return vec3_normalize(vec3_mad(vec3_mad(c->forward, c->right, 2.0f * x - 1.0f), c->up, 1.0f - 2.0f * y));
}

/* Metres along the viewing axis. */
static inline float camera_depth(const struct camera *c, struct vec3 position)
{
    return vec3_dot(vec3_sub(position, c->position), c->forward);
}

#endif
