/* SPDX-License-Identifier: MIT
 * The functions of the Vulkan that draws nothing that cannot fail: what the device is, what is destroyed, and
 * commands. */
#include "null_vulkan.h"

#include <string.h>

#define EXPORT(type, name, parameters)                                                                       \
    VKAPI_ATTR type VKAPI_CALL name parameters;                                                              \
    VKAPI_ATTR type VKAPI_CALL name parameters

/* ---- What the device is ------------------------------------------------------------------------------ */

EXPORT(void, vkGetPhysicalDeviceProperties, (VkPhysicalDevice physical, VkPhysicalDeviceProperties *out))
{
    (void)physical;
    *out = (VkPhysicalDeviceProperties){
        .apiVersion = VK_API_VERSION_1_2,
        .deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU,
        .deviceName = "draws nothing",
        .limits = { .maxImageDimension2D = 16384,
                    .maxPerStageDescriptorStorageBuffers = 1000,
                    .maxStorageBufferRange = UINT32_MAX,
                    .maxPushConstantsSize = 256,
                    .maxComputeWorkGroupInvocations = 1024,
                    .maxComputeWorkGroupCount = { 65535, 65535, 65535 },
                    .maxComputeSharedMemorySize = 32768,
                    .maxBoundDescriptorSets = 8,
                    .maxSamplerAnisotropy = 16,
                    .maxFramebufferWidth = 16384,
                    .maxFramebufferHeight = 16384,
                    .minUniformBufferOffsetAlignment = 64,
                    .minStorageBufferOffsetAlignment = 16,
                    .nonCoherentAtomSize = 64,
                    .timestampPeriod = 1 },
    };
}

EXPORT(void, vkGetPhysicalDeviceProperties2, (VkPhysicalDevice physical, VkPhysicalDeviceProperties2 *out))
{
    vkGetPhysicalDeviceProperties(physical, &out->properties);
}

EXPORT(void, vkGetPhysicalDeviceFeatures, (VkPhysicalDevice physical, VkPhysicalDeviceFeatures *out))
{
    (void)physical;
    *out = (VkPhysicalDeviceFeatures){ .samplerAnisotropy = VK_TRUE,
                                       .fragmentStoresAndAtomics = VK_TRUE,
                                       .vertexPipelineStoresAndAtomics = VK_TRUE };
}

EXPORT(void, vkGetPhysicalDeviceFormatProperties,
       (VkPhysicalDevice physical, VkFormat format, VkFormatProperties *out))
{
    (void)physical;
    (void)format;
    *out = (VkFormatProperties){ 0x7fffffff, 0x7fffffff, 0x7fffffff };
}

/* Cached memory that is not coherent comes with flushes, which can fail. */
EXPORT(void, vkGetPhysicalDeviceMemoryProperties,
       (VkPhysicalDevice physical, VkPhysicalDeviceMemoryProperties *out))
{
    (void)physical;
    *out = (VkPhysicalDeviceMemoryProperties){
        .memoryTypeCount = 3,
        .memoryTypes = { { VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0 },
                         { VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, 1 },
                         { VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, 1 } },
        .memoryHeapCount = 2,
        .memoryHeaps = { { UINT64_C(8) << 30, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT }, { UINT64_C(8) << 30, 0 } },
    };
}

EXPORT(void, vkGetPhysicalDeviceQueueFamilyProperties,
       (VkPhysicalDevice physical, uint32_t *count, VkQueueFamilyProperties *out))
{
    (void)physical;
    if (out && *count > 0)
        *out = (VkQueueFamilyProperties){ .queueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT |
                                                        VK_QUEUE_TRANSFER_BIT,
                                          .queueCount = 1,
                                          .timestampValidBits = 64 };
    *count = 1;
}

EXPORT(void, vkGetDeviceQueue, (VkDevice device, uint32_t family, uint32_t index, VkQueue *out))
{
    const struct null_object *object = null_object_add(NULL_Queue, NULL);
    (void)device;
    (void)family;
    (void)index;
    memcpy(out, &object, sizeof object);
}

/* ---- Memory ------------------------------------------------------------------------------------------ */

static VkMemoryRequirements requirements(const void *handle, enum null_kind kind, uint32_t types)
{
    const struct null_object *object = null_object_get(handle, kind);
    const VkDeviceSize size = object ? object->size : 0;
    return (VkMemoryRequirements){ (size + 255) / 256 * 256, 256, types };
}

EXPORT(void, vkGetBufferMemoryRequirements, (VkDevice device, VkBuffer buffer, VkMemoryRequirements *out))
{
    (void)device;
    *out = requirements(buffer, NULL_Buffer, 7);
}

EXPORT(void, vkGetImageMemoryRequirements, (VkDevice device, VkImage image, VkMemoryRequirements *out))
{
    (void)device;
    *out = requirements(image, NULL_Image, 1);
}

/* ---- What is destroyed ------------------------------------------------------------------------------- */

