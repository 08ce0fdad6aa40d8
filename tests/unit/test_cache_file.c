/* SPDX-License-Identifier: MIT
 * Files that may be lost: whatever happens to one, what is loaded is what was saved, or nothing. */
#include "files.h"
#include "unit.h"

#include "file/cache_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BYTES = 100, FILE_BYTES = 24 + BYTES };

static char saved[BYTES];

static void save(void)
{
    for (int i = 0; i < BYTES; i++)
        saved[i] = (char)(7 * i);
    assert_true(cache_file_save(files_path("cache"), saved, sizeof saved));
}

static void assert_absent(void)
{
    size_t size = 77;
    assert_null(cache_file_load(files_path("cache"), &size));
    assert_int_equal(size, 77);
}

/* The file's own bytes. */
static void read_file(char bytes[static FILE_BYTES])
{
    FILE *const file = fopen(files_path("cache"), "rb");
    assert_non_null(file);
    assert_int_equal(fread(bytes, 1, FILE_BYTES, file), FILE_BYTES);
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
}

static void what_was_saved_is_loaded(void **state)
{
    (void)state;
    size_t size = 0;
    save();
    char *const data = cache_file_load(files_path("cache"), &size);
    assert_non_null(data);
    assert_int_equal(size, sizeof saved);
    assert_memory_equal(data, saved, sizeof saved);
    free(data);
    assert_int_equal(files_count(), 1);
}

static void one_wrong_byte_anywhere_and_the_file_counts_as_absent(void **state)
{
    (void)state;
    char bytes[FILE_BYTES];
    save();
    read_file(bytes);
    for (int i = 0; i < FILE_BYTES; i++) {
        bytes[i] ^= 1;
        files_write("cache", bytes, sizeof bytes);
        assert_absent();
        bytes[i] ^= 1;
    }
}

static void a_file_of_another_length_counts_as_absent(void **state)
{
    (void)state;
    char bytes[FILE_BYTES + 1] = { 0 };
    save();
    read_file(bytes);
    for (size_t size = 0; size < FILE_BYTES; size++) {
        files_write("cache", bytes, size);
        assert_absent();
    }
    files_write("cache", bytes, FILE_BYTES + 1);
    assert_absent();
}

static void a_missing_file_and_a_folder_count_as_absent(void **state)
{
    (void)state;
    unlink(files_path("cache"));
    assert_absent();
    assert_int_equal(mkdir(files_path("cache"), 0700), 0);
    assert_absent();
    assert_false(cache_file_save(files_path("cache"), saved, sizeof saved));
    assert_int_equal(rmdir(files_path("cache")), 0);
    assert_int_equal(files_count(), 0);
}

static void missing_folders_are_made(void **state)
{
    (void)state;
    char path[512];
    size_t size;
    snprintf(path, sizeof path, "%s/a/b/cache", files_path(""));
    assert_true(cache_file_save(path, saved, sizeof saved));
    free(cache_file_load(path, &size));
    assert_int_equal(size, sizeof saved);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(files_path("a/b")), 0);
    assert_int_equal(rmdir(files_path("a")), 0);
}

static void a_folder_that_cannot_be_made_is_no_harm(void **state)
{
    (void)state;
    char path[512];
    files_write_text("a", "a file where a folder should be");
    snprintf(path, sizeof path, "%s/a/b/cache", files_path(""));
    assert_false(cache_file_save(path, saved, sizeof saved));
    assert_int_equal(files_count(), 1);
    unlink(files_path("a"));
}

static void the_folder_follows_the_environment(void **state)
{
    (void)state;
    char path[64];
    setenv("HOME", "/home/x", 1);
    setenv("XDG_CACHE_HOME", "/caches", 1);
    assert_true(cache_folder(path, sizeof path));
    assert_string_equal(path, "/caches/sdfgi");
    setenv("XDG_CACHE_HOME", "caches", 1); /* the specification wants it ignored */
    assert_true(cache_folder(path, sizeof path));
    assert_string_equal(path, "/home/x/.cache/sdfgi");
    unsetenv("XDG_CACHE_HOME");
    assert_true(cache_folder(path, sizeof path));
    assert_string_equal(path, "/home/x/.cache/sdfgi");
    assert_false(cache_folder(path, 8));
    unsetenv("HOME");
    assert_false(cache_folder(path, sizeof path));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_saved_is_loaded),
        cmocka_unit_test(one_wrong_byte_anywhere_and_the_file_counts_as_absent),
        cmocka_unit_test(a_file_of_another_length_counts_as_absent),
        cmocka_unit_test(a_missing_file_and_a_folder_count_as_absent),
        cmocka_unit_test(missing_folders_are_made),
        cmocka_unit_test(a_folder_that_cannot_be_made_is_no_harm),
        cmocka_unit_test(the_folder_follows_the_environment),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
