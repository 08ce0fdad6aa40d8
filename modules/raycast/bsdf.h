/* SPDX-License-Identifier: MIT
 *
 * Lambert * (1 - F) + GGX, F0 0.04 for dielectrics and the base colour for metals, Smith's height-correlated
 * masking. Schlick's F weighs the lobe at the half vector, and the Lambertian part at the view's angle: taken
 * at the half vector there too, as in glTF 2.0 appendix B, a white surface reflects 1.11 of a uniform sky at
 * a grazing 83 degrees, where the references made by another renderer have 0.63 and this form has 0.61.
 *
 * The lobe alone loses the light that goes from facet to facet: a white metal of roughness 1 reflects 0.31 of
 * a uniform sky at normal incidence. It is therefore multiplied by 1 + F0 (1 / E - 1), where E is the share
 * of uniform light that the lobe reflects towards the viewer with F = 1 (Turquin 2019, "Practical multiple
 * scattering compensation for microfacet models"). White metals then reflect all light. The factor does not
 * depend on where the light comes from, so the density of samples still follows the lobe.
 */
#ifndef RAYCAST_BSDF_H
#define RAYCAST_BSDF_H

#include "geometry.h"
#include "lobe.h"

/* A surface seen from one direction. */
struct bsdf {
    const struct surface *surface;
    struct frame frame;    /* around the shading normal */
    struct vec3 out_local; /* towards where the light leaves */
    struct vec3 diffuse;   /* albedo under the interface, as seen from there */
    struct vec3 gain;      /* of the glossy part */
    float diffuse_share;   /* probability of sampling the Lambertian part, [0, 1] */
};

struct bsdf_value {
    struct vec3 diffuse, specular; /* times the cosine of the incoming direction */
    float cosine;                  /* itself, at the shading normal */
    float pdf;                     /* with which bsdf_sample gives this direction, per solid angle */
};

/* `min_diffuse_share` keeps cosine sampling alive on mirrors, for what is measured before the BSDF. */
struct bsdf bsdf_make(const struct surface *surface, const struct lobe *lobe, struct vec3 towards_viewer,
                      float min_diffuse_share);

/* False when nothing is reflected: directions below either normal. */
bool bsdf_evaluate(const struct bsdf *b, struct vec3 incoming, struct bsdf_value *out);

/* Draws three numbers whatever the outcome. */
bool bsdf_sample(const struct bsdf *b, struct random *r, struct vec3 *incoming, struct bsdf_value *out);

#endif
