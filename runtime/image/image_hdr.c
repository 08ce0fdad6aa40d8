/* SPDX-License-Identifier: MIT
 * Radiance HDR: lines of text, an empty one, the size, then rows of RGBE: red, green and blue share an
 * exponent. A row of 8 to 32767 pixels may be run-length encoded, each of its four channels on its own (Ward,
 * Real pixels, Graphics Gems II, 1991). */
#include "image_codec.h"

#include "file/input_file.h"

#include <base/text.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RUN_MIN_WIDTH = 8, RUN_MAX_WIDTH = 32767, RUN_MAX = 127, EXPONENT_BIAS = 128 + 8 };

struct reader {
    const uint8_t *at, *end;
};

static size_t bytes_left(const struct reader *r)
{
    return (size_t)(r->end - r->at);
}

/* ---- Header ----------------------------------------------------------------------------------------- */

/* Without its end; a longer line is cut. */
static bool read_line(struct reader *r, char line[static 64])
{
    const uint8_t *end = memchr(r->at, '\n', bytes_left(r));
    if (!end)
        return false;
    const size_t length = (size_t)(end - r->at) < 63 ? (size_t)(end - r->at) : 63;
    memcpy(line, r->at, length);
    line[length] = '\0';
    r->at = end + 1;
    return true;
}

static bool read_header(struct reader *r, unsigned *width, unsigned *height, char *error, size_t error_size)
{
    char line[64] = "", more;
    bool known = false;
    if (!read_line(r, line) || (strcmp(line, "#?RADIANCE") != 0 && strcmp(line, "#?RGBE") != 0))
        return base_text_error(error, error_size, "broken picture: not a Radiance HDR file");
    while (read_line(r, line) && line[0])
        known = known || strcmp(line, "FORMAT=32-bit_rle_rgbe") == 0;
    if (!known)
        return base_text_error(error, error_size, "broken picture: its FORMAT is not 32-bit_rle_rgbe");
    return (read_line(r, line) && sscanf(line, "-Y %9u +X %9u%c", height, width, &more) == 2) ||
           base_text_error(error, error_size, "broken picture: expected a size \"-Y HEIGHT +X WIDTH\"");
}

/* ---- Rows ------------------------------------------------------------------------------------------- */

static bool may_have_runs(uint32_t width)
{
    return width >= RUN_MIN_WIDTH && width <= RUN_MAX_WIDTH;
}

/* The fewest bytes that rows of that size take. */
static uint64_t rows_need(uint32_t width, uint32_t height)
{
    const uint64_t runs = (width + RUN_MAX - 1) / RUN_MAX;
    return height * (may_have_runs(width) ? 4 + 4 * 2 * runs : UINT64_C(4) * width);
}

/* Every fourth byte of `out`, in runs of one byte and in stretches of bytes as they are. */
static bool read_channel(struct reader *r, uint8_t *out, uint32_t width)
{
    for (uint32_t x = 0; x < width;) {
        if (bytes_left(r) < 2)
            return false;
        const uint8_t code = *r->at++;
        const bool is_run = code > 128;
        const uint32_t count = is_run ? code - 128u : code;
        const uint32_t bytes = is_run ? 1 : count;
        if (count == 0 || count > width - x || bytes > bytes_left(r))
            return false;
        for (uint32_t i = 0; i < count; i++)
            out[4 * (x + i)] = r->at[is_run ? 0 : i];
        r->at += bytes;
        x += count;
    }
    return true;
}

static bool read_row(struct reader *r, uint8_t *rgbe, uint32_t width)
{
    if (bytes_left(r) < 4)
        return false;
    const bool has_runs = may_have_runs(width) && r->at[0] == 2 && r->at[1] == 2 && r->at[2] < 128;
    if (!has_runs) {
        if (bytes_left(r) < (size_t)4 * width)
            return false;
        memcpy(rgbe, r->at, (size_t)4 * width);
        r->at += (size_t)4 * width;
        return true;
    }
    if (((uint32_t)r->at[2] << 8 | r->at[3]) != width)
        return false;
    r->at += 4;
    for (int c = 0; c < 4; c++)
        if (!read_channel(r, rgbe + c, width))
            return false;
    return true;
}

static void decode_row(const uint8_t *rgbe, float *rgba, uint32_t width)
{
    for (uint32_t x = 0; x < width; x++, rgbe += 4, rgba += 4) {
        const float scale = rgbe[3] ? ldexpf(1, rgbe[3] - EXPONENT_BIAS) : 0;
        for (int c = 0; c < 3; c++)
            rgba[c] = (float)rgbe[c] * scale;
        rgba[3] = 1;
    }
}

static bool read_rows(struct reader *r, struct image *image)
{
    uint8_t *rgbe = malloc((size_t)4 * image->width);
    bool complete = rgbe != NULL;
    for (uint32_t y = 0; complete && y < image->height; y++) {
        complete = read_row(r, rgbe, image->width);
        if (complete)
            decode_row(rgbe, image->rgba + 4 * (size_t)y * image->width, image->width);
    }
    free(rgbe);
    return complete;
}

/* ---- The whole -------------------------------------------------------------------------------------- */

bool image_hdr_read(struct image *image, const struct image_input *input, char *error, size_t error_size)
{
    char *bytes = input_file_read(input->stream, input->size, error, error_size);
    if (!bytes)
        return false;
    struct reader r = { (const uint8_t *)bytes, (const uint8_t *)bytes + input->size };
    unsigned width, height;
    bool complete =
        read_header(&r, &width, &height, error, error_size) &&
        image_init_backed(image, width, height, rows_need(width, height), bytes_left(&r), error, error_size);
    if (complete) {
        image->channels = 3;
        complete = read_rows(&r, image) ||
                   base_text_error(error, error_size, "broken picture: its rows are cut or not as encoded");
    }
    free(bytes);
    return complete;
}
