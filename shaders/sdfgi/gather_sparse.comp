/* SPDX-License-Identifier: MIT
 * Indirect diffuse irradiance of a whole picture, from lookups at every second or fourth pixel along each
 * axis: the samples. A workgroup makes a tile of the picture, in three parts.
 *
 * 1. Each thread looks up one sample. The samples around the tile are among them, so that tiles need nothing
 *    of each other.
 * 2. Pixels interpolate the samples at the corners of their square. A sample counts as far as it lies in the
 *    pixel's plane and faces as the pixel does.
 * 3. Pixels that no interpolation is good for are looked up as well: those of things and edges that fall
 *    between samples, and those around which samples differ much. Light thus never crosses an edge.
 *
 * The order of the list of part 3 varies from run to run, but no result depends on it. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../lib/on_cpu.glsl"
#include "picture_gather.glsl"

layout(local_size_x = SDFGI_SAMPLES_X, local_size_y = SDFGI_SAMPLES_Y) in;

/* Samples with less weight are left out, because they may be as bright as they like. */
#define LEAST_WEIGHT 0.02
/* Pixels whose samples together have less weight are looked up. Half a square of samples is enough, one
 * corner of four is not: on its way to the pixel a thin wall may lie. */
#define ENOUGH_WEIGHT 0.4
/* Pixels are looked up if samples differ by more than this part of the brightest. Neighbouring samples on one
 * surface differ by a few per cent, since a light cell is many pixels wide at any distance. */
#define MOST_CONTRAST 0.25

const uint SAMPLES = SDFGI_SAMPLES_X * SDFGI_SAMPLES_Y;
/* Squares between samples, and pixels of the largest tile. */
const ivec2 SQUARES = ivec2(SDFGI_SAMPLES_X - 1, SDFGI_SAMPLES_Y - 1);
const uint MOST_PIXELS = uint(SQUARES.x * SQUARES.y * SDFGI_SAMPLE_STEP_MAX * SDFGI_SAMPLE_STEP_MAX);

/* 3 KiB of samples and 6.6 KiB of list. */
shared uvec4 sample_surface[SAMPLES]; /* position, packed normal: 0 without a surface */
shared uvec2 sample_light[SAMPLES];   /* half floats */
shared uint listed[MOST_PIXELS];      /* x | y << 16, within the tile */
shared uint listed_count;

ivec2 tile_start()
{
    return ivec2(gl_WorkGroupID.xy) * SQUARES * int(args.step);
}

/* Beyond the picture the pixels on its border stand in. */
ivec2 sample_pixel(uint index)
{
    const ivec2 sample_at = ivec2(index % SDFGI_SAMPLES_X, index / SDFGI_SAMPLES_X);
    return min(tile_start() + sample_at * int(args.step), ivec2(args.width, args.height) - 1);
}

void sample_store(uint index, bool is_surface, picture_surface s, vec3 light)
{
    sample_surface[index] =
        is_surface ? uvec4(floatBitsToUint(s.pos), packSnorm4x8(vec4(s.normal, 0.0))) : uvec4(0u);
    sample_light[index] = uvec2(packHalf2x16(light.xy), packHalf2x16(vec2(light.z, 0.0)));
}

/* ---- Interpolation */

struct mean {
    vec3 sum;
    float weight;
    vec3 darkest, brightest;
};

/* How much a sample tells of a surface, in [0, 1]. It tells nothing at a distance of 1 / `per_reach` from its
 * plane, little from 30 degrees between the normals, and nothing from 60. */
float sample_likeness(picture_surface s, float per_reach, uvec4 of_sample)
{
    const float off_plane_m = abs(dot(uintBitsToFloat(of_sample.xyz) - s.pos, s.normal));
    const float facing = max(dot(unpackSnorm4x8(of_sample.w).xyz, s.normal), 0.0);
    const float facing4 = facing * facing * facing * facing;
    return max(1.0 - off_plane_m * per_reach, 0.0) * facing4 * facing4;
}

