/* SPDX-License-Identifier: MIT
 * Creation, settings, destruction. */
#include "context.h"

#include "core/extent.h"
#include "core/problem.h"
#include "scene/up_axis.h"

#include <string.h>

static struct problem desc_problem(const struct sdfgi_desc *d)
{
    struct problem p = { "" };
    if (!d->vulkan.instance)
        sdfgi_problem_add(&p, "vulkan.instance is null");
    if (!d->vulkan.physical_device)
        sdfgi_problem_add(&p, "vulkan.physical_device is null");
    if (!d->vulkan.device)
        sdfgi_problem_add(&p, "vulkan.device is null");
    if (!d->vulkan.get_instance_proc_addr)
        sdfgi_problem_add(&p, "vulkan.get_instance_proc_addr is null");
    if (d->frames_in_flight > SDFGI_MAX_FRAMES_IN_FLIGHT)
        sdfgi_problem_add(&p, "frames_in_flight is %u, must be at most %d", (unsigned)d->frames_in_flight,
                          (int)SDFGI_MAX_FRAMES_IN_FLIGHT);
    if ((unsigned)d->up_axis > SDFGI_UP_MINUS_Z)
        sdfgi_problem_add(&p, "up_axis is %d, must be one of enum sdfgi_up_axis", (int)d->up_axis);
    if (!d->allocator.alloc != !d->allocator.free)
        sdfgi_problem_add(&p, "allocator.%s is null, must be set where allocator.%s is",
                          d->allocator.alloc ? "free" : "alloc", d->allocator.alloc ? "alloc" : "free");
    if (!d->device_allocator.allocate != !d->device_allocator.free)
        sdfgi_problem_add(&p, "device_allocator.%s is null, must be set where device_allocator.%s is",
                          d->device_allocator.allocate ? "free" : "allocate",
                          d->device_allocator.allocate ? "allocate" : "free");
    return p;
}

static enum sdfgi_result check_device(struct hooks *hooks, const struct sdfgi_vulkan *vulkan)
{
    struct sdfgi_requirements requirements;
    const enum sdfgi_result result = sdfgi_get_requirements(vulkan->instance, vulkan->physical_device,
                                                            vulkan->get_instance_proc_addr, &requirements);
    if (result != SDFGI_OK)
        return sdfgi_message_invalid(hooks, "sdfgi_create: the instance lacks core functions");
    if (requirements.supported)
        return SDFGI_OK;
    sdfgi_message_log(hooks, SDFGI_MESSAGE_UNSUPPORTED_DEVICE, "sdfgi_create: %s", requirements.reasons[0]);
    return SDFGI_ERROR_UNSUPPORTED;
}

static VkResult import_device(struct backend *backend, const struct sdfgi_desc *desc)
{
    const struct sdfgi_vulkan *v = &desc->vulkan;
    if (v->allocation_callbacks)
        backend->callbacks = *v->allocation_callbacks;
    const VkResult result =
        gpu_device_init(&backend->device, v->instance, v->physical_device, v->device, v->queue_family_index,
                        v->get_instance_proc_addr, v->allocation_callbacks ? &backend->callbacks : NULL);
    backend->device.pipeline_cache = desc->pipeline_cache;
    sdfgi_backend_set_allocator(backend, &desc->device_allocator);
    return result;
}

/* An instance does not tell for which version it was made. Drivers may: of a version that is too low, they
 * have no functions. vkCreateRenderPass2 came with Vulkan 1.2. */
static enum sdfgi_result check_api_version(struct sdfgi *gi, const struct sdfgi_vulkan *v)
{
    const bool shown_too_low = !gi->backend.device.fn.GetDeviceProcAddr(v->device, "vkCreateRenderPass2");
    if (v->api_version ? v->api_version >= GPU_API_VERSION : !shown_too_low)
        return SDFGI_OK;
    const unsigned minor = v->api_version ? VK_API_VERSION_MINOR(v->api_version) : 1;
    sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_UNSUPPORTED_DEVICE,
                      "sdfgi_create: vulkan.instance was made with VkApplicationInfo::apiVersion of at most "
                      "1.%u, needed is 1.%u",
                      minor, (unsigned)VK_API_VERSION_MINOR(GPU_API_VERSION));
    return SDFGI_ERROR_UNSUPPORTED;
}

static enum sdfgi_result check_queue_family(struct sdfgi *gi, const struct sdfgi_desc *desc)
{
    if (gi->backend.device.queue_flags & VK_QUEUE_COMPUTE_BIT)
        return SDFGI_OK;
    return sdfgi_message_invalid(
        &gi->backend.hooks,
        "sdfgi_create: vulkan.queue_family_index is %u, a family that the device lacks "
        "or that cannot compute",
        (unsigned)desc->vulkan.queue_family_index);
}

