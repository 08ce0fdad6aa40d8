/* SPDX-License-Identifier: MIT
 * The lobe of rough surfaces: GGX with alpha = roughness^2. */
#ifndef SDFGI_GGX_GLSL
#define SDFGI_GGX_GLSL

/* Facets are chosen from a spherical cap about the viewer's direction in a space where the surface's facets
 * face all ways alike (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"). Of the
 * part below the horizon this share is kept, for a viewer at cosine n_v: most of what would send light into
 * the surface is cut off (Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections"). */
float sdfgi_ggx_kept_below(float n_v, float alpha)
{
    const float s = 1.0 + sqrt(max(1.0 - n_v * n_v, 0.0)), s2 = s * s, a2 = alpha * alpha;
    return n_v > 0.0 ? (1.0 - a2) * s2 / (s2 + a2 * n_v * n_v) : 1.0;
}

/* The direction in which a facet that the viewer sees reflects him; `point` in the unit square chooses the
 * facet. */
vec3 sdfgi_ggx_reflected(vec3 normal, vec3 to_eye, float alpha, vec2 point)
{
    const vec3 side =
        normalize(abs(normal.y) < 0.9 ? vec3(-normal.z, 0.0, normal.x) : vec3(0.0, normal.z, -normal.y));
    const mat3 basis = mat3(side, cross(normal, side), normal);
    const vec3 view = normalize(to_eye) * basis;
    const vec3 stretched = normalize(vec3(view.xy * alpha, max(view.z, 1e-3)));
    const float low = sdfgi_ggx_kept_below(view.z, alpha) * stretched.z, turn = 6.2831853 * point.x,
                z = (1.0 - point.y) * (1.0 + low) - low;
    const vec3 cap = vec3(sqrt(clamp(1.0 - z * z, 0.0, 1.0)) * vec2(cos(turn), sin(turn)), z) + stretched;
    const vec3 facet = normalize(vec3(cap.xy * alpha, max(cap.z, 1e-6)));
    return basis * reflect(-view, facet);
}

/* A facet may send light into the surface: its neighbours send it out again. */
vec3 sdfgi_ggx_above(vec3 dir, vec3 normal)
{
    const float rise = dot(dir, normal);
    return normalize(dir + (max(abs(rise), 1e-3) - rise) * normal);
}

vec3 sdfgi_ggx_direction(vec3 normal, vec3 to_eye, float alpha, vec2 point)
{
    return sdfgi_ggx_above(sdfgi_ggx_reflected(normal, to_eye, alpha, point), normal);
}

/* Of an interface of refractive index 1.5, as glTF has it. */
const float SDFGI_GGX_DIELECTRIC_F0 = 0.04;

/* Schlick's weight: the Fresnel term is mix(f0, 1, weight). */
float sdfgi_ggx_fresnel_weight(float cosine)
{
    const float x = clamp(1.0 - cosine, 0.0, 1.0);
    return x * x * x * x * x;
}

/* Schlick's Fresnel term of a dielectric, from his weight. */
float sdfgi_ggx_dielectric(float weight)
{
    return mix(SDFGI_GGX_DIELECTRIC_F0, 1.0, weight);
}

/* Share of what a facet sends out that no other facet hides, for cosines of the viewer and of the light to
 * the normal: the height-correlated Smith term over what the viewer sees. */
float sdfgi_ggx_unhidden(float n_v, float n_l, float alpha)
{
    const vec2 cosines2 = vec2(n_v * n_v, n_l * n_l), alpha2 = vec2(alpha * alpha);
    const vec2 slopes = sqrt(1.0 + alpha2 * (1.0 - cosines2) / cosines2);
    return (1.0 + slopes.x) / (slopes.x + slopes.y);
}

/* GGX's facets that reflect light into a viewer's direction, for unit vectors: their distribution times the
 * share that no other facet hides, over four cosines' product. Without Fresnel's term. 1 - n_h^2 as a cross
 * product: the difference loses all digits near the peak of smooth surfaces. */
float sdfgi_ggx_facets(vec3 normal, vec3 half_way, float n_v, float n_l, float alpha)
{
    const float n_h = clamp(dot(normal, half_way), 0.0, 1.0), a2 = alpha * alpha;
    const vec3 nxh = cross(normal, half_way);
    const float d = dot(nxh, nxh) + n_h * n_h * a2,
                smith = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    return a2 / (3.14159265359 * d * d) * 0.5 / max(smith, 1e-9);
}

/* Share of the cap that is left for a viewer at a cosine above 0. */
float sdfgi_ggx_kept(float n_v, float alpha)
{
    const float below = n_v * inversesqrt(mix(alpha * alpha, 1.0, n_v * n_v));
    return (1.0 + sdfgi_ggx_kept_below(n_v, alpha) * below) / (1.0 + below);
}

/* Share of even light that the lobe loses towards a viewer at cosine n_v where all Fresnel terms are 1: what
 * facets send to one another. A fit to quadrature of GGX with the height-correlated Smith term, within 0.4 %
 * of the share that is left. */
float sdfgi_ggx_lost(float n_v, float alpha)
{
    const float w2 = n_v * (1.0 + alpha) / (n_v + alpha), w = sqrt(w2);
    const float p0 = (((22.234367 * w - 61.307645) * w + 60.352630) * w - 25.384391) * w + 4.109031;
    const float p1 = (((-143.709702 * w + 393.553851) * w - 396.470660) * w + 175.587888) * w - 29.169027;
    const float p2 = (((340.274992 * w - 958.890693) * w + 1014.252800) * w - 481.791489) * w + 88.913657;
    const float p3 = (((-348.497532 * w + 1013.868940) * w - 1115.579900) * w + 552.758587) * w - 105.153300;
    const float p4 = (((131.955634 * w - 395.253320) * w + 448.694297) * w - 229.214931) * w + 44.557960;
    return clamp(w2 * ((((p4 * alpha + p3) * alpha + p2) * alpha + p1) * alpha + p0), 0.0, 0.9);
}

/* The mean of Schlick's weight over the lobe towards a viewer at cosine n_v, as the weight of a facet at a
 * mean cosine. A fit to quadrature of GGX as above: the directional albedo is within 1.2 % for an f0 of 0.04
 * and more and a roughness of 0.05 and more. */
float sdfgi_ggx_mean_fresnel_weight(float n_v, float alpha)
{
    const float r = sqrt(alpha), w = n_v * (1.0 + alpha) / (n_v + alpha);
    const float p0 = ((-3.1123 * w + 6.8462) * w - 1.8866) * w - 2.2530;
    const float p1 = ((26.3534 * w - 38.8747) * w + 10.6600) * w + 6.5418;
    const float p2 = ((-45.7241 * w + 61.3439) * w - 17.8969) * w - 5.4955;
    const float p3 = ((22.6039 * w - 29.3204) * w + 8.9432) * w + 1.4517;
    const float a2 = alpha * alpha, cosine = sqrt((n_v * n_v + a2) / (1.0 + a2));
    return sdfgi_ggx_fresnel_weight(cosine - alpha * (((p3 * r + p2) * r + p1) * r + p0));
}

#endif
