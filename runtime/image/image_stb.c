/* SPDX-License-Identifier: MIT
 * HDR and PNG are written through stb. Its readers trust what they read. */
#include "image_codec.h"

#include <base/text.h>
#include <stb_image_write.h>
#include <stdlib.h>
#include <string.h>

static void write_to_stream(void *stream, void *bytes, int size)
{
    fwrite(bytes, 1, (size_t)size, stream);
}

bool image_hdr_write(const struct image_source *source, FILE *stream, char *error, size_t error_size)
{
    const size_t count = (size_t)source->width * source->height;
    float *rgb = malloc(count * 3 * sizeof(float));
    if (!rgb)
        return base_text_error(error, error_size, "out of memory");
    for (size_t i = 0; i < 3 * count; i++)
        rgb[i] = source->rgba[4 * (i / 3) + (source->channels == 1 ? 0 : i % 3)];
    const int written =
        stbi_write_hdr_to_func(write_to_stream, stream, (int)source->width, (int)source->height, 3, rgb);
    free(rgb);
    return written || base_text_error(error, error_size, "out of memory");
}

bool image_png_write(const uint8_t *rgba, uint32_t width, uint32_t height, uint32_t channels, FILE *stream)
{
    const size_t count = (size_t)width * height;
    uint8_t *packed = malloc(count * channels);
    if (!packed)
        return false;
    for (size_t i = 0; i < count; i++)
        memcpy(packed + i * channels, rgba + 4 * i, channels);
    const int written = stbi_write_png_to_func(write_to_stream, stream, (int)width, (int)height,
                                               (int)channels, packed, (int)(width * channels));
    free(packed);
    return written != 0;
}
