/* SPDX-License-Identifier: MIT
 * PNG files of every form give the texels that went in; whatever else bytes hold is refused, soon. */
#include "unit.h"

#include <picture/picture_png.h>

#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { SIDE_MAX = 9, CAPACITY = 1 << 14 };

struct form {
    uint32_t width, height;
    int color, depth, interlace;
};

struct file {
    uint8_t bytes[CAPACITY];
    size_t size;
};

static struct file file;
static struct picture_png png;
static char error[200];

static void append(png_structp writer, png_bytep bytes, size_t size)
{
    (void)writer;
    assert_true(size <= CAPACITY - file.size);
    memcpy(file.bytes + file.size, bytes, size);
    file.size += size;
}

static uint32_t channels_of(int color)
{
    static const uint32_t channels[] = { [PNG_COLOR_TYPE_GRAY] = 1,
                                         [PNG_COLOR_TYPE_RGB] = 3,
                                         [PNG_COLOR_TYPE_PALETTE] = 1,
                                         [PNG_COLOR_TYPE_GRAY_ALPHA] = 2,
                                         [PNG_COLOR_TYPE_RGB_ALPHA] = 4 };
    return channels[color];
}

/* Differs from neighbour to neighbour and channel to channel. */
static uint32_t sample(const struct form *form, uint32_t x, uint32_t y, uint32_t channel)
{
    return (x * 7919 + y * 10459 + channel * 15013 + 1) & ((1u << form->depth) - 1);
}

static void fill_row(const struct form *form, uint32_t y, uint8_t *row)
{
    const uint32_t channels = channels_of(form->color), depth = (uint32_t)form->depth;
    memset(row, 0, (size_t)SIDE_MAX * 8);
    for (uint32_t i = 0; i < form->width * channels; i++) {
        const uint32_t value = sample(form, i / channels, y, i % channels);
        if (depth == 16) {
            row[2 * i] = (uint8_t)(value >> 8);
            row[2 * i + 1] = (uint8_t)value;
        } else {
            row[i * depth / 8] |= (uint8_t)(value << (8 - depth - i * depth % 8));
        }
    }
}

/* Entry i of the palette is (i, 255 - i, 3 i), with alpha 128 + i / 2. */
static void write_palette(png_structp writer, png_infop info, int depth)
{
    png_color colors[256];
    uint8_t alphas[256];
    for (int i = 0; i < 1 << depth; i++) {
        colors[i] = (png_color){ (png_byte)i, (png_byte)(255 - i), (png_byte)(3 * i) };
        alphas[i] = (uint8_t)(128 + i / 2);
    }
    png_set_PLTE(writer, info, colors, 1 << depth);
    png_set_tRNS(writer, info, alphas, 1 << depth, NULL);
}

