/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include "report/report.h"

#include <stdlib.h>
#include <string.h>

/* The library's own needs Vulkan; names are all that the report asks for. */
const char *sdfgi_memory_category_name(enum sdfgi_memory_category category)
{
    static const char *const names[] = { "volumes", "probes", "scratch", "lists", "readback", "views" };
    return names[category];
}

static const cJSON *get(const cJSON *json, const char *path)
{
    char copy[128];
    strcpy(copy, path);
    for (char *key = strtok(copy, "."); key; key = strtok(NULL, ".")) {
        json = key[0] >= '0' && key[0] <= '9' ? cJSON_GetArrayItem(json, atoi(key))
                                              : cJSON_GetObjectItemCaseSensitive(json, key);
        if (!json)
            fail_msg("the report has no %s", path);
    }
    return json;
}

static struct sdfgi_report make_frame(bool ran, uint64_t gpu_ns)
{
    struct sdfgi_report frame = { .pass_count = 2, .converged_fraction = 0.5f, .command_count = 17 };
    frame.passes[0] = (struct sdfgi_pass_report){ .name = "voxelize",
                                                  .ran = ran,
                                                  .reason = ran ? "dirty" : "nothing changed",
                                                  .dispatches = ran ? 3 : 0,
                                                  .work = ran ? 1000 : 0,
                                                  .work_unit = "cells",
                                                  .gpu_ns = gpu_ns,
                                                  .gpu_ns_valid = gpu_ns != 0 };
    frame.passes[1] =
        (struct sdfgi_pass_report){ .name = "emission", .reason = "no emission", .work_unit = "cells" };
    frame.memory.bytes[1] = 77;
    frame.memory.total_bytes = 77;
    frame.health_count = 1;
    frame.health[0] = (struct sdfgi_health){ SDFGI_MESSAGE_NO_LIGHTS, 4, "a hint" };
    return frame;
}

static void quantiles_are_nearest_ranks(void **state)
{
    (void)state;
    uint64_t values[] = { 50, 10, 40, 30, 20 };
    struct report_samples samples = { values, 5, 5 };
    assert_int_equal(report_quantile(&samples, 0), 10);
    assert_int_equal(report_quantile(&samples, 0.5), 30);
    assert_int_equal(report_quantile(&samples, 0.95), 50);
    assert_int_equal(report_quantile(&samples, 1), 50);
    samples.count = 0;
    assert_int_equal(report_quantile(&samples, 0.5), 0);
}

static void frames_are_collected_pass_by_pass(void **state)
{
    (void)state;
    struct report report = { 0 };
    for (uint64_t i = 1; i <= 1000; i++) {
        const struct sdfgi_report frame = make_frame(i <= 600, i <= 600 ? i : 0);
        report_add_frame(&report, &frame, 10 * i);
        report_add_fog(&report, i <= 600 ? i : 0);
    }
    struct report_summary summary = { .device_name = "a",
                                      .device_driver = "b",
                                      .device_type = "cpu",
                                      .width = 320,
                                      .height = 180,
                                      .seconds = 1.5,
                                      .exposure = 0.25,
                                      .estimated_bytes = 77 };
    sdfgi_settings_default(&summary.settings);
    cJSON *json = report_to_json(&report, &summary);
    assert_non_null(json);
    assert_int_equal(get(json, "frames")->valueint, 1000);
    assert_int_equal(get(json, "size.1")->valueint, 180);
    assert_true(get(json, "exposure")->valuedouble == 0.25);
    assert_int_equal(get(json, "passes.0.ran")->valueint, 600);
    assert_string_equal(get(json, "passes.0.reason")->valuestring, "dirty");
    assert_string_equal(get(json, "passes.0.skipped_because")->valuestring, "nothing changed");
    assert_int_equal(get(json, "passes.0.work")->valueint, 1000);
    assert_int_equal(get(json, "passes.0.gpu_ns.median")->valueint, 300);
    assert_int_equal(get(json, "passes.0.gpu_ns.p95")->valueint, 570);
    assert_int_equal(get(json, "passes.0.gpu_ns.max")->valueint, 600);
    assert_int_equal(get(json, "passes.1.ran")->valueint, 0);
    assert_true(cJSON_IsNull(get(json, "passes.1.reason")));
    assert_string_equal(get(json, "passes.1.skipped_because")->valuestring, "no emission");
    assert_int_equal(get(json, "frame_gpu_ns.p99")->valueint, 9900);
    assert_int_equal(get(json, "fog_gpu_ns.median")->valueint, 300);
    assert_int_equal(get(json, "fog_gpu_ns.samples")->valueint, 600);
    assert_int_equal(get(json, "library_commands")->valueint, 17);
    assert_int_equal(get(json, "memory.by_category.probes")->valueint, 77);
    assert_int_equal(get(json, "memory.estimated_bytes")->valueint, 77);
    assert_string_equal(get(json, "health.0.code")->valuestring, "NO_LIGHTS");
    assert_true(cJSON_IsFalse(get(json, "gi.enabled")));
    assert_true(get(json, "gi.settings.sdfgi_min_cell_size")->valuedouble == 0.2);
    assert_string_equal(get(json, "gi.settings.sdfgi_y_scale")->valuestring, "100%");
    cJSON_Delete(json);
    report_finish(&report);
}

