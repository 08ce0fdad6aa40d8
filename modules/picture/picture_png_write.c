/* SPDX-License-Identifier: MIT */
#include "picture_png.h"

#include <base/text.h>
#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

struct encoder {
    png_structp png;
    png_infop info;
    FILE *stream;
    const uint8_t *rgba;
    uint32_t width, height, channels;
    uint8_t *row; /* of `channels` */
    char *error;
    size_t error_size;
};

/* ---- Called by libpng ------------------------------------------------------------------------------- */

static void stop(png_structp png, png_const_charp reason)
{
    const struct encoder *encoder = png_get_error_ptr(png);
    base_text_error(encoder->error, encoder->error_size, "%s", reason);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp reason)
{
    (void)png;
    (void)reason;
}

/* A stream that takes no more says so when it is flushed. */
static void write_bytes(png_structp png, png_bytep bytes, size_t size)
{
    fwrite(bytes, 1, size, png_get_io_ptr(png));
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

/* ---- The whole -------------------------------------------------------------------------------------- */

static bool encode(const struct encoder *encoder)
{
    const png_structp png = encoder->png;
    const int types[] = { [1] = PNG_COLOR_TYPE_GRAY, [3] = PNG_COLOR_TYPE_RGB, [4] = PNG_COLOR_TYPE_RGBA };
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_write_fn(png, encoder->stream, write_bytes, flush_nothing);
    png_set_IHDR(png, encoder->info, encoder->width, encoder->height, 8, types[encoder->channels],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, encoder->info);
    for (uint32_t y = 0; y < encoder->height; y++) {
        const uint8_t *texel = encoder->rgba + (size_t)4 * y * encoder->width;
        for (size_t x = 0; x < encoder->width; x++)
            memcpy(encoder->row + x * encoder->channels, texel + 4 * x, encoder->channels);
        png_write_row(png, encoder->row);
    }
    png_write_end(png, encoder->info);
    return true;
}

bool picture_png_write(FILE *stream, const uint8_t *rgba, uint32_t width, uint32_t height, uint32_t channels,
                       char *error, size_t error_size)
{
    struct encoder encoder = { .stream = stream,
                               .rgba = rgba,
                               .width = width,
                               .height = height,
                               .channels = channels,
                               .row = malloc((size_t)width * channels),
                               .error = error,
                               .error_size = error_size };
    base_text_error(error, error_size, "out of memory");
    if (encoder.row)
        encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, stop, ignore);
    encoder.info = encoder.png ? png_create_info_struct(encoder.png) : NULL;
    errno = 0;
    const bool complete = encoder.info && encode(&encoder);
    if (!complete && errno == ENOMEM)
        base_text_error(error, error_size, "out of memory");
    png_destroy_write_struct(&encoder.png, &encoder.info);
    free(encoder.row);
    return complete;
}
