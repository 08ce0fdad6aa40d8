/* SPDX-License-Identifier: MIT */
#include "bsdf.h"

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

struct bsdf bsdf_make(const struct surface *surface, struct vec3 towards_viewer, float min_diffuse_share)
{
    struct vec3 n = surface->normal;
    if (surface->glossy)
        n = visible_normal(n, towards_viewer);
    struct bsdf b = { .surface = surface, .frame = frame_around(n) };
    b.out_local = frame_to_local(&b.frame, towards_viewer);
    b.diffuse = surface->diffuse;
    if (surface->glossy)
        b.diffuse = vec3_scale(b.diffuse, 1.0f - fresnel(vec3_splat(DIELECTRIC_F0), b.out_local.z).x);
    b.diffuse_share = guess_diffuse_share(&b, min_diffuse_share);
    return b;
}

/* Trowbridge-Reitz distribution of facet normals at local half vector h. */
static float distribution(struct vec3 h, float alpha)
{
    const float x = h.x / alpha, y = h.y / alpha, e = x * x + y * y + h.z * h.z;
    return 1.0f / (VEC3_PI * alpha * alpha * e * e);
}

/* Smith's Lambda: masked facets per visible one. */
static float lambda(struct vec3 w, float alpha)
{
    const float z2 = w.z * w.z, tan2 = (w.x * w.x + w.y * w.y) / z2;
    return 0.5f * (sqrtf(1.0f + alpha * alpha * tan2) - 1.0f);
}

/* Adds the glossy part and its share of the sampling density. */
static void add_specular(const struct bsdf *b, struct vec3 in, struct bsdf_value *v)
{
    const struct vec3 out = b->out_local, h = vec3_normalize(vec3_add(in, out));
    const float alpha = b->surface->alpha, d = distribution(h, alpha);
    const float lambda_out = lambda(out, alpha), lambda_in = lambda(in, alpha);
    const struct vec3 f = fresnel(b->surface->specular, vec3_dot(out, h));
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

/* A facet normal visible from `out`: stretch to a hemisphere of unit roughness, take a point on the spherical
 * cap that the reflections of `out` cover, and shrink back (Dupuy and Benyoub 2023, "Sampling Visible GGX
 * Normals with Spherical Caps"). */
static struct vec3 sample_visible_normal(struct vec3 out, float alpha, float u, float v)
{
    const struct vec3 o = vec3_normalize(vec3_make(out.x * alpha, out.y * alpha, out.z));
    const float phi = 2.0f * VEC3_PI * u, z = (1.0f - v) * (1.0f + o.z) - o.z;
    const float r = sqrtf(fmaxf(0.0f, 1.0f - z * z));
    const struct vec3 h = vec3_add(vec3_make(r * cosf(phi), r * sinf(phi), z), o);
    return vec3_normalize(vec3_make(h.x * alpha, h.y * alpha, h.z));
}

static struct vec3 sample_specular(const struct bsdf *b, float u, float v)
{
    const struct vec3 out = b->out_local, h = sample_visible_normal(out, b->surface->alpha, u, v);
    return vec3_sub(vec3_scale(h, 2.0f * vec3_dot(out, h)), out);
}

bool bsdf_sample(const struct bsdf *b, struct random *r, struct vec3 *incoming, struct bsdf_value *out)
{
    const float choice = random_float(r), u = random_float(r), v = random_float(r);
    const struct vec3 local = choice < b->diffuse_share ? sample_cosine(u, v) : sample_specular(b, u, v);
    *incoming = vec3_normalize(frame_to_world(&b->frame, local));
    return bsdf_evaluate(b, *incoming, out);
}
