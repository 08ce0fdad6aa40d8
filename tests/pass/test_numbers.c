/* SPDX-License-Identifier: MIT
 * Numbers that shaders are given at the ends of their range: depths without variance, and denormal light
 * (HARD_CASES rows 43 and 56). */
#include "gi_test.h"
#include "gpu_test_compute.h"
#include "hard_case.h"
#include "oracle_encode.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include "encode_chebyshev.comp.h"

#include "shaders/shared/constants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Moments of depth */

struct depth_trip {
    float mean, square, gap, visibility;
};

/* As the atlas holds it: a number in [0, 1] in 16 bits. */
static double stored_share(double share)
{
    return floor(share * 65535 + 0.5) / 65535;
}

/* A wall at one distance: whatever the rounding of its moments, a receiver before it is seen, and one that is
 * a cell behind it is not. */
static void hard_43_weights_of_flat_depths_are_shares(void **state)
{
    (void)state;
    enum { DEPTHS = 20000 };
    static struct depth_trip depths[DEPTHS];
    const double range = SDFGI_OCCLUSION_RANGE;
    struct test_random random = { 43 };
    double variance = 0, before = INFINITY, behind = 0, least = INFINITY, most = 0;
    for (int i = 0; i < DEPTHS; i++) {
        const double depth = test_random_real(&random, 0, range);
        const double mean = range * stored_share(depth / range),
                     square = range * range * stored_share(depth * depth / (range * range));
        variance = fmax(variance, fabs(square - mean * mean));
        const double receiver = i % 3 == 0   ? depth
                                : i % 3 == 1 ? depth + 1
                                             : test_random_real(&random, 0, range);
        depths[i] = (struct depth_trip){ (float)mean, (float)square, (float)(receiver - mean), NAN };
    }
    gpu_test_compute_alone(encode_chebyshev_comp, sizeof encode_chebyshev_comp, DEPTHS, depths,
                           sizeof depths);
    for (int i = 0; i < DEPTHS; i++) {
        const double weight = (double)depths[i].visibility;
        REQUIRE_TRUE(isfinite(weight));
        least = fmin(least, weight);
        most = fmax(most, weight);
        before = i % 3 == 0 ? fmin(before, weight) : before;
        behind = i % 3 == 1 ? fmax(behind, weight) : behind;
    }
    HARD_CASE_AT_MOST(43, "variance that rounding adds to a flat depth, cells squared", variance, 0.02);
    HARD_CASE_AT_LEAST(43, "least weight", least, 0);
    HARD_CASE_AT_MOST(43, "largest weight", most, 1);
    HARD_CASE_AT_LEAST(43, "weight of a receiver at the wall", before, 0.999);
    HARD_CASE_AT_MOST(43, "weight of a receiver a cell behind the wall", behind, 1e-3);
}

/* ---- Denormal numbers */

/* Numbers below the smallest normal one, each beside others of any size. */
static float flushed(float value)
{
    return fabsf(value) < 0x1p-126f ? 0 : value;
}

/* A box and a lamp of which some numbers are `tiny`, which are denormal or 0, and what was made of them. */
static void open_tiny(struct gi_test *t, float tiny)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.ray_count = 25;
    settings.frames_to_converge = 5;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = SDFGI_VISIT_RAYS;
    gi_test_open(t, &settings);
    struct test_mesh box = test_mesh_box((double[]){ 1, 1, 1 }, (double[]){ 1, 1, 1 }, test_rotation_none);
    for (uint32_t i = 0; i < 3 * box.vertex_count; i++)
        box.positions[i] += box.positions[i] < 0.5f ? tiny : 0;
    gi_test_add(t, &box, gi_test_material(t, (float[]){ 0.5f, tiny, 0.5f }, (float[]){ 1, tiny, 0.5f }));
    test_mesh_destroy(&box);
    const struct sdfgi_light_desc lamp = { .type = SDFGI_LIGHT_POINT,
                                           .position = { 1, 3, (double)tiny },
                                           .intensity = { 5, 5, tiny },
                                           .indirect_energy = 1,
                                           .casts_shadow = true };
    sdfgi_light light;
    REQUIRE_CMP((int)sdfgi_light_create(t->gi, &lamp, &light), ==, (int)SDFGI_OK);
    const struct sdfgi_sky sky = { { 1, tiny, tiny }, { 1, 1, tiny }, { tiny, 0.5f, tiny } };
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &sky), ==, (int)SDFGI_OK);
    gi_test_update(t, 12);
}

static void hard_56_denormals_in_a_scene_are_zero(void **state)
{
    (void)state;
    static struct gi_test denormal, zero;
    static const enum resource made[] = { RESOURCE_BITS,     RESOURCE_DISTANCE, RESOURCE_ALBEDO,
                                          RESOURCE_EMISSION, RESOURCE_NORMALS,  RESOURCE_IRRADIANCE };
    static const struct gi_test_point points[2] = { { { 0.7f, 2, 0.8f }, { 0, 1, 0 } },
                                                    { { -1e-3f, 1, 1 }, { -1, 0, 0 } } };
    float light[2][2][3];
    uint32_t differ = 0;
    open_tiny(&denormal, 1e-40f);
    open_tiny(&zero, 0);
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        uint64_t size;
        void *a = gi_test_read(&denormal, made[i], &size), *b = gi_test_read(&zero, made[i], NULL);
        differ += memcmp(a, b, size) != 0;
        free(a);
        free(b);
    }
    gi_test_irradiance(&denormal, points, 2, light[0]);
    gi_test_irradiance(&zero, points, 2, light[1]);
    for (int i = 0; i < 2; i++)
        REQUIRE_CMP(light[1][i][0], >, 0.5f);
    for (int i = 0; i < 6; i++) /* what a lookup returns may be denormal again */
        differ += flushed(light[0][i / 3][i % 3]) != flushed(light[1][i / 3][i % 3]);
    HARD_CASE_AT_MOST(56, "volumes and light of a scene that differ from those of 0", differ, 0);
    gi_test_close(&zero);
    gi_test_close(&denormal);
}

TEST_GROUP(numbers)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_43_weights_of_flat_depths_are_shares),
        cmocka_unit_test(hard_56_denormals_in_a_scene_are_zero),
    };
    return cmocka_run_group_tests_name("numbers", tests, NULL, NULL);
}
