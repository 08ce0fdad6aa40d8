/* SPDX-License-Identifier: MIT */
#include "view.h"

#include "shaders/shared/bindings.h"

#include <stddef.h>

enum { MAX_BINDINGS = 7 };

static VkResult create_pool(const struct backend *backend, VkDescriptorPool *pool)
{
    const uint32_t sets = backend->retired.frames_in_flight;
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 3 * sets },
        { VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 3 * sets },
        { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, sets },
    };
    return sdfgi_backend_pool_create(backend, "sdfgi view", sets, sizes, 3, 0, pool);
}

static VkResult create_sets(const struct backend *backend, struct sdfgi_view *view)
{
    VkResult result = create_pool(backend, &view->pool);
    for (uint32_t f = 0; f < backend->retired.frames_in_flight && result == VK_SUCCESS; f++)
        result = sdfgi_backend_set_allocate(backend, "sdfgi view", view->pool, backend->pipelines.view,
                                            &view->sets[f]);
    return result;
}

static VkResult create_picture(struct backend *backend, const struct sdfgi_view *view,
                               struct gpu_image *image, const char *name)
{
    return sdfgi_backend_image_init(
        backend, image, VK_FORMAT_R16G16B16A16_SFLOAT, view->desc.width, view->desc.height,
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
        SDFGI_MEMORY_VIEWS, name);
}

static void finish_list(struct backend *backend, struct sdfgi_view **first);

static void destroy(struct gpu_retired *item, void *user)
{
    struct backend *backend = user;
    struct sdfgi_view *view = (struct sdfgi_view *)item;
    finish_list(backend, &view->resolves.of_gathers);
    sdfgi_backend_image_finish(backend, &view->diffuse, SDFGI_MEMORY_VIEWS);
    sdfgi_backend_image_finish(backend, &view->reflection, SDFGI_MEMORY_VIEWS);
    sdfgi_backend_image_finish(backend, &view->filtered, SDFGI_MEMORY_VIEWS);
    sdfgi_backend_buffer_finish(backend, &view->tiles, SDFGI_MEMORY_VIEWS);
    backend->device.fn.DestroyDescriptorPool(backend->device.handle, view->pool, backend->device.callbacks);
    sdfgi_hooks_free(&backend->hooks, view);
}

_Static_assert(offsetof(struct sdfgi_view, retired) == 0, "destroy() finds the view by its first member");

struct sdfgi_view *sdfgi_view_make(struct backend *backend, const struct sdfgi_view_desc *desc,
                                   VkResult *result)
{
    struct sdfgi_view *view = sdfgi_hooks_alloc_zeroed(&backend->hooks, sizeof *view);
    *result = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (!view)
        return NULL;
    view->desc = *desc;
    *result = desc->width > 0 ? create_picture(backend, view, &view->diffuse, "sdfgi diffuse")
                              : create_sets(backend, view);
    if (*result == VK_SUCCESS && desc->reflections)
        *result = sdfgi_view_add_reflection(backend, view);
    if (*result == VK_SUCCESS)
        return view;
    destroy(&view->retired, backend);
    return NULL;
}

static uint64_t squares(const struct sdfgi_view_desc *desc, uint32_t side)
{
    return ((uint64_t)desc->width + side - 1) / side * (((uint64_t)desc->height + side - 1) / side);
}

/* A list of all tiles, one of all pixels, and what the lobes of rough surfaces answer. */
static uint64_t tiles_size(const struct sdfgi_view_desc *desc)
{
    return sizeof(uint32_t) * (SDFGI_TILES_HEADER + squares(desc, SDFGI_GROUP_PIXELS) + squares(desc, 1) +
                               squares(desc, SDFGI_LOBE_STEP));
}

VkResult sdfgi_view_add_reflection(struct backend *backend, struct sdfgi_view *view)
{
    VkResult result = VK_SUCCESS;
    if (!view->reflection.handle)
        result = create_picture(backend, view, &view->reflection, "sdfgi reflection");
    if (result == VK_SUCCESS && !view->filtered.handle)
        result = create_picture(backend, view, &view->filtered, "sdfgi filtered");
    if (result == VK_SUCCESS && !view->tiles.handle)
        result = sdfgi_backend_buffer_init(
            backend, &view->tiles, tiles_size(&view->desc),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
            GPU_DEVICE_LOCAL, SDFGI_MEMORY_VIEWS, "sdfgi tiles");
    return result;
}

