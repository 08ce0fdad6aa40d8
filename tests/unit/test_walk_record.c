/* SPDX-License-Identifier: MIT
 * A walk's record: which time belongs to which frame, what is the worst of it, and how it is written. */
#include "files.h"
#include "unit.h"

#include "walk/walk_report.h"
#include "walk/walk_sheet.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* The library's own lives beside its Vulkan code, which a unit test does without. */
const char *sdfgi_memory_category_name(enum sdfgi_memory_category category)
{
    (void)category;
    return "bytes";
}

enum { FRAMES = 100 };

static struct walk_record record;

/* Frame `index`: cascades are generated in every tenth, rays are traced in all but the last ten. */
static struct sdfgi_report report_of(uint32_t index)
{
    struct sdfgi_report report = { .active = true, .pass_count = 2, .command_count = 10 + index };
    report.passes[0] = (struct sdfgi_pass_report){ .name = "probe_trace",
                                                   .ran = index < FRAMES - 10,
                                                   .reason = index < FRAMES - 10 ? "light" : "settled",
                                                   .work = index < FRAMES - 10 ? 1000 + index : 7,
                                                   .work_unit = "rays" };
    report.passes[1] = (struct sdfgi_pass_report){ .name = "light_list",
                                                   .ran = index % 10 == 3,
                                                   .reason = index % 10 == 3 ? "moved" : "still",
                                                   .dispatches = index % 10 == 3 ? 2 : 0,
                                                   .work = index % 10 == 3 ? 700 : 0,
                                                   .work_unit = "light cells" };
    return report;
}

/* Times arrive two frames late, as the library's do: frame n took n ms for its rays. */
static void fill(void)
{
    record = (struct walk_record){ 0 };
    for (uint32_t i = 0; i < FRAMES + 2; i++) {
        struct sdfgi_report report = report_of(i);
        const bool ran = i >= 2 && i - 2 < FRAMES - 10;
        report.passes[0].gpu_ns_valid = ran;
        report.passes[0].gpu_ns = ran ? 1000000 * (uint64_t)(i - 2) : 55;
        if (i < FRAMES) {
            assert_true(walk_record_add(&record, &report));
            record.frames[i].gpu_ns = 1000000 * (uint64_t)(i + 100);
            for (int c = 0; c < 3; c++)
                record.frames[i].irradiance[0][c] = i < 50 ? 2.0f : 2.1f;
        }
        walk_record_times(&record, (int64_t)i - 2, &report);
    }
}

static void times_go_to_their_own_frames(void **state)
{
    (void)state;
    fill();
    assert_int_equal(record.frame_count, FRAMES);
    for (uint32_t i = 0; i < FRAMES; i++) {
        assert_int_equal(record.frames[i].passes[0].timed, i < FRAMES - 10);
        assert_int_equal(record.frames[i].gi_gpu_ns, i < FRAMES - 10 ? 1000000 * (uint64_t)i : 0);
    }
    walk_record_finish(&record);
}

static void work_counts_only_where_a_pass_ran(void **state)
{
    (void)state;
    fill();
    struct walk_statistics work;
    assert_true(walk_record_statistics(&record, walk_series_pass_work, 0, &work));
    assert_int_equal(work.samples, FRAMES);
    assert_true(work.worst == 1089 && work.worst_frame == 89);
    double total = 0;
    for (uint32_t i = 0; i < FRAMES - 10; i++)
        total += 1000 + i;
    assert_true(work.total == total);
    /* Ten zeros, then 1000 up: the fiftieth of a hundred is the fortieth of those. */
    assert_true(work.median == 1039 && work.p99 == 1088);
    walk_record_finish(&record);
}

static void unknown_times_are_left_out(void **state)
{
    (void)state;
    fill();
    struct walk_statistics gi;
    record.frames[40].passes[0].timed = false;
    assert_true(walk_record_statistics(&record, walk_series_gi_gpu_ns, 0, &gi));
    /* Nor did frame 93's only pass come with a time. */
    assert_int_equal(gi.samples, FRAMES - 2);
    walk_record_finish(&record);
}

