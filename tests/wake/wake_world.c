/* SPDX-License-Identifier: MIT */
#include "wake_world.h"

#include "require.h"
#include "shared_pipelines.h"

#include <stdio.h>
#include <vulkan/vulkan.h>

#define OK(call) REQUIRE_CMP((int)(call), ==, (int)SDFGI_OK)

/* ---- The world at first */

static void init_lights(struct wake_world *w)
{
    const struct sdfgi_light_desc light = { .position = { 0.5, 0.9, -0.2 },
                                            .direction = { 0.3f, -1, 0.3f },
                                            .intensity = { 5, 5, 5 },
                                            .inner_angle_rad = 0.2f,
                                            .outer_angle_rad = 0.8f,
                                            .indirect_energy = 1,
                                            .casts_shadow = true };
    for (int i = 0; i < WAKE_LIGHTS; i++) {
        w->lights[i] = light;
        w->lights[i].type = (enum sdfgi_light_type)i;
        w->light_exists[i] = true;
    }
    w->lights[SDFGI_LIGHT_SPOT].position[0] = -1.3;
}

static void init_materials(struct wake_world *w, const struct wake_device *device)
{
    for (int i = 0; i < WAKE_MATERIALS; i++)
        w->materials[i] = (struct sdfgi_material_desc){ .albedo = { 0.6f, 0.4f, 0.4f }, .alpha = 1 };
    struct sdfgi_material_desc *emitter = &w->materials[1], *textured = &w->materials[2],
                               *masked = &w->materials[3];
    emitter->emission[0] = emitter->emission[1] = 6;
    textured->emission[2] = 2;
    textured->emission_texture.view = device->textures[0].view;
    textured->albedo_texture.view = device->textures[1].view;
    masked->albedo_texture.view = device->textures[0].view;
    masked->emission_texture.view = device->textures[1].view;
    masked->emission[1] = 0.5f;
    masked->alpha_cutoff = 0.6f;
}

static void init_meshes(struct wake_world *w, const struct wake_device *device)
{
    w->meshes[0] =
        (struct sdfgi_mesh_desc){ .position_buffer = device->buffers[WAKE_ROOM_POSITIONS].buffer,
                                  .index_buffer = device->buffers[WAKE_ROOM_INDICES].buffer,
                                  .index_type = VK_INDEX_TYPE_UINT32,
                                  .vertex_count = (uint32_t)(device->buffers[WAKE_ROOM_POSITIONS].size / 12),
                                  .triangle_count = (uint32_t)(device->buffers[WAKE_ROOM_INDICES].size / 12),
                                  .bounds_min = { -3, -3, -3 },
                                  .bounds_max = { 3, 3, 3 } };
    for (int i = 1; i < WAKE_MESHES; i++)
        w->meshes[i] = (struct sdfgi_mesh_desc){
            .position_buffer = device->buffers[i == 1 ? WAKE_POSITIONS : WAKE_OTHER_POSITIONS].buffer,
            .uv_buffer = device->buffers[WAKE_UVS].buffer,
            .color_buffer = device->buffers[WAKE_COLORS].buffer,
            .index_buffer = device->buffers[i == 1 ? WAKE_INDICES : WAKE_OTHER_INDICES].buffer,
            .index_type = VK_INDEX_TYPE_UINT32,
            .vertex_count = 54,
            .triangle_count = 12,
            .bounds_min = { -1, -1, -1 },
            .bounds_max = { 1, 1, 1 }
        };
}

static void init_instances(struct wake_world *w)
{
    static const double places[WAKE_INSTANCES][3] = {
        { 0 }, { -1.1, -0.9, -1.1 }, { 0.9, -1.1, 0.8 }, { 0.2, 0.3, -0.8 }
    };
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++) {
        w->instances[i] =
            (struct sdfgi_instance_desc){ .mesh = { i == 0 ? 0 : 1 + i % 2 },
                                          .material = { i },
                                          .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } } };
        memcpy(w->instances[i].transform.translation, places[i], sizeof places[i]);
        w->instance_exists[i] = true;
    }
}

void wake_world_init(struct wake_world *w, const struct wake_device *device,
                     const struct sdfgi_settings *settings)
{
    memset(w, 0, sizeof *w);
    w->settings = *settings;
    w->sky = (struct sdfgi_sky){ { 0.3f, 0.3f, 1 }, { 1, 1, 1 }, { 0.3f, 0.3f, 0 } };
    init_lights(w);
    init_materials(w, device);
    init_meshes(w, device);
    init_instances(w);
}

