/* SPDX-License-Identifier: MIT */
#include "format_codec.h"

#include "require.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    enum format_number number;
} numbers[] = {
    { "USCALED", FORMAT_UNSIGNED }, { "UINT", FORMAT_UNSIGNED }, { "SSCALED", FORMAT_SIGNED },
    { "SINT", FORMAT_SIGNED },      { "UNORM", FORMAT_UNORM },   { "SNORM", FORMAT_SNORM },
    { "SRGB", FORMAT_SRGB },        { "SFLOAT", FORMAT_FLOAT },
};

static enum format_number number_of(const char *text)
{
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (strncmp(text, numbers[i].name, strlen(numbers[i].name)) == 0)
            return numbers[i].number;
    require_fail(__FILE__, __LINE__, "no number format: %s", text);
    return FORMAT_UNSIGNED;
}

struct format_codec format_codec_of(const char *name)
{
    struct format_codec codec = { 0 };
    REQUIRE_TRUE(strncmp(name, "VK_FORMAT_", 10) == 0);
    const char *at = name + 10;
    uint32_t sum = 0;
    while (*at != '_') {
        const char *channel = strchr("RGBA", *at);
        REQUIRE_TRUE(channel != NULL);
        char *end;
        const uint32_t bits = (uint32_t)strtoul(at + 1, &end, 10);
        codec.bits[channel - "RGBA"] = bits;
        codec.first[channel - "RGBA"] = sum;
        sum += bits;
        codec.components++;
        at = end;
    }
    codec.number = number_of(at + 1);
    codec.size = sum / 8;
    /* Of a packed format, the last component lies in the lowest bits. */
    if (strstr(at, "_PACK32"))
        for (int i = 0; i < 4; i++)
            codec.first[i] = 32 - codec.first[i] - codec.bits[i];
    return codec;
}

/* ---- Bits */

static uint64_t bits_read(const uint8_t *element, uint32_t first, uint32_t count)
{
    uint64_t bits = 0;
    for (uint32_t i = 0; i < count; i++)
        bits |= (uint64_t)(element[(first + i) / 8] >> ((first + i) % 8) & 1) << i;
    return bits;
}

static void bits_write(uint8_t *element, uint32_t first, uint32_t count, uint64_t bits)
{
    for (uint32_t i = 0; i < count; i++)
        element[(first + i) / 8] = (uint8_t)((element[(first + i) / 8] & ~(1 << (first + i) % 8)) |
                                             (bits >> i & 1) << (first + i) % 8);
}

/* ---- Numbers */

static double float_of(uint64_t bits, uint32_t count)
{
    if (count == 32) {
        const uint32_t word = (uint32_t)bits;
        float value;
        memcpy(&value, &word, sizeof value);
        return (double)value;
    }
    const int exponent = (int)(bits >> 10 & 31), mantissa = (int)(bits & 1023);
    const double sign = bits >> 15 ? -1 : 1;
    if (exponent == 31)
        return mantissa ? NAN : sign * INFINITY;
    return sign * (exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24));
}

static uint64_t bits_of_float(double value, uint32_t count)
{
    const float narrow = (float)value;
    uint32_t word;
    memcpy(&word, &narrow, sizeof word);
    if (count == 32 || value == 0)
        return value == 0 ? 0 : word;
    const uint32_t exponent = (word >> 23 & 255) - 112;
    REQUIRE_CMP(exponent, <, 31u);
    return (word >> 16 & 0x8000) | exponent << 10 | (word >> 13 & 1023);
}

static double srgb_decoded(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double decoded(const struct format_codec *c, int channel, uint64_t bits)
{
    const uint32_t count = c->bits[channel];
    const int64_t full = INT64_C(1) << count, number = (int64_t)bits;
    const int64_t with_sign = number >= full / 2 ? number - full : number;
    switch (c->number) {
    case FORMAT_UNSIGNED:
        return (double)number;
    case FORMAT_SIGNED:
        return (double)with_sign;
    case FORMAT_UNORM:
        return (double)number / (double)(full - 1);
    case FORMAT_SNORM:
        return fmax((double)with_sign / (double)(full / 2 - 1), -1);
    case FORMAT_SRGB: {
        const double v = (double)number / (double)(full - 1);
        return channel < 3 ? srgb_decoded(v) : v;
    }
    case FORMAT_FLOAT:
        break;
    }
    return float_of(bits, count);
}

void format_decode(const struct format_codec *codec, const uint8_t *element, double values[static 4])
{
    for (int i = 0; i < 4; i++) {
        values[i] = i == 3 ? 1 : 0;
        if (codec->bits[i])
            values[i] = decoded(codec, i, bits_read(element, codec->first[i], codec->bits[i]));
    }
}

static uint64_t encoded(const struct format_codec *c, int channel, double value)
{
    const uint32_t count = c->bits[channel];
    const double full = ldexp(1, (int)count);
    if (c->number == FORMAT_FLOAT)
        return bits_of_float(value, count);
    if (c->number == FORMAT_SRGB && channel < 3)
        value = value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055;
    if (c->number == FORMAT_UNORM || c->number == FORMAT_SRGB)
        value *= full - 1;
    if (c->number == FORMAT_SNORM)
        value *= full / 2 - 1;
    return (uint64_t)(int64_t)llround(value);
}

void format_encode(const struct format_codec *codec, const double values[static 4], uint8_t *element)
{
    for (int i = 0; i < 4; i++)
        if (codec->bits[i])
            bits_write(element, codec->first[i], codec->bits[i], encoded(codec, i, values[i]));
}
