/* SPDX-License-Identifier: MIT
 * Lists the emitters of a cascade: of the blocks that emitter_mark found the SDFGI_MAX_EMITTERS brightest, in
 * the order of the blocks. Among equals a hash of the block chooses. The list depends on what is there alone,
 * not on the order in which it was found. What is not listed still lights what rays at random find it.
 *
 * One workgroup. The smallest key in the list is found digit by digit, from the highest one down. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_EMISSION
#define SDFGI_WRITES_EMITTERS
#include "../lib/on_cpu.glsl"
#include "block_slices.glsl"
#include "emitters.glsl"
#include "../lib/random.glsl"

layout(local_size_x = SDFGI_GROUP_EMITTERS) in;
SDFGI_PUSH(sdfgi_cascade_args);

const uint DIGITS = 256u, MOST = uint(SDFGI_MAX_EMITTERS), THREADS = uint(SDFGI_GROUP_EMITTERS);

shared uint histogram[DIGITS];
shared uint prefix; /* of the smallest key: the digits that are known */
shared uint above;  /* blocks whose digits are greater */
shared uint listed[MOST];
shared uint listed_count;

uint found_count()
{
    return sdfgi_scratch_at(0);
}

uint found_block(uint i)
{
    return sdfgi_scratch_at(SDFGI_SCRATCH_EMITTERS + i);
}

uvec2 emission_of(uint block)
{
    return sdfgi_emission_at(block + args.cascade * sdfgi_albedo_block_count());
}

/* Orders blocks: by how much they emit, to one part in 128, and then by a hash. */
uint key_of(uint block)
{
    const uvec2 emission = emission_of(block);
    float weights = 0.0;
    for (uint axis = 0u; axis < 6u; axis++)
        weights += float(emission.y >> (5u * axis) & 31u);
    const float power = sdfgi_light_luminance(sdfgi_emission_radiance(emission)) * weights;
    return floatBitsToUint(power) & 0xffff0000u | sdfgi_random_hash(block) >> 16u;
}

/* Finds the next eight bits of the smallest key, from bit `shift` on. Called by the whole workgroup. */
void find_digit(uint shift)
{
    const uint lane = gl_LocalInvocationIndex;
    for (uint digit = lane; digit < DIGITS; digit += THREADS)
        histogram[digit] = 0u;
    barrier();
    for (uint i = lane; i < found_count(); i += THREADS) {
        const uint key = key_of(found_block(i));
        if (shift == 24u || key >> (shift + 8u) == prefix)
            atomicAdd(histogram[key >> shift & 255u], 1u);
    }
    barrier();
    if (lane == 0u) {
        uint digit = DIGITS;
        while (digit > 0u && above + histogram[digit - 1u] <= MOST)
            above += histogram[--digit];
        prefix = prefix << 8u | (digit - 1u); /* more blocks than MOST share the prefix: digit is not 0 */
    }
    barrier();
}

/* Finds the key that all listed blocks exceed, if there are more blocks than the list takes. */
uint find_limit()
{
    if (gl_LocalInvocationIndex == 0u)
        prefix = above = 0u;
    barrier();
    if (found_count() <= MOST)
        return 0u;
    for (uint shift = 32u; shift > 0u; shift -= 8u)
        find_digit(shift - 8u);
    return prefix;
}

void choose(uint limit)
{
    if (gl_LocalInvocationIndex == 0u)
        listed_count = 0u;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < found_count(); i += THREADS)
        if (key_of(found_block(i)) > limit)
            listed[atomicAdd(listed_count, 1u)] = found_block(i);
    barrier();
}

void load_block(uint block, out uvec2 cells[8])
{
    const uvec3 texel = sdfgi_albedo_block_texel(block);
    for (uint i = 0u; i < 8u; i++)
        cells[i] = sdfgi_subvoxels(sdfgi_texel_index(texel + uvec3(i & 1u, i >> 1u & 1u, i >> 2u)) |
                                   args.cascade << (3u * sdfgi_frame.resolution_log2));
}

