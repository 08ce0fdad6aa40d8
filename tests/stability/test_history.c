/* SPDX-License-Identifier: MIT
 * Light that is kept from frame to frame: whatever bits lie there, it is finite at once, and right again soon
 * (HARD_CASES row 32). Histories of probes are floats, and what no float of theirs can be is forgotten. What
 * cells keep is coded in whole numbers: any bits are light that might have been there, and fade as fast as
 * such light, within a gather cycle. Light creeps to its target from below and from above (row 30), and for
 * as long as one likes (row 67). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct gi_test_point points[] = {
    { { 0.2f, -1.9f, 0.3f }, { 0, 1, 0 } },
    { { 1.9f, -1, 0.4f }, { -1, 0, 0 } },
    { { 0, 0.5f, 0 }, { 0, 1, 0 } }, /* in the air: probes answer */
};
enum { POINTS = sizeof points / sizeof *points };

/* The brightest light that cells can keep, a number that is none, and any bits; and, in full, more. */
static const uint32_t patterns[] = { 0xffffffff, 0x7fc00001, 0xdeadbeef, 0xff800000, 0x7f800000,
                                     0x7c007c00, 0xfc00fc00, 0x7e007e00, 0x7f7fffff };
enum {
    PATTERNS = sizeof patterns / sizeof *patterns,
    FEW_PATTERNS = 3,
    MOST_HISTORIES = 3,
    PARTS = 8,
    CYCLES_BEFORE = 6
};

/* What is spoiled. */
struct histories {
    enum sdfgi_surface_light surface_light;
    enum resource which[MOST_HISTORIES];
};

static const struct histories of_probes = { SDFGI_SURFACE_LIGHT_PROBES,
                                            { RESOURCE_SUMS, RESOURCE_PREVIOUS, RESOURCE_IRRADIANCE } };
static const struct histories of_cells = { SDFGI_SURFACE_LIGHT_CELLS,
                                           { RESOURCE_LIGHT, RESOURCE_SURFACES, RESOURCE_GATHERED } };

/* Frames of a sample cycle, or of a gather cycle if each light cell is visited in every frame. */
static uint32_t cycle_frames(const struct sdfgi_settings *settings)
{
    const bool cells = settings->surface_light == SDFGI_SURFACE_LIGHT_CELLS;
    return cells ? sdfgi_settings_cycle_visits(settings) : sdfgi_settings_cycle_frames(settings);
}

/* Probes keep half floats. Light that crept to its value may have been rounded to the step beside it. */
#define HALF_FLOAT_STEP (1.0 / 1024)

struct spoiling {
    struct gi_test *t;
    const struct histories *histories;
    uint32_t pattern;
};

static void record_fill(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct spoiling *s = user;
    const struct gpu_buffer *buffers = s->t->gi->volume.resources->buffers;
    (void)index;
    for (int i = 0; i < MOST_HISTORIES; i++)
        vkCmdFillBuffer(cmd, buffers[s->histories->which[i]].handle, 0, VK_WHOLE_SIZE, s->pattern);
}

/* Looks at the points. Returns how many values are no light. */
static uint32_t values_spoiled(struct gi_test *t, float found[static POINTS][3])
{
    uint32_t count = 0;
    gi_test_irradiance(t, points, POINTS, found);
    for (int i = 0; i < 3 * POINTS; i++)
        count += !isfinite(found[i / 3][i % 3]) || found[i / 3][i % 3] < 0;
    return count;
}

/* Largest relative difference. */
static double worst_of(float (*found)[3], float (*wanted)[3])
{
    double worst = 0;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)found[i][k] / (double)wanted[i][k] - 1));
    return worst;
}

/* A floor and a wall that glows, under a sky. */
static void start_corner(struct gi_test *t, const struct sdfgi_settings *settings)
{
    gi_test_restart(t, settings);
    light_set_uniform_sky(t, 1);
    light_add_box(t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ 0.7f, 0.7f, 0.7f }, 0);
    light_add_box(t, (double[]){ 2, -2, -3 }, (double[]){ 3, 0, 3 }, (float[]){ 0.2f, 0.6f, 0.3f }, 0.5f);
}

/* Goes on for a cycle, as if light were new. Returns how many values were no light. Prints how far off light
 * is on the way. */
