/* SPDX-License-Identifier: MIT
 * Reflections of a camera that moves: puddles and windows, and lit things that they mirror. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fog_scene.h"
#include "host_test.h"
#include "picture_flip.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 4 };
#define BRIGHTEST 5.0f /* of what glows, with what it reflects */

static struct host_device *device;

static bool is_full(void)
{
    return getenv("SDFGI_TEST_FULL") != NULL;
}

typedef float pixels[FOG_PIXELS][4];

/* ---- Scenes */

/* The first box is the mirror; the others glow, and are seen in the mirror alone, or above it. */
static const struct fog_box puddle[] = {
    { { 0, -1.5, 0 }, { 60, 1, 60 }, .color = { 0.9f, 0.9f, 0.9f, 1 }, .metal = true },
    { { -0.9, 0.3, -3.2 }, { 0.5, 1.2, 0.4 }, .color = { 0.5f, 0.5f, 0.5f, 1 }, .emission = 4 },
    { { 0.3, 0, -3 }, { 0.6, 0.4, 0.4 }, .color = { 0.5f, 0.5f, 0.5f, 1 }, .emission = 1 },
    { { 1.3, 0.5, -3.3 }, { 0.3, 1.6, 0.3 }, .color = { 0.5f, 0.5f, 0.5f, 1 }, .emission = 2 },
};
static const struct fog_box window[] = {
    { { 0, 0, -2.5 }, { 60, 60, 0.5 }, .color = { 0.9f, 0.9f, 0.9f, 1 }, .metal = true },
    { { -0.6, -1, -0.5 }, { 0.6, 0.4, 0.4 }, .color = { 0.5f, 0.5f, 0.5f, 1 }, .emission = 4 },
    { { 0.4, 1, 0.3 }, { 0.4, 0.4, 0.6 }, .color = { 0.5f, 0.5f, 0.5f, 1 }, .emission = 1 },
    { { 1.2, 0.5, 1.2 }, { 0.4, 0.8, 0.6 }, .color = { 0.5f, 0.5f, 0.5f, 1 }, .emission = 2 },
};

enum { BOXES = sizeof puddle / sizeof *puddle };

static struct fog_scene scene_of(const struct fog_box mirror[BOXES], float roughness)
{
    static struct fog_box boxes[BOXES];
    struct fog_scene scene = fog_scene_empty(0);
    memcpy(boxes, mirror, sizeof boxes);
    boxes[0].smoothness = 1 - roughness;
    scene.boxes = boxes;
    scene.box_count = BOXES;
    scene.gi = true;
    /* What glows shows at once; what it lights counts in sharp mirrors, which are tried in suite `full`. */
    scene.frames = is_full() ? 0 : 6;
    scene.view.materials = HOST_MATERIALS_GLTF;
    scene.view.sky = (struct host_sky){ { 0.2f, 0.3f, 0.5f }, { 0.4f, 0.4f, 0.4f }, { 0.1f, 0.1f, 0.1f } };
    scene.view.camera.yfov_rad = 0.7f;
    if (mirror == puddle)
        scene.view.camera.look_at[1] = -0.6;
    return scene;
}

/* ---- What a camera sees */

struct walk {
    pixels frames[FRAMES]; /* of a run beside the mirror, 5 m/s */
    pixels turned;         /* from where it began, by a hundredth of a degree */
};

static void frame(struct fog_stage *stage, pixels out)
{
    assert_true(host_renderer_frame(stage->renderer, &stage->camera));
    fog_stage_read(stage, out[0]);
}

static void walk(struct fog_scene scene, struct walk *out)
{
    struct fog_stage stage;
    fog_stage_open(&stage, device, &scene);
    for (int i = 0; i < FRAMES; i++) {
        stage.camera.position[0] = stage.camera.look_at[0] = i * 5.0 / 60;
        frame(&stage, out->frames[i]);
    }
    stage.camera.position[0] = 0;
    stage.camera.look_at[0] = tan(0.01 * 3.14159265 / 180);
    frame(&stage, out->turned);
    fog_stage_close(&stage);
}