static png_structp begin(const struct form *form, png_infop *info)
{
    const png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    *info = png_create_info_struct(writer);
    file.size = 0;
    png_set_write_fn(writer, NULL, append, NULL);
    png_set_IHDR(writer, *info, form->width, form->height, form->depth, form->color, form->interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (form->color == PNG_COLOR_TYPE_PALETTE)
        write_palette(writer, *info, form->depth);
    png_write_info(writer, *info);
    return writer;
}

static void encode(const struct form *form)
{
    uint8_t rows[SIDE_MAX][SIDE_MAX * 8];
    png_infop info;
    png_structp writer = begin(form, &info);
    for (uint32_t y = 0; y < form->height; y++)
        fill_row(form, y, rows[y]);
    for (int pass = png_set_interlace_handling(writer); pass > 0; pass--)
        for (uint32_t y = 0; y < form->height; y++)
            png_write_row(writer, rows[y]);
    png_write_end(writer, info);
    png_destroy_write_struct(&writer, &info);
}

/* Black, of one bit a texel: deflate makes 8000 texels of each byte. */
static void encode_black(uint32_t width, uint32_t height)
{
    static const uint8_t row[1 << 10];
    png_infop info;
    png_structp writer = begin(&(struct form){ width, height, PNG_COLOR_TYPE_GRAY, 1, 0 }, &info);
    assert_true(width <= 8 * sizeof row);
    for (uint32_t y = 0; y < height; y++)
        png_write_row(writer, row);
    png_write_end(writer, info);
    png_destroy_write_struct(&writer, &info);
}

static uint32_t wanted(const struct form *form, uint32_t x, uint32_t y, uint32_t c, bool deep)
{
    const uint32_t value = sample(form, x, y, 0), most = deep ? 0xffff : 0xff;
    if (form->color == PNG_COLOR_TYPE_PALETTE)
        return (const uint32_t[]){ value, 255 - value, 3 * value & 255, 128 + value / 2 }[c];
    const bool grey = (form->color & PNG_COLOR_MASK_COLOR) == 0;
    if (c == 3 && (form->color & PNG_COLOR_MASK_ALPHA) == 0)
        return most;
    const uint32_t channel = sample(form, x, y, !grey ? c : c == 3 ? 1 : 0);
    if (form->depth == 16)
        return deep ? channel : channel >> 8;
    return channel * 255 / ((1u << form->depth) - 1);
}

static void require_texels(const struct form *form, bool deep)
{
    if (!picture_png_read(&png, file.bytes, file.size, deep, error, sizeof error))
        fail_msg("%u x %u, colour %d, depth %d: %s", form->width, form->height, form->color, form->depth,
                 error);
    assert_int_equal(png.width, form->width);
    assert_int_equal(png.height, form->height);
    assert_int_equal(png.depth, form->depth == 16 && deep ? 16 : 8);
    for (uint32_t i = 0; i < 4 * form->width * form->height; i++) {
        const uint32_t x = i / 4 % form->width, y = i / 4 / form->width;
        const uint32_t got = png.depth == 16 ? ((uint16_t *)png.texels)[i] : ((uint8_t *)png.texels)[i];
        assert_int_equal(got, wanted(form, x, y, i % 4, png.depth == 16));
    }
    free(png.texels);
}

static const int kinds[][2] = {
    { PNG_COLOR_TYPE_GRAY, 1 },       { PNG_COLOR_TYPE_GRAY, 2 },    { PNG_COLOR_TYPE_GRAY, 4 },
    { PNG_COLOR_TYPE_GRAY, 8 },       { PNG_COLOR_TYPE_GRAY, 16 },   { PNG_COLOR_TYPE_GRAY_ALPHA, 8 },
    { PNG_COLOR_TYPE_PALETTE, 1 },    { PNG_COLOR_TYPE_PALETTE, 4 }, { PNG_COLOR_TYPE_PALETTE, 8 },
    { PNG_COLOR_TYPE_RGB, 8 },        { PNG_COLOR_TYPE_RGB, 16 },    { PNG_COLOR_TYPE_RGB_ALPHA, 8 },
    { PNG_COLOR_TYPE_RGB_ALPHA, 16 },
};

static void every_form_gives_back_its_texels(void **state)
{
    (void)state;
    static const uint32_t sides[] = { 1, 2, 3, 5, 9 };
    for (uint32_t k = 0; k < 2 * 25 * sizeof kinds / sizeof *kinds; k++) {
        const int *kind = kinds[k / 50];
        const struct form form = { sides[k % 5], sides[k / 5 % 5], kind[0], kind[1], k / 25 % 2 };
        uint32_t width, height;
        encode(&form);
        assert_true(picture_png_size(file.bytes, file.size, &width, &height));
        assert_true(width == form.width && height == form.height);
        require_texels(&form, false);
        require_texels(&form, true);
    }
}

static void channels_are_those_of_the_file(void **state)
{
    (void)state;
    static const int colors[] = { PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                  PNG_COLOR_TYPE_RGB_ALPHA };
    static const uint32_t channels[] = { 1, 4, 3, 4 };
    for (int i = 0; i < 4; i++) {
        encode(&(struct form){ 2, 2, colors[i], 8, 0 });
        assert_true(picture_png_read(&png, file.bytes, file.size, false, error, sizeof error));
        assert_int_equal(png.channels, channels[i]);
        free(png.texels);
    }
}

static void refuse(size_t size)
{
    error[0] = '\0';
    assert_false(picture_png_read(&png, file.bytes, size, false, error, sizeof error));
    assert_null(png.texels);
    assert_true(error[0] != '\0' && strchr(error, '\n') == NULL);
}

static void every_truncation_is_refused(void **state)
{
    (void)state;
    for (int interlace = 0; interlace < 2; interlace++) {
        encode(&(struct form){ 9, 9, PNG_COLOR_TYPE_RGB, 8, interlace });
        for (size_t size = 0; size < file.size; size++)
            refuse(size);
    }
}

static void changed_bytes_are_refused(void **state)
{
    (void)state;
    encode(&(struct form){ 9, 9, PNG_COLOR_TYPE_PALETTE, 8, 0 });
    for (size_t i = 0; i < 64; i++) {
        file.bytes[i] ^= 0x10;
        refuse(file.size);
        file.bytes[i] ^= 0x10;
    }
}

static void put_word(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* A header that claims more than deflate can make of the file's bytes: nothing of that size is taken. */
static void a_small_file_cannot_claim_a_large_picture(void **state)
{
    (void)state;
    encode(&(struct form){ 1, 1, PNG_COLOR_TYPE_RGB, 8, 0 });
    put_word(file.bytes + 16, 30000);
    put_word(file.bytes + 20, 30000);
    put_word(file.bytes + 29, (uint32_t)crc32(0, file.bytes + 12, 17));
    refuse(file.size);
    assert_non_null(strstr(error, "too short"));
}

/* As floats, twice as many texels would take half a gigabyte. */
static void a_few_kilobytes_hold_a_black_picture_of_4096_x_4096_and_no_larger(void **state)
{
    (void)state;
    encode_black(4096, 4096);
    assert_true(file.size < 4096);
    assert_true(picture_png_read(&png, file.bytes, file.size, false, error, sizeof error));
    free(png.texels);
    encode_black(8192, 4096);
    refuse(file.size);
    assert_non_null(strstr(error, "too short"));
}

/* The header says two rows, the image data are those of one. */
static void image_data_that_end_before_the_last_row_are_refused(void **state)
{
    (void)state;
    for (int interlace = 0; interlace < 2; interlace++) {
        encode(&(struct form){ 4, 1, PNG_COLOR_TYPE_GRAY, 8, interlace });
        put_word(file.bytes + 20, 2);
        put_word(file.bytes + 29, (uint32_t)crc32(0, file.bytes + 12, 17));
        refuse(file.size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_form_gives_back_its_texels),
        cmocka_unit_test(channels_are_those_of_the_file),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(changed_bytes_are_refused),
        cmocka_unit_test(a_small_file_cannot_claim_a_large_picture),
        cmocka_unit_test(a_few_kilobytes_hold_a_black_picture_of_4096_x_4096_and_no_larger),
        cmocka_unit_test(image_data_that_end_before_the_last_row_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
