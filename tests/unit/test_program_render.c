/* SPDX-License-Identifier: MIT
 * Pictures that the program renders: caches, debug views, both pictures of a pair, skies, exposure. */
#include "files.h"
#include "program_run.h"
#include "unit.h"

#include "image/image.h"
#include "image/tone.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels along a side of pictures. Where a test draws with a power of two, software drivers compile once
 * more. */
enum { PICTURE = 24 };

static void assert_renders(const char *environment, const char *picture)
{
    char arguments[256];
    snprintf(arguments, sizeof arguments,
             "render tiny.gltf --gi off --size 24x24 --frames 1 --quiet --out %s", picture);
    /* Mesa keeps compiled shaders too, and does so apart: only the first picture has to wait for them. */
    setenv("MESA_SHADER_CACHE_DIR", files_path("mesa"), 1);
    const struct program_run run = run_program(environment, arguments);
    unsetenv("MESA_SHADER_CACHE_DIR");
    assert_string_equal(run.err, "");
    assert_int_equal(run.code, 0);
}

static void a_picture_needs_no_cache_and_a_damaged_one_is_no_harm(void **state)
{
    (void)state;
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    assert_renders("XDG_CACHE_HOME=$PWD/cache", "first.png");
    run_in_folder("test $(ls cache/sdfgi | wc -l) = 1");
    run_in_folder("echo rubbish >$(ls -d cache/sdfgi/*)");
    assert_renders("XDG_CACHE_HOME=$PWD/cache", "second.png");
    run_in_folder("test $(ls cache/sdfgi | wc -l) = 1 && ! grep -q rubbish cache/sdfgi/*");
    run_in_folder("rm -r cache && mkdir cache && touch cache/sdfgi");
    assert_renders("XDG_CACHE_HOME=$PWD/cache", "third.png");
    assert_renders("env -u HOME -u XDG_CACHE_HOME", "fourth.png");
    run_in_folder("cmp first.png second.png && cmp first.png third.png && cmp first.png fourth.png");
    run_in_folder("rm -rf cache mesa *.png tiny.gltf");
}

/* Renders the triangle with no message, and reads the picture. */
static struct image render_tiny(const char *arguments, const char *picture)
{
    char line[512], error[256];
    snprintf(line, sizeof line,
             "render tiny.gltf --size 24x24 --quiet --set cascades=1 --set resolution=32 --out %s %s",
             picture, arguments);
    const struct program_run run = run_program("SDFGI_VALIDATION=1", line);
    assert_string_equal(run.err, "");
    assert_int_equal(run.code, 0);
    struct image image;
    assert_true(image_read(&image, files_path(picture), error, sizeof error));
    return image;
}

/* The triangle stands where the default camera looks, and faces +z. */
static struct image render_debug(const char *picture)
{
    return render_tiny("--frames 1 --debug solid", picture);
}

static void a_debug_view_is_written_instead_of_the_picture(void **state)
{
    (void)state;
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    struct image linear = render_debug("linear.pfm"), encoded = render_debug("encoded.png");
    int solid = 0;
    for (int i = 0; i < 4 * PICTURE * PICTURE; i++) {
        const float value = i % 4 == 3 ? 1 : tone_srgb_encode(linear.rgba[i]);
        assert_true(fabsf(encoded.rgba[i] - value) < 0.003f);
        solid += i % 4 == 0 && fabsf(linear.rgba[i] - 0.75f) < 0.001f;
        assert_true(i % 4 != 0 || linear.rgba[i] > 0.3f || linear.rgba[i] < 0.02f);
    }
    assert_in_range(solid, PICTURE * PICTURE / 16, PICTURE * PICTURE * 3 / 4);
    image_finish(&linear);
    image_finish(&encoded);
    run_in_folder("rm -f linear.pfm encoded.png tiny.gltf");
}

/* ---- With and without */

static double mean_of(const struct image *image)
{
    double sum = 0;
    for (uint32_t i = 0; i < 4 * image->width * image->height; i++)
        sum += i % 4 == 3 ? 0 : (double)image->rgba[i];
    return sum / (3 * image->width * image->height);
}

