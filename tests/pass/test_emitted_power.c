/* SPDX-License-Identifier: MIT
 * The power that the voxeliser stores of an emitter, against that of its triangles: by sides, wherever the
 * emitter lies in the grid (HARD_CASES row 50). */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <sdfgi/inspect.h>
#include <stdio.h>
#include <stdlib.h>

/* 32 cells of 0.25 m: sub-voxels of 6.25 cm. */
static const double CELL_M = 0.25;
static const double RADIANCE = 3;
enum { SIDES = 6 };

static int open_context(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    gi_test_open(&pass_context, &settings);
    return 0;
}

/* ---- Exact and stored power, in W/sr that leave along +x -x +y -y +z -z */

struct power {
    double sides[SIDES];
    double own; /* radiance times the area of all triangles */
};

static struct power exact_power(const struct test_mesh *mesh)
{
    struct power power = { 0 };
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *v[3];
        double a[3], b[3], square = 0;
        for (int k = 0; k < 3; k++)
            v[k] = mesh->positions + 3 * (size_t)mesh->indices[3 * i + (uint32_t)k];
        for (int k = 0; k < 3; k++) {
            a[k] = (double)v[1][k] - (double)v[0][k];
            b[k] = (double)v[2][k] - (double)v[0][k];
        }
        for (int k = 0; k < 3; k++) {
            const int u = (k + 1) % 3, w = (k + 2) % 3;
            const double area = (a[u] * b[w] - a[w] * b[u]) / 2;
            power.sides[2 * k + (area < 0)] += RADIANCE * fabs(area);
            square += area * area;
        }
        power.own += RADIANCE * sqrt(square);
    }
    return power;
}

/* Lines of sight along an axis, of 64, that meet a set sub-voxel of the block at a cell. */
static int lines_seen(const struct oracle_bits *bits, const uint32_t cell[static 3], int axis)
{
    int seen = 0;
    for (uint32_t line = 0; line < 64; line++) {
        bool met = false;
        for (uint32_t depth = 0; depth < 8; depth++) {
            uint32_t at[3];
            at[axis] = depth;
            at[(axis + 1) % 3] = line % 8;
            at[(axis + 2) % 3] = line / 8;
            met = met || oracle_bits_get(bits, 4 * cell[0] + at[0], 4 * cell[1] + at[1], 4 * cell[2] + at[2]);
        }
        seen += met;
    }
    return seen;
}

static void stored_power(double power[static SIDES])
{
    struct gi_test *t = &pass_context;
    struct oracle_bits bits = gi_test_bits(t, 0);
    uint32_t(*emission)[2] = gi_test_read(t, RESOURCE_EMISSION, NULL);
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP(sdfgi_inspect_get_cascade(t->gi, 0, &where), ==, SDFGI_OK);
    memset(power, 0, SIDES * sizeof *power);
    for (uint32_t i = 0; i < 16 * 16 * 16; i++) {
        const uint32_t cell[3] = { 2 * (i % 16), 2 * (i / 16 % 16), 2 * (i / 256) };
        const uint64_t block = sdfgi_inspect_block(&where, cell[0], cell[1], cell[2]);
        struct sdfgi_inspect_surface s;
        sdfgi_inspect_decode_block(NULL, emission[block], 0, where.emission_unit, &s);
        for (int side = 0; side < SIDES && s.emission[0] > 0; side++)
            power[side] += (double)s.emission[0] * s.emitting[side] / 31 * lines_seen(&bits, cell, side / 2) *
                           (CELL_M / 4) * (CELL_M / 4);
    }
    free(emission);
    oracle_bits_destroy(&bits);
}

/* What rays towards listed emitters find, of all sides together. */
static double listed_power(void)
{
    uint32_t *words = gi_test_read(&pass_context, RESOURCE_EMITTERS, NULL);
    double power = 0;
    for (uint32_t i = 0; i < words[0]; i++) {
        float value;
        memcpy(&value, words + 8 + SDFGI_EMITTER_WORDS * i + 6, sizeof value);
        power += (double)value * CELL_M * CELL_M;
    }
    free(words);
    return power;
}

/* ---- Lamps */

struct lamp {
    const char *name;
    struct test_mesh mesh;
};

static struct test_mesh plane(double x, double z, const double rotation[static 9])
{
    const double u[3] = { 0, 0, z / 2 }, v[3] = { x / 2, 0, 0 };
    struct test_mesh mesh = test_mesh_plane((double[3]){ 0 }, u, v, 1);
    test_mesh_transform(&mesh, rotation, (double[3]){ 0 });
    return mesh;
}

static struct test_mesh box(double x, double y, double z)
{
    return test_mesh_box((double[3]){ 0 }, (double[]){ x / 2, y / 2, z / 2 }, test_rotation_none);
}

static sdfgi_instance light_up(const struct test_mesh *mesh)
{
    const float radiance = (float)RADIANCE;
    const struct sdfgi_material_desc desc = { .emission = { radiance, radiance, radiance } };
    struct sdfgi_settings settings;
    sdfgi_material material;
    sdfgi_get_settings(pass_context.gi, &settings);
    gi_test_renew(&pass_context, &settings);
    REQUIRE_CMP(sdfgi_material_create(pass_context.gi, &desc, &material), ==, SDFGI_OK);
    return gi_test_add(&pass_context, mesh, material);
}

struct slide {
    double off, pop; /* largest error, and largest change of a step, of what all sides show */
    double side;     /* largest error of one side, of what all show */
    double listed;   /* power in the list of emitters over that of their areas, at most */
};