#define DESTROY(kind)                                                                                        \
    EXPORT(void, vkDestroy##kind,                                                                            \
           (VkDevice device, Vk##kind handle, const VkAllocationCallbacks *callbacks))                       \
    {                                                                                                        \
        (void)callbacks;                                                                                     \
        null_object_get(device, NULL_Device);                                                                \
        null_object_remove(handle, NULL_##kind);                                                             \
    }
NULL_DEVICE_KINDS(DESTROY)
#undef DESTROY

EXPORT(void, vkFreeMemory, (VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks *callbacks))
{
    (void)device;
    (void)callbacks;
    null_object_remove(memory, NULL_DeviceMemory);
}

EXPORT(void, vkFreeCommandBuffers,
       (VkDevice device, VkCommandPool pool, uint32_t count, const VkCommandBuffer *buffers))
{
    (void)device;
    null_object_get(pool, NULL_CommandPool);
    for (uint32_t i = 0; i < count; i++)
        null_object_remove(buffers[i], NULL_CommandBuffer);
}

EXPORT(VkResult, vkFreeDescriptorSets,
       (VkDevice device, VkDescriptorPool pool, uint32_t count, const VkDescriptorSet *sets))
{
    (void)device;
    null_object_get(pool, NULL_DescriptorPool);
    for (uint32_t i = 0; i < count; i++)
        null_object_remove(sets[i], NULL_DescriptorSet);
    return VK_SUCCESS;
}

EXPORT(void, vkDestroyDevice, (VkDevice device, const VkAllocationCallbacks *callbacks))
{
    (void)callbacks;
    null_object_remove(device, NULL_Device);
}

EXPORT(void, vkDestroyInstance, (VkInstance instance, const VkAllocationCallbacks *callbacks))
{
    (void)callbacks;
    null_object_remove(instance, NULL_Instance);
}

EXPORT(void, vkUpdateDescriptorSets,
       (VkDevice device, uint32_t count, const VkWriteDescriptorSet *writes, uint32_t copy_count,
        const VkCopyDescriptorSet *copies))
{
    (void)device;
    (void)copy_count;
    (void)copies;
    for (uint32_t i = 0; i < count; i++)
        null_object_get(writes[i].dstSet, NULL_DescriptorSet);
}

/* ---- Commands ---------------------------------------------------------------------------------------- */

static void ignore(void)
{
}

#define COMMANDS(X)                                                                                          \
    X(vkCmdBeginRenderPass)                                                                                  \
    X(vkCmdBindDescriptorSets)                                                                               \
    X(vkCmdBindIndexBuffer)                                                                                  \
    X(vkCmdBindPipeline)                                                                                     \
    X(vkCmdBindVertexBuffers)                                                                                \
    X(vkCmdBlitImage)                                                                                        \
    X(vkCmdCopyBuffer)                                                                                       \
    X(vkCmdCopyBufferToImage)                                                                                \
    X(vkCmdCopyImageToBuffer)                                                                                \
    X(vkCmdDispatch)                                                                                         \
    X(vkCmdDispatchIndirect)                                                                                 \
    X(vkCmdDraw)                                                                                             \
    X(vkCmdDrawIndexed)                                                                                      \
    X(vkCmdEndRenderPass)                                                                                    \
    X(vkCmdFillBuffer)                                                                                       \
    X(vkCmdPipelineBarrier)                                                                                  \
    X(vkCmdPushConstants)                                                                                    \
    X(vkCmdResetQueryPool)                                                                                   \
    X(vkCmdSetScissor)                                                                                       \
    X(vkCmdSetViewport)                                                                                      \
    X(vkCmdWriteTimestamp)                                                                                   \
    X(vkCreateRenderPass2) /* shows that the instance was made for Vulkan 1.2 */

#define COMMAND(name) VKAPI_ATTR void VKAPI_CALL name(void) __attribute__((alias("ignore")));
COMMANDS(COMMAND)
#undef COMMAND

/* Done at once. The library marks frames that have run in this way. */
EXPORT(void, vkCmdUpdateBuffer,
       (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, const void *data))
{
    const struct null_object *object = null_object_get(buffer, NULL_Buffer);
    (void)cmd;
    if (object && object->memory && object->memory->bytes)
        memcpy(object->memory->bytes + offset, data, size);
}

/* ---- Finding them ------------------------------------------------------------------------------------ */

#define DECLARE(name, errors, parameters, arguments) VKAPI_ATTR VkResult VKAPI_CALL vk##name parameters;
FALLIBLE_FUNCTIONS(DECLARE)
#undef DECLARE

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice device, const char *name);

EXPORT(PFN_vkVoidFunction, vkGetInstanceProcAddr, (VkInstance instance, const char *name))
{
#define ENTRY(name)                                   { #name, (PFN_vkVoidFunction)name },
#define FALLIBLE(name, errors, parameters, arguments) ENTRY(vk##name)
#define DESTROY(kind)                                 ENTRY(vkDestroy##kind)
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } functions[] = { FALLIBLE_FUNCTIONS(FALLIBLE) NULL_DEVICE_KINDS(DESTROY) COMMANDS(ENTRY)
                          ENTRY(vkGetPhysicalDeviceProperties) ENTRY(vkGetPhysicalDeviceProperties2)
                              ENTRY(vkGetPhysicalDeviceFeatures) ENTRY(vkGetPhysicalDeviceFormatProperties)
                                  ENTRY(vkGetPhysicalDeviceMemoryProperties)
                                      ENTRY(vkGetPhysicalDeviceQueueFamilyProperties) ENTRY(
                                          vkGetBufferMemoryRequirements) ENTRY(vkGetImageMemoryRequirements)
                                          ENTRY(vkCmdUpdateBuffer) ENTRY(vkFreeMemory)
                                              ENTRY(vkFreeDescriptorSets) ENTRY(vkFreeCommandBuffers)
                                                  ENTRY(vkUpdateDescriptorSets) ENTRY(vkGetDeviceProcAddr) };
    (void)instance;
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].function;
    return NULL;
}

PFN_vkVoidFunction vkGetDeviceProcAddr(VkDevice device, const char *name)
{
    (void)device;
    return vkGetInstanceProcAddr(NULL, name);
}
