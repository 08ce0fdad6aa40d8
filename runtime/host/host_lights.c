/* SPDX-License-Identifier: MIT
 * The scene's lights: those of the file, scaled, and those of the view. */
#include "host_internal.h"
#include "host_math.h"

#include <math.h>
#include <string.h>

/* Wider cones than this get a cube of shadow maps: one map would spend its texels on the rim. */
static const float widest_single_map_rad = 1.05f;

static void light_add(struct host_scene *scene, const struct host_light *light, float scale, float angle_rad)
{
    struct host_scene_light out = { .type = light->type, .range_m = light->range_m, .angle_rad = angle_rad };
    bool dark = true;
    for (int i = 0; i < 3; i++) {
        out.position[i] = light->position[i];
        out.direction[i] = (double)light->direction[i];
        out.intensity[i] = light->intensity[i] * scale;
        dark = dark && !(out.intensity[i] > 0.0f);
    }
    if (dark)
        return;
    host_normalize3(out.direction);
    memcpy(out.rest, out.direction, sizeof(out.rest));
    memcpy(out.steady, out.intensity, sizeof(out.steady));
    out.inner_rad = light->inner_rad;
    out.outer_rad = light->outer_rad;
    out.cube = light->type == HOST_LIGHT_POINT || light->outer_rad > widest_single_map_rad;
    if (light->type == HOST_LIGHT_DIRECTIONAL)
        scene->suns[scene->sun_count++] = out;
    else
        scene->lights[scene->light_count++] = out;
}

static void sun_add(struct host_scene *scene, const struct host_sun *sun)
{
    struct host_light light = { .type = HOST_LIGHT_DIRECTIONAL };
    memcpy(light.direction, sun->direction, sizeof(light.direction));
    memcpy(light.intensity, sun->irradiance, sizeof(light.intensity));
    light_add(scene, &light, 1.0f, sun->angle_rad);
}

static void file_light_add(struct host_scene *scene, const struct gltf_light *in, float scale)
{
    struct host_light light = { .range_m = in->range,
                                .inner_rad = in->inner_rad,
                                .outer_rad = in->outer_rad };
    light.type = in->type == GLTF_LIGHT_DIRECTIONAL ? HOST_LIGHT_DIRECTIONAL
                 : in->type == GLTF_LIGHT_SPOT      ? HOST_LIGHT_SPOT
                                                    : HOST_LIGHT_POINT;
    memcpy(light.position, in->position, sizeof(light.position));
    memcpy(light.direction, in->direction, sizeof(light.direction));
    memcpy(light.intensity, in->intensity, sizeof(light.intensity));
    light_add(scene, &light, scale, 0.0f);
}

static const double pi = 3.14159265358979323846;

static void turn_sun(struct host_scene_light *sun, double degrees)
{
    const double angle = degrees * (pi / 180.0), c = cos(angle), s = sin(angle);
    sun->direction[0] = c * sun->rest[0] - s * sun->rest[1];
    sun->direction[1] = s * sun->rest[0] + c * sun->rest[1];
}

/* Three waves of 3, 8 and 23 Hz at 60 frames a second, whose ratios are no simple fractions. Lamps differ by
 * 2 % in their pace, so that they soon differ in their light. */
static void flicker(struct host_scene_light *lamp, uint32_t index, double part, double frames)
{
    const double turn = 2.0 * pi * frames * (1.0 + 0.02 * index),
                 wave = sin(0.0503 * turn) + sin(0.1371 * turn) + sin(0.3877 * turn);
    for (int i = 0; i < 3; i++)
        lamp->intensity[i] = lamp->steady[i] * (float)fmax(1.0 + part * wave / 3.0, 0.0);
}

void host_scene_move_lights(struct host_scene *scene, const struct host_light_motion *motion, double frames)
{
    for (uint32_t i = 0; i < scene->sun_count; i++)
        turn_sun(&scene->suns[i], motion->turn_suns_deg * frames);
    for (uint32_t i = 0; i < scene->light_count; i++)
        flicker(&scene->lights[i], i, 0.01 * motion->flicker_percent, frames);
}

bool host_lights_init(struct host_scene *scene, const struct gltf_scene *gltf, const struct host_view *view)
{
    const size_t capacity = (size_t)gltf->light_count + view->light_count + 1;
    scene->suns = host_device_alloc(scene->device, capacity, sizeof(*scene->suns));
    scene->lights = host_device_alloc(scene->device, capacity, sizeof(*scene->lights));
    if (!scene->suns || !scene->lights)
        return false;
    if (view->sun.enabled)
        sun_add(scene, &view->sun);
    for (uint32_t i = 0; i < view->light_count; i++)
        light_add(scene, &view->lights[i], 1.0f, 0.0f);
    for (uint32_t i = 0; i < gltf->light_count; i++)
        file_light_add(scene, &gltf->lights[i], view->punctual_scale);
    if (scene->sun_count > HOST_MAX_SUNS)
        return host_fail(scene->device, "%u directional lights: the renderer has shadow maps for %d",
                         scene->sun_count, HOST_MAX_SUNS);
    scene->sky = view->sky;
    scene->fog = view->fog;
    return true;
}
