/* SPDX-License-Identifier: MIT */
#include "cli.h"

#include <base/text.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int cli_error(const char *format, ...)
{
    char text[CLI_ERROR_BYTES];
    va_list args;
    va_start(args, format);
    base_text_error_va(text, sizeof text, format, args);
    va_end(args);
    fprintf(stderr, "sdfgi: %s\n", text);
    return CLI_EXIT_FAILURE;
}

int cli_exit_code(enum cli_outcome outcome)
{
    return outcome == CLI_WRONG ? CLI_EXIT_USAGE : CLI_EXIT_OK;
}

const char *cli_split_pair(const char *pair, char *name, size_t name_size)
{
    const char *equals = strchr(pair, '=');
    if (!equals || equals == pair || (size_t)(equals - pair) >= name_size)
        return NULL;
    memcpy(name, pair, (size_t)(equals - pair));
    name[equals - pair] = '\0';
    return equals + 1;
}

/* ---- Values ----------------------------------------------------------------------------------------- */

static double option_maximum(const struct cli_option *option)
{
    if (option->minimum != 0 || option->maximum != 0)
        return option->maximum;
    return option->type == CLI_FLOAT    ? HUGE_VAL
           : option->type == CLI_UINT64 ? 9007199254740992.0
                                        : UINT32_MAX;
}

static bool in_range(const struct cli_option *option, double value)
{
    return value >= option->minimum && value <= option_maximum(option);
}

static bool to_whole(const struct cli_option *option, const char *text, double *value)
{
    return base_text_to_double(text, value) && *value == floor(*value) && in_range(option, *value);
}

static bool set_size(const struct cli_option *option, const char *text)
{
    char width_text[16];
    const char *x = strchr(text, 'x');
    if (!x || (size_t)(x - text) >= sizeof width_text)
        return false;
    memcpy(width_text, text, (size_t)(x - text));
    width_text[x - text] = '\0';
    double width, height;
    if (!to_whole(option, width_text, &width) || !to_whole(option, x + 1, &height))
        return false;
    *(struct cli_size *)option->target = (struct cli_size){ (uint32_t)width, (uint32_t)height };
    return true;
}

static bool set_switch(bool *target, const char *text)
{
    *target = strcmp(text, "on") == 0;
    return *target || strcmp(text, "off") == 0;
}

static bool set_list(struct cli_list *list, const char *text)
{
    if (list->count == CLI_LIST_MAX)
        return false;
    list->values[list->count++] = text;
    return true;
}

static bool set_number(const struct cli_option *option, const char *text)
{
    double value;
    if (option->type == CLI_FLOAT) {
        if (!base_text_to_double(text, &value) || !in_range(option, value))
            return false;
        *(double *)option->target = value;
        return true;
    }
    if (!to_whole(option, text, &value))
        return false;
    if (option->type == CLI_UINT)
        *(uint32_t *)option->target = (uint32_t)value;
    else
        *(uint64_t *)option->target = (uint64_t)value;
    return true;
}

static bool set_value(const struct cli_option *option, const char *text)
{
    switch (option->type) {
    case CLI_FLAG:
        *(bool *)option->target = true;
        return true;
    case CLI_SWITCH:
        return set_switch(option->target, text);
    case CLI_TEXT:
        *(const char **)option->target = text;
        return text[0] != '\0';
    case CLI_SIZE:
        return set_size(option, text);
    case CLI_LIST:
        return set_list(option->target, text);
    case CLI_UINT:
    case CLI_UINT64:
    case CLI_FLOAT:
        return set_number(option, text);
    }
    return false;
}

/* ---- Messages --------------------------------------------------------------------------------------- */

static void expectation(const struct cli_option *option, char *text, size_t size)
{
    const double maximum = option_maximum(option);
    char range[80];
    if (isinf(maximum))
        snprintf(range, sizeof range, "of at least %g", option->minimum);
    else
        snprintf(range, sizeof range, "from %.17g to %.17g", option->minimum, maximum);
    switch (option->type) {
    case CLI_SWITCH:
        snprintf(text, size, "on or off");
        break;
    case CLI_TEXT:
        snprintf(text, size, "something that is not empty");
        break;
    case CLI_LIST:
        snprintf(text, size, "at most %d of them", CLI_LIST_MAX);
        break;
    case CLI_SIZE:
        snprintf(text, size, "WxH, each a whole number %s", range);
        break;
    default:
        snprintf(text, size, "a %snumber %s", option->type == CLI_FLOAT ? "" : "whole ", range);
    }
}

static enum cli_outcome wrong_value(const struct cli_spec *spec, const struct cli_option *option,
                                    const char *value)
{
    char expected[160];
    expectation(option, expected, sizeof expected);
    cli_error("%s: --%s is \"%s\", expected %s", spec->name, option->name, value, expected);
    return CLI_WRONG;
}

