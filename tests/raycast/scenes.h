/* SPDX-License-Identifier: MIT
 * Scenes and views built in code, for the tests of the path tracer. */
#ifndef TESTS_RAYCAST_SCENES_H
#define TESTS_RAYCAST_SCENES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../../modules/gltf/gltf_scene.h"
#include "raycast.h"

enum { SCENE_CAPACITY = 16 };

/* A glTF scene with room to grow; nothing of it is shared between tests. */
struct built_scene {
    struct gltf_scene gltf;
    struct gltf_image images[SCENE_CAPACITY];
    struct gltf_texture textures[SCENE_CAPACITY];
    struct gltf_material materials[SCENE_CAPACITY];
    struct gltf_primitive primitives[SCENE_CAPACITY];
    struct gltf_instance instances[SCENE_CAPACITY];
    struct gltf_light lights[SCENE_CAPACITY];
};

void sdfgi_scene_init(struct built_scene *s);
void sdfgi_scene_finish(struct built_scene *s);

/* A rough dielectric of grey `albedo`, opaque and single-sided; change it before the scene is traced. */
struct gltf_material *scene_add_material(struct built_scene *s, float albedo);

/* A parallelogram from `corner` along `a` and `b`, front where a x b points, with the newest material; its uv
 * run from (0, 0) to (1, 1). */
void scene_add_quad(struct built_scene *s, const float corner[3], const float a[3], const float b[3]);

/* A level square of side 2 `half` at height `y`, front up (or down), centred on the Y axis. */
void scene_add_floor(struct built_scene *s, float y, float half, bool front_up);

/* A closed box around the origin, fronts inwards. */
void scene_add_room(struct built_scene *s, float half);

/* A texture of 8-bit RGBA, `width` x `height` (at most 4 texels), filtered nearest. Returns its index. */
int32_t scene_add_texture(struct built_scene *s, uint32_t width, uint32_t height, const uint8_t *rgba);

/* Camera at `position` looking at `target`, no light at all, glTF materials. */
struct raycast_view view_make(const double position[3], const double target[3], float yfov_deg);
void view_set_sky(struct raycast_view *v, float radiance);

/* A tracer that must come into being. */
struct raycast *tracer_create(const struct built_scene *s, const struct raycast_view *v,
                              const struct raycast_settings *settings);

/* Writes the state to a file; failing that the test fails. */
void state_save(const struct raycast *rc, const char *path);

/* Trace `spp` samples into a picture of width x height and return the mean over all its channels. */
double trace_mean(const struct built_scene *s, const struct raycast_view *v, uint32_t width, uint32_t height,
                  uint32_t spp, uint32_t max_bounces, enum raycast_aov aov);

/* Light at a point with its normal up. */
struct raycast_irradiance gather_up(const struct built_scene *s, const struct raycast_view *v, double x,
                                    double y, double z, uint32_t samples);

/* Fails unless |actual / expected - 1| <= tolerance; prints both. */
void assert_ratio(double actual, double expected, double tolerance);

#endif
