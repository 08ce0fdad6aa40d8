/* SPDX-License-Identifier: MIT */
#include "files.h"
#include "unit.h"

#include "file/output_file.h"
#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WIDTH = 37, HEIGHT = 35, COUNT = WIDTH * HEIGHT };

static float pixels[4 * COUNT];
static char error[256];

/* Numbers over twelve decades that differ in every pixel and channel. */
static int make_folder_and_pixels(void **state)
{
    for (int i = 0; i < 4 * COUNT; i++)
        pixels[i] =
            i % 4 == 3 ? (float)(i % 101) / 100 : (float)pow(10, (i % 97) / 8.0 - 6) * (1 + (float)(i % 7));
    return files_setup(state);
}

static struct image write_and_read(const char *name, uint32_t channels)
{
    struct image image;
    if (!image_write_float(files_path(name), pixels, WIDTH, HEIGHT, channels, error, sizeof error) ||
        !image_read(&image, files_path(name), error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_false(image.display_referred);
    return image;
}

static float wanted_value(int i, uint32_t channels)
{
    const int c = i % 4;
    if (c == 3)
        return channels == 4 ? pixels[i] : 1;
    return pixels[channels == 1 ? i - c : i];
}

static void float_formats_give_back_the_same_bits(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t channels;
    } cases[] = { { "1.exr", 1 }, { "3.exr", 3 }, { "4.exr", 4 }, { "1.pfm", 1 }, { "3.PFM", 3 } };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        struct image image = write_and_read(cases[k].name, cases[k].channels);
        assert_int_equal(image.channels, cases[k].channels);
        for (int i = 0; i < 4 * COUNT; i++)
            assert_true(image.rgba[i] == wanted_value(i, cases[k].channels));
        image_finish(&image);
    }
}

/* RGBE shares an exponent: the error is at most 1/256 of the largest channel. */
static void hdr_is_off_by_less_than_its_shared_exponent_allows(void **state)
{
    (void)state;
    struct image image = write_and_read("3.hdr", 3);
    for (int i = 0; i < COUNT; i++) {
        const float *p = pixels + 4 * i;
        const float largest = fmaxf(p[0], fmaxf(p[1], p[2]));
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(image.rgba[4 * i + c] - p[c]) <= largest / 128);
    }
    image_finish(&image);
}

/* Powers of two are exact. Runs of every length that a row can begin, and values that have no exponent. */
static void hdr_runs_come_back_as_they_were(void **state)
{
    (void)state;
    enum { LENGTHS = 5, ROW = 300 };
    static const int lengths[LENGTHS] = { 1, 2, 3, 127, 128 };
    static float row[4 * ROW];
    for (int x = 0, run = 0, left = 0; x < ROW; x++, left--) {
        if (left == 0)
            left = lengths[run++ % LENGTHS];
        for (int c = 0; c < 3; c++)
            row[4 * x + c] = ldexpf(1, run + c);
    }
    memcpy(row + 4 * 290, (float[12]){ 0, 0, 0, 0, INFINITY, 0, 0, 0, NAN, -1, 1e-39f, 0 }, 12 * sizeof *row);
    struct image image;
    if (!image_write_float(files_path("r.hdr"), row, ROW, 1, 3, error, sizeof error) ||
        !image_read(&image, files_path("r.hdr"), error, sizeof error))
        fail_msg("%s", error);
    for (int i = 0; i < 4 * 290; i++)
        assert_true(i % 4 == 3 || image.rgba[i] == row[i]);
    assert_true(image.rgba[4 * 290] == 0 && image.rgba[4 * 291] > 9e37f && image.rgba[4 * 292] == 0);
    image_finish(&image);
}

