/* SPDX-License-Identifier: MIT
 * A program of libFuzzer's for the target that FUZZ_TARGET names. A promise that is broken ends the program,
 * which libFuzzer counts as a crash. */
#include "fuzz.h"

#include "files.h"
#include "require.h"

#include <stdlib.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t capacity, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t capacity);

static void remove_folder(void)
{
    files_teardown(NULL);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    if (files_setup(NULL) != 0)
        abort();
    atexit(remove_folder);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run(&FUZZ_TARGET, data, size);
    return 0;
}

/* Every fourth change is to bytes alone, as is every one where the target knows nothing better; every fourth
 * result keeps the lengths and checksums that it has. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t capacity, unsigned seed)
{
    struct test_random random = { seed };
    const struct fuzz_target *const target = &FUZZ_TARGET;
    size_t changed = 0;
    if (target->mutate && test_random_uint(&random) % 4 != 0)
        changed = target->mutate(data, size, capacity, &random);
    if (changed == 0)
        changed = LLVMFuzzerMutate(data, size, capacity);
    if (target->mend && test_random_uint(&random) % 4 != 0)
        target->mend(data, changed);
    return changed;
}
