/* SPDX-License-Identifier: MIT
 * Everything the renderer asks of libsdfgi: the scene is registered once, then each frame records an update
 * and draws with the library's descriptor set. */
#include "host_internal.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct host_gi {
    struct host_device *device;
    sdfgi *context;
    pthread_t thread;     /* whose messages are told: one that prepares has none of its own */
    struct sdfgi_log log; /* of the host's caller */
    sdfgi_light suns[HOST_MAX_SUNS], *lamps; /* of the scene's lights */
    char last_error[160];                    /* the library's own words about its last error */
};

static void message_received(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    struct host_gi *gi = user;
    if (!pthread_equal(gi->thread, pthread_self()))
        return;
    /* An error comes with a result that says so: whoever gets that prints it, and prints it once. */
    if (level == SDFGI_LOG_ERROR)
        snprintf(gi->last_error, sizeof(gi->last_error), "%s", text);
    else if (gi->log.fn)
        gi->log.fn(gi->log.user, level, id, text);
}

static bool gi_check(struct host_gi *gi, enum sdfgi_result result, const char *what)
{
    if (result == SDFGI_OK)
        return true;
    host_fail(gi->device, "global illumination, %s: %s", what,
              gi->last_error[0] ? gi->last_error : "the library refused");
    gi->last_error[0] = '\0';
    return false;
}

static struct sdfgi_mesh_desc mesh_desc(const struct host_scene *scene, const struct host_primitive *p)
{
    const VkBuffer buffer = scene->geometry.buffer;
    struct sdfgi_mesh_desc desc = {
        .position_buffer = buffer,
        .position_offset = p->positions,
        .uv_buffer = buffer,
        .uv_offset = p->uv[scene->materials[p->material].gi_uv_set == 1],
        .color_buffer = p->has_colors ? buffer : VK_NULL_HANDLE,
        .color_offset = p->has_colors ? p->colors : 0,
        .index_buffer = buffer,
        .index_offset = p->indices,
        .index_type = VK_INDEX_TYPE_UINT32,
        .vertex_count = p->vertex_count,
        .triangle_count = p->index_count / 3,
    };
    memcpy(desc.bounds_min, p->bounds_min, sizeof(desc.bounds_min));
    memcpy(desc.bounds_max, p->bounds_max, sizeof(desc.bounds_max));
    return desc;
}

static struct sdfgi_transform transform_of(const struct host_instance *instance)
{
    struct sdfgi_transform out;
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++)
            out.basis[3 * column + row] = (float)instance->transform[4 * column + row];
        out.translation[column] = instance->transform[12 + column];
    }
    return out;
}

static bool all_zero(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (v[i] != 0.0f)
            return false;
    return true;
}

/* Meshes and instances that have shrunk to a point: the library refuses them. */
static bool is_point(const struct host_primitive *p, const struct sdfgi_transform *transform)
{
    return all_zero(transform->basis, 9) || (all_zero(p->bounds_min, 3) && all_zero(p->bounds_max, 3));
}

static bool geometry_register(struct host_gi *gi, const struct host_scene *scene,
                              const sdfgi_material *materials, sdfgi_mesh *meshes)
{
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct host_instance *instance = &scene->instances[i];
        const struct host_primitive *primitive = &scene->primitives[instance->primitive];
        sdfgi_mesh *mesh = &meshes[instance->primitive];
        sdfgi_instance unused;
        const struct sdfgi_transform transform = transform_of(instance);
        if (!scene->materials[primitive->material].casts_shadow || is_point(primitive, &transform))
            continue;
        if (mesh->id == 0) {
            const struct sdfgi_mesh_desc desc = mesh_desc(scene, primitive);
            if (!gi_check(gi, sdfgi_mesh_create(gi->context, &desc, mesh), "registering a mesh"))
                return false;
        }
        const struct sdfgi_instance_desc desc = { .mesh = *mesh,
                                                  .material = materials[primitive->material],
                                                  .transform = transform,
                                                  .mobility = SDFGI_STATIC };
        if (!gi_check(gi, sdfgi_instance_create(gi->context, &desc, &unused), "registering an instance"))
            return false;
    }
    return true;
}

