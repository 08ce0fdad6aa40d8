/* SPDX-License-Identifier: MIT
 * HDR and PNG, through stb. */
#include "image_codec.h"

#include <base/text.h>
#include <stb_image.h>
#include <stb_image_write.h>
#include <stdlib.h>
#include <string.h>

/* The size in the header is checked before anything is decoded. */
static bool read_header(struct image *image, const char *path, char *error, size_t error_size)
{
    int width, height, channels;
    if (!stbi_info(path, &width, &height, &channels))
        return base_text_error(error, error_size, "broken picture: %s", stbi_failure_reason());
    if (!image_init(image, (uint32_t)width, (uint32_t)height, error, error_size))
        return false;
    /* Grey with alpha is kept as colour with alpha. */
    image->channels = channels == 2 ? 4 : (uint32_t)channels;
    return true;
}

bool image_hdr_read(struct image *image, const char *path, char *error, size_t error_size)
{
    int width, height, channels;
    if (!stbi_is_hdr(path))
        return base_text_error(error, error_size, "broken picture: not a Radiance HDR file");
    if (!read_header(image, path, error, error_size))
        return false;
    float *rgba = stbi_loadf(path, &width, &height, &channels, 4);
    if (!rgba)
        return base_text_error(error, error_size, "broken picture: %s", stbi_failure_reason());
    for (size_t i = 0; i < 4 * (size_t)image->width * image->height; i++)
        image->rgba[i] = rgba[i];
    stbi_image_free(rgba);
    return true;
}

static bool read_png_16(struct image *image, const char *path)
{
    int width, height, channels;
    stbi_us *rgba = stbi_load_16(path, &width, &height, &channels, 4);
    for (size_t i = 0; rgba && i < 4 * (size_t)image->width * image->height; i++)
        image->rgba[i] = (float)rgba[i] / 65535;
    stbi_image_free(rgba);
    return rgba != NULL;
}

static bool read_png_8(struct image *image, const char *path)
{
    int width, height, channels;
    stbi_uc *rgba = stbi_load(path, &width, &height, &channels, 4);
    for (size_t i = 0; rgba && i < 4 * (size_t)image->width * image->height; i++)
        image->rgba[i] = (float)rgba[i] / 255;
    stbi_image_free(rgba);
    return rgba != NULL;
}

bool image_png_read(struct image *image, const char *path, char *error, size_t error_size)
{
    if (!read_header(image, path, error, error_size))
        return false;
    image->display_referred = true;
    if (stbi_is_16_bit(path) ? read_png_16(image, path) : read_png_8(image, path))
        return true;
    return base_text_error(error, error_size, "broken picture: %s", stbi_failure_reason());
}

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
