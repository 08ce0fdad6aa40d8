/* SPDX-License-Identifier: MIT */
#include "plan_book.h"

#include "plan_text.h"
#include "require.h"

#include <stdio.h>
#include <stdlib.h>

static struct {
    const char *path;
    bool records;
    struct text text; /* of the whole file */
} book;

static bool load(void)
{
    FILE *file = fopen(book.path, "r");
    char line[512];
    if (!file)
        return false;
    while (fgets(line, sizeof line, file))
        text_append(&book.text, line, strlen(line));
    fclose(file);
    return book.text.size > 0;
}

bool plan_book_open(const char *path)
{
    const char *record = getenv("SDFGI_TEST_RECORD");
    book.path = path;
    book.records = record && strcmp(record, "0") != 0;
    text_append(&book.text, "", 0);
    if (book.records || load())
        return true;
    fprintf(stderr, "%s is missing or empty; to record it, run the program with SDFGI_TEST_RECORD=1\n", path);
    return false;
}

bool plan_book_close(bool complete)
{
    bool done = true;
    FILE *file = book.records && complete ? fopen(book.path, "w") : NULL;
    if (book.records && complete)
        done = file && fwrite(book.text.at, 1, book.text.size, file) == book.text.size;
    if (file)
        done = fclose(file) == 0 && done;
    text_free(&book.text);
    return done;
}

/* The frames below a heading; NULL if there is none. */
static const char *find(const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = book.text.at; (at = strstr(at, "== ")) != NULL; at++)
        if ((at == book.text.at || at[-1] == '\n') && strncmp(at + 3, name, length) == 0 &&
            at[3 + length] == '\n')
            return at + 4 + length;
    return NULL;
}

unsigned plan_book_count(void)
{
    unsigned count = strncmp(book.text.at, "== ", 3) == 0;
    for (const char *at = book.text.at; (at = strstr(at, "\n== ")) != NULL; at++)
        count++;
    return count;
}

static int line_length(const char *line)
{
    return (int)strcspn(line, "\n");
}

/* True where the file goes on with another heading, or ends. */
static bool ends(const char *recorded)
{
    return *recorded == 0 || strncmp(recorded, "== ", 3) == 0;
}

static void compare(const char *name, const char *text, const char *recorded)
{
    int line = 1;
    while (*text && !ends(recorded)) {
        const int length = line_length(text), other = line_length(recorded);
        if (length != other || strncmp(text, recorded, (size_t)length) != 0)
            break;
        text += length + 1;
        recorded += other + 1;
        line++;
    }
    if (*text == 0 && ends(recorded))
        return;
    require_fail(__FILE__, __LINE__, "%s, line %d:\n  planned:  %.*s\n  recorded: %.*s", name, line,
                 line_length(text), text, ends(recorded) ? 0 : line_length(recorded), recorded);
}

void plan_book_take(const char *name, const char *text)
{
    if (book.records) {
        text_add(&book.text, "== %s\n", name);
        text_append(&book.text, text, strlen(text));
        return;
    }
    const char *recorded = find(name);
    if (!recorded)
        require_fail(__FILE__, __LINE__, "%s has no situation %s", book.path, name);
    else
        compare(name, text, recorded);
}