/* Pixels whose green is not between those of the other picture's pixels around them, give or take `noise`. */
static uint32_t moved_by_more_than_a_pixel(pixels a, pixels b, float noise)
{
    uint32_t moved = 0;
    for (int y = 1; y < FOG_HEIGHT - 1; y++)
        for (int x = 1; x < FOG_WIDTH - 1; x++) {
            float low = BRIGHTEST, high = 0;
            for (int i = 0; i < 9; i++) {
                const float was = b[(y - 1 + i / 3) * FOG_WIDTH + x - 1 + i % 3][1];
                low = was < low ? was : low;
                high = was > high ? was : high;
            }
            const float is = a[y * FOG_WIDTH + x][1];
            moved += is < low - noise || is > high + noise;
        }
    return moved;
}

/* What the change of pixels from frame to frame is off that of pictures with 16 rays for each pixel, over the
 * light. */
static double crawl_of(const struct walk *seen, const struct walk *smooth)
{
    double off = 0, light = 0;
    for (int i = 1; i < FRAMES; i++)
        for (int k = 0; k < FOG_PIXELS; k++) {
            off += fabs((double)(seen->frames[i][k][1] - seen->frames[i - 1][k][1]) -
                        (double)(smooth->frames[i][k][1] - smooth->frames[i - 1][k][1]));
            light += (double)smooth->frames[i][k][1];
        }
    return off / light;
}

/* Mean FLIP of neighbouring frames. */
static double change_of(struct walk *w, float exposure)
{
    double sum = 0;
    for (int i = 1; i < FRAMES; i++)
        sum += picture_flip(w->frames[i - 1][0], w->frames[i][0], FOG_WIDTH, FOG_HEIGHT, exposure);
    return sum / (FRAMES - 1);
}

/* A pixel of a rough mirror is the mean of 16 rays, one of which may meet a lamp. Measured: FLIP is up to
 * 0.0025 more, and 0.014 to 0.039 crawls. Without the filter that is up to 0.1; FLIP does not tell. */
static void require_no_crawl(const char *name, const struct fog_box mirror[BOXES], float roughness)
{
    static struct walk seen, smooth;
    struct fog_scene scene = scene_of(mirror, roughness);
    walk(scene, &seen);
    scene.supersample = 4;
    walk(scene, &smooth);
    const float exposure = tone_exposure(smooth.frames[0][0], FOG_PIXELS);
    const double change = change_of(&seen, exposure), even = change_of(&smooth, exposure),
                 crawl = crawl_of(&seen, &smooth);
    const uint32_t moved = moved_by_more_than_a_pixel(seen.turned, seen.frames[0],
                                                      roughness > 0 ? BRIGHTEST / 16 : BRIGHTEST / 500);
    printf("%s, roughness %.2f: FLIP %.4f from frame to frame, %.4f with 16 rays a pixel; %.4f crawls; %u "
           "pixels moved\n",
           name, (double)roughness, change, even, crawl, moved);
    REQUIRE_CMP(even, >, 0.01);
    REQUIRE_CMP(change - even, <=, 0.005);
    REQUIRE_CMP(crawl, <=, 0.045);
    REQUIRE_CMP(moved, ==, 0u);
}

static void nothing_crawls_in_puddles_and_windows(void **state)
{
    (void)state;
    static const float roughnesses[] = { 0.15f, 0.08f, 0, 0.3f, 0.5f, 0.58f };
    for (int i = 0; i < (is_full() ? 6 : 1); i++) {
        require_no_crawl("window", window, roughnesses[i]);
        if (is_full())
            require_no_crawl("puddle", puddle, roughnesses[i]);
    }
}

TEST_GROUP(crawl)
{
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_crawls_in_puddles_and_windows),
    };
    return host_test_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
