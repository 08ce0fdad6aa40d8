/* SPDX-License-Identifier: MIT
 * Creation, settings, destruction. */
#include "internal.h"

#include <string.h>

static const char *desc_problem(const struct sdfgi_desc *d)
{
    if (!d->vulkan.instance || !d->vulkan.physical_device || !d->vulkan.device ||
        !d->vulkan.get_instance_proc_addr)
        return "vulkan.instance, physical_device, device or get_instance_proc_addr is null";
    if (d->frames_in_flight > SDFGI_MAX_FRAMES_IN_FLIGHT)
        return "frames_in_flight exceeds 8";
    if (!d->allocator.alloc != !d->allocator.free)
        return "allocator has only one of alloc and free";
    return NULL;
}

/* Everything about light and cascades starts anew. */
static void forget_everything(struct sdfgi *gi)
{
    memset(gi->cascades, 0, sizeof gi->cascades);
    memset(&gi->schedule, 0, sizeof gi->schedule);
    memset(gi->slots, 0, sizeof gi->slots);
    memset(gi->passes, 0, sizeof gi->passes);
    memset(gi->counters, 0, sizeof gi->counters);
    memset(&gi->params, 0, sizeof gi->params);
    for (int c = 0; c < SDFGI_MAX_CASCADES; c++)
        gi->cascades[c].rebuild = true;
    gi->ring = 1;
    gi->ring_frame = 0;
    gi->disturbed_ring = gi->known_ring = 0;
    gi->known_change = gi->known_brightest = 0;
    settle_reset(&gi->settling);
    gi->converged = gi->active = false;
    gi->materials_changed = gi->lights_changed = gi->params_changed = true;
    gi->relight_budget = SDFGI_RELIGHT_CELLS;
    gi->update_count = 0;
}

static enum sdfgi_result check_device(struct sdfgi *gi, const struct sdfgi_vulkan *vulkan)
{
    struct sdfgi_requirements requirements;
    const enum sdfgi_result result = sdfgi_get_requirements(vulkan->instance, vulkan->physical_device,
                                                            vulkan->get_instance_proc_addr, &requirements);
    if (result != SDFGI_OK)
        return invalid(gi, "sdfgi_create: the instance lacks core functions");
    if (requirements.supported)
        return SDFGI_OK;
    message(gi, SDFGI_MESSAGE_UNSUPPORTED_DEVICE, "sdfgi_create: %s", requirements.reasons[0]);
    return SDFGI_ERROR_UNSUPPORTED;
}

static enum sdfgi_result init(struct sdfgi *gi, const struct sdfgi_desc *desc)
{
    const struct sdfgi_vulkan *v = &desc->vulkan;
    enum sdfgi_result result = check_device(gi, v);
    if (result != SDFGI_OK)
        return result;
    if (v->allocation_callbacks)
        gi->callbacks = *v->allocation_callbacks;
    result = message_vulkan(gi,
                            gpu_device_init(&gi->device, v->instance, v->physical_device, v->device,
                                            v->queue_family_index, v->get_instance_proc_addr,
                                            v->allocation_callbacks ? &gi->callbacks : NULL),
                            "sdfgi_create: importing the device");
    if (result != SDFGI_OK)
        return result;
    gi->device.pipeline_cache = desc->pipeline_cache;
    result = message_vulkan(gi, pipelines_init(gi), "sdfgi_create: pipelines");
    if (result != SDFGI_OK)
        return result;
    if (desc->settings)
        return sdfgi_set_settings(gi, desc->settings);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_create(const struct sdfgi_desc *desc, sdfgi **out)
{
    const struct sdfgi prototype = { .log = desc->log, .allocator = desc->allocator };
    const char *problem = desc_problem(desc);
    if (problem)
        return invalid(&prototype, "sdfgi_create: %s", problem);
    struct sdfgi *gi = host_alloc(&desc->allocator, sizeof *gi);
    if (!gi) {
        message(&prototype, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "sdfgi_create: out of host memory");
        return SDFGI_ERROR_OUT_OF_MEMORY;
    }
    memset(gi, 0, sizeof *gi);
    gi->log = desc->log;
    gi->allocator = desc->allocator;
    gi->frames_in_flight = desc->frames_in_flight ? desc->frames_in_flight : 2;
    gi->exposure = 1;
    sdfgi_settings_default(&gi->settings);
    scene_init(gi);
    forget_everything(gi);
    const enum sdfgi_result result = init(gi, desc);
    if (result != SDFGI_OK) {
        sdfgi_destroy(gi);
        return result;
    }
    *out = gi;
    return SDFGI_OK;
}

void sdfgi_destroy(sdfgi *gi)
{
    if (!gi)
        return;
    /* Without a device nothing was made from it. */
    if (gi->device.handle) {
        resources_retire(gi);
        resources_collect(gi, true);
        scene_finish(gi);
        pipelines_finish(gi);
    }
    const struct sdfgi_allocator allocator = gi->allocator;
    host_free(&allocator, gi);
}

/* True if two settings cannot share device objects. */
static bool needs_new_resources(const struct sdfgi_settings *a, const struct sdfgi_settings *b)
{
    return a->cascades != b->cascades || a->resolution != b->resolution || a->voxelizer != b->voxelizer ||
           a->sdf_method != b->sdf_method || ring_samples(a) != ring_samples(b) ||
           a->ray_count != b->ray_count || a->min_cell_size_m != b->min_cell_size_m ||
           a->y_scale != b->y_scale || a->visibility != b->visibility || a->use_occlusion != b->use_occlusion;
}

static enum sdfgi_result check_settings(struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    char error[160];
    if (!sdfgi_settings_validate(settings, error, sizeof error)) {
        message(gi, SDFGI_MESSAGE_INVALID_SETTING, "sdfgi_set_settings: %s", error);
        return SDFGI_ERROR_INVALID_ARGUMENT;
    }
    return SDFGI_OK;
}

static enum sdfgi_result replace_resources(struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    struct resources *created = NULL;
    if (settings->enabled) {
        const enum sdfgi_result result = resources_create(gi, settings, &created);
        if (result != SDFGI_OK)
            return result;
    }
    resources_retire(gi);
    gi->resources = created;
    forget_everything(gi);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_set_settings(sdfgi *gi, const struct sdfgi_settings *settings)
{
    if (gi->device_lost)
        return SDFGI_ERROR_DEVICE_LOST;
    enum sdfgi_result result = check_settings(gi, settings);
    if (result != SDFGI_OK)
        return result;
    const bool held = gi->resources != NULL;
    if (settings->enabled != held || (held && needs_new_resources(settings, &gi->settings)))
        result = replace_resources(gi, settings);
    if (result != SDFGI_OK)
        return result;
    if (memcmp(settings, &gi->settings, sizeof *settings) != 0)
        light_disturb(gi);
    gi->settings = *settings;
    return SDFGI_OK;
}

void sdfgi_get_settings(const sdfgi *gi, struct sdfgi_settings *settings)
{
    *settings = gi->settings;
}

bool sdfgi_is_active(const sdfgi *gi)
{
    return gi->active;
}

VkDescriptorSetLayout sdfgi_get_descriptor_set_layout(const sdfgi *gi)
{
    return gi->pipelines.set_layout;
}

VkDescriptorSet sdfgi_get_descriptor_set(const sdfgi *gi)
{
    return gi->resources ? gi->resources->set : VK_NULL_HANDLE;
}