/* What the two sides of each axis see of an emitter, in squares of a cell's width. */
void load_sides(uint block, uint weights, out vec3 seen, out vec3 net)
{
    uvec2 cells[8];
    load_block(block, cells);
    [[unroll]] for (int axis = 0; axis < 3; axis++)
    {
        const float area = float(slices_seen(cells, axis)) * slices_column_area(axis) /
                           (31.0 * float(SDFGI_SUBVOXELS * SDFGI_SUBVOXELS));
        const uvec2 sides = uvec2(weights >> uint(10 * axis), weights >> uint(10 * axis + 5)) & 31u;
        seen[axis] = area * float(sides.x + sides.y);
        net[axis] = area * (float(sides.x) - float(sides.y));
    }
}

/* Mean of length(seen * dir) over all directions, within 1.1 %: a quarter of an ellipsoid's surface, by
 * Knud Thomsen's formula. */
float mean_of_ball(vec3 seen)
{
    const float P = 1.6075;
    const vec3 powers = pow(max(seen, 1e-20), vec3(P));
    return pow((powers.x + powers.y + powers.z) / 3.0, 1.0 / P);
}

/* The form of an emitter whose own area is `area`. In the mean over all directions any emitter shows half of
 * that in both of two opposite ones, together (Cauchy), so the area tells whether it is rather a box or a
 * ball. A flat one has no more area than its net one; an eighth of a sphere 1.155 times that. */
void find_form(float area, inout vec3 seen, inout vec3 net, out float boxy, out float bent)
{
    const float box = 0.5 * (seen.x + seen.y + seen.z), ball = min(mean_of_ball(seen), box),
                flat_area = max(length(net), 1e-20);
    boxy = box - ball > 0.01 * box ? clamp((0.5 * area - ball) / (box - ball), 0.0, 1.0) : 1.0;
    bent = clamp((area / flat_area - 1.0) / 0.155, 0.0, 1.0);
    seen *= min(0.5 * area / max(mix(ball, box, boxy), 1e-20), 1.0);
    net *= min(area / flat_area, 1.0);
}

/* Writes a listed block to its place in the list. */
void store(uint place, uint block)
{
    const uint index = block + args.cascade * sdfgi_albedo_block_count();
    const uvec2 emission = sdfgi_emission_at(index);
    const uint shape = sdfgi_emitters_at(emitter_shape_word(args.cascade, block)),
               word = emitter_word(args.cascade, place);
    vec3 seen, net;
    load_sides(block, emission.y, seen, net);
    const float area = emitter_shape_fill(shape) * (seen.x + seen.y + seen.z);
    float boxy, bent;
    find_form(area, seen, net, boxy, bent);
    sdfgi_emitters[word] = block;
    sdfgi_emitters[word + 1u] = emitter_shape_pack_form(shape, boxy, bent);
    sdfgi_emitters[word + 2u] = emission.x;
    sdfgi_emitters[word + 3u] = packHalf2x16(vec2(seen.x, net.x));
    sdfgi_emitters[word + 4u] = packHalf2x16(vec2(seen.y, net.y));
    sdfgi_emitters[word + 5u] = packHalf2x16(vec2(seen.z, net.z));
    sdfgi_emitters[word + 6u] =
        floatBitsToUint(area * sdfgi_light_luminance(sdfgi_emission_radiance(emission)));
    sdfgi_emitters[word + 7u] = emission.y & SDFGI_EMISSION_IS_BRIGHT;
    sdfgi_emission[index].y = emission.y | SDFGI_EMISSION_IS_LISTED;
}

void main()
{
    choose(find_limit());
    if (gl_LocalInvocationIndex == 0u) {
        sdfgi_emitters[emitter_count_word(args.cascade)] = listed_count;
        sdfgi_emitters[emitter_count_word(args.cascade) + 1u] = uint(found_count() == listed_count);
    }
    for (uint i = gl_LocalInvocationIndex; i < listed_count; i += THREADS) {
        uint place = 0u;
        for (uint k = 0u; k < listed_count; k++)
            place += uint(listed[k] < listed[i]);
        store(place, listed[i]);
    }
}
