/* SPDX-License-Identifier: MIT
 * The list of light cells against one made here from the solid bits: which cells, in which order, and what
 * becomes of the light they had. */
#include "frame/stage.h"
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 32, CELLS = N * N * N };

/* ---- The list as it should be: blocks of 4^3 texels in order, texels in order within */

static bool is_solid(const struct gi_test *t, const uint64_t *bits, int x, int y, int z)
{
    return x >= 0 && y >= 0 && z >= 0 && x < N && y < N && z < N &&
           bits[gi_test_cell(t, 0, (uint32_t)x, (uint32_t)y, (uint32_t)z)] != 0;
}

static bool is_light_cell(const struct gi_test *t, const uint64_t *bits, const uint32_t texel[3])
{
    const ivec3 wrap = t->gi->volume.state.params.cascades[0].wrap;
    const int x = (int)(texel[0] - (uint32_t)wrap.x) & (N - 1),
              y = (int)(texel[1] - (uint32_t)wrap.y) & (N - 1),
              z = (int)(texel[2] - (uint32_t)wrap.z) & (N - 1);
    return !is_solid(t, bits, x, y, z) && (is_solid(t, bits, x - 1, y, z) || is_solid(t, bits, x + 1, y, z) ||
                                           is_solid(t, bits, x, y - 1, z) || is_solid(t, bits, x, y + 1, z) ||
                                           is_solid(t, bits, x, y, z - 1) || is_solid(t, bits, x, y, z + 1));
}

/* Texel indices; returns how many. */
static uint32_t expected_list(struct gi_test *t, uint32_t list[static CELLS])
{
    uint64_t *bits = gi_test_subvoxels(t);
    uint32_t count = 0;
    for (uint32_t i = 0; i < CELLS; i++) {
        const uint32_t block = i / 64, bit = i % 64, side = N / 4;
        const uint32_t texel[3] = { 4 * (block % side) + bit % 4, 4 * (block / side % side) + bit / 4 % 4,
                                    4 * (block / side / side) + bit / 16 };
        if (is_light_cell(t, bits, texel))
            list[count++] = texel[0] + N * (texel[1] + N * texel[2]);
    }
    free(bits);
    return count;
}

/* ---- A scene whose cascade begins in the middle of its volumes */

static struct sdfgi_settings settings(void)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = N;
    return s;
}

static void open_scene(struct gi_test *t, uint64_t room)
{
    const double low[3] = { 1, -4, -7 }, high[3] = { 8, 3, 1 };
    struct test_mesh soup = test_mesh_soup(3, 60, low, high, 1.5);
    const struct sdfgi_settings s = settings();
    gi_test_renew(t, &s);
    if (room > 0)
        t->gi->volume.resources->extent.light_cells = t->gi->volume.resources->extent.light_cells_max = room;
    pass_scene_stand(t, (double[]){ 5, -1, -3 });
    gi_test_add(t, &soup, gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 0, 0, 0 }));
    test_mesh_destroy(&soup);
    gi_test_update(t, 1);
}

static uint32_t counted(struct gi_test *t)
{
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    const uint32_t count = counters[SDFGI_COUNTER_LIGHT_CELLS];
    free(counters);
    return count;
}

static void require_list(struct gi_test *t, const uint32_t *expected, uint32_t count)
{
    uint32_t *list = gi_test_read(t, RESOURCE_LIGHT_CELLS, NULL);
    for (uint32_t i = 0; i < count; i++)
        REQUIRE_CMP(list[i] & 0xffffff, ==, expected[i]);
    free(list);
}

/* After a build all light cells are dirty. */
static void require_dirty_groups(struct gi_test *t, uint32_t count)
{
    uint32_t *groups = gi_test_read(t, RESOURCE_INDIRECT, NULL);
    REQUIRE_CMP(groups[0], ==, (count + SDFGI_GROUP_LINEAR - 1) / SDFGI_GROUP_LINEAR);
    free(groups);
}

static void the_list_is_complete_and_in_the_order_of_blocks(void **state)
{
    (void)state;
    static uint32_t expected[CELLS];
    open_scene(&pass_context, 0);
    REQUIRE_CMP(pass_context.gi->volume.state.params.cascades[0].wrap.x, !=, 0);
    const uint32_t count = expected_list(&pass_context, expected);
    REQUIRE_CMP(count, >, 2000u);
    REQUIRE_CMP(counted(&pass_context), ==, count);
    require_list(&pass_context, expected, count);
    require_dirty_groups(&pass_context, count);
}

