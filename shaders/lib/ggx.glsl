/* SPDX-License-Identifier: MIT
 * The lobe of rough surfaces: GGX with alpha = roughness^2. */
#ifndef SDFGI_GGX_GLSL
#define SDFGI_GGX_GLSL

/* The direction in which a facet that the viewer sees reflects him; `point` in the unit square chooses the
 * facet. Visible facets of GGX (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
 */
vec3 sdfgi_ggx_direction(vec3 normal, vec3 to_eye, float alpha, vec2 point)
{
    const vec3 side =
        normalize(abs(normal.y) < 0.9 ? vec3(-normal.z, 0.0, normal.x) : vec3(0.0, normal.z, -normal.y));
    const mat3 basis = mat3(side, cross(normal, side), normal);
    const vec3 view = normalize(to_eye) * basis;
    const vec3 stretched = normalize(vec3(view.xy * alpha, max(view.z, 1e-3)));
    const float turn = 6.2831853 * point.x, z = (1.0 - point.y) * (1.0 + stretched.z) - stretched.z;
    const vec3 cap = vec3(sqrt(clamp(1.0 - z * z, 0.0, 1.0)) * vec2(cos(turn), sin(turn)), z) + stretched;
    const vec3 facet = normalize(vec3(cap.xy * alpha, max(cap.z, 1e-6)));
    const vec3 dir = reflect(-view, facet);
    /* A facet may send light into the surface: its neighbours send it out again. */
    return normalize(basis * vec3(dir.xy, max(abs(dir.z), 1e-3)));
}

/* Schlick's Fresnel term of a dielectric of refractive index 1.5, for 1 less the cosine. */
float sdfgi_ggx_fresnel(float rest)
{
    const float rest2 = rest * rest;
    return 0.04 + 0.96 * rest2 * rest2 * rest;
}

/* The mean of that over the directions of the lobe that a viewer at `cosine` from the normal sees. A fit to
 * quadrature, within 5 % up to alpha = 0.56. */
float sdfgi_ggx_mean_fresnel(float cosine, float alpha)
{
    const float alpha2 = 1.076 * alpha * alpha;
    const float raised = sqrt((cosine * cosine + alpha2) / (1.0 + alpha2));
    const float mixed = 1.1228 * alpha / (alpha + 0.3265) * (1.0 - 0.6272 * sqrt(cosine));
    return sdfgi_ggx_fresnel(mix(1.0 - raised, 0.6751, mixed));
}

#endif