/* ---- A context of a world */

static void log_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    if (level != SDFGI_LOG_INFO)
        require_fail(__FILE__, __LINE__, "message %d: %s", (int)id, text);
}

static void add_light(struct wake_context *c, const struct wake_world *w, uint32_t i)
{
    OK(sdfgi_light_create(c->gi, &w->lights[i], &c->lights[i]));
}

static void add_material(struct wake_context *c, const struct wake_world *w, uint32_t i)
{
    OK(sdfgi_material_create(c->gi, &w->materials[i], &c->materials[i]));
}

static void add_mesh(struct wake_context *c, const struct wake_world *w, uint32_t i)
{
    OK(sdfgi_mesh_create(c->gi, &w->meshes[i], &c->meshes[i]));
}

static void add_instance(struct wake_context *c, const struct wake_world *w, uint32_t i)
{
    struct sdfgi_instance_desc desc = w->instances[i];
    desc.mesh = c->meshes[desc.mesh.id];
    desc.material = c->materials[desc.material.id];
    OK(sdfgi_instance_create(c->gi, &desc, &c->instances[i]));
}

static void add_all(struct wake_context *c, const struct wake_world *w)
{
    OK(sdfgi_set_sky(c->gi, &w->sky));
    for (uint32_t i = 0; i < WAKE_MATERIALS; i++)
        add_material(c, w, i);
    for (uint32_t i = 0; i < WAKE_MESHES; i++)
        add_mesh(c, w, i);
    for (uint32_t i = 0; i < WAKE_LIGHTS; i++)
        if (w->light_exists[i])
            add_light(c, w, i);
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++)
        if (w->instance_exists[i])
            add_instance(c, w, i);
}

void wake_context_create(struct wake_context *c, struct wake_device *device, const struct wake_world *world)
{
    const struct gpu_test *gpu = &device->t.gpu;
    const struct sdfgi_desc desc = {
        .vulkan = { gpu->instance, gpu->physical_device, gpu->device, gpu->queue_family_index,
                    shared_pipelines_loader(), NULL },
        .settings = &world->settings,
        .log = { log_message, NULL },
    };
    memset(c, 0, sizeof *c);
    wake_device_write(device, &world->contents);
    OK(sdfgi_create(&desc, &c->gi));
    add_all(c, world);
}

/* ---- Changes */

struct following {
    struct wake_context *c;
    const struct wake_world *before, *after;
    bool new_first;
};

static void replace_instance(const struct following *f, uint32_t i)
{
    const sdfgi_instance old = f->c->instances[i];
    if (f->before->instance_exists[i] && !f->new_first)
        OK(sdfgi_instance_destroy(f->c->gi, old));
    if (f->after->instance_exists[i])
        add_instance(f->c, f->after, i);
    if (f->before->instance_exists[i] && f->new_first)
        OK(sdfgi_instance_destroy(f->c->gi, old));
}

static bool has_material(const struct wake_world *w, uint32_t instance, uint32_t material)
{
    return w->instance_exists[instance] && w->instances[instance].material.id == material;
}

static bool has_mesh(const struct wake_world *w, uint32_t instance, uint32_t mesh)
{
    return w->instance_exists[instance] && w->instances[instance].mesh.id == mesh;
}

/* Materials cannot go before their instances. They need not go either: `new_first` stands for an update. */
static void change_material(const struct following *f, uint32_t m)
{
    const sdfgi_material old = f->c->materials[m];
    if (f->new_first) {
        OK(sdfgi_material_update(f->c->gi, old, &f->after->materials[m]));
        return;
    }
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++)
        if (has_material(f->before, i, m))
            OK(sdfgi_instance_destroy(f->c->gi, f->c->instances[i]));
    OK(sdfgi_material_destroy(f->c->gi, old));
    add_material(f->c, f->after, m);
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++)
        if (has_material(f->before, i, m))
            add_instance(f->c, f->after, i);
}

/* Instances go with their mesh. */
static void replace_mesh(const struct following *f, uint32_t m)
{
    const sdfgi_mesh old = f->c->meshes[m];
    if (!f->new_first)
        OK(sdfgi_mesh_destroy(f->c->gi, old));
    add_mesh(f->c, f->after, m);
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++)
        if (has_mesh(f->before, i, m))
            add_instance(f->c, f->after, i);
    if (f->new_first)
        OK(sdfgi_mesh_destroy(f->c->gi, old));
}

