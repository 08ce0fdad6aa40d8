/* SPDX-License-Identifier: MIT
 * Every seed of every fuzz target, without libFuzzer: readers take what is valid, refuse what is broken, and
 * are done with either in a second. What fuzzing has found stays among the seeds. Usage: test_seeds FOLDER */
#include "fuzz.h"

#include "files.h"
#include "require.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SEED_BYTES_MAX = 1 << 16 };

static const char *seeds;

static size_t load(const char *path, uint8_t data[static SEED_BYTES_MAX])
{
    FILE *const file = fopen(path, "rb");
    REQUIRE_TRUE(file != NULL);
    const size_t size = fread(data, 1, SEED_BYTES_MAX, file);
    REQUIRE_TRUE(fgetc(file) == EOF);
    fclose(file);
    return size;
}

/* Leaves large numbers in memory that comes to be used again, for readers that forget to set theirs: in all
 * holes of up to 64 KiB. */
static void spoil_memory(void)
{
    enum { BLOCKS = 64, STEP = 1024 };
    volatile uint32_t *blocks[BLOCKS];
    for (size_t i = 0; i < BLOCKS; i++) {
        const size_t words = (i + 1) * STEP / sizeof **blocks;
        blocks[i] = test_array_alloc(words, sizeof **blocks);
        for (size_t k = 0; k < words; k++)
            blocks[i][k] = INT32_MAX;
    }
    for (size_t i = 0; i < BLOCKS; i++)
        free((void *)blocks[i]);
}

static void run_seed(const struct fuzz_target *target, const char *folder, const char *name)
{
    static uint8_t data[SEED_BYTES_MAX];
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const size_t size = load(path, data);
    if (strstr(name, "_mended"))
        target->mend(data, size);
    spoil_memory();
    const clock_t start = clock();
    const bool is_read = fuzz_run(target, data, size);
    const double took_s = (double)(clock() - start) / CLOCKS_PER_SEC;
    if (took_s > 1)
        require_fail(__FILE__, __LINE__, "%s took %.1f s of processor time", path, took_s);
    if (is_read ? strncmp(name, "broken_", 7) == 0 : strncmp(name, "valid_", 6) == 0)
        require_fail(__FILE__, __LINE__, "%s was %s", path, is_read ? "read" : "refused");
}

static void run_seeds(const struct fuzz_target *target, const char *name)
{
    char folder[512];
    int count = 0;
    snprintf(folder, sizeof folder, "%s/%s", seeds, name);
    DIR *const entries = opendir(folder);
    REQUIRE_TRUE(entries != NULL);
    for (const struct dirent *entry; (entry = readdir(entries));)
        if (entry->d_name[0] != '.') {
            run_seed(target, folder, entry->d_name);
            count++;
        }
    closedir(entries);
    REQUIRE_CMP(count, >, 0);
}

#define FUZZ_TEST(name)                                                                                      \
    static void seeds_of_##name##_end_well(void **state)                                                     \
    {                                                                                                        \
        (void)state;                                                                                         \
        run_seeds(&fuzz_##name, #name);                                                                      \
    }
FUZZ_TARGETS(FUZZ_TEST)

int main(int argc, char **argv)
{
    if (argc != 2)
        return EXIT_FAILURE;
    seeds = argv[1];
#define FUZZ_CASE(name) cmocka_unit_test(seeds_of_##name##_end_well),
    const struct CMUnitTest tests[] = { FUZZ_TARGETS(FUZZ_CASE) };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
