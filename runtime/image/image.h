/* SPDX-License-Identifier: MIT
 * Pictures of floats: read EXR, HDR, PFM and PNG, write the same.
 *
 * EXR, HDR and PFM hold linear, scene-referred values and pass through unchanged. PNG holds display-referred
 * values: reading gives the encoded numbers over their maximum, [0, 1], without undoing the sRGB curve. */
#ifndef RUNTIME_IMAGE_H
#define RUNTIME_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Larger pictures are refused: their byte counts would not fit the formats. */
enum { IMAGE_SIDE_MAX = 32768 };

enum image_format { IMAGE_EXR, IMAGE_HDR, IMAGE_PFM, IMAGE_PNG, IMAGE_FORMAT_COUNT };

struct image {
    uint32_t width, height;
    uint32_t channels;     /* 1, 3 or 4 as the file has; `rgba` always has 4 */
    float *rgba;           /* 4 * width * height, rows from the top; grey is repeated, a missing alpha is 1 */
    bool display_referred; /* from a PNG */
};

/* The format by the ending of `path`, in any case; IMAGE_FORMAT_COUNT if it is none of them. */
enum image_format image_format_from_path(const char *path);

/* The endings, for messages. */
const char *image_format_list(void);

/* Zeroed pixels, or false with a line in `error`. */
bool image_init(struct image *image, uint32_t width, uint32_t height, char *error, size_t error_size);
void image_finish(struct image *image); /* accepts a zeroed image */

/* Reads the file at `path`, whose format its ending tells. On failure returns false and writes one line that
 * names the file into `error`; `image` is then empty. */
bool image_read(struct image *image, const char *path, char *error, size_t error_size);

/* Writes `channels` (1, 3 or 4) of RGBA floats as EXR (32-bit float, zip), HDR or PFM, as the ending of
 * `path` tells. HDR drops alpha and repeats grey, PFM drops alpha. The file appears whole or not at all. */
bool image_write_float(const char *path, const float *rgba, uint32_t width, uint32_t height,
                       uint32_t channels, char *error, size_t error_size);

/* Writes display-referred bytes, RGBA, as a PNG with 3 or 4 channels. */
bool image_write_png(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height,
                     uint32_t channels, char *error, size_t error_size);

#endif