static uint32_t go_on(struct gi_test *t, uint32_t frames, float (*wanted)[3])
{
    float found[POINTS][3];
    uint32_t spoiled = 0;
    sdfgi_volume_invalidate(&t->gi->volume);
    for (uint32_t frame = 1; frame <= frames; frame++) {
        gi_test_update(t, 1);
        spoiled += values_spoiled(t, found);
        if (frame * PARTS % frames == 0)
            printf(" %.2g", worst_of(found, wanted));
    }
    printf("\n");
    return spoiled;
}

/* Spoils the histories with each pattern. Returns the largest relative error of light after a cycle; until
 * then it must be finite in each frame. Suite `full` lets light settle first; by default that of cells has
 * CYCLES_BEFORE gather cycles, in which it comes within the tolerance of it. */
static double spoil(struct gi_test *t, const struct histories *histories)
{
    struct sdfgi_settings settings = light_exact_settings(32, 0.4f);
    settings.surface_light = histories->surface_light;
    float before[POINTS][3], found[POINTS][3];
    double worst = 0;
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    const int count = full ? PATTERNS : FEW_PATTERNS;
    start_corner(t, &settings);
    if (histories->surface_light == SDFGI_SURFACE_LIGHT_CELLS && !full)
        gi_test_update(t, CYCLES_BEFORE * cycle_frames(&settings));
    else
        gi_test_converge(t, 2000);
    gi_test_irradiance(t, points, POINTS, before);
    for (int i = 0; i < count; i++) {
        gpu_test_submit(&t->gpu, record_fill, &(struct spoiling){ t, histories, patterns[i] });
        uint32_t spoiled = values_spoiled(t, found);
        printf("0x%08x: off by", patterns[i]);
        spoiled += go_on(t, cycle_frames(&settings), before);
        gi_test_irradiance(t, points, POINTS, found);
        worst = fmax(worst, worst_of(found, before));
        HARD_CASE_AT_MOST(32, "values that are not finite, from the first frame on", spoiled, 0);
    }
    return worst;
}

static void hard_32_any_bits_in_histories_of_probes_become_light_in_a_cycle(void **state)
{
    HARD_CASE_AT_MOST(32, "light one sample cycle after any bits in probes, off by",
                      spoil(*state, &of_probes), HALF_FLOAT_STEP);
}

static void hard_32_any_bits_in_what_cells_keep_become_light_in_a_cycle(void **state)
{
    HARD_CASE_AT_MOST(32, "light one gather cycle after any bits in light cells, off by",
                      spoil(*state, &of_cells), 0.01);
}

/* ---- Targets that light creeps to */

/* The largest relative error of settled light. */
static double settled_error(struct gi_test *t, double exact)
{
    float found[POINTS][3];
    double worst = 0;
    gi_test_converge(t, 400);
    gi_test_irradiance(t, points, POINTS, found);
    for (int i = 0; i < 3 * POINTS; i++)
        worst = fmax(worst, fabs((double)found[i / 3][i % 3] / PI / exact - 1));
    return worst;
}

/* A sky that changes by a thousandth in each frame, less than a step of the formats in which light is kept,
 * until it is 1. */
static double error_after_creeping(struct gi_test *t, float from, float step)
{
    for (int i = 0; i <= 30; i++) {
        light_set_uniform_sky(t, from + step * (float)i);
        gi_test_update(t, 1);
    }
    light_set_uniform_sky(t, 1);
    return settled_error(t, 1);
}

static void hard_30_probes_creep_to_their_target_from_both_sides(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.4f);
    gi_test_restart(t, &settings);
    const double below = error_after_creeping(t, 0.97f, 1e-3f),
                 above = error_after_creeping(t, 1.03f, -1e-3f);
    printf("sky: off by %.5f from below, %.5f from above\n", below, above);
    HARD_CASE_AT_MOST(30, "light of a sky that creeps up, off by", below, 0.005);
    HARD_CASE_AT_MOST(30, "light of a sky that creeps down, off by", above, 0.005);
}

/* A furnace settles once a cycle adds less than 1/1024; what its bounces would add after that is missing: at
 * this albedo up to four times as much, less than the limit. Light cells that gather are tested in suite
 * `full`. */
