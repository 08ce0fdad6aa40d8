/* SPDX-License-Identifier: MIT
 * When light counts as settled, without a device. */
#include "context.h"
#include "require.h"
#include "test_memory.h"

/* Rings until light has settled when each changes `factor` times what the one before did; at most 1,000. */
static uint32_t rings_until_done(float first, float factor, float end)
{
    struct settling s;
    settle_reset(&s);
    float change = first;
    uint32_t rings = 0;
    while (!settle_done(&s) && rings < 1000) {
        settle_ring(&s, change);
        change = change * factor > end ? change * factor : end;
        rings++;
    }
    return rings;
}

static void light_that_fades_out_settles_at_the_threshold(void **state)
{
    (void)state;
    /* 0.5^10 is 1/1024: the eleventh ring after the first half is below. */
    REQUIRE_CMP(rings_until_done(0.5f, 0.5f, 0), ==, 11u);
    REQUIRE_CMP(rings_until_done(0.5f, 0.8f, 0), ==, 29u);
    REQUIRE_CMP(rings_until_done(0, 1, 0), ==, 1u);
}

static void a_circle_of_roundings_is_an_end(void **state)
{
    (void)state;
    REQUIRE_CMP(rings_until_done(0.00169f, 1, 0.00169f), ==, 9u);
    REQUIRE_CMP(rings_until_done(0.5f, 0.5f, 0.0016f), <, 30u);
}

static void light_that_keeps_changing_never_settles(void **state)
{
    (void)state;
    REQUIRE_CMP(rings_until_done(0.01f, 1, 0.01f), ==, 1000u);
}

static void nothing_is_settled_before_a_ring_has_ended(void **state)
{
    (void)state;
    struct settling s;
    settle_reset(&s);
    REQUIRE_TRUE(!settle_done(&s));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_that_fades_out_settles_at_the_threshold),
        cmocka_unit_test(a_circle_of_roundings_is_an_end),
        cmocka_unit_test(light_that_keeps_changing_never_settles),
        cmocka_unit_test(nothing_is_settled_before_a_ring_has_ended),
    };
    return cmocka_run_group_tests_name("settle", tests, NULL, NULL);
}
