/* SPDX-License-Identifier: MIT
 *
 * A hash of everything a picture depends on, field by field: padding and pointers have no say.
 */
#include <string.h>

#include "../gltf/gltf_scene.h"
#include "internal.h"
#include "random.h"

/* Changes when the same inputs begin to give other samples, so that old states are refused. */
#define METHOD_VERSION 3

uint64_t raycast_hash_bytes(uint64_t h, const void *bytes, size_t size)
{
    const uint8_t *b = bytes;
    for (size_t i = 0; i < size; i += sizeof(uint64_t)) {
        uint64_t word = 0;
        const size_t left = size - i;
        memcpy(&word, b + i, left < sizeof(word) ? left : sizeof(word));
        h = random_mix((h ^ word) + RANDOM_STEP);
    }
    return random_mix(h ^ size);
}

#define HASH(h, field) raycast_hash_bytes((h), &(field), sizeof(field))

static uint64_t hash_texture_ref(uint64_t h, const struct gltf_texture_ref *r)
{
    h = HASH(h, r->texture);
    h = HASH(h, r->uv_set);
    return HASH(h, r->uv_transform);
}

static uint64_t hash_material(uint64_t h, const struct gltf_material *m)
{
    const uint32_t flags[3] = { m->alpha_mode, m->double_sided, m->unlit };
    h = HASH(h, m->base_color);
    h = HASH(h, m->metallic);
    h = HASH(h, m->roughness);
    h = HASH(h, m->emissive);
    h = HASH(h, m->normal_scale);
    h = HASH(h, m->alpha_cutoff);
    h = HASH(h, flags);
    h = hash_texture_ref(h, &m->base_color_texture);
    h = hash_texture_ref(h, &m->metallic_roughness_texture);
    h = hash_texture_ref(h, &m->normal_texture);
    return hash_texture_ref(h, &m->emissive_texture);
}

static uint64_t hash_array(uint64_t h, const float *values, size_t count)
{
    return values != NULL ? raycast_hash_bytes(h, values, count * sizeof(*values)) : random_mix(h + 1);
}

static uint64_t hash_primitive(uint64_t h, const struct gltf_primitive *p)
{
    const size_t n = p->vertex_count;
    h = hash_array(h, p->positions, 3 * n);
    h = hash_array(h, p->normals, 3 * n);
    h = hash_array(h, p->tangents, 4 * n);
    h = hash_array(h, p->uv0, 2 * n);
    h = hash_array(h, p->uv1, 2 * n);
    h = hash_array(h, p->colors, 4 * n);
    h = raycast_hash_bytes(h, p->indices, p->index_count * sizeof(*p->indices));
    return HASH(h, p->material);
}

static uint64_t hash_images(uint64_t h, const struct gltf_scene *s)
{
    for (uint32_t i = 0; i < s->image_count; i++) {
        const struct gltf_image *image = &s->images[i];
        h = HASH(h, image->width);
        h = raycast_hash_bytes(h, image->texels, (size_t)4 * image->width * image->height);
    }
    for (uint32_t i = 0; i < s->texture_count; i++) {
        const struct gltf_texture *t = &s->textures[i];
        const int32_t fields[4] = { t->image, (int32_t)t->wrap_u, (int32_t)t->wrap_v,
                                    (int32_t)t->mag_filter };
        h = HASH(h, fields);
    }
    return h;
}

static uint64_t hash_gltf_light(uint64_t h, const struct gltf_light *l)
{
    const uint32_t type = l->type;
    h = HASH(h, type);
    h = HASH(h, l->position);
    h = HASH(h, l->direction);
    h = HASH(h, l->intensity);
    h = HASH(h, l->range);
    h = HASH(h, l->inner_rad);
    return HASH(h, l->outer_rad);
}

static uint64_t hash_scene(uint64_t h, const struct gltf_scene *s)
{
    h = hash_images(h, s);
    for (uint32_t i = 0; i < s->material_count; i++)
        h = hash_material(h, &s->materials[i]);
    for (uint32_t i = 0; i < s->primitive_count; i++)
        h = hash_primitive(h, &s->primitives[i]);
    for (uint32_t i = 0; i < s->instance_count; i++) {
        h = HASH(h, s->instances[i].primitive);
        h = HASH(h, s->instances[i].transform);
    }
    for (uint32_t i = 0; i < s->light_count; i++)
        h = hash_gltf_light(h, &s->lights[i]);
    return h;
}

static uint64_t hash_view_light(uint64_t h, const struct raycast_light *l)
{
    const uint32_t type = l->type;
    h = HASH(h, type);
    h = HASH(h, l->position);
    h = HASH(h, l->direction);
    h = HASH(h, l->intensity);
    h = HASH(h, l->inner_deg);
    h = HASH(h, l->outer_deg);
    h = HASH(h, l->range_m);
    return HASH(h, l->radius_m);
}

static uint64_t hash_view(uint64_t h, const struct raycast_view *v)
{
    const uint32_t materials = v->materials;
    h = HASH(h, v->camera.position);
    h = HASH(h, v->camera.look_at);
    h = HASH(h, v->camera.up);
    h = HASH(h, v->camera.yfov_deg);
    if (v->camera.ymag_m > 0.0f) {
        h = HASH(h, v->camera.ymag_m);
        h = HASH(h, v->camera.znear_m);
        h = HASH(h, v->camera.zfar_m);
    }
    h = HASH(h, v->sky);
    if (v->environment.rgb) {
        h = HASH(h, v->environment.width);
        h = raycast_hash_bytes(h, v->environment.rgb,
                               3 * sizeof(float) * v->environment.width * v->environment.height);
    }
    h = HASH(h, v->sun);
    for (uint32_t i = 0; i < v->light_count; i++)
        h = hash_view_light(h, &v->lights[i]);
    h = HASH(h, v->punctual_scale);
    h = HASH(h, v->emissive_scale);
    h = HASH(h, materials);
    return HASH(h, v->default_albedo);
}

static uint64_t hash_cascade(uint64_t h, const struct raycast_cascade *c)
{
    const size_t cells = (size_t)c->resolution * c->resolution * c->resolution;
    h = HASH(h, c->low_m);
    h = HASH(h, c->cell_m);
    h = raycast_hash_bytes(h, c->bits, cells * sizeof(*c->bits));
    for (size_t i = 0; i < cells / 8; i++) {
        const struct raycast_block *b = &c->blocks[i];
        h = HASH(h, b->emission);
        h = HASH(h, b->albedo);
        h = HASH(h, b->emitting);
        h = HASH(h, b->slopes);
    }
    return h;
}

static uint64_t hash_voxels(uint64_t h, const struct raycast_voxels *v)
{
    h = HASH(h, v->cascade_count);
    for (uint32_t i = 0; i < v->cascade_count && i < RAYCAST_MAX_CASCADES; i++)
        h = hash_cascade(h, &v->cascades[i]);
    return h;
}

uint64_t raycast_hash_inputs(const struct gltf_scene *scene, const struct raycast_view *view,
                             const struct raycast_settings *s)
{
    const uint32_t size[5] = { s->width, s->height, s->max_bounces, s->aovs, s->cull_back_faces };
    uint64_t h = hash_view(hash_scene(METHOD_VERSION, scene), view);
    h = HASH(h, size);
    if (s->voxels != NULL)
        h = hash_voxels(h, s->voxels);
    return HASH(h, s->seed);
}
