/* SPDX-License-Identifier: MIT
 * Device memory from a host's allocator. */
#include "backend.h"

static bool is_counted(const struct gpu_memory_request *request)
{
    return request->category < SDFGI_MEMORY_CATEGORY_COUNT;
}

/* What is wrong with a block; NULL if nothing is. */
static const char *fault_of(const struct sdfgi_memory_request *request,
                            const struct sdfgi_memory_block *block)
{
    if (!block->memory)
        return "memory is null";
    if (block->offset % request->requirements.alignment != 0)
        return "offset is not a multiple of requirements.alignment";
    if (request->mapped && !block->mapped)
        return "mapped is null, though it was asked for";
    return NULL;
}

static VkResult allocate(void *user, const struct gpu_memory_request *r, struct gpu_memory *memory)
{
    struct backend *backend = user;
    const struct sdfgi_device_allocator *a = &backend->device_allocator;
    const struct sdfgi_memory_request request = { .requirements = r->needs,
                                                  .required = r->required,
                                                  .preferred = r->preferred,
                                                  .mapped = r->mapped,
                                                  .buffer = r->buffer,
                                                  .image = r->image,
                                                  .category = (enum sdfgi_memory_category)r->category,
                                                  .bytes = is_counted(r) ? r->bytes : 0,
                                                  .name = r->name };
    struct sdfgi_memory_block block = { .memory = VK_NULL_HANDLE };
    const VkResult result = a->allocate(a->user, &request, &block);
    if (result != VK_SUCCESS)
        return result;
    const char *fault = fault_of(&request, &block);
    if (fault) {
        sdfgi_message_invalid(&backend->hooks, "device_allocator.allocate, for \"%s\": %s", r->name, fault);
        a->free(a->user, &block);
        return VK_ERROR_VALIDATION_FAILED_EXT;
    }
    memory->handle = block.memory;
    memory->offset = block.offset;
    memory->mapped = block.mapped;
    memory->allocation = block.allocation;
    return VK_SUCCESS;
}

static void release(void *user, const struct gpu_memory *memory)
{
    const struct backend *backend = user;
    const struct sdfgi_memory_block block = { memory->handle, memory->offset, memory->mapped,
                                              memory->allocation };
    backend->device_allocator.free(backend->device_allocator.user, &block);
}

void sdfgi_backend_set_allocator(struct backend *backend, const struct sdfgi_device_allocator *allocator)
{
    backend->device_allocator = *allocator;
    if (allocator->allocate)
        backend->device.allocator = (struct gpu_allocator){ allocate, release, backend };
}
