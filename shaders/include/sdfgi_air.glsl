/* SPDX-License-Identifier: MIT
 * Light at a point of the air from all directions, for media. The cage and the probes that count are found
 * once; each probe then gives the mean over its directions, and its irradiance in one. */
#ifndef SDFGI_AIR_GLSL
#define SDFGI_AIR_GLSL

#include "sdfgi_lookup.glsl"

/* Cell widths of room around a point that will do. */
#define SDFGI_AIR_ROOM 2.0
/* Steps along each axis of a point with less. */
#define SDFGI_AIR_STEPS 3u

/* Radiance, W/(m^2 sr). */
struct sdfgi_air_light {
    vec3 mean;    /* over all directions */
    vec3 towards; /* over the hemisphere about a direction, weighted by the cosine: E / pi of a small surface
                   */
    float known;  /* 0 to 1; 0: no probe is seen, as inside of walls, and mean and towards are 0 */
};

/* Two lights of a cascade times exposure and weight, and their weights. */
struct sdfgi_air_sums {
    vec4 mean, towards;
};

/* The texels of a probe's octahedral map that lie on the axes. */
uvec2 sdfgi_air_axis_texel(uint axis)
{
    const uint last = uint(SDFGI_IRRADIANCE_TEXELS - 1), middle = last / 2u;
    if (axis >> 1u == 1u)
        return uvec2((axis & 1u) == 0u ? middle : last);
    const uint end = (axis & 1u) == 0u ? last : 0u;
    return axis >> 1u == 0u ? uvec2(end, middle) : uvec2(middle, end);
}

/* The mean of a probe's light over all directions: that of its irradiance over pi, which six axes give
 * without error up to the third order of spherical harmonics. */
vec4 sdfgi_air_mean_of_probe(uint probe_index)
{
    vec4 sum = vec4(0.0);
    for (uint axis = SDFGI_FIRST; axis < 6u; axis++) {
        const uvec2 at = sdfgi_air_axis_texel(axis);
        const uint index =
            probe_index * uint(SDFGI_IRRADIANCE_COUNT) + at.x + uint(SDFGI_IRRADIANCE_TEXELS) * at.y;
        const sdfgi_irradiance_texel texel =
            sdfgi_irradiance_unpack(sdfgi_half4_decode(sdfgi_irradiance_texels_at(index)));
        sum += vec4(texel.light, texel.confidence);
    }
    return sum / 6.0;
}

/* Where to look for probes from. Near a wall, and more so in a corner, there is too little room around a
 * point to see one for sure. It then walks away from what is near, a cell at a time and through empty cells
 * alone. */
vec3 sdfgi_air_find_room(uint cascade, vec3 pos)
{
    ivec3 cell = ivec3(floor(pos));
    if (sdfgi_free_radius(cascade, pos) > SDFGI_AIR_ROOM || !sdfgi_cell_is_empty(cascade, cell))
        return pos;
    for (uint i = 0u; i < 3u * SDFGI_AIR_STEPS; i++) {
        const ivec3 unit = sdfgi_axis_direction(2u * (i % 3u));
        const float ahead = sdfgi_cell_distance(cascade, cell + unit),
                    behind = sdfgi_cell_distance(cascade, cell - unit);
        const ivec3 next = cell + unit * int(sign(ahead - behind));
        if (sdfgi_cell_is_empty(cascade, next))
            cell = next;
    }
    return vec3(cell) + 0.5;
}

sdfgi_air_sums sdfgi_air_cascade(uint cascade, vec3 pos, vec3 direction)
{
    const ivec3 cage = sdfgi_cage_of(cascade, pos);
    const uint around = sdfgi_probes_around(cascade, cage, sdfgi_air_find_room(cascade, pos));
    sdfgi_air_sums sums = sdfgi_air_sums(vec4(0.0), vec4(0.0));
    for (int k = int(SDFGI_FIRST); k < 8; k++) {
        if ((around >> k & 1u) == 0u)
            continue;
        const ivec3 probe = cage + sdfgi_cage_corner(k);
        const vec4 mean = sdfgi_air_mean_of_probe(sdfgi_probe_index(cascade, probe));
        const sdfgi_irradiance_texel towards = sdfgi_irradiance_of_probe(cascade, probe, direction);
        const float weight = sdfgi_probe_weight(sdfgi_probe_trilinear(cage, k, pos), vec3(0.0), direction),
                    facing = sdfgi_probe_weight_at(cascade, cage, k, pos, direction);
        sums.mean += vec4(mean.rgb, 1.0) * (weight * mean.a);
        sums.towards += vec4(towards.light, 1.0) * (facing * towards.confidence);
    }
    return sums;
}

/* Both lights times exposure, of all cascades and of what lies beyond them. See sdfgi_lookup. */
sdfgi_air_light sdfgi_air_lookup(vec3 pos_first, vec3 direction)
{
    sdfgi_air_light result = sdfgi_air_light(vec3(0.0), vec3(0.0), 0.0);
    float rest = 1.0, outside = 1.0;
    for (uint c = 0u; c < sdfgi_frame.cascade_count && rest > 0.0; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, pos_first);
        const float weight = sdfgi_lookup_cascade_weight(c, pos);
        if (weight <= 0.0)
            continue;
        outside *= 1.0 - weight;
        const sdfgi_air_sums sums = sdfgi_air_cascade(c, pos, direction);
        if (min(sums.mean.a, sums.towards.a) <= 1e-6)
            continue;
        result.mean += rest * weight * sums.mean.rgb / sums.mean.a;
        result.towards += rest * weight * sums.towards.rgb / sums.towards.a;
        rest *= 1.0 - weight;
    }
    result.mean += outside * sdfgi_sky_everywhere();
    result.towards += outside * sdfgi_sky_around(direction);
    result.known = 1.0 - rest + outside;
    const float scale = result.known > 1e-3 ? 1.0 / result.known : 0.0;
    result.mean *= scale;
    result.towards *= scale;
    return result;
}

#endif
