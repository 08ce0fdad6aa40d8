/* SPDX-License-Identifier: MIT
 * One reader and one writer per format, used by image.c alone. Readers fill an image whose `rgba` is NULL. */
#ifndef RUNTIME_IMAGE_CODEC_H
#define RUNTIME_IMAGE_CODEC_H

#include "image.h"

#include <stdio.h>

struct image_input {
    const char *path;
    FILE *stream; /* at its start */
    uint64_t size;
};

struct image_source {
    const float *rgba;
    uint32_t width, height, channels;
};

/* False with a line in `error` for a size that image_init refuses. */
bool image_check_size(uint32_t width, uint32_t height, char *error, size_t error_size);

/* image_init for a file that has `have` bytes, of which pixels of that size take at least `need`. */
bool image_init_backed(struct image *image, uint32_t width, uint32_t height, uint64_t need, uint64_t have,
                       char *error, size_t error_size);

bool image_exr_read(struct image *image, const struct image_input *input, char *error, size_t error_size);
bool image_exr_write(const struct image_source *source, FILE *stream, char *error, size_t error_size);
bool image_hdr_read(struct image *image, const struct image_input *input, char *error, size_t error_size);
bool image_hdr_write(const struct image_source *source, FILE *stream, char *error, size_t error_size);
bool image_pfm_read(struct image *image, const struct image_input *input, char *error, size_t error_size);
bool image_pfm_write(const struct image_source *source, FILE *stream, char *error, size_t error_size);
bool image_png_read(struct image *image, const struct image_input *input, char *error, size_t error_size);

#endif