void mean_add(inout mean m, picture_surface s, float per_reach, uint index, float share)
{
    const float weight = share * sample_likeness(s, per_reach, sample_surface[index]);
    if (!(weight > LEAST_WEIGHT))
        return;
    const uvec2 halves = sample_light[index];
    const vec3 light = vec3(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y).x);
    m.sum += weight * light;
    m.weight += weight;
    m.darkest = min(m.darkest, light);
    m.brightest = max(m.brightest, light);
}

bool mean_is_good(mean m)
{
    const vec3 contrast = m.brightest - m.darkest;
    const float most = MOST_CONTRAST * max(m.brightest.x, max(m.brightest.y, m.brightest.z));
    return m.weight >= ENOUGH_WEIGHT && max(contrast.x, max(contrast.y, contrast.z)) <= most;
}

/* Interpolates at a pixel `at` of the tile. */
mean mean_at(ivec2 at, picture_surface s)
{
    const int step = int(args.step);
    const ivec2 square = at >> findMSB(step);
    const vec2 t = vec2(at & (step - 1)) / float(step);
    const uint first = uint(square.x + square.y * SDFGI_SAMPLES_X);
    const float per_reach = 1.0 / (float(step) * s.pixel_m);
    mean m = mean(vec3(0.0), 0.0, vec3(PICTURE_BRIGHTEST), vec3(0.0));
    mean_add(m, s, per_reach, first, (1.0 - t.x) * (1.0 - t.y));
    mean_add(m, s, per_reach, first + 1u, t.x * (1.0 - t.y));
    mean_add(m, s, per_reach, first + SDFGI_SAMPLES_X, (1.0 - t.x) * t.y);
    mean_add(m, s, per_reach, first + SDFGI_SAMPLES_X + 1u, t.x * t.y);
    return m;
}

void pixel_interpolate(ivec2 at)
{
    const ivec2 pixel = tile_start() + at;
    if (pixel.x >= int(args.width) || pixel.y >= int(args.height))
        return;
    picture_surface s;
    vec3 irradiance = vec3(0.0);
    const bool is_surface = picture_surface_at(pixel, s);
    if (is_surface) {
        const mean m = mean_at(at, s);
        if (!mean_is_good(m)) {
            listed[atomicAdd(listed_count, 1u)] = uint(at.x) | uint(at.y) << 16u;
            return;
        }
        irradiance = m.sum / m.weight;
    }
    picture_store(pixel, is_surface, s.normal, irradiance);
}

/* Neighbouring threads take neighbouring pixels. */
void tile_interpolate()
{
    const ivec2 size = SQUARES * int(args.step);
    for (int y = int(gl_LocalInvocationID.y); y < size.y; y += SDFGI_SAMPLES_Y)
        for (int x = int(gl_LocalInvocationID.x); x < size.x; x += SDFGI_SAMPLES_X)
            pixel_interpolate(ivec2(x, y));
}

/* ---- Lookups */

/* Looks up the sample or the listed pixel of a number. */
void look_up(bool is_sample, uint index)
{
    const uint at = is_sample ? 0u : listed[index];
    const ivec2 pixel = is_sample ? sample_pixel(index) : tile_start() + ivec2(at & 0xffffu, at >> 16u);
    picture_surface s;
    const bool is_surface = picture_surface_at(pixel, s);
    const vec3 irradiance = is_surface ? picture_irradiance(s) : vec3(0.0);
    if (is_sample)
        sample_store(index, is_surface, s, irradiance);
    if (is_sample && is_surface)
        picture_mark(s, index);
    if (!is_sample)
        picture_store(pixel, is_surface, s.normal, irradiance);
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        listed_count = 0u;
    /* First samples, then listed pixels. A loop, so that drivers compile the lookup once. The loop in it asks
     * at its end: software drivers would go round once more with a lookup for nothing. */
    [[dont_unroll]] for (uint part = 0u; part < 2u; part++)
    {
        const uint count = part == 0u ? SAMPLES : listed_count;
        uint i = gl_LocalInvocationIndex;
        do {
            if (i < count)
                look_up(part == 0u, i);
            i += SAMPLES;
        } while (i < count);
        barrier();
        if (part == 0u)
            tile_interpolate();
        barrier();
    }
}
