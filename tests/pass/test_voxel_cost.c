/* SPDX-License-Identifier: MIT
 * What bad, huge and coincident triangles cost the voxeliser, and what coincident ones leave (HARD_CASES rows
 * 14, 15 and 17). Times are those of the device's clock. */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <sdfgi/inspect.h>
#include <stdio.h>
#include <stdlib.h>

/* The shortest of several runs counts, because other programs take time of a processor that draws. Where that
 * is not enough there are more rounds: what is too slow stays too slow. Beside a program that takes a
 * processor all the time, one run of many may have two to itself, and take half of the time that all others
 * take: then the median of the rounds' ratios counts. */
enum { RUNS = 3, MOST_ROUNDS = 11 };

static struct sdfgi_settings cost_settings(void)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32; /* cells of 0.25 m: 8 m */
    return settings;
}

static const float tint[3] = { 1, 0.3f, 0.1f };

/* The mesh claims the bounds of `bounded`. */
static void open_tinted(const struct test_mesh *mesh, const struct test_mesh *bounded)
{
    const struct sdfgi_settings settings = cost_settings();
    gi_test_renew(&pass_context, &settings);
    const sdfgi_mesh handle = gi_test_mesh_within(&pass_context, mesh, bounded);
    const struct sdfgi_instance_desc desc = {
        .mesh = handle,
        .material = gi_test_material(&pass_context, tint, (float[3]){ 0 }),
        .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } },
    };
    sdfgi_instance instance;
    REQUIRE_CMP(sdfgi_instance_create(pass_context.gi, &desc, &instance), ==, SDFGI_OK);
    gi_test_update(&pass_context, 4);
}

static void skip_without_clock(void)
{
    const struct sdfgi_settings settings = cost_settings();
    gi_test_renew(&pass_context, &settings);
    if (pass_context.gi->backend.device.timestamp_bits == 0)
        skip();
}

/* Nanoseconds of the pass that voxelises the scene anew. */
static uint64_t voxelize_ns(void)
{
    static struct sdfgi_report report;
    uint64_t ns = 0;
    const double low[3] = { -4, -4, -4 }, high[3] = { 4, 4, 4 };
    REQUIRE_CMP(sdfgi_invalidate_box(pass_context.gi, low, high), ==, SDFGI_OK);
    for (int frame = 0; frame < 6 && ns == 0; frame++) {
        gi_test_update(&pass_context, 1);
        sdfgi_get_report(pass_context.gi, &report);
        if (report.passes[PASS_VOXELIZE].gpu_ns_valid)
            ns = report.passes[PASS_VOXELIZE].gpu_ns;
    }
    REQUIRE_CMP(ns, >, 0ul);
    return ns;
}

static uint64_t best_voxelize_ns(const struct test_mesh *mesh, const struct test_mesh *bounded)
{
    uint64_t best = UINT64_MAX;
    open_tinted(mesh, bounded);
    for (int run = 0; run < RUNS; run++) {
        const uint64_t ns = voxelize_ns();
        best = ns < best ? ns : best;
    }
    return best;
}

struct race {
    const char *what;
    const struct test_mesh *mesh, *bounded; /* a mesh, and one whose bounds it claims */
    const struct test_mesh *usual;          /* what it is compared with */
    double limit;                           /* of the ratio of their times */
};

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double time_ratio(const struct race *race)
{
    double usual = INFINITY, own = INFINITY, ratios[MOST_ROUNDS];
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const double a = (double)best_voxelize_ns(race->usual, race->usual) * 1e-6,
                     b = (double)best_voxelize_ns(race->mesh, race->bounded) * 1e-6;
        ratios[round] = b / a;
        usual = fmin(usual, a);
        own = fmin(own, b);
        if (own <= race->limit * usual) {
            printf("%s: %.3f ms, %.3f ms usually\n", race->what, own, usual);
            return own / usual;
        }
    }
    qsort(ratios, MOST_ROUNDS, sizeof *ratios, compare_doubles);
    printf("%s: %.3f ms, %.3f ms usually, %.2f times that in the median\n", race->what, own, usual,
           ratios[MOST_ROUNDS / 2]);
    return ratios[MOST_ROUNDS / 2];
}