/* ---- Listed again after a change: where a cell stands decides whether it keeps what it held */

/* A value for each entry, along the first axis. */
static void fill_light(struct gi_test *t, uint32_t light[static CELLS], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        light[i] = 77 + i;
    gpu_test_buffer_write(&t->gpu, t->gi->volume.resources->buffers[RESOURCE_LIGHT].handle, 0,
                          sizeof *light * count, light);
}

/* As when the cells [low, N) along x have been made again: those below are kept. Without light from the
 * probes, which would take the place of what cells held. */
static void list_again(struct gi_test *t, int32_t low)
{
    static struct frame frame;
    const struct frame_input input = { .extent = t->gi->volume.resources->extent,
                                       .counters = t->gi->volume.feedback.counters,
                                       .threads_per_ray = 1 };
    const struct situation_needs needs = {
        .holds = { [NEED_LIST] = true, [NEED_MASKS] = true, [NEED_DIRECT] = true }
    };
    memset(&frame, 0, sizeof frame);
    frame.next = t->gi->volume.state;
    frame.situation.from_nothing = true; /* no cached ray is looked at */
    struct change *change = &frame.next.cascades.at[0].change;
    *change = (struct change){ .cause = CHANGE_SCROLL,
                               .stage = CHANGE_COMPLETES,
                               .boxes = { { { low, 0, 0 }, { N, N, N } } },
                               .count = 1,
                               .kept = { { 0, 0, 0 }, { low, N, N } } };
    struct sdfgi_frame_params params = frame.next.params;
    params.cascades[0].dirty_count = 1;
    params.cascades[0].dirty[0] = (struct sdfgi_dirty_box){ .low = { low, 0, 0 }, .high = { N, N, N } };
    params.cascades[0].kept_low = (ivec3){ 0, 0, 0 };
    params.cascades[0].kept_high = (ivec3){ low, N, N };
    gpu_test_buffer_write(&t->gpu, t->gi->volume.resources->buffers[RESOURCE_FRAME].handle, 0, sizeof params,
                          &params);
    sdfgi_stage_complete(&(struct plan_stage){ &frame, &input, &needs });
    REQUIRE_TRUE(sdfgi_work_has(&frame.work, PASS_LIGHT_LIST) &&
                 !sdfgi_work_has(&frame.work, PASS_LIGHT_BOUNCE));
    pass_scene_run(t, &frame.work);
}

/* Returns how many cells keep their light. */
static uint32_t require_light(struct gi_test *t, const uint32_t before[static CELLS], const uint32_t *list,
                              uint32_t count, int32_t low)
{
    uint32_t *after = gi_test_read(t, RESOURCE_LIGHT, NULL), kept = 0;
    const int32_t wrap = t->gi->volume.state.params.cascades[0].wrap.x;
    for (uint32_t i = 0; i < count; i++) {
        const int32_t x = ((int32_t)(list[i] % N) - wrap) & (N - 1);
        REQUIRE_CMP(after[i], ==, x < low ? before[i] : 0u);
        kept += x < low;
    }
    free(after);
    return kept;
}

static void cells_that_stay_keep_their_light_and_others_forget_it(void **state)
{
    (void)state;
    static uint32_t expected[CELLS];
    static uint32_t light[CELLS];
    for (int32_t low = 8; low <= N; low += 8) {
        open_scene(&pass_context, 0);
        gi_test_update(&pass_context, 2);
        const uint32_t count = expected_list(&pass_context, expected);
        fill_light(&pass_context, light, count);
        list_again(&pass_context, low);
        require_list(&pass_context, expected, count);
        REQUIRE_CMP(require_light(&pass_context, light, expected, count, low), >, 0u);
    }
}

