/* SPDX-License-Identifier: MIT
 * All outputs of a command, looked at before its work begins. */
#ifndef RUNTIME_OUTPUT_NAMES_H
#define RUNTIME_OUTPUT_NAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* An output of a command, and the option that names it. */
struct output_name {
    const char *path;         /* NULL: not wanted */
    const char *option;       /* "--aov" */
    const char *option_value; /* "normal=a.exr", of an option that may be repeated; else NULL */
};

/* True if all of them can be written and no two are the same file, whatever their paths look like; otherwise
 * one line in `error`. */
bool output_names_check(const struct output_name *names, uint32_t count, char *error, size_t error_size);

#endif
