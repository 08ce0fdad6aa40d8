/* SPDX-License-Identifier: MIT
 * Bad input to the program: one line on stderr that says what and where, an exit code other than 0, no file.
 */
#include "files.h"
#include "program_run.h"
#include "unit.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int make_files(void **state)
{
    if (files_setup(state))
        return 1;
    files_write_text("broken.json", "{\"camera\":\n{]");
    files_write_text("unknown.json", "{\"camera\":{\"position\":[0,1,2],\"look_at\":[0,0,0]},\"skies\":1}");
    files_write_text("range.json",
                     "{\"camera\":{\"position\":[0,1,2],\"look_at\":[0,0,0],\"yfov_deg\":200}}");
    files_write_text("path.json", "{\"points\":[[0,0,0],[10,0,0]]}");
    files_write_text("short.json", "{\"points\":[[0,0,0]]}");
    files_write_text("broken.glb", "glTF is what this is not");
    files_write_text("one.pfm", "Pf\n1 1\n-1\nabcd");
    files_write_text("two.pfm", "Pf\n2 1\n-1\nabcdabcd");
    files_write_text("cut.pfm", "Pf\n2 2\n-1\nabcd");
    files_write_text("same.json", "{\"points\":[[0,0,0],[-0.0,0,0]]}");
    return mkfifo(files_path("pipe"), 0600);
}

