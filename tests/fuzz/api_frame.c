/* SPDX-License-Identifier: MIT
 * Frames, and calls that break a rule. */
#include "api_world.h"

#include "require.h"

#include <sdfgi/debug.h>
#include <sdfgi/inspect.h>

#include <float.h>
#include <math.h>

/* ---- Frames ----------------------------------------------------------------------------------------- */

static struct sdfgi_gather_desc gather_desc(struct api_world *w)
{
    return (struct sdfgi_gather_desc){
        .depth = w->device->depth.view,
        .normal = w->device->normal.view,
        .output = w->device->output.view,
        .width = API_PICTURE,
        .height = API_PICTURE,
        .inverse_view_projection = { 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1 },
        .background_depth = 1,
        .resolution = (enum sdfgi_gather_resolution)api_below(w, 3),
    };
}

static void record_debug(struct api_world *w, VkCommandBuffer cmd)
{
    const struct sdfgi_gather_desc gather = gather_desc(w);
    struct sdfgi_debug_desc desc = { .output = gather.output,
                                     .width = gather.width,
                                     .height = gather.height,
                                     .background_depth = gather.background_depth,
                                     .depth = gather.depth,
                                     .normal = gather.normal,
                                     .roughness = gather.normal,
                                     .input_layout = gather.input_layout,
                                     .view = (enum sdfgi_debug_view)api_below(w, SDFGI_DEBUG_VIEW_COUNT) };
    memcpy(desc.inverse_view_projection, gather.inverse_view_projection, sizeof desc.inverse_view_projection);
    REQUIRE_CMP((int)sdfgi_debug_draw(w->t->gi, cmd, &desc), ==, (int)SDFGI_OK);
}

static void record_copy(struct api_world *w, VkCommandBuffer cmd)
{
    const enum sdfgi_volume volume = (enum sdfgi_volume)api_below(w, SDFGI_VOLUME_COUNT);
    const uint64_t size = sdfgi_inspect_volume_size(w->t->gi, volume);
    REQUIRE_CMP(size, <=, (uint64_t)w->device->copy.size);
    const enum sdfgi_result result = sdfgi_inspect_copy(
        w->t->gi, cmd, api_below(w, w->scene.settings.cascades), volume, w->device->copy.buffer, 0);
    REQUIRE_TRUE(result == SDFGI_OK || result == SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(result != SDFGI_OK || size > 0);
}

static void record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    struct api_world *const w = user;
    (void)index;
    REQUIRE_CMP((int)sdfgi_update(w->t->gi, cmd, &w->t->frame), ==, (int)SDFGI_OK);
    REQUIRE_TRUE(sdfgi_is_active(w->t->gi) == w->scene.settings.enabled);
    for (uint32_t gathers = api_below(w, 4); gathers > 1; gathers--) {
        const struct sdfgi_gather_desc desc = gather_desc(w);
        REQUIRE_CMP((int)sdfgi_gather(w->t->gi, cmd, &desc), ==, (int)SDFGI_OK);
    }
    api_record_views(w, cmd);
    if (api_below(w, 8) == 0)
        record_copy(w, cmd);
    if (api_below(w, 8) == 0)
        record_debug(w, cmd);
}

static void check_report(struct api_world *w)
{
    static struct sdfgi_report report;
    sdfgi_get_report(w->t->gi, &report);
    REQUIRE_CMP(report.pass_count, <=, (uint32_t)SDFGI_MAX_PASSES);
    REQUIRE_CMP(report.health_count, <=, (uint32_t)SDFGI_MESSAGE_COUNT);
    REQUIRE_TRUE(report.converged_fraction >= 0 && report.converged_fraction <= 1);
    REQUIRE_TRUE(report.scroll.cells <= report.scroll.budget_cells || !w->scene.settings.enabled);
    uint64_t sum = 0;
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        sum += report.memory.bytes[i];
    REQUIRE_CMP(sum, ==, report.memory.total_bytes);
    REQUIRE_TRUE(report.memory.total_bytes > 0 || !w->scene.settings.enabled);
}