/* A bit per light cell of half a block, and the entry of the first, as lookups find them. */
static void require_blocks(struct gi_test *t, const uint32_t *expected, uint32_t count)
{
    uint32_t(*halves)[2] = gi_test_read(t, RESOURCE_LIGHT_BLOCKS, NULL), entry = 0;
    for (uint32_t b = 0; b < CELLS / 64; b++)
        for (uint32_t bit = 0; bit < 64; bit++) {
            const uint32_t *half = halves[2 * b + bit / 32], below = (1u << bit % 32) - 1;
            if ((half[0] >> bit % 32 & 1) == 0)
                continue;
            const uint32_t side = N / 4, x = 4 * (b % side) + bit % 4,
                           y = 4 * (b / side % side) + bit / 4 % 4, z = 4 * (b / side / side) + bit / 16;
            REQUIRE_CMP(entry, <, count);
            REQUIRE_CMP(x + N * (y + N * z), ==, expected[entry]);
            REQUIRE_CMP(half[1] + (uint32_t)__builtin_popcount(half[0] & below), ==, entry);
            entry++;
        }
    REQUIRE_CMP(entry, ==, count);
    free(halves);
}

static void lookups_find_each_cell_by_its_block(void **state)
{
    (void)state;
    static uint32_t expected[CELLS];
    open_scene(&pass_context, 0);
    const uint32_t count = expected_list(&pass_context, expected);
    require_blocks(&pass_context, expected, count);
    list_again(&pass_context, 16);
    require_blocks(&pass_context, expected, count);
}

static void without_room_the_first_cells_are_listed_and_the_others_counted(void **state)
{
    (void)state;
    enum { ROOM = 777 };
    static uint32_t expected[CELLS];
    open_scene(&pass_context, ROOM);
    const uint32_t count = expected_list(&pass_context, expected);
    REQUIRE_CMP(counted(&pass_context), ==, count);
    require_list(&pass_context, expected, ROOM);
    gi_test_update(&pass_context, 6);
    REQUIRE_CMP(pass_health_count(&pass_context, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, count - ROOM);
    REQUIRE_CMP(pass_context.messages[SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW], ==, 1u);
}

/* Planes across x, two cells apart: every cell of the second cascade is occupied, and every second one of the
 * first. Rays that leave the first along the planes pass no empty cell of the second. */
static void open_between_planes(void)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.cascades = 2;
    settings.resolution = 32;
    settings.ray_count = 25;
    settings.frames_to_converge = 1;
    struct test_mesh planes = { 0 };
    for (int k = -16; k < 16; k++) {
        struct test_mesh plane = test_mesh_plane((double[]){ 0.25 * (2 * k + 0.5), 0, 0 },
                                                 (double[]){ 0, 9, 0 }, (double[]){ 0, 0, 9 }, 1);
        test_mesh_append(&planes, &plane);
        test_mesh_destroy(&plane);
    }
    pass_scene_open(&pass_context, &settings, &planes);
    test_mesh_destroy(&planes);
}

static void hard_64_hits_without_a_light_cell_are_counted(void **state)
{
    (void)state;
    open_between_planes();
    gi_test_update(&pass_context, 4);
    uint64_t size;
    uint32_t *codes = gi_test_read(&pass_context, RESOURCE_RAYS, &size),
             *counters = gi_test_read(&pass_context, RESOURCE_COUNTERS, NULL), unlit = 0;
    for (uint64_t i = 0; i < size / 4; i++)
        unlit += codes[i] == SDFGI_RAY_UNLIT;
    printf("%u of %llu rays have no light cell\n", unlit, (unsigned long long)size / 4);
    HARD_CASE_AT_MOST(64, "hits without a light cell, less those counted",
                      fabs((double)unlit - counters[SDFGI_COUNTER_UNLIT_HITS]), 0);
    HARD_CASE_AT_LEAST(64, "hits without a light cell that are reported",
                       pass_health_count(&pass_context, SDFGI_MESSAGE_UNLIT_HITS), 1);
    free(codes);
    free(counters);
}

TEST_GROUP(light_list)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_list_is_complete_and_in_the_order_of_blocks),
        cmocka_unit_test(cells_that_stay_keep_their_light_and_others_forget_it),
        cmocka_unit_test(lookups_find_each_cell_by_its_block),
        cmocka_unit_test(without_room_the_first_cells_are_listed_and_the_others_counted),
        cmocka_unit_test(hard_64_hits_without_a_light_cell_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, pass_context_close);
}
