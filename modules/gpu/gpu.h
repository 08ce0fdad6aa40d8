/* SPDX-License-Identifier: MIT
 *
 * The thinnest Vulkan layer the passes need: functions of an imported device, buffers, images, pipelines, a
 * recorder that counts commands and places barriers, timestamps. Knows nothing of lighting. Functions that
 * can fail return a VkResult; destructors accept objects that were never or only half created.
 */
#ifndef GPU_H
#define GPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

#include "gpu_names.h"

/* The version of Vulkan that shaders and calls need. */
#define GPU_API_VERSION VK_API_VERSION_1_2

#define GPU_INSTANCE_FUNCTIONS(X)                                                                            \
    X(GetDeviceProcAddr)                                                                                     \
    X(GetPhysicalDeviceMemoryProperties)                                                                     \
    X(GetPhysicalDeviceProperties)                                                                           \
    X(GetPhysicalDeviceFeatures)                                                                             \
    X(GetPhysicalDeviceFormatProperties)                                                                     \
    X(GetPhysicalDeviceQueueFamilyProperties)

#define GPU_DEVICE_FUNCTIONS(X)                                                                              \
    X(AllocateDescriptorSets)                                                                                \
    X(AllocateMemory)                                                                                        \
    X(BindBufferMemory)                                                                                      \
    X(BindImageMemory)                                                                                       \
    X(CmdBeginRenderPass)                                                                                    \
    X(CmdBindDescriptorSets)                                                                                 \
    X(CmdBindPipeline)                                                                                       \
    X(CmdCopyBuffer)                                                                                         \
    X(CmdDispatch)                                                                                           \
    X(CmdDispatchIndirect)                                                                                   \
    X(CmdDraw)                                                                                               \
    X(CmdEndRenderPass)                                                                                      \
    X(CmdFillBuffer)                                                                                         \
    X(CmdPipelineBarrier)                                                                                    \
    X(CmdPushConstants)                                                                                      \
    X(CmdResetQueryPool)                                                                                     \
    X(CmdUpdateBuffer)                                                                                       \
    X(CmdWriteTimestamp)                                                                                     \
    X(CreateBuffer)                                                                                          \
    X(CreateBufferView)                                                                                      \
    X(CreateComputePipelines)                                                                                \
    X(CreateDescriptorPool)                                                                                  \
    X(CreateDescriptorSetLayout)                                                                             \
    X(CreateFramebuffer)                                                                                     \
    X(CreateGraphicsPipelines)                                                                               \
    X(CreateImage)                                                                                           \
    X(CreateImageView)                                                                                       \
    X(CreatePipelineLayout)                                                                                  \
    X(CreateQueryPool)                                                                                       \
    X(CreateRenderPass)                                                                                      \
    X(CreateSampler)                                                                                         \
    X(CreateShaderModule)                                                                                    \
    X(DestroyBuffer)                                                                                         \
    X(DestroyBufferView)                                                                                     \
    X(DestroyDescriptorPool)                                                                                 \
    X(DestroyDescriptorSetLayout)                                                                            \
    X(DestroyFramebuffer)                                                                                    \
    X(DestroyImage)                                                                                          \
    X(DestroyImageView)                                                                                      \
    X(DestroyPipeline)                                                                                       \
    X(DestroyPipelineLayout)                                                                                 \
    X(DestroyQueryPool)                                                                                      \
    X(DestroyRenderPass)                                                                                     \
    X(DestroySampler)                                                                                        \
    X(DestroyShaderModule)                                                                                   \
    X(FlushMappedMemoryRanges)                                                                               \
    X(FreeDescriptorSets)                                                                                    \
    X(FreeMemory)                                                                                            \
    X(GetBufferMemoryRequirements)                                                                           \
    X(GetImageMemoryRequirements)                                                                            \
    X(GetQueryPoolResults)                                                                                   \
    X(InvalidateMappedMemoryRanges)                                                                          \
    X(MapMemory)                                                                                             \
    X(UpdateDescriptorSets)

