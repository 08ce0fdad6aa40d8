/* SPDX-License-Identifier: MIT
 * Metallic-roughness reflection: GGX with the height-correlated Smith term, Schlick's Fresnel, Lambert below.
 */

#include "../lib/ggx.glsl"

const float BRDF_PI = 3.14159265359;

struct brdf_surface {
    vec3 normal;
    vec3 view;    /* towards the viewer */
    vec3 diffuse; /* albedo of the Lambertian part */
    vec3 f0;
    float alpha;    /* roughness squared */
    float specular; /* 0 for pure Lambert, else 1 */
};

/* Share of light that the interface above the Lambertian part lets through. That part is dielectric whatever
 * the material's metalness, which only takes area from it; and the share depends on the view alone, so that
 * light from lamps and from everywhere is treated alike, here as in the references (Lambert times 1 - F). */
float brdf_diffuse_transmission(brdf_surface s)
{
    if (s.specular == 0.0)
        return 1.0;
    return 1.0 - sdfgi_ggx_dielectric(sdfgi_ggx_fresnel_weight(dot(s.normal, s.view)));
}

/* Factor on the lobe that gives back what facets send to one another (Turquin 2019, "Practical Multiple
 * Scattering Compensation for Microfacet Models"): the references have the same. */
vec3 brdf_compensation(brdf_surface s)
{
    const float lost = sdfgi_ggx_lost(max(dot(s.normal, s.view), 1e-2), s.alpha);
    return 1.0 + s.f0 * (lost / (1.0 - lost));
}

/* BRDF times the cosine, for unit directions with the light above the surface. */
vec3 brdf_evaluate(brdf_surface s, vec3 light)
{
    const float n_l = clamp(dot(s.normal, light), 0.0, 1.0);
    if (s.specular == 0.0)
        return s.diffuse * (n_l / BRDF_PI);
    const vec3 h = normalize(s.view + light);
    const float n_v = max(abs(dot(s.normal, s.view)), 1e-4);
    const vec3 fresnel = mix(s.f0, vec3(1.0), sdfgi_ggx_fresnel_weight(dot(s.view, h)));
    const vec3 diffuse = s.diffuse * (brdf_diffuse_transmission(s) / BRDF_PI);
    const float facets = sdfgi_ggx_facets(s.normal, h, n_v, n_l, s.alpha);
    return (diffuse + brdf_compensation(s) * fresnel * facets) * n_l;
}

/* Directional albedo of the specular lobe. White metal loses nothing. */
vec3 brdf_specular_albedo(brdf_surface s)
{
    const float n_v = max(dot(s.normal, s.view), 1e-2);
    const float kept = 1.0 - sdfgi_ggx_lost(n_v, s.alpha);
    return mix(s.f0, vec3(1.0), sdfgi_ggx_mean_fresnel_weight(n_v, s.alpha)) * kept * brdf_compensation(s);
}