static void png_gives_back_the_same_bytes(void **state)
{
    (void)state;
    static uint8_t bytes[4 * COUNT];
    for (int i = 0; i < 4 * COUNT; i++)
        bytes[i] = (uint8_t)(i * 7);
    for (uint32_t channels = 3; channels <= 4; channels++) {
        struct image image;
        if (!image_write_png(files_path("a.png"), bytes, WIDTH, HEIGHT, channels, error, sizeof error) ||
            !image_read(&image, files_path("a.png"), error, sizeof error))
            fail_msg("%s", error);
        assert_true(image.display_referred);
        assert_int_equal(image.channels, channels);
        for (int i = 0; i < 4 * COUNT; i++)
            assert_int_equal(lroundf(image.rgba[i] * 255), i % 4 == 3 && channels == 3 ? 255 : bytes[i]);
        image_finish(&image);
    }
}

static void a_big_endian_pfm_is_swapped(void **state)
{
    (void)state;
    /* Two rows of one pixel, from the bottom: 1.0, then 2.0. */
    files_write("big.pfm", "Pf\n1 2\n1.0\n\x3f\x80\x00\x00\x40\x00\x00\x00", 19);
    struct image image;
    assert_true(image_read(&image, files_path("big.pfm"), error, sizeof error));
    assert_true(image.rgba[0] == 2 && image.rgba[4] == 1);
    image_finish(&image);
}

static void broken_files_give_one_line_that_names_them(void **state)
{
    (void)state;
    static const struct {
        const char *name, *bytes;
    } cases[] = {
        { "empty.exr", "" },
        { "junk.exr", "this is no picture at all, but it is long enough to be read as a header" },
        { "magic.exr", "\x76\x2f\x31\x01\x02" },
        { "empty.hdr", "" },
        { "cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 8\n\x02\x02" },
        { "junk.png", "\x89PNG\r\n\x1a\n0000" },
        { "empty.pfm", "" },
        { "huge.pfm", "PF\n99999999 99999999\n-1\n" },
        { "zero.pfm", "PF\n0 5\n-1\n" },
        { "cut.pfm", "PF\n5 5\n-1\nabcd" },
        { "scale.pfm", "PF\n5 5\nnan\nabcd" },
        { "name.xyz", "" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct image image;
        files_write(cases[i].name, cases[i].bytes, strlen(cases[i].bytes));
        assert_false(image_read(&image, files_path(cases[i].name), error, sizeof error));
        assert_non_null(strstr(error, cases[i].name));
        assert_null(strchr(error, '\n'));
        assert_null(image.rgba);
    }
    struct image image;
    assert_false(image_read(&image, files_path("missing.exr"), error, sizeof error));
    assert_non_null(strstr(error, "missing.exr"));
}

/* Every length from nothing to all of the file: no crash, and success only when every pixel is there. */
static void truncated_files_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = { "t.exr", "t.pfm", "t.hdr", "t.png" };
    static const uint8_t bytes[4 * COUNT];
    for (int k = 0; k < 4; k++) {
        struct image image;
        const char *path = files_path(names[k]);
        assert_true(strcmp(names[k], "t.png") == 0
                        ? image_write_png(path, bytes, WIDTH, HEIGHT, 3, error, sizeof error)
                        : image_write_float(path, pixels, WIDTH, HEIGHT, 3, error, sizeof error));
        struct stat status;
        assert_int_equal(stat(files_path(names[k]), &status), 0);
        for (off_t size = status.st_size - 1; size >= 0; size -= 1 + size / 40) {
            assert_int_equal(truncate(files_path(names[k]), size), 0);
            assert_false(image_read(&image, files_path(names[k]), error, sizeof error));
            assert_null(image.rgba);
        }
    }
}

static void require_refused_under_name(const char *name, const char *other)
{
    char from[256];
    struct image image = write_and_read(name, 3);
    image_finish(&image);
    snprintf(from, sizeof from, "%s", files_path(name));
    assert_int_equal(rename(from, files_path(other)), 0);
    assert_false(image_read(&image, files_path(other), error, sizeof error));
}

