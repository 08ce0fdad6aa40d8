/* SPDX-License-Identifier: MIT */
#include "picture_png.h"

#include <base/text.h>
#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

/* The most that a byte of deflate data can stand for: 258 bytes in two bits. A byte of those is eight texels
 * of one bit, which come to 128 bytes as floats: beyond 4096 x 4096, the most common size of a large picture
 * in one colour, it has to be a byte a texel. */
enum { INFLATE_RATIO_MAX = 1032, FREE_TEXELS = 1 << 24 };

struct decoder {
    png_structp png;
    png_infop info;
    struct picture_png *out;
    size_t file_size;
    int passes; /* over the rows: 1, or 7 where interlaced */
    bool deep, complete;
    char *error;
    size_t error_size;
};

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

bool picture_png_size(const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height)
{
    enum { SIGNATURE_BYTES = 8, WIDTH_AT = 16, HEIGHT_AT = 20, LEAST_BYTES = 33 };
    if (size < LEAST_BYTES || png_sig_cmp(bytes, 0, SIGNATURE_BYTES) != 0)
        return false;
    *width = big_endian(bytes + WIDTH_AT);
    *height = big_endian(bytes + HEIGHT_AT);
    return true;
}

/* ---- Called by libpng ------------------------------------------------------------------------------- */

static void stop(png_structp png, png_const_charp reason)
{
    const struct decoder *decoder = png_get_error_ptr(png);
    base_text_error(decoder->error, decoder->error_size, "%s", reason);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp reason)
{
    (void)png;
    (void)reason;
}

/* To RGBA of 8 bits, or of 16 in the machine's byte order. */
static void choose_form(struct decoder *decoder)
{
    const png_structp png = decoder->png;
    const int color = png_get_color_type(png, decoder->info);
    const bool alpha =
        (color & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, decoder->info, PNG_INFO_tRNS) != 0;
    const bool deep = decoder->deep && png_get_bit_depth(png, decoder->info) == 16;
    const uint16_t one = 1;
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    if (!alpha)
        png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    if (!deep)
        png_set_strip_16(png);
    else if (*(const uint8_t *)&one == 1)
        png_set_swap(png);
    decoder->out->depth = deep ? 16 : 8;
    decoder->out->channels = alpha ? 4 : (color & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1;
}

static bool is_backed(png_structp png, png_infop info, uint64_t file_size)
{
    const uint64_t row_bytes = png_get_rowbytes(png, info), width = png_get_image_width(png, info),
                   height = png_get_image_height(png, info);
    const uint64_t bytes = height * (row_bytes + 1), texels = height * width;
    return bytes <= INFLATE_RATIO_MAX * file_size &&
           (texels <= FREE_TEXELS || texels <= INFLATE_RATIO_MAX * file_size);
}

static void on_header(png_structp png, png_infop info)
{
    struct decoder *decoder = png_get_progressive_ptr(png);
    struct picture_png *out = decoder->out;
    out->width = png_get_image_width(png, info);
    out->height = png_get_image_height(png, info);
    if (!is_backed(png, info, decoder->file_size))
        png_error(png, "the file is too short for so many pixels");
    choose_form(decoder);
    decoder->passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    out->texels = calloc(out->height, png_get_rowbytes(png, info));
    if (out->texels == NULL)
        png_error(png, "out of memory");
}

/* Interlaced pictures come as seven passes over all rows. */
static void on_row(png_structp png, png_bytep row, png_uint_32 y, int pass)
{
    (void)pass;
    const struct decoder *decoder = png_get_progressive_ptr(png);
    const size_t row_bytes = png_get_rowbytes(png, decoder->info);
    png_progressive_combine_row(png, (png_bytep)decoder->out->texels + y * row_bytes, row);
}

/* The image data may have ended before the last row. */
static void on_end(png_structp png, png_infop info)
{
    (void)info;
    struct decoder *decoder = png_get_progressive_ptr(png);
    if (decoder->passes == 1)
        decoder->complete = png_get_current_row_number(png) == decoder->out->height;
    else
        decoder->complete = png_get_current_pass_number(png) == decoder->passes;
}

/* ---- The whole -------------------------------------------------------------------------------------- */

static bool decode(struct decoder *decoder, const uint8_t *bytes)
{
    if (setjmp(png_jmpbuf(decoder->png)))
        return false;
    /* All that is neither header, palette, transparency nor image data. */
    png_set_keep_unknown_chunks(decoder->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_progressive_read_fn(decoder->png, decoder, on_header, on_row, on_end);
    png_process_data(decoder->png, decoder->info, (png_bytep)bytes, decoder->file_size);
    if (!decoder->complete)
        png_error(decoder->png, "the file ends early");
    return true;
}

bool picture_png_read(struct picture_png *png, const uint8_t *bytes, size_t size, bool deep, char *error,
                      size_t error_size)
{
    struct decoder decoder = {
        .out = png, .file_size = size, .deep = deep, .error = error, .error_size = error_size
    };
    *png = (struct picture_png){ 0 };
    base_text_error(error, error_size, "out of memory");
    decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, stop, ignore);
    decoder.info = decoder.png ? png_create_info_struct(decoder.png) : NULL;
    errno = 0;
    const bool complete = decoder.info && decode(&decoder, bytes);
    if (!complete && errno == ENOMEM) /* inflating without memory is reported as data that is broken */
        base_text_error(error, error_size, "out of memory");
    png_destroy_read_struct(&decoder.png, &decoder.info, NULL);
    if (complete)
        return true;
    free(png->texels);
    *png = (struct picture_png){ 0 };
    return false;
}
