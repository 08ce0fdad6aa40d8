/* SPDX-License-Identifier: MIT */
#include "same.h"

static bool same_floats(const float *a, const float *b, int count)
{
    for (int i = 0; i < count; i++)
        if (a[i] != b[i])
            return false;
    return true;
}

static bool same_doubles(const double *a, const double *b, int count)
{
    for (int i = 0; i < count; i++)
        if (a[i] != b[i])
            return false;
    return true;
}

static bool same_texture(const struct sdfgi_texture *a, const struct sdfgi_texture *b)
{
    return a->view == b->view && a->layout == b->layout && same_floats(a->uv_transform, b->uv_transform, 6) &&
           a->address_u == b->address_u && a->address_v == b->address_v && a->decode_srgb == b->decode_srgb;
}

bool sdfgi_same_material(const struct sdfgi_material_desc *a, const struct sdfgi_material_desc *b)
{
    return same_floats(a->albedo, b->albedo, 3) && a->alpha == b->alpha &&
           same_floats(a->emission, b->emission, 3) && a->alpha_cutoff == b->alpha_cutoff &&
           a->double_sided_emission == b->double_sided_emission && a->smoothness == b->smoothness &&
           a->specular_albedo == b->specular_albedo && a->metallic == b->metallic &&
           same_texture(&a->albedo_texture, &b->albedo_texture) &&
           same_texture(&a->emission_texture, &b->emission_texture);
}

bool sdfgi_same_transform(const struct sdfgi_transform *a, const struct sdfgi_transform *b)
{
    return same_floats(a->basis, b->basis, 9) && same_doubles(a->translation, b->translation, 3);
}

bool sdfgi_same_reach(const struct sdfgi_light_desc *a, const struct sdfgi_light_desc *b)
{
    return a->type == b->type && same_doubles(a->position, b->position, 3) &&
           same_floats(a->direction, b->direction, 3) && a->range_m == b->range_m &&
           a->inner_angle_rad == b->inner_angle_rad && a->outer_angle_rad == b->outer_angle_rad &&
           a->casts_shadow == b->casts_shadow;
}

bool sdfgi_same_light(const struct sdfgi_light_desc *a, const struct sdfgi_light_desc *b)
{
    return sdfgi_same_reach(a, b) && same_floats(a->intensity, b->intensity, 3) &&
           a->indirect_energy == b->indirect_energy;
}

bool sdfgi_same_sky(const struct sdfgi_sky *a, const struct sdfgi_sky *b)
{
    return same_floats(a->zenith, b->zenith, 3) && same_floats(a->horizon, b->horizon, 3) &&
           same_floats(a->ground, b->ground, 3);
}

bool sdfgi_same_harmonics(const struct sdfgi_sky_harmonics *a, const struct sdfgi_sky_harmonics *b)
{
    for (int i = 0; i < 9; i++)
        if (!same_floats(a->coefficients[i], b->coefficients[i], 3))
            return false;
    return a->intensity == b->intensity && a->rotation_rad == b->rotation_rad;
}