static void hard_30_bounces_creep_to_their_target_from_both_sides(void **state)
{
    struct gi_test *t = *state;
    const double albedo = floor(0.8 * 1023 + 0.5) / 1023; /* as it is stored */
    for (int cells = 0; cells < (getenv("SDFGI_TEST_FULL") ? 2 : 1); cells++) {
        struct sdfgi_settings settings = light_settings(32, 0.4f);
        settings.surface_light = cells ? SDFGI_SURFACE_LIGHT_CELLS : SDFGI_SURFACE_LIGHT_PROBES;
        settings.cell_rays = 16;
        settings.cell_rays_per_frame = 1 << 17;
        gi_test_restart(t, &settings);
        light_add(t, test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 2, 2, 2 }, 1, test_rotation_none),
                  0.8f, 1);
        const double below = settled_error(t, 1 / (1 - albedo));
        const struct sdfgi_light_desc lamp = light_point(0.1, 0.4, -0.2, 10);
        const sdfgi_light light = light_create(t, &lamp);
        REQUIRE_CMP(settled_error(t, 1 / (1 - albedo)), >, 0.1);
        REQUIRE_CMP((int)sdfgi_light_destroy(t->gi, light), ==, (int)SDFGI_OK);
        const double above = settled_error(t, 1 / (1 - albedo));
        printf("furnace, %s: off by %.5f from below, %.5f from above\n", cells ? "cells" : "probes", below,
               above);
        HARD_CASE_AT_MOST(30, "furnace of albedo 0.8 from below, off by", below, 0.005);
        HARD_CASE_AT_MOST(30, "furnace of albedo 0.8 from above, off by", above, 0.005);
    }
}

/* ---- Numbers of frames and cycles */

/* As if so many frames and cycles had gone by. An even number: frames in flight keep their slots. */
static void age(struct gi_test *t, uint64_t more)
{
    struct volume_state *s = &t->gi->volume.state;
    t->gi->backend.retired.frame += more;
    s->updates += more;
    s->accumulation.cycle += more;
    s->accumulation.invalid_cycle += more;
    s->accumulation.invalidations += more;
    s->gathering.invalidations += more;
    for (int c = 0; c < SDFGI_MAX_CASCADES; c++) {
        s->gathering.at[c].cycle += more;
        s->gathering.at[c].invalid_cycle += more;
    }
}

/* Light after some frames of a young or an old context, and how long it then takes to settle. */
static uint32_t frames_to_settle(struct gi_test *t, uint64_t more, float found[2][POINTS][3])
{
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 16;
    settings.cell_rays_per_frame = 1 << 17;
    start_corner(t, &settings);
    gi_test_update(t, 2);
    age(t, more);
    gi_test_update(t, 9);
    gi_test_irradiance(t, points, POINTS, found[0]);
    const uint32_t frames = gi_test_converge(t, 400);
    gi_test_irradiance(t, points, POINTS, found[1]);
    REQUIRE_CMP(t->messages[SDFGI_MESSAGE_UPDATE_LOST], ==, 0u);
    return frames;
}

static void hard_67_light_does_not_depend_on_how_many_frames_went_by(void **state)
{
    static const uint64_t ages[] = { UINT64_C(1) << 24, UINT64_C(1) << 32, UINT64_C(1) << 31,
                                     UINT64_C(1) << 48 };
    const size_t count = getenv("SDFGI_TEST_FULL") ? 4 : 2;
    float young[2][POINTS][3], old[2][POINTS][3];
    const uint32_t frames = frames_to_settle(*state, 0, young);
    uint32_t differ = 0;
    for (size_t i = 0; i < count; i++) {
        REQUIRE_CMP(frames_to_settle(*state, ages[i] - 4, old), ==, frames);
        for (int k = 0; k < 2; k++)
            differ += memcmp(young[k], old[k], sizeof young[k]) != 0;
    }
    HARD_CASE_AT_MOST(67, "looks after 2^24 to 2^48 frames whose bits differ", differ, 0);
}

TEST_GROUP(history)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    static struct gi_test t;
    const struct sdfgi_settings settings = light_settings(32, 0.4f);
    gi_test_open(&t, &settings);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(hard_32_any_bits_in_histories_of_probes_become_light_in_a_cycle, &t),
        cmocka_unit_test_prestate(hard_32_any_bits_in_what_cells_keep_become_light_in_a_cycle, &t),
        cmocka_unit_test_prestate(hard_30_probes_creep_to_their_target_from_both_sides, &t),
        cmocka_unit_test_prestate(hard_30_bounces_creep_to_their_target_from_both_sides, &t),
        cmocka_unit_test_prestate(hard_67_light_does_not_depend_on_how_many_frames_went_by, &t),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gi_test_close(&t);
    return failed;
}
