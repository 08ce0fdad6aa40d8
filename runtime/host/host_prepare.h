/* SPDX-License-Identifier: MIT
 * Pipelines and memory of GI, made by a thread of its own while frames go on. Errors are not told: the switch
 * that follows makes what is missing, and says why it cannot. */
#ifndef HOST_PREPARE_H
#define HOST_PREPARE_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include <sdfgi/sdfgi.h>

struct host_prepare {
    sdfgi *gi; /* to be filled in; all else is zero at first */
    struct sdfgi_settings settings;
    pthread_t thread;
    bool runs;
    atomic_bool stop, done; /* done: the thread is about to end */
    bool complete;          /* it was not stopped before; to be read once it is done */
};

/* Called in each frame until it says true: all that GI needs with these settings has then been made, or
 * cannot be. Other settings than before begin anew. */
bool host_prepare_step(struct host_prepare *prepare, const struct sdfgi_settings *settings);

/* Called in each frame while nothing is to be prepared. True once no thread is at it: GI that is off holds
 * nothing then. */
bool host_prepare_stop(struct host_prepare *prepare);

/* Waits until no thread is at it: for one pipeline, or one piece of memory, at most. */
void host_prepare_finish(struct host_prepare *prepare);

#endif