static bool materials_register(struct host_gi *gi, const struct host_scene *scene, sdfgi_material *materials)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (!gi_check(gi, sdfgi_material_create(gi->context, &scene->materials[i].gi, &materials[i]),
                      "registering a material"))
            return false;
    }
    return true;
}

static struct sdfgi_light_desc light_desc(const struct host_scene_light *light)
{
    static const enum sdfgi_light_type types[] = { [HOST_LIGHT_POINT] = SDFGI_LIGHT_POINT,
                                                   [HOST_LIGHT_SPOT] = SDFGI_LIGHT_SPOT,
                                                   [HOST_LIGHT_DIRECTIONAL] = SDFGI_LIGHT_DIRECTIONAL };
    struct sdfgi_light_desc desc = { .type = types[light->type],
                                     .indirect_energy = 1.0f,
                                     .casts_shadow = true };
    for (int i = 0; i < 3; i++) {
        desc.position[i] = light->position[i];
        desc.direction[i] = (float)light->direction[i];
        desc.intensity[i] = light->intensity[i];
    }
    if (light->type != HOST_LIGHT_DIRECTIONAL)
        desc.range_m = light->range_m;
    if (light->type == HOST_LIGHT_SPOT) {
        desc.inner_angle_rad = light->inner_rad;
        desc.outer_angle_rad = light->outer_rad;
    }
    return desc;
}

static bool light_register(struct host_gi *gi, const struct host_scene_light *light, sdfgi_light *handle)
{
    const struct sdfgi_light_desc desc = light_desc(light);
    return gi_check(gi, sdfgi_light_create(gi->context, &desc, handle), "registering a light");
}

static bool lighting_register(struct host_gi *gi, const struct host_scene *scene)
{
    struct sdfgi_sky sky;
    memcpy(sky.zenith, scene->sky.zenith, sizeof(sky.zenith));
    memcpy(sky.horizon, scene->sky.horizon, sizeof(sky.horizon));
    memcpy(sky.ground, scene->sky.ground, sizeof(sky.ground));
    for (uint32_t i = 0; i < scene->sun_count; i++) {
        if (!light_register(gi, &scene->suns[i], &gi->suns[i]))
            return false;
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        if (!light_register(gi, &scene->lights[i], &gi->lamps[i]))
            return false;
    }
    return gi_check(gi, sdfgi_set_sky(gi->context, &sky), "setting the sky") &&
           (!scene->environment.exists ||
            gi_check(gi, sdfgi_set_sky_harmonics(gi->context, &scene->environment.harmonics),
                     "setting the environment"));
}

static bool scene_register(struct host_gi *gi, const struct host_scene *scene)
{
    sdfgi_material *materials = host_device_alloc(gi->device, scene->material_count, sizeof(*materials));
    sdfgi_mesh *meshes = host_device_alloc(gi->device, scene->primitive_count, sizeof(*meshes));
    const bool ok = materials && meshes && materials_register(gi, scene, materials) &&
                    geometry_register(gi, scene, materials, meshes) && lighting_register(gi, scene);
    free(materials);
    free(meshes);
    return ok;
}

static bool context_create(struct host_gi *gi, const struct host_renderer_desc *desc,
                           uint32_t frames_in_flight)
{
    const struct sdfgi_desc info = {
        .vulkan = { .instance = gi->device->instance,
                    .physical_device = gi->device->physical,
                    .device = gi->device->device,
                    .queue_family_index = gi->device->queue_family,
                    .get_instance_proc_addr = vkGetInstanceProcAddr },
        .frames_in_flight = frames_in_flight,
        .log = { message_received, gi },
        .pipeline_cache = gi->device->cache.handle,
        .pipelines_later = true, /* with GI off there are none */
    };
    return gi_check(gi, sdfgi_create(&info, &gi->context), "creating the context") &&
           (!desc->settings || host_gi_set_settings(gi, desc->settings));
}

