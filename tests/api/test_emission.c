/* SPDX-License-Identifier: MIT
 * Emission keeps its value whatever else the scene holds. */
#include "gi_test.h"
#include "require.h"

#include <sdfgi/inspect.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const float levels[] = { 1e-4f, 3e-3f, 0.5f, 40, 2e3f, 1e6f };
enum { LEVELS = sizeof levels / sizeof *levels };

static double level_x(int level)
{
    return 2.5 * level - 6.25;
}

/* A slab for each level, whose top lies in the middle of a layer of blocks. */
static void add_slabs(struct gi_test *t)
{
    for (int i = 0; i < LEVELS; i++) {
        const float emission[3] = { levels[i], 0.5f * levels[i], 0.25f * levels[i] };
        struct test_mesh slab = test_mesh_box((double[]){ level_x(i), -0.5, 0 }, (double[]){ 0.8, 0.75, 0.8 },
                                              test_rotation_none);
        gi_test_add(t, &slab, gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, emission));
        test_mesh_destroy(&slab);
    }
}

/* As many digits as nine bits hold, over ten powers of ten, beside a material that nothing shows and that is
 * brighter still. */
static void emission_keeps_its_digits(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    gi_test_material(&t, (float[]){ 0, 0, 0 }, (float[]){ 6e7f, 6e7f, 6e7f });
    add_slabs(&t);
    gi_test_update(&t, 1);
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP(sdfgi_inspect_get_cascade(t.gi, 0, &where), ==, SDFGI_OK);
    uint32_t *emission = gi_test_read(&t, RESOURCE_EMISSION, NULL);
    for (int i = 0; i < LEVELS; i++) {
        const double top[3] = { level_x(i), 0.2, 0 };
        uint32_t cell[3];
        for (int k = 0; k < 3; k++)
            cell[k] = (uint32_t)floor((top[k] - where.origin_m[k]) / where.cell_m[k]);
        const uint64_t block = sdfgi_inspect_block(&where, cell[0], cell[1], cell[2]);
        struct sdfgi_inspect_surface s;
        sdfgi_inspect_decode_block(0, emission + 2 * block, 0, where.emission_unit, &s);
        printf("%g is stored as %g %g %g\n", (double)levels[i], (double)s.emission[0],
               2 * (double)s.emission[1], 4 * (double)s.emission[2]);
        for (int k = 0; k < 3; k++) /* RGB9E5: half a step */
            REQUIRE_NEAR(s.emission[k] / levels[i], ldexp(1, -k), 1 / 512.0 + 1e-6);
    }
    free(emission);
    gi_test_close(&t);
}

/* Settled light stays, and nothing is recorded. */
static void brighter_materials_leave_settled_light_alone(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct sdfgi_report report;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.ray_count = 25;
    settings.frames_to_converge = 5;
    gi_test_open(&t, &settings);
    struct test_mesh lamp =
        test_mesh_box((double[]){ 0, 1, 0 }, (double[]){ 0.5, 0.25, 0.5 }, test_rotation_none);
    gi_test_add(&t, &lamp, gi_test_material(&t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 3, 2, 1 }));
    test_mesh_destroy(&lamp);
    gi_test_converge(&t, 400);
    const sdfgi_material brighter = gi_test_material(&t, (float[]){ 0, 0, 0 }, (float[]){ 6e5f, 6e5f, 6e5f });
    for (int i = 0; i < 2; i++) {
        gi_test_update(&t, 3);
        sdfgi_get_report(t.gi, &report);
        REQUIRE_TRUE(report.converged);
        if (i == 0)
            REQUIRE_CMP((int)sdfgi_material_destroy(t.gi, brighter), ==, (int)SDFGI_OK);
    }
    gi_test_close(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emission_keeps_its_digits),
        cmocka_unit_test(brighter_materials_leave_settled_light_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