static enum sdfgi_result init(struct sdfgi *gi, const struct sdfgi_desc *desc)
{
    struct hooks *hooks = &gi->backend.hooks;
    enum sdfgi_result result = check_device(hooks, &desc->vulkan);
    if (result == SDFGI_OK)
        result = sdfgi_message_vulkan(hooks, import_device(&gi->backend, desc),
                                      "sdfgi_create: importing the device");
    if (result == SDFGI_OK)
        result = check_api_version(gi, &desc->vulkan);
    if (result == SDFGI_OK)
        result = check_queue_family(gi, desc);
    if (result == SDFGI_OK)
        result = sdfgi_message_vulkan(hooks, sdfgi_pipelines_init(&gi->backend), "sdfgi_create: layouts");
    if (result == SDFGI_OK && !desc->pipelines_later)
        result = sdfgi_message_vulkan(
            hooks, sdfgi_pipelines_require_all(&gi->backend, desc->settings ? desc->settings : &gi->settings),
            "sdfgi_create: pipelines");
    if (result == SDFGI_OK)
        result = sdfgi_message_vulkan(hooks, sdfgi_blank_set_init(&gi->backend, &gi->blank),
                                      "sdfgi_create: the blank set");
    if (result == SDFGI_OK && desc->settings)
        result = sdfgi_set_settings(gi, desc->settings);
    return result;
}

static void log_created(const struct sdfgi *gi, VkPhysicalDevice physical)
{
    VkPhysicalDeviceProperties properties;
    gi->backend.device.fn.GetPhysicalDeviceProperties(physical, &properties);
    sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_CREATED, "sdfgi_create: version %d.%d.%d on %s",
                      SDFGI_VERSION_MAJOR, SDFGI_VERSION_MINOR, SDFGI_VERSION_PATCH, properties.deviceName);
}

enum sdfgi_result sdfgi_create(const struct sdfgi_desc *desc, sdfgi **out)
{
    const struct hooks hooks = { .log = desc->log, .log_info = desc->log_info, .allocator = desc->allocator };
    const struct problem problem = desc_problem(desc);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &hooks, "sdfgi_create");
    struct sdfgi *gi = sdfgi_hooks_alloc_zeroed(&hooks, sizeof *gi);
    if (!gi || pthread_mutex_init(&gi->backend.lock, NULL) != 0) {
        sdfgi_hooks_free(&hooks, gi);
        sdfgi_message_log(&hooks, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "sdfgi_create: out of host memory");
        return SDFGI_ERROR_OUT_OF_MEMORY;
    }
    gi->backend.hooks = hooks;
    gi->backend.retired.frames_in_flight = desc->frames_in_flight ? desc->frames_in_flight : 2;
    sdfgi_settings_default(&gi->settings);
    sdfgi_scene_init(&gi->scene, &gi->backend);
    gi->scene.up_axis = desc->up_axis;
    gi->scene.left_handed = desc->left_handed;
    sdfgi_volume_init(&gi->volume, &gi->backend, &gi->scene);
    sdfgi_volume_reset(&gi->volume, NULL, &gi->settings);
    const enum sdfgi_result result = init(gi, desc);
    if (result != SDFGI_OK) {
        sdfgi_destroy(gi);
        return result;
    }
    log_created(gi, desc->vulkan.physical_device);
    *out = gi;
    return SDFGI_OK;
}

void sdfgi_destroy(sdfgi *gi)
{
    if (!gi)
        return;
    struct backend *backend = &gi->backend;
    /* Without a device nothing was made from it. */
    if (backend->device.handle) {
        sdfgi_preparation_finish(gi);
        sdfgi_volume_finish(&gi->volume);
        gpu_retire_all(&backend->retired);
        sdfgi_views_finish(backend, &gi->views);
        sdfgi_views_finish(backend, &gi->debug_views);
        sdfgi_scene_finish(&gi->scene);
        sdfgi_blank_set_finish(backend, &gi->blank);
        sdfgi_pipelines_finish(backend);
    }
    const struct hooks hooks = backend->hooks;
    pthread_mutex_destroy(&backend->lock);
    sdfgi_hooks_free(&hooks, gi);
}

/* ---- Settings */

/* The raster voxeliser draws, and stores from its shaders. */
static bool can_voxelize_by_raster(const struct gpu_device *device)
{
    return (device->queue_flags & VK_QUEUE_GRAPHICS_BIT) && device->features.fragmentStoresAndAtomics &&
           device->features.vertexPipelineStoresAndAtomics;
}