static struct image render_lit(const char *arguments, const char *picture)
{
    char line[256];
    snprintf(line, sizeof line, "--frames 6 --sky 2 --sun 0,-1,-1,1,1,1 %s", arguments);
    return render_tiny(line, picture);
}

static double reported_exposure(void)
{
    static const char key[] = "\"exposure\":";
    static char text[65536];
    files_take_text("r.json", text, sizeof text);
    const char *found = strstr(text, key);
    assert_non_null(found);
    return strtod(found + strlen(key), NULL);
}

/* The picture without GI beside the one with it is that of a run without GI, at the same exposure. */
static void both_pictures_have_the_same_exposure(void **state)
{
    (void)state;
    char arguments[128], error[256];
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    struct image on = render_lit("--off off.png --report r.json", "on.png"), off;
    snprintf(arguments, sizeof arguments, "--gi off --exposure %.17g", reported_exposure());
    struct image alone = render_lit(arguments, "alone.png");
    assert_true(image_read(&off, files_path("off.png"), error, sizeof error));
    assert_memory_equal(off.rgba, alone.rgba, sizeof(float[4 * PICTURE * PICTURE]));
    printf("# mean %.4f with GI, %.4f without\n", mean_of(&on), mean_of(&off));
    assert_true(mean_of(&on) > 1.02 * mean_of(&off));
    image_finish(&on);
    image_finish(&off);
    image_finish(&alone);
    run_in_folder("rm -f on.png off.png alone.png tiny.gltf");
}

/* ---- Skies */

static const float upper_half[3] = { 2, 1, 0.5f },
                   lower_half[3] = { 0.25f, 0.5f, 1 }; /* exact in all formats */

static void write_environment(const char *name)
{
    enum { WIDTH = 8, HEIGHT = 4 };
    float rgba[HEIGHT][WIDTH][4];
    char error[256];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            memcpy(rgba[y][x], y < HEIGHT / 2 ? upper_half : lower_half, sizeof upper_half);
            rgba[y][x][3] = 1;
        }
    assert_true(image_write_float(files_path(name), rgba[0][0], WIDTH, HEIGHT, 3, error, sizeof error));
}

static struct image render_under(const char *environment)
{
    char arguments[256];
    write_environment(environment);
    snprintf(arguments, sizeof arguments, "--frames 1 --view near.json --environment %s", environment);
    return render_tiny(arguments, "sky.pfm");
}

static void assert_color(const float *rgba, const float color[static 3], float tolerance)
{
    for (int k = 0; k < 3; k++)
        if (fabsf(rgba[k] - color[k]) > tolerance * color[k])
            fail_msg("%g %g %g instead of %g %g %g", (double)rgba[0], (double)rgba[1], (double)rgba[2],
                     (double)color[0], (double)color[1], (double)color[2]);
}

/* The sky is drawn, and lights the upright triangle, which sees as much of its upper half as of the lower. */
static void pictures_of_skies_are_shown_and_light(void **state)
{
    (void)state;
    static const char *const files[] = { "sky.hdr", "sky.exr" };
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    files_write_text("near.json", "{\"camera\":{\"position\":[0.3,0.3,1.5],\"look_at\":[0.3,0.3,0]}}");
    for (int i = 0; i < 2; i++) {
        struct image image = render_under(files[i]);
        assert_color(image.rgba, upper_half, 0.02f);
        assert_color(image.rgba + 4 * PICTURE * (PICTURE - 1), lower_half, 0.02f);
        const float *lit = image.rgba + 4 * (PICTURE * PICTURE / 2 + PICTURE / 2 - 1);
        float mean[3];
        for (int k = 0; k < 3; k++) /* only the ratio of channels: the material is not quite white */
            mean[k] = (upper_half[k] + lower_half[k]) * lit[1] / (upper_half[1] + lower_half[1]);
        assert_true(lit[1] > 0.4f && lit[1] < 0.75f);
        assert_color(lit, mean, 0.05f);
        image_finish(&image);
    }
    run_in_folder("rm -f sky.* near.json tiny.gltf");
}

/* ---- Exposure */

