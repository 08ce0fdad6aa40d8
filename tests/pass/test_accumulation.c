/* SPDX-License-Identifier: MIT
 * When light counts as converged, without a device. */
#include "volume/accumulation.h"

#include "require.h"

/* Cycles until light has converged when each changes `factor` times what the one before did; at most 1,000.
 */
static uint32_t cycles_until_done(float first, float factor, float end)
{
    struct convergence c;
    sdfgi_convergence_reset(&c);
    float change = first;
    uint32_t cycles = 0;
    while (!sdfgi_convergence_done(&c) && cycles < 1000) {
        sdfgi_convergence_add(&c, change);
        change = change * factor > end ? change * factor : end;
        cycles++;
    }
    return cycles;
}

static void light_that_fades_out_converges_at_the_threshold(void **state)
{
    (void)state;
    /* 0.5^10 is 1/1024: the eleventh cycle after the first half is below. */
    REQUIRE_CMP(cycles_until_done(0.5f, 0.5f, 0), ==, 11u);
    REQUIRE_CMP(cycles_until_done(0.5f, 0.8f, 0), ==, 29u);
    REQUIRE_CMP(cycles_until_done(0, 1, 0), ==, 1u);
}

static void a_circle_of_roundings_is_an_end(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done(0.00169f, 1, 0.00169f), ==, 9u);
    REQUIRE_CMP(cycles_until_done(0.5f, 0.5f, 0.0016f), <, 30u);
    REQUIRE_CMP(cycles_until_done(0.0064f, 1, 0.0064f), ==, 33u);
}

/* A room with a loop gain of 0.99 fills slowly: that is no circle. It is below 1/256 after 67 cycles. */
static void light_that_creeps_is_waited_for(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done(0.0077f, 0.99f, 0), >=, 67u);
}

static void light_that_keeps_changing_never_converges(void **state)
{
    (void)state;
    REQUIRE_CMP(cycles_until_done(0.01f, 1, 0.01f), ==, 1000u);
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
        cmocka_unit_test(light_that_fades_out_converges_at_the_threshold),
        cmocka_unit_test(a_circle_of_roundings_is_an_end),
        cmocka_unit_test(light_that_creeps_is_waited_for),
        cmocka_unit_test(light_that_keeps_changing_never_converges),
        cmocka_unit_test(nothing_has_converged_before_a_cycle_has_ended),
    };
    return cmocka_run_group_tests_name("accumulation", tests, NULL, NULL);
}
