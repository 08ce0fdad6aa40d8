/* SPDX-License-Identifier: MIT
 * The command line of the `sdfgi` program: sub-commands as rows, options as rows, one parser for all.
 *
 * A sub-command fills a table that points into its own variables, whose initial values are the defaults:
 *
 *     int cmd_reference(int argc, char **argv)
 *     {
 *         const char *scene = NULL, *out = NULL;
 *         uint32_t spp = 64;
 *         const struct cli_option options[] = {
 *             { "spp", CLI_UINT, &spp, "N", .help = "samples per pixel", .minimum = 1, .maximum = 1e6 },
 *             { "out", CLI_TEXT, &out, "FILE", .help = "output picture", .required = true },
 *         };
 *         const struct cli_positional positionals[] = { { "SCENE", &scene, .required = true } };
 *         const struct cli_spec spec = { "reference", "path-traced ground truth", CLI_ARRAY(options),
 *                                        CLI_ARRAY(positionals), NULL };
 *         const enum cli_outcome outcome = cli_parse(&spec, argc, argv);
 *         if (outcome != CLI_RUN)
 *             return cli_exit_code(outcome);
 *
 * argv[0] is the name of the sub-command. Rows name .help and what follows, so that the rest may be left out.
 * Options are `--name value` or `--name=value`; `--` ends them. */
#ifndef RUNTIME_CLI_H
#define RUNTIME_CLI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Exit codes of the program; a run that SIGINT or SIGTERM ended leaves with 128 + its number instead. */
enum { CLI_EXIT_OK = 0, CLI_EXIT_FAILURE = 1, CLI_EXIT_USAGE = 2 };

enum { CLI_LIST_MAX = 64, CLI_ERROR_BYTES = 512 };

enum cli_type {
    CLI_FLAG,   /* bool: present or not, no value */
    CLI_SWITCH, /* bool: on | off */
    CLI_TEXT,   /* const char * */
    CLI_UINT,   /* uint32_t in [minimum, maximum] */
    CLI_UINT64, /* uint64_t in [minimum, maximum], exact up to 2^53 */
    CLI_FLOAT,  /* double in [minimum, maximum], finite */
    CLI_SIZE,   /* struct cli_size: WxH, each in [minimum, maximum] */
    CLI_LIST,   /* struct cli_list: may be given many times */
};

struct cli_size {
    uint32_t width, height;
};

struct cli_list {
    const char *values[CLI_LIST_MAX];
    uint32_t count;
};

struct cli_option {
    const char *name; /* without the dashes */
    enum cli_type type;
    void *target;
    const char *placeholder; /* shown in the help; NULL for CLI_FLAG and CLI_SWITCH */
    const char *help;
    double minimum, maximum; /* both 0: 0 to the largest value of the type */
    bool required;
    bool *given; /* may be NULL: set when the option appears */
};

struct cli_positional {
    const char *placeholder;
    const char **target;
    bool required;
};

struct cli_spec {
    const char *name, *summary;
    const struct cli_option *options;
    uint32_t option_count;
    const struct cli_positional *positionals;
    uint32_t positional_count;
    const char *notes; /* printed at the end of the help; may be NULL */
};

#define CLI_ARRAY(array) (array), (uint32_t)(sizeof(array) / sizeof((array)[0]))

enum cli_outcome {
    CLI_RUN,   /* go on */
    CLI_HELP,  /* --help was printed: leave with 0 */
    CLI_WRONG, /* one line was printed: leave with CLI_EXIT_USAGE */
};

/* Reads the arguments into the targets. On CLI_WRONG the targets are in no useful state. */
enum cli_outcome cli_parse(const struct cli_spec *spec, int argc, char **argv);

/* The exit code for an outcome other than CLI_RUN. */
int cli_exit_code(enum cli_outcome outcome);

/* Prints "sdfgi: " and one line to stderr; returns CLI_EXIT_FAILURE. */
__attribute__((format(printf, 1, 2))) int cli_error(const char *format, ...);

/* Splits "NAME=VALUE" at the first '='. The name is copied into `name`; returns the value, or NULL if there
 * is no
 * '=', the name is empty or does not fit. */
const char *cli_split_pair(const char *pair, char *name, size_t name_size);

/* A progress bar with the time left on stderr; silent unless stderr is a terminal. */
struct cli_progress {
    const char *label;
    double start_s, drawn_s;
    uint64_t total; /* 0: unknown */
    bool visible;
};

void cli_progress_begin(struct cli_progress *progress, const char *label, uint64_t total);
void cli_progress_update(struct cli_progress *progress, uint64_t done);
void cli_progress_end(struct cli_progress *progress);

/* Seconds from a monotonic clock. */
double cli_time_s(void);

#endif