static void print_usage_line(const struct cli_spec *spec)
{
    printf("usage: sdfgi %s", spec->name);
    for (uint32_t i = 0; i < spec->positional_count; i++)
        printf(spec->positionals[i].required ? " %s" : " [%s]", spec->positionals[i].placeholder);
    for (uint32_t i = 0; i < spec->option_count; i++)
        if (spec->options[i].required)
            printf(" --%s %s", spec->options[i].name, spec->options[i].placeholder);
    puts(spec->option_count ? " [options]" : "");
}

static void print_help(const struct cli_spec *spec)
{
    print_usage_line(spec);
    printf("\n%s\n", spec->summary);
    for (uint32_t i = 0; i < spec->option_count; i++) {
        const struct cli_option *option = &spec->options[i];
        const char *value = option->type == CLI_SWITCH ? "on|off"
                            : option->placeholder      ? option->placeholder
                                                       : "";
        char left[64];
        snprintf(left, sizeof left, "--%s %s", option->name, value);
        printf("%s  %-28s %s%s\n", i ? "" : "\n", left, option->help,
               option->type == CLI_LIST ? " (may be repeated)" : "");
    }
    if (spec->notes)
        printf("\n%s\n", spec->notes);
}

/* ---- Parsing ---------------------------------------------------------------------------------------- */

/* What has been seen so far; options by their index in the table. */
struct seen {
    uint64_t options;
    uint32_t positionals;
};

static const struct cli_option *find_option(const struct cli_spec *spec, const char *name, size_t length)
{
    for (uint32_t i = 0; i < spec->option_count; i++)
        if (strlen(spec->options[i].name) == length && strncmp(spec->options[i].name, name, length) == 0)
            return &spec->options[i];
    return NULL;
}

/* Reads the option at argv[*at] and moves *at past its value. */
static enum cli_outcome parse_option(const struct cli_spec *spec, int argc, char **argv, int *at,
                                     struct seen *seen)
{
    const char *name = argv[*at] + 2;
    const char *equals = strchr(name, '=');
    const size_t length = equals ? (size_t)(equals - name) : strlen(name);
    const struct cli_option *option = find_option(spec, name, length);
    if (!option) {
        cli_error("%s: unknown option \"%s\", see sdfgi %s --help", spec->name, argv[*at], spec->name);
        return CLI_WRONG;
    }
    const char *value = equals ? equals + 1 : NULL;
    if (option->type == CLI_FLAG && value) {
        cli_error("%s: --%s takes no value", spec->name, option->name);
        return CLI_WRONG;
    }
    if (option->type != CLI_FLAG && !value) {
        if (*at + 1 >= argc) {
            cli_error("%s: --%s needs a value", spec->name, option->name);
            return CLI_WRONG;
        }
        value = argv[++*at];
    }
    if (!set_value(option, value))
        return wrong_value(spec, option, value);
    if (option->given)
        *option->given = true;
    seen->options |= 1ull << (option - spec->options);
    return CLI_RUN;
}

static enum cli_outcome check_required(const struct cli_spec *spec, const struct seen *seen)
{
    for (uint32_t i = seen->positionals; i < spec->positional_count; i++)
        if (spec->positionals[i].required) {
            cli_error("%s: %s is missing, see sdfgi %s --help", spec->name, spec->positionals[i].placeholder,
                      spec->name);
            return CLI_WRONG;
        }
    for (uint32_t i = 0; i < spec->option_count; i++)
        if (spec->options[i].required && !(seen->options >> i & 1)) {
            cli_error("%s: --%s is missing, see sdfgi %s --help", spec->name, spec->options[i].name,
                      spec->name);
            return CLI_WRONG;
        }
    return CLI_RUN;
}

enum cli_outcome cli_parse(const struct cli_spec *spec, int argc, char **argv)
{
    struct seen seen = { 0 };
    bool options_over = false;
    for (int i = 1; i < argc; i++) {
        if (!options_over && strcmp(argv[i], "--") == 0) {
            options_over = true;
        } else if (!options_over && (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)) {
            print_help(spec);
            return CLI_HELP;
        } else if (!options_over && argv[i][0] == '-' && argv[i][1] == '-') {
            const enum cli_outcome outcome = parse_option(spec, argc, argv, &i, &seen);
            if (outcome != CLI_RUN)
                return outcome;
        } else if (seen.positionals < spec->positional_count) {
            *spec->positionals[seen.positionals++].target = argv[i];
        } else {
            cli_error("%s: unexpected argument \"%s\", see sdfgi %s --help", spec->name, argv[i], spec->name);
            return CLI_WRONG;
        }
    }
    return check_required(spec, &seen);
}
