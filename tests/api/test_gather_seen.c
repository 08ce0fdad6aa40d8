/* SPDX-License-Identifier: MIT
 * Light cells that a gathered picture reads are visited more often than others. */
#include "gather_picture.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAMES = 60, STATE_PLANE = 18, FIRST = 2 };

static void open_ground(struct gi_test *t, struct picture_scene *scene)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.resolution = 32;
    settings.cell_rays = 128;
    settings.cell_rays_per_frame = 1600;
    *scene = (struct picture_scene){ .count = 0 };
    gi_test_open(t, &settings);
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
    uint32_t cells, complete; /* light cells, and those with a complete cycle */
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
        p->complete += (gathered[STATE_PLANE * room + i] >> 7 & 7) >= FIRST;
        marked += seen[i / 32] >> (i % 32) & 1;
    }
    REQUIRE_CMP(counters[SDFGI_COUNTER_CELLS_SEEN], ==, marked);
    free(counters);
    free(seen);
    free(gathered);
}

static void what_a_picture_shows_is_visited_first(void **state)
{
    (void)state;
    for (int looks = 0; looks < 2; looks++) {
        struct gi_test t;
        struct picture_scene scene;
        struct progress found[2] = { { 0 } };
        open_ground(&t, &scene);
        const struct picture picture = picture_draw(&scene, &above, 64, 64);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
