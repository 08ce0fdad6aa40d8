/* SPDX-License-Identifier: MIT
 * Rays that go on from metal. What leaves light cells is diffuse light, but metal reflects what lies before
 * it: a ray that meets metal goes on in a direction of the metal's lobe, and brings what it meets there times
 * the metal's albedo. There metal counts as diffuse. */
#ifndef SDFGI_METAL_GLSL
#define SDFGI_METAL_GLSL

#include "surface.glsl"
#include "../lib/ggx.glsl"

/* Cell widths from the surface to where a ray goes on. At an angle to the axes a surface has steps, and the
 * ray begins beyond them: as if it stood there. */
const float METAL_CLEARANCE = 0.05;
const float METAL_SLANTED_CLEARANCE = 0.45;
/* Cosine between the normal and that of the face that was hit, from which on there are no steps. */
const float METAL_FLAT = 0.98;
/* Cosine between a ray and the surface, at least, for which it keeps to that. */
const float METAL_LEAST_COSINE = 0.3;
/* Cosine between the ray that goes on and the normal of the face that was hit, at least. */
const float METAL_LEAST_RISE = 0.02;
/* Alpha of the kinds of metal: of roughness up to 0.2, which is a mirror, up to 0.4, and beyond. */
const vec3 METAL_ALPHA = vec3(0.0, 0.09, 0.23);

/* Whether rays of reflections go on from metal. Where the scene has none, they would take longer for nothing.
 */
#ifdef SDFGI_METAL
const bool METAL = true;
#else
const bool METAL = false;
#endif

/* True for metal from which they go on. */
bool is_metal(uint block)
{
    return METAL && surface_metal(block) != 0u;
}

/* Where a ray goes on that has come along `dir` for `range` cell widths and has hit the face `axis` of a
 * block at `at`: on the way that it came. That is on its own side of all walls. */
vec3 metal_start(uint block, uint axis, vec3 at, vec3 dir, float range)
{
    const vec3 normal = surface_normal(block, axis);
    const float clearance = dot(normal, vec3(sdfgi_axis_direction(axis))) >= METAL_FLAT
                                ? METAL_CLEARANCE
                                : METAL_SLANTED_CLEARANCE;
    const float back = clearance / max(-dot(dir, normal), METAL_LEAST_COSINE);
    return at - sdfgi_cells_from_metric(dir) * min(back, range);
}

/* Its direction then. `point` in the unit square chooses it from the lobe, whose middle has y = 0. */
vec3 metal_direction(uint block, uint axis, vec3 dir, vec2 point)
{
    const float alpha = METAL_ALPHA[max(surface_metal(block), 1u) - 1u];
    const vec3 face = vec3(sdfgi_axis_direction(axis)),
               on = sdfgi_ggx_direction(surface_normal(block, axis), -dir, alpha, point);
    return normalize(on + max(2.0 * METAL_LEAST_RISE - 2.0 * dot(on, face), 0.0) * face);
}

#endif
