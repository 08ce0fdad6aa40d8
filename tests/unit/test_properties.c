/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include <math.h>
#include <sdfgi/settings.h>
#include <stdio.h>
#include <string.h>

static struct sdfgi_settings defaults(void)
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    return settings;
}

/* Setting `name` to `value` fails, changes nothing, and the line names the property. */
static void assert_refused(const char *name, const char *value)
{
    struct sdfgi_settings settings = defaults();
    const struct sdfgi_settings before = settings;
    char error[200] = "";
    if (sdfgi_settings_set(&settings, name, value, error, sizeof error))
        fail_msg("%s took \"%s\"", name, value);
    assert_memory_equal(&settings, &before, sizeof settings);
    assert_non_null(strstr(error, name));
    assert_null(strchr(error, '\n'));
    assert_false(sdfgi_settings_set(&settings, name, value, NULL, 0));
}

static void assert_set(struct sdfgi_settings *settings, const char *name, const char *value)
{
    char error[200];
    if (!sdfgi_settings_set(settings, name, value, error, sizeof error))
        fail_msg("%s", error);
}

static void defaults_are_off_and_physical(void **state)
{
    (void)state;
    const struct sdfgi_settings s = defaults();
    assert_false(s.enabled);
    assert_true(s.use_occlusion && s.read_sky_light);
    assert_true(s.bounce_feedback == 1 && s.energy == 1);
    assert_int_equal(s.cascades, 4);
    assert_true(s.min_cell_size_m == 0.2f);
    assert_int_equal(s.y_scale, SDFGI_Y_SCALE_100);
    assert_int_equal(s.resolution, 128);
    assert_int_equal(s.ray_count, 25);
    assert_true(sdfgi_settings_validate(&s, NULL, 0));
}

static void every_default_reads_back_as_its_row_says(void **state)
{
    (void)state;
    const struct sdfgi_settings s = defaults();
    const struct sdfgi_property_info *info;
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++)
        assert_true((float)sdfgi_settings_get(&s, info->name) == (float)info->default_value);
}

static void every_row_is_complete_and_named_once(void **state)
{
    (void)state;
    const struct sdfgi_property_info *info, *other;
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++) {
        assert_int_equal(strncmp(info->name, "sdfgi_", 6), 0);
        assert_true(info->minimum < info->maximum);
        assert_true(info->default_value >= info->minimum && info->default_value <= info->maximum);
        assert_non_null(info->unit);
        assert_non_null(info->choices);
        assert_true(strlen(info->buys) > 0 && strlen(info->costs) > 0 && strlen(info->description) > 0);
        for (uint32_t k = 0; k < i; k++) {
            other = sdfgi_property_get_info(k);
            assert_string_not_equal(info->name, other->name);
        }
    }
    assert_null(sdfgi_property_get_info(UINT32_MAX));
}

static void formatting_and_parsing_are_inverse(void **state)
{
    (void)state;
    struct sdfgi_settings s = defaults();
    assert_set(&s, "sdfgi_enabled", "true");
    assert_set(&s, "sdfgi_bounce_feedback", "0.123456789");
    assert_set(&s, "sdfgi_min_cell_size", "0.1");
    assert_set(&s, "sdfgi_y_scale", "75%");
    assert_set(&s, "sdfgi_resolution", "64");
    assert_set(&s, "sdfgi_visibility", "probe_depth");
    assert_set(&s, "sdfgi_voxelizer", "raster");
    struct sdfgi_settings copy = defaults();
    const struct sdfgi_property_info *info;
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++) {
        char text[64];
        assert_true(sdfgi_settings_format(&s, info->name, text, sizeof text));
        if (!info->derived)
            assert_set(&copy, info->name, text);
    }
    assert_memory_equal(&copy, &s, sizeof s);
}

static void short_decimals_are_formatted_as_they_were_typed(void **state)
{
    (void)state;
    const struct sdfgi_settings s = defaults();
    char text[64];
    assert_true(sdfgi_settings_format(&s, "sdfgi_min_cell_size", text, sizeof text));
    assert_string_equal(text, "0.2");
    assert_true(sdfgi_settings_format(&s, "sdfgi_max_distance", text, sizeof text));
    assert_string_equal(text, "204.8");
    assert_false(sdfgi_settings_format(&s, "sdfgi_none", text, sizeof text));
}