/* ---- Bad triangles */

/* The mesh, and as many triangles again that have a corner which is not finite or far too large. */
static struct test_mesh half_bad(const struct test_mesh *good)
{
    static const float bad[] = { NAN, INFINITY, -INFINITY, 1e30f, -3e38f, 1e12f };
    struct test_mesh mesh = { 0 }, spoiled = { 0 };
    test_mesh_append(&mesh, good);
    test_mesh_append(&spoiled, good);
    for (uint32_t i = 0; i < 3 * spoiled.vertex_count; i++)
        spoiled.positions[i] = bad[i % 6];
    test_mesh_append(&mesh, &spoiled);
    test_mesh_destroy(&spoiled);
    return mesh;
}

static void hard_14_bad_triangles_take_little_time(void **state)
{
    (void)state;
    skip_without_clock();
    struct test_mesh good = test_mesh_bumpy_sphere((double[]){ 0.1, 0, -0.1 }, 3, 0.2, 3);
    struct test_mesh mesh = half_bad(&good);
    const struct race race = { "one bad for each good triangle", &mesh, &good, &good, 2.5 };
    HARD_CASE_AT_MOST(14, "time, with one bad triangle for each good one", time_ratio(&race), race.limit);
    test_mesh_destroy(&mesh);
    test_mesh_destroy(&good);
}

/* ---- Huge triangles */

/* Across the axis, sloped a little. */
static struct test_mesh plane_across(int axis, double half)
{
    double center[3] = { 0 }, u[3] = { 0 }, v[3] = { 0 };
    center[axis] = 0.53;
    u[(axis + 1) % 3] = v[(axis + 2) % 3] = half;
    u[axis] = 0.3 * half;
    return test_mesh_plane(center, u, v, 1);
}

/* Columns in which the voxeliser finds the mesh. */
static double samples_of(const struct test_mesh *mesh)
{
    open_tinted(mesh, mesh);
    uint32_t *counters = gi_test_read(&pass_context, RESOURCE_COUNTERS, NULL);
    const double samples = counters[SDFGI_COUNTER_VOXELS];
    free(counters);
    return samples;
}

static void hard_15_huge_triangles_take_no_more_time(void **state)
{
    (void)state;
    skip_without_clock();
    for (int axis = getenv("SDFGI_TEST_FULL") ? 0 : 2; axis < 3; axis++) {
        struct test_mesh huge = plane_across(axis, 1e6), small = plane_across(axis, 5);
        const struct race race = { "a plane of 2,000 km", &huge, &huge, &small, 2 };
        HARD_CASE_AT_MOST(15, "time of a plane of 2,000 km over one of 10 m", time_ratio(&race), race.limit);
        HARD_CASE_AT_MOST(15, "samples of a plane of 2,000 km over those of one of 10 m",
                          samples_of(&huge) / samples_of(&small), 2);
        test_mesh_destroy(&huge);
        test_mesh_destroy(&small);
    }
}

/* ---- Coincident triangles */

/* As many as the row says; on a software device `some`, but in suite `full`. */
static uint32_t count_or(uint32_t some)
{
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_renew(&pass_context, &settings);
    return gpu_test_is_software(&pass_context.gpu) && !getenv("SDFGI_TEST_FULL") ? some : 1000000;
}

/* Copies of one triangle, each at its own place: half as large as a block of 2^3 cells. */
static struct test_mesh triangles(uint32_t count, void (*place)(uint32_t i, double at[static 3]))
{
    struct test_mesh mesh = { .positions = test_array_alloc(9 * (size_t)count, sizeof(float)),
                              .indices = test_array_alloc(3 * (size_t)count, sizeof(uint32_t)),
                              .vertex_count = 3 * count,
                              .triangle_count = count };
    for (uint32_t i = 0; i < count; i++) {
        double at[3];
        place(i, at);
        const double corners[3][3] = { { 0, 0, 0 }, { 0, 0, 0.45 }, { 0.45, 0, 0 } };
        for (int k = 0; k < 9; k++)
            mesh.positions[9 * (size_t)i + (size_t)k] = (float)(at[k % 3] + corners[k / 3][k % 3]);
        for (uint32_t k = 0; k < 3; k++)
            mesh.indices[3 * (size_t)i + k] = 3 * i + k;
    }
    return mesh;
}

