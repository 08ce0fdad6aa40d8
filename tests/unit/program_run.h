/* SPDX-License-Identifier: MIT
 * Runs the program inside the folder of a test's files. */
#ifndef TEST_PROGRAM_RUN_H
#define TEST_PROGRAM_RUN_H

struct program_run {
    int code;
    char out[8192], err[8192];
};

/* An absolute path. To be set first. */
void program_set(const char *path);

/* Runs the program with `environment` before its name. */
struct program_run run_program(const char *environment, const char *arguments);

/* Runs a line of shell, which must succeed. */
void run_in_folder(const char *command);

#endif
