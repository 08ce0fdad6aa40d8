/* SPDX-License-Identifier: MIT
 * What comes from a command line: settings as NAME=VALUE, one in a line; and all arguments of a program, one
 * in a line. */
#include "fuzz.h"

#include "cli/cli.h"
#include "require.h"

#include <sdfgi/settings.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEXT_BYTES = 8192, NAME_BYTES = 64, ERROR_BYTES = 128, ARGUMENTS_MAX = 64 };

static void read_text(const char *path, char text[static TEXT_BYTES])
{
    FILE *const file = fopen(path, "rb");
    REQUIRE_TRUE(file != NULL);
    text[fread(text, 1, TEXT_BYTES - 1, file)] = '\0';
    fclose(file);
}

/* Cuts the next line off `text`; NULL at the end. */
static char *take_line(char **text)
{
    char *const line = *text;
    if (!line)
        return NULL;
    char *const end = strchr(line, '\n');
    *text = end ? end + 1 : NULL;
    if (end)
        *end = '\0';
    return line;
}

/* ---- Settings --------------------------------------------------------------------------------------- */

/* What is printed is read back as the same value. */
static void check_text(const struct sdfgi_settings *settings, const char *name)
{
    char text[64], error[ERROR_BYTES];
    struct sdfgi_settings again = *settings;
    REQUIRE_TRUE(sdfgi_settings_format(settings, name, text, sizeof text));
    if (!sdfgi_settings_set(&again, name, text, error, sizeof error))
        require_fail(__FILE__, __LINE__, "%s=%s is printed and not read: %s", name, text, error);
    const double wanted = sdfgi_settings_get(settings, name), found = sdfgi_settings_get(&again, name);
    /* Derived values are products of two floats and a double; each is printed as the nearest float. */
    REQUIRE_NEAR(found / (wanted != 0 ? wanted : 1), wanted != 0 ? 1 : 0, 1e-6);
}

static void apply(struct sdfgi_settings *settings, const char *line)
{
    char name[NAME_BYTES], error[ERROR_BYTES];
    const char *const value = cli_split_pair(line, name, sizeof name);
    if (!value)
        return;
    const struct sdfgi_settings before = *settings;
    memset(error, 'x', sizeof error);
    if (sdfgi_settings_set(settings, name, value, error, sizeof error)) {
        if (!sdfgi_settings_validate(settings, error, sizeof error))
            require_fail(__FILE__, __LINE__, "%s is taken and not valid: %s", line, error);
        check_text(settings, name);
        return;
    }
    REQUIRE_TRUE(memcmp(settings, &before, sizeof before) == 0);
    REQUIRE_CMP(strnlen(error, sizeof error), <, sizeof error);
    REQUIRE_TRUE(strchr(error, '\n') == NULL);
    sdfgi_settings_set(settings, name, value, error, strlen(value) % 16);
    sdfgi_settings_set(settings, name, value, NULL, 0);
}

static bool read_settings(const char *path, char *error, size_t error_size)
{
    (void)error;
    (void)error_size;
    static char text[TEXT_BYTES];
    struct sdfgi_settings settings;
    read_text(path, text);
    sdfgi_settings_default(&settings);
    char *rest = text;
    for (const char *line; (line = take_line(&rest));)
        apply(&settings, line);
    return true;
}

/* ---- Arguments -------------------------------------------------------------------------------------- */

struct arguments {
    bool flag, gi;
    const char *out, *scene, *more;
    uint32_t spp, free_count;
    uint64_t seed;
    double seconds;
    struct cli_size size;
    struct cli_list list;
};

static enum cli_outcome parse(struct arguments *a, int argc, char **argv)
{
    const struct cli_option options[] = {
        { "flag", CLI_FLAG, &a->flag, .help = "a flag" },
        { "gi", CLI_SWITCH, &a->gi, .help = "a switch" },
        { "out", CLI_TEXT, &a->out, "FILE", .help = "a file" },
        { "spp", CLI_UINT, &a->spp, "N", .help = "a count", .minimum = 1, .maximum = 1e6 },
        { "count", CLI_UINT, &a->free_count, "N", .help = "another" },
        { "seed", CLI_UINT64, &a->seed, "N", .help = "a large count" },
        { "time", CLI_FLOAT, &a->seconds, "S", .help = "seconds", .minimum = 0, .maximum = 1e9 },
        { "size", CLI_SIZE, &a->size, "WxH", .help = "a size", .minimum = 1, .maximum = 16384 },
        { "set", CLI_LIST, &a->list, "NAME=VALUE", .help = "a list" },
    };
    const struct cli_positional positionals[] = { { "SCENE", &a->scene, .required = true },
                                                  { "MORE", &a->more, .required = false } };
    const struct cli_spec spec = { "fuzz", "reads arguments", CLI_ARRAY(options), CLI_ARRAY(positionals),
                                   NULL };
    return cli_parse(&spec, argc, argv);
}

static void check_arguments(const struct arguments *a)
{
    REQUIRE_TRUE(a->scene != NULL);
    REQUIRE_TRUE(a->out && a->out[0] != '\0');
    REQUIRE_TRUE(a->spp >= 1 && a->spp <= 1000000);
    REQUIRE_CMP(a->seed, <=, UINT64_C(1) << 53);
    REQUIRE_TRUE(a->seconds >= 0 && a->seconds <= 1e9);
    REQUIRE_TRUE(a->size.width >= 1 && a->size.width <= 16384);
    REQUIRE_TRUE(a->size.height >= 1 && a->size.height <= 16384);
    REQUIRE_CMP(a->list.count, <=, (uint32_t)CLI_LIST_MAX);
    for (uint32_t i = 0; i < a->list.count; i++)
        REQUIRE_TRUE(a->list.values[i] != NULL);
}

static bool read_arguments(const char *path, char *error, size_t error_size)
{
    static char text[TEXT_BYTES];
    char name[] = "fuzz", *argv[ARGUMENTS_MAX + 1] = { name }, *rest = text;
    int argc = 1;
    read_text(path, text);
    for (char *line; argc < ARGUMENTS_MAX && (line = take_line(&rest));)
        argv[argc++] = line;
    struct arguments a = { .out = "out", .spp = 1, .size = { 1, 1 } };
    const enum cli_outcome outcome = parse(&a, argc, argv);
    if (outcome == CLI_RUN)
        check_arguments(&a);
    snprintf(error, error_size, FUZZ_STEM ".txt: wrong arguments");
    return outcome != CLI_WRONG;
}

const struct fuzz_target fuzz_settings = { ".txt", read_settings, NULL, NULL };
const struct fuzz_target fuzz_cli = { ".txt", read_arguments, NULL, NULL };
