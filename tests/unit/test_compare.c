/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include "compare/compare.h"
#include "image/flip.h"
#include "image/tone.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, COUNT = WIDTH * HEIGHT };

static char error[300];

/* Stripes, discs and a gradient over four decades of radiance; `shift` moves it to the right, by pixels. */
static struct image make_scene(int shift)
{
    struct image image;
    assert_true(image_init(&image, WIDTH, HEIGHT, error, sizeof error));
    for (int i = 0; i < COUNT; i++) {
        const int x = i % WIDTH - shift + WIDTH, y = i / WIDTH;
        const float disc = hypotf((float)(x % 32) - 16, (float)(y % 32) - 16) < 9 ? 4.0f : 0.05f;
        image.rgba[4 * i] = disc * (0.2f + (float)(x % WIDTH) / WIDTH);
        image.rgba[4 * i + 1] = x / 6 % 2 ? disc : 0.02f;
        image.rgba[4 * i + 2] = disc * (float)y / HEIGHT;
        image.rgba[4 * i + 3] = 1;
    }
    return image;
}

static void blur_once(struct image *image)
{
    struct image copy;
    assert_true(image_init(&copy, WIDTH, HEIGHT, error, sizeof error));
    memcpy(copy.rgba, image->rgba, sizeof(float) * 4 * COUNT);
    for (int i = 0; i < 4 * COUNT; i++) {
        const int x = i / 4 % WIDTH;
        const float left = copy.rgba[x > 0 ? i - 4 : i], right = copy.rgba[x < WIDTH - 1 ? i + 4 : i];
        image->rgba[i] = (left + copy.rgba[i] + right) / 3;
    }
    image_finish(&copy);
}

static struct compare_result compare(const struct image *a, const struct image *b)
{
    struct compare_result result;
    if (!compare_images(&(struct compare_input){ a, "a" }, &(struct compare_input){ b, "b" }, NULL, &result,
                        NULL, error, sizeof error))
        fail_msg("%s", error);
    return result;
}

static void a_picture_equals_itself(void **state)
{
    (void)state;
    struct image image = make_scene(0);
    const struct compare_result r = compare(&image, &image);
    assert_int_equal(r.pixels, COUNT);
    assert_true(r.flip == 0 && r.flip_max == 0 && r.relmse == 0 && r.p99_relative_error == 0);
    assert_true(r.mean_ratio == 1);
    assert_true(isinf(r.psnr_db));
    image_finish(&image);
}

static void errors_grow_with_shift(void **state)
{
    (void)state;
    struct image image = make_scene(0);
    struct compare_result last = { .psnr_db = HUGE_VAL };
    for (int shift = 1; shift <= 3; shift++) {
        struct image moved = make_scene(shift);
        const struct compare_result r = compare(&moved, &image);
        assert_true(r.flip > last.flip && r.relmse > last.relmse && r.psnr_db < last.psnr_db);
        last = r;
        image_finish(&moved);
    }
    image_finish(&image);
}

static void errors_grow_with_blur(void **state)
{
    (void)state;
    struct image image = make_scene(0), blurred = make_scene(0);
    struct compare_result last = { .psnr_db = HUGE_VAL };
    for (int i = 0; i < 4; i++) {
        blur_once(&blurred);
        const struct compare_result r = compare(&blurred, &image);
        assert_true(r.flip > last.flip && r.relmse > last.relmse && r.psnr_db < last.psnr_db);
        last = r;
    }
    image_finish(&image);
    image_finish(&blurred);
}

/* The error is symmetric: both pictures go through the same filters and only absolute differences count. */
static void flip_is_symmetric(void **state)
{
    (void)state;
    struct image a = make_scene(0), b = make_scene(2);
    float *errors[2];
    for (int i = 0; i < 4 * COUNT; i++) {
        a.rgba[i] = fminf(a.rgba[i] / 4, 1);
        b.rgba[i] = fminf(b.rgba[i] / 4, 1);
    }
    for (int k = 0; k < 2; k++) {
        errors[k] = calloc(COUNT, sizeof(float));
        assert_true(flip_ldr(k ? b.rgba : a.rgba, k ? a.rgba : b.rgba, WIDTH, HEIGHT, errors[k]));
    }
    assert_memory_equal(errors[0], errors[1], COUNT * sizeof(float));
    for (int i = 0; i < COUNT; i++)
        assert_true(errors[0][i] >= 0 && errors[0][i] <= 1);
    free(errors[0]);
    free(errors[1]);
    image_finish(&a);
    image_finish(&b);
}

