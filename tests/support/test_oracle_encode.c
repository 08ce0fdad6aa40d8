/* SPDX-License-Identifier: MIT
 * The encoding references, against their defining properties. */
#include "test_memory.h"
#include "oracle_encode.h"
#include "require.h"

static const double PI = 3.14159265358979323846;

static void octahedral_map_returns_every_direction(void **state)
{
    (void)state;
    struct test_random random = { 1 };
    for (uint32_t i = 0; i < 100000; i++) {
        double d[3], square[2], back[3];
        test_random_direction(&random, d);
        if (i < 27) {
            const double corner[3] = { i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0 };
            const double length = sqrt(corner[0] * corner[0] + corner[1] * corner[1] + corner[2] * corner[2]);
            if (length == 0)
                continue;
            for (int k = 0; k < 3; k++)
                d[k] = corner[k] / length;
        }
        oracle_octahedral_encode(d, square);
        REQUIRE_CMP(fmax(fabs(square[0]), fabs(square[1])), <=, 1);
        oracle_octahedral_decode(square, back);
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(back[k], d[k], 1e-15 * 8);
    }
}

static void octahedral_texels_cover_the_sphere(void **state)
{
    (void)state;
    const uint32_t sizes[4] = { 1, 5, 8, 16 };
    for (int i = 0; i < 4; i++) {
        double sum = 0;
        for (uint32_t t = 0; t < sizes[i] * sizes[i]; t++)
            sum += oracle_octahedral_texel_sr(sizes[i], t % sizes[i], t / sizes[i]);
        REQUIRE_NEAR(sum, 4 * PI, 1e-12);
    }
}

static void octahedral_texel_angles_are_integrals_of_the_density(void **state)
{
    (void)state;
    enum { SAMPLES = 400 };
    for (uint32_t t = 0; t < 25; t++) {
        double sum = 0;
        for (uint32_t s = 0; s < SAMPLES * SAMPLES; s++) {
            const double x = t % 5 + (s % SAMPLES + 0.5) / SAMPLES, y = t / 5 + (s / SAMPLES + 0.5) / SAMPLES;
            sum += oracle_octahedral_density((double[]){ 0.4 * x - 1, 0.4 * y - 1 });
        }
        const double expected = oracle_octahedral_texel_sr(5, t % 5, t / 5);
        REQUIRE_NEAR(sum * 0.16 / (SAMPLES * SAMPLES), expected, 1e-4 * expected);
    }
}

/* Row 40 of the hard cases gives the spread of a 5x5 map as 2.15 : 1. */
static void octahedral_texel_angles_spread_as_measured(void **state)
{
    (void)state;
    double low = INFINITY, high = 0;
    for (uint32_t t = 0; t < 25; t++) {
        low = fmin(low, oracle_octahedral_texel_sr(5, t % 5, t / 5));
        high = fmax(high, oracle_octahedral_texel_sr(5, t % 5, t / 5));
    }
    REQUIRE_NEAR(high / low, 2.15, 0.01);
}

static void texel_direction(uint32_t size, const uint32_t texel[static 2], double direction[static 3])
{
    const double step = 2.0 / size;
    oracle_octahedral_decode((double[]){ -1 + (texel[0] - 0.5) * step, -1 + (texel[1] - 0.5) * step },
                             direction);
}

/* The sides x = +-1 of the map lie in the plane y = 0 and the sides y = +-1 in x = 0: across a side is the
 * mirror image of the texel inside it. */
static void octahedral_border_continues_across_the_seam(void **state)
{
    (void)state;
    const uint32_t size = 5;
    for (uint32_t i = 1; i <= size; i++) {
        const uint32_t border[4][2] = { { 0, i }, { size + 1, i }, { i, 0 }, { i, size + 1 } };
        const uint32_t inside[4][2] = { { 1, i }, { size, i }, { i, 1 }, { i, size } };
        for (int side = 0; side < 4; side++) {
            const int mirrored = side < 2 ? 1 : 0;
            uint32_t source[2];
            double across[3], within[3];
            oracle_octahedral_border(size, border[side][0], border[side][1], source);
            texel_direction(size, source, across);
            texel_direction(size, inside[side], within);
            for (int k = 0; k < 3; k++)
                REQUIRE_NEAR(across[k], k == mirrored ? -within[k] : within[k], 1e-15);
        }
    }
}

/* All four corners of the map are -z: across a corner is the opposite one. */
static void octahedral_border_corners_hold_the_opposite_corner(void **state)
{
    (void)state;
    const uint32_t size = 5;
    for (uint32_t corner = 0; corner < 4; corner++) {
        const uint32_t x = corner & 1 ? size + 1 : 0, y = corner & 2 ? size + 1 : 0;
        const uint32_t inside[2] = { corner & 1 ? size : 1, corner & 2 ? size : 1 };
        uint32_t source[2];
        double across[3], within[3];
        oracle_octahedral_border(size, x, y, source);
        texel_direction(size, source, across);
        texel_direction(size, inside, within);
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(across[k], k < 2 ? -within[k] : within[k], 1e-15);
    }
}

