/* SPDX-License-Identifier: MIT */
#ifndef RAYCAST_INTERNAL_H
#define RAYCAST_INTERNAL_H

#include "camera.h"
#include "film.h"
#include "integrator.h"
#include "raycast.h"

struct gltf_scene;

struct raycast {
    struct raycast_settings settings;
    struct camera camera;
    struct integrator integrator;
    struct film film;
    uint64_t rays, not_finite; /* since creation */
    uint64_t identity;         /* hash of all that the sums depend on */
};

/* Mix bytes into a hash. */
uint64_t raycast_hash_bytes(uint64_t h, const void *bytes, size_t size);

/* Of everything a picture depends on but the number of samples and threads. */
uint64_t raycast_hash_inputs(const struct gltf_scene *scene, const struct raycast_view *view,
                             const struct raycast_settings *settings);

/* Writes one line that says what is wrong; false, for the caller to return. */
bool raycast_fail(char *error, size_t error_size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* One line naming the field that is wrong, or true. */
bool raycast_view_check(const struct raycast_view *view, char *error, size_t error_size);
bool raycast_settings_check(const struct raycast_settings *s, char *error, size_t error_size);

#endif
