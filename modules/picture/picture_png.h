/* SPDX-License-Identifier: MIT
 * PNG files, from bytes in memory, and into streams. When they are read, time and memory are bounded by the
 * size of the picture, and that by the size of the file: image data beyond the last row is never inflated,
 * and texts and profiles are skipped. */
#ifndef PICTURE_PNG_H
#define PICTURE_PNG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

struct picture_png {
    uint32_t width, height;
    uint32_t channels; /* 1, 3 or 4 as the file has; `texels` always has 4 */
    uint32_t depth;    /* of a channel: 8 or 16 bits */
    void *texels;      /* uint8_t or uint16_t, RGBA, rows from the top; for free() */
};

/* True if the bytes start as a PNG does; the size is then as its header says, and not yet checked. */
bool picture_png_size(const uint8_t *bytes, size_t size, uint32_t *width, uint32_t *height);

/* Decodes a PNG. Channels of fewer than 8 bits get 8; those of 16 bits keep them only if `deep` says so. On
 * failure returns false with one line in `error`, and `png` is empty. */
bool picture_png_read(struct picture_png *png, const uint8_t *bytes, size_t size, bool deep, char *error,
                      size_t error_size);

/* Encodes the first 1, 3 or 4 channels of RGBA. On failure returns false with one line in `error`; what
 * cannot be written shows when the stream is flushed. */
bool picture_png_write(FILE *stream, const uint8_t *rgba, uint32_t width, uint32_t height, uint32_t channels,
                       char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
