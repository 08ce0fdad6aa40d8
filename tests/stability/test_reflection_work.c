/* SPDX-License-Identifier: MIT
 * What a picture shows calls for rays, and for the filter over them (EFFECTS rows 20 to 22). */
#include "light_scene.h"
#include "mirror.h"
#include "require.h"
#include "test_group.h"

#include "shaders/shared/constants.h"

enum { TILE = SDFGI_GROUP_PIXELS, SIDE = 5 * TILE, PIXELS = SIDE * SIDE };
#define HALF_M 0.5f
#define MIRROR 0.002f
#define SMOOTH 0.01f /* a narrow view shows the lobe */
#define GLOSS  0.18f /* the filter runs twice over it */

struct tile_work {
    uint32_t rays[3], unused, tiles[3];
};
static_assert(offsetof(struct tile_work, tiles) == SDFGI_TILES_TILES * sizeof(uint32_t),
              "as in the list of tiles");

/* Groups of the indirect dispatches for a surface that is rough but for some tiles in its first row. */
static struct tile_work work_of_surface(struct gi_test *t, int smooth_tiles, float smooth)
{
    static float roughness[PIXELS];
    static uint16_t texels[PIXELS][4];
    struct mirror surface;
    struct tile_work work;
    for (int i = 0; i < PIXELS; i++)
        roughness[i] = i < TILE * SIDE && i % SIDE < TILE * smooth_tiles ? smooth : 1;
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
    for (int i = 0; i < 8; i++) {
        const bool is_mirror = i % 2 == 0;
        const int smooth = i / 2, rays = smooth * TILE * TILE;
        const struct tile_work work = work_of_surface(t, smooth, is_mirror ? MIRROR : SMOOTH);
        REQUIRE_CMP(work.tiles[0], ==, is_mirror ? 0u : (uint32_t)smooth);
        REQUIRE_CMP(work.rays[0], ==, (uint32_t)((rays + SDFGI_GROUP_REFLECT - 1) / SDFGI_GROUP_REFLECT));
        REQUIRE_CMP(work.rays[1] * work.rays[2] * work.tiles[1] * work.tiles[2], ==, 1u);
    }
}

/* The filter leaves tiles of mirrors out, so that its pictures hold there what an earlier resolve has left:
 * light of a sky that has gone. */
static void gloss_takes_no_light_from_mirrors_beside_it(void **state)
{
    struct gi_test *t = *state;
    static float even[PIXELS], mixed[PIXELS];
    static uint16_t texels[PIXELS][4];
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    struct mirror gloss, both;
    for (int i = 0; i < PIXELS; i++) {
        even[i] = GLOSS;
        mixed[i] = i % SIDE < 2 * TILE ? MIRROR : GLOSS;
    }
    gi_test_restart(t, &settings);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 2);
    mirror_open_rough(&gloss, t, SIDE, SIDE, HALF_M, even);
    mirror_open_rough(&both, t, SIDE, SIDE, HALF_M, mixed);
    gi_test_resolve(t, both.view, &gloss.desc);
    mirror_read(&both, texels);
    for (int i = 0; i < PIXELS; i++)
        REQUIRE_CMP(gi_test_half(texels[i][1]), >, 0.5f);
    light_set_uniform_sky(t, 0);
    gi_test_update(t, 2);
    mirror_read(&both, texels);
    for (int i = 0; i < PIXELS; i++)
        REQUIRE_CMP(gi_test_half(texels[i][1]), ==, 0.0f);
    mirror_close(&both);
    mirror_close(&gloss);
}

TEST_GROUP(reflection_work)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_are_sent_for_tiles_that_are_smooth),
        cmocka_unit_test(gloss_takes_no_light_from_mirrors_beside_it),
    };
    return cmocka_run_group_tests_name("reflection_work", tests, light_open, light_close);
}
