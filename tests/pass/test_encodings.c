/* SPDX-License-Identifier: MIT
 * Encodings of shaders/lib on the device against references in double precision (HARD_CASES rows 28, 29, 36,
 * 40, 41, 56 and 67). */
#include "gpu_test_compute.h"
#include "hard_case.h"
#include "oracle_encode.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include "encode_light.comp.h"
#include "encode_octahedral.comp.h"
#include "encode_random.comp.h"
#include "encode_rgb48.comp.h"
#include "encode_rgbe.comp.h"
#include "encode_sky.comp.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- RGB9E5 */

struct color_trip {
    float color[3];
    uint32_t packed;
    float back[4];
};

enum { COLORS = 20000 };

static struct color_trip colors[COLORS];

static void fill_colors(void)
{
    static const float special[][3] = {
        { NAN, 1, 2 },           { -1, -INFINITY, NAN },     { INFINITY, 1, 0 },
        { 1e30f, 65408, 65407 }, { 6e4f, 1e-3f, 0 },         { 0x1p-24f, 0x1p-25f, 0x1p-26f },
        { 1e-40f, 1e-45f, 0 },   { -0.0f, 0, 511.5f / 512 }, { 0.99999994f, 0.5f, 0.25f },
        { 65408, 65409, 65536 }
    };
    struct test_random random = { 28 };
    uint32_t n = 0;
    for (; n < sizeof special / sizeof *special; n++)
        memcpy(colors[n].color, special[n], sizeof special[n]);
    for (int e = -30; e <= 20; e++, n++)
        for (int k = 0; k < 3; k++)
            colors[n].color[k] = ldexpf(1, e - 3 * k);
    for (; n < COLORS; n++) { /* 1e-6 to 1e9, all channels alike or not */
        const double level = test_random_real(&random, -6, 9), spread = n & 1 ? 0.01 : 3;
        for (int k = 0; k < 3; k++)
            colors[n].color[k] = (float)pow(10, level - test_random_real(&random, 0, spread));
    }
}

/* The colour to be kept: what is negative or not a number is 0, and what is too bright is cut. */
static void wanted_color(const struct color_trip *c, double wanted[static 3], double *largest)
{
    *largest = 0;
    for (int k = 0; k < 3; k++) {
        const double value = (double)c->color[k];
        wanted[k] = value > 0 ? fmin(value, ORACLE_RGBE_MAX) : 0;
        *largest = fmax(*largest, wanted[k]);
    }
}

/* What is representable comes back exactly, and all else to within half a step of the largest channel. */
static void require_color(const struct color_trip *c)
{
    double wanted[3], largest;
    wanted_color(c, wanted, &largest);
    /* Nine bits below the power of two above the largest: half a step is at most its 511th part. */
    const double tolerance = fmax(largest / 511, ORACLE_RGBE_SMALLEST / 2);
    for (int k = 0; k < 3; k++)
        REQUIRE_NEAR(c->back[k], wanted[k], tolerance * (1 + 1e-6));
}

/* Of the largest channel, relative, where steps are no larger than the format's smallest. */
static double error_of_largest(const struct color_trip *c)
{
    double wanted[3], largest, worst = 0;
    wanted_color(c, wanted, &largest);
    for (int k = 0; largest >= 1.53e-5 && k < 3; k++)
        if (wanted[k] == largest)
            worst = fmax(worst, fabs((double)c->back[k] / largest - 1));
    return worst;
}

/* Of the weakest channel, relative to the largest. */
static double error_of_weakest(const struct color_trip *c)
{
    double wanted[3], largest, worst = 0;
    wanted_color(c, wanted, &largest);
    const double weakest = fmin(wanted[0], fmin(wanted[1], wanted[2]));
    for (int k = 0; largest >= 1.53e-5 && k < 3; k++)
        if (wanted[k] == weakest)
            worst = fmax(worst, fabs((double)c->back[k] - weakest) / largest);
    return worst;
}