/* Views differ more than frames with and without GI do, so pairs are compared before medians are taken. */
static void gi_costs_what_pairs_of_frames_differ_by(void **state)
{
    (void)state;
    const struct report_cost_pair pairs[] = { { 11000000, 470000, 5600000 },
                                              { 25000000, 900000, 20000000 },
                                              { 8000000, 400000, 3100000 } };
    struct report report = { 0 };
    struct report_summary summary = { .cost = report_cost_of(pairs, 3) };
    sdfgi_settings_default(&summary.settings);
    cJSON *json = report_to_json(&report, &summary);
    assert_float_equal(get(json, "gi_cost.frame_ms")->valuedouble, 11, 1e-9);
    assert_float_equal(get(json, "gi_cost.frame_off_ms")->valuedouble, 5.6, 1e-9);
    assert_float_equal(get(json, "gi_cost.gi_cost_ms")->valuedouble, 5, 1e-9);
    assert_float_equal(get(json, "gi_cost.lookup_ms")->valuedouble, 4.5, 1e-9);
    assert_float_equal(get(json, "gi_cost.update_ms")->valuedouble, 0.5, 1e-9);
    assert_int_equal(get(json, "gi_cost.samples")->valueint, 3);
    cJSON_Delete(json);
}

static void nothing_is_said_of_what_is_not_known(void **state)
{
    (void)state;
    const struct report_cost_pair untimed = { 0 };
    struct report report = { 0 };
    struct report_summary summary = { .cost = report_cost_of(&untimed, 1) };
    sdfgi_settings_default(&summary.settings);
    cJSON *json = report_to_json(&report, &summary);
    assert_non_null(json);
    assert_null(cJSON_GetObjectItemCaseSensitive(json, "gi_cost"));
    assert_null(cJSON_GetObjectItemCaseSensitive(json, "fog_gpu_ns"));
    cJSON_Delete(json);
}

static void every_setting_in_force_is_reported(void **state)
{
    (void)state;
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    cJSON *json = report_settings_to_json(&settings);
    const struct sdfgi_property_info *info;
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++)
        assert_non_null(cJSON_GetObjectItemCaseSensitive(json, info->name));
    cJSON_Delete(json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_are_nearest_ranks),
        cmocka_unit_test(frames_are_collected_pass_by_pass),
        cmocka_unit_test(gi_costs_what_pairs_of_frames_differ_by),
        cmocka_unit_test(nothing_is_said_of_what_is_not_known),
        cmocka_unit_test(every_setting_in_force_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