struct gpu_functions {
#define GPU_DECLARE(name) PFN_vk##name name;
    GPU_INSTANCE_FUNCTIONS(GPU_DECLARE)
    GPU_DEVICE_FUNCTIONS(GPU_DECLARE)
#undef GPU_DECLARE
    /* NULL unless the host enabled VK_EXT_debug_utils. */
    PFN_vkSetDebugUtilsObjectNameEXT SetDebugUtilsObjectNameEXT;
    PFN_vkCmdBeginDebugUtilsLabelEXT CmdBeginDebugUtilsLabelEXT;
    PFN_vkCmdEndDebugUtilsLabelEXT CmdEndDebugUtilsLabelEXT;
};

/* What an object needs memory for. */
struct gpu_memory_request {
    VkMemoryRequirements needs;
    VkMemoryPropertyFlags required, preferred;
    bool mapped;     /* the host reads or writes it */
    VkBuffer buffer; /* the object: this or that one */
    VkImage image;
    uint64_t bytes;    /* that the caller asked for; of an image those that it needs */
    uint32_t category; /* the caller's */
    const char *name;  /* static */
};

struct gpu_memory {
    VkDeviceMemory handle;
    VkDeviceSize offset, size;
    void *mapped; /* its first byte; NULL: it is not mapped */
    bool coherent;
    void *allocation; /* the allocator's */
};

/* Where memory comes from. `free` gets nothing but what `allocate` gave. */
struct gpu_allocator {
    VkResult (*allocate)(void *user, const struct gpu_memory_request *request, struct gpu_memory *memory);
    void (*free)(void *user, const struct gpu_memory *memory);
    void *user;
};

/* A device of the host's. */
struct gpu_device {
    struct gpu_functions fn;
    VkDevice handle;
    const VkAllocationCallbacks *callbacks; /* may be NULL */
    VkPipelineCache pipeline_cache;         /* for every pipeline; may be VK_NULL_HANDLE. Set it after init */
    struct gpu_allocator allocator;         /* NULL: each object gets memory of its own. Set it after init */
    VkPhysicalDeviceMemoryProperties memory;
    VkPhysicalDeviceLimits limits;
    VkQueueFlags queue_flags;          /* of the queue family; 0: there is no such family */
    uint32_t timestamp_bits;           /* of it; 0: no timestamps */
    bool is_cpu;                       /* a software driver: few threads run at once */
    VkPhysicalDeviceFeatures features; /* that it has: which of them the host enabled, nobody can ask */
};

/* Loads functions of an instance; false if one is missing. */
bool gpu_functions_load_instance(struct gpu_functions *fn, VkInstance instance,
                                 PFN_vkGetInstanceProcAddr get);

/* Imports a device. VK_ERROR_INITIALIZATION_FAILED if a core function is missing. */
VkResult gpu_device_init(struct gpu_device *device, VkInstance instance, VkPhysicalDevice physical,
                         VkDevice handle, uint32_t queue_family, PFN_vkGetInstanceProcAddr get,
                         const VkAllocationCallbacks *callbacks);

/* Names what a call has made, if `result` says that it has, for debuggers; `handle` points to it. Does
 * nothing without VK_EXT_debug_utils. Returns `result`. */
VkResult gpu_named(const struct gpu_device *device, VkResult result, VkObjectType type, const void *handle,
                   const char *name);

/* ---- Memory: gpu_memory.c */

struct gpu_buffer {
    VkBuffer handle;
    VkBufferView texels;      /* of the whole buffer; VK_NULL_HANDLE: it has none */
    struct gpu_memory memory; /* mapped: host-visible buffers only */
    uint64_t size;
};

struct gpu_image {
    VkImage handle;
    VkImageView view;
    struct gpu_memory memory;
    uint64_t size;
};

enum gpu_placement { GPU_DEVICE_LOCAL, GPU_HOST_READ };

/* `category` and `name` are for the allocator. */
VkResult gpu_buffer_init(const struct gpu_device *device, struct gpu_buffer *buffer, uint64_t size,
                         VkBufferUsageFlags usage, enum gpu_placement placement, uint32_t category,
                         const char *name);
/* Has shaders read a buffer's first bytes, or VK_WHOLE_SIZE, as texels, too. `usage` must have said so. */
VkResult gpu_buffer_view(const struct gpu_device *device, struct gpu_buffer *buffer, VkFormat format,
                         VkDeviceSize bytes, const char *name);
void gpu_buffer_finish(const struct gpu_device *device, struct gpu_buffer *buffer);