/* Among them a TGA of 32 x 2 pixels, which has no signature. */
static void pictures_are_what_their_names_say(void **state)
{
    (void)state;
    static const uint8_t tga[18 + 3 * 64] = { 0, 0, 2, [12] = 32, [14] = 2, [16] = 24 };
    static const char *const names[] = { "a.png", "a.hdr", "a.pfm", "a.exr" };
    for (int i = 0; i < 4; i++) {
        struct image image;
        files_write(names[i], tga, sizeof tga);
        assert_false(image_read(&image, files_path(names[i]), error, sizeof error));
    }
    require_refused_under_name("b.pfm", "b.png");
    require_refused_under_name("b.hdr", "b.png");
    require_refused_under_name("b.exr", "b.hdr");
}

/* Overwrites `count` bytes of an attribute's value from `at`; type and size stand between it and its name. */
static void patch_exr(const char *name, const char *attribute, size_t at, const char *with, size_t count)
{
    char bytes[1 << 14];
    FILE *file = fopen(files_path(name), "rb");
    const size_t size = fread(bytes, 1, sizeof bytes, file), length = strlen(attribute) + 1;
    fclose(file);
    for (size_t i = 0; i + 40 < size; i++)
        if (memcmp(bytes + i, attribute, length) == 0) {
            memcpy(bytes + i + length + strlen(bytes + i + length) + 1 + 4 + at, with, count);
            files_write(name, bytes, size);
            return;
        }
    fail();
}

/* Its data window ends at (32767, 32767), low bytes first. */
static void enlarge_exr(const char *name)
{
    patch_exr(name, "dataWindow", 8, "\xff\x7f\0\0\xff\x7f\0\0", 8);
}

