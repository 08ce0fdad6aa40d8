/* SPDX-License-Identifier: MIT
 * The estimate before creation is what is allocated, by category, and stays within the target. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>

static struct sdfgi_report report;

static void check(const struct sdfgi_settings *settings)
{
    struct gi_test t;
    struct sdfgi_memory estimate;
    REQUIRE_CMP((int)sdfgi_estimate_memory(settings, 2, &estimate), ==, (int)SDFGI_OK);
    gi_test_open(&t, settings);
    sdfgi_get_report(t.gi, &report);
    uint64_t sum = 0;
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++) {
        REQUIRE_CMP(estimate.bytes[i], ==, report.memory.bytes[i]);
        sum += estimate.bytes[i];
    }
    REQUIRE_CMP(estimate.total_bytes, ==, report.memory.total_bytes);
    REQUIRE_CMP(sum, ==, estimate.total_bytes);
    printf("resolution %u, %u cascades: %.2f MiB\n", settings->resolution, settings->cascades,
           (double)sum / (1 << 20));
    gi_test_close(&t);
}

static void the_estimate_is_what_is_allocated(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = { { 32, 1 }, { 32, 4 }, { 32, 8 }, { 64, 1 }, { 64, 4 }, { 128, 1 } };
    for (int i = 0; i < 6; i++) {
        struct sdfgi_settings settings = gi_test_settings();
        settings.resolution = sizes[i][0];
        settings.cascades = sizes[i][1];
        check(&settings);
    }
}

static void the_estimate_holds_for_every_choice(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    check(&settings);
    settings.visibility = SDFGI_VISIBILITY_CELL_MASK;
    settings.ray_count = 7;
    settings.frames_to_converge = 64;
    check(&settings);
    settings.sdf_method = SDFGI_SDF_FLOOD;
    settings.use_occlusion = false;
    check(&settings);
}

/* DESIGN: 64 MiB a cascade with all defaults. */
static void defaults_need_at_most_64_mib_a_cascade(void **state)
{
    (void)state;
    struct sdfgi_memory memory;
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    REQUIRE_CMP((int)sdfgi_estimate_memory(NULL, 0, &memory), ==, (int)SDFGI_OK);
    printf("defaults: %.3f MiB in %u cascades\n", (double)memory.total_bytes / (1 << 20), settings.cascades);
    REQUIRE_CMP(memory.total_bytes, <=, settings.cascades * (UINT64_C(64) << 20));
}

/* A scene with so much surface that its lists become as long as they may. */
static void longest_lists_need_at_most_100_mib_a_cascade(void **state)
{
    (void)state;
    struct sdfgi_memory memory;
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    REQUIRE_CMP((int)sdfgi_estimate_memory(NULL, 0, &memory), ==, (int)SDFGI_OK);
    const struct extent extent = sdfgi_extent_from_settings(&settings);
    struct extent grown = extent;
    sdfgi_extent_set_light_cells(&grown, extent.light_cells_max);
    REQUIRE_CMP(grown.light_cells, >, extent.light_cells);
    uint64_t total = memory.total_bytes;
    for (int i = 0; i < RESOURCE_COUNT; i++)
        total +=
            sdfgi_resource_size((enum resource)i, &grown) - sdfgi_resource_size((enum resource)i, &extent);
    printf("with the longest lists: %.3f MiB\n", (double)total / (1 << 20));
    REQUIRE_CMP(total, <=, settings.cascades * (UINT64_C(100) << 20));
}

static void estimates_are_checked(void **state)
{
    (void)state;
    struct sdfgi_memory memory = { .total_bytes = 77 };
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 100;
    REQUIRE_CMP((int)sdfgi_estimate_memory(&settings, 2, &memory), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP((int)sdfgi_estimate_memory(NULL, 9, &memory), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(memory.total_bytes, ==, 77ul);
}

static void every_memory_category_has_a_name(void **state)
{
    (void)state;
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        REQUIRE_TRUE(sdfgi_memory_category_name((enum sdfgi_memory_category)i)[0] != 0);
}

TEST_GROUP(memory_report)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_estimate_is_what_is_allocated),
        cmocka_unit_test(the_estimate_holds_for_every_choice),
        cmocka_unit_test(defaults_need_at_most_64_mib_a_cascade),
        cmocka_unit_test(longest_lists_need_at_most_100_mib_a_cascade),
        cmocka_unit_test(estimates_are_checked),
        cmocka_unit_test(every_memory_category_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
