/* SPDX-License-Identifier: MIT
 * docs/debug_views.md has the debug views of the library, in its order and its words. */
#include "unit.h"

#include <sdfgi/debug.h>
#include <stdio.h>
#include <string.h>

enum { LINE_BYTES = 512 };

/* The next row of a table whose first column is a name; false at the end of the file. */
static bool next_row(FILE *file, char line[LINE_BYTES])
{
    while (fgets(line, LINE_BYTES, file))
        if (strncmp(line, "| `", 3) == 0)
            return true;
    return false;
}

static void the_document_has_every_view(void **state)
{
    (void)state;
    char line[LINE_BYTES], wanted[LINE_BYTES];
    FILE *file = fopen(SOURCE_ROOT "/docs/debug_views.md", "rb");
    assert_non_null(file);
    for (int i = 0; i < SDFGI_DEBUG_VIEW_COUNT; i++) {
        const enum sdfgi_debug_view view = (enum sdfgi_debug_view)i;
        snprintf(wanted, sizeof wanted, "| `%s` | %s |\n", sdfgi_debug_view_name(view),
                 sdfgi_debug_view_text(view));
        assert_true(next_row(file, line));
        assert_string_equal(line, wanted);
    }
    assert_false(next_row(file, line));
    fclose(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(the_document_has_every_view) };
    return cmocka_run_group_tests_name("debug_names", tests, NULL, NULL);
}
