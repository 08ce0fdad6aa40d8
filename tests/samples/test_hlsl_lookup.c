/* SPDX-License-Identifier: MIT
 * Lookups in HLSL answer as those in GLSL do. */
#include "gi_test.h"
#include "gpu_test_compute.h"
#include "require.h"

#include "lookup.comp.h"
#include "lookup_hlsl.h"
#include "lookup_software.comp.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 48, ROW = 16, FRAMES = 8 };

/* A red wall glows beside a grey block, on a floor. */
static void open_scene(struct gi_test *t)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.cascades = 2;
    gi_test_open(t, &s);
    struct test_mesh room =
        test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 2, 2, 2 }, 0.5, test_rotation_none);
    gi_test_add(t, &room, gi_test_material(t, (float[]){ 0.6f, 0.5f, 0.4f }, (float[]){ 3, 1, 0.5f }));
    test_mesh_destroy(&room);
    gi_test_update(t, FRAMES);
}

/* Points of the floor and of a wall, and some in the air, seen from the middle. */
static void place(float rows[POINTS][ROW])
{
    memset(rows, 0, sizeof(float[POINTS][ROW]));
    for (int i = 0; i < POINTS; i++) {
        const float u = 0.37f * (float)(i % 8) - 1.3f, v = 0.51f * (float)(i / 8) - 1.28f;
        const float at[3][3] = { { u, -1.99f, v }, { -1.99f, u, v }, { u, v, 0.3f } };
        memcpy(rows[i], at[i % 3], sizeof at[0]);
        rows[i][4 + (i % 3 == 0 ? 1 : 0)] = 1;
        for (int k = 0; k < 3; k++)
            rows[i][8 + k] = -rows[i][k];
    }
}

static void look_up(struct gi_test *t, const struct gpu_test_shader *shader, float rows[POINTS][ROW])
{
    place(rows);
    gpu_test_compute(&t->gpu, shader, POINTS, rows, sizeof(float[POINTS][ROW]));
}

/* Compilers fuse operations differently: 1e-4 is a hundred times what that does to a value. */
static void hlsl_answers_as_glsl_does(void **state)
{
    (void)state;
    static struct gi_test t;
    static float glsl[POINTS][ROW], hlsl[POINTS][ROW];
    open_scene(&t);
    struct gpu_test_shader shader = GI_TEST_SHADER(t.gi, sdfgi_get_descriptor_set(t.gi), lookup);
    look_up(&t, &shader, glsl);
    shader.code = lookup_hlsl;
    shader.code_size = sizeof lookup_hlsl;
    look_up(&t, &shader, hlsl);
    int lit = 0, apart = 0;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 12; k++) {
            lit += k != 3 && k != 7 && glsl[i][k] > 0.05f;
            apart += !(fabsf(glsl[i][k] - hlsl[i][k]) <= 1e-4f * fabsf(glsl[i][k]) + 1e-6f);
        }
    printf("%d values of %d are lit, %d differ\n", lit, 12 * POINTS, apart);
    REQUIRE_CMP(lit, >, 9 * POINTS);
    REQUIRE_CMP(apart, ==, 0);
    gi_test_close(&t);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = { cmocka_unit_test(hlsl_answers_as_glsl_does) };
    return cmocka_run_group_tests_name("hlsl_lookup", tests, NULL, NULL);
}