static void hard_28_29_rgb9e5_keeps_colors(void **state)
{
    (void)state;
    fill_colors();
    double largest = 0, weakest = 0;
    gpu_test_compute_alone(encode_rgbe_comp, sizeof encode_rgbe_comp, COLORS, colors, sizeof colors);
    for (uint32_t i = 0; i < COLORS; i++) {
        require_color(&colors[i]);
        largest = fmax(largest, error_of_largest(&colors[i]));
        weakest = fmax(weakest, error_of_weakest(&colors[i]));
        const double color[3] = { (double)colors[i].color[0], (double)colors[i].color[1],
                                  (double)colors[i].color[2] };
        /* Denormals may be flushed; they pack to 0 either way. */
        REQUIRE_CMP(colors[i].packed, ==, oracle_rgbe_encode(color));
        double back[3];
        oracle_rgbe_decode(colors[i].packed, back);
        for (int k = 0; k < 3; k++)
            REQUIRE_CMP((double)colors[i].back[k], ==, back[k]);
    }
    HARD_CASE_AT_MOST(28, "error of the brightest channel, relative", largest, 0.00196);
    HARD_CASE_AT_MOST(29, "error of the weakest channel, relative to the brightest", weakest, 1.0 / 511);
}

static void hard_28_powers_of_two_are_exact(void **state)
{
    (void)state;
    static struct color_trip powers[40];
    for (int i = 0; i < 40; i++)
        for (int k = 0; k < 3; k++)
            powers[i].color[k] = ldexpf(1, i - 24);
    gpu_test_compute_alone(encode_rgbe_comp, sizeof encode_rgbe_comp, 40, powers, sizeof powers);
    for (int i = 0; i < 40; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_CMP(powers[i].back[k], ==, fminf(ldexpf(1, i - 24), 65408));
}

/* Mantissas of 14 bits: half a step is at most a 16,383rd of the largest channel. */
static void rgb48_keeps_colors_32_times_finer(void **state)
{
    (void)state;
    fill_colors();
    gpu_test_compute_alone(encode_rgb48_comp, sizeof encode_rgb48_comp, COLORS, colors, sizeof colors);
    for (uint32_t i = 0; i < COLORS; i++) {
        double wanted[3], largest = 0;
        wanted_color(&colors[i], wanted, &largest);
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(colors[i].back[k], wanted[k], largest / 16383 + 0x1p-61);
        REQUIRE_CMP(colors[i].back[3], ==, 0.0f);
    }
}

/* ---- Octahedral maps */

struct octahedral_trip {
    float direction[3], texel;
    float at[2], source[2];
    float back[3], solid_angle;
};

enum { DIRECTIONS = 20000 };

static struct octahedral_trip trips[DIRECTIONS];

static void fill_directions(void)
{
    struct test_random random = { 40 };
    for (int i = 0; i < DIRECTIONS; i++) {
        double d[3];
        if (i < 27) /* axes, edges and corners of the octahedron */
            for (int k = 0; k < 3; k++)
                d[k] = i / (int[]){ 1, 3, 9 }[k] % 3 - 1 + (i == 13 && k == 1);
        else
            test_random_direction(&random, d);
        const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        const int n = i & 1 ? 16 : 5, border = i / 2 % ((n + 2) * (n + 2));
        for (int k = 0; k < 3; k++)
            trips[i].direction[k] = (float)(d[k] / length);
        trips[i].texel = (float)(10000 * n + border % (n + 2) + 100 * (border / (n + 2)));
    }
}

static void require_border(const struct octahedral_trip *t)
{
    const uint32_t texel = (uint32_t)t->texel, n = texel / 10000;
    uint32_t source[2];
    oracle_octahedral_border(n, texel % 100, texel / 100 % 100, source);
    REQUIRE_CMP((uint32_t)t->source[0] + 1, ==, source[0]);
    REQUIRE_CMP((uint32_t)t->source[1] + 1, ==, source[1]);
}

/* The library's maps have +Y in the middle where the reference has +Z: (x, z, y) there is (x, y, z) here. */
static void hard_40_41_octahedral_maps_agree_with_the_reference(void **state)
{
    (void)state;
    fill_directions();
    gpu_test_compute_alone(encode_octahedral_comp, sizeof encode_octahedral_comp, DIRECTIONS, trips,
                           sizeof trips);
    double angle = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const struct octahedral_trip *t = &trips[i];
        const double swapped[3] = { (double)t->direction[0], (double)t->direction[2],
                                    (double)t->direction[1] };
        const double at[2] = { (double)t->at[0], (double)t->at[1] };
        double square[2];
        oracle_octahedral_encode(swapped, square);
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(t->back[k], t->direction[k], 1e-6);
        angle = fmax(angle, fabs((double)t->solid_angle / oracle_octahedral_density(at) - 1));
        if (t->direction[1] > -0.999f) /* straight down is all four corners at once */
            for (int k = 0; k < 2; k++)
                REQUIRE_NEAR(t->at[k], square[k], 1e-5);
        require_border(t);
    }
    HARD_CASE_AT_MOST(40, "solid angle of a direction, relative error", angle, 1e-5);
}

