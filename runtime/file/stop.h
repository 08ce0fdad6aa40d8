/* SPDX-License-Identifier: MIT
 * SIGINT and SIGTERM. While a run has nothing to keep, the first of them ends the program at once. From
 * stop_keep on it asks for an end, and the run finishes in order; the second one ends the program. */
#ifndef RUNTIME_STOP_H
#define RUNTIME_STOP_H

#include <stdbool.h>

/* Installs the handlers. Whatever file is being written when they end the program is removed. */
void stop_watch(void);

/* From here on there is something to keep. */
void stop_keep(void);

/* True once an end has been asked for. Any thread may ask, at any time. */
bool stop_asked(void);

/* What asked: "SIGINT" or "SIGTERM"; and the exit code that says so, 128 + its number. */
const char *stop_name(void);
int stop_exit_code(void);

#endif
