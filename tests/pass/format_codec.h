/* SPDX-License-Identifier: MIT
 * Elements of a VkFormat on the CPU, by nothing but the format's name: "R8G8B8A8_SNORM". */
#ifndef TEST_PASS_FORMAT_CODEC_H
#define TEST_PASS_FORMAT_CODEC_H

#include <stdint.h>

enum format_number { FORMAT_UNSIGNED, FORMAT_SIGNED, FORMAT_UNORM, FORMAT_SNORM, FORMAT_SRGB, FORMAT_FLOAT };

struct format_codec {
    enum format_number number;
    uint32_t components, size;  /* bytes of an element */
    uint32_t bits[4], first[4]; /* of red, green, blue, alpha, from the lowest bit of the first byte; bits 0:
                                   the format lacks it */
};

/* `name` is that of the enumerator. The test fails if it makes no sense. */
struct format_codec format_codec_of(const char *name);

/* Red, green, blue and alpha; what is lacking is 0, alpha 1. */
void format_decode(const struct format_codec *codec, const uint8_t *element, double values[static 4]);
/* The nearest element. Only values that half floats and floats hold may be given for these. */
void format_encode(const struct format_codec *codec, const double values[static 4], uint8_t *element);

#endif