/* Arguments, and what the line names. */
static const char *const bad_input[][2] = {
    { "nonsense", "nonsense" },
    { "render --out a.png", "SCENE" },
    { "render none.glb", "--out" },
    { "render none.glb --out a.png", "none.glb" },
    { "render broken.glb --out a.png", "broken.glb" },
    { "render none.glb --out none/a.png", "none/a.png" },
    { "render none.glb --out a.txt", "a.txt" },
    { "render none.glb --out .", "\".\"" },
    { "render none.glb --out a.png --report none/r.json", "none/r.json" },
    { "render none.glb --out a.png --aov direct=none/d.exr", "none/d.exr" },
    { "render none.glb --out a.png --aov direct=d.png", "d.png" },
    { "render none.glb --out a.png --aov shadows=d.exr", "shadows" },
    { "render none.glb --out a.png --report ./a.png", "--out and --report" },
    { "render none.glb --out a.exr --aov direct=b.exr --aov normal=$PWD/a.exr", "--out and --aov normal=" },
    { "render none.glb --out a.png --view none.json", "none.json" },
    { "render none.glb --out a.png --view broken.json", "broken.json: broken JSON in line 2" },
    { "render none.glb --out a.png --view unknown.json", "unknown.json: skies: unknown key" },
    { "render none.glb --out a.png --view range.json", "range.json: camera.yfov_deg" },
    { "render none.glb --out a.png --view pipe", "pipe: not a plain file" },
    { "render none.glb --out a.png --view .", ".: not a plain file" },
    { "render none.glb --out a.png --view /dev/zero", "/dev/zero: not a plain file" },
    { "render none.glb --out a.png --set sdfgi_energy=1000", "sdfgi_energy" },
    { "render none.glb --out a.png --set sdfgi_none=1", "sdfgi_none" },
    { "render none.glb --out a.png --set energy", "key=value" },
    { "render none.glb --out a.png --frames 1x", "1x" },
    { "render none.glb --out a.png --lookup eighth", "--lookup is \"eighth\"" },
    { "render none.glb --out a.png --reflections forward", "--reflections is \"forward\"" },
    { "render none.glb --out a.png --turn-sun 0.1", "--turn-sun needs --frames" },
    { "render none.glb --out a.png --frames 2 --turn-sun 200", "--turn-sun" },
    { "render none.glb --out a.png --flicker 10", "--flicker needs --frames" },
    { "render none.glb --out a.png --frames 2 --flicker 101", "--flicker" },
    { "render none.glb --out a.png --eyes 0.1", "--eyes needs --stereo" },
    { "render none.glb --out a.png --stereo --eyes 0", "--eyes" },
    { "view none.glb --eyes 0.1", "--eyes needs --stereo" },
    { "render none.glb --out a.png --debug voxels", "--debug is \"voxels\"" },
    { "render none.glb --out a.png --debug solid --gi off", "GI is off" },
    { "render none.glb --out a.png --off b.exr", "--off is \"b.exr\"" },
    { "render none.glb --out a.exr --off b.png", "--out is \"a.exr\"" },
    { "render none.glb --out a.png --off b.png --gi off", "GI is off" },
    { "render none.glb --out a.png --off ./a.png", "--out and --off" },
    { "render none.glb --out a.png --off none/b.png", "none/b.png" },
    { "render none.glb --out a.png --size 10000x10000 --ssaa 4", "--ssaa" },
    { "walk --out w", "out/world.glb" },
    { "walk none.glb --out w", "views/walk.json" },
    { "walk none.glb --path none.json --out w", "none.json" },
    { "walk none.glb --path broken.json --out w", "broken.json: broken JSON in line 2" },
    { "walk none.glb --path pipe --out w", "pipe: not a plain file" },
    { "walk none.glb --path same.json --out w --frames 3", "same.json: points[1]" },
    { "walk none.glb --path short.json --out w", "short.json: points" },
    { "walk none.glb --path path.json", "--out" },
    { "walk none.glb --path path.json --out none/w", "none/w" },
    { "walk none.glb --path path.json --out broken.json", "broken.json" },
    { "walk none.glb --path path.json --out . --report none/r.json", "none/r.json" },
    { "walk none.glb --path path.json --out .", "none.glb" },
    { "walk none.glb --path path.json --out w", "none.glb" },
    { "walk none.glb --path path.json --out w --report none/r.json", "none/r.json" },
    { "walk none.glb --path path.json --out . --report ./walk.svg", "the plot and --report" },
    { "walk none.glb --path path.json --out . --start 11", "--start" },
    { "walk none.glb --path path.json --out . --speed 0", "--speed" },
    { "walk none.glb --path path.json --out . --fps 10000 --speed 0.001", "frames" },
    { "walk none.glb --path path.json --out . --every 0", "--every" },
    { "walk none.glb --path path.json --out . --sample 1,2,3", "--sample" },
    { "walk none.glb --path path.json --out . --sample 1,2,3,0,0,0", "--sample" },
    { "walk none.glb --path path.json --out . --sample 1,2,3,0,1,0,5", "--sample" },
    { "walk none.glb --path path.json --out . --sample 1,2,3,0,1,0 --window", "--sample" },
    { "walk none.glb --path path.json --out . --lookup eighth", "--lookup is \"eighth\"" },
    { "walk none.glb --path path.json --out . --reflections 3", "--reflections is \"3\"" },
    { "walk none.glb --path path.json --out . --debug Solid", "--debug is \"Solid\"" },
    { "walk none.glb --path path.json --out . --view none.json", "none.json" },
    { "walk none.glb --path path.json --out . --set energy=-1", "sdfgi_energy" },
    { "info --set cascades=9", "sdfgi_cascades" },
    { "properties --xml --json", "--xml" },
#ifdef SDFGI_WITH_RAYCAST
    { "reference none.glb --out a.exr --aov normal=./a.exr", "--out and --aov normal=./a.exr" },
    { "reference none.glb --out a.exr --aov normal=b.exr --aov normal=c.exr", "normal is given twice" },
    { "reference none.glb --out a.exr --geometry cubes", "cubes" },
    { "reference none.glb --out a.exr --set cascades=2", "--set" },
    { "reference none.glb --out a.exr --geometry voxels --set cascades=9", "sdfgi_cascades" },
#endif
    { "compare one.pfm", "REFERENCE" },
    { "compare one.pfm none.pfm", "none.pfm" },
    { "compare one.pfm two.pfm", "expected equal sizes" },
    { "compare one.pfm cut.pfm", "cut.pfm" },
    { "compare one.pfm one.pfm --error-map none/e.png", "none/e.png" },
    { "compare one.pfm one.pfm --error-map e.png --strip e.png", "--error-map and --strip" },
};

