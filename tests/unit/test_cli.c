/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include "cli/cli.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct values {
    const char *scene, *out;
    bool flag, gi, spp_given;
    uint32_t spp;
    uint64_t big;
    double exposure;
    struct cli_size size;
    struct cli_list set;
};

/* Parses words separated by spaces with one table that has every type. */
static enum cli_outcome parse(struct values *v, const char *words)
{
    static char text[2048];
    char *argv[200];
    int argc = 0;
    *v = (struct values){ .spp = 64, .gi = true, .exposure = 1 };
    snprintf(text, sizeof text, "test %s", words);
    for (char *word = strtok(text, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    const struct cli_option options[] = {
        { "flag", CLI_FLAG, &v->flag, .help = "a flag" },
        { "gi", CLI_SWITCH, &v->gi, .help = "a switch" },
        { "out", CLI_TEXT, &v->out, "FILE", .help = "a text", .required = true },
        { "spp", CLI_UINT, &v->spp, "N", .help = "a number", .minimum = 1, .maximum = 1000,
          .given = &v->spp_given },
        { "big", CLI_UINT64, &v->big, "N", .help = "a big number" },
        { "exposure", CLI_FLOAT, &v->exposure, "X", .help = "a float", .minimum = -10, .maximum = 10 },
        { "size", CLI_SIZE, &v->size, "WxH", .help = "a size", .minimum = 1, .maximum = 16384 },
        { "set", CLI_LIST, &v->set, "K=V", .help = "a list" },
    };
    const struct cli_positional positionals[] = { { "SCENE", &v->scene, true } };
    const struct cli_spec spec = { "test", "A test.", CLI_ARRAY(options), CLI_ARRAY(positionals), "Notes." };
    return cli_parse(&spec, argc, argv);
}

/* Standard error is caught in a file, so that its lines can be counted. */
static enum cli_outcome parse_and_catch(const char *words, char *caught, size_t size)
{
    struct values v;
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stderr);
    const int saved = dup(STDERR_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    const enum cli_outcome outcome = parse(&v, words);
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    rewind(file);
    const size_t length = fread(caught, 1, size - 1, file);
    caught[length] = '\0';
    fclose(file);
    return outcome;
}

static void every_type_is_read(void **state)
{
    (void)state;
    struct values v;
    assert_int_equal(parse(&v, "--flag --gi off --out=a.png s.glb --spp 12 --big 5000000000 --exposure -2.5 "
                               "--size 320x180 --set a=1 --set b=2"),
                     CLI_RUN);
    assert_string_equal(v.scene, "s.glb");
    assert_string_equal(v.out, "a.png");
    assert_true(v.flag && !v.gi && v.spp_given);
    assert_int_equal(v.spp, 12);
    assert_true(v.big == 5000000000u);
    assert_true(v.exposure == -2.5);
    assert_int_equal(v.size.width, 320);
    assert_int_equal(v.size.height, 180);
    assert_int_equal(v.set.count, 2);
    assert_string_equal(v.set.values[1], "b=2");
}

static void what_is_not_given_keeps_its_default(void **state)
{
    (void)state;
    struct values v;
    assert_int_equal(parse(&v, "s.glb --out a"), CLI_RUN);
    assert_int_equal(v.spp, 64);
    assert_true(v.gi && !v.flag && !v.spp_given);
}

static void wrong_arguments_give_one_line_that_names_them(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "s --out a --spp 0", "--spp" },
        { "s --out a --spp 1001", "--spp" },
        { "s --out a --spp 1.5", "--spp" },
        { "s --out a --spp 5x", "--spp" },
        { "s --out a --exposure nan", "nan" },
        { "s --out a --exposure 11", "11" },
        { "s --out a --size 320", "--size" },
        { "s --out a --size 0x5", "0x5" },
        { "s --out a --size 5x5x5", "5x5x5" },
        { "s --out a --gi maybe", "maybe" },
        { "s --out a --unknown", "--unknown" },
        { "s --out a extra", "extra" },
        { "s --out", "--out" },
        { "s", "--out" },
        { "--out a", "SCENE" },
        { "s --out a --flag=1", "--flag" },
        { "s --out=", "--out" },
        { "s --out a --big -1", "--big" },
        { "s --out a --big 1e300", "--big" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[1024];
        assert_int_equal(parse_and_catch(cases[i][0], text, sizeof text), CLI_WRONG);
        assert_non_null(strstr(text, cases[i][1]));
        assert_ptr_equal(strchr(text, '\n'), text + strlen(text) - 1);
    }
    assert_int_equal(cli_exit_code(CLI_WRONG), CLI_EXIT_USAGE);
    assert_int_equal(cli_exit_code(CLI_HELP), CLI_EXIT_OK);
}

static void a_list_longer_than_its_limit_is_refused(void **state)
{
    (void)state;
    char words[2000] = "s --out a", text[1024];
    for (int i = 0; i < CLI_LIST_MAX; i++)
        strcat(words, " --set x=1");
    struct values v;
    assert_int_equal(parse(&v, words), CLI_RUN);
    strcat(words, " --set x=1");
    assert_int_equal(parse_and_catch(words, text, sizeof text), CLI_WRONG);
}

static void two_dashes_end_the_options(void **state)
{
    (void)state;
    struct values v;
    assert_int_equal(parse(&v, "--out a -- --spp"), CLI_RUN);
    assert_string_equal(v.scene, "--spp");
}

static void pairs_split_at_the_first_equals_sign(void **state)
{
    (void)state;
    char name[8];
    assert_string_equal(cli_split_pair("a=b=c", name, sizeof name), "b=c");
    assert_string_equal(name, "a");
    assert_string_equal(cli_split_pair("a=", name, sizeof name), "");
    assert_null(cli_split_pair("=b", name, sizeof name));
    assert_null(cli_split_pair("ab", name, sizeof name));
    assert_null(cli_split_pair("12345678=b", name, sizeof name));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_is_read),
        cmocka_unit_test(what_is_not_given_keeps_its_default),
        cmocka_unit_test(wrong_arguments_give_one_line_that_names_them),
        cmocka_unit_test(a_list_longer_than_its_limit_is_refused),
        cmocka_unit_test(two_dashes_end_the_options),
        cmocka_unit_test(pairs_split_at_the_first_equals_sign),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