static void cascades_that_were_generated_are_counted(void **state)
{
    (void)state;
    fill();
    struct walk_statistics cascades;
    assert_true(walk_record_statistics(&record, walk_series_count, WALK_COUNT_cascades_generated, &cascades));
    assert_true(cascades.total == 20 && cascades.worst == 2 && cascades.worst_frame == 3);
    walk_record_finish(&record);
}

static void the_largest_change_of_light_is_found(void **state)
{
    (void)state;
    fill();
    uint32_t frame;
    assert_true(fabs(walk_record_change(&record, 0, &frame) - 0.05) < 1e-6);
    assert_int_equal(frame, 50);
    walk_record_finish(&record);
}

static void an_empty_record_has_zeros(void **state)
{
    (void)state;
    struct walk_statistics gi;
    uint32_t frame;
    record = (struct walk_record){ 0 };
    assert_true(walk_record_statistics(&record, walk_series_gi_gpu_ns, 0, &gi));
    assert_true(gi.samples == 0 && gi.worst == 0 && gi.median == 0);
    assert_true(walk_record_change(&record, 0, &frame) == 0);
}

/* ---- Files ------------------------------------------------------------------------------------------ */

static struct walk_summary summary_of(void)
{
    struct walk_summary summary = { .run = { "device", "driver", "cpu", 64, 36, 1.5, 0 },
                                    .scene = "scene.glb",
                                    .path = "path.json",
                                    .length_m = 10,
                                    .speed_m_s = 5,
                                    .fps = 50,
                                    .sample_positions = { { 1, 2, 3 } },
                                    .sample_normals = { { 0, 1, 0 } },
                                    .sample_count = 1 };
    sdfgi_settings_default(&summary.run.settings);
    return summary;
}

static double number_at(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static void the_report_says_what_every_frame_did(void **state)
{
    (void)state;
    fill();
    const struct walk_summary summary = summary_of();
    cJSON *json = walk_report_to_json(&record, &summary);
    const cJSON *frames = cJSON_GetObjectItem(json, "frames"),
                *journey = cJSON_GetObjectItem(json, "journey");
    assert_int_equal(cJSON_GetArraySize(frames), FRAMES);
    const cJSON *frame = cJSON_GetArrayItem(frames, 13), *passes = cJSON_GetObjectItem(frame, "passes");
    assert_int_equal(cJSON_GetArraySize(passes), 2);
    const cJSON *trace = cJSON_GetObjectItem(passes, "probe_trace");
    assert_true(number_at(trace, "work") == 1013 && number_at(trace, "gpu_ns") == 13e6);
    assert_string_equal(cJSON_GetObjectItem(trace, "reason")->valuestring, "light");
    assert_true(number_at(frame, "library_commands") == 23 && number_at(frame, "time_s") == 0.26);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(cJSON_GetArrayItem(frames, 95), "passes")), 0);
    const cJSON *pass = cJSON_GetArrayItem(cJSON_GetObjectItem(journey, "passes"), 0);
    assert_string_equal(cJSON_GetObjectItem(pass, "skipped_because")->valuestring, "settled");
    assert_true(number_at(cJSON_GetObjectItem(journey, "gi_gpu_ns"), "worst_frame") == 89);
    assert_true(number_at(cJSON_GetObjectItem(journey, "frame_gpu_ns"), "worst") == 199e6);
    const cJSON *sample = cJSON_GetArrayItem(cJSON_GetObjectItem(journey, "samples"), 0);
    assert_true(number_at(sample, "worst_change_frame") == 50);
    cJSON_Delete(json);
    walk_record_finish(&record);
}

static void the_plot_has_every_series(void **state)
{
    (void)state;
    static char text[1 << 20], error[300];
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
    fill();
    const struct walk_summary summary = summary_of();
    if (walk_plot_write(&record, &summary, files_path("walk.svg"), error, sizeof error) != WALK_PLOT_WRITTEN)
        fail_msg("%s", error);
    files_take_text("walk.svg", text, sizeof text);
    static const char *const expected[] = {
        "<svg", "</svg>", "probe_trace, rays", "light_list, light cells", "GI", "at (1, 2, 3)"
    };
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++)
        if (!strstr(text, expected[i]))
            fail_msg("the plot lacks \"%s\"", expected[i]);
    walk_record_finish(&record);
}

