/* SPDX-License-Identifier: MIT
 * Light cells that a gathered picture reads are visited more often than others, and gather more rays. */
#include "gather_picture.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 60, STATE_PLANE = 18, FIRST = 2, GOES_ON = 5, LONG = 6 };

/* A frame visits a hundred surfaces. */
static void open_empty(struct gi_test *t, struct picture_scene *scene)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.resolution = 32;
    settings.cell_rays = 128;
    settings.cell_rays_per_frame = 1600;
    *scene = (struct picture_scene){ .count = 0 };
    gi_test_open(t, &settings);
}

static void open_ground(struct gi_test *t, struct picture_scene *scene)
{
    open_empty(t, scene);
    picture_scene_add(scene, t,
                      test_mesh_box((double[]){ 0, -1.5, 0 }, (double[]){ 3, 0.5, 3 }, test_rotation_none),
                      0.5f, 0);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &(struct sdfgi_sky){ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }), ==,
                (int)SDFGI_OK);
}

/* From above, a small part of the ground. */
static const struct picture_camera above = { .position = { 0.4, 1.5, 0.3 },
                                             .right = { 1, 0, 0 },
                                             .up = { 0, 0, -1 },
                                             .forward = { 0, -1, 0 },
                                             .tan_x = 0.4,
                                             .tan_y = 0.4,
                                             .near_m = 0.05 };

struct progress {
    uint32_t cells;
    uint32_t complete, in_long, after_long; /* those with a complete cycle, in long ones, and with one */
};

/* Of the cells that are seen, [1], and of those that are not, [0]. */
static void read_progress(struct gi_test *t, struct progress found[static 2])
{
    const uint64_t room = t->gi->volume.resources->extent.light_cells;
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL),
             *seen = gi_test_read(t, RESOURCE_SEEN, NULL),
             *gathered = gi_test_read(t, RESOURCE_GATHERED, NULL), marked = 0;
    for (uint32_t i = 0; i < counters[SDFGI_COUNTER_LIGHT_CELLS]; i++) {
        struct progress *p = &found[seen[i / 32] >> (i % 32) & 1];
        p->cells++;
        const uint32_t mean = gathered[STATE_PLANE * room + i] >> 7 & 7;
        p->complete += mean >= FIRST;
        p->in_long += mean >= GOES_ON;
        p->after_long += mean >= LONG;
        marked += seen[i / 32] >> (i % 32) & 1;
    }
    REQUIRE_CMP(counters[SDFGI_COUNTER_CELLS_SEEN], ==, marked);
    free(counters);
    free(seen);
    free(gathered);
}

/* The sun shines on a box beside the ground that the picture shows, and few rays find it. */
static void add_sunlit_box(struct gi_test *t)
{
    const struct sdfgi_light_desc sun = light_sun(0.9f, -0.4f, 0.1f, 100);
    light_add_box(t, (double[]){ 1.9, -1.5, -0.1 }, (double[]){ 2.6, 0.2, 0.6 },
                  (float[]){ 0.9f, 0.9f, 0.9f }, 0);
    light_create(t, &sun);
}

enum { SIDE = 68, PIXELS = SIDE * SIDE };

static void look(struct gi_test *t, const struct picture *picture, float light[static PIXELS])
{
    float(*found)[3] = picture_gather(t, picture, SDFGI_GATHER_FULL);
    for (int i = 0; i < PIXELS; i++)
        light[i] = found[i][1];
    free(found);
}

/* Root of the mean square of the difference, over the mean. */
static double difference(const float a[static PIXELS], const float b[static PIXELS])
{
    double sum = 0, squares = 0;
    for (int i = 0; i < PIXELS; i++) {
        sum += (double)b[i] / PIXELS;
        squares += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]) / PIXELS;
    }
    return sqrt(squares) / sum;
}

