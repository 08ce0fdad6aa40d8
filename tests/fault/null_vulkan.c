/* SPDX-License-Identifier: MIT
 * A Vulkan that draws nothing: objects are counted, memory that the host maps is there, most commands are
 * ignored.
 * The functions that can fail are in the table of fallible_vulkan.h; each asks fault_vulkan first. */
#define _GNU_SOURCE
#include "null_vulkan.h"

#include <string.h>
#include <sys/mman.h>

/* ---- Objects ----------------------------------------------------------------------------------------- */

enum { OBJECTS_MAX = 1 << 14 };

static const char *const kind_names[NULL_KIND_COUNT] = {
#define NAME(kind) [NULL_##kind] = #kind,
    NULL_KINDS(NAME)
#undef NAME
};

/* A dispatchable handle points to one of these, so does any other. */
static struct null_object objects[OBJECTS_MAX];
static uint32_t object_count;

struct null_object *null_object_add(enum null_kind kind, const void *owner)
{
    if (object_count == OBJECTS_MAX) {
        fault_misuse("more than %d objects", OBJECTS_MAX);
        return NULL;
    }
    struct null_object *object = &objects[object_count++];
    *object = (struct null_object){ .kind = kind, .alive = true, .owner = owner };
    return object;
}

struct null_object *null_object_get(const void *handle, enum null_kind kind)
{
    struct null_object *object = (struct null_object *)handle;
    const bool known = object >= objects && object < objects + object_count;
    if (known && object->alive && object->kind == kind)
        return object;
    fault_misuse("%s that %s", kind_names[kind], known && object->kind == kind ? "is destroyed" : "is none");
    return NULL;
}

void null_object_remove(const void *handle, enum null_kind kind)
{
    struct null_object *object = handle ? null_object_get(handle, kind) : NULL;
    if (!object)
        return;
    object->alive = false;
    if (object->bytes)
        munmap(object->bytes, object->size);
    for (uint32_t i = 0; i < object_count; i++)
        if (objects[i].alive && objects[i].owner == handle) {
            objects[i].alive = false;
            if (kind == NULL_Device || kind == NULL_Instance)
                fault_misuse("%s outlives its %s", kind_names[objects[i].kind], kind_names[kind]);
        }
}

void null_vulkan_report(FILE *out)
{
    for (uint32_t i = 0; i < object_count; i++)
        if (objects[i].alive && objects[i].kind != NULL_PhysicalDevice && objects[i].kind != NULL_Queue)
            fprintf(out, "leak %s\n", kind_names[objects[i].kind]);
}

/* ---- Making ------------------------------------------------------------------------------------------ */

