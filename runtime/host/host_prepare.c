/* SPDX-License-Identifier: MIT */
#include "host_prepare.h"

#include <string.h>

/* All: a debug view may be asked for at any time. */
enum {
    PARTS = SDFGI_PREPARE_TEXTURES | SDFGI_PREPARE_EMISSION | SDFGI_PREPARE_GATHER |
            SDFGI_PREPARE_REFLECTIONS | SDFGI_PREPARE_DEBUG
};

/* False if told to stop before all is made. What cannot be made ends it too. */
static bool make_all(struct host_prepare *prepare)
{
    const struct sdfgi_prepare_desc desc = { .settings = &prepare->settings,
                                             .parts = PARTS,
                                             .max_objects = 1 };
    struct sdfgi_progress progress = { 0, 1 };
    while (progress.made < progress.total) {
        if (prepare->stop)
            return false;
        if (sdfgi_prepare(prepare->gi, &desc, &progress) != SDFGI_OK)
            return true;
    }
    return true;
}

static void *run(void *user)
{
    struct host_prepare *prepare = user;
    prepare->complete = make_all(prepare);
    prepare->done = true;
    return NULL;
}

static bool begin(struct host_prepare *prepare, const struct sdfgi_settings *settings)
{
    prepare->settings = *settings;
    prepare->stop = prepare->done = false;
    prepare->runs = pthread_create(&prepare->thread, NULL, run, prepare) == 0;
    return prepare->runs;
}

bool host_prepare_step(struct host_prepare *prepare, const struct sdfgi_settings *settings)
{
    if (!prepare->runs && !begin(prepare, settings))
        return true;
    const bool same = memcmp(&prepare->settings, settings, sizeof *settings) == 0;
    prepare->stop = !same;
    if (!prepare->done)
        return false;
    host_prepare_finish(prepare);
    return same && prepare->complete;
}

bool host_prepare_stop(struct host_prepare *prepare)
{
    prepare->stop = true;
    if (prepare->runs && !prepare->done)
        return false;
    host_prepare_finish(prepare);
    struct sdfgi_settings settings;
    sdfgi_get_settings(prepare->gi, &settings);
    if (!settings.enabled)
        sdfgi_release_prepared(prepare->gi);
    return true;
}

void host_prepare_finish(struct host_prepare *prepare)
{
    if (!prepare->runs)
        return;
    prepare->stop = true;
    pthread_join(prepare->thread, NULL);
    prepare->runs = false;
}
