/* SPDX-License-Identifier: MIT */
#include "scene_files.h"

#include <string.h>
#include <zlib.h>

static void big_endian_put(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

static size_t chunk_put(uint8_t *out, const char *type, const uint8_t *data, uint32_t size)
{
    big_endian_put(out, size);
    memcpy(out + 4, type, 4);
    memcpy(out + 8, data, size);
    big_endian_put(out + 8 + size, (uint32_t)crc32(0, out + 4, size + 4));
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
    big_endian_put(out + at, (uint32_t)adler32(1, out + sizeof head, (uInt)size));
    return at + 4;
}

size_t png_encode(const struct png *image, uint8_t *out, size_t capacity)
{
    static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    uint8_t header[13] = { 0 }, rows[4096];
    assert_true((size_t)image->width * image->height * 8 + image->height < sizeof rows - 16);
    big_endian_put(header, image->width);
    big_endian_put(header + 4, image->height);
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

void png_resize(uint8_t *png, uint32_t width, uint32_t height)
{
    big_endian_put(png + 16, width);
    big_endian_put(png + 20, height);
    big_endian_put(png + 29, (uint32_t)crc32(0, png + 12, 17));
}

/* Deflate with fixed codes: a zero byte, then eight times 258 of them per period of 13 bytes. */
static void zeros_deflate(uint8_t *out, size_t periods)
{
    static const uint8_t period[13] = { 0x18, 0x05, 0xa3, 0x60, 0x14, 0x8c, 0x82,
                                        0x51, 0x30, 0x0a, 0x46, 0xc1, 0x28 };
    memcpy(out, (const uint8_t[3]){ 0x78, 0x01, 0x62 }, 3);
    for (size_t i = 0; i < periods; i++)
        memcpy(out + 3 + i * sizeof period, period, sizeof period);
}

size_t png_bomb_encode(uint8_t *out, size_t capacity)
{
    static const uint8_t texel[4];
    const size_t head = 8 + 25, ends = head + 8 + 3 + 4 + 12;
    png_encode(&(struct png){ 1, 1, 8, texel }, out, capacity);
    const size_t periods = (capacity - ends) / 13, size = 3 + 13 * periods;
    big_endian_put(out + head, (uint32_t)size);
    zeros_deflate(out + head + 8, periods);
    big_endian_put(out + head + 8 + size, (uint32_t)crc32(0, out + head + 4, (uInt)size + 4));
    return head + 12 + size + chunk_put(out + head + 12 + size, "IEND", texel, 0);
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