static void bad_input_gives_one_line_and_no_file(void **state)
{
    (void)state;
    const int before = files_count();
    for (size_t i = 0; i < sizeof bad_input / sizeof bad_input[0]; i++) {
        const struct program_run run = run_program("", bad_input[i][0]);
        if (run.code == 0 || !strstr(run.err, bad_input[i][1]) || strncmp(run.err, "sdfgi: ", 7) != 0 ||
            strchr(run.err, '\n') != run.err + strlen(run.err) - 1 || run.out[0])
            fail_msg("%s: code %d, stderr \"%s\", stdout \"%s\"", bad_input[i][0], run.code, run.err,
                     run.out);
        assert_int_equal(files_count(), before);
    }
}

static void without_a_vulkan_device_info_says_so(void **state)
{
    (void)state;
    const struct program_run run =
        run_program("VK_ICD_FILENAMES=/none.json VK_DRIVER_FILES=/none.json", "info");
    assert_int_not_equal(run.code, 0);
    assert_non_null(strstr(run.err, "Vulkan"));
    assert_ptr_equal(strchr(run.err, '\n'), run.err + strlen(run.err) - 1);
    /* The memory estimate needs no device. */
    assert_non_null(strstr(run.out, "total"));
    assert_non_null(strstr(run.out, "  probes_state "));
}

static void listing_devices_leaves_nothing_behind(void **state)
{
    (void)state;
    const struct program_run run = run_program("SDFGI_VALIDATION=1", "info");
    if (run.code != 0)
        skip();
    assert_string_equal(run.err, "");
}

static void every_command_has_help(void **state)
{
    (void)state;
    const struct program_run list = run_program("", "--help");
    assert_int_equal(list.code, 0);
    int commands = 0;
    char name[32];
    for (const char *line = strstr(list.out, "\n  "); line; line = strstr(line + 1, "\n  ")) {
        char arguments[64];
        assert_int_equal(sscanf(line, " %31s", name), 1);
        snprintf(arguments, sizeof arguments, "%s --help", name);
        const struct program_run run = run_program("", arguments);
        assert_int_equal(run.code, 0);
        assert_non_null(strstr(run.out, "usage: sdfgi"));
        assert_non_null(strstr(run.out, name));
        assert_string_equal(run.err, "");
        static const char *const common[] = { "\n  --quiet ", "\n  --device ", "\n  --report " };
        for (int i = 0; i < 3; i++)
            if (!strstr(run.out, common[i]))
                fail_msg("%s has no%s", name, common[i] + 2);
        commands++;
    }
    assert_true(commands >= 4);
}

static void a_picture_compared_with_itself_has_no_error(void **state)
{
    (void)state;
    const struct program_run run = run_program("", "compare two.pfm two.pfm --json");
    assert_int_equal(run.code, 0);
    assert_non_null(strstr(run.out, "\"flip\":\t0"));
}

/* Commands that print something, and what their reports hold. */
static void quiet_commands_print_nothing_and_report(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "compare two.pfm two.pfm --device 0", "\"flip\"" },
        { "properties --markdown", "\"sdfgi_cascades\"" },
        { "info", "\"total_bytes\"" },
        { "walk tiny.gltf --path path.json --set enabled=false --hold 0 --size 24x24 --frames 2 --out w",
          "\"frames_rendered\"" },
#ifdef SDFGI_WITH_RAYCAST
        { "reference tiny.gltf --size 8x8 --spp 1 --out r.pfm", "\"samples_per_pixel\"" },
