/* SPDX-License-Identifier: MIT */
#include "scene_check.h"

#include <math.h>
#include <stdio.h>

static bool all_zero(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (v[i] != 0)
            return false;
    return true;
}

static void check_address(struct problem *p, const char *texture, const char *field,
                          VkSamplerAddressMode mode)
{
    if (mode != VK_SAMPLER_ADDRESS_MODE_REPEAT && mode != VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT &&
        mode != VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE)
        sdfgi_problem_add(p, "%s.%s is %d, must be REPEAT, MIRRORED_REPEAT or CLAMP_TO_EDGE", texture, field,
                          (int)mode);
}

static void check_texture(struct problem *p, const char *name, const struct sdfgi_texture *texture)
{
    char field[64];
    snprintf(field, sizeof field, "%s.uv_transform", name);
    sdfgi_problem_floats(p, field, texture->uv_transform, 6, -INFINITY, INFINITY);
    check_address(p, name, "address_u", texture->address_u);
    check_address(p, name, "address_v", texture->address_v);
}

struct problem sdfgi_check_material(const struct sdfgi_material_desc *d)
{
    struct problem p = { "" };
    sdfgi_problem_floats(&p, "albedo", d->albedo, 3, 0, 1);
    sdfgi_problem_floats(&p, "emission", d->emission, 3, 0, INFINITY);
    sdfgi_problem_floats(&p, "alpha", &d->alpha, 1, 0, 1);
    sdfgi_problem_floats(&p, "alpha_cutoff", &d->alpha_cutoff, 1, 0, 1);
    sdfgi_problem_floats(&p, "smoothness", &d->smoothness, 1, 0, 1);
    sdfgi_problem_floats(&p, "specular_albedo", &d->specular_albedo, 1, 0, 1);
    sdfgi_problem_floats(&p, "metallic", &d->metallic, 1, 0, 1);
    check_texture(&p, "albedo_texture", &d->albedo_texture);
    check_texture(&p, "emission_texture", &d->emission_texture);
    return p;
}

/* ---- Instances, lights, sky */

struct problem sdfgi_check_transform(const struct sdfgi_transform *t)
{
    struct problem p = { "" };
    sdfgi_problem_floats(&p, "transform.basis", t->basis, 9, -INFINITY, INFINITY);
    sdfgi_problem_finite(&p, "transform.translation", t->translation, 3);
    if (all_zero(t->basis, 9))
        sdfgi_problem_add(&p, "transform.basis is 0: nothing is left of the mesh. The identity is "
                              "1, 0, 0, 0, 1, 0, 0, 0, 1");
    return p;
}

static void check_angles(struct problem *p, const struct sdfgi_light_desc *d)
{
    sdfgi_problem_floats(p, "inner_angle_rad", &d->inner_angle_rad, 1, 0, 1.5708f);
    sdfgi_problem_floats(p, "outer_angle_rad", &d->outer_angle_rad, 1, 0, 1.5708f);
    if (!(d->inner_angle_rad < d->outer_angle_rad))
        sdfgi_problem_add(p, "outer_angle_rad is %g, must be more than inner_angle_rad = %g",
                          (double)d->outer_angle_rad, (double)d->inner_angle_rad);
}

struct problem sdfgi_check_light(const struct sdfgi_light_desc *d)
{
    struct problem p = { "" };
    if (d->type > SDFGI_LIGHT_SPOT)
        sdfgi_problem_add(&p, "type is %d, must be one of enum sdfgi_light_type", (int)d->type);
    sdfgi_problem_floats(&p, "intensity", d->intensity, 3, 0, INFINITY);
    sdfgi_problem_floats(&p, "indirect_energy", &d->indirect_energy, 1, 0, INFINITY);
    sdfgi_problem_floats(&p, "range_m", &d->range_m, 1, 0, INFINITY);
    sdfgi_problem_finite(&p, "position", d->position, 3);
    if (d->type != SDFGI_LIGHT_POINT) {
        sdfgi_problem_floats(&p, "direction", d->direction, 3, -INFINITY, INFINITY);
        if (all_zero(d->direction, 3))
            sdfgi_problem_add(&p, "direction is 0, must be the way that the light travels");
    }
    if (d->type == SDFGI_LIGHT_SPOT)
        check_angles(&p, d);
    return p;
}

struct problem sdfgi_check_sky(const struct sdfgi_sky *sky)
{
    struct problem p = { "" };
    sdfgi_problem_floats(&p, "zenith", sky->zenith, 3, 0, INFINITY);
    sdfgi_problem_floats(&p, "horizon", sky->horizon, 3, 0, INFINITY);
    sdfgi_problem_floats(&p, "ground", sky->ground, 3, 0, INFINITY);
    return p;
}

struct problem sdfgi_check_harmonics(const struct sdfgi_sky_harmonics *h)
{
    struct problem p = { "" };
    for (int i = 0; i < 9; i++)
        sdfgi_problem_floats(&p, "coefficients", h->coefficients[i], 3, -INFINITY, INFINITY);
    sdfgi_problem_floats(&p, "intensity", &h->intensity, 1, 0, INFINITY);
    sdfgi_problem_floats(&p, "rotation_rad", &h->rotation_rad, 1, -INFINITY, INFINITY);
    return p;
}

struct problem sdfgi_check_box(const double box_min[static 3], const double box_max[static 3])
{
    struct problem p = { "" };
    for (int i = 0; i < 3; i++)
        if (!(box_min[i] <= box_max[i]))
            sdfgi_problem_add(&p, "box_min[%d] is %g, must be at most box_max[%d] = %g", i, box_min[i], i,
                              box_max[i]);
    return p;
}

/* ---- Handles */

enum sdfgi_result sdfgi_check_out_of_slots(const struct scene *scene, const char *what, uint32_t limit)
{
    sdfgi_message_log(&scene->backend->hooks, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY,
                      "%s: out of host memory, more than %u of them, or no handle left", what, limit);
    return SDFGI_ERROR_OUT_OF_MEMORY;
}

enum sdfgi_result sdfgi_check_unknown_handle(const struct scene *scene, const char *what, uint32_t id)
{
    sdfgi_message_log(&scene->backend->hooks, SDFGI_MESSAGE_INVALID_HANDLE, "%s: no object with handle %u",
                      what, id);
    return SDFGI_ERROR_INVALID_ARGUMENT;
}
