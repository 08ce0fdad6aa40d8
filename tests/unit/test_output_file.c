/* SPDX-License-Identifier: MIT
 * Files that appear whole or not at all: what lies beside them meanwhile, and who may touch it. */
#include "files.h"
#include "unit.h"

#include "file/output_file.h"
#include "file/output_names.h"
#include "file/stop.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char error[300];

/* Begins an output, whose path is copied: `files_path` has one for all. */
static void begin(struct output_file *file, char path[static 256], const char *name)
{
    snprintf(path, 256, "%s", files_path(name));
    if (!output_file_begin(file, path, error, sizeof error))
        fail_msg("%s", error);
}

static void write_output(const char *name, const char *text)
{
    char path[256];
    struct output_file file;
    begin(&file, path, name);
    fputs(text, file.stream);
    assert_true(output_file_commit(&file, error, sizeof error));
}

static void assert_text(const char *name, const char *expected)
{
    char text[64];
    files_take_text(name, text, sizeof text);
    assert_string_equal(text, expected);
}

static void make_link(const char *target, const char *name)
{
    assert_int_equal(symlink(target, files_path(name)), 0);
}

static void links_under_temporary_names_are_not_followed(void **state)
{
    (void)state;
    char name[64];
    snprintf(name, sizeof name, "a.txt.%ld.partial", (long)getpid());
    files_write_text("victim", "precious");
    make_link("victim", name);
    write_output("a.txt", "text");
    assert_text("a.txt", "text");
    assert_text("victim", "precious");
    unlink(files_path(name));
    assert_int_equal(files_count(), 0);
}

static void temporary_names_cannot_be_foretold(void **state)
{
    (void)state;
    char path[256];
    struct output_file a, b;
    begin(&a, path, "a.txt");
    begin(&b, path, "a.txt");
    assert_string_not_equal(a.temporary_path, b.temporary_path);
    output_file_cancel(&a);
    output_file_cancel(&b);
    assert_int_equal(files_count(), 0);
}

static void outputs_have_the_permissions_that_the_user_gives_files(void **state)
{
    (void)state;
    struct stat status;
    const mode_t before = umask(027);
    write_output("a.txt", "text");
    umask(before);
    assert_int_equal(stat(files_path("a.txt"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
    assert_text("a.txt", "text");
}

static void leave(const char *output, long process, char name[64])
{
    snprintf(name, 64, "%s.%ld.0123456789abcdef.partial", output, process);
    files_write_text(name, "half");
}

static void what_killed_runs_left_is_removed(void **state)
{
    (void)state;
    char dead[64], dead_state[64], living[64], other[64];
    const pid_t child = fork();
    if (child == 0)
        _exit(0);
    waitpid(child, NULL, 0);
    leave("a.exr", child, dead);
    leave("a.exr.state", child, dead_state);
    leave("a.exr", getppid(), living);
    leave("b.exr", child, other);
    assert_true(output_file_check(files_path("a.exr"), error, sizeof error));
    assert_int_not_equal(access(files_path(dead), F_OK), 0);
    assert_int_not_equal(access(files_path(dead_state), F_OK), 0);
    assert_text(living, "half");
    assert_text(other, "half");
    assert_int_equal(files_count(), 0);
}

static void what_is_being_written_can_be_abandoned(void **state)
{
    (void)state;
    char path[256];
    struct output_file file;
    begin(&file, path, "a.txt");
    assert_int_equal(files_count(), 1);
    output_file_abandon();
    assert_int_equal(files_count(), 0);
    output_file_cancel(&file);
    write_output("a.txt", "text");
    output_file_abandon();
    assert_text("a.txt", "text");
}

/* A folder of the name has appeared meanwhile. */
static void what_cannot_have_its_name_is_an_error_and_leaves_nothing(void **state)
{
    (void)state;
    char path[256];
    struct output_file file;
    begin(&file, path, "a.txt");
    fputs("text", file.stream);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_false(output_file_commit(&file, error, sizeof error));
    assert_non_null(strstr(error, path));
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(files_count(), 0);
}

/* Writes, and is sent signals meanwhile, the first of which may ask for an end alone. */
static void write_under_signals(const char *path, bool keep)
{
    struct output_file file;
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    stop_watch();
    if (keep)
        stop_keep();
    if (!output_file_begin(&file, path, error, sizeof error))
        _exit(1);
    raise(SIGINT);
    if (!stop_asked())
        _exit(2);
    raise(SIGTERM);
    _exit(3);
}

static void signals_that_end_a_program_remove_what_it_writes(void **state)
{
    (void)state;
    char path[256];
    snprintf(path, sizeof path, "%s", files_path("a.txt"));
    for (int keep = 0; keep < 2; keep++) {
        int status;
        const pid_t child = fork();
        if (child == 0)
            write_under_signals(path, keep);
        waitpid(child, &status, 0);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 128 + (keep ? SIGTERM : SIGINT));
        assert_int_equal(files_count(), 0);
    }
}

static void two_names_of_one_file_are_refused(void **state)
{
    (void)state;
    char one[256], two[256];
    snprintf(one, sizeof one, "%s/a.exr", files_path(""));
    static const char *const spellings[] = { "a.exr", "./a.exr", "here/a.exr", "link.exr" };
    make_link(".", "here");
    make_link("a.exr", "link.exr");
    files_write_text("a.exr", "");
    for (int i = 0; i < 4; i++) {
        snprintf(two, sizeof two, "%s/%s", files_path(""), spellings[i]);
        const struct output_name names[] = { { one, "--out", NULL },
                                             { NULL, "--report", NULL },
                                             { two, "--aov", "normal=a.exr" } };
        if (i == 3)
            files_write_text("a.exr", "");
        else
            unlink(files_path("a.exr"));
        assert_false(output_names_check(names, 3, error, sizeof error));
        assert_non_null(strstr(error, "--out and --aov normal=a.exr"));
    }
    snprintf(two, sizeof two, "%s/b.exr", files_path(""));
    const struct output_name names[] = { { one, "--out", NULL }, { two, "--aov", "normal=b.exr" } };
    assert_true(output_names_check(names, 2, error, sizeof error));
    unlink(files_path("a.exr"));
    unlink(files_path("here"));
    unlink(files_path("link.exr"));
    assert_int_equal(files_count(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(links_under_temporary_names_are_not_followed),
        cmocka_unit_test(temporary_names_cannot_be_foretold),
        cmocka_unit_test(outputs_have_the_permissions_that_the_user_gives_files),
        cmocka_unit_test(what_killed_runs_left_is_removed),
        cmocka_unit_test(what_is_being_written_can_be_abandoned),
        cmocka_unit_test(what_cannot_have_its_name_is_an_error_and_leaves_nothing),
        cmocka_unit_test(signals_that_end_a_program_remove_what_it_writes),
        cmocka_unit_test(two_names_of_one_file_are_refused),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