/* The first channel, alpha, is given a name that says nothing. */
static void an_exr_with_another_channel_is_read_as_without_it(void **state)
{
    (void)state;
    struct image image = write_and_read("extra.exr", 4);
    image_finish(&image);
    patch_exr("extra.exr", "channels", 0, "!", 1);
    if (!image_read(&image, files_path("extra.exr"), error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(image.channels, 3);
    for (int i = 0; i < 4 * COUNT; i++)
        assert_true(image.rgba[i] == wanted_value(i, 3));
    image_finish(&image);
}

static void require_refused(const char *name, const char *reason)
{
    struct image image;
    assert_false(image_read(&image, files_path(name), error, sizeof error));
    if (!strstr(error, name) || !strstr(error, reason))
        fail_msg("%s", error);
}

/* The last file is a hole that takes no room on the disk. */
static void only_plain_files_of_some_size_are_read(void **state)
{
    (void)state;
    static const char *const names[] = { "pipe.exr", "pipe.hdr", "pipe.pfm", "pipe.png" };
    for (int i = 0; i < 4; i++) {
        assert_int_equal(mkfifo(files_path(names[i]), 0600), 0);
        require_refused(names[i], "not a plain file");
    }
    files_write_text("hole.png", "");
    assert_int_equal(truncate(files_path("hole.png"), (INT64_C(16) << 30) + 1), 0);
    require_refused("hole.png", "larger than 16 GiB");
}

/* What the header says is held against the bytes that follow before room is made for it. */
static void small_files_cannot_claim_large_pictures(void **state)
{
    (void)state;
    static const char *const names[] = { "s.pfm", "s.hdr", "s.hdr", "s.exr" };
    static const char *const headers[] = { "PF\n30000 30000\n-1\n",
                                           "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 32767\n",
                                           "#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 32768\n", NULL };
    for (int i = 0; i < 4; i++) {
        if (headers[i])
            files_write_text(names[i], headers[i]);
        else if (image_write_float(files_path(names[i]), pixels, 2, 2, 3, error, sizeof error))
            enlarge_exr(names[i]);
        require_refused(names[i], "too short");
    }
}

/* Runs of a row: none of no length, none past the row's end. A row may also lie there as it is. */
static void hdr_rows_are_read_as_encoded(void **state)
{
    (void)state;
    static const struct {
        const char *rows;
        size_t size;
        bool good;
    } cases[] = {
        { "\2\2\0\x8\x88\x80\x88\x40\x88\x20\x88\x81", 12, true },
        { "\2\2\0\x8\x84\x80\4\x80\x80\x80\x80\x88\x40\x88\x20\x88\x81", 17, true },
        { "\2\2\0\x9\x88\x80\x88\x40\x88\x20\x88\x81", 12, false },
        { "\2\2\0\x8\x89\x80\x88\x40\x88\x20\x88\x81", 12, false },
        { "\2\2\0\x8\0\0\0\0\0\0\0\0", 12, false },
        { "\2\2\0\x8\x80\x80\x88\x40\x88\x20\x88\x81", 12, false },
        { "\2\2\0\x8\x88\x80\x88\x40\x88\x20\7\x81", 12, false },
        { "\x80\x40\x20\x81\x80\x40\x20\x81\x80\x40\x20\x81\x80\x40\x20\x81"
          "\x80\x40\x20\x81\x80\x40\x20\x81\x80\x40\x20\x81\x80\x40\x20\x81",
          32, true },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static const char header[] = "#?RGBE\nGAMMA=1\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
        char bytes[128];
        struct image image;
        memcpy(bytes, header, sizeof header - 1);
        memcpy(bytes + sizeof header - 1, cases[i].rows, cases[i].size);
        files_write("rows.hdr", bytes, sizeof header - 1 + cases[i].size);
        assert_int_equal(image_read(&image, files_path("rows.hdr"), error, sizeof error), cases[i].good);
        for (int k = 0; cases[i].good && k < 8; k++)
            assert_true(image.rgba[4 * k] == 1 && image.rgba[4 * k + 1] == 0.5f &&
                        image.rgba[4 * k + 2] == 0.25f && image.rgba[4 * k + 3] == 1);
        image_finish(&image);
    }
}

static void an_unwritable_place_gives_one_line_and_no_file(void **state)
{
    (void)state;
    const int before = files_count();
    static const uint8_t bytes[4];
    assert_false(image_write_float(files_path("none/a.exr"), pixels, 2, 2, 3, error, sizeof error));
    assert_non_null(strstr(error, "none/a.exr"));
    assert_false(image_write_png(files_path("none/a.png"), bytes, 1, 1, 3, error, sizeof error));
    assert_false(image_write_float(files_path("a.txt"), pixels, 2, 2, 3, error, sizeof error));
    assert_false(image_write_float(files_path("a.png"), pixels, 2, 2, 3, error, sizeof error));
    assert_false(output_file_check(files_path(""), error, sizeof error));
    assert_false(output_file_check("/dev/null", error, sizeof error));
    assert_true(output_file_check(files_path("fine.exr"), error, sizeof error));
    assert_int_equal(files_count(), before);
}

static void a_cancelled_file_leaves_the_old_one(void **state)
{
    (void)state;
    files_write("old.txt", "old", 3);
    const int before = files_count();
    struct output_file file;
    assert_true(output_file_begin(&file, files_path("old.txt"), error, sizeof error));
    fputs("new text", file.stream);
    output_file_cancel(&file);
    assert_int_equal(files_count(), before);
    struct stat status;
    assert_int_equal(stat(files_path("old.txt"), &status), 0);
    assert_int_equal(status.st_size, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(float_formats_give_back_the_same_bits),
        cmocka_unit_test(hdr_is_off_by_less_than_its_shared_exponent_allows),
        cmocka_unit_test(hdr_runs_come_back_as_they_were),
        cmocka_unit_test(an_exr_with_another_channel_is_read_as_without_it),
        cmocka_unit_test(png_gives_back_the_same_bytes),
        cmocka_unit_test(a_big_endian_pfm_is_swapped),
        cmocka_unit_test(broken_files_give_one_line_that_names_them),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(pictures_are_what_their_names_say),
        cmocka_unit_test(only_plain_files_of_some_size_are_read),
        cmocka_unit_test(small_files_cannot_claim_large_pictures),
        cmocka_unit_test(hdr_rows_are_read_as_encoded),
        cmocka_unit_test(an_unwritable_place_gives_one_line_and_no_file),
        cmocka_unit_test(a_cancelled_file_leaves_the_old_one),
    };
    return cmocka_run_group_tests(tests, make_folder_and_pixels, files_teardown);
}
