/* SPDX-License-Identifier: MIT
 * A light cell: outgoing radiance along six axes in 64 bits. x: RGB9E5 colour of the brightest axis. y: 5
 * bits per axis, its brightness relative to the brightest axis, and a valid bit. Axes: 0 +x, 1 -x, 2 +y, 3
 * -y, 4 +z, 5 -z.
 *
 * Both words are rounded by a hash of the cell. Rounding down would lose 0.9 % of the light per bounce, and
 * rounding to nearest would stall light that grows in small steps; a hash does neither on average over many
 * cells.
 *
 * Axes that are about as bright as the brightest share their mean brightness and keep weights of exactly 1.
 * If only the brightest had weight 1, a small gain of one axis would lower the rounded weights of all others,
 * and light in a furnace would never come to rest. */
#ifndef SDFGI_LIGHT_PACK_GLSL
#define SDFGI_LIGHT_PACK_GLSL

#include "random.glsl"
#include "rgbe.glsl"

float sdfgi_light_luminance(vec3 color)
{
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

/* An axis counts as bright as the brightest one if it is less than half a unit of a weight below it. */
const float SDFGI_LIGHT_AS_BRIGHT = 61.0 / 62.0;

/* Mean of the levels that are at least `least`. */
float sdfgi_light_mean_above(float levels[6], float least)
{
    float sum = 0.0, count = 0.0;
    for (int a = 0; a < 6; a++) {
        const float counts = float(levels[a] >= least);
        sum += counts * levels[a];
        count += counts;
    }
    return sum / count;
}

uvec2 sdfgi_light_pack(vec3 axes[6], uint hash)
{
    const float rounding = sdfgi_random_unit(hash);
    vec3 total = vec3(0.0);
    float levels[6], brightest = 0.0;
    for (int a = 0; a < 6; a++) {
        total += axes[a];
        levels[a] = sdfgi_light_luminance(axes[a]);
        brightest = max(brightest, levels[a]);
    }
    if (!(brightest > 0.0))
        return uvec2(0u, SDFGI_LIGHT_VALID);
    const float least = SDFGI_LIGHT_AS_BRIGHT * brightest, level = sdfgi_light_mean_above(levels, least);
    const vec3 base = total * (level / sdfgi_light_luminance(total));
    uint weights = 0u;
    for (int a = 0; a < 6; a++) {
        const uint weight = levels[a] >= least ? 31u : uint(levels[a] / level * 31.0 + rounding);
        weights |= min(weight, 31u) << (5 * a);
    }
    return uvec2(sdfgi_rgbe_encode_rounded(base, rounding), weights | SDFGI_LIGHT_VALID);
}

vec3 sdfgi_light_unpack_axis(uvec2 cell, uint axis)
{
    return sdfgi_rgbe_decode(cell.x) * (float(cell.y >> (5u * axis) & 31u) / 31.0);
}

#endif