/* ---- Light cells */

struct light_trip {
    float axes[6][4], back[6][4];
};

enum { LIGHTS = 5000 };

static struct light_trip lights[LIGHTS];

static double luminance(const float color[4])
{
    return 0.2126 * (double)color[0] + 0.7152 * (double)color[1] + 0.0722 * (double)color[2];
}

/* A third of the cells is lit alike from all sides, a third in one colour, a third at random. */
static void fill_lights(void)
{
    struct test_random random = { 36 };
    for (int i = 1; i < LIGHTS; i++) {
        const double level = pow(10, test_random_real(&random, -3, 4));
        float base[3];
        for (int k = 0; k < 3; k++)
            base[k] = (float)(level * test_random_real(&random, 0, 1));
        for (int a = 0; a < 6; a++)
            for (int k = 0; k < 3; k++)
                lights[i].axes[a][k] = i % 3 == 0   ? base[k]
                                       : i % 3 == 1 ? base[k] * (float)((5 * a + i) % 7) / 6
                                                    : (float)(level * test_random_real(&random, 0, 1));
    }
}

/* Largest channel of the colour that a light cell stores: that of all axes together, as bright as the
 * brightest. */
static double stored_channel(const struct light_trip *t)
{
    float total[4] = { 0 };
    double brightest = 0;
    for (int a = 0; a < 6; a++) {
        brightest = fmax(brightest, luminance(t->axes[a]));
        for (int k = 0; k < 3; k++)
            total[k] += t->axes[a][k];
    }
    return brightest > 0 ? (double)fmaxf(total[0], fmaxf(total[1], total[2])) * brightest / luminance(total)
                         : 0;
}

/* Hashed rounding moves a channel by at most one step, 1/255 of the largest where that is just above a power
 * of two, and a weight by one step, 1/31 of the brightest; both up or down. */
static void require_light(const struct light_trip *t, bool uniform)
{
    double brightest = 0;
    const double rounding = stored_channel(t) / 255 * 1.001;
    for (int a = 0; a < 6; a++)
        brightest = fmax(brightest, luminance(t->axes[a]));
    for (int a = 0; a < 6; a++) {
        const double lost = luminance(t->axes[a]) - luminance(t->back[a]);
        REQUIRE_CMP(t->back[a][3], ==, 1.0f);
        REQUIRE_CMP(lost, <=, brightest / 31 + rounding);
        REQUIRE_CMP(lost, >=, -rounding - brightest / 31);
        for (int k = 0; uniform && k < 3; k++)
            REQUIRE_NEAR(t->back[a][k], t->axes[a][k], rounding);
    }
}

struct range {
    double low, high;
};

static void range_add(struct range *range, double value)
{
    range->low = fmin(range->low, value);
    range->high = fmax(range->high, value);
}