static void change_instance(const struct following *f, uint32_t i)
{
    const struct sdfgi_instance_desc *before = &f->before->instances[i], *after = &f->after->instances[i];
    const bool moves = before->mesh.id == after->mesh.id && before->material.id == after->material.id &&
                       before->mobility == after->mobility;
    if (!f->after->instance_exists[i])
        return;
    if (moves)
        OK(sdfgi_instance_set_transform(f->c->gi, f->c->instances[i], &after->transform));
    else
        replace_instance(f, i);
}

static void change_light(const struct following *f, uint32_t i)
{
    const bool was = f->before->light_exists[i], is = f->after->light_exists[i];
    if (was && is) {
        OK(sdfgi_light_update(f->c->gi, f->c->lights[i], &f->after->lights[i]));
        return;
    }
    if (was)
        OK(sdfgi_light_destroy(f->c->gi, f->c->lights[i]));
    if (is)
        add_light(f->c, f->after, i);
}

/* ---- Changes behind the library's back */

static void invalidate_instance(const struct following *f, uint32_t i)
{
    const struct sdfgi_transform *t = &f->after->instances[i].transform;
    const struct sdfgi_mesh_desc *mesh = &f->after->meshes[f->after->instances[i].mesh.id];
    double low[3], high[3];
    for (int row = 0; row < 3; row++) {
        low[row] = high[row] = t->translation[row];
        for (int k = 0; k < 3; k++) {
            const double a = (double)t->basis[3 * k + row] * (double)mesh->bounds_min[k],
                         b = (double)t->basis[3 * k + row] * (double)mesh->bounds_max[k];
            low[row] += fmin(a, b);
            high[row] += fmax(a, b);
        }
    }
    OK(sdfgi_invalidate_box(f->c->gi, low, high));
}

static bool reads_buffer(const struct wake_world *w, uint32_t instance, VkBuffer buffer)
{
    const struct sdfgi_mesh_desc *mesh = &w->meshes[w->instances[instance].mesh.id];
    return mesh->position_buffer == buffer || mesh->uv_buffer == buffer || mesh->color_buffer == buffer ||
           mesh->index_buffer == buffer;
}

static bool reads_texture(const struct wake_world *w, uint32_t instance, VkImageView view)
{
    const struct sdfgi_material_desc *material = &w->materials[w->instances[instance].material.id];
    return material->albedo_texture.view == view || material->emission_texture.view == view;
}

static void change_buffer(const struct following *f, struct wake_device *device, uint32_t buffer)
{
    wake_device_write(device, &f->after->contents);
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++)
        if (f->after->instance_exists[i] && reads_buffer(f->after, i, device->buffers[buffer].buffer))
            invalidate_instance(f, i);
}

static void change_texture(const struct following *f, struct wake_device *device, uint32_t texture)
{
    wake_device_write(device, &f->after->contents);
    for (uint32_t i = 0; i < WAKE_INSTANCES; i++)
        if (f->after->instance_exists[i] && reads_texture(f->after, i, device->textures[texture].view))
            invalidate_instance(f, i);
}

void wake_context_follow(struct wake_context *c, struct wake_device *device, const struct wake_world *before,
                         const struct wake_world *after, enum wake_object object, uint32_t index,
                         bool new_first)
{
    const struct following f = { c, before, after, new_first };
    switch (object) {
    case WAKE_SETTINGS:
        OK(sdfgi_set_settings(c->gi, &after->settings));
        break;
    case WAKE_FRAME: /* given with the next update */
        break;
    case WAKE_SKY:
        OK(sdfgi_set_sky(c->gi, &after->sky));
        break;
    case WAKE_LIGHT:
    case WAKE_LIGHT_EXISTS:
        change_light(&f, index);
        break;
    case WAKE_MATERIAL:
        change_material(&f, index);
        break;
    case WAKE_MESH:
        replace_mesh(&f, index);
        break;
    case WAKE_INSTANCE:
        change_instance(&f, index);
        break;
    case WAKE_INSTANCE_EXISTS:
        replace_instance(&f, index);
        break;
    case WAKE_BUFFER_CONTENT:
        change_buffer(&f, device, index);
        break;
    case WAKE_TEXTURE_CONTENT:
        change_texture(&f, device, index);
        break;
    }
}