/* The darkest pixel of a triangle under a dim sky, over that sky. */
static float darkest_under_sky(float sky, const char *hint)
{
    char arguments[320], error[256];
    struct image image;
    snprintf(arguments, sizeof arguments,
             "render tiny.gltf --quiet --size 24x24 --frames 6 --sun none --sky %g --gi-exposure %s "
             "--out dim.pfm --set sdfgi_resolution=32 --set sdfgi_cascades=1 --set sdfgi_min_cell_size=0.2",
             (double)sky, hint);
    assert_int_equal(run_program("", arguments).code, 0);
    assert_true(image_read(&image, files_path("dim.pfm"), error, sizeof error));
    float darkest = image.rgba[0];
    for (uint32_t i = 0; i < 4 * image.width * image.height; i += 4)
        darkest = fminf(darkest, image.rgba[i]);
    image_finish(&image);
    return darkest / sky;
}

/* Under a sky of 1e-7 the smallest steps of half floats are more than half of the light: stored as it is, it
 * is a seventh too bright. With a hint that fits it is not; what is left is the picture's own rounding. */
static void the_exposure_for_the_library_arrives_there(void **state)
{
    (void)state;
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    const float bright = darkest_under_sky(1, "1"), fits = darkest_under_sky(1e-7f, "1e7"),
                none = darkest_under_sky(1e-7f, "1");
    printf("# a triangle under a sky: %.4f of it; of 1e-7 %.4f, without a hint %.4f\n", (double)bright,
           (double)fits, (double)none);
    assert_true(fabsf(fits / bright - 1) < 0.07f);
    assert_true(fabsf(none / bright - 1) > 0.1f);
    run_in_folder("rm -f dim.pfm tiny.gltf");
}

/* The mean of what of a light's light the picture shows after the last frame. */
static double direct_light(const char *light_from, const char *frames)
{
    char arguments[256], error[256];
    struct image image;
    snprintf(arguments, sizeof arguments, "--sky none %s %s --aov direct=direct.pfm", light_from, frames);
    image = render_tiny(arguments, "lit.png");
    image_finish(&image);
    assert_true(image_read(&image, files_path("direct.pfm"), error, sizeof error));
    const double light = mean_of(&image);
    image_finish(&image);
    return light;
}

/* It stands in the last frame where it was asked for. */
static void a_sun_that_turns_ends_where_it_is(void **state)
{
    (void)state;
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    const double still = direct_light("--sun 1,0,-1", "--frames 3"),
                 turned = direct_light("--sun 1,0,-1", "--frames 3 --turn-sun 120");
    printf("# direct light of a sun that stands: %.5f, and of one that has turned: %.5f\n", still, turned);
    assert_true(still > 0.01 && still == turned);
    run_in_folder("rm -f lit.png direct.pfm tiny.gltf");
}

/* It has its own power in the last frame, and another one before. */
static void a_lamp_that_flickers_ends_as_it_is(void **state)
{
    (void)state;
    if (run_program("", "info").code != 0)
        skip();
    files_write_triangle("tiny.gltf");
    files_write_text("lamp.view.json",
                     "{ \"camera\": { \"position\": [0.3, 0.3, 3], \"look_at\": [0.3, 0.3, 0] },"
                     "  \"lights\": [{ \"type\": \"point\", \"position\": [0.3, 0.3, 1],"
                     "                \"intensity\": [2, 2, 2] }] }");
    const double still = direct_light("--view lamp.view.json", "--frames 3"),
                 flickered = direct_light("--view lamp.view.json", "--frames 3 --flicker 80");
    printf("# direct light of a lamp that is steady: %.5f, and of one that has flickered: %.5f\n", still,
           flickered);
    assert_true(still > 0.01 && still == flickered);
    run_in_folder("rm -f lit.png direct.pfm tiny.gltf lamp.view.json");
}

int main(int argc, char **argv)
{
    if (argc < 2)
        return EXIT_FAILURE;
    program_set(argv[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_needs_no_cache_and_a_damaged_one_is_no_harm),
        cmocka_unit_test(a_debug_view_is_written_instead_of_the_picture),
        cmocka_unit_test(both_pictures_have_the_same_exposure),
        cmocka_unit_test(pictures_of_skies_are_shown_and_light),
        cmocka_unit_test(the_exposure_for_the_library_arrives_there),
        cmocka_unit_test(a_sun_that_turns_ends_where_it_is),
        cmocka_unit_test(a_lamp_that_flickers_ends_as_it_is),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
