/* SPDX-License-Identifier: MIT */
#include "resources.h"

#include "shaders/shared/bindings.h"

#include <assert.h>
#include <string.h>

#define BUFFER_USAGE                                                                                         \
    (VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |                               \
     VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |                                   \
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT)

/* How much of a buffer shaders may read as texels: all on software drivers. Elsewhere hosts read SEEN alone,
 * and a binding needs a word where low light is not in it. */
static uint64_t texel_bytes(const struct backend *backend, enum resource resource,
                            const struct extent *extent)
{
    if (sdfgi_pipelines_read_texels(backend, resource))
        return VK_WHOLE_SIZE;
    if (resource != RESOURCE_SEEN)
        return 0;
    const uint32_t most = backend->device.limits.maxTexelBufferElements;
    return sdfgi_low_light_begin(extent, most) > 0 ? sdfgi_resource_size(resource, extent) : sizeof(uint32_t);
}

static VkResult create_buffer(struct backend *backend, struct gpu_buffer *buffer, enum resource resource,
                              const struct extent *extent)
{
    const struct resource_row *row = sdfgi_resource_row(resource);
    const uint64_t texels = texel_bytes(backend, resource, extent);
    const VkResult result =
        sdfgi_backend_buffer_init(backend, buffer, sdfgi_resource_size(resource, extent),
                                  BUFFER_USAGE | (texels ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT : 0),
                                  GPU_DEVICE_LOCAL, row->category, row->name);
    if (result != VK_SUCCESS || !texels)
        return result;
    const VkResult viewed = gpu_buffer_view(&backend->device, buffer, row->texels, texels, row->name);
    if (viewed != VK_SUCCESS)
        sdfgi_backend_buffer_finish(backend, buffer, row->category);
    return viewed;
}

/* Zeros: memory that another context has used may hold the number of an update, and that update counts as
 * run. */
static VkResult create_readback(struct backend *backend, struct resources *r)
{
    const VkResult result = sdfgi_backend_buffer_init(
        backend, &r->readback, sdfgi_readback_size(backend->retired.frames_in_flight),
        VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_HOST_READ, SDFGI_MEMORY_READBACK, "sdfgi readback");
    return result == VK_SUCCESS ? gpu_buffer_zero(&backend->device, &r->readback) : result;
}

/* ---- Descriptor sets */

/* A pool for `sets` sets with one binding for each of `count` resources. */
static VkResult create_pool(const struct backend *backend, const char *name, uint32_t sets, uint32_t count,
                            VkDescriptorPool *pool)
{
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count },
        { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1 },
        { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, (backend->software ? count : 0) + 1 },
    };
    return sdfgi_backend_pool_create(backend, name, sets, sizes, 3, 0, pool);
}

static VkResult create_sets(const struct backend *backend, VkDescriptorPool *pool,
                            VkDescriptorSet sets[static RESOURCE_SET_COUNT])
{
    VkResult result = create_pool(backend, "sdfgi volume", RESOURCE_SET_COUNT, RESOURCE_COUNT, pool);
    for (int i = 0; i < RESOURCE_SET_COUNT && result == VK_SUCCESS; i++)
        result = sdfgi_backend_set_allocate(backend, sdfgi_resource_set_name((enum resource_set)i), *pool,
                                            backend->pipelines.sets[i], &sets[i]);
    return result;
}

static void write_texels(const struct backend *backend, VkDescriptorSet set, uint32_t binding,
                         VkBufferView texels)
{
    backend->device.fn.UpdateDescriptorSets(
        backend->device.handle, 1,
        &(VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                 .dstSet = set,
                                 .dstBinding = binding,
                                 .descriptorCount = 1,
                                 .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                 .pTexelBufferView = &texels },
        0, NULL);
}

static void write_binding(const struct backend *backend, VkDescriptorSet set, enum resource resource,
                          const struct gpu_buffer *buffer)
{
    const uint32_t binding = sdfgi_resource_row(resource)->binding;
    /* Not the whole: a buffer of texels may be a little longer than its elements, and than storage may be. */
    const VkDescriptorBufferInfo info = { buffer->handle, 0, buffer->size };
    const VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = set,
                                         .dstBinding = binding,
                                         .descriptorCount = 1,
                                         .descriptorType = sdfgi_resource_descriptor(resource),
                                         .pBufferInfo = &info };
    backend->device.fn.UpdateDescriptorSets(backend->device.handle, 1, &write, 0, NULL);
    if (sdfgi_pipelines_read_texels(backend, resource))
        write_texels(backend, set, SDFGI_BINDING_TEXELS + binding, buffer->texels);
}

