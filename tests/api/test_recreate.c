/* SPDX-License-Identifier: MIT
 * What the table of properties says about recreation holds for every property. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>

static struct sdfgi_settings base_settings(void)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    return s;
}

/* The choice after the value in force, or the first one; false if any value in range will do. */
static bool next_choice(const struct sdfgi_property_info *info, const char *now, char *text, size_t size)
{
    const char *at = strstr(info->choices, now);
    const char *comma = at ? strchr(at, ',') : NULL;
    const char *next = comma ? comma + 1 : info->choices;
    snprintf(text, size, "%.*s", (int)strcspn(next, ","), next);
    return text[0] != 0;
}

/* Another valid value of a property. */
static void other_value(const struct sdfgi_property_info *info, const struct sdfgi_settings *settings,
                        char *text, size_t size)
{
    char now[64];
    REQUIRE_TRUE(sdfgi_settings_format(settings, info->name, now, sizeof now));
    const double value = sdfgi_settings_get(settings, info->name);
    if (next_choice(info, now, text, size))
        return;
    if (info->type == SDFGI_PROPERTY_BOOL)
        snprintf(text, size, "%s", value != 0 ? "false" : "true");
    else if (info->type == SDFGI_PROPERTY_INT)
        snprintf(text, size, "%.0f", value + 1 <= info->maximum ? value + 1 : value - 1);
    else
        snprintf(text, size, "%g", value / 2 > info->minimum ? value / 2 : info->maximum / 2);
}

static void set(struct gi_test *t, const struct sdfgi_settings *settings)
{
    REQUIRE_CMP((int)sdfgi_set_settings(t->gi, settings), ==, (int)SDFGI_OK);
}

/* Objects that were replaced live until frames have passed, of which there are none here: new ones never lie
 * where the old ones lay. */
static bool recreates(struct gi_test *t, const struct sdfgi_property_info *info)
{
    const struct sdfgi_settings base = base_settings();
    struct sdfgi_settings changed = base;
    char text[64], error[200];
    set(t, &base);
    const struct resources *before = t->gi->volume.resources;
    other_value(info, &base, text, sizeof text);
    if (!sdfgi_settings_set(&changed, info->name, text, error, sizeof error))
        require_fail(__FILE__, __LINE__, "%s", error);
    REQUIRE_TRUE(memcmp(&changed, &base, sizeof base) != 0);
    set(t, &changed);
    REQUIRE_TRUE(before && t->gi->volume.resources);
    return t->gi->volume.resources != before;
}

/* sdfgi_enabled is left out: it makes and destroys all there is. */
static void a_change_recreates_everything_where_its_property_says_so_and_nowhere_else(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings base = base_settings();
    const struct sdfgi_property_info *info;
    uint32_t count[2] = { 0 };
    gi_test_open(&t, &base);
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++) {
        if (strcmp(info->name, "sdfgi_enabled") == 0)
            continue;
        if (recreates(&t, info) != info->recreates)
            require_fail(__FILE__, __LINE__, "%s: the table says %s", info->name,
                         info->recreates ? "it recreates" : "it is live");
        count[info->recreates]++;
    }
    printf("%u properties are live, %u recreate everything\n", count[0], count[1]);
    REQUIRE_TRUE(count[0] > 0 && count[1] > 0);
    gi_test_close(&t);
}

/* Settings that are in force already change nothing. */
static void the_same_settings_recreate_nothing(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings base = base_settings();
    gi_test_open(&t, &base);
    const struct resources *before = t.gi->volume.resources;
    set(&t, &base);
    REQUIRE_TRUE(t.gi->volume.resources == before);
    gi_test_close(&t);
}

static uint32_t retired_count(const struct gi_test *t)
{
    uint32_t count = 0;
    for (const struct gpu_retired *item = t->gi->backend.retired.first; item; item = item->next)
        count++;
    return count;
}

/* A slider that is dragged while no frame is drawn. */
static void settings_that_change_without_an_update_hold_no_memory(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = base_settings();
    gi_test_open(&t, &settings);
    gi_test_update(&t, 1);
    const uint32_t before = retired_count(&t);
    for (int i = 0; i < 20; i++) {
        settings.min_cell_size_m = 0.2f + 0.01f * (float)i;
        settings.enabled = i % 3 != 1;
        set(&t, &settings);
    }
    /* What the update used is still there, and nothing else. */
    REQUIRE_CMP(retired_count(&t), ==, before + 1);
    gi_test_close(&t);
}

TEST_GROUP(recreate)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_change_recreates_everything_where_its_property_says_so_and_nowhere_else),
        cmocka_unit_test(the_same_settings_recreate_nothing),
        cmocka_unit_test(settings_that_change_without_an_update_hold_no_memory),
    };
    return cmocka_run_group_tests_name("api_recreate", tests, NULL, NULL);
}
