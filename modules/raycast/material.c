/* SPDX-License-Identifier: MIT */
#include "material.h"

/* IEC 61966-2-1. */
static float linear_from_srgb(float s)
{
    return s <= 0.04045f ? s / 12.92f : powf((s + 0.055f) / 1.055f, 2.4f);
}

void material_context_init(struct material_context *c, const struct gltf_scene *scene,
                           const struct raycast_view *view)
{
    c->scene = scene;
    c->mode = view->materials;
    c->emissive_scale = view->emissive_scale;
    for (int i = 0; i < 256; i++)
        c->srgb[i] = linear_from_srgb((float)i / 255.0f);
}

/* The importer's is the last one, without a name and with glTF's default values throughout. */
bool material_is_default(const struct gltf_scene *scene, int32_t index)
{
    const struct gltf_material *m = &scene->materials[index];
    const bool plain = m->name == NULL && m->metallic == 1.0f && m->roughness == 1.0f && !material_emits(m) &&
                       m->alpha_mode == GLTF_ALPHA_OPAQUE && !m->double_sided && !m->unlit;
    const bool white = m->base_color[0] == 1.0f && m->base_color[1] == 1.0f && m->base_color[2] == 1.0f;
    return (uint32_t)index + 1 == scene->material_count && plain && white &&
           m->base_color_texture.texture < 0 && m->metallic_roughness_texture.texture < 0 &&
           m->normal_texture.texture < 0;
}

struct gltf_material material_default(const struct gltf_scene *scene, int32_t index, const float albedo[3])
{
    struct gltf_material m = scene->materials[index];
    for (int k = 0; k < 3; k++)
        m.base_color[k] = albedo[k];
    m.metallic = 0.0f;
    return m;
}