static void write_sets(const struct backend *backend, const struct resources *r)
{
    for (int i = 0; i < RESOURCE_COUNT; i++)
        write_binding(backend, r->sets[sdfgi_resource_row((enum resource)i)->set], (enum resource)i,
                      &r->buffers[i]);
    write_texels(backend, r->sets[RESOURCE_SET_LOOKUP], SDFGI_BINDING_LOW_LIGHT,
                 r->buffers[RESOURCE_SEEN].texels);
}

/* ---- The raster voxeliser's target */

static VkResult create_framebuffer(const struct gpu_device *d, struct raster_target *target)
{
    const VkSubpassDescription subpass = { .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS };
    VkResult result = d->fn.CreateRenderPass(
        d->handle,
        &(VkRenderPassCreateInfo){
            .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO, .subpassCount = 1, .pSubpasses = &subpass },
        d->callbacks, &target->pass);
    result = gpu_named(d, result, VK_OBJECT_TYPE_RENDER_PASS, &target->pass, "sdfgi raster");
    if (result != VK_SUCCESS)
        return result;
    result = d->fn.CreateFramebuffer(
        d->handle,
        &(VkFramebufferCreateInfo){ .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                    .renderPass = target->pass,
                                    .width = target->extent,
                                    .height = target->extent,
                                    .layers = 1 },
        d->callbacks, &target->framebuffer);
    return gpu_named(d, result, VK_OBJECT_TYPE_FRAMEBUFFER, &target->framebuffer, "sdfgi raster");
}

/* ---- Life */

/* Besides the buffers, in the order in which they are made. */
enum { MAKE_READBACK, MAKE_SETS, MAKE_TIMER, MAKE_FRAMEBUFFER, MAKE_RASTER_PIPELINES };

static VkResult make_other(struct backend *backend, struct resources *r, uint32_t which)
{
    VkResult result;
    switch (which) {
    case MAKE_READBACK:
        return create_readback(backend, r);
    case MAKE_SETS:
        result = create_sets(backend, &r->pool, r->sets);
        if (result == VK_SUCCESS)
            write_sets(backend, r);
        return result;
    case MAKE_TIMER:
        return gpu_timer_init(&backend->device, &r->timer, backend->retired.frames_in_flight, r->timer_tags,
                              r->timer_counts);
    case MAKE_FRAMEBUFFER:
        r->raster.extent = r->settings.resolution * SDFGI_SUBVOXELS;
        return create_framebuffer(&backend->device, &r->raster);
    default:
        return sdfgi_pipelines_raster(backend, PASS_VOXELIZE_RASTER, which - MAKE_RASTER_PIPELINES,
                                      r->raster.pass, r->raster.extent,
                                      &r->raster.pipelines[which - MAKE_RASTER_PIPELINES]);
    }
}

uint32_t sdfgi_resources_object_count(const struct sdfgi_settings *settings)
{
    const bool raster = settings->voxelizer == SDFGI_VOXELIZER_RASTER;
    return RESOURCE_COUNT + (raster ? MAKE_RASTER_PIPELINES + PASS_VARIANTS : MAKE_FRAMEBUFFER);
}

VkResult sdfgi_resources_make_next(struct backend *backend, struct resources *r)
{
    assert(r->made < sdfgi_resources_object_count(&r->settings));
    const VkResult result = r->made < RESOURCE_COUNT ? create_buffer(backend, &r->buffers[r->made],
                                                                     (enum resource)r->made, &r->extent)
                                                     : make_other(backend, r, r->made - RESOURCE_COUNT);
    r->made += result == VK_SUCCESS;
    return result;
}

