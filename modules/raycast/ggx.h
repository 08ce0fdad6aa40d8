/* SPDX-License-Identifier: MIT
 *
 * The Trowbridge-Reitz (GGX) distribution of facets and Smith's masking. Directions are local: z along the
 * normal. `alpha` is the roughness squared.
 */
#ifndef RAYCAST_GGX_H
#define RAYCAST_GGX_H

#include "vec3.h"

/* Smoother than this (a lobe of a twentieth of a degree) single precision loses the distribution's peak. */
#define GGX_MIN_ALPHA 0.001f

/* Density of facet normals at half vector h. */
static inline float ggx_distribution(struct vec3 h, float alpha)
{
    const float x = h.x / alpha, y = h.y / alpha, e = x * x + y * y + h.z * h.z;
    return 1.0f / (VEC3_PI * alpha * alpha * e * e);
}

/* Smith's Lambda: masked facets per visible one. */
static inline float ggx_lambda(struct vec3 w, float alpha)
{
    const float z2 = w.z * w.z, tan2 = (w.x * w.x + w.y * w.y) / z2;
    return 0.5f * (sqrtf(1.0f + alpha * alpha * tan2) - 1.0f);
}

/* A facet normal visible from `out`: stretch to a hemisphere of unit roughness, take a point on the spherical
 * cap that the reflections of `out` cover, and shrink back (Dupuy and Benyoub 2023, "Sampling Visible GGX
 * Normals with Spherical Caps"). u and v are uniform in [0, 1). */
static inline struct vec3 ggx_visible_normal(struct vec3 out, float alpha, float u, float v)
{
    const struct vec3 o = vec3_normalize(vec3_make(out.x * alpha, out.y * alpha, out.z));
    const float phi = 2.0f * VEC3_PI * u, z = (1.0f - v) * (1.0f + o.z) - o.z;
    const float r = sqrtf(fmaxf(0.0f, 1.0f - z * z));
    const struct vec3 h = vec3_add(vec3_make(r * cosf(phi), r * sinf(phi), z), o);
    return vec3_normalize(vec3_make(h.x * alpha, h.y * alpha, h.z));
}

/* `out` mirrored at a facet. */
static inline struct vec3 ggx_mirrored(struct vec3 out, struct vec3 facet)
{
    return vec3_sub(vec3_scale(facet, 2.0f * vec3_dot(out, facet)), out);
}

#endif
