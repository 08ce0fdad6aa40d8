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

/* The mean of Schlick's weight over the lobe towards a viewer at cosine n_v, as the weight of a facet at a
 * mean cosine. A fit to quadrature of GGX as above: the directional albedo is within 1.2 % for an f0 of 0.04
 * and more and a roughness of 0.05 and more. */
float brdf_mean_fresnel_weight(float n_v, float alpha)
{
    const float r = sqrt(alpha), w = n_v * (1.0 + alpha) / (n_v + alpha);
    const float p0 = ((-3.1123 * w + 6.8462) * w - 1.8866) * w - 2.2530;
    const float p1 = ((26.3534 * w - 38.8747) * w + 10.6600) * w + 6.5418;
    const float p2 = ((-45.7241 * w + 61.3439) * w - 17.8969) * w - 5.4955;
    const float p3 = ((22.6039 * w - 29.3204) * w + 8.9432) * w + 1.4517;
    const float a2 = alpha * alpha, cosine = sqrt((n_v * n_v + a2) / (1.0 + a2));
    return brdf_fresnel_weight(cosine - alpha * (((p3 * r + p2) * r + p1) * r + p0));
}

/* Directional albedo of the specular lobe. White metal loses nothing. */
vec3 brdf_specular_albedo(brdf_surface s)
{
    const float n_v = max(dot(s.normal, s.view), 1e-2);
    const float kept = 1.0 - brdf_lost(n_v, s.alpha);
    return mix(s.f0, vec3(1.0), brdf_mean_fresnel_weight(n_v, s.alpha)) * kept * brdf_compensation(s);
}
