/* SPDX-License-Identifier: MIT
 * The file of recorded hashes. Its first line names the device that they hold for; then comes a line for each
 * frame of each journey. SDFGI_TEST_RECORD=1: the file is written anew instead of compared with. */
#ifndef TEST_JOURNEY_BOOK_H
#define TEST_JOURNEY_BOOK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { JOURNEY_MAX_COLUMNS = 40, JOURNEY_NAME_SIZE = 24 };

struct journey_column {
    char name[JOURNEY_NAME_SIZE];
    uint32_t hash;
};

struct journey_row {
    const char *journey;
    uint32_t frame, count;
    struct journey_column columns[JOURNEY_MAX_COLUMNS];
};

/* Adds a column with the hash of `size` bytes. */
void journey_row_add(struct journey_row *row, const char *name, const void *data, size_t size);

/* False, and a line on stderr, where the file's hashes are those of another device. */
bool journey_book_open(const char *path, const char *device);

/* Records a row, or fails the test with the names of all columns that are not as recorded. */
void journey_book_take(const struct journey_row *row);

/* Writes what was recorded, if `complete`; false if it could not. */
bool journey_book_close(bool complete);

#endif
