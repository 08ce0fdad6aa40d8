/* SPDX-License-Identifier: MIT
 * What reads bytes that others have made, one row per reader. libFuzzer feeds a row in a program of its own
 * (fuzz_main.c), and the default tests feed all rows with the seeds (test_seeds.c). */
#ifndef TESTS_FUZZ_H
#define TESTS_FUZZ_H

#include "test_memory.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Every file that is read has this name and the ending of its row: messages must show it. */
#define FUZZ_STEM "fuzzed"

struct fuzz_target {
    const char *ending;
    /* Reads the file at `path`, and checks all that its reader promises, with cmocka. False where the reader
     * refused it, with the reader's line in `error`. */
    bool (*read)(const char *path, char *error, size_t error_size);
    /* Changes what the format calls an element: `size` of `capacity` bytes. Returns the new size, or 0 where
     * the bytes are no such file. NULL: nothing is known of the format. */
    size_t (*mutate)(uint8_t *data, size_t size, size_t capacity, struct test_random *random);
    /* Puts right what covers other bytes: lengths and checksums. May be NULL. */
    void (*mend)(uint8_t *data, size_t size);
};

/* Writes the file, has it read, and checks the message if it was refused. True where it was not. */
bool fuzz_run(const struct fuzz_target *target, const uint8_t *data, size_t size);

uint32_t fuzz_big_endian(const uint8_t *bytes);
void fuzz_big_endian_put(uint8_t *bytes, uint32_t value);

/* The `mutate` of formats that are JSON, or have it inside. */
size_t fuzz_json_mutate(uint8_t *data, size_t size, size_t capacity, struct test_random *random);
/* Those of glTF and GLB. */
size_t fuzz_glb_mutate(uint8_t *data, size_t size, size_t capacity, struct test_random *random);
void fuzz_glb_mend(uint8_t *data, size_t size);

#define FUZZ_DECLARE(name) extern const struct fuzz_target fuzz_##name;
FUZZ_TARGETS(FUZZ_DECLARE) /* meson.build has the list */
#undef FUZZ_DECLARE

#endif