/* Fills a host-visible buffer with zeros that the device sees in all work submitted later. */
VkResult gpu_buffer_zero(const struct gpu_device *device, const struct gpu_buffer *buffer);

/* Makes what the device wrote to a host-visible buffer visible to the host. */
VkResult gpu_buffer_invalidate(const struct gpu_device *device, const struct gpu_buffer *buffer);

/* A 2D image, or an array if there are several layers, device local, with a view of all layers. */
VkResult gpu_image_init(const struct gpu_device *device, struct gpu_image *image, VkFormat format,
                        uint32_t width, uint32_t height, uint32_t layers, VkImageUsageFlags usage,
                        uint32_t category, const char *name);
void gpu_image_finish(const struct gpu_device *device, struct gpu_image *image);

/* ---- Pipelines: gpu_pipeline.c */

struct gpu_shader {
    const uint32_t *code;
    size_t size; /* bytes */
};

VkResult gpu_compute_pipeline_create(const struct gpu_device *device, struct gpu_shader shader,
                                     VkPipelineLayout layout, const char *name, VkPipeline *pipeline);

/* Triangles into a render pass without attachments, `extent` pixels a side, neither culled nor clipped in
 * depth. */
VkResult gpu_raster_pipeline_create(const struct gpu_device *device, struct gpu_shader vertex,
                                    struct gpu_shader fragment, VkPipelineLayout layout,
                                    VkRenderPass render_pass, uint32_t extent, const char *name,
                                    VkPipeline *pipeline);

/* ---- Recording: gpu_recorder.c */

/* What a command does with the resources it names. */
enum gpu_usage {
    GPU_USAGE_COMPUTE,  /* shader reads and writes */
    GPU_USAGE_GRAPHICS, /* the same, from vertex and fragment shaders */
    GPU_USAGE_TRANSFER, /* fills, updates and copies */
    GPU_USAGE_INDIRECT, /* indirect arguments, besides compute */
    GPU_USAGE_COUNT,
};

/* Resources are bits of a mask, chosen by the caller. A barrier is placed before a command whose reads meet
 * earlier writes, or whose writes meet earlier reads or writes. */
struct gpu_recorder {
    const struct gpu_device *device;
    VkCommandBuffer cmd;
    uint32_t command_count;
    bool begun;             /* the barrier against earlier work has been placed */
    uint64_t reads, writes; /* since the last barrier */
    VkPipelineStageFlags stages;
    VkAccessFlags write_access;
};

void gpu_recorder_begin(struct gpu_recorder *rec, const struct gpu_device *device, VkCommandBuffer cmd);

/* Makes all that was written visible to anything later in the queue. */
void gpu_recorder_end(struct gpu_recorder *rec);

/* Has what is recorded from here on wait for all that writes what it reads or writes, and for all that reads
 * what it writes. */
void gpu_order(struct gpu_recorder *rec, enum gpu_usage usage, uint64_t reads, uint64_t writes);
/* Declares what the next command touches, and orders it. */
void gpu_use(struct gpu_recorder *rec, enum gpu_usage usage, uint64_t reads, uint64_t writes);
/* Declares it for a command that the caller has ordered. */
void gpu_touch(struct gpu_recorder *rec, enum gpu_usage usage, uint64_t reads, uint64_t writes);

void gpu_label_begin(struct gpu_recorder *rec, const char *name);
void gpu_label_end(struct gpu_recorder *rec);
void gpu_fill(struct gpu_recorder *rec, const struct gpu_buffer *buffer, uint64_t offset, uint64_t size,
              uint32_t value);
/* Any size that is a multiple of 4; recorded inline, so `data` may be freed afterwards. */
void gpu_update(struct gpu_recorder *rec, const struct gpu_buffer *buffer, uint64_t offset, uint64_t size,
                const void *data);
void gpu_copy(struct gpu_recorder *rec, const struct gpu_buffer *from, uint64_t from_offset,
              const struct gpu_buffer *to, uint64_t to_offset, uint64_t size);