static void destroy(struct gpu_retired *item, void *user)
{
    struct backend *backend = user;
    struct resources *r = (struct resources *)item;
    const struct gpu_device *d = &backend->device;
    for (int i = 0; i < RESOURCE_COUNT; i++)
        sdfgi_backend_buffer_finish(backend, &r->buffers[i], sdfgi_resource_row((enum resource)i)->category);
    sdfgi_backend_buffer_finish(backend, &r->readback, SDFGI_MEMORY_READBACK);
    gpu_timer_finish(d, &r->timer);
    d->fn.DestroyDescriptorPool(d->handle, r->pool, d->callbacks);
    for (int v = 0; v < PASS_VARIANTS; v++)
        d->fn.DestroyPipeline(d->handle, r->raster.pipelines[v], d->callbacks);
    d->fn.DestroyFramebuffer(d->handle, r->raster.framebuffer, d->callbacks);
    d->fn.DestroyRenderPass(d->handle, r->raster.pass, d->callbacks);
    sdfgi_hooks_free(&backend->hooks, r);
}

_Static_assert(offsetof(struct resources, retired) == 0,
               "destroy() finds the resources by their first member");

/* A resource that is larger than the device's buffers; RESOURCE_COUNT: none. */
static enum resource too_large(const struct backend *backend, const struct extent *extent)
{
    int i = 0;
    while (i < RESOURCE_COUNT &&
           sdfgi_resource_size((enum resource)i, extent) <= backend->device.limits.maxStorageBufferRange)
        i++;
    return (enum resource)i;
}

static enum sdfgi_result check_sizes(const struct backend *backend, const struct extent *extent,
                                     const char *caller)
{
    struct extent most = *extent;
    sdfgi_extent_set_emits(&most);
    sdfgi_extent_set_low_light(&most);
    const enum resource resource = too_large(backend, &most);
    if (resource == RESOURCE_COUNT)
        return SDFGI_OK;
    return sdfgi_message_invalid(
        &backend->hooks,
        "%s: %s takes %llu bytes, maxStorageBufferRange is %u: lower sdfgi_resolution or sdfgi_cascades",
        caller, sdfgi_resource_row(resource)->name, (unsigned long long)sdfgi_resource_size(resource, &most),
        backend->device.limits.maxStorageBufferRange);
}

/* Light lists may grow as far as all that grows with them fits the device's buffers. */
static void limit_light_cells(const struct backend *backend, struct extent *extent)
{
    uint64_t fits = extent->light_cells, most = extent->light_cells_max;
    while (fits < most) {
        const uint64_t tried = most - (most - fits) / 2;
        struct extent grown = *extent;
        sdfgi_extent_set_light_cells(&grown, tried);
        if (too_large(backend, &grown) == RESOURCE_COUNT)
            fits = tried;
        else
            most = tried - 1;
    }
    extent->light_cells_max = fits;
}