static void distances_follow_the_cell_size_and_set_it(void **state)
{
    (void)state;
    struct sdfgi_settings s = defaults();
    assert_true((float)sdfgi_settings_get(&s, "sdfgi_cascade0_distance") == 12.8f);
    assert_true((float)sdfgi_settings_get(&s, "sdfgi_max_distance") == 204.8f);
    assert_set(&s, "sdfgi_cascade0_distance", "6.4");
    assert_true(s.min_cell_size_m == 0.1f);
    assert_set(&s, "sdfgi_cascades", "6");
    assert_set(&s, "sdfgi_max_distance", "819.2");
    assert_true(s.min_cell_size_m == 0.2f);
    assert_set(&s, "sdfgi_resolution", "64");
    assert_true((float)sdfgi_settings_get(&s, "sdfgi_cascade0_distance") == 6.4f);
}

static void a_distance_that_needs_impossible_cells_is_refused(void **state)
{
    (void)state;
    assert_refused("sdfgi_cascade0_distance", "0.2");
    assert_refused("sdfgi_max_distance", "1000000");
}

static void limits_are_inclusive_and_nothing_beyond_them_is_taken(void **state)
{
    (void)state;
    struct sdfgi_settings s = defaults();
    assert_set(&s, "sdfgi_bounce_feedback", "1.99");
    assert_set(&s, "sdfgi_min_cell_size", "0.01");
    assert_true(sdfgi_settings_validate(&s, NULL, 0));
    assert_refused("sdfgi_bounce_feedback", "1.991");
    assert_refused("sdfgi_bounce_feedback", "-0.01");
    assert_refused("sdfgi_cascades", "0");
    assert_refused("sdfgi_cascades", "9");
    assert_refused("sdfgi_cascades", "4294967300");
    assert_refused("sdfgi_min_cell_size", "0.0099");
    assert_refused("sdfgi_resolution", "100");
}

static void text_that_is_not_exactly_a_value_is_refused(void **state)
{
    (void)state;
    assert_refused("sdfgi_energy", "nan");
    assert_refused("sdfgi_energy", "inf");
    assert_refused("sdfgi_energy", "1 ");
    assert_refused("sdfgi_energy", "1m");
    assert_refused("sdfgi_energy", "");
    assert_refused("sdfgi_cascades", "2.5");
    assert_refused("sdfgi_enabled", "yes\nplease");
    assert_refused("sdfgi_y_scale", "75");
    assert_refused("sdfgi_visibility", "cell_mask,probe_depth");
    assert_refused("sdfgi_visibility", "cell");
    assert_refused("sdfgi_visibility", "");
    assert_refused("sdfgi_none", "1");
}

static void validation_names_the_first_bad_field(void **state)
{
    (void)state;
    char error[200];
    struct sdfgi_settings s = defaults();
    s.energy = NAN;
    assert_false(sdfgi_settings_validate(&s, error, sizeof error));
    assert_non_null(strstr(error, "sdfgi_energy"));
    s = defaults();
    s.resolution = 96;
    assert_false(sdfgi_settings_validate(&s, error, sizeof error));
    assert_non_null(strstr(error, "sdfgi_resolution"));
    s = defaults();
    s.visibility = (enum sdfgi_visibility)(SDFGI_VISIBILITY_PROBE_DEPTH + 1);
    assert_false(sdfgi_settings_validate(&s, error, sizeof error));
    assert_non_null(strstr(error, "sdfgi_visibility"));
    s = defaults();
    s.cascades = UINT32_MAX;
    assert_false(sdfgi_settings_validate(&s, error, sizeof error));
    assert_non_null(strstr(error, "sdfgi_cascades"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_off_and_physical),
        cmocka_unit_test(every_default_reads_back_as_its_row_says),
        cmocka_unit_test(every_row_is_complete_and_named_once),
        cmocka_unit_test(formatting_and_parsing_are_inverse),
        cmocka_unit_test(short_decimals_are_formatted_as_they_were_typed),
        cmocka_unit_test(distances_follow_the_cell_size_and_set_it),
        cmocka_unit_test(a_distance_that_needs_impossible_cells_is_refused),
        cmocka_unit_test(limits_are_inclusive_and_nothing_beyond_them_is_taken),
        cmocka_unit_test(text_that_is_not_exactly_a_value_is_refused),
        cmocka_unit_test(validation_names_the_first_bad_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
