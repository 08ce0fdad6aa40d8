/* SPDX-License-Identifier: MIT */
#include "program_run.h"

#include "files.h"
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

static const char *program;

void program_set(const char *path)
{
    program = path;
}

struct program_run run_program(const char *environment, const char *arguments)
{
    static struct program_run run;
    char command[2048];
    snprintf(command, sizeof command, "cd %s && %s '%s' %s >out.txt 2>err.txt", files_path(""), environment,
             program, arguments);
    const int status = system(command);
    assert_true(WIFEXITED(status));
    run.code = WEXITSTATUS(status);
    files_take_text("out.txt", run.out, sizeof run.out);
    files_take_text("err.txt", run.err, sizeof run.err);
    return run;
}

void run_in_folder(const char *command)
{
    char line[512];
    snprintf(line, sizeof line, "cd %s && %s", files_path(""), command);
    assert_int_equal(system(line), 0);
}