static void hard_36_light_cells_neither_gain_nor_lose_on_average(void **state)
{
    (void)state;
    fill_lights();
    gpu_test_compute_alone(encode_light_comp, sizeof encode_light_comp, LIGHTS, lights, sizeof lights);
    double before = 0, after = 0;
    struct range cells = { INFINITY, 0 };
    for (int i = 0; i < LIGHTS; i++) {
        require_light(&lights[i], i % 3 == 0);
        for (int a = 0; a < 6; a++) {
            before += luminance(lights[i].axes[a]);
            after += luminance(lights[i].back[a]);
            for (int k = 0; k < 3 && i % 3 == 0 && i > 0; k++)
                range_add(&cells, 1 + (double)(lights[i].back[a][k] - lights[i].axes[a][k]) /
                                          stored_channel(&lights[i]));
        }
    }
    printf("light cells keep %.2f %% of the light; channels in even light %.2f %% to %.2f %%\n",
           100 * after / before, 100 * cells.low, 100 * cells.high);
    /* 30,000 axes: steps of at most 3.3 % average out to well below a thousandth. */
    HARD_CASE_AT_MOST(36, "gain or loss over all cells", fabs(after / before - 1), 1e-3);
    HARD_CASE_AT_LEAST(36, "share of even light that a cell keeps at least", cells.low, 0.97);
    /* A hash rounds the mantissa by one step at most, up as often as down. */
    HARD_CASE_AT_MOST(36, "share of even light that a cell keeps at most", cells.high, 1 + 1.0 / 255);
}

/* ---- Random numbers */

static void hard_67_random_points_stay_in_the_unit_square(void **state)
{
    (void)state;
    enum { POINTS = 4096 };
    static uint32_t points[POINTS][4];
    const uint32_t starts[4] = { 0, 1u << 24, 0x7ffffe00, 0xfffffe00 };
    for (uint32_t i = 0; i < POINTS; i++) {
        points[i][0] = starts[i / 1024] + i % 1024;
        points[i][1] = 1234567 * (i / 1024);
    }
    struct range filled = { INFINITY, 0 };
    gpu_test_compute_alone(encode_random_comp, sizeof encode_random_comp, POINTS, points, sizeof points);
    for (uint32_t block = 0; block < 4; block++) {
        uint32_t cells[16][16] = { { 0 } };
        for (uint32_t i = 1024 * block; i < 1024 * (block + 1); i++) {
            float p[2];
            memcpy(p, &points[i][2], sizeof p);
            REQUIRE_TRUE(p[0] >= 0 && p[0] < 1 && p[1] >= 0 && p[1] < 1);
            cells[(int)(16 * p[0])][(int)(16 * p[1])]++;
        }
        /* Four points per cell on average; the sequence leaves none empty, however late it starts. */
        for (int i = 0; i < 256; i++)
            range_add(&filled, cells[i / 16][i % 16]);
    }
    HARD_CASE_AT_LEAST(67, "points of 1024 in an emptiest 256th of the square", filled.low, 1);
    HARD_CASE_AT_MOST(67, "points of 1024 in a fullest 256th of the square", filled.high, 9);
}

/* ---- Sky */

/* Share of a cosine-weighted hemisphere around a normal at height y that max(0, d.y) fills. */
static double ramp_by_quadrature(double y)
{
    enum { STEPS = 400 };
    const double x = sqrt(fmax(0, 1 - y * y));
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            const double r2 = (i + 0.5) / STEPS, r = sqrt(r2), turn = 6.283185307179586 * (j + 0.5) / STEPS;
            sum += fmax(0, sqrt(1 - r2) * y + r * cos(turn) * x);
        }
    return sum / (STEPS * STEPS);
}

