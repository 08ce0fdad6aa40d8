/* SPDX-License-Identifier: MIT */
#include "bsdf.h"

#include "ggx.h"

/* Shading normals can face away from the viewer; microfacets need them not to. The normal is tilted until the
 * viewer is this far (as a cosine) above its horizon. */
#define MIN_VIEW_COSINE 0.01f

/* Of an interface of refractive index 1.5. */
#define DIELECTRIC_F0 0.04f

static struct vec3 fresnel(struct vec3 f0, float cosine)
{
    const float m = 1.0f - clamp01(cosine), m2 = m * m, m5 = m2 * m2 * m;
    return vec3_lerp(f0, vec3_splat(1.0f), m5);
}

static struct vec3 visible_normal(struct vec3 normal, struct vec3 towards_viewer)
{
    const float cosine = vec3_dot(normal, towards_viewer);
    if (cosine >= MIN_VIEW_COSINE)
        return normal;
    return vec3_normalize(vec3_mad(normal, towards_viewer, MIN_VIEW_COSINE - cosine));
}

/* Share of the reflected light that a guess at the view's Fresnel term gives to the Lambertian part. Neither
 * part is starved: the guess knows nothing about where the light is. */
static float guess_diffuse_share(const struct bsdf *b, float min_share)
{
    if (!b->surface->glossy)
        return 1.0f;
    const float specular = vec3_luminance(fresnel(b->surface->specular, b->out_local.z));
    const float diffuse = vec3_luminance(b->diffuse);
    if (!(diffuse > 0.0f))
        return min_share;
    return fmaxf(min_share, fminf(fmaxf(diffuse / (diffuse + specular), 0.1f), 0.9f));
}

/* 1 + F0 * (1 / E - 1), where E is the share that perfect facets reflect. */
static struct vec3 lobe_gain(const struct lobe *lobe, const struct surface *s, float cosine)
{
    const float lost_per_reflected = 1.0f / lobe_share(lobe, cosine, s->alpha) - 1.0f;
    return vec3_mad(vec3_splat(1.0f), s->specular, lost_per_reflected);
}

struct bsdf bsdf_make(const struct surface *surface, const struct lobe *lobe, struct vec3 towards_viewer,
                      float min_diffuse_share)
{
    struct vec3 n = surface->normal;
    if (surface->glossy)
        n = visible_normal(n, towards_viewer);
    struct bsdf b = { .surface = surface, .frame = frame_around(n) };
    b.out_local = frame_to_local(&b.frame, towards_viewer);
    b.diffuse = surface->diffuse;
    if (surface->glossy) {
        b.diffuse = vec3_scale(b.diffuse, 1.0f - fresnel(vec3_splat(DIELECTRIC_F0), b.out_local.z).x);
        b.gain = lobe_gain(lobe, surface, b.out_local.z);
    }
    b.diffuse_share = guess_diffuse_share(&b, min_diffuse_share);
    return b;
}

/* Adds the glossy part and its share of the sampling density. */
static void add_specular(const struct bsdf *b, struct vec3 in, struct bsdf_value *v)
{
    const struct vec3 out = b->out_local, h = vec3_normalize(vec3_add(in, out));
    const float alpha = b->surface->alpha, d = ggx_distribution(h, alpha);
    const float lambda_out = ggx_lambda(out, alpha), lambda_in = ggx_lambda(in, alpha);
    const struct vec3 f = vec3_mul(b->gain, fresnel(b->surface->specular, vec3_dot(out, h)));
    v->specular = vec3_scale(f, d / (4.0f * out.z * (1.0f + lambda_out + lambda_in)));
    /* Density of visible normals, over the Jacobian of the reflection 4 (out . h), which cancels. */
    const float pdf = d / (4.0f * out.z * (1.0f + lambda_out));
    v->pdf = b->diffuse_share * v->pdf + (1.0f - b->diffuse_share) * pdf;
}

bool bsdf_evaluate(const struct bsdf *b, struct vec3 incoming, struct bsdf_value *out)
{
    const struct vec3 in = frame_to_local(&b->frame, incoming);
    if (!(in.z > 0.0f) || !(vec3_dot(b->surface->geometric_normal, incoming) > 0.0f))
        return false;
    out->cosine = in.z;
    out->diffuse = vec3_scale(b->diffuse, in.z / VEC3_PI);
    out->specular = vec3_splat(0.0f);
    out->pdf = in.z / VEC3_PI;
    if (b->surface->glossy)
        add_specular(b, in, out);
    return out->pdf > 0.0f;
}

static struct vec3 sample_cosine(float u, float v)
{
    const float r = sqrtf(u), phi = 2.0f * VEC3_PI * v;
    return vec3_make(r * cosf(phi), r * sinf(phi), sqrtf(fmaxf(0.0f, 1.0f - u)));
}

static struct vec3 sample_specular(const struct bsdf *b, float u, float v)
{
    return ggx_mirrored(b->out_local, ggx_visible_normal(b->out_local, b->surface->alpha, u, v));
}

bool bsdf_sample(const struct bsdf *b, struct random *r, struct vec3 *incoming, struct bsdf_value *out)
{
    const float choice = random_float(r), u = random_float(r), v = random_float(r);
    const struct vec3 local = choice < b->diffuse_share ? sample_cosine(u, v) : sample_specular(b, u, v);
    *incoming = vec3_normalize(frame_to_world(&b->frame, local));
    return bsdf_evaluate(b, *incoming, out);
}