/* On the test pair that comes with the metric, within half of the fourth decimal. */
static void flip_reproduces_published_means(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double mean;
    } cases[] = { { "noise", 0.099167 }, { "shift", 0.128711 }, { "hue", 0.214418 }, { "blur", 0.087216 } };
    const char *folder = getenv("SDFGI_SCENES");
    char path[512];
    struct image reference;
    snprintf(path, sizeof path, "%s/flip/r.png", folder ? folder : SOURCE_ROOT "/../shared/scenes");
    if (!image_read(&reference, path, error, sizeof error)) {
        print_message("skipped: %s\n", error);
        skip();
    }
    for (int i = 0; i < 4; i++) {
        struct image test;
        snprintf(path, sizeof path, "%s/flip/%s.png", folder ? folder : SOURCE_ROOT "/../shared/scenes",
                 cases[i].name);
        if (!image_read(&test, path, error, sizeof error))
            fail_msg("%s", error);
        const double mean = compare(&test, &reference).flip;
        if (fabs(mean - cases[i].mean) >= 5e-5)
            fail_msg("%s: %.6f, published %.6f", cases[i].name, mean, cases[i].mean);
        image_finish(&test);
    }
    image_finish(&reference);
}

static void measures_have_their_stated_values(void **state)
{
    (void)state;
    struct image a, b;
    assert_true(image_init(&a, 10, 10, error, sizeof error));
    assert_true(image_init(&b, 10, 10, error, sizeof error));
    for (int i = 0; i < 400; i++) {
        a.rgba[i] = i / 4 == 7 ? 3 : 1.5f;
        b.rgba[i] = 1;
    }
    const struct compare_result r = compare(&a, &b);
    assert_true(fabs(r.mean_ratio - 1.515) < 1e-5);
    assert_true(fabs(r.relmse - (99 * 0.25 + 4) / 100 / 1.01) < 1e-6);
    assert_true(fabs(r.p99_relative_error - 0.5) < 1e-5);
    assert_true(fabs(r.exposure - 0.18) < 1e-6);
    image_finish(&a);
    image_finish(&b);
}

static void scaling_both_pictures_changes_only_relmse(void **state)
{
    (void)state;
    struct image a = make_scene(0), b = make_scene(1);
    const struct compare_result before = compare(&a, &b);
    for (int i = 0; i < 4 * COUNT; i++) {
        a.rgba[i] *= 1024;
        b.rgba[i] *= 1024;
    }
    const struct compare_result after = compare(&a, &b);
    assert_true(fabs(after.flip - before.flip) < 1e-5);
    assert_true(fabs(after.psnr_db - before.psnr_db) < 1e-3);
    assert_true(fabs(after.mean_ratio - before.mean_ratio) < 1e-6);
    assert_true(fabs(after.p99_relative_error - before.p99_relative_error) < 1e-5);
    image_finish(&a);
    image_finish(&b);
}

static void only_pixels_in_the_mask_count(void **state)
{
    (void)state;
    struct image a = make_scene(0), b = make_scene(0), mask;
    assert_true(image_init(&mask, WIDTH, HEIGHT, error, sizeof error));
    for (int i = 0; i < COUNT; i++) {
        const bool inside = i % WIDTH < WIDTH / 2;
        mask.rgba[4 * i] = inside ? 1 : 0.5f;
        if (!inside)
            a.rgba[4 * i] += 10;
    }
    const struct compare_input inputs[] = { { &a, "a" }, { &b, "b" }, { &mask, "mask" } };
    struct compare_result r;
    assert_true(compare_images(&inputs[0], &inputs[1], &inputs[2], &r, NULL, error, sizeof error));
    assert_int_equal(r.pixels, COUNT / 2);
    assert_true(r.relmse == 0 && r.mean_ratio == 1 && isinf(r.psnr_db));
    memset(mask.rgba, 0, sizeof(float) * 4 * COUNT);
    assert_false(compare_images(&inputs[0], &inputs[1], &inputs[2], &r, NULL, error, sizeof error));
    assert_non_null(strstr(error, "mask"));
    image_finish(&a);
    image_finish(&b);
    image_finish(&mask);
}

