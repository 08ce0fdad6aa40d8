/* SPDX-License-Identifier: MIT
 * sdfgi_prepare: pipelines and volumes made ahead, by a thread that may run beside the one that draws. */
#include "context.h"

#include "core/problem.h"

#include <string.h>
#include <time.h>

enum {
    ALL_PARTS = SDFGI_PREPARE_TEXTURES | SDFGI_PREPARE_EMISSION | SDFGI_PREPARE_GATHER |
                SDFGI_PREPARE_REFLECTIONS | SDFGI_PREPARE_DEBUG,
    USUAL_PARTS = ALL_PARTS & ~SDFGI_PREPARE_DEBUG,
};

struct job {
    struct sdfgi_settings settings;
    uint32_t parts;
    uint64_t instances; /* to have room for */
};

/* ---- Pipelines */

/* The part that a pass which not every frame needs belongs to. */
static uint32_t part_of(enum need need)
{
    static const uint32_t parts[NEED_COUNT] = {
        [NEED_GATHER] = SDFGI_PREPARE_GATHER,           [NEED_GATHER_SPARSE] = SDFGI_PREPARE_GATHER,
        [NEED_REFLECTIONS] = SDFGI_PREPARE_REFLECTIONS, [NEED_ROUGH_LOBES] = SDFGI_PREPARE_REFLECTIONS,
        [NEED_DEBUG_VIEW] = SDFGI_PREPARE_DEBUG,        [NEED_DEBUG_TIER] = SDFGI_PREPARE_DEBUG,
    };
    return parts[need];
}

/* True if light cells keep from where they get their light once a view has reflections. */
static bool wants_low_light(const struct job *job)
{
    return (job->parts & SDFGI_PREPARE_REFLECTIONS) && job->settings.rough_lobes &&
           sdfgi_settings_cycle_visits(&job->settings) > 0;
}

/* Materials that call for one may come later. */
static bool wants_second_variant(const struct job *job, enum pass_kind kind)
{
    return (kind == PASS_KIND_COMPUTE_TEXTURED && (job->parts & SDFGI_PREPARE_TEXTURES)) ||
           (kind == PASS_KIND_COMPUTE_LOBES && wants_low_light(job)) || kind == PASS_KIND_COMPUTE_METAL;
}

static bool wants_pipeline(const struct job *job, enum pass pass, uint32_t variant)
{
    const struct pass_row *row = sdfgi_pass_row(pass);
    if (row->made == PASS_MADE_RASTER) /* made with its target */
        return false;
    if (variant != PASS_PLAIN && !wants_second_variant(job, row->kind))
        return false;
    return row->made == PASS_MADE_CREATED ? sdfgi_pass_fits(pass, &job->settings)
                                          : (job->parts & part_of(row->need)) != 0;
}

static struct sdfgi_progress pipeline_progress(struct backend *backend, const struct job *job)
{
    struct sdfgi_progress p = { 0, 0 };
    for (int i = 0; i < PASS_COUNT; i++)
        for (uint32_t v = 0; v < PASS_VARIANTS; v++)
            if (wants_pipeline(job, (enum pass)i, v)) {
                p.total++;
                p.made += sdfgi_pipelines_has(backend, (enum pass)i, v);
            }
    return p;
}

static VkResult make_pipeline(struct backend *backend, const struct job *job)
{
    for (int i = 0; i < PASS_COUNT; i++)
        for (uint32_t v = 0; v < PASS_VARIANTS; v++)
            if (wants_pipeline(job, (enum pass)i, v) && !sdfgi_pipelines_has(backend, (enum pass)i, v))
                return sdfgi_pipelines_require(backend, (enum pass)i, v);
    return VK_SUCCESS;
}

/* ---- Volumes */

static bool fits(const struct resources *r, const struct job *job)
{
    const bool emission = job->parts & SDFGI_PREPARE_EMISSION;
    return sdfgi_settings_change(&r->settings, &job->settings) != SETTINGS_ALL &&
           (r->extent.emits || !emission) && (r->extent.low_light || !wants_low_light(job));
}

/* True if nothing is missing, room for instances included: the scene may have grown meanwhile. */
static bool is_complete(const struct resources *r, const struct job *job)
{
    return r->made == sdfgi_resources_object_count(&job->settings) && r->extent.instances >= job->instances;
}