static VkResult add(enum null_kind kind, const void *owner, void *out)
{
    const struct null_object *object = null_object_add(kind, owner);
    memcpy(out, &object, sizeof object);
    return object ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

#define CREATE(kind)                                                                                         \
    static VkResult null_Create##kind(VkDevice device, const Vk##kind##CreateInfo *info,                     \
                                      const VkAllocationCallbacks *callbacks, Vk##kind *out)                 \
    {                                                                                                        \
        (void)callbacks;                                                                                     \
        return info ? add(NULL_##kind, device, out) : VK_ERROR_UNKNOWN;                                      \
    }
CREATE(CommandPool)
CREATE(DescriptorPool)
CREATE(DescriptorSetLayout)
CREATE(Fence)
CREATE(Framebuffer)
CREATE(ImageView)
CREATE(PipelineCache)
CREATE(PipelineLayout)
CREATE(QueryPool)
CREATE(RenderPass)
CREATE(BufferView)
CREATE(Sampler)
CREATE(ShaderModule)
#undef CREATE

static VkResult null_CreateBuffer(VkDevice device, const VkBufferCreateInfo *info,
                                  const VkAllocationCallbacks *callbacks, VkBuffer *out)
{
    (void)callbacks;
    struct null_object *object = null_object_add(NULL_Buffer, device);
    if (object)
        object->size = info->size;
    memcpy(out, &object, sizeof object);
    return object ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_CreateImage(VkDevice device, const VkImageCreateInfo *info,
                                 const VkAllocationCallbacks *callbacks, VkImage *out)
{
    (void)callbacks;
    struct null_object *object = null_object_add(NULL_Image, device);
    if (object)
        object->size = (VkDeviceSize)32 * info->extent.width * info->extent.height * info->arrayLayers;
    memcpy(out, &object, sizeof object);
    return object ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult pipelines(VkDevice device, uint32_t count, VkPipeline *out)
{
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; i++)
        result = add(NULL_Pipeline, device, &out[i]);
    return result;
}

static VkResult null_CreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                            const VkComputePipelineCreateInfo *infos,
                                            const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    (void)cache;
    (void)callbacks;
    return null_object_get(infos->stage.module, NULL_ShaderModule) ? pipelines(device, count, out)
                                                                   : VK_ERROR_UNKNOWN;
}

static VkResult null_CreateGraphicsPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                             const VkGraphicsPipelineCreateInfo *infos,
                                             const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    (void)cache;
    (void)callbacks;
    return null_object_get(infos->pStages->module, NULL_ShaderModule) ? pipelines(device, count, out)
                                                                      : VK_ERROR_UNKNOWN;
}

static VkResult null_AllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                    const VkAllocationCallbacks *callbacks, VkDeviceMemory *out)
{
    (void)callbacks;
    struct null_object *object = null_object_add(NULL_DeviceMemory, device);
    if (object)
        object->size = info->allocationSize;
    memcpy(out, &object, sizeof object);
    return object ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_AllocateCommandBuffers(VkDevice device, const VkCommandBufferAllocateInfo *info,
                                            VkCommandBuffer *out)
{
    (void)device;
    return add(NULL_CommandBuffer, info->commandPool, out);
}

static VkResult null_AllocateDescriptorSets(VkDevice device, const VkDescriptorSetAllocateInfo *info,
                                            VkDescriptorSet *out)
{
    VkResult result = VK_SUCCESS;
    (void)device;
    for (uint32_t i = 0; i < info->descriptorSetCount && result == VK_SUCCESS; i++)
        result = add(NULL_DescriptorSet, info->descriptorPool, &out[i]);
    return result;
}

/* ---- Memory ------------------------------------------------------------------------------------------ */

static VkResult null_BindBufferMemory(VkDevice device, VkBuffer buffer, VkDeviceMemory memory,
                                      VkDeviceSize offset)
{
    struct null_object *object = null_object_get(buffer, NULL_Buffer);
    (void)device;
    (void)offset;
    if (!object)
        return VK_ERROR_UNKNOWN;
    object->memory = null_object_get(memory, NULL_DeviceMemory);
    return object->memory ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_BindImageMemory(VkDevice device, VkImage image, VkDeviceMemory memory,
                                     VkDeviceSize offset)
{
    (void)device;
    (void)offset;
    return null_object_get(image, NULL_Image) && null_object_get(memory, NULL_DeviceMemory)
               ? VK_SUCCESS
               : VK_ERROR_UNKNOWN;
}

/* Zeros, whatever was drawn or copied, and what vkCmdUpdateBuffer wrote. */
static VkResult null_MapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                               VkMemoryMapFlags flags, void **out)
{
    struct null_object *object = null_object_get(memory, NULL_DeviceMemory);
    (void)device;
    (void)size;
    (void)flags;
    if (!object || object->bytes)
        return VK_ERROR_MEMORY_MAP_FAILED;
    void *const bytes = mmap(NULL, object->size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (bytes == MAP_FAILED)
        return VK_ERROR_MEMORY_MAP_FAILED;
    object->bytes = bytes;
    *out = object->bytes + offset;
    return VK_SUCCESS;
}

static VkResult null_FlushMappedMemoryRanges(VkDevice device, uint32_t count,
                                             const VkMappedMemoryRange *ranges)
{
    (void)device;
    return count > 0 && null_object_get(ranges->memory, NULL_DeviceMemory) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_InvalidateMappedMemoryRanges(VkDevice device, uint32_t count,
                                                  const VkMappedMemoryRange *ranges)
{
    return null_FlushMappedMemoryRanges(device, count, ranges);
}

/* ---- Work: over as soon as it is submitted ----------------------------------------------------------- */

static VkResult null_BeginCommandBuffer(VkCommandBuffer cmd, const VkCommandBufferBeginInfo *info)
{
    return info && null_object_get(cmd, NULL_CommandBuffer) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_EndCommandBuffer(VkCommandBuffer cmd)
{
    return null_object_get(cmd, NULL_CommandBuffer) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_QueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo *submits, VkFence fence)
{
    (void)queue;
    for (uint32_t i = 0; i < count; i++)
        if (!null_object_get(submits[i].pCommandBuffers[0], NULL_CommandBuffer))
            return VK_ERROR_UNKNOWN;
    return !fence || null_object_get(fence, NULL_Fence) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_QueueWaitIdle(VkQueue queue)
{
    return null_object_get(queue, NULL_Queue) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_DeviceWaitIdle(VkDevice device)
{
    return null_object_get(device, NULL_Device) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_ResetFences(VkDevice device, uint32_t count, const VkFence *fences)
{
    (void)device;
    return count > 0 && null_object_get(fences[0], NULL_Fence) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_WaitForFences(VkDevice device, uint32_t count, const VkFence *fences, VkBool32 all,
                                   uint64_t timeout_ns)
{
    (void)all;
    (void)timeout_ns;
    return null_ResetFences(device, count, fences);
}

static VkResult null_GetQueryPoolResults(VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count,
                                         size_t size, void *data, VkDeviceSize stride,
                                         VkQueryResultFlags flags)
{
    (void)device;
    (void)size;
    (void)flags;
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t ticks = 1000 * (first + i);
        memcpy((char *)data + i * stride, &ticks, sizeof ticks);
    }
    return null_object_get(pool, NULL_QueryPool) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_GetPipelineCacheData(VkDevice device, VkPipelineCache cache, size_t *size, void *data)
{
    const VkPipelineCacheHeaderVersionOne header = { .headerSize = sizeof header, .headerVersion = 1 };
    (void)device;
    if (data && *size >= sizeof header)
        memcpy(data, &header, sizeof header);
    *size = sizeof header;
    return null_object_get(cache, NULL_PipelineCache) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

/* ---- Instance and device ----------------------------------------------------------------------------- */

static VkResult null_EnumerateInstanceVersion(uint32_t *version)
{
    *version = VK_API_VERSION_1_2;
    return VK_SUCCESS;
}

static VkResult null_EnumerateInstanceLayerProperties(uint32_t *count, VkLayerProperties *out)
{
    (void)out;
    *count = 0;
    return VK_SUCCESS;
}

static VkResult null_CreateInstance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *callbacks,
                                    VkInstance *out)
{
    (void)info;
    (void)callbacks;
    return add(NULL_Instance, NULL, out);
}

static VkResult null_EnumeratePhysicalDevices(VkInstance instance, uint32_t *count, VkPhysicalDevice *out)
{
    if (out && *count > 0)
        add(NULL_PhysicalDevice, NULL, out);
    *count = 1;
    return null_object_get(instance, NULL_Instance) ? VK_SUCCESS : VK_ERROR_UNKNOWN;
}

static VkResult null_CreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                  const VkAllocationCallbacks *callbacks, VkDevice *out)
{
    (void)info;
    (void)callbacks;
    return null_object_get(physical, NULL_PhysicalDevice) ? add(NULL_Device, NULL, out) : VK_ERROR_UNKNOWN;
}

/* ---- The functions themselves ------------------------------------------------------------------------ */

#define FALLIBLE(name, errors, parameters, arguments)                                                        \
    VKAPI_ATTR VkResult VKAPI_CALL vk##name parameters;                                                      \
    VKAPI_ATTR VkResult VKAPI_CALL vk##name parameters                                                       \
    {                                                                                                        \
        const VkResult result = fault_vulkan("vk" #name, errors);                                            \
        return result != VK_SUCCESS ? result : null_##name arguments;                                        \
    }
FALLIBLE_FUNCTIONS(FALLIBLE)
#undef FALLIBLE
