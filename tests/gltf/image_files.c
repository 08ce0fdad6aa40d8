/* SPDX-License-Identifier: MIT */
#include "scene_files.h"

#include <string.h>

static size_t chunk_put(uint8_t *out, const char *type, const uint8_t *data, uint32_t size)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(size >> (24 - 8 * i));
    memcpy(out + 4, type, 4);
    memcpy(out + 8, data, size);
    memset(out + 8 + size, 0, 4); /* the checksum, which the decoder leaves unread */
    return size + 12;
}

/* One stored deflate block, rows with filter 0, 8- or 16-bit RGBA. */
static size_t rows_deflate(const struct png *image, uint8_t *out)
{
    const size_t row = (size_t)image->width * 4 * image->depth / 8;
    const size_t size = image->height * (row + 1);
    const uint8_t head[7] = {
        0x78, 0x01, 1, (uint8_t)size, (uint8_t)(size >> 8), (uint8_t)~size, (uint8_t)(~size >> 8)
    };
    memcpy(out, head, sizeof head);
    size_t at = sizeof head;
    for (size_t y = 0; y < image->height; y++) {
        out[at++] = 0;
        memcpy(out + at, image->samples + y * row, row);
        at += row;
    }
    memset(out + at, 0, 4);
    return at + 4;
}

size_t png_encode(const struct png *image, uint8_t *out, size_t capacity)
{
    static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    uint8_t header[13] = { 0 }, rows[4096];
    assert_true((size_t)image->width * image->height * 8 + image->height < sizeof rows - 16);
    for (int i = 0; i < 4; i++) {
        header[i] = (uint8_t)(image->width >> (24 - 8 * i));
        header[4 + i] = (uint8_t)(image->height >> (24 - 8 * i));
    }
    header[8] = image->depth;
    header[9] = 6; /* RGBA */
    const size_t rows_size = rows_deflate(image, rows);
    assert_true(rows_size + 64 < capacity);
    memcpy(out, signature, sizeof signature);
    size_t at = sizeof signature;
    at += chunk_put(out + at, "IHDR", header, sizeof header);
    at += chunk_put(out + at, "IDAT", rows, (uint32_t)rows_size);
    return at + chunk_put(out + at, "IEND", rows, 0);
}

void base64_encode(const uint8_t *data, size_t size, char *out, size_t capacity)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    assert_true((size + 2) / 3 * 4 + 1 <= capacity);
    for (size_t i = 0; i < size; i += 3) {
        const uint32_t second = i + 1 < size ? data[i + 1] : 0, third = i + 2 < size ? data[i + 2] : 0;
        const uint32_t group = (uint32_t)data[i] << 16 | second << 8 | third;
        *out++ = digits[group >> 18];
        *out++ = digits[group >> 12 & 63];
        *out++ = i + 1 < size ? digits[group >> 6 & 63] : '=';
        *out++ = i + 2 < size ? digits[group & 63] : '=';
    }
    *out = '\0';
}