/* The first frame of all decides what exposure light is stored with, and those that are near change nothing:
 * a fresh context with an exposure of 1 stores the same. */
static void choose_exposure(struct api_world *w)
{
    const bool calm = w->calm > 0 || w->t->gi->volume.state.updates == 0;
    w->t->frame.exposure = calm ? 1 : (float)exp2(test_random_real(&w->random, -6, 6));
    w->calm -= w->calm > 0;
}

void api_frame(struct api_world *w)
{
    const uint32_t fate = api_below(w, 40);
    choose_exposure(w);
    w->t->frame.cut = api_below(w, 16) == 0;
    w->t->frame.forward_reflections = api_below(w, 4) == 0;
    if (fate < 4) { /* the swapchain was out of date */
        gpu_test_record_and_drop(&w->t->gpu, record, w);
        sdfgi_cancel_update(w->t->gi);
        if (fate == 0)
            sdfgi_cancel_update(w->t->gi);
    } else if (fate == 4) { /* and the host forgot to say so */
        gpu_test_record_and_drop(&w->t->gpu, record, w);
        w->calm = 4;
    } else {
        gpu_test_submit_many(&w->t->gpu, 1 + fate % 2, record, w);
    }
    check_report(w);
}

/* ---- Broken rules ----------------------------------------------------------------------------------- */

static float no_float(struct api_world *w)
{
    static const float values[] = { NAN, INFINITY, -INFINITY };
    return values[api_below(w, 3)];
}

static enum sdfgi_result wrong_material(struct api_world *w)
{
    struct sdfgi_material_desc desc = api_random_material(&w->random);
    sdfgi_material out = { 77 };
    float *const fields[] = { &desc.albedo[api_below(w, 3)], &desc.emission[api_below(w, 3)], &desc.alpha,
                              &desc.alpha_cutoff, &desc.albedo_texture.uv_transform[api_below(w, 6)] };
    *fields[api_below(w, 5)] = no_float(w);
    const enum sdfgi_result result = sdfgi_material_create(w->t->gi, &desc, &out);
    REQUIRE_CMP(out.id, ==, 77u);
    return result;
}

static enum sdfgi_result wrong_mesh(struct api_world *w)
{
    struct sdfgi_mesh_desc desc = w->device->shapes[api_below(w, API_SHAPES)];
    sdfgi_mesh out = { 77 };
    switch (api_below(w, 8)) {
    case 0:
        desc.position_buffer = VK_NULL_HANDLE;
        break;
    case 1:
        desc.vertex_count = 0;
        break;
    case 2:
        desc.triangle_count = 0;
        break;
    case 3:
        desc.index_buffer = VK_NULL_HANDLE;
        desc.triangle_count = desc.vertex_count / 3 + 1;
        break;
    case 4:
        desc.position_offset = 2;
        break;
    case 5:
        desc.position_stride = 4;
        break;
    case 6:
        desc.bounds_min[api_below(w, 3)] = FLT_MAX;
        break;
    default:
        desc.bounds_max[api_below(w, 3)] = no_float(w);
    }
    const enum sdfgi_result result = sdfgi_mesh_create(w->t->gi, &desc, &out);
    REQUIRE_CMP(out.id, ==, 77u);
    return result;
}

static enum sdfgi_result wrong_light(struct api_world *w)
{
    struct sdfgi_light_desc desc = api_random_light(&w->random);
    sdfgi_light out = { 77 };
    const uint32_t slot = api_below(w, API_LIGHTS);
    desc.type = SDFGI_LIGHT_SPOT;
    switch (api_below(w, 5)) {
    case 0:
        desc.position[api_below(w, 3)] = (double)no_float(w);
        break;
    case 1:
        desc.intensity[api_below(w, 3)] = -1;
        break;
    case 2:
        memset(desc.direction, 0, sizeof desc.direction);
        break;
    case 3:
        desc.outer_angle_rad = desc.inner_angle_rad;
        break;
    default:
        desc.type = (enum sdfgi_light_type)3;
    }
    if (w->scene.lights[slot].live && api_below(w, 2))
        return sdfgi_light_update(w->t->gi, w->scene.lights[slot].handle, &desc);
    const enum sdfgi_result result = sdfgi_light_create(w->t->gi, &desc, &out);
    REQUIRE_CMP(out.id, ==, 77u);
    return result;
}

