/* SPDX-License-Identifier: MIT
 * What other drivers make of the same scene (HARD_CASES row 57): stages of integers against recorded hashes,
 * light against recorded values. meson.build runs it with other numbers of threads and other widths of
 * vectors, and SDFGI_TEST_DEVICE on any device. To record anew: SDFGI_TEST_RECORD=1 prints both tables. */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { POINTS = 12 };

static const struct {
    enum resource resource;
    uint32_t hash;
} recorded[] = {
    { RESOURCE_BITS, 0x31514855u },         { RESOURCE_DISTANCE, 0xfff6e44bu },
    { RESOURCE_ALBEDO, 0xb062e2ddu },       { RESOURCE_PROBES, 0x2cab84a0u },
    { RESOURCE_LIGHT_BLOCKS, 0x38573c77u }, { RESOURCE_MASKS, 0x6251c629u },
};
enum { STAGES = sizeof recorded / sizeof *recorded };

static const float recorded_light[POINTS] = { 2.2033267f,  2.14341569f, 2.14119291f, 2.17091012f,
                                              2.13294506f, 2.12983823f, 2.06936455f, 2.0957942f,
                                              2.13425064f, 2.05556941f, 2.03840661f, 2.10486317f };

/* FNV-1a. */
static uint32_t hash_of(const uint8_t *data, uint64_t size)
{
    uint32_t hash = 2166136261u;
    for (uint64_t i = 0; i < size; i++)
        hash = (hash ^ data[i]) * 16777619u;
    return hash;
}

static bool is_recording(void)
{
    return getenv("SDFGI_TEST_RECORD") != NULL;
}

static int open_scene(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.ray_count = 125;
    settings.frames_to_converge = 4;
    const double low[3] = { -3, -1, -3 }, high[3] = { 3, 2, 3 };
    struct test_mesh mesh = test_mesh_bumpy_sphere((double[]){ 0.4, -1.2, 0.3 }, 1.2, 0.2, 4);
    struct test_mesh soup = test_mesh_soup(57, 60, low, high, 0.8);
    struct test_mesh ground =
        test_mesh_plane((double[]){ 0, -2.9, 0 }, (double[]){ 0, 0.3, 3.7 }, (double[]){ 3.7, 0.1, 0 }, 3);
    test_mesh_append(&mesh, &soup);
    test_mesh_append(&mesh, &ground);
    gi_test_renew(&pass_context, &settings);
    printf("%s\n", pass_context.gpu.properties.deviceName);
    gi_test_add(&pass_context, &mesh,
                gi_test_material(&pass_context, (float[3]){ 0.7f, 0.5f, 0.3f }, (float[3]){ 0 }));
    test_mesh_destroy(&mesh);
    test_mesh_destroy(&soup);
    test_mesh_destroy(&ground);
    const struct sdfgi_light_desc sun = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                          .direction = { 0.3f, -1, 0.2f },
                                          .intensity = { 4, 4, 4 },
                                          .casts_shadow = true };
    const struct sdfgi_sky sky = { { 0.4f, 0.6f, 1 }, { 1, 1, 1 }, { 0.1f, 0.1f, 0.1f } };
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_light_create(pass_context.gi, &sun, &light), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_set_sky(pass_context.gi, &sky), ==, SDFGI_OK);
    /* Settled light may lack a thousandth: on until no cycle adds anything. */
    for (int i = 0; i < 10; i++) {
        sdfgi_volume_invalidate(&pass_context.gi->volume);
        gi_test_converge(&pass_context, 200);
    }
    return 0;
}

static void hard_57_stages_of_integers_are_as_recorded(void **state)
{
    (void)state;
    uint32_t differ = 0;
    for (int i = 0; i < STAGES; i++) {
        const enum resource resource = recorded[i].resource;
        uint64_t size;
        uint8_t *data = gi_test_read(&pass_context, resource, &size);
        if (resource == RESOURCE_BITS) { /* without empty boxes */
            free(data);
            data = (uint8_t *)gi_test_subvoxels(&pass_context);
        }
        const uint32_t hash = hash_of(data, size);
        printf("%s: 0x%08x\n", sdfgi_resource_row(resource)->name, hash);
        differ += hash != recorded[i].hash;
        free(data);
    }
    if (is_recording())
        skip();
    HARD_CASE_AT_MOST(57, "stages of integers that differ", differ, 0);
}

static void hard_57_light_is_as_recorded(void **state)
{
    (void)state;
    struct gi_test_point points[POINTS];
    float light[POINTS][3];
    for (int i = 0; i < POINTS; i++)
        points[i] = (struct gi_test_point){ { (float)(i % 4) * 1.6f - 2.4f, -2.6f, (float)i * 0.45f - 2.5f },
                                            { 0, 1, 0 } };
    gi_test_irradiance(&pass_context, points, POINTS, light);
    double worst = 0, most = 0, squares = 0;
    for (int i = 0; i < POINTS; i++) {
        const double expected = (double)recorded_light[i], off = (double)light[i][1] - expected;
        printf("%.9gf,\n", (double)light[i][1]);
        worst = fmax(worst, fabs(off / expected));
        most = fmax(most, expected);
        squares += off * off / POINTS;
        REQUIRE_TRUE(isfinite(light[i][1]));
    }
    if (is_recording())
        skip();
    HARD_CASE_AT_MOST(57, "light off the record, relative", worst, 1e-3);
    HARD_CASE_AT_LEAST(57, "PSNR against the record, dB, 99 at most",
                       fmin(99, 20 * log10(most / sqrt(squares))), 60);
}

TEST_GROUP(drivers)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_57_stages_of_integers_are_as_recorded),
        cmocka_unit_test(hard_57_light_is_as_recorded),
    };
    return cmocka_run_group_tests_name("drivers", tests, open_scene, pass_context_close);
}
