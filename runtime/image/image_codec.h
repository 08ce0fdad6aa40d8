/* SPDX-License-Identifier: MIT
 * One reader and one writer per format, used by image.c alone. Readers fill an image whose `rgba` is NULL. */
#ifndef RUNTIME_IMAGE_CODEC_H
#define RUNTIME_IMAGE_CODEC_H

#include "image.h"

#include <stdio.h>

struct image_source {
    const float *rgba;
    uint32_t width, height, channels;
};

bool image_exr_read(struct image *image, const char *path, char *error, size_t error_size);
bool image_exr_write(const struct image_source *source, FILE *stream, char *error, size_t error_size);
bool image_hdr_read(struct image *image, const char *path, char *error, size_t error_size);
bool image_hdr_write(const struct image_source *source, FILE *stream, char *error, size_t error_size);
bool image_pfm_read(struct image *image, const char *path, char *error, size_t error_size);
bool image_pfm_write(const struct image_source *source, FILE *stream, char *error, size_t error_size);
bool image_png_read(struct image *image, const char *path, char *error, size_t error_size);
/* From bytes; false when memory runs out. */
bool image_png_write(const uint8_t *rgba, uint32_t width, uint32_t height, uint32_t channels, FILE *stream);

#endif
