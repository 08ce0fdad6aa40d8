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

/* Share of even light that the lobe loses towards a viewer at cosine n_v where all Fresnel terms are 1: what
 * facets send to one another. A fit to quadrature of GGX with the height-correlated Smith term, within 0.4 %
 * of the share that is left. */
float brdf_lost(float n_v, float alpha)
{
    const float w2 = n_v * (1.0 + alpha) / (n_v + alpha), w = sqrt(w2);
    const float p0 = (((22.234367 * w - 61.307645) * w + 60.352630) * w - 25.384391) * w + 4.109031;
    const float p1 = (((-143.709702 * w + 393.553851) * w - 396.470660) * w + 175.587888) * w - 29.169027;
    const float p2 = (((340.274992 * w - 958.890693) * w + 1014.252800) * w - 481.791489) * w + 88.913657;
    const float p3 = (((-348.497532 * w + 1013.868940) * w - 1115.579900) * w + 552.758587) * w - 105.153300;
    const float p4 = (((131.955634 * w - 395.253320) * w + 448.694297) * w - 229.214931) * w + 44.557960;
    return clamp(w2 * ((((p4 * alpha + p3) * alpha + p2) * alpha + p1) * alpha + p0), 0.0, 0.9);
}

/* Factor on the lobe that gives back what facets send to one another (Turquin 2019, "Practical Multiple
 * Scattering Compensation for Microfacet Models"): the references have the same. */
vec3 brdf_compensation(brdf_surface s)
{
    const float lost = brdf_lost(max(dot(s.normal, s.view), 1e-2), s.alpha);
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
    const float n_h = clamp(dot(s.normal, h), 0.0, 1.0);
    const float a2 = s.alpha * s.alpha;
    /* 1 - n_h^2 as a cross product: the difference loses all digits near the peak of smooth surfaces. */
    const vec3 nxh = cross(s.normal, h);
    const float d = dot(nxh, nxh) + n_h * n_h * a2;
    const float distribution = a2 / (BRDF_PI * d * d);
    const float smith = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    const vec3 fresnel = mix(s.f0, vec3(1.0), brdf_fresnel_weight(dot(s.view, h)));
    const vec3 diffuse = s.diffuse * (brdf_diffuse_transmission(s) / BRDF_PI);
    return (diffuse + brdf_compensation(s) * fresnel * (distribution * 0.5 / max(smith, 1e-9))) * n_l;
}

/* The specular lobe sends f0 x + y of even light to the viewer: the split-sum approximation (Karis 2013,
 * "Real Shading in Unreal Engine 4"), as a fit (Karis 2014, "Physically Based Shading on Mobile"). */
vec2 brdf_split_sum(float roughness, float n_v)
{
    const vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    const float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

/* Directional albedo of the specular lobe. The fit gives the parts, and brdf_lost the sum: white metal loses
 * nothing. */
vec3 brdf_specular_albedo(brdf_surface s)
{
    const float n_v = max(dot(s.normal, s.view), 1e-2);
    const vec2 sums = brdf_split_sum(sqrt(s.alpha), n_v);
    const float kept = 1.0 - brdf_lost(n_v, s.alpha);
    return (s.f0 * sums.x + sums.y) * (kept / (sums.x + sums.y)) * brdf_compensation(s);
}