static void on_one_spot(uint32_t i, double at[static 3])
{
    (void)i;
    memcpy(at, (double[3]){ 0.01, 0.12, 0.02 }, 3 * sizeof *at);
}

static void anywhere(uint32_t i, double at[static 3])
{
    struct test_random random = { i };
    for (int k = 0; k < 3; k++)
        at[k] = test_random_real(&random, -3.9, 3.6);
}

/* Channels of the albedo where the triangles lie, seen from above, in 1/1023. */
static void read_albedo(uint16_t albedo[static 3])
{
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP(sdfgi_inspect_get_cascade(pass_context.gi, 0, &where), ==, SDFGI_OK);
    uint32_t *words = gi_test_read(&pass_context, RESOURCE_ALBEDO, NULL);
    struct sdfgi_inspect_surface surface;
    sdfgi_inspect_decode_block(words + 2 * sdfgi_inspect_block(&where, 16, 16, 16), (uint32_t[2]){ 0 }, 0, 1,
                               &surface);
    memcpy(albedo, surface.albedo[2], sizeof surface.albedo[2]);
    free(words);
}

/* Steps of 1/1023 by which a channel differs from the tint, at most. */
static double albedo_error(void)
{
    uint16_t albedo[3];
    double worst = 0;
    read_albedo(albedo);
    for (int k = 0; k < 3; k++)
        worst = fmax(worst, fabs(albedo[k] - 1023 * (double)tint[k]));
    return worst;
}

static struct oracle_bits bits_of(const struct test_mesh *mesh)
{
    open_tinted(mesh, mesh);
    return gi_test_bits(&pass_context, 0);
}

static void hard_17_coincident_triangles_leave_what_one_does(void **state)
{
    (void)state;
    struct test_mesh one = triangles(1, on_one_spot), many = triangles(count_or(45000), on_one_spot);
    struct oracle_bits expected = bits_of(&one);
    REQUIRE_CMP(pass_health_count(&pass_context, SDFGI_MESSAGE_SURFACES_CROWDED), ==, 0ul);
    REQUIRE_CMP(oracle_bits_count(&expected), >, 5ul);
    struct oracle_bits bits = bits_of(&many);
    HARD_CASE_AT_MOST(
        17, "bits that differ",
        oracle_bits_missing(&expected, &bits, NULL) + oracle_bits_missing(&bits, &expected, NULL), 0);
    HARD_CASE_AT_MOST(17, "albedo off the mean, 1/1023", albedo_error(), 1);
    HARD_CASE_AT_LEAST(17, "samples left out that are reported",
                       pass_health_count(&pass_context, SDFGI_MESSAGE_SURFACES_CROWDED), 1);
    oracle_bits_destroy(&expected);
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&one);
    test_mesh_destroy(&many);
}

static void hard_17_coincident_triangles_take_little_more_time(void **state)
{
    (void)state;
    skip_without_clock();
    struct test_mesh spread = triangles(count_or(1000), anywhere),
                     many = triangles(count_or(1000), on_one_spot);
    const struct race race = { "coincident triangles", &many, &many, &spread, 3 };
    HARD_CASE_AT_MOST(17, "time over that of triangles anywhere", time_ratio(&race), race.limit);
    test_mesh_destroy(&spread);
    test_mesh_destroy(&many);
}

TEST_GROUP(voxel_cost)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_14_bad_triangles_take_little_time),
        cmocka_unit_test(hard_15_huge_triangles_take_no_more_time),
        cmocka_unit_test(hard_17_coincident_triangles_leave_what_one_does),
        cmocka_unit_test(hard_17_coincident_triangles_take_little_more_time),
    };
    return cmocka_run_group_tests_name("voxel_cost", tests, NULL, pass_context_close);
}
