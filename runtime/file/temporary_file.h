/* SPDX-License-Identifier: MIT
 * Files beside an output that become it when they are complete. Their names, PATH.PID.RANDOM.partial, say
 * whose they are, so that a later run can remove those of processes that were killed. */
#ifndef RUNTIME_TEMPORARY_FILE_H
#define RUNTIME_TEMPORARY_FILE_H

#include <stdio.h>

/* Makes a new file beside `path` and opens it for writing; never opens a file or a link that is there.
 * `*name` is for free(). On failure returns NULL and sets errno. */
FILE *temporary_file_open(const char *path, char **name);

/* Removes what processes that live no more have left of the outputs whose paths begin with `prefix`. */
void temporary_file_remove_leftovers(const char *prefix);

#endif