/* A texel index on an axis of `size` texels, wrapped as the sampler says. */
static uint32_t wrap_texel(int64_t i, uint32_t size, enum gltf_wrap wrap)
{
    const int64_t n = size;
    if (wrap == GLTF_WRAP_CLAMP)
        return (uint32_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
    const int64_t period = wrap == GLTF_WRAP_MIRROR ? 2 * n : n;
    const int64_t m = ((i % period) + period) % period;
    return (uint32_t)(m < n ? m : 2 * n - 1 - m);
}

static struct rgba fetch(const struct material_context *c, const struct gltf_image *image, uint32_t x,
                         uint32_t y, bool srgb)
{
    const uint8_t *t = image->texels + 4 * ((size_t)y * image->width + x);
    if (srgb)
        return (struct rgba){ c->srgb[t[0]], c->srgb[t[1]], c->srgb[t[2]], (float)t[3] / 255.0f };
    return (struct rgba){ (float)t[0] / 255.0f, (float)t[1] / 255.0f, (float)t[2] / 255.0f,
                          (float)t[3] / 255.0f };
}

static struct rgba rgba_lerp(struct rgba a, struct rgba b, float t)
{
    return (struct rgba){ a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t,
                          a.a + (b.a - a.a) * t };
}

/* Keeps a coordinate inside what an index can hold; beyond 2^30 texels single precision has no fraction left.
 */
static float bounded(float x)
{
    return x > -0x1p30f ? x < 0x1p30f ? x : 0x1p30f : -0x1p30f;
}

static struct rgba sample_bilinear(const struct material_context *c, const struct gltf_texture *t, float u,
                                   float v, bool srgb)
{
    const struct gltf_image *image = &c->scene->images[t->image];
    const float x = bounded(u * (float)image->width - 0.5f), y = bounded(v * (float)image->height - 0.5f);
    const float fx = floorf(x), fy = floorf(y);
    const uint32_t x0 = wrap_texel((int64_t)fx, image->width, t->wrap_u);
    const uint32_t x1 = wrap_texel((int64_t)fx + 1, image->width, t->wrap_u);
    const uint32_t y0 = wrap_texel((int64_t)fy, image->height, t->wrap_v);
    const uint32_t y1 = wrap_texel((int64_t)fy + 1, image->height, t->wrap_v);
    const struct rgba top = rgba_lerp(fetch(c, image, x0, y0, srgb), fetch(c, image, x1, y0, srgb), x - fx);
    const struct rgba bottom =
        rgba_lerp(fetch(c, image, x0, y1, srgb), fetch(c, image, x1, y1, srgb), x - fx);
    return rgba_lerp(top, bottom, y - fy);
}

static struct rgba sample_nearest(const struct material_context *c, const struct gltf_texture *t, float u,
                                  float v, bool srgb)
{
    const struct gltf_image *image = &c->scene->images[t->image];
    const int64_t x = (int64_t)floorf(bounded(u * (float)image->width));
    const int64_t y = (int64_t)floorf(bounded(v * (float)image->height));
    return fetch(c, image, wrap_texel(x, image->width, t->wrap_u), wrap_texel(y, image->height, t->wrap_v),
                 srgb);
}

/* False when the material has no such texture. */
static bool sample(const struct material_context *c, const struct gltf_texture_ref *ref,
                   const struct material_point *p, bool srgb, struct rgba *out)
{
    if (ref->texture < 0 || c->scene->textures[ref->texture].image < 0)
        return false;
    const struct gltf_texture *t = &c->scene->textures[ref->texture];
    const float *uv = p->uv[ref->uv_set == 1], *m = ref->uv_transform;
    const float u = m[0] * uv[0] + m[1] * uv[1] + m[2], v = m[3] * uv[0] + m[4] * uv[1] + m[5];
    *out = t->mag_filter == GLTF_FILTER_NEAREST ? sample_nearest(c, t, u, v, srgb)
                                                : sample_bilinear(c, t, u, v, srgb);
    return true;
}

struct rgba material_base_color(const struct material_context *c, const struct gltf_material *m,
                                const struct material_point *p)
{
    struct rgba t = { 1.0f, 1.0f, 1.0f, 1.0f };
    sample(c, &m->base_color_texture, p, true, &t);
    return (struct rgba){ t.r * m->base_color[0] * p->color[0], t.g * m->base_color[1] * p->color[1],
                          t.b * m->base_color[2] * p->color[2], t.a * m->base_color[3] * p->color[3] };
}

float material_coverage(const struct material_context *c, const struct gltf_material *m,
                        const struct material_point *p)
{
    if (m->alpha_mode == GLTF_ALPHA_OPAQUE)
        return 1.0f;
    const float alpha = material_base_color(c, m, p).a;
    if (m->alpha_mode == GLTF_ALPHA_MASK)
        return alpha >= m->alpha_cutoff ? 1.0f : 0.0f;
    return clamp01(alpha);
}

struct vec3 material_emission(const struct material_context *c, const struct gltf_material *m,
                              const struct material_point *p)
{
    struct rgba t = { 1.0f, 1.0f, 1.0f, 1.0f };
    sample(c, &m->emissive_texture, p, true, &t);
    return vec3_scale(vec3_mul(vec3_load(m->emissive), vec3_make(t.r, t.g, t.b)), c->emissive_scale);
}

void material_roughness_metallic(const struct material_context *c, const struct gltf_material *m,
                                 const struct material_point *p, float *roughness, float *metallic)
{
    struct rgba t = { 1.0f, 1.0f, 1.0f, 1.0f };
    sample(c, &m->metallic_roughness_texture, p, false, &t);
    *roughness = clamp01(t.g * m->roughness);
    *metallic = clamp01(t.b * m->metallic);
}

bool material_tangent_normal(const struct material_context *c, const struct gltf_material *m,
                             const struct material_point *p, struct vec3 *normal)
{
    struct rgba t;
    if (!sample(c, &m->normal_texture, p, false, &t))
        return false;
    *normal = vec3_normalize(vec3_make((2.0f * t.r - 1.0f) * m->normal_scale,
                                       (2.0f * t.g - 1.0f) * m->normal_scale, 2.0f * t.b - 1.0f));
    return true;
}
