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
    return sdfgi_scratch[0];
}

uint found_block(uint i)
{
    return sdfgi_scratch[SDFGI_SCRATCH_EMITTERS + i];
}

uvec2 emission_of(uint block)
{
    return sdfgi_emission[block + args.cascade * sdfgi_albedo_block_count()];
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
        cells[i] = sdfgi_bits[sdfgi_texel_index(texel + uvec3(i & 1u, i >> 1u & 1u, i >> 2u)) |
                              args.cascade << (3u * sdfgi_frame.resolution_log2)];
}

/* Writes a listed block to its place in the list. */
void store(uint place, uint block)
{
    const uint index = block + args.cascade * sdfgi_albedo_block_count();
    const uvec2 emission = sdfgi_emission[index];
    const uint shape = sdfgi_emitters[emitter_shape_word(args.cascade, block)],
               word = emitter_word(args.cascade, place);
    const float square = emitter_shape_fill(shape) / float(SDFGI_SUBVOXELS * SDFGI_SUBVOXELS);
    uvec2 cells[8];
    load_block(block, cells);
    sdfgi_emitters[word] = block;
    sdfgi_emitters[word + 1u] = shape;
    sdfgi_emitters[word + 2u] = emission.x;
    float all_areas = 0.0;
    [[unroll]] for (int axis = 0; axis < 3; axis++)
    {
        const float seen = float(slices_seen(cells, axis)) * slices_column_area(axis) * square / 31.0;
        const uint weights = emission.y >> uint(10 * axis);
        const vec2 areas = seen * vec2(weights & 31u, weights >> 5u & 31u);
        sdfgi_emitters[word + 3u + uint(axis)] = packHalf2x16(areas);
        all_areas += areas.x + areas.y;
    }
    sdfgi_emitters[word + 6u] =
        floatBitsToUint(all_areas * sdfgi_light_luminance(sdfgi_emission_radiance(emission)));
    sdfgi_emitters[word + 7u] = emission.y & SDFGI_EMISSION_IS_BRIGHT;
    sdfgi_emission[index].y = emission.y | SDFGI_EMISSION_IS_LISTED;
}

void main()
{
    choose(find_limit());
    if (gl_LocalInvocationIndex == 0u)
        sdfgi_emitters[emitter_count_word(args.cascade)] = listed_count;
    for (uint i = gl_LocalInvocationIndex; i < listed_count; i += THREADS) {
        uint place = 0u;
        for (uint k = 0u; k < listed_count; k++)
            place += uint(listed[k] < listed[i]);
        store(place, listed[i]);
    }
}
