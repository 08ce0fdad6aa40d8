/* SPDX-License-Identifier: MIT */
#include "hard_case.h"
#include "require.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* One write per line: programs that run at the same time append to the same file. */
static void record(const char *file, const char *test, int row, const char *what, double measured, int sense,
                   double limit)
{
    const char *records = getenv("SDFGI_TEST_HARD_CASES");
    if (records == NULL)
        return;
    char line[512];
    const char *suite = getenv("SDFGI_TEST_FULL") != NULL ? "full" : "default";
    const int size = snprintf(line, sizeof line, "%d\t%s\t%s\t%s\t%s\t%.9g\t%s\t%.9g\n", row, suite, file,
                              test, what, measured, sense < 0 ? "at most" : "at least", limit);
    REQUIRE_CMP(size, <, (int)sizeof line);
    const int out = open(records, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    REQUIRE_CMP(out, >=, 0);
    const ssize_t written = write(out, line, (size_t)size);
    close(out);
    REQUIRE_CMP(written, ==, (ssize_t)size);
}

void hard_case_check(const char *file, int line, const char *test, int row, const char *what, double measured,
                     int sense, double limit)
{
    record(file, test, row, what, measured, sense, limit);
    const bool kept = sense < 0 ? measured <= limit : measured >= limit;
    if (!kept)
        require_fail(file, line, "hard case %d, %s: %.9g, allowed %s %.9g", row, what, measured,
                     sense < 0 ? "at most" : "at least", limit);
}
