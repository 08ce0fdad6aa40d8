/* SPDX-License-Identifier: MIT
 * What is inside a pass is called for, too: nothing of the sky in a sealed room, of bounces without feedback,
 * or of the next cascade before the blend. What nothing calls for is changed, and no bit of light follows.
 * Shadow rays are counted in tests/pass/test_trace.c. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>
#include <stdlib.h>

enum { POINTS = 3 };

static void start(struct gi_test *t, uint32_t cascades, float feedback)
{
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    settings.cascades = cascades;
    settings.bounce_feedback = feedback;
    gi_test_restart(t, &settings);
}

/* A room of 3 m whose walls emit a little; `open`: with a window. */
static void start_room(struct gi_test *t, float feedback, bool open)
{
    const double center[3] = { 0, 0, 0 }, half[3] = { 1.5, 1.5, 1.5 };
    start(t, 1, feedback);
    if (!open) {
        light_add(t, test_mesh_room(center, half, 1, test_rotation_none), 0.8f, 0.1f);
        return;
    }
    light_add_box(t, (double[]){ -2, -2, -2 }, (double[]){ 2, -1.5, 2 }, (float[]){ 0.8f, 0.8f, 0.8f }, 0.1f);
    light_add_box(t, (double[]){ -2, -1.5, -2 }, (double[]){ -1.5, 2, 2 }, (float[]){ 0.8f, 0.8f, 0.8f },
                  0.1f);
}

static void look(struct gi_test *t, float found[static POINTS][3])
{
    static const struct gi_test_point points[POINTS] = { { { 0, 0, 0 }, { 0, 1, 0 } },
                                                         { { 0.3f, -1.5f, 0.2f }, { 0, 1, 0 } },
                                                         { { -1.5f, 0.1f, -0.3f }, { 1, 0, 0 } } };
    gi_test_irradiance(t, points, POINTS, found);
}

/* EFFECTS row 11. Without feedback light is at its end, and cycles after the change do not bring it nearer.
 */
static void a_sealed_room_calls_for_no_sky(void **state)
{
    struct gi_test *t = *state;
    for (int open = 0; open < 2; open++) {
        float before[POINTS][3], after[POINTS][3];
        start_room(t, 0, open);
        light_set_uniform_sky(t, 1);
        gi_test_converge(t, 200);
        look(t, before);
        light_set_uniform_sky(t, 1000);
        gi_test_converge(t, 200);
        look(t, after);
        REQUIRE_CMP(memcmp(before, after, sizeof before) != 0, ==, open != 0);
    }
}

/* EFFECTS row 13: light that makes no bounces has settled once it has arrived. */
static void no_feedback_calls_for_no_bounces(void **state)
{
    struct gi_test *t = *state;
    uint32_t frames[2];
    float found[2][POINTS][3];
    for (int i = 0; i < 2; i++) {
        start_room(t, (float)i, false);
        frames[i] = gi_test_converge(t, 300);
        look(t, found[i]);
    }
    printf("settled after %u frames without feedback, %u with it; light %.4f and %.4f of its source\n",
           frames[0], frames[1], (double)found[0][1][0] / (0.1 * PI), (double)found[1][1][0] / (0.1 * PI));
    REQUIRE_CMP(frames[0], <=, frames[1] / 2);
    REQUIRE_NEAR((double)found[0][1][0] / (0.1 * PI), 1, 0.01);
    REQUIRE_CMP((double)found[1][1][0] / (0.1 * PI), >, 4);
}

/* Makes everything that lookups read of the second cascade another light. */
static void poison_second_cascade(struct gi_test *t)
{
    static const enum resource read[] = { RESOURCE_SURFACES, RESOURCE_IRRADIANCE };
    for (size_t i = 0; i < sizeof read / sizeof *read; i++) {
        uint64_t size;
        uint8_t *bytes = gi_test_read(t, read[i], &size);
        for (uint64_t at = size / 2; at < size; at += 4)
            memcpy(bytes + at, &(uint32_t){ 0x3c003c00u }, 4);
        gpu_test_buffer_write(&t->gpu, t->gi->volume.resources->buffers[read[i]].handle, 0, size, bytes);
        free(bytes);
    }
}

/* EFFECTS row 18: the finer cascade ends 4 m from the camera; the blend begins a probe spacing and a cell
 * before that. */
static void no_cascade_is_read_before_the_blend(void **state)
{
    struct gi_test *t = *state;
    static const struct gi_test_point points[POINTS] = { { { 0.3f, -1, 0.2f }, { 0, 1, 0 } },
                                                         { { 1.4f, -1, 0.6f }, { 0, 1, 0 } },
                                                         { { 3.3f, -1, 0.2f }, { 0, 1, 0 } } };
    float before[POINTS][3], after[POINTS][3];
    start(t, 2, 1);
    light_add_box(t, (double[]){ -8, -2, -8 }, (double[]){ 8, -1, 8 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    light_set_uniform_sky(t, 1);
    gi_test_converge(t, 300);
    gi_test_irradiance(t, points, POINTS, before);
    poison_second_cascade(t);
    gi_test_irradiance(t, points, POINTS, after);
    REQUIRE_BYTES(before, after, 2 * sizeof before[0]);
    REQUIRE_CMP(memcmp(before[2], after[2], sizeof before[2]), !=, 0);
}

static bool has_pipeline(struct gi_test *t, enum pass pass)
{
    return t->gi->backend.pipelines.passes[pass][0] != VK_NULL_HANDLE;
}

/* A pipeline takes a driver up to a second: none is made that no frame with the settings can run. */
static void settings_call_for_their_pipelines(void **state)
{
    (void)state;
    static const enum pass first[] = { PASS_DISTANCE_EXACT, PASS_CELL_MASK, PASS_VOXELIZE },
                           then[] = { PASS_FLOOD_STEP, PASS_OCCLUSION_TRACE, PASS_CELL_GATHER,
                                      PASS_CELL_FILTER };
    struct gi_test t = { 0 };
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_PROBES;
    gi_test_open(&t, &settings);
    for (size_t i = 0; i < sizeof first / sizeof *first; i++)
        REQUIRE_TRUE(has_pipeline(&t, first[i]));
    for (size_t i = 0; i < sizeof then / sizeof *then; i++)
        REQUIRE_TRUE(!has_pipeline(&t, then[i]));
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.sdf_method = SDFGI_SDF_FLOOD;
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &settings), ==, (int)SDFGI_OK);
    for (size_t i = 0; i < sizeof then / sizeof *then; i++)
        REQUIRE_TRUE(has_pipeline(&t, then[i]));
    gi_test_close(&t);
}

TEST_GROUP(called_for)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sealed_room_calls_for_no_sky),
        cmocka_unit_test(no_feedback_calls_for_no_bounces),
        cmocka_unit_test(no_cascade_is_read_before_the_blend),
        cmocka_unit_test(settings_call_for_their_pipelines),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