static void sky_light_agrees_with_quadrature(void **state)
{
    (void)state;
    enum { NORMALS = 41 };
    static float sky[NORMALS][3][4];
    for (int i = 0; i < NORMALS; i++) {
        const double y = (double)i / 20 - 1;
        sky[i][0][0] = (float)(0.6 * sqrt(1 - y * y));
        sky[i][0][1] = (float)y;
        sky[i][0][2] = (float)(-0.8 * sqrt(1 - y * y));
    }
    gpu_test_compute_alone(encode_sky_comp, sizeof encode_sky_comp, NORMALS, sky, sizeof sky);
    for (int i = 0; i < NORMALS; i++) {
        const double y = (double)i / 20 - 1, up = ramp_by_quadrature(y), down = ramp_by_quadrature(-y);
        REQUIRE_NEAR(sky[i][1][0], up, 0.006);
        REQUIRE_NEAR(sky[i][1][2], down, 0.006);
        REQUIRE_NEAR(sky[i][1][1], 1 - up - down, 0.012); /* what both ramps are off */
        REQUIRE_NEAR(sky[i][1][0] + sky[i][1][1] + sky[i][1][2], 1, 1e-6);
        REQUIRE_NEAR(sky[i][2][0], fmax(0, y), 1e-6);
        REQUIRE_NEAR(sky[i][2][1], 1 - fabs(y), 1e-6);
        REQUIRE_NEAR(sky[i][2][2], fmax(0, -y), 1e-6);
    }
}

/* ---- Denormal numbers */

/* Numbers below the smallest normal one, each beside others of any size. */
static float maybe_denormal(struct test_random *random)
{
    static const float values[] = { 1e-40f, 1e-45f, 0x1.fffffcp-127f, 0, 1e-3f, 1, 3e4f };
    return values[(int)test_random_real(random, 0, 6.999)];
}

/* Runs a shader on `count` rows of `floats`, of which the first `inputs` hold such numbers, and on the same
 * rows with zeros instead. Returns how many outputs differ. */
static uint32_t outputs_that_differ(const uint32_t *code, size_t code_size, int floats, int inputs)
{
    enum { ROWS = 500, MOST = 48 };
    static float rows[2][ROWS * MOST];
    struct test_random random = { 56 };
    memset(rows, 0, sizeof rows);
    for (int i = 0; i < ROWS * floats; i++)
        if (i % floats < inputs && (inputs == 3 || i % 4 < 3)) {
            rows[0][i] = maybe_denormal(&random);
            rows[1][i] = fabsf(rows[0][i]) < 0x1p-126f ? 0 : rows[0][i];
        }
    for (int k = 0; k < 2; k++)
        gpu_test_compute_alone(code, code_size, ROWS, rows[k], (size_t)ROWS * (size_t)floats * sizeof(float));
    uint32_t differ = 0;
    for (int i = 0; i < ROWS * floats; i++)
        differ +=
            (i % floats >= inputs || i % 4 == 3) && memcmp(&rows[0][i], &rows[1][i], sizeof(float)) != 0;
    return differ;
}

/* Light that is brighter or darker by so little is the same light. */
static void hard_56_denormals_are_encoded_as_zero(void **state)
{
    (void)state;
    HARD_CASE_AT_MOST(56, "RGB9E5 texels that differ from those of 0",
                      outputs_that_differ(encode_rgbe_comp, sizeof encode_rgbe_comp, 8, 3), 0);
    HARD_CASE_AT_MOST(56, "48-bit colours that differ from those of 0",
                      outputs_that_differ(encode_rgb48_comp, sizeof encode_rgb48_comp, 8, 3), 0);
    HARD_CASE_AT_MOST(56, "light cells that differ from those of 0",
                      outputs_that_differ(encode_light_comp, sizeof encode_light_comp, 48, 24), 0);
}

TEST_GROUP(encodings)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_28_29_rgb9e5_keeps_colors),
        cmocka_unit_test(hard_28_powers_of_two_are_exact),
        cmocka_unit_test(rgb48_keeps_colors_32_times_finer),
        cmocka_unit_test(hard_40_41_octahedral_maps_agree_with_the_reference),
        cmocka_unit_test(hard_36_light_cells_neither_gain_nor_lose_on_average),
        cmocka_unit_test(hard_67_random_points_stay_in_the_unit_square),
        cmocka_unit_test(sky_light_agrees_with_quadrature),
        cmocka_unit_test(hard_56_denormals_are_encoded_as_zero),
    };
    return cmocka_run_group_tests_name("encodings", tests, NULL, NULL);
}