enum sdfgi_result sdfgi_resources_begin(struct backend *backend, const struct sdfgi_settings *settings,
                                        struct scene_extent scene, const char *caller, struct resources **out)
{
    struct extent extent = sdfgi_extent_from_settings(settings);
    if (scene.instances > extent.instances)
        extent.instances = scene.instances;
    const enum sdfgi_result fits = check_sizes(backend, &extent, caller);
    if (fits != SDFGI_OK)
        return fits;
    limit_light_cells(backend, &extent);
    if (scene.emits)
        sdfgi_extent_set_emits(&extent);
    if (scene.low_light)
        sdfgi_extent_set_low_light(&extent);
    struct resources *r = sdfgi_hooks_alloc_zeroed(&backend->hooks, sizeof *r);
    if (!r)
        return sdfgi_message_vulkan(&backend->hooks, VK_ERROR_OUT_OF_HOST_MEMORY, caller);
    r->settings = *settings;
    r->extent = extent;
    *out = r;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_resources_create(struct backend *backend, const struct sdfgi_settings *settings,
                                         struct resources **out)
{
    struct resources *r;
    const enum sdfgi_result begun =
        sdfgi_resources_begin(backend, settings, (struct scene_extent){ 0 }, "switching on", &r);
    if (begun != SDFGI_OK)
        return begun;
    VkResult result = VK_SUCCESS;
    for (uint32_t i = sdfgi_resources_object_count(settings); i > 0 && result == VK_SUCCESS; i--)
        result = sdfgi_resources_make_next(backend, r);
    if (result != VK_SUCCESS) {
        destroy(&r->retired, backend);
        return sdfgi_message_vulkan(&backend->hooks, result, "switching on");
    }
    *out = r;
    return SDFGI_OK;
}

void sdfgi_resources_destroy(struct backend *backend, struct resources *resources)
{
    if (resources)
        destroy(&resources->retired, backend);
}

void sdfgi_resources_retire(struct backend *backend, struct resources *resources)
{
    if (resources)
        gpu_retire(&backend->retired, &resources->retired, destroy, backend);
}

/* ---- Buffers that grow */

/* What is as long as the light list, or grows with it. */
static const enum resource listed[] = { RESOURCE_LIGHT_CELLS, RESOURCE_DIRECT,   RESOURCE_LIGHT,
                                        RESOURCE_SURFACES,    RESOURCE_GATHERED, RESOURCE_SEEN,
                                        RESOURCE_SCRATCH };
/* What is there only if something emits, or is larger then. */
static const enum resource emitting[] = { RESOURCE_EMITTERS, RESOURCE_RAYS, RESOURCE_SCRATCH };
/* Larger if a view has reflections. */
static const enum resource reflecting[] = { RESOURCE_SEEN, RESOURCE_SCRATCH };

enum { MAX_GROWN = sizeof listed / sizeof *listed };

/* What larger buffers replace. */
struct outgrown {
    struct gpu_retired retired;
    const enum resource *which;
    uint32_t count;
    struct gpu_buffer buffers[MAX_GROWN];
    VkDescriptorPool pool;
};

_Static_assert(offsetof(struct outgrown, retired) == 0,
               "destroy_outgrown() finds the buffers by their first member");

static void destroy_outgrown(struct gpu_retired *item, void *user)
{
    struct backend *backend = user;
    struct outgrown *old = (struct outgrown *)item;
    for (uint32_t i = 0; i < old->count; i++)
        sdfgi_backend_buffer_finish(backend, &old->buffers[i], sdfgi_resource_row(old->which[i])->category);
    backend->device.fn.DestroyDescriptorPool(backend->device.handle, old->pool, backend->device.callbacks);
    sdfgi_hooks_free(&backend->hooks, old);
}

static VkResult create_grown(struct backend *backend, struct outgrown *grown, const struct extent *extent,
                             VkDescriptorSet sets[static RESOURCE_SET_COUNT])
{
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < grown->count && result == VK_SUCCESS; i++)
        result = create_buffer(backend, &grown->buffers[i], grown->which[i], extent);
    return result == VK_SUCCESS ? create_sets(backend, &grown->pool, sets) : result;
}

static void exchange(struct resources *r, struct outgrown *grown)
{
    for (uint32_t i = 0; i < grown->count; i++) {
        const struct gpu_buffer buffer = grown->buffers[i];
        grown->buffers[i] = r->buffers[grown->which[i]];
        r->buffers[grown->which[i]] = buffer;
    }
    const VkDescriptorPool pool = grown->pool;
    grown->pool = r->pool;
    r->pool = pool;
}

/* Makes some buffers anew with another extent. False, and nothing changes, if there is no memory. */
static bool grow(struct backend *backend, struct resources *r, const struct extent *extent,
                 const enum resource *which, uint32_t count)
{
    /* Made as what is to be destroyed, and exchanged for the old ones. */
    struct outgrown *grown = sdfgi_hooks_alloc_zeroed(&backend->hooks, sizeof *grown);
    if (!grown)
        return false;
    grown->which = which;
    grown->count = count;
    VkDescriptorSet sets[RESOURCE_SET_COUNT];
    if (create_grown(backend, grown, extent, sets) != VK_SUCCESS) {
        destroy_outgrown(&grown->retired, backend);
        return false;
    }
    exchange(r, grown);
    memcpy(r->sets, sets, sizeof sets);
    r->extent = *extent;
    write_sets(backend, r);
    if (r->used)
        gpu_retire(&backend->retired, &grown->retired, destroy_outgrown, backend);
    else
        destroy_outgrown(&grown->retired, backend);
    return true;
}

bool sdfgi_resources_grow_light_cells(struct backend *backend, struct resources *r, uint64_t light_cells)
{
    assert(light_cells > r->extent.light_cells && light_cells <= r->extent.light_cells_max);
    struct extent extent = r->extent;
    sdfgi_extent_set_light_cells(&extent, light_cells);
    return grow(backend, r, &extent, listed, MAX_GROWN);
}

