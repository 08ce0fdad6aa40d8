/* SPDX-License-Identifier: MIT */
#include "scene_files.h"

#include <math.h>
#include <string.h>

#define check(condition)                                                                                     \
    do {                                                                                                     \
        if (!(condition))                                                                                    \
            fail_msg("the scene breaks a promise: %s", #condition);                                          \
    } while (0)

/* Unit vectors are stored in float: three roundings of 6e-8, and room for the squares. */
static const double unit_tolerance = 1e-6;

static bool is_unit(const float *v)
{
    const double length = sqrt((double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2]);
    return fabs(length - 1) < unit_tolerance;
}

static bool are_finite(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

static void vertices_check(const struct gltf_primitive *p)
{
    check(are_finite(p->positions, 3 * (size_t)p->vertex_count));
    check(are_finite(p->uv0, 2 * (size_t)p->vertex_count));
    check(p->uv1 == NULL || are_finite(p->uv1, 2 * (size_t)p->vertex_count));
    check(p->colors == NULL || are_finite(p->colors, 4 * (size_t)p->vertex_count));
    for (size_t i = 0; i < p->vertex_count; i++) {
        check(is_unit(p->normals + 3 * i));
        check(is_unit(p->tangents + 4 * i));
        check(fabsf(p->tangents[4 * i + 3]) == 1);
        for (int k = 0; k < 3; k++)
            check(p->positions[3 * i + k] >= p->bounds_min[k] && p->positions[3 * i + k] <= p->bounds_max[k]);
    }
}

static void texture_ref_check(const struct gltf_scene *s, const struct gltf_texture_ref *ref)
{
    check(ref->texture >= -1 && ref->texture < (int64_t)s->texture_count);
    check(ref->uv_set == 0 || ref->uv_set == 1);
    check(are_finite(ref->uv_transform, 6));
    if (ref->texture >= 0) {
        const int32_t image = s->textures[ref->texture].image;
        check(image >= 0 && image < (int64_t)s->image_count);
    }
}

static bool is_name(const char *name)
{
    return name == NULL || strlen(name) <= 255;
}

static void material_check(const struct gltf_scene *s, const struct gltf_material *m)
{
    check(is_name(m->name));
    check(isfinite(m->normal_scale) && isfinite(m->occlusion_strength));
    const float factors[] = { m->base_color[0], m->base_color[1], m->base_color[2], m->base_color[3],
                              m->metallic,      m->roughness,     m->alpha_cutoff };
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++)
        check(factors[i] >= 0 && factors[i] <= 1);
    for (int i = 0; i < 3; i++)
        check(m->emissive[i] >= 0 && isfinite(m->emissive[i]));
    texture_ref_check(s, &m->base_color_texture);
    texture_ref_check(s, &m->metallic_roughness_texture);
    texture_ref_check(s, &m->normal_texture);
    texture_ref_check(s, &m->occlusion_texture);
    texture_ref_check(s, &m->emissive_texture);
}

static void primitive_check(const struct gltf_scene *s, const struct gltf_primitive *p)
{
    check(p->index_count % 3 == 0 && p->index_count > 0);
    for (uint32_t i = 0; i < p->index_count; i++)
        check(p->indices[i] < p->vertex_count);
    check(p->material >= 0 && p->material < (int64_t)s->material_count);
    vertices_check(p);
    const struct gltf_material *const m = &s->materials[p->material];
    const struct gltf_texture_ref *const refs[] = { &m->base_color_texture, &m->metallic_roughness_texture,
                                                    &m->normal_texture, &m->occlusion_texture,
                                                    &m->emissive_texture };
    for (size_t i = 0; i < sizeof refs / sizeof *refs; i++)
        check(p->uv1 != NULL || refs[i]->texture < 0 || refs[i]->uv_set == 0);
}

static void light_check(const struct gltf_light *l)
{
    check(is_name(l->name));
    check(is_unit(l->direction));
    for (int i = 0; i < 3; i++)
        check(isfinite(l->position[i]) && l->intensity[i] >= 0);
    check(are_finite(l->intensity, 3) && isfinite(l->range) && l->range >= 0);
    if (l->type == GLTF_LIGHT_SPOT)
        check(l->inner_rad >= 0 && l->inner_rad < l->outer_rad && (double)l->outer_rad <= 1.5707963267948966);
}

static void transform_check(const double *m)
{
    for (int i = 0; i < 16; i++)
        check(isfinite(m[i]));
    check(m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1);
}

/* Axes of unit length, at right angles. */
static void rigid_check(const double *m)
{
    transform_check(m);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const double *const a = m + 4 * i, *const b = m + 4 * k;
            check(fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - (i == k)) < unit_tolerance);
        }
}

static void camera_check(const struct gltf_camera *c)
{
    check(is_name(c->name));
    rigid_check(c->transform);
    if (c->yfov_rad == 0)
        check(c->ymag > 0 && isfinite(c->ymag) && c->znear >= 0 && c->znear < c->zfar && isfinite(c->zfar));
    else
        check(c->yfov_rad > 0 && c->yfov_rad < 3.1415927f);
}

static void image_check(const struct gltf_image *image)
{
    check(image->width > 0 && image->height > 0 && image->texels != NULL);
    volatile uint8_t last = image->texels[4 * (size_t)image->width * image->height - 1];
    (void)last;
}

void scene_check(const struct gltf_scene *s)
{
    for (uint32_t i = 0; i < s->image_count; i++)
        image_check(&s->images[i]);
    for (uint32_t i = 0; i < s->texture_count; i++)
        check(s->textures[i].image >= -1 && s->textures[i].image < (int64_t)s->image_count);
    for (uint32_t i = 0; i < s->material_count; i++)
        material_check(s, &s->materials[i]);
    for (uint32_t i = 0; i < s->primitive_count; i++)
        primitive_check(s, &s->primitives[i]);
    for (uint32_t i = 0; i < s->instance_count; i++) {
        check(s->instances[i].primitive < s->primitive_count);
        transform_check(s->instances[i].transform);
    }
    for (uint32_t i = 0; i < s->light_count; i++)
        light_check(&s->lights[i]);
    for (uint32_t i = 0; i < s->camera_count; i++)
        camera_check(&s->cameras[i]);
    for (int i = 0; i < 3; i++)
        check(isfinite(s->bounds_min[i]) && isfinite(s->bounds_max[i]) &&
              s->bounds_min[i] <= s->bounds_max[i]);
    check(s->warning == NULL || strchr(s->warning, '\n') == NULL);
}
