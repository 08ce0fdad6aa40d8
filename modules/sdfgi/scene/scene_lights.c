/* SPDX-License-Identifier: MIT
 * Lights and sky. */
#include "same.h"
#include "scene.h"
#include "scene_check.h"

static const char *light_problem(const struct sdfgi_light_desc *d)
{
    const bool aims = d->type == SDFGI_LIGHT_DIRECTIONAL || d->type == SDFGI_LIGHT_SPOT;
    if (d->type > SDFGI_LIGHT_SPOT)
        return "unknown type";
    if (!sdfgi_check_non_negative(d->intensity, 3) || !sdfgi_check_non_negative(&d->indirect_energy, 1) ||
        !sdfgi_check_non_negative(&d->range_m, 1))
        return "intensity, indirect_energy or range_m is negative or not finite";
    if (!sdfgi_check_finite_doubles(d->position, 3))
        return "position is not finite";
    if (aims && (!sdfgi_check_finite_floats(d->direction, 3) ||
                 (d->direction[0] == 0 && d->direction[1] == 0 && d->direction[2] == 0)))
        return "direction is zero or not finite";
    if (d->type == SDFGI_LIGHT_SPOT && !(d->inner_angle_rad >= 0 && d->inner_angle_rad < d->outer_angle_rad &&
                                         d->outer_angle_rad <= 1.5708f))
        return "angles do not satisfy 0 <= inner < outer <= pi/2";
    return NULL;
}

static void lights_changed(struct scene *scene)
{
    sdfgi_journal_note(scene->journals, JOURNAL_LIGHTS);
}

enum sdfgi_result sdfgi_scene_light_create(struct scene *scene, const struct sdfgi_light_desc *desc,
                                           sdfgi_light *out)
{
    const char *problem = light_problem(desc);
    if (problem)
        return sdfgi_message_invalid(&scene->backend->hooks, "sdfgi_light_create: %s", problem);
    uint32_t id;
    struct light *light = sdfgi_pool_add(&scene->lights, &scene->backend->hooks, &id);
    if (!light)
        return sdfgi_check_out_of_slots(scene, "sdfgi_light_create", SDFGI_MAX_LIGHTS);
    light->desc = *desc;
    lights_changed(scene);
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_light_update(struct scene *scene, sdfgi_light handle,
                                           const struct sdfgi_light_desc *desc)
{
    struct light *light = sdfgi_pool_get(&scene->lights, handle.id);
    if (!light)
        return sdfgi_check_unknown_handle(scene, "sdfgi_light_update", handle.id);
    const char *problem = light_problem(desc);
    if (problem)
        return sdfgi_message_invalid(&scene->backend->hooks, "sdfgi_light_update: %s", problem);
    if (sdfgi_same_light(&light->desc, desc))
        return SDFGI_OK;
    light->desc = *desc;
    lights_changed(scene);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_light_destroy(struct scene *scene, sdfgi_light handle)
{
    if (!sdfgi_pool_get(&scene->lights, handle.id))
        return sdfgi_check_unknown_handle(scene, "sdfgi_light_destroy", handle.id);
    sdfgi_pool_remove(&scene->lights, handle.id);
    lights_changed(scene);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_set_sky(struct scene *scene, const struct sdfgi_sky *sky)
{
    if (!sdfgi_check_non_negative(sky->zenith, 3) || !sdfgi_check_non_negative(sky->horizon, 3) ||
        !sdfgi_check_non_negative(sky->ground, 3))
        return sdfgi_message_invalid(&scene->backend->hooks,
                                     "sdfgi_set_sky: a radiance is negative or not finite");
    if (sdfgi_same_sky(&scene->sky, sky))
        return SDFGI_OK;
    scene->sky = *sky;
    sdfgi_journal_note(scene->journals, JOURNAL_SKY);
    return SDFGI_OK;
}
