/* SPDX-License-Identifier: MIT */
#include "stop.h"

#include "output_file.h"

#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

/* Handlers of signals can be given nothing. */
static atomic_bool keeps;
static atomic_int asked; /* the signal; 0: none */

static void say(const char *line)
{
    (void)!write(STDERR_FILENO, line, strlen(line));
}

static void end_at_once(int number)
{
    output_file_abandon();
    say(number == SIGINT ? "sdfgi: SIGINT" : "sdfgi: SIGTERM");
    say(atomic_load(&keeps) ? " ended the run before it had kept all that was done\n"
                            : " ended the run before there was anything to keep\n");
    _exit(128 + number);
}

static void on_signal(int number)
{
    if (!atomic_load(&keeps) || atomic_exchange(&asked, number) != 0)
        end_at_once(number);
}

void stop_watch(void)
{
    struct sigaction action = { .sa_handler = on_signal, .sa_flags = SA_RESTART };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void stop_keep(void)
{
    atomic_store(&keeps, true);
}

bool stop_asked(void)
{
    return atomic_load(&asked) != 0;
}

const char *stop_name(void)
{
    return atomic_load(&asked) == SIGINT ? "SIGINT" : "SIGTERM";
}

int stop_exit_code(void)
{
    return 128 + atomic_load(&asked);
}