static enum sdfgi_result wrong_transform(struct api_world *w)
{
    struct sdfgi_transform transform = api_random_transform(&w->random);
    const uint32_t slot = api_below(w, API_INSTANCES);
    if (api_below(w, 2))
        transform.basis[api_below(w, 9)] = no_float(w);
    else
        memset(transform.basis, 0, sizeof transform.basis);
    if (w->scene.instances[slot].live)
        return sdfgi_instance_set_transform(w->t->gi, w->scene.instances[slot].handle, &transform);
    struct sdfgi_instance_desc desc = { .mesh = w->scene.meshes[0].handle,
                                        .material = w->scene.materials[0].handle,
                                        .transform = transform };
    sdfgi_instance out = { 77 };
    const enum sdfgi_result result = sdfgi_instance_create(w->t->gi, &desc, &out);
    REQUIRE_CMP(out.id, ==, 77u);
    return result;
}

static uint32_t stale_id(struct api_world *w, const struct api_stale *stale)
{
    const uint32_t known = stale->count < API_STALE ? stale->count : API_STALE,
                   index = api_below(w, API_STALE);
    return index < known ? stale->ids[index] : index % 2 ? 0 : UINT32_MAX - index;
}

static enum sdfgi_result stale_handle(struct api_world *w)
{
    sdfgi *const gi = w->t->gi;
    const struct sdfgi_light_desc light = api_random_light(&w->random);
    const struct sdfgi_transform transform = api_random_transform(&w->random);
    const struct sdfgi_instance_desc desc = { .mesh = { stale_id(w, &w->meshes) },
                                              .material = { stale_id(w, &w->materials) },
                                              .transform = transform };
    sdfgi_instance out;
    const struct sdfgi_material_desc material = api_random_material(&w->random);
    switch (api_below(w, 8)) {
    case 0:
        return sdfgi_mesh_destroy(gi, (sdfgi_mesh){ stale_id(w, &w->meshes) });
    case 1:
        return sdfgi_material_destroy(gi, (sdfgi_material){ stale_id(w, &w->materials) });
    case 2:
        return sdfgi_instance_destroy(gi, (sdfgi_instance){ stale_id(w, &w->instances) });
    case 3:
        return sdfgi_light_destroy(gi, (sdfgi_light){ stale_id(w, &w->lights) });
    case 4:
        return sdfgi_light_update(gi, (sdfgi_light){ stale_id(w, &w->lights) }, &light);
    case 5:
        return sdfgi_material_update(gi, (sdfgi_material){ stale_id(w, &w->materials) }, &material);
    case 6:
        return sdfgi_instance_set_transform(gi, (sdfgi_instance){ stale_id(w, &w->instances) }, &transform);
    default:
        return sdfgi_instance_create(gi, &desc, &out);
    }
}

/* What no instance may be. */
static void spoil_instance(struct api_world *w, struct sdfgi_instance_desc *desc)
{
    switch (api_below(w, 5)) {
    case 0:
        desc->mesh.id = stale_id(w, &w->meshes);
        break;
    case 1:
        desc->material.id = stale_id(w, &w->materials);
        break;
    case 2:
        desc->transform.basis[api_below(w, 9)] = no_float(w);
        break;
    case 3:
        desc->transform.translation[api_below(w, 3)] = (double)no_float(w);
        break;
    default:
        desc->mobility = (enum sdfgi_mobility)2;
    }
}