static double sum_of(const double sides[static SIDES])
{
    double sum = 0;
    for (int side = 0; side < SIDES; side++)
        sum += sides[side];
    return sum;
}

/* Compares what is stored now with what the lamp emits. Returns the sum of all sides. */
static double look(const struct power *exact, struct slide *slide)
{
    double stored[SIDES];
    stored_power(stored);
    const double sum = sum_of(stored), all = sum_of(exact->sides);
    for (int side = 0; side < SIDES; side++)
        slide->side = fmax(slide->side, fabs(stored[side] - exact->sides[side]) / all);
    slide->off = fmax(slide->off, fabs(sum / all - 1));
    slide->listed = fmax(slide->listed, listed_power() / exact->own);
    return sum;
}

/* Moves a lamp by a sixteenth of a cell a step. */
static struct slide slide_lamp(const struct lamp *lamp, const double direction[static 3], int steps)
{
    struct slide slide = { 0 };
    const sdfgi_instance instance = light_up(&lamp->mesh);
    const struct power exact = exact_power(&lamp->mesh);
    double before = 0;
    for (int i = 0; i <= steps; i++) {
        struct sdfgi_transform transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
        for (int k = 0; k < 3; k++)
            transform.translation[k] = 0.013 + direction[k] * CELL_M / 16 * i;
        REQUIRE_CMP(sdfgi_instance_set_transform(pass_context.gi, instance, &transform), ==, SDFGI_OK);
        gi_test_update(&pass_context, 1);
        const double sum = look(&exact, &slide);
        slide.pop = i > 0 ? fmax(slide.pop, fabs(sum / before - 1)) : 0;
        before = sum;
    }
    printf("%s along (%g %g %g): off by %.4f, %.4f a step, a side by %.4f, listed %.4f\n", lamp->name,
           direction[0], direction[1], direction[2], slide.off, slide.pop, slide.side, slide.listed);
    return slide;
}

/* What remains is rounding: five bits of each side, nine of radiance. */
static void require_power(struct slide slide)
{
    HARD_CASE_AT_MOST(50, "stored power of a lamp that slides, off by", slide.off, 0.01);
    HARD_CASE_AT_MOST(50, "stored power of a lamp, change for a step of 1/16 cell", slide.pop, 0.012);
    HARD_CASE_AT_MOST(50, "stored power towards one side, off by, of all sides", slide.side, 0.005);
    HARD_CASE_AT_MOST(50, "power in the list of emitters over theirs", slide.listed, 1.01);
}

static void hard_50_an_emitter_that_slides_keeps_its_power(void **state)
{
    (void)state;
    static const double across[3] = { 0.7, -0.4, 0.6 }, along[][3] = { { 1, 0, 0 }, { 0, 1, 0 } };
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    double tilted[9], steep[9];
    test_rotation((double[]){ 1, 0, 0.3 }, 0.5, tilted);
    test_rotation((double[]){ 0.2, 0.1, 1 }, 1.3, steep);
    struct lamp lamps[] = {
        { "a panel of one cell", plane(CELL_M, CELL_M, test_rotation_none) },
        { "a panel of two cells", plane(2 * CELL_M, 2 * CELL_M, test_rotation_none) },
        { "a tilted panel", plane(2 * CELL_M, 3 * CELL_M, tilted) },
        { "a steep panel", plane(2 * CELL_M, 3 * CELL_M, steep) },
        { "a strip", plane(0.04 * CELL_M, 3 * CELL_M, test_rotation_none) },
        { "a speck", plane(0.1 * CELL_M, 0.1 * CELL_M, test_rotation_none) },
        { "a box of one cell", box(CELL_M, CELL_M, CELL_M) },
        { "a flat box", box(2 * CELL_M, 0.3 * CELL_M, 3 * CELL_M) },
        { "a sphere", test_mesh_sphere((double[3]){ 0 }, 0.8 * CELL_M, 3) },
    };
    for (size_t i = 0; i < sizeof lamps / sizeof *lamps; i++) {
        require_power(slide_lamp(&lamps[i], across, full ? 64 : 12));
        for (int d = 0; full && d < 2; d++)
            require_power(slide_lamp(&lamps[i], along[d], 32));
        test_mesh_destroy(&lamps[i].mesh);
    }
}

/* Of many layers on one line of sight in a block the first is seen. */
static void layers_count_once(void **state)
{
    (void)state;
    enum { LAYERS = 5 };
    const struct test_mesh panel = plane(2 * CELL_M, 2 * CELL_M, test_rotation_none);
    const struct power exact = exact_power(&panel);
    struct test_mesh layers = { 0 };
    for (int i = 0; i < LAYERS; i++) {
        struct test_mesh layer = plane(2 * CELL_M, 2 * CELL_M, test_rotation_none);
        test_mesh_transform(&layer, test_rotation_none, (double[]){ 0, 0.04 + 0.07 * i, 0 });
        test_mesh_append(&layers, &layer);
        test_mesh_append(&layers, &layer);
        test_mesh_destroy(&layer);
    }
    light_up(&layers);
    gi_test_update(&pass_context, 1);
    double stored[SIDES];
    stored_power(stored);
    REQUIRE_NEAR(stored[2] / exact.sides[2], 1, 0.005);
    test_mesh_destroy(&layers);
}

TEST_GROUP(emitted_power)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_50_an_emitter_that_slides_keeps_its_power),
        cmocka_unit_test(layers_count_once),
    };
    return cmocka_run_group_tests_name("emitted_power", tests, open_context, pass_context_close);
}
