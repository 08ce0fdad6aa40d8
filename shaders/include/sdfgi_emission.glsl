/* SPDX-License-Identifier: MIT
 * The emission of surfaces: a value per albedo block (2^3 cells). */
#ifndef SDFGI_EMISSION_GLSL
#define SDFGI_EMISSION_GLSL

#include "sdfgi_space.glsl"
#include "../lib/rgbe.glsl"

const uint SDFGI_EMISSION_IS_BRIGHT = 0x40000000u;
const uint SDFGI_EMISSION_IS_LISTED = 0x80000000u; /* the block is in its cascade's list of emitters */

/* Nine bits are kept of 0.03 to SDFGI_EMISSION_MOST in the first unit, and of 5e-10 to 1 in the second. */
const float SDFGI_EMISSION_BRIGHT_UNIT = 2048.0, SDFGI_EMISSION_DIM_UNIT = 1.0 / 65536.0;

/* Index in buffers with one element per albedo block of all cascades. */
uint sdfgi_block_index(uint cascade, ivec3 cell)
{
    return sdfgi_albedo_block_index(cascade, cell) + cascade * sdfgi_albedo_block_count();
}

/* In units of stored emission. */
vec3 sdfgi_emission_radiance(uvec2 packed)
{
    return sdfgi_rgbe_decode(packed.x) * ((packed.y & SDFGI_EMISSION_IS_BRIGHT) != 0u
                                              ? SDFGI_EMISSION_BRIGHT_UNIT
                                              : SDFGI_EMISSION_DIM_UNIT);
}

/* Emitted radiance times exposure towards `axis`. */
vec3 sdfgi_block_emission(uint block, uint axis)
{
    const uvec2 packed = sdfgi_emission_at(block);
    return sdfgi_emission_radiance(packed) * (float(packed.y >> (5u * axis) & 31u) / 31.0) *
           sdfgi_frame.emission_scale;
}

#endif