/* True if volumes with the settings are in force, or wait to be. */
static bool has_volumes(struct sdfgi *gi, const struct job *job)
{
    struct preparation *p = &gi->preparation;
    pthread_mutex_lock(&gi->backend.lock);
    const bool has =
        (p->in_force && sdfgi_settings_change(&p->in_force_settings, &job->settings) != SETTINGS_ALL) ||
        (p->ready && fits(p->ready, job) && is_complete(p->ready, job));
    pthread_mutex_unlock(&gi->backend.lock);
    return has;
}

/* Notes what is wanted, takes back what is incomplete by now, and destroys what was made for anything else.
 * No frame has used it. */
static void want(struct sdfgi *gi, const struct job *job)
{
    struct preparation *p = &gi->preparation;
    struct resources *unwanted = NULL;
    pthread_mutex_lock(&gi->backend.lock);
    p->wanted = job->settings;
    p->keeps = true;
    if (p->ready && (!fits(p->ready, job) || !is_complete(p->ready, job))) {
        unwanted = p->making;
        p->making = p->ready;
        p->ready = NULL;
    }
    pthread_mutex_unlock(&gi->backend.lock);
    sdfgi_resources_destroy(&gi->backend, unwanted);
    if (p->making && (!fits(p->making, job) || has_volumes(gi, job))) {
        sdfgi_resources_destroy(&gi->backend, p->making);
        p->making = NULL;
    }
}

static void publish(struct sdfgi *gi)
{
    struct preparation *p = &gi->preparation;
    pthread_mutex_lock(&gi->backend.lock);
    p->ready = p->making;
    pthread_mutex_unlock(&gi->backend.lock);
    p->making = NULL;
}

static VkResult make_next(struct backend *backend, struct resources *r, const struct job *job)
{
    if (r->made < sdfgi_resources_object_count(&job->settings))
        return sdfgi_resources_make_next(backend, r);
    const bool grown = sdfgi_resources_grow_instances(backend, r, job->instances);
    return grown ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

static enum sdfgi_result make_volume_object(struct sdfgi *gi, const struct job *job)
{
    struct preparation *p = &gi->preparation;
    if (!p->making) {
        const struct scene_extent scene = { job->instances, job->parts & SDFGI_PREPARE_EMISSION,
                                            wants_low_light(job) };
        const enum sdfgi_result begun =
            sdfgi_resources_begin(&gi->backend, &job->settings, scene, "sdfgi_prepare", &p->making);
        if (begun != SDFGI_OK)
            return begun;
    }
    const VkResult result = make_next(&gi->backend, p->making, job);
    if (result != VK_SUCCESS) {
        sdfgi_resources_destroy(&gi->backend, p->making);
        p->making = NULL;
    } else if (is_complete(p->making, job)) {
        publish(gi);
    }
    return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_prepare");
}

/* ---- Progress and budget */

static struct sdfgi_progress progress_of(struct sdfgi *gi, const struct job *job)
{
    const uint32_t count = sdfgi_resources_object_count(&job->settings);
    const struct resources *making = gi->preparation.making;
    struct sdfgi_progress p = pipeline_progress(&gi->backend, job);
    if (has_volumes(gi, job))
        p.made += count;
    else if (making)
        p.made += making->made < count ? making->made : count - 1;
    p.total += count;
    pthread_mutex_lock(&gi->backend.lock);
    gi->preparation.progress = p;
    pthread_mutex_unlock(&gi->backend.lock);
    return p;
}

static uint64_t now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000 + (uint64_t)t.tv_nsec / 1000;
}

static enum sdfgi_result make_one(struct sdfgi *gi, const struct job *job)
{
    const struct sdfgi_progress pipelines = pipeline_progress(&gi->backend, job);
    if (pipelines.made == pipelines.total)
        return make_volume_object(gi, job);
    return sdfgi_message_vulkan(&gi->backend.hooks, make_pipeline(&gi->backend, job), "sdfgi_prepare");
}

static enum sdfgi_result work(struct sdfgi *gi, const struct job *job, uint32_t objects, uint32_t us)
{
    const uint64_t begin = now_us();
    enum sdfgi_result result = SDFGI_OK;
    struct sdfgi_progress p = progress_of(gi, job);
    for (uint32_t done = 0; result == SDFGI_OK && p.made < p.total; done++) {
        if ((objects > 0 && done == objects) || (us > 0 && done > 0 && now_us() - begin >= us))
            break;
        result = make_one(gi, job);
        p = progress_of(gi, job);
    }
    return result;
}

/* ---- The interface */