static void a_black_reference_has_no_ratio_but_a_maximum(void **state)
{
    (void)state;
    struct image a = make_scene(0), b;
    assert_true(image_init(&b, WIDTH, HEIGHT, error, sizeof error));
    const struct compare_result r = compare(&a, &b);
    assert_true(isnan(r.mean_ratio) && r.max > 1 && isfinite(r.flip) && isfinite(r.relmse));
    image_finish(&a);
    image_finish(&b);
}

static void what_cannot_be_compared_is_refused_by_name(void **state)
{
    (void)state;
    struct image a = make_scene(0), b = make_scene(0), small;
    assert_true(image_init(&small, WIDTH, HEIGHT - 1, error, sizeof error));
    const struct compare_input ia = { &a, "a.exr" }, ib = { &b, "b.exr" }, ismall = { &small, "small.exr" };
    struct compare_result r;
    assert_false(compare_images(&ia, &ismall, NULL, &r, NULL, error, sizeof error));
    assert_string_equal(error, "a.exr is 96 x 64, small.exr is 96 x 63: expected equal sizes");
    assert_false(compare_images(&ia, &ib, &ismall, &r, NULL, error, sizeof error));
    assert_non_null(strstr(error, "small.exr"));
    b.display_referred = true;
    assert_false(compare_images(&ia, &ib, NULL, &r, NULL, error, sizeof error));
    assert_non_null(strstr(error, "PNG"));
    b.display_referred = false;
    b.rgba[4 * (WIDTH * 3 + 5) + 1] = NAN;
    assert_false(compare_images(&ia, &ib, NULL, &r, NULL, error, sizeof error));
    assert_string_equal(error, "b.exr: pixel 5, 3 is not finite");
    image_finish(&a);
    image_finish(&b);
    image_finish(&small);
}

static void a_strip_shows_picture_reference_and_errors(void **state)
{
    (void)state;
    struct image picture = make_scene(3), reference = make_scene(0);
    float *flip_map = malloc(COUNT * sizeof *flip_map);
    uint8_t *strip = malloc((size_t)4 * COMPARE_STRIP_PANELS * COUNT), *map = malloc((size_t)4 * COUNT);
    assert_true(flip_map && strip && map);
    struct compare_result r;
    assert_true(compare_images(&(struct compare_input){ &picture, "a" },
                               &(struct compare_input){ &reference, "b" }, NULL, &r, flip_map, error,
                               sizeof error));
    compare_paint_strip(&picture, &reference, flip_map, r.exposure, strip);
    compare_paint_map(flip_map, COUNT, map);
    const struct image *const panels[2] = { &picture, &reference };
    for (int i = 0; i < COUNT; i++) {
        const uint8_t *const row = strip + 4 * COMPARE_STRIP_PANELS * WIDTH * (i / WIDTH);
        for (int p = 0; p < 2; p++) {
            float shown[3];
            tone_map(panels[p]->rgba + 4 * i, (float)r.exposure, shown);
            for (int c = 0; c < 3; c++)
                assert_true(fabsf((float)row[4 * (p * WIDTH + i % WIDTH) + c] - 255 * shown[c]) <= 0.51f);
        }
        assert_memory_equal(row + 4 * (2 * WIDTH + i % WIDTH), map + 4 * i, 4);
    }
    free(flip_map);
    free(strip);
    free(map);
    image_finish(&picture);
    image_finish(&reference);
}

static void srgb_curve_and_its_inverse_agree(void **state)
{
    (void)state;
    for (int i = 0; i <= 1000; i++) {
        const float x = (float)i / 1000;
        assert_true(fabsf(tone_srgb_decode(tone_srgb_encode(x)) - x) < 1e-5f);
    }
    assert_true(tone_srgb_encode(-1) == 0 && fabsf(tone_srgb_encode(5) - 1) < 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_equals_itself),
        cmocka_unit_test(errors_grow_with_shift),
        cmocka_unit_test(errors_grow_with_blur),
        cmocka_unit_test(flip_is_symmetric),
        cmocka_unit_test(flip_reproduces_published_means),
        cmocka_unit_test(measures_have_their_stated_values),
        cmocka_unit_test(scaling_both_pictures_changes_only_relmse),
        cmocka_unit_test(only_pixels_in_the_mask_count),
        cmocka_unit_test(a_black_reference_has_no_ratio_but_a_maximum),
        cmocka_unit_test(what_cannot_be_compared_is_refused_by_name),
        cmocka_unit_test(a_strip_shows_picture_reference_and_errors),
        cmocka_unit_test(srgb_curve_and_its_inverse_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