bool sdfgi_resources_add_emitters(struct backend *backend, struct resources *r)
{
    struct extent extent = r->extent;
    sdfgi_extent_set_emits(&extent);
    return grow(backend, r, &extent, emitting, sizeof emitting / sizeof *emitting);
}

bool sdfgi_resources_add_low_light(struct backend *backend, struct resources *r)
{
    struct extent extent = r->extent;
    sdfgi_extent_set_low_light(&extent);
    return grow(backend, r, &extent, reflecting, sizeof reflecting / sizeof *reflecting);
}

bool sdfgi_resources_grow_instances(struct backend *backend, struct resources *r, uint64_t instances)
{
    static const enum resource which[] = { RESOURCE_INSTANCES };
    struct extent extent = r->extent;
    extent.instances = instances;
    return too_large(backend, &extent) == RESOURCE_COUNT && grow(backend, r, &extent, which, 1);
}

/* ---- The blank set */

/* Its texels have the format that they have when there is light: drivers compile a shader for formats. */
static VkResult view_blank(const struct backend *backend, struct blank_set *blank, enum resource resource)
{
    struct gpu_buffer shown = blank->buffer;
    const VkResult result = gpu_buffer_view(&backend->device, &shown, sdfgi_resource_row(resource)->texels,
                                            VK_WHOLE_SIZE, "sdfgi blank");
    blank->views[resource] = shown.texels;
    return result;
}

static VkResult fill_blank(const struct backend *backend, struct blank_set *blank, enum resource resource)
{
    const VkResult result =
        sdfgi_pipelines_read_texels(backend, resource) ? view_blank(backend, blank, resource) : VK_SUCCESS;
    struct gpu_buffer shown = blank->buffer;
    shown.texels = blank->views[resource];
    if (result == VK_SUCCESS)
        write_binding(backend, blank->set, resource, &shown);
    return result;
}

static VkResult fill_blank_low_light(const struct backend *backend, struct blank_set *blank)
{
    const VkResult result = view_blank(backend, blank, RESOURCE_SEEN);
    if (result == VK_SUCCESS)
        write_texels(backend, blank->set, SDFGI_BINDING_LOW_LIGHT, blank->views[RESOURCE_SEEN]);
    return result;
}

VkResult sdfgi_blank_set_init(struct backend *backend, struct blank_set *blank)
{
    const struct extent none = { 0 };
    const uint64_t bytes = sdfgi_resource_size(RESOURCE_FRAME, &none);
    const VkBufferUsageFlags usage = BUFFER_USAGE | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    VkResult result = gpu_buffer_init(&backend->device, &blank->buffer, bytes, usage, GPU_HOST_READ,
                                      SDFGI_MEMORY_CATEGORY_COUNT, "sdfgi blank");
    if (result == VK_SUCCESS)
        result = gpu_buffer_zero(&backend->device, &blank->buffer);
    if (result == VK_SUCCESS)
        result = create_pool(backend, "sdfgi blank", 1, sdfgi_resource_set_size(RESOURCE_SET_LOOKUP),
                             &blank->pool);
    if (result == VK_SUCCESS)
        result = sdfgi_backend_set_allocate(backend, "sdfgi blank", blank->pool,
                                            backend->pipelines.sets[RESOURCE_SET_LOOKUP], &blank->set);
    for (int i = 0; i < RESOURCE_COUNT && result == VK_SUCCESS; i++)
        if (sdfgi_resource_row((enum resource)i)->set == RESOURCE_SET_LOOKUP)
            result = fill_blank(backend, blank, (enum resource)i);
    return result == VK_SUCCESS ? fill_blank_low_light(backend, blank) : result;
}

void sdfgi_blank_set_finish(struct backend *backend, struct blank_set *blank)
{
    const struct gpu_device *d = &backend->device;
    d->fn.DestroyDescriptorPool(d->handle, blank->pool, d->callbacks);
    for (int i = 0; i < RESOURCE_COUNT; i++)
        d->fn.DestroyBufferView(d->handle, blank->views[i], d->callbacks);
    gpu_buffer_finish(d, &blank->buffer);
}
