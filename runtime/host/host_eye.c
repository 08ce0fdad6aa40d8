/* SPDX-License-Identifier: MIT */
#include "host_internal.h"

void host_eye_begin(struct host_renderer *renderer, uint32_t eye)
{
    const double side = eye == 0 ? -0.5 : 0.5;
    renderer->eye = eye;
    renderer->camera = renderer->head;
    if (renderer->eye_count == HOST_EYES)
        host_camera_move_aside(&renderer->camera, side * (double)renderer->eye_distance_m);
}

struct host_eye *host_eye_here(struct host_renderer *renderer)
{
    return &renderer->targets.eyes[renderer->eye];
}

const struct host_slot_eye *host_slot_here(const struct host_renderer *renderer, const struct host_slot *slot)
{
    return &slot->eyes[renderer->eye];
}

/* Halves of a picture with an odd number of columns share the one in the middle. */
uint32_t host_eye_column(const struct host_renderer *renderer, uint32_t eye)
{
    return eye == 0 ? 0 : renderer->picture_width - renderer->width;
}

void host_eye_look(struct host_renderer *renderer, const struct host_camera *camera)
{
    host_camera_resolve(camera, (double)renderer->width / renderer->height, &renderer->head);
    renderer->camera = renderer->head;
}
