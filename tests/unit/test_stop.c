/* SPDX-License-Identifier: MIT
 * SIGINT and SIGTERM: the program stops within a second, keeps what is done, says so, and its exit code names
 * the signal. */
#include "files.h"
#include "unit.h"

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const double limit_s = 1, longest_delay_s = 20;

static const char *program;

struct run {
    int code;
    double stop_s; /* from the signal to the end */
    char err[4096];
};

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void sleep_s(double seconds)
{
    const struct timespec t = { (time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds)) };
    nanosleep(&t, NULL);
}

static pid_t start(const char *arguments)
{
    char command[1024];
    snprintf(command, sizeof command, "cd %s && exec '%s' %s >out.txt 2>err.txt", files_path(""), program,
             arguments);
    const pid_t child = fork();
    if (child != 0)
        return child;
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

static struct run stop(pid_t child, int number)
{
    struct run run;
    int status;
    kill(child, number);
    const double before_s = now_s();
    waitpid(child, &status, 0);
    run.stop_s = now_s() - before_s;
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    files_take_text("err.txt", run.err, sizeof run.err);
    remove(files_path("out.txt"));
    return run;
}

/* How many times longer than alone a program takes: others may use the processors as well. */
static double slowdown(void)
{
    const double begin_s = now_s();
    const clock_t begin = clock();
    while (clock() - begin < CLOCKS_PER_SEC / 10)
        continue;
    return (now_s() - begin_s) / ((double)(clock() - begin) / CLOCKS_PER_SEC);
}

/* It stopped in time and said so in one line. */
static void assert_stopped(const struct run *run, const char *arguments, int number)
{
    char said[64];
    snprintf(said, sizeof said, ": stopped by %s after ", number == SIGINT ? "SIGINT" : "SIGTERM");
    if (run->code != 128 + number || !strstr(run->err, said) ||
        strchr(run->err, '\n') != run->err + strlen(run->err) - 1)
        fail_msg("%s: code %d, stderr \"%s\"", arguments, run->code, run->err);
    if (run->stop_s > limit_s && run->stop_s > limit_s * slowdown())
        fail_msg("%s: stopped after %.2f s", arguments, run->stop_s);
}

/* Gives the program `delay_s` to begin its work, and more where that was not enough. */
static void stop_at_work(const char *arguments, double delay_s, int number)
{
    struct run run;
    for (;; delay_s *= 2) {
        const pid_t child = start(arguments);
        sleep_s(delay_s);
        run = stop(child, number);
        if (!strstr(run.err, "before there was anything to keep") || delay_s > longest_delay_s)
            break;
    }
    assert_stopped(&run, arguments, number);
}

static bool has_device(void)
{
    static int code = -1;
    char command[1024];
    snprintf(command, sizeof command, "'%s' info >/dev/null 2>&1", program);
    if (code < 0)
        code = system(command);
    return code == 0;
}

static void run_in_folder(const char *command)
{
    char line[1024];
    snprintf(line, sizeof line, "cd %s && %s", files_path(""), command);
    if (system(line) != 0)
        fail_msg("%s", command);
}

/* While it loads and looks for a device; earlier it has no handler yet, later it has a frame. */
static void a_run_without_results_ends_at_once(void **state)
{
    (void)state;
    if (!has_device())
        skip();
    struct run run = { .code = 0 };
    for (double delay_s = 0.02; delay_s < longest_delay_s && run.code != 128 + SIGTERM; delay_s *= 1.5) {
        const pid_t child = start("render tiny.gltf --gi off --size 24x24 --frames 1000000 --out a.png");
        sleep_s(delay_s);
        run = stop(child, SIGTERM);
    }
    assert_string_equal(run.err, "sdfgi: SIGTERM ended the run before there was anything to keep\n");
    assert_int_equal(files_count(), 1);
}

static void a_picture_shows_the_light_that_there_was(void **state)
{
    (void)state;
    if (!has_device())
        skip();
    stop_at_work("render tiny.gltf --gi off --size 24x24 --frames 1000000 --report r.json --out a.png", 1,
                 SIGINT);
    run_in_folder("test -s a.png && grep -q '\"frames\":.*[1-9]' r.json && rm a.png r.json");
    assert_int_equal(files_count(), 1);
}

static void a_walk_keeps_its_frames(void **state)
{
    (void)state;
    if (!has_device())
        skip();
    files_write_text("path.json", "{\"points\":[[0,0,2],[10,0,2]]}");
    static const char arguments[] =
        "walk tiny.gltf --path path.json --set enabled=false --hold 0 --size 24x24 "
        "--frames 100000 --every 100000 --out w";
    const double begin_s = now_s();
    const pid_t child = start(arguments);
    while (access(files_path("w/frame_000000.off.png"), F_OK) != 0 && now_s() - begin_s < longest_delay_s)
        sleep_s(0.01);
    sleep_s(0.1); /* until a frame is finished */
    const struct run run = stop(child, SIGTERM);
    assert_stopped(&run, arguments, SIGTERM);
    run_in_folder("grep -q '\"frames_rendered\":.*[1-9]' w/report.json && test -s w/contact_sheet.png && "
                  "grep -q '\"frames_asked\":.*100000' w/report.json");
    run_in_folder("rm -r w path.json");
    assert_int_equal(files_count(), 1);
}

#ifdef SDFGI_WITH_RAYCAST

static void a_reference_keeps_picture_and_samples(void **state)
{
    (void)state;
    static const int signals[] = { SIGINT, SIGTERM };
    for (int i = 0; i < 2; i++) {
        stop_at_work("reference tiny.gltf --size 64x64 --spp 100000000 --out a.exr", 0.2, signals[i]);
        run_in_folder("test -s a.exr && test -s a.exr.state && rm a.exr");
    }
    char command[512];
    snprintf(command, sizeof command,
             "'%s' reference tiny.gltf --size 64x64 --spp 2 --resume --out a.exr >/dev/null", program);
    run_in_folder(command);
    run_in_folder("rm a.exr a.exr.state");
    assert_int_equal(files_count(), 1);
}

/* Spoils the place of the picture while the program works, and returns what that said. */
static struct run spoil(const char *out, const char *command)
{
    struct run run;
    double delay_s = 0.15;
    do {
        char arguments[128];
        int status;
        snprintf(arguments, sizeof arguments, "reference tiny.gltf --size 64x64 --time %.2f --out %s",
                 3 * delay_s, out);
        run_in_folder("mkdir -p gone");
        const pid_t child = start(arguments);
        sleep_s(delay_s);
        run_in_folder(command);
        waitpid(child, &status, 0);
        run.code = WEXITSTATUS(status);
        files_take_text("err.txt", run.err, sizeof run.err);
        delay_s *= 2;
    } while (!strstr(run.err, "samples per pixel") && delay_s < longest_delay_s);
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.err, "not all pictures could be written; --resume goes on from"));
    remove(files_path("out.txt"));
    return run;
}

