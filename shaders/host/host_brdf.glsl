/* SPDX-License-Identifier: MIT
 * Metallic-roughness reflection: GGX with the height-correlated Smith term, Schlick's Fresnel, Lambert below.
 */

const float BRDF_PI = 3.14159265359;
/* Of an interface of refractive index 1.5, as glTF has it. */
const float BRDF_DIELECTRIC_F0 = 0.04;

struct brdf_surface {
    vec3 normal;
    vec3 view;    /* towards the viewer */
    vec3 diffuse; /* albedo of the Lambertian part */
    vec3 f0;
    float alpha;    /* roughness squared */
    float specular; /* 0 for pure Lambert, else 1 */
};

float brdf_fresnel_weight(float cosine)
{
    const float x = clamp(1.0 - cosine, 0.0, 1.0);
    return x * x * x * x * x;
}

/* Share of light that the interface above the Lambertian part lets through. That part is dielectric whatever
 * the material's metalness, which only takes area from it; and the share depends on the view alone, so that
 * light from lamps and from everywhere is treated alike, here as in the references (Lambert times 1 - F). */
float brdf_diffuse_transmission(brdf_surface s)
{
    if (s.specular == 0.0)
        return 1.0;
    const float weight = brdf_fresnel_weight(dot(s.normal, s.view));
    return 1.0 - mix(BRDF_DIELECTRIC_F0, 1.0, weight);
}

/* BRDF times the cosine, for unit directions with the light above the surface. */
vec3 brdf_evaluate(brdf_surface s, vec3 light)
{
    const float n_l = clamp(dot(s.normal, light), 0.0, 1.0);
    if (s.specular == 0.0)
        return s.diffuse * (n_l / BRDF_PI);
    const vec3 h = normalize(s.view + light);
    const float n_v = max(abs(dot(s.normal, s.view)), 1e-4);
    const float n_h = clamp(dot(s.normal, h), 0.0, 1.0);
    const float a2 = s.alpha * s.alpha;
    /* 1 - n_h^2 as a cross product: the difference loses all digits near the peak of smooth surfaces. */
    const vec3 nxh = cross(s.normal, h);
    const float d = dot(nxh, nxh) + n_h * n_h * a2;
    const float distribution = a2 / (BRDF_PI * d * d);
    const float smith = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    const vec3 fresnel = mix(s.f0, vec3(1.0), brdf_fresnel_weight(dot(s.view, h)));
    const vec3 diffuse = s.diffuse * (brdf_diffuse_transmission(s) / BRDF_PI);
    return (diffuse + fresnel * (distribution * 0.5 / max(smith, 1e-9))) * n_l;
}

/* The specular lobe sends f0 x + y of even light to the viewer: the split-sum approximation (Karis 2013,
 * "Real Shading in Unreal Engine 4"), as a fit (Karis 2014, "Physically Based Shading on Mobile"). */
vec2 brdf_split_sum(float roughness, float n_v)
{
    const vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    const float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

/* Directional albedo of the specular lobe. Light that microfacets pass to one another is added as a lobe of
 * its own (Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"), so
 * that white metal loses none. */
vec3 brdf_specular_albedo(brdf_surface s)
{
    const vec2 sums = brdf_split_sum(sqrt(s.alpha), clamp(dot(s.normal, s.view), 0.0, 1.0));
    const vec3 once = s.f0 * sums.x + sums.y;
    const float rest = 1.0 - sums.x - sums.y;
    const vec3 mean_fresnel = s.f0 + (1.0 - s.f0) / 21.0;
    return once + rest * once * mean_fresnel / (1.0 - rest * mean_fresnel);
}
