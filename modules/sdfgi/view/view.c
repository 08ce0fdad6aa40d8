/* SPDX-License-Identifier: MIT */
#include "view.h"

#include "shaders/shared/bindings.h"

#include <math.h>
#include <string.h>

enum { GATHER_IMAGES = 3 };

/* ---- Views */

static VkResult create_pool(const struct backend *backend, VkDescriptorPool *pool)
{
    const uint32_t sets = backend->retired.frames_in_flight;
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * sets },
        { VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sets },
    };
    return sdfgi_backend_pool_create(backend, sets, sizes, 0, pool);
}

static void destroy(struct backend *backend, struct view *view)
{
    backend->device.fn.DestroyDescriptorPool(backend->device.handle, view->pool, backend->device.callbacks);
    sdfgi_hooks_free(&backend->hooks, view);
}

static struct view *create(struct backend *backend, VkResult *result)
{
    struct view *view = sdfgi_hooks_alloc_zeroed(&backend->hooks, sizeof *view);
    *result = view ? create_pool(backend, &view->pool) : VK_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t f = 0; f < backend->retired.frames_in_flight && *result == VK_SUCCESS; f++)
        *result = sdfgi_backend_set_allocate(backend, view->pool, backend->pipelines.view, &view->sets[f]);
    if (*result == VK_SUCCESS)
        return view;
    if (view)
        destroy(backend, view);
    return NULL;
}

void sdfgi_views_finish(struct backend *backend, struct views *views)
{
    for (struct view *view = views->first, *next; view; view = next) {
        next = view->next;
        destroy(backend, view);
    }
    views->first = NULL;
}

struct view *sdfgi_views_next(struct backend *backend, struct views *views, VkResult *result)
{
    struct view **link = &views->first;
    *result = VK_SUCCESS;
    for (uint32_t i = 0; i < views->used; i++)
        link = &(*link)->next;
    if (!*link)
        *link = create(backend, result);
    views->used += *link != NULL;
    return *link;
}

/* ---- Stage 8, diffuse, as a screen pass */

struct problem sdfgi_view_gather_problem(const struct sdfgi_gather_desc *d)
{
    struct problem p = { "" };
    if (!d->depth || !d->normal || !d->output)
        sdfgi_problem_add(&p, "%s is null", !d->depth ? "depth" : !d->normal ? "normal" : "output");
    if (d->width == 0 || d->height == 0)
        sdfgi_problem_add(&p, "%s is 0", d->width == 0 ? "width" : "height");
    if ((unsigned)d->resolution > SDFGI_GATHER_QUARTER)
        sdfgi_problem_add(&p, "resolution is %d, must be one of enum sdfgi_gather_resolution",
                          (int)d->resolution);
    sdfgi_problem_floats(&p, "inverse_view_projection", d->inverse_view_projection, 16, -INFINITY, INFINITY);
    sdfgi_problem_floats(&p, "scale", &d->scale, 1, 0, INFINITY);
    static const float zero[16];
    if (memcmp(zero, d->inverse_view_projection, sizeof zero) == 0)
        sdfgi_problem_add(&p, "inverse_view_projection is 0");
    return p;
}

void sdfgi_view_write_set(const struct backend *backend, const struct view *view,
                          const struct sdfgi_gather_desc *d)
{
    const VkImageLayout layout = d->input_layout ? d->input_layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkDescriptorImageInfo images[GATHER_IMAGES] = {
        [SDFGI_BINDING_GATHER_DEPTH] = { VK_NULL_HANDLE, d->depth, layout },
        [SDFGI_BINDING_GATHER_NORMAL] = { VK_NULL_HANDLE, d->normal, layout },
        [SDFGI_BINDING_GATHER_OUTPUT] = { VK_NULL_HANDLE, d->output, VK_IMAGE_LAYOUT_GENERAL },
    };
    VkWriteDescriptorSet writes[GATHER_IMAGES];
    for (uint32_t i = 0; i < GATHER_IMAGES; i++)
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = view->sets[sdfgi_backend_slot(backend)],
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = i == SDFGI_BINDING_GATHER_OUTPUT ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                               : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .pImageInfo = &images[i],
        };
    backend->device.fn.UpdateDescriptorSets(backend->device.handle, GATHER_IMAGES, writes, 0, NULL);
}

struct work sdfgi_view_gather_work(const struct sdfgi_gather_desc *d)
{
    static const uint32_t steps[] = {
        [SDFGI_GATHER_FULL] = 1, [SDFGI_GATHER_HALF] = 2, [SDFGI_GATHER_QUARTER] = SDFGI_SAMPLE_STEP_MAX
    };
    struct work work = {
        .pass = d->resolution == SDFGI_GATHER_FULL ? PASS_GATHER : PASS_GATHER_SPARSE,
        .indirect = WORK_DIRECT,
        .units = (uint64_t)d->width * d->height,
        .args.gather = { .width = d->width,
                         .height = d->height,
                         .background_depth = d->background_depth,
                         .step = steps[d->resolution],
                         .scale = d->scale > 0 ? d->scale : 1 },
    };
    memcpy(work.args.gather.inverse_view_projection, d->inverse_view_projection,
           sizeof work.args.gather.inverse_view_projection);
    return work;
}