/* One that is wrong among those that are not, wherever it stands: none is made, and no handle is written. */
static enum sdfgi_result wrong_instances(struct api_world *w)
{
    const uint32_t before = w->t->gi->scene.instances.count;
    struct sdfgi_instance_desc descs[API_INSTANCES + 1],
        last = { .transform = api_random_transform(&w->random) };
    sdfgi_instance out[API_INSTANCES + 1];
    uint32_t count = 0;
    for (uint32_t i = 0; i < API_INSTANCES; i++)
        if (w->scene.instances[i].live)
            last = descs[count++] = w->scene.instances[i].desc;
    const uint32_t at = api_below(w, count + 1);
    descs[count] = last;
    spoil_instance(w, &descs[at]);
    for (uint32_t i = 0; i <= count; i++)
        out[i].id = 77;
    const enum sdfgi_result result = sdfgi_instances_create(w->t->gi, count + 1, descs, out);
    REQUIRE_CMP(w->t->gi->scene.instances.count, ==, before);
    for (uint32_t i = 0; i <= count; i++)
        REQUIRE_CMP(out[i].id, ==, 77u);
    return result;
}

/* A handle that is stale, or there twice, among those that are live: none goes. */
static enum sdfgi_result wrong_destruction(struct api_world *w)
{
    const uint32_t before = w->t->gi->scene.instances.count;
    sdfgi_instance handles[API_INSTANCES + 1];
    uint32_t count = 0;
    for (uint32_t i = 0; i < API_INSTANCES; i++)
        if (w->scene.instances[i].live)
            handles[count++] = w->scene.instances[i].handle;
    const uint32_t at = api_below(w, count + 1);
    const bool stale = at == count || api_below(w, 2);
    handles[count].id = at == count ? 0 : handles[at].id;
    if (stale)
        handles[at].id = stale_id(w, &w->instances);
    const enum sdfgi_result result = sdfgi_instances_destroy(w->t->gi, count + 1, handles);
    REQUIRE_CMP(w->t->gi->scene.instances.count, ==, before);
    return result;
}

static enum sdfgi_result wrong_settings(struct api_world *w)
{
    struct sdfgi_settings s = w->scene.settings, found;
    switch (api_below(w, 4)) {
    case 0:
        s.resolution = 33;
        break;
    case 1:
        s.cascades = 9;
        break;
    case 2:
        s.energy = no_float(w);
        break;
    default:
        s.visibility = (enum sdfgi_visibility)2;
    }
    const enum sdfgi_result result = sdfgi_set_settings(w->t->gi, &s);
    sdfgi_get_settings(w->t->gi, &found);
    REQUIRE_TRUE(sdfgi_settings_change(&found, &w->scene.settings) == SETTINGS_SAME);
    return result;
}

static enum sdfgi_result wrong_numbers(struct api_world *w)
{
    struct sdfgi_frame_desc frame = w->t->frame;
    struct sdfgi_sky sky = w->scene.sky;
    const double low[3] = { 0, 0, 0 }, high[3] = { 1, (double)NAN, 1 };
    struct sdfgi_inspect_cascade cascade;
    /* Refused before anything is recorded. */
    const VkCommandBuffer none = (VkCommandBuffer)(uintptr_t)1;
    switch (api_below(w, 5)) {
    case 0:
        sky.horizon[api_below(w, 3)] = -1;
        return sdfgi_set_sky(w->t->gi, &sky);
    case 1:
        return sdfgi_invalidate_box(w->t->gi, low, high);
    case 2:
        frame.camera_position[api_below(w, 3)] = (double)no_float(w);
        return sdfgi_update(w->t->gi, none, &frame);
    case 3:
        frame.exposure = -1;
        return sdfgi_update(w->t->gi, none, &frame);
    default:
        return sdfgi_inspect_get_cascade(w->t->gi, 2, &cascade);
    }
}

void api_break_rule(struct api_world *w)
{
    static enum sdfgi_result (*const rules[])(struct api_world *) = {
        wrong_material, wrong_mesh,      wrong_light,       wrong_transform, stale_handle,
        wrong_settings, wrong_instances, wrong_destruction, wrong_numbers,   api_wrong_view,
    };
    const enum sdfgi_result result = rules[api_below(w, sizeof rules / sizeof *rules)](w);
    REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    w->refused++;
}
