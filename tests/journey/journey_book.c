/* SPDX-License-Identifier: MIT */
#include "journey_book.h"

#include "require.h"
#include "test_memory.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINE_SIZE = 2048 };

static struct {
    const char *path;
    bool records;
    char *text; /* of the whole file */
    size_t size, room;
} book;

/* ---- Hashes ---- */

/* FNV-1a with words of eight bytes for bytes. The shift brings high bits down, which a product never does. */
static uint64_t hash_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 32;
}

static uint32_t hash_bytes(const void *data, size_t size)
{
    uint64_t hash = hash_word(UINT64_C(0xcbf29ce484222325), size), word;
    for (size_t i = 0; i + 8 <= size; i += 8) {
        memcpy(&word, (const char *)data + i, 8);
        hash = hash_word(hash, word);
    }
    word = 0;
    memcpy(&word, (const char *)data + size / 8 * 8, size % 8);
    hash = hash_word(hash, word);
    return (uint32_t)(hash ^ hash >> 32);
}

void journey_row_add(struct journey_row *row, const char *name, const void *data, size_t size)
{
    REQUIRE_CMP(row->count, <, JOURNEY_MAX_COLUMNS);
    struct journey_column *column = &row->columns[row->count++];
    snprintf(column->name, sizeof column->name, "%s", name);
    column->hash = hash_bytes(data, size);
}

/* ---- The file ---- */

static void append(const char *line)
{
    const size_t length = strlen(line);
    if (book.size + length + 1 > book.room) {
        book.room = 2 * (book.size + length + 1);
        book.text = test_array_resize(book.text, book.room, 1);
    }
    memcpy(book.text + book.size, line, length + 1);
    book.size += length;
}

static bool load(void)
{
    FILE *file = fopen(book.path, "r");
    char line[LINE_SIZE];
    if (!file)
        return false;
    while (fgets(line, sizeof line, file))
        append(line);
    fclose(file);
    return book.size > 0;
}

bool journey_book_open(const char *path, const char *device)
{
    const char *record = getenv("SDFGI_TEST_RECORD");
    book.path = path;
    book.records = record && strcmp(record, "0") != 0;
    if (book.records) {
        append(device);
        append("\n");
        return true;
    }
    const size_t length = strlen(device);
    const bool found = load();
    if (found && strncmp(book.text, device, length) == 0 && book.text[length] == '\n')
        return true;
    fprintf(stderr,
            "skipped: %s holds hashes of '%.*s', and this is '%s'; "
            "to record those of this device, run the program with SDFGI_TEST_RECORD=1 at a commit known to "
            "be right\n",
            path, found ? (int)strcspn(book.text, "\n") : 7, found ? book.text : "nothing", device);
    return false;
}

bool journey_book_close(bool complete)
{
    bool done = true;
    FILE *file = book.records && complete ? fopen(book.path, "w") : NULL;
    if (book.records && complete)
        done = file && fwrite(book.text, 1, book.size, file) == book.size;
    if (file)
        done = fclose(file) == 0 && done;
    free(book.text);
    return done;
}

/* ---- Rows ---- */

static void record(const struct journey_row *row)
{
    char text[LINE_SIZE];
    snprintf(text, sizeof text, "%s %" PRIu32, row->journey, row->frame);
    append(text);
    for (uint32_t i = 0; i < row->count; i++) {
        snprintf(text, sizeof text, " %s=%08" PRIx32, row->columns[i].name, row->columns[i].hash);
        append(text);
    }
    append("\n");
}

/* The columns of a frame as recorded; NULL if there are none. */
static const char *find_line(const struct journey_row *row)
{
    char start[LINE_SIZE];
    const int length = snprintf(start, sizeof start, "\n%s %" PRIu32 " ", row->journey, row->frame);
    const char *line = strstr(book.text, start);
    return line ? line + length : NULL;
}

static bool parse_line(const char *line, struct journey_row *row)
{
    int length;
    *row = (struct journey_row){ 0 };
    for (; row->count < JOURNEY_MAX_COLUMNS; line += length) {
        struct journey_column *column = &row->columns[row->count];
        if (sscanf(line, "%23[^= \n]=%8" SCNx32 "%n", column->name, &column->hash, &length) != 2)
            return false;
        row->count++;
        if (line[length] != ' ')
            return line[length] == '\n';
        length++;
    }
    return false;
}

static const struct journey_column *find_column(const struct journey_row *row, const char *name)
{
    for (uint32_t i = 0; i < row->count; i++)
        if (strcmp(row->columns[i].name, name) == 0)
            return &row->columns[i];
    return NULL;
}

/* Appends what is amiss with the columns of `have`; of those that `want` has too, their hashes. */
static void compare(const struct journey_row *have, const struct journey_row *want, const char *missing,
                    bool hashes, char *text)
{
    for (uint32_t i = 0; i < have->count; i++) {
        const struct journey_column *a = &have->columns[i], *b = find_column(want, a->name);
        char *end = text + strlen(text);
        const size_t room = LINE_SIZE - strlen(text);
        if (!b)
            snprintf(end, room, " %s (%s)", a->name, missing);
        else if (hashes && a->hash != b->hash)
            snprintf(end, room, " %s", a->name);
    }
}

void journey_book_take(const struct journey_row *row)
{
    if (book.records) {
        record(row);
        return;
    }
    struct journey_row recorded;
    char text[LINE_SIZE] = "";
    const char *line = find_line(row);
    if (!line || !parse_line(line, &recorded))
        require_fail(__FILE__, __LINE__, "%s has no line for journey %s, frame %" PRIu32, book.path,
                     row->journey, row->frame);
    compare(row, &recorded, "not in the file", true, text);
    compare(&recorded, row, "only in the file", false, text);
    if (text[0])
        require_fail(__FILE__, __LINE__, "journey %s, frame %" PRIu32 ": not as recorded:%s", row->journey,
                     row->frame, text);
}