/* ---- Those of a context */

static void finish_list(struct backend *backend, struct sdfgi_view **first)
{
    for (struct sdfgi_view *view = *first, *next; view; view = next) {
        next = view->next;
        destroy(&view->retired, backend);
    }
    *first = NULL;
}

bool sdfgi_views_reflect(const struct views *views)
{
    const struct sdfgi_view *view = views->of_host;
    while (view && !view->tiles.handle)
        view = view->next;
    return view != NULL;
}

void sdfgi_views_finish(struct backend *backend, struct views *views)
{
    finish_list(backend, &views->of_gathers);
    finish_list(backend, &views->of_host);
}

struct sdfgi_view *sdfgi_views_next(struct backend *backend, struct views *views, VkResult *result)
{
    struct sdfgi_view **link = &views->of_gathers;
    *result = VK_SUCCESS;
    for (uint32_t i = 0; i < views->used; i++)
        link = &(*link)->next;
    if (!*link)
        *link = sdfgi_view_make(backend, &(struct sdfgi_view_desc){ 0 }, result);
    views->used += *link != NULL;
    return *link;
}

struct sdfgi_view *sdfgi_view_next_resolve(struct backend *backend, struct sdfgi_view *view, VkResult *result)
{
    if (view->frame != backend->retired.frame)
        view->resolves.used = 0;
    view->frame = backend->retired.frame;
    return sdfgi_views_next(backend, &view->resolves, result);
}

void sdfgi_views_retire(struct backend *backend, struct views *views, struct sdfgi_view *view)
{
    struct sdfgi_view **link = &views->of_host;
    while (*link && *link != view)
        link = &(*link)->next;
    if (!*link)
        return;
    *link = view->next;
    gpu_retire(&backend->retired, &view->retired, destroy, backend);
}

/* ---- Descriptors */

struct writes {
    VkWriteDescriptorSet items[MAX_BINDINGS];
    VkDescriptorImageInfo images[MAX_BINDINGS];
    uint32_t count;
};

static void add_image(struct writes *w, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                      VkImageView image, VkImageLayout layout)
{
    if (!image)
        return;
    w->images[w->count] = (VkDescriptorImageInfo){ VK_NULL_HANDLE, image, layout };
    w->items[w->count] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                                 .dstSet = set,
                                                 .dstBinding = binding,
                                                 .descriptorCount = 1,
                                                 .descriptorType = type,
                                                 .pImageInfo = &w->images[w->count] };
    w->count++;
}

void sdfgi_view_write_set(const struct backend *backend, const struct sdfgi_view *holder,
                          const struct sdfgi_view *view, const struct view_pictures *p)
{
    const VkDescriptorType in = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                           out = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    const VkImageLayout layout = p->input_layout ? p->input_layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkDescriptorSet set = holder->sets[sdfgi_backend_slot(backend)];
    const VkDescriptorBufferInfo tiles = { view->tiles.handle, 0, VK_WHOLE_SIZE };
    struct writes w = { .count = 0 };
    add_image(&w, set, SDFGI_BINDING_VIEW_DEPTH, in, p->depth, layout);
    add_image(&w, set, SDFGI_BINDING_VIEW_NORMAL, in, p->normal, layout);
    /* Some drivers look at what no shader reads: no binding may name a picture that is gone. Others stand for
     * what this resolve does without. */
    add_image(&w, set, SDFGI_BINDING_VIEW_ROUGHNESS, in, p->roughness ? p->roughness : p->depth, layout);
    add_image(&w, set, SDFGI_BINDING_VIEW_DIFFUSE, out, p->diffuse, VK_IMAGE_LAYOUT_GENERAL);
    add_image(&w, set, SDFGI_BINDING_VIEW_REFLECTION, out,
              view->reflects ? view->reflection.view : p->diffuse, VK_IMAGE_LAYOUT_GENERAL);
    add_image(&w, set, SDFGI_BINDING_VIEW_FILTERED, out, view->filtered.view, VK_IMAGE_LAYOUT_GENERAL);
    if (view->tiles.handle)
        w.items[w.count++] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                                     .dstSet = set,
                                                     .dstBinding = SDFGI_BINDING_VIEW_TILES,
                                                     .descriptorCount = 1,
                                                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                     .pBufferInfo = &tiles };
    backend->device.fn.UpdateDescriptorSets(backend->device.handle, w.count, w.items, 0, NULL);
}