/* Found by trying: the smallest exponent whose rounded mantissas all fit into nine bits. */
static uint32_t rgbe_by_trying(const double rgb[static 3])
{
    for (uint32_t exponent = 0;; exponent++) {
        uint32_t packed = exponent << 27;
        bool fits = true;
        for (int k = 0; k < 3; k++) {
            const double mantissa = floor(rgb[k] / exp2((int)exponent - 24) + 0.5);
            fits = fits && mantissa <= 511;
            packed |= (uint32_t)fmin(mantissa, 511) << (9 * k);
        }
        if (fits)
            return packed;
    }
}

static void rgbe_takes_the_smallest_exponent_that_fits(void **state)
{
    (void)state;
    struct test_random random = { 4 };
    for (uint32_t i = 0; i < 200000; i++) {
        const double scale = exp2(test_random_real(&random, -26, 16));
        double rgb[3];
        for (int k = 0; k < 3; k++)
            rgb[k] = fmin(scale * test_random_real(&random, 0, 1), ORACLE_RGBE_MAX);
        REQUIRE_CMP(oracle_rgbe_encode(rgb), ==, rgbe_by_trying(rgb));
    }
}

/* Row 28 of the hard cases: 0.195 % of the largest channel from 1.53e-5 (2^-16) to the maximum. */
static void rgbe_errors_stay_within_half_a_step(void **state)
{
    (void)state;
    struct test_random random = { 6 };
    for (uint32_t i = 0; i < 200000; i++) {
        const double max = fmin(exp2(test_random_real(&random, -16, 16)), ORACLE_RGBE_MAX);
        const double rgb[3] = { max, max * test_random_real(&random, 0, 1),
                                max * test_random_real(&random, 0, 1) };
        double back[3];
        oracle_rgbe_decode(oracle_rgbe_encode(rgb), back);
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(back[k], rgb[k], max / 512);
    }
}

static void rgbe_keeps_stored_values_and_powers_of_two(void **state)
{
    (void)state;
    struct test_random random = { 8 };
    double rgb[3], again[3];
    for (uint32_t i = 0; i < 100000; i++) {
        oracle_rgbe_decode(test_random_uint(&random), rgb);
        oracle_rgbe_decode(oracle_rgbe_encode(rgb), again);
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(again[k], rgb[k], 0);
    }
    for (int exponent = -24; exponent <= 15; exponent++) {
        const double power = ldexp(1, exponent);
        oracle_rgbe_decode(oracle_rgbe_encode((double[]){ power, 0, power }), rgb);
        REQUIRE_NEAR(rgb[0], power, 0);
        REQUIRE_NEAR(rgb[1], 0, 0);
        REQUIRE_NEAR(rgb[2], power, 0);
    }
}

static void rgbe_clamps_what_it_cannot_hold(void **state)
{
    (void)state;
    double rgb[3];
    oracle_rgbe_decode(oracle_rgbe_encode((double[]){ NAN, -1, 1e30 }), rgb);
    REQUIRE_NEAR(rgb[0], 0, 0);
    REQUIRE_NEAR(rgb[1], 0, 0);
    REQUIRE_NEAR(rgb[2], ORACLE_RGBE_MAX, 0);
    REQUIRE_CMP(oracle_rgbe_encode((double[]){ 1e-30, 0, 0 }), ==, 0);
    oracle_rgbe_decode(oracle_rgbe_encode((double[]){ ORACLE_RGBE_SMALLEST, 0, 0 }), rgb);
    REQUIRE_NEAR(rgb[0], ORACLE_RGBE_SMALLEST, 0);
    /* The encoding of (1, 1, 1) that the specification's formulas give: exponent 16, mantissas 256. */
    REQUIRE_CMP(oracle_rgbe_encode((double[]){ 1, 1, 1 }), ==, 16u << 27 | 256u << 18 | 256u << 9 | 256u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(octahedral_map_returns_every_direction),
        cmocka_unit_test(octahedral_texels_cover_the_sphere),
        cmocka_unit_test(octahedral_texel_angles_are_integrals_of_the_density),
        cmocka_unit_test(octahedral_texel_angles_spread_as_measured),
        cmocka_unit_test(octahedral_border_continues_across_the_seam),
        cmocka_unit_test(octahedral_border_corners_hold_the_opposite_corner),
        cmocka_unit_test(rgbe_takes_the_smallest_exponent_that_fits),
        cmocka_unit_test(rgbe_errors_stay_within_half_a_step),
        cmocka_unit_test(rgbe_keeps_stored_values_and_powers_of_two),
        cmocka_unit_test(rgbe_clamps_what_it_cannot_hold),
    };
    return cmocka_run_group_tests_name("oracle_encode", tests, NULL, NULL);
}