static enum sdfgi_result check(struct sdfgi *gi, const struct sdfgi_prepare_desc *desc, const struct job *job)
{
    char error[160];
    if (desc->parts & ~(uint32_t)ALL_PARTS)
        return sdfgi_message_invalid(&gi->backend.hooks, "sdfgi_prepare: parts is %#x, must be bits of %#x",
                                     (unsigned)desc->parts, (unsigned)ALL_PARTS);
    if (sdfgi_settings_validate(&job->settings, error, sizeof error))
        return SDFGI_OK;
    sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_INVALID_SETTING, "sdfgi_prepare: %s", error);
    return SDFGI_ERROR_INVALID_ARGUMENT;
}

static uint64_t instance_room(struct sdfgi *gi)
{
    pthread_mutex_lock(&gi->backend.lock);
    const uint64_t room = gi->scene.instance_room;
    pthread_mutex_unlock(&gi->backend.lock);
    return room;
}

enum sdfgi_result sdfgi_prepare(sdfgi *gi, const struct sdfgi_prepare_desc *desc,
                                struct sdfgi_progress *progress)
{
    struct job job = { .parts = desc->parts ? desc->parts : USUAL_PARTS, .instances = instance_room(gi) };
    sdfgi_settings_default(&job.settings);
    if (desc->settings)
        job.settings = *desc->settings;
    job.settings.enabled = true;
    const enum sdfgi_result valid = check(gi, desc, &job);
    if (valid != SDFGI_OK)
        return valid;
    if (gi->backend.hooks.device_lost)
        return SDFGI_ERROR_DEVICE_LOST;
    want(gi, &job);
    const enum sdfgi_result result = work(gi, &job, desc->max_objects, desc->max_microseconds);
    if (result == SDFGI_OK && progress)
        *progress = sdfgi_prepared(gi);
    return result;
}

static void release(struct sdfgi *gi)
{
    struct preparation *p = &gi->preparation;
    pthread_mutex_lock(&gi->backend.lock);
    struct resources *ready = p->ready;
    p->ready = NULL;
    p->keeps = false;
    p->progress = (struct sdfgi_progress){ 0, 0 };
    pthread_mutex_unlock(&gi->backend.lock);
    sdfgi_resources_destroy(&gi->backend, ready);
    sdfgi_resources_destroy(&gi->backend, p->making);
    p->making = NULL;
}

void sdfgi_release_prepared(sdfgi *gi)
{
    release(gi);
    sdfgi_preparation_drop(gi);
}

/* ---- For the thread that draws */

struct resources *sdfgi_preparation_take(struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    struct preparation *p = &gi->preparation;
    struct resources *taken = NULL;
    pthread_mutex_lock(&gi->backend.lock);
    if (p->ready && sdfgi_settings_change(&p->ready->settings, settings) != SETTINGS_ALL) {
        taken = p->ready;
        p->ready = NULL;
        p->in_force = true;
        p->in_force_settings = taken->settings;
    }
    pthread_mutex_unlock(&gi->backend.lock);
    return taken;
}

void sdfgi_preparation_note(struct sdfgi *gi)
{
    const struct resources *r = gi->volume.resources;
    pthread_mutex_lock(&gi->backend.lock);
    gi->preparation.in_force = r != NULL;
    if (r)
        gi->preparation.in_force_settings = r->settings;
    pthread_mutex_unlock(&gi->backend.lock);
}

bool sdfgi_preparation_keeps(struct sdfgi *gi)
{
    const struct resources *r = gi->volume.resources;
    pthread_mutex_lock(&gi->backend.lock);
    const bool keeps = gi->preparation.keeps && r &&
                       sdfgi_settings_change(&r->settings, &gi->preparation.wanted) != SETTINGS_ALL;
    pthread_mutex_unlock(&gi->backend.lock);
    return keeps;
}

void sdfgi_preparation_drop(struct sdfgi *gi)
{
    if (gi->settings.enabled || !gi->volume.resources || sdfgi_preparation_keeps(gi))
        return;
    sdfgi_volume_reset(&gi->volume, NULL, &gi->settings);
    sdfgi_preparation_note(gi);
}

struct sdfgi_progress sdfgi_prepared(const struct sdfgi *gi)
{
    pthread_mutex_t *lock = (pthread_mutex_t *)&gi->backend.lock;
    pthread_mutex_lock(lock);
    const struct sdfgi_progress progress = gi->preparation.progress;
    pthread_mutex_unlock(lock);
    return progress;
}

void sdfgi_preparation_finish(struct sdfgi *gi)
{
    release(gi);
}