/* Against 2,048 rays a surface, after two cycles and after some long ones. */
static void seen_cells_gather_four_times_the_rays(void **state)
{
    (void)state;
    enum { SOON = FRAMES / 2, LATE = 3 * FRAMES };
    static float soon[PIXELS], late[PIXELS], exact[PIXELS];
    struct gi_test t;
    struct picture_scene scene;
    struct progress found[2] = { { 0 } };
    open_ground(&t, &scene);
    add_sunlit_box(&t);
    struct picture picture = picture_draw(&scene, &above, SIDE, SIDE);
    for (int i = 0; i < LATE; i++) {
        gi_test_update(&t, 1);
        look(&t, &picture, i < SOON ? soon : late);
    }
    read_progress(&t, found);
    struct sdfgi_settings settings = t.gi->settings;
    settings.cell_rays = 2048;
    settings.cell_rays_per_frame = 1 << 20;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &settings), ==, (int)SDFGI_OK);
    gi_test_update(&t, 180); /* all cells in each: rough cycles, and one of 128 visits */
    look(&t, &picture, exact);
    const double before = difference(soon, exact), after = difference(late, exact);
    printf(
        "%u of %u cells that are seen have completed a long cycle, and %u of %u others; light is off by %.4f "
        "after %d frames and by %.4f after %d\n",
        found[1].after_long, found[1].cells, found[0].after_long, found[0].cells, before, SOON, after, LATE);
    REQUIRE_CMP(found[1].after_long, >=, found[1].cells * 9 / 10);
    REQUIRE_CMP(found[0].after_long, ==, 0u);
    REQUIRE_CMP(after, <=, 0.53 * before);
    picture_finish(&picture);
    picture_scene_finish(&scene);
    gi_test_close(&t);
}

/* Light makes a bounce in a cycle: in a bright room it needs many. */
static void cells_whose_light_still_changes_have_short_cycles(void **state)
{
    (void)state;
    struct gi_test t;
    struct picture_scene scene;
    struct progress found[2] = { { 0 } };
    open_empty(&t, &scene);
    picture_scene_add(&scene, &t,
                      test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 2, 2, 2 }, 0.5, test_rotation_none),
                      0.95f, 0.05f);
    struct picture picture = picture_draw(&scene, &above, SIDE, SIDE);
    for (int i = 0; i < FRAMES; i++) {
        gi_test_update(&t, 1);
        free(picture_gather(&t, &picture, SDFGI_GATHER_FULL));
    }
    read_progress(&t, found);
    printf("bright room: %u of %u cells that are seen have completed a cycle, and %u are in long ones\n",
           found[1].complete, found[1].cells, found[1].in_long);
    REQUIRE_CMP(found[1].complete, >=, found[1].cells * 9 / 10);
    REQUIRE_CMP(found[1].in_long, ==, 0u);
    picture_finish(&picture);
    picture_scene_finish(&scene);
    gi_test_close(&t);
}

static void what_a_picture_shows_is_visited_first(void **state)
{
    (void)state;
    for (int looks = 0; looks < 2; looks++) {
        struct gi_test t;
        struct picture_scene scene;
        struct progress found[2] = { { 0 } };
        open_ground(&t, &scene);
        const struct picture picture = picture_draw(&scene, &above, 68, 68);
        for (int i = 0; i < FRAMES; i++) {
            gi_test_update(&t, 1);
            if (looks)
                free(picture_gather(&t, &picture, i % 2 ? SDFGI_GATHER_HALF : SDFGI_GATHER_FULL));
        }
        read_progress(&t, found);
        printf("%u of %u cells that are seen have completed a cycle, and %u of %u others\n",
               found[1].complete, found[1].cells, found[0].complete, found[0].cells);
        REQUIRE_TRUE(looks ? found[1].cells >= 20 : found[1].cells == 0);
        REQUIRE_CMP(found[1].complete, >=, found[1].cells * 9 / 10);
        REQUIRE_CMP(found[0].complete, <=, found[0].cells / 2);
        picture_scene_finish(&scene);
        gi_test_close(&t);
    }
}

TEST_GROUP(gather_seen)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_picture_shows_is_visited_first),
        cmocka_unit_test(seen_cells_gather_four_times_the_rays),
        cmocka_unit_test(cells_whose_light_still_changes_have_short_cycles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
