/* SPDX-License-Identifier: MIT
 * What the files of the Vulkan that draws nothing share. */
#ifndef NULL_VULKAN_H
#define NULL_VULKAN_H

#define VK_NO_PROTOTYPES
#include "fault.h"

#include <stdbool.h>
#include <stddef.h>

/* X(kind): objects with a life of their own. */
#define NULL_DEVICE_KINDS(X)                                                                                 \
    X(Buffer)                                                                                                \
    X(BufferView)                                                                                            \
    X(CommandPool)                                                                                           \
    X(DescriptorPool)                                                                                        \
    X(DescriptorSetLayout)                                                                                   \
    X(Fence)                                                                                                 \
    X(Framebuffer)                                                                                           \
    X(Image)                                                                                                 \
    X(ImageView)                                                                                             \
    X(Pipeline)                                                                                              \
    X(PipelineCache)                                                                                         \
    X(PipelineLayout)                                                                                        \
    X(QueryPool)                                                                                             \
    X(RenderPass)                                                                                            \
    X(Sampler)                                                                                               \
    X(ShaderModule)

#define NULL_KINDS(X)                                                                                        \
    NULL_DEVICE_KINDS(X)                                                                                     \
    X(Instance)                                                                                              \
    X(PhysicalDevice)                                                                                        \
    X(Device)                                                                                                \
    X(Queue)                                                                                                 \
    X(CommandBuffer)                                                                                         \
    X(DescriptorSet)                                                                                         \
    X(DeviceMemory)

enum null_kind {
#define KIND(kind) NULL_##kind,
    NULL_KINDS(KIND)
#undef KIND
        NULL_KIND_COUNT
};

struct null_object {
    enum null_kind kind;
    bool alive;
    const void *owner;          /* dies with it */
    uint64_t size;              /* of buffers, images and memory */
    char *bytes;                /* of memory that is mapped */
    struct null_object *memory; /* of buffers */
};

/* NULL if there are too many. */
struct null_object *null_object_add(enum null_kind kind, const void *owner);
/* NULL, and a line of the report, unless `handle` is such an object and lives. */
struct null_object *null_object_get(const void *handle, enum null_kind kind);
/* Accepts NULL. */
void null_object_remove(const void *handle, enum null_kind kind);

#endif
