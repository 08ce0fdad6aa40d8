/* SPDX-License-Identifier: MIT */
#ifndef SDFGI_NTH_BIT_GLSL
#define SDFGI_NTH_BIT_GLSL

/* Position of the n-th set bit, from 0. There are more than n. */
uint sdfgi_nth_bit(uint bits, uint n)
{
    uint bit = 0u;
    for (uint width = 16u; width > 0u; width /= 2u) {
        const uint count = bitCount(bitfieldExtract(bits, int(bit), int(width)));
        if (n >= count) {
            n -= count;
            bit += width;
        }
    }
    return bit;
}

#endif
