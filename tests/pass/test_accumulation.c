/* SPDX-License-Identifier: MIT
 * When light counts as converged, without a device. */
#include "volume/accumulation.h"

#include "require.h"

#include <math.h>

/* Light that drifts by `first` in the first cycle and `factor` times as much in each that follows, and that
 * goes round in a circle of a width. */
struct light {
    float first, factor, circle;
};

/* Cycles until light has converged; at most 2,000. */
static uint32_t cycles_until_done(struct light light)
{
    struct convergence c;
    sdfgi_convergence_reset(&c);
    float drift = light.first, since_mark = 0;
    uint32_t cycle = 0;
    while (!sdfgi_convergence_done(&c) && cycle < 2000) {
        cycle++;
        since_mark += drift;
        sdfgi_convergence_add(&c, drift > light.circle ? drift : light.circle);
        sdfgi_convergence_add_drift(&c, since_mark + light.circle, sdfgi_cycle_span(cycle, 0));
        if (sdfgi_cycle_marks(cycle, 0))
            since_mark = 0;
        drift *= light.factor;
    }
    return cycle;
}

/* What a light with a factor below 1 drifts in the 30 cycles after those that have been. */
static double rest_after(struct light light, uint32_t cycles)
{
    double rest = 0;
    for (uint32_t i = 0; i < 30; i++)
        rest += (double)light.first * pow((double)light.factor, cycles + i);
    return rest;
}

static void light_that_fades_out_converges_soon(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done((struct light){ 0.5f, 0.5f, 0 }), <=, 13u);
    REQUIRE_CMP(cycles_until_done((struct light){ 0.5f, 0.8f, 0 }), <=, 37u);
    REQUIRE_CMP(cycles_until_done((struct light){ 0, 1, 0 }), ==, 1u);
}

static void what_is_left_is_a_hundredth_at_most(void **state)
{
    (void)state;
    for (int i = 50; i < 100; i++) {
        const struct light light = { 0.3f, (float)i / 100, 0 };
        REQUIRE_CMP(rest_after(light, cycles_until_done(light)), <=, 0.01);
    }
}

static void a_circle_of_roundings_is_an_end(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done((struct light){ 0, 1, 0.0009f }), <=, 5u);
    REQUIRE_CMP(cycles_until_done((struct light){ 0, 1, 0.0017f }), <=, 41u);
    REQUIRE_CMP(cycles_until_done((struct light){ 0.5f, 0.5f, 0.0016f }), <=, 49u);
    REQUIRE_CMP(cycles_until_done((struct light){ 0, 1, 0.0064f }), <=, 193u);
}

/* By less than circles are wide, and never less: a room with hardly any loss, whose light is rounded. */
static void light_that_creeps_never_converges(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done((struct light){ 4e-4f, 1, 0.0009f }), ==, 2000u);
}

static void light_that_keeps_changing_never_converges(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done((struct light){ 0, 1, 0.011f }), ==, 2000u);
}

static void spans_grow_and_follow_one_another(void **state)
{
    (void)state;
    uint64_t mark = 101;
    uint32_t longest = 0;
    REQUIRE_TRUE(sdfgi_cycle_marks(101, 100) && sdfgi_cycle_span(101, 100) == 0);
    REQUIRE_TRUE(!sdfgi_cycle_marks(100, 100) && !sdfgi_cycle_marks(7, 100));
    for (uint64_t cycle = 102; cycle < 1000; cycle++) {
        const uint32_t span = sdfgi_cycle_span(cycle, 100);
        REQUIRE_TRUE(sdfgi_cycle_marks(cycle, 100) == (span > 0));
        if (span == 0)
            continue;
        REQUIRE_CMP(cycle - mark, ==, (uint64_t)span);
        REQUIRE_CMP(span, >=, longest);
        longest = span;
        mark = cycle;
    }
    REQUIRE_CMP(longest, ==, 32u);
}

static void nothing_has_converged_before_a_cycle_has_ended(void **state)
{
    (void)state;
    struct convergence c;
    sdfgi_convergence_reset(&c);
    REQUIRE_TRUE(!sdfgi_convergence_done(&c));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_that_fades_out_converges_soon),
        cmocka_unit_test(what_is_left_is_a_hundredth_at_most),
        cmocka_unit_test(a_circle_of_roundings_is_an_end),
        cmocka_unit_test(light_that_creeps_never_converges),
        cmocka_unit_test(light_that_keeps_changing_never_converges),
        cmocka_unit_test(spans_grow_and_follow_one_another),
        cmocka_unit_test(nothing_has_converged_before_a_cycle_has_ended),
    };
    return cmocka_run_group_tests_name("accumulation", tests, NULL, NULL);
}
