/* SPDX-License-Identifier: MIT
 * What a picture shows calls for rays, and for the filter over them (EFFECTS rows 20 to 22). */
#include "light_scene.h"
#include "mirror.h"
#include "require.h"
#include "test_group.h"

#include "shaders/shared/constants.h"

enum { TILE = SDFGI_GROUP_PIXELS, SIDE = 5 * TILE, PIXELS = SIDE * SIDE };
#define HALF_M 0.5f

struct tile_work {
    uint32_t rays[3], unused, tiles[3];
};
static_assert(offsetof(struct tile_work, tiles) == SDFGI_TILES_TILES * sizeof(uint32_t),
              "as in the list of tiles");

/* Groups of the indirect dispatches for a surface that is rough but for some tiles in its first row. */
static struct tile_work work_of_surface(struct gi_test *t, int smooth_tiles)
{
    static float roughness[PIXELS];
    static uint16_t texels[PIXELS][4];
    struct mirror surface;
    struct tile_work work;
    for (int i = 0; i < PIXELS; i++)
        roughness[i] = i < TILE * SIDE && i % SIDE < TILE * smooth_tiles ? 0 : 1;
    mirror_open_rough(&surface, t, SIDE, SIDE, HALF_M, roughness);
    mirror_read(&surface, texels);
    gpu_test_buffer_read(&t->gpu, surface.view->tiles.handle, 0, sizeof work, &work);
    mirror_close(&surface);
    return work;
}

/* All passes are recorded either way, and run over what is in the lists. */
static void rays_are_sent_for_tiles_that_are_smooth(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    gi_test_restart(t, &settings);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 2);
    for (int smooth = 0; smooth < 4; smooth++) {
        const struct tile_work work = work_of_surface(t, smooth);
        const int rays = smooth * TILE * TILE;
        REQUIRE_CMP(work.tiles[0], ==, (uint32_t)smooth);
        REQUIRE_CMP(work.rays[0], ==, (uint32_t)((rays + SDFGI_GROUP_REFLECT - 1) / SDFGI_GROUP_REFLECT));
        REQUIRE_CMP(work.rays[1] * work.rays[2] * work.tiles[1] * work.tiles[2], ==, 1u);
    }
}

TEST_GROUP(reflection_work)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_are_sent_for_tiles_that_are_smooth),
    };
    return cmocka_run_group_tests_name("reflection_work", tests, light_open, light_close);
}