static enum sdfgi_result check_settings(struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    char error[160];
    if (!sdfgi_settings_validate(settings, error, sizeof error)) {
        sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_INVALID_SETTING, "sdfgi_set_settings: %s", error);
        return SDFGI_ERROR_INVALID_ARGUMENT;
    }
    if (sdfgi_settings_y_scale(settings) != 1 && sdfgi_up_vector(gi->scene.up_axis).y == 0) {
        sdfgi_message_log(
            &gi->backend.hooks, SDFGI_MESSAGE_INVALID_SETTING,
            "sdfgi_set_settings: sdfgi_y_scale is %g%%, must be 100%% where up_axis is +Z or -Z: "
            "cells are flattened along Y",
            100 * sdfgi_settings_y_scale(settings));
        return SDFGI_ERROR_INVALID_ARGUMENT;
    }
    if (settings->voxelizer == SDFGI_VOXELIZER_RASTER && !can_voxelize_by_raster(&gi->backend.device)) {
        sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_UNSUPPORTED_DEVICE,
                          "sdfgi_set_settings: sdfgi_voxelizer is raster, which needs a queue family with "
                          "graphics, fragmentStoresAndAtomics and vertexPipelineStoresAndAtomics");
        return SDFGI_ERROR_UNSUPPORTED;
    }
    return SDFGI_OK;
}

static void log_switched(const struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    const double mib = (double)sdfgi_backend_held(&gi->backend).total_bytes / (1024 * 1024);
    if (settings->enabled)
        sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_SWITCHED,
                          "sdfgi_set_settings: on, %u cascades of %u^3 cells; %.1f MiB are held",
                          (unsigned)settings->cascades, (unsigned)settings->resolution, mib);
    else
        sdfgi_message_log(
            &gi->backend.hooks, SDFGI_MESSAGE_SWITCHED, "sdfgi_set_settings: off; %.1f MiB are %s", mib,
            gi->volume.resources ? "kept, as prepared" : "held until the frames in flight are over");
}

/* New volumes: those that have been prepared, or else made now. */
static enum sdfgi_result replace_volumes(struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    enum sdfgi_result result = sdfgi_message_vulkan(
        &gi->backend.hooks, sdfgi_pipelines_require_all(&gi->backend, settings), "switching on: pipelines");
    if (result != SDFGI_OK)
        return result;
    struct resources *volumes = sdfgi_preparation_take(gi, settings);
    if (!volumes)
        result = sdfgi_resources_create(&gi->backend, settings, &volumes);
    if (result == SDFGI_OK)
        sdfgi_volume_reset(&gi->volume, volumes, settings);
    return result;
}

/* Makes, replaces, keeps or releases the volumes, as the settings call for. */
static enum sdfgi_result change_volumes(struct sdfgi *gi, const struct sdfgi_settings *settings)
{
    const struct resources *r = gi->volume.resources;
    const bool fit = r && sdfgi_settings_change(settings, &r->settings) != SETTINGS_ALL;
    if (settings->enabled && !fit) {
        const enum sdfgi_result result = replace_volumes(gi, settings);
        if (result != SDFGI_OK)
            return result;
    } else if (settings->enabled == gi->settings.enabled) {
        return SDFGI_OK;
    } else if (!settings->enabled && sdfgi_preparation_keeps(gi)) {
        sdfgi_volume_pause(&gi->volume);
    } else if (!settings->enabled) {
        sdfgi_volume_reset(&gi->volume, NULL, settings);
    }
    sdfgi_preparation_note(gi);
    memset(gi->passes, 0, sizeof gi->passes);
    log_switched(gi, settings);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_set_settings(sdfgi *gi, const struct sdfgi_settings *settings)
{
    if (gi->backend.hooks.device_lost)
        return SDFGI_ERROR_DEVICE_LOST;
    enum sdfgi_result result = check_settings(gi, settings);
    if (result == SDFGI_OK)
        result = change_volumes(gi, settings);
    if (result != SDFGI_OK)
        return result;
    /* The switch alone changes nothing that light depends on. */
    gi->settings.enabled = settings->enabled;
    if (sdfgi_settings_change(settings, &gi->settings) >= SETTINGS_LIGHT)
        sdfgi_volume_invalidate(&gi->volume);
    gi->settings = *settings;
    return SDFGI_OK;
}

void sdfgi_get_settings(const sdfgi *gi, struct sdfgi_settings *settings)
{
    *settings = gi->settings;
}

void sdfgi_reset(sdfgi *gi)
{
    const struct resources *r = gi->volume.resources;
    sdfgi_volume_forget(&gi->volume, r ? &r->settings : &gi->settings);
    /* To a new context all lights are new, too. */
    sdfgi_gathering_outdate(&gi->volume.state.gathering);
}

/* ---- Version */

uint32_t sdfgi_version(void)
{
    return SDFGI_VERSION;
}

/* ---- What hosts bind */

bool sdfgi_is_active(const sdfgi *gi)
{
    return gi->settings.enabled && gi->volume.state.updates > 0 && !gi->volume.state.paused;
}

VkDescriptorSetLayout sdfgi_get_descriptor_set_layout(const sdfgi *gi)
{
    return gi->backend.pipelines.sets[RESOURCE_SET_LOOKUP];
}

VkDescriptorSet sdfgi_get_descriptor_set(const sdfgi *gi)
{
    return sdfgi_is_active(gi) ? gi->volume.resources->sets[RESOURCE_SET_LOOKUP] : gi->blank.set;
}

bool sdfgi_is_software(const sdfgi *gi)
{
    return gi->backend.software;
}
