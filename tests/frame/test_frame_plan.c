/* SPDX-License-Identifier: MIT
 * What frames do in each situation, as recorded in plans.txt. Where a plan is meant to change, record anew:
 * SDFGI_TEST_RECORD=1, read the difference against docs/frame.md, and say why in the commit. */
#include "plan_book.h"
#include "require.h"
#include "situations.h"

static const struct situation_table *const tables[] = { &situations_start, &situations_scroll,
                                                        &situations_edit, &situations_light,
                                                        &situations_settings };

enum { TABLES = sizeof tables / sizeof *tables, MOST_TESTS = 128 };

static struct show show;

static void is_as_recorded(void **state)
{
    const struct situation_row *row = *state;
    row->fn(&show);
    plan_book_take(row->name, show.text.at);
}

static int clean_up(void **state)
{
    (void)state;
    drive_end(&show.d);
    text_free(&show.text);
    return 0;
}

static void the_file_holds_nothing_else(void **state)
{
    (void)state;
    unsigned count = 0;
    for (int i = 0; i < TABLES; i++)
        count += tables[i]->count;
    REQUIRE_CMP(plan_book_count(), ==, count);
}

static size_t add_tests(struct CMUnitTest *tests)
{
    size_t count = 0;
    for (int i = 0; i < TABLES; i++)
        for (uint32_t k = 0; k < tables[i]->count; k++) {
            assert_true(count < MOST_TESTS);
            tests[count++] = (struct CMUnitTest){ .name = tables[i]->rows[k].name,
                                                  .test_func = is_as_recorded,
                                                  .teardown_func = clean_up,
                                                  .initial_state = (void *)&tables[i]->rows[k] };
        }
    return count;
}

int main(int argc, char **argv)
{
    struct CMUnitTest tests[MOST_TESTS + 1] = { 0 };
    if (argc != 2 || !plan_book_open(argv[1]))
        return 1;
    const size_t count = add_tests(tests);
    tests[count] = (struct CMUnitTest)cmocka_unit_test(the_file_holds_nothing_else);
    const int failed = _cmocka_run_group_tests("plans", tests, count + 1, NULL, NULL);
    return !plan_book_close(failed == 0) || failed;
}