#endif
    };
    const bool has_device = run_program("", "info").code == 0;
    files_write_triangle("tiny.gltf");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char arguments[256], text[65536];
        if (!has_device && (strcmp(rows[i][0], "info") == 0 || strncmp(rows[i][0], "walk", 4) == 0))
            continue;
        snprintf(arguments, sizeof arguments, "%s --quiet --report report.json", rows[i][0]);
        const struct program_run run = run_program("", arguments);
        assert_int_equal(run.code, 0);
        assert_string_equal(run.out, "");
        assert_string_equal(run.err, "");
        files_take_text("report.json", text, sizeof text);
        if (!strstr(text, rows[i][1]))
            fail_msg("%s is not in the report of %s", rows[i][1], rows[i][0]);
    }
    run_in_folder("rm -rf r.pfm w tiny.gltf report.json");
}

#ifdef SDFGI_WITH_RAYCAST
static void assert_traces(const char *arguments, const char *picture)
{
    char line[256];
    snprintf(line, sizeof line, "reference tiny.gltf --quiet --size 8x8 --spp 2 --out %s %s", picture,
             arguments);
    const struct program_run run = run_program("", line);
    assert_string_equal(run.err, "");
    assert_int_equal(run.code, 0);
}

#define CAMERA "{\"camera\":{\"position\":[0,0,5],\"look_at\":[0,1,0]}"

/* What a view file says is what options say, and options go over it. */
static void options_go_over_the_view_file(void **state)
{
    (void)state;
    files_write_triangle("tiny.gltf");
    files_write_text("plain.json", CAMERA "}");
    files_write_text("map.json", CAMERA ",\"environment\":\"two.pfm\",\"sun\":\"0,-1,-1\"}");
    files_write_text("sky.json", CAMERA ",\"sky\":\"2\"}");
    assert_traces("--view map.json", "map.pfm");
    assert_traces("--view plain.json --environment two.pfm --sun 0,-1,-1", "options.pfm");
    assert_traces("--view sky.json --environment two.pfm --sun 0,-1,-1", "over.pfm");
    run_in_folder("cmp map.pfm options.pfm && cmp map.pfm over.pfm");
    assert_traces("--view sky.json", "sky.pfm");
    assert_traces("--view map.json --sky 2 --sun none", "bare.pfm");
    run_in_folder("cmp sky.pfm bare.pfm && ! cmp -s sky.pfm map.pfm");
    run_in_folder("rm -f map.* options.pfm over.pfm sky.* bare.pfm plain.json tiny.gltf");
}

/* A scene is loaded first, so that these cannot be among the rows above. */
static void wrong_parts_of_a_view_are_named(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        { "--sky blue", "reference: --sky is \"blue\"" },
        { "--sun 0,0,0", "--sun is \"0,0,0\"" },
        { "--camera Garden", "--camera is \"Garden\"" },
        { "--environment gone.hdr", "gone.hdr" },
        { "--environment map.png", "picture of radiance" },
        { "--environment two.pfm --sky 1", "give one of them" },
        { "--pose-time -1", "--pose-time is \"-1\"" },
    };
    files_write_triangle("tiny.gltf");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char arguments[256];
        snprintf(arguments, sizeof arguments, "reference tiny.gltf --out r.pfm %s", rows[i][0]);
        const struct program_run run = run_program("", arguments);
        if (run.code == 0 || !strstr(run.err, rows[i][1]) ||
            strchr(run.err, '\n') != run.err + strlen(run.err) - 1)
            fail_msg("%s: \"%s\"", rows[i][0], run.err);
    }
    run_in_folder("rm -f tiny.gltf");
}
#endif

int main(int argc, char **argv)
{
    if (argc < 2)
        return EXIT_FAILURE;
    program_set(argv[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_input_gives_one_line_and_no_file),
        cmocka_unit_test(without_a_vulkan_device_info_says_so),
        cmocka_unit_test(listing_devices_leaves_nothing_behind),
        cmocka_unit_test(every_command_has_help),
        cmocka_unit_test(a_picture_compared_with_itself_has_no_error),
        cmocka_unit_test(quiet_commands_print_nothing_and_report),
#ifdef SDFGI_WITH_RAYCAST
        cmocka_unit_test(options_go_over_the_view_file),
        cmocka_unit_test(wrong_parts_of_a_view_are_named),
#endif
    };
    return cmocka_run_group_tests(tests, make_files, files_teardown);
}
