/* SPDX-License-Identifier: MIT
 * Records a plan: uploads, then the list of work, then what goes back to the host. */
#include "frame.h"

#include "voxelize.h"

/* ---- Uploads: recorded inline, so that frames in flight never meet */

static void upload(struct pass_recorder *r, enum resource resource, uint64_t offset, uint64_t size,
                   const void *data)
{
    gpu_update(&r->gpu, &r->resources->buffers[resource], offset, size, data);
}

static void upload_lights(struct pass_recorder *r, const struct volume_state *state,
                          const struct pool *lights)
{
    enum { BATCH = 64 };
    struct sdfgi_light_params batch[BATCH];
    uint32_t filled = 0, done = 0;
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(LIGHTS));
    for (uint32_t i = 0; i < lights->end; i++) {
        const struct light *light = sdfgi_pool_at(lights, i);
        if (light)
            batch[filled++] = sdfgi_params_of_light(state, i, &light->desc);
        if (filled == BATCH || (i + 1 == lights->end && filled > 0)) {
            upload(r, RESOURCE_LIGHTS, done * sizeof *batch, filled * sizeof *batch, batch);
            done += filled;
            filled = 0;
        }
    }
}

static void upload_materials(struct pass_recorder *r, const struct scene *scene)
{
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(MATERIALS));
    for (uint32_t i = 0; i < scene->materials.end; i++) {
        const struct material *material = sdfgi_pool_at(&scene->materials, i);
        if (!material)
            continue;
        const struct sdfgi_material_params p = sdfgi_params_of_material(scene, &material->desc);
        upload(r, RESOURCE_MATERIALS, i * sizeof p, sizeof p, &p);
    }
}

/* Those that changed since the buffer was written last, newest first. Neighbours in the list are often
 * neighbours in the buffer, the other way round. */
static void upload_instances(struct pass_recorder *r, const struct scene *scene, const struct frame *frame)
{
    enum { BATCH = 128 };
    struct sdfgi_instance_params batch[BATCH];
    const uint64_t size = sizeof *batch, first = SDFGI_MAX_DRAWS * sizeof(uint32_t);
    const struct cascades *cascades = &frame->next.cascades;
    uint32_t filled = 0, lowest = 0;
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(INSTANCES));
    for (uint32_t link = scene->newest; link > 0;) {
        const struct instance *instance = sdfgi_pool_at(&scene->instances, link - 1);
        if (instance->revision <= frame->instances_since)
            break;
        if (filled == BATCH || (filled > 0 && link != lowest)) {
            upload(r, RESOURCE_INSTANCES, first + lowest * size, filled * size, batch + BATCH - filled);
            filled = 0;
        }
        if (link <= r->resources->extent.instances) {
            filled++;
            batch[BATCH - filled] = sdfgi_params_of_instance(cascades, scene, instance);
            lowest = link - 1;
        }
        link = instance->by_revision.after;
    }
    if (filled > 0)
        upload(r, RESOURCE_INSTANCES, first + lowest * size, filled * size, batch + BATCH - filled);
}

/* No workgroups, no rays: shaders/sdfgi/ray_queue.glsl. */
static void empty_ray_queue(struct pass_recorder *r)
{
    const uint32_t empty[4] = { 0, 1, 1, 0 };
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(INDIRECT));
    upload(r, RESOURCE_INDIRECT, 16 * SDFGI_INDIRECT_RAYS, sizeof empty, empty);
}

/* Neither workgroups nor visits: shaders/sdfgi/visit_list.comp. */
static void empty_visits(struct pass_recorder *r)
{
    const uint32_t empty[SDFGI_VISITS_RECORDS][4] = { { 0, 1, 1, 0 }, { 0, 1, 1, 0 }, { 0, 1, 1, 0 } };
    const struct extent *e = &r->resources->extent;
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(SEEN));
    upload(r, RESOURCE_SEEN, 4ull * sdfgi_seen_records((uint32_t)e->light_cells, (uint32_t)e->cascades),
           sizeof empty, empty);
}

static void record_uploads(struct pass_recorder *r, const struct frame *frame, const struct scene *scene)
{
    if (frame->uploads & FRAME_UPLOAD_PARAMS) {
        gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(FRAME));
        upload(r, RESOURCE_FRAME, 0, sizeof frame->next.params, &frame->next.params);
    }
    if (frame->uploads & FRAME_UPLOAD_RAY_QUEUE)
        empty_ray_queue(r);
    if (frame->uploads & FRAME_UPLOAD_VISITS)
        empty_visits(r);
    if (frame->uploads & FRAME_UPLOAD_LIGHTS)
        upload_lights(r, &frame->next, &scene->lights);
    if (frame->uploads & FRAME_UPLOAD_MATERIALS)
        upload_materials(r, scene);
    if (frame->uploads & FRAME_UPLOAD_INSTANCES)
        upload_instances(r, scene, frame);
}

/* ---- Work */

/* Records what a list begins with. Returns how many items. */
static uint32_t record_items(struct pass_recorder *r, const struct voxelizer *voxelizer,
                             const struct work *items, uint32_t count)
{
    if (items->kind == WORK_CLEAR || sdfgi_pass_row(items->pass)->domain != DOMAIN_INSTANCES)
        return sdfgi_pass_record_at_once(r, items, count);
    sdfgi_voxelize_record(voxelizer, items);
    return 1;
}

/* The counters, and the number that tells that this frame has run. */
static void record_readback(struct pass_recorder *r, uint32_t slot, uint32_t number)
{
    const struct extent *e = &r->resources->extent;
    const struct gpu_buffer *buffers = r->resources->buffers, *readback = &r->resources->readback;
    const uint64_t bytes = SDFGI_COUNTER_COUNT * sizeof(uint32_t),
                   own = SDFGI_COUNTER_GATHER * sizeof(uint32_t),
                   at = slot * (SDFGI_READBACK_WORDS * sizeof(uint32_t));
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, RESOURCE_BIT(COUNTERS) | RESOURCE_BIT(GATHERED), 0);
    gpu_copy(&r->gpu, &buffers[RESOURCE_COUNTERS], 0, readback, at, own);
    if (e->gathers)
        gpu_copy(&r->gpu, &buffers[RESOURCE_GATHERED], sdfgi_gather_counters_offset(e), readback, at + own,
                 bytes - own);
    gpu_update(&r->gpu, readback, at + bytes, sizeof number, &number);
}

void sdfgi_frame_record(const struct frame *frame, const struct scene *scene, struct pass_recorder *r,
                        struct draw_list *draws, uint32_t slot, uint32_t number)
{
    const struct voxelizer voxelizer = { r, scene, &frame->next.cascades, draws };
    const struct work_list *list = &frame->work;
    record_uploads(r, frame, scene);
    for (uint32_t i = 0; i < list->count;)
        i += record_items(r, &voxelizer, &list->items[i], list->count - i);
    sdfgi_pass_close(r);
    if (!frame->situation.converged)
        record_readback(r, slot, number);
}