static void samples_outlive_a_picture_that_cannot_be_written(void **state)
{
    (void)state;
    setenv("TMPDIR", files_path(""), 1);
    struct run run = spoil("a.exr", "rmdir gone && mkdir a.exr");
    assert_non_null(strstr(run.err, "goes on from a.exr.state\n"));
    run_in_folder("rmdir a.exr && rm a.exr.state");
    run = spoil("gone/a.exr", "rm -r gone");
    assert_non_null(strstr(run.err, ".state once it is moved to gone/a.exr.state\n"));
    run_in_folder("rm sdfgi.*.state");
    assert_int_equal(files_count(), 1);
}

#endif

/* What a test that failed has left is no fault of the next one. */
static int remove_outputs(void **state)
{
    (void)state;
    run_in_folder("find . -mindepth 1 -maxdepth 1 ! -name tiny.gltf ! -name .cache -exec rm -r {} +");
    return 0;
}

static int make_scene(void **state)
{
    if (files_setup(state))
        return 1;
    files_write_triangle("tiny.gltf");
    setenv("XDG_CACHE_HOME", files_path(".cache"), 1);
    setenv("MESA_SHADER_CACHE_DIR", files_path(".cache"), 1);
    return 0;
}

static int remove_files(void **state)
{
    run_in_folder("rm -rf .cache");
    return files_teardown(state);
}

int main(int argc, char **argv)
{
    if (argc < 2)
        return EXIT_FAILURE;
    program = argv[1]; /* an absolute path */
    signal(SIGINT, SIG_DFL);
#define STOP(name) cmocka_unit_test_teardown(name, remove_outputs)
    const struct CMUnitTest tests[] = {
        STOP(a_run_without_results_ends_at_once),
        STOP(a_picture_shows_the_light_that_there_was),
        STOP(a_walk_keeps_its_frames),
#ifdef SDFGI_WITH_RAYCAST
        STOP(a_reference_keeps_picture_and_samples),
        STOP(samples_outlive_a_picture_that_cannot_be_written),
#endif
    };
#undef STOP
    return cmocka_run_group_tests(tests, make_scene, remove_files);
}