static void without_gnuplot_there_is_a_message_and_no_file(void **state)
{
    (void)state;
    char error[300];
    fill();
    const struct walk_summary summary = summary_of();
    char *programs = getenv("PATH") ? strdup(getenv("PATH")) : NULL;
    setenv("PATH", "/nonexistent", 1);
    assert_int_equal(walk_plot_write(&record, &summary, files_path("walk.svg"), error, sizeof error),
                     WALK_PLOT_NO_GNUPLOT);
    if (programs)
        setenv("PATH", programs, 1);
    free(programs);
    assert_non_null(strstr(error, "gnuplot is not installed"));
    assert_int_equal(files_count(), 0);
    walk_record_finish(&record);
}

/* gnuplot leaves with 0 then. A limit on the size of files stands for a full disk. */
static void a_plot_that_is_cut_short_is_no_plot(void **state)
{
    (void)state;
    char error[300];
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
    fill();
    const struct walk_summary summary = summary_of();
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    const struct rlimit small = { 16384, before.rlim_max };
    void (*const handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const enum walk_plot_result result =
        walk_plot_write(&record, &summary, files_path("walk.svg"), error, sizeof error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, handler);
    assert_int_equal(result, WALK_PLOT_NOT_WRITTEN);
    assert_non_null(strstr(error, "cut short"));
    assert_int_equal(files_count(), 0);
    walk_record_finish(&record);
}

/* ---- Contact sheet ---------------------------------------------------------------------------------- */

static void every_picture_has_its_place_on_the_sheet(void **state)
{
    (void)state;
    enum { WIDTH = 960, HEIGHT = 20, MOMENTS = 6 };
    static uint8_t picture[4 * WIDTH * HEIGHT];
    struct walk_sheet sheet;
    assert_true(walk_sheet_init(&sheet, MOMENTS, WIDTH, HEIGHT));
    assert_int_equal(sheet.shrink, 2);
    for (uint32_t i = 0; i < 2 * MOMENTS; i++) {
        memset(picture, (int)(100 + i), sizeof picture);
        walk_sheet_add(&sheet, i / 2, i % 2, picture);
    }
    uint32_t texels[256] = { 0 };
    for (uint32_t i = 0; i < sheet.width * sheet.height; i++)
        texels[sheet.rgba[4 * i]]++;
    for (uint32_t i = 0; i < 2 * MOMENTS; i++)
        assert_int_equal(texels[100 + i], sheet.tile_width * sheet.tile_height);
    walk_sheet_finish(&sheet);
}

static void a_sliver_of_a_picture_fits_a_sheet(void **state)
{
    (void)state;
    static uint8_t picture[4 * 2000];
    struct walk_sheet sheet;
    memset(picture, 77, sizeof picture);
    assert_true(walk_sheet_init(&sheet, 1, 2000, 1));
    walk_sheet_add(&sheet, 0, true, picture);
    walk_sheet_finish(&sheet);
    assert_true(walk_sheet_init(&sheet, 1, 1, 2000));
    walk_sheet_add(&sheet, 0, true, picture);
    assert_int_equal(sheet.tile_height, 2000);
    walk_sheet_finish(&sheet);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(times_go_to_their_own_frames),
        cmocka_unit_test(work_counts_only_where_a_pass_ran),
        cmocka_unit_test(unknown_times_are_left_out),
        cmocka_unit_test(cascades_that_were_generated_are_counted),
        cmocka_unit_test(the_largest_change_of_light_is_found),
        cmocka_unit_test(an_empty_record_has_zeros),
        cmocka_unit_test(the_report_says_what_every_frame_did),
        cmocka_unit_test(the_plot_has_every_series),
        cmocka_unit_test(without_gnuplot_there_is_a_message_and_no_file),
        cmocka_unit_test(a_plot_that_is_cut_short_is_no_plot),
        cmocka_unit_test(every_picture_has_its_place_on_the_sheet),
        cmocka_unit_test(a_sliver_of_a_picture_fits_a_sheet),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