enum { GPU_MOST_IMAGES = 3 };
/* Brings up to GPU_MOST_IMAGES images into the layout GENERAL, from any other. What they hold is lost. */
void gpu_images_to_general(struct gpu_recorder *rec, const struct gpu_image *const images[], uint32_t count);
void gpu_bind_pipeline(struct gpu_recorder *rec, VkPipelineBindPoint point, VkPipeline pipeline);
void gpu_bind_set(struct gpu_recorder *rec, VkPipelineBindPoint point, VkPipelineLayout layout,
                  uint32_t index, VkDescriptorSet set);
void gpu_push(struct gpu_recorder *rec, VkPipelineLayout layout, uint32_t size, const void *data);
void gpu_dispatch(struct gpu_recorder *rec, uint32_t x, uint32_t y, uint32_t z);
void gpu_dispatch_indirect(struct gpu_recorder *rec, const struct gpu_buffer *arguments, uint64_t offset);
void gpu_draw(struct gpu_recorder *rec, uint32_t vertices, uint32_t instances);
/* A render pass over `extent` pixels a side without attachments. */
void gpu_render_pass_begin(struct gpu_recorder *rec, VkRenderPass pass, VkFramebuffer framebuffer,
                           uint32_t extent);
void gpu_render_pass_end(struct gpu_recorder *rec);

/* ---- Timestamps: gpu_timer.c */

enum {
    GPU_TIMER_STAMPS = 512,         /* per frame; what runs after the last of them is not timed */
    GPU_TIMER_NOTHING = 0x7fffffff, /* a tag: what runs until the next stamp is not timed */
};

/* From one stamp to the next. */
struct gpu_timer_span {
    uint32_t tag; /* the caller's */
    uint64_t ns;
};

/* Stamps of the frames in flight, each in a slot. */
struct gpu_timer {
    VkQueryPool pool; /* null: no timestamps on this queue */
    uint32_t slots, slot;
    uint32_t end;     /* of the stamps in the slot that have been reset */
    uint32_t *tags;   /* slots * GPU_TIMER_STAMPS */
    uint32_t *counts; /* per slot */
};

/* `tags` holds slots * GPU_TIMER_STAMPS and `counts` slots elements; both stay the caller's. */
VkResult gpu_timer_init(const struct gpu_device *device, struct gpu_timer *timer, uint32_t slots,
                        uint32_t *tags, uint32_t *counts);
void gpu_timer_finish(const struct gpu_device *device, struct gpu_timer *timer);

/* Reads the spans last recorded in `slot`, whose frame must be over. `*count` says how many were written to
 * `spans`: none on failure, and none where the device has no times. */
VkResult gpu_timer_read(const struct gpu_device *device, const struct gpu_timer *timer, uint32_t slot,
                        struct gpu_timer_span spans[GPU_TIMER_STAMPS], uint32_t *count);

/* Starts recording into `slot`, forgetting what it held. */
void gpu_timer_begin_frame(struct gpu_timer *timer, uint32_t slot);
/* Before the first stamp that a command buffer takes, `most` at most. One reset for all of them: between
 * passes each would have the device wait. */
void gpu_timer_reset(struct gpu_timer *timer, struct gpu_recorder *rec, uint32_t most);
/* Ends the span of the stamp before, and begins that of `tag`. The last stamp in a command buffer has the tag
 * GPU_TIMER_NOTHING. */
void gpu_timer_stamp(struct gpu_timer *timer, struct gpu_recorder *rec, uint32_t tag);

/* ---- Deferred destruction: gpu_retire.c */

/* Lies in an object that frames in flight may still use, so that retiring it needs no memory. */
struct gpu_retired {
    struct gpu_retired *next;
    uint64_t frame; /* in which it was retired */
    void (*destroy)(struct gpu_retired *item, void *user);
    void *user;
};

struct gpu_retire_queue {
    struct gpu_retired *first;
    uint64_t frame; /* the caller counts frames here */
    uint32_t frames_in_flight;
};

/* Has `destroy` called once no frame in flight can use the object. `destroy` frees the item too. */
void gpu_retire(struct gpu_retire_queue *queue, struct gpu_retired *item,
                void (*destroy)(struct gpu_retired *item, void *user), void *user);
/* Destroys what no frame in flight can use any more. */
void gpu_retire_collect(struct gpu_retire_queue *queue);
/* Destroys all. The device must be idle. */
void gpu_retire_all(struct gpu_retire_queue *queue);

#endif
