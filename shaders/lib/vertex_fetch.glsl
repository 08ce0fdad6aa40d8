/* SPDX-License-Identifier: MIT
 * Attributes of vertices and indices, in whatever format a host has them, from buffers of words. Needs
 * SDFGI_ZERO (on_cpu.glsl). */
#ifndef SDFGI_VERTEX_FETCH_GLSL
#define SDFGI_VERTEX_FETCH_GLSL

#include "srgb.glsl"
#include "../shared/vertex_fetch.h"

/* The last word of the element at a byte. */
uint sdfgi_fetch_last_word(uint fetch, uint byte)
{
    return (byte + SDFGI_FETCH_GET_SIZE(fetch) - 1u) >> 2u;
}

/* Bits [first, first + count) of a word as the number that they stand for. */
float sdfgi_fetch_component(uint word, uint first, uint count, uint fetch)
{
    const int offset = int(first), bits = int(count);
    if ((fetch & SDFGI_FETCH_FLOAT) != 0u)
        return unpackHalf2x16(bitfieldExtract(word, offset, bits)).x;
    const bool is_signed = (fetch & SDFGI_FETCH_SIGNED) != 0u;
    const float number = is_signed ? float(bitfieldExtract(int(word), offset, bits))
                                   : float(bitfieldExtract(word, offset, bits));
    const float most = float((1u << (is_signed ? count - 1u : count)) - 1u);
    return (fetch & SDFGI_FETCH_NORMALISED) != 0u ? max(number / most, -1.0) : number;
}

/* An element whose components have at most 16 bits: at `byte` modulo 4 of three words. */
vec4 sdfgi_fetch_packed(uvec3 words, uint byte, uint fetch)
{
    const uint shift = 8u * (byte & 3u), bits = SDFGI_FETCH_GET_BITS(fetch);
    const uvec2 element = words.xy >> shift | (words.yz << 1u) << (31u - shift);
    vec4 v;
    for (uint c = SDFGI_ZERO; c < 4u; c++) {
        const uint at = c * bits, first = at & 31u;
        v[c] = sdfgi_fetch_component(at < 32u ? element.x : element.y, first, min(bits, 32u - first), fetch);
    }
    if ((fetch & SDFGI_FETCH_BLUE_FIRST) != 0u)
        v.xz = v.zx;
    if ((fetch & SDFGI_FETCH_SRGB) != 0u)
        v.rgb = sdfgi_srgb_decode(v.rgb);
    return v;
}

/* What an element lacks is 0, and its fourth component 1. */
vec4 sdfgi_fetch_completed(vec4 v, uint fetch)
{
    const uint components = SDFGI_FETCH_GET_COMPONENTS(fetch);
    return vec4(v.xy, components > 2u ? v.z : 0.0, components > 3u ? v.w : 1.0);
}

/* Defines `vec4 name(uint fetch, uint byte)`: the element at a byte of an array of words, of which the first
 * `most` components are wanted: 2 to 4. Reads no word beyond the element. GLSL passes no buffer to a
 * function. What floats of 32 bits do not need is a loop of one round, because software drivers run what is
 * under a condition in any case. */
#define SDFGI_FETCH_FUNCTION(name, words, most)                                                              \
    vec4 name(uint fetch, uint byte)                                                                         \
    {                                                                                                        \
        const uint at = byte >> 2u, last = sdfgi_fetch_last_word(fetch, byte);                               \
        const uvec4 read =                                                                                   \
            uvec4(words[at], words[min(at + 1u, last)], most > 2 ? words[min(at + 2u, last)] : 0u,           \
                  most > 3 ? words[min(at + 3u, last)] : 0u);                                                \
        const uint times = SDFGI_FETCH_GET_BITS(fetch) < 32u ? 1u : 0u;                                      \
        vec4 v = uintBitsToFloat(read);                                                                      \
        for (uint i = 0u; i < times; i++)                                                                    \
            v = sdfgi_fetch_packed(read.xyz, byte, fetch);                                                   \
        return sdfgi_fetch_completed(v, fetch);                                                              \
    }

/* Defines `uint name(uint bits, uint byte)`: the number of 8, 16 or 32 bits at any byte. */
#define SDFGI_FETCH_INDEX_FUNCTION(name, words)                                                              \
    uint name(uint bits, uint byte)                                                                          \
    {                                                                                                        \
        const uint shift = 8u * (byte & 3u), times = shift + bits > 32u ? 1u : 0u;                           \
        uint number = words[byte >> 2u] >> shift;                                                            \
        for (uint i = 0u; i < times; i++)                                                                    \
            number |= words[(byte >> 2u) + 1u] << (32u - shift);                                             \
        return number & 0xffffffffu >> (32u - bits);                                                         \
    }

#endif