struct host_gi *host_gi_create(struct host_device *device, const struct host_scene *scene,
                               const struct host_renderer_desc *desc, uint32_t frames_in_flight)
{
    struct host_gi *gi = host_device_alloc(device, 1, sizeof(*gi));
    if (!gi)
        return NULL;
    gi->device = device;
    gi->thread = pthread_self();
    gi->log = desc->log;
    gi->lamps = host_device_alloc(device, scene->light_count, sizeof(*gi->lamps));
    if (!gi->lamps || !context_create(gi, desc, frames_in_flight) || !scene_register(gi, scene)) {
        host_gi_destroy(gi);
        return NULL;
    }
    return gi;
}

void host_gi_destroy(struct host_gi *gi)
{
    if (!gi)
        return;
    sdfgi_destroy(gi->context);
    free(gi->lamps);
    free(gi);
}

sdfgi *host_gi_context(const struct host_gi *gi)
{
    return gi->context;
}

VkDescriptorSetLayout host_gi_layout(const struct host_gi *gi)
{
    return sdfgi_get_descriptor_set_layout(gi->context);
}

bool host_gi_is_software(const struct host_gi *gi)
{
    return sdfgi_is_software(gi->context);
}

VkDescriptorSet host_gi_set(const struct host_gi *gi)
{
    return sdfgi_is_active(gi->context) ? sdfgi_get_descriptor_set(gi->context) : VK_NULL_HANDLE;
}

static bool light_follow(struct host_gi *gi, const struct host_scene_light *light, sdfgi_light handle)
{
    const struct sdfgi_light_desc desc = light_desc(light);
    return gi_check(gi, sdfgi_light_update(gi->context, handle, &desc), "changing a light");
}

/* Lights that are as before cost the library nothing. */
static bool lights_follow(struct host_gi *gi, const struct host_scene *scene)
{
    bool ok = true;
    for (uint32_t i = 0; i < scene->sun_count && ok; i++)
        ok = light_follow(gi, &scene->suns[i], gi->suns[i]);
    for (uint32_t i = 0; i < scene->light_count && ok; i++)
        ok = light_follow(gi, &scene->lights[i], gi->lamps[i]);
    return ok;
}

bool host_gi_update(struct host_gi *gi, VkCommandBuffer cmd, const struct host_scene *scene,
                    const struct sdfgi_frame_desc *frame)
{
    return lights_follow(gi, scene) &&
           gi_check(gi, sdfgi_update(gi->context, cmd, frame), "recording an update");
}

sdfgi_view *host_gi_view_create(struct host_gi *gi, const struct sdfgi_view_desc *desc)
{
    sdfgi_view *view = NULL;
    gi_check(gi, sdfgi_view_create(gi->context, desc, &view), "creating a view");
    return view;
}

void host_gi_view_destroy(struct host_gi *gi, sdfgi_view *view)
{
    sdfgi_view_destroy(gi->context, view);
}

bool host_gi_resolve(struct host_gi *gi, sdfgi_view *view, VkCommandBuffer cmd,
                     const struct sdfgi_resolve_desc *desc)
{
    return gi_check(gi, sdfgi_view_resolve(gi->context, view, cmd, desc), "looking up light");
}

bool host_gi_debug(struct host_gi *gi, VkCommandBuffer cmd, const struct sdfgi_debug_desc *desc)
{
    return gi_check(gi, sdfgi_debug_draw(gi->context, cmd, desc), "drawing a debug view");
}

bool host_gi_set_settings(struct host_gi *gi, const struct sdfgi_settings *settings)
{
    return gi_check(gi, sdfgi_set_settings(gi->context, settings), "changing settings");
}

void host_gi_get_settings(const struct host_gi *gi, struct sdfgi_settings *settings)
{
    sdfgi_get_settings(gi->context, settings);
}

void host_gi_get_report(const struct host_gi *gi, struct sdfgi_report *report)
{
    sdfgi_get_report(gi->context, report);
}
