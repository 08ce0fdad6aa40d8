/* SPDX-License-Identifier: MIT
 * Radiance HDR as image_hdr.c describes it. Rows that may be run-length encoded are. */
#include "image_codec.h"

#include <base/text.h>
#include <math.h>
#include <stdlib.h>

enum { RUN_MIN_WIDTH = 8, RUN_MAX_WIDTH = 32767, RUN_MIN = 3, RUN_MAX = 127, EXPONENT_BIAS = 128 };

/* Beyond them there is no exponent left. */
static const float darkest = 1e-38f, brightest = 1e38f;

static void encode_texel(const float rgb[3], uint8_t rgbe[4])
{
    const float most = fminf(fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])), brightest);
    int exponent = 0;
    const float scale = most >= darkest ? frexpf(most, &exponent) * 256 / most : 0;
    for (int c = 0; c < 3; c++)
        rgbe[c] = (uint8_t)fminf(fmaxf(rgb[c] * scale, 0), 255);
    rgbe[3] = most >= darkest ? (uint8_t)(exponent + EXPONENT_BIAS) : 0;
}

static void encode_row(const struct image_source *source, uint32_t y, uint8_t *rgbe)
{
    for (uint32_t x = 0; x < source->width; x++) {
        const float *rgba = source->rgba + 4 * ((size_t)y * source->width + x);
        const float grey[3] = { rgba[0], rgba[0], rgba[0] };
        encode_texel(source->channels == 1 ? grey : rgba, rgbe + (size_t)4 * x);
    }
}

/* How many of the values from here on are alike, every fourth byte. */
static uint32_t run_length(const uint8_t *values, uint32_t left)
{
    uint32_t length = 1;
    while (length < left && length < RUN_MAX && values[(size_t)4 * length] == values[0])
        length++;
    return length;
}

/* How many come before the next run. */
static uint32_t stretch_length(const uint8_t *values, uint32_t left)
{
    uint32_t length = 0;
    while (length < left && length < RUN_MAX &&
           run_length(values + (size_t)4 * length, left - length) < RUN_MIN)
        length++;
    return length;
}

static void write_channel(FILE *stream, const uint8_t *values, uint32_t width)
{
    for (uint32_t x = 0; x < width;) {
        const uint8_t *at = values + (size_t)4 * x;
        const uint32_t run = run_length(at, width - x);
        const uint32_t count = run < RUN_MIN ? stretch_length(at, width - x) : run;
        fputc((int)(run < RUN_MIN ? count : 128 + count), stream);
        for (uint32_t i = 0; i < (run < RUN_MIN ? count : 1); i++)
            fputc(at[(size_t)4 * i], stream);
        x += count;
    }
}

static void write_row(FILE *stream, const uint8_t *rgbe, uint32_t width)
{
    if (width < RUN_MIN_WIDTH || width > RUN_MAX_WIDTH) {
        fwrite(rgbe, 4, width, stream);
        return;
    }
    const uint8_t start[4] = { 2, 2, (uint8_t)(width >> 8), (uint8_t)width };
    fwrite(start, sizeof start, 1, stream);
    for (int c = 0; c < 4; c++)
        write_channel(stream, rgbe + c, width);
}

bool image_hdr_write(const struct image_source *source, FILE *stream, char *error, size_t error_size)
{
    uint8_t *rgbe = malloc((size_t)4 * source->width);
    if (!rgbe)
        return base_text_error(error, error_size, "out of memory");
    fprintf(stream, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", source->height, source->width);
    for (uint32_t y = 0; y < source->height; y++) {
        encode_row(source, y, rgbe);
        write_row(stream, rgbe, source->width);
    }
    free(rgbe);
    return true;
}
