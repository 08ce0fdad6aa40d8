/* SPDX-License-Identifier: MIT */
#include "gpu.h"

#include <assert.h>
#include <string.h>

static const struct {
    VkMemoryPropertyFlags required, preferred;
} placements[] = {
    [GPU_DEVICE_LOCAL] = { 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT },
    [GPU_HOST_READ] = { VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT,
                        VK_MEMORY_PROPERTY_HOST_CACHED_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT },
};

/* Index of the first memory type with the required flags, if possible with the preferred ones too; UINT32_MAX
 * if there is none. Vulkan sorts types so that those with flags nobody asked for come later: protected ones,
 * and some that need a feature to be switched on. */
static uint32_t memory_type(const struct gpu_device *device, uint32_t allowed, enum gpu_placement placement)
{
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++) {
        const VkMemoryPropertyFlags flags = device->memory.memoryTypes[i].propertyFlags;
        const VkMemoryPropertyFlags required = placements[placement].required;
        const VkMemoryPropertyFlags both = required | placements[placement].preferred;
        if (!(allowed >> i & 1) || (flags & required) != required)
            continue;
        if ((flags & both) == both)
            return i;
        if (found == UINT32_MAX)
            found = i;
    }
    return found;
}

/* Memory for this object alone. */
static VkResult allocate_own(const struct gpu_device *device, const struct gpu_memory_request *request,
                             enum gpu_placement placement, struct gpu_memory *memory)
{
    const uint32_t type = memory_type(device, request->needs.memoryTypeBits, placement);
    if (type == UINT32_MAX)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    memory->coherent = device->memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkResult result = device->fn.AllocateMemory(device->handle,
                                                &(VkMemoryAllocateInfo){
                                                    .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                                    .allocationSize = request->needs.size,
                                                    .memoryTypeIndex = type,
                                                },
                                                device->callbacks, &memory->handle);
    result = gpu_named(device, result, VK_OBJECT_TYPE_DEVICE_MEMORY, &memory->handle, request->name);
    if (result != VK_SUCCESS || !request->mapped)
        return result;
    return device->fn.MapMemory(device->handle, memory->handle, 0, VK_WHOLE_SIZE, 0, &memory->mapped);
}

static VkDeviceSize round_up(VkDeviceSize value, VkDeviceSize unit)
{
    return unit > 0 ? (value + unit - 1) / unit * unit : value;
}

/* Ranges that are flushed begin and end at atoms, and none reaches into a neighbour's memory. */
static void widen_to_atoms(const struct gpu_device *device, VkMemoryRequirements *needs)
{
    const VkDeviceSize atom = device->limits.nonCoherentAtomSize;
    needs->alignment = needs->alignment > atom ? needs->alignment : atom;
    needs->size = round_up(needs->size, atom);
}

static VkResult allocate(const struct gpu_device *device, const struct gpu_memory_request *request,
                         enum gpu_placement placement, struct gpu_memory *memory)
{
    struct gpu_memory_request asked = *request;
    asked.required = placements[placement].required;
    asked.preferred = placements[placement].preferred;
    asked.mapped = placement == GPU_HOST_READ;
    if (!device->allocator.allocate)
        return allocate_own(device, &asked, placement, memory);
    if (asked.mapped)
        widen_to_atoms(device, &asked.needs);
    const VkResult result = device->allocator.allocate(device->allocator.user, &asked, memory);
    memory->size = asked.needs.size;
    return result;
}

static void release(const struct gpu_device *device, const struct gpu_memory *memory)
{
    if (!device->allocator.free)
        device->fn.FreeMemory(device->handle, memory->handle, device->callbacks);
    else if (memory->handle)
        device->allocator.free(device->allocator.user, memory);
}

static VkResult buffer_back(const struct gpu_device *device, struct gpu_buffer *buffer,
                            enum gpu_placement placement, uint32_t category, const char *name)
{
    struct gpu_memory_request request = {
        .buffer = buffer->handle, .bytes = buffer->size, .category = category, .name = name
    };
    device->fn.GetBufferMemoryRequirements(device->handle, buffer->handle, &request.needs);
    const VkResult result = allocate(device, &request, placement, &buffer->memory);
    if (result != VK_SUCCESS)
        return result;
    return device->fn.BindBufferMemory(device->handle, buffer->handle, buffer->memory.handle,
                                       buffer->memory.offset);
}

/* Bytes of a buffer that is read as texels. lavapipe compiles a shader anew where such a buffer's size
 * becomes a power of two, or ceases to be one, and where bits 8 to 15 of it become 0 or cease to be: none of
 * that happens with these sizes. */
static uint64_t size_of_texels(uint64_t size)
{
    while ((size & (size - 1)) == 0 || (size >> 8 & 0xff) == 0)
        size += 256;
    return size;
}

VkResult gpu_buffer_init(const struct gpu_device *device, struct gpu_buffer *buffer, uint64_t size,
                         VkBufferUsageFlags usage, enum gpu_placement placement, uint32_t category,
                         const char *name)
{
    memset(buffer, 0, sizeof *buffer);
    buffer->size = size;
    const bool texels = (usage & VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT) != 0;
    VkResult result = device->fn.CreateBuffer(device->handle,
                                              &(VkBufferCreateInfo){
                                                  .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                                  .size = texels ? size_of_texels(size) : size,
                                                  .usage = usage,
                                                  .sharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                              },
                                              device->callbacks, &buffer->handle);
    if (result == VK_SUCCESS)
        result = buffer_back(device, buffer, placement, category, name);
    if (result != VK_SUCCESS) {
        gpu_buffer_finish(device, buffer);
        return result;
    }
    return gpu_named(device, result, VK_OBJECT_TYPE_BUFFER, &buffer->handle, name);
}

VkResult gpu_buffer_view(const struct gpu_device *device, struct gpu_buffer *buffer, VkFormat format,
                         VkDeviceSize bytes, const char *name)
{
    const VkResult result = device->fn.CreateBufferView(
        device->handle,
        &(VkBufferViewCreateInfo){ .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                   .buffer = buffer->handle,
                                   .format = format,
                                   .range = bytes },
        device->callbacks, &buffer->texels);
    return gpu_named(device, result, VK_OBJECT_TYPE_BUFFER_VIEW, &buffer->texels, name);
}

void gpu_buffer_finish(const struct gpu_device *device, struct gpu_buffer *buffer)
{
    if (buffer->texels)
        device->fn.DestroyBufferView(device->handle, buffer->texels, device->callbacks);
    device->fn.DestroyBuffer(device->handle, buffer->handle, device->callbacks);
    release(device, &buffer->memory);
    memset(buffer, 0, sizeof *buffer);
}

/* What a host's allocator gave is a part of the memory, and may or may not be coherent. */
static VkMappedMemoryRange range_of(const struct gpu_memory *memory)
{
    return (VkMappedMemoryRange){ .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE,
                                  .memory = memory->handle,
                                  .offset = memory->offset,
                                  .size = memory->size > 0 ? memory->size : VK_WHOLE_SIZE };
}

VkResult gpu_buffer_zero(const struct gpu_device *device, const struct gpu_buffer *buffer)
{
    const VkMappedMemoryRange range = range_of(&buffer->memory);
    assert(buffer->memory.mapped);
    memset(buffer->memory.mapped, 0, buffer->size);
    if (buffer->memory.coherent)
        return VK_SUCCESS;
    return device->fn.FlushMappedMemoryRanges(device->handle, 1, &range);
}

VkResult gpu_buffer_invalidate(const struct gpu_device *device, const struct gpu_buffer *buffer)
{
    const VkMappedMemoryRange range = range_of(&buffer->memory);
    if (buffer->memory.coherent)
        return VK_SUCCESS;
    return device->fn.InvalidateMappedMemoryRanges(device->handle, 1, &range);
}

static VkResult image_view(const struct gpu_device *device, struct gpu_image *image, VkFormat format,
                           uint32_t layers)
{
    return device->fn.CreateImageView(
        device->handle,
        &(VkImageViewCreateInfo){
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = image->handle,
            .viewType = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
            .format = format,
            .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers },
        },
        device->callbacks, &image->view);
}

static VkResult image_back(const struct gpu_device *device, struct gpu_image *image, uint32_t category,
                           const char *name)
{
    struct gpu_memory_request request = { .image = image->handle, .category = category, .name = name };
    device->fn.GetImageMemoryRequirements(device->handle, image->handle, &request.needs);
    image->size = request.bytes = request.needs.size;
    const VkResult result = allocate(device, &request, GPU_DEVICE_LOCAL, &image->memory);
    if (result != VK_SUCCESS)
        return result;
    return device->fn.BindImageMemory(device->handle, image->handle, image->memory.handle,
                                      image->memory.offset);
}

VkResult gpu_image_init(const struct gpu_device *device, struct gpu_image *image, VkFormat format,
                        uint32_t width, uint32_t height, uint32_t layers, VkImageUsageFlags usage,
                        uint32_t category, const char *name)
{
    memset(image, 0, sizeof *image);
    VkResult result = device->fn.CreateImage(device->handle,
                                             &(VkImageCreateInfo){
                                                 .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                                 .imageType = VK_IMAGE_TYPE_2D,
                                                 .format = format,
                                                 .extent = { width, height, 1 },
                                                 .mipLevels = 1,
                                                 .arrayLayers = layers,
                                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                                 .usage = usage,
                                             },
                                             device->callbacks, &image->handle);
    if (result == VK_SUCCESS)
        result = image_back(device, image, category, name);
    if (result == VK_SUCCESS)
        result = gpu_named(device, image_view(device, image, format, layers), VK_OBJECT_TYPE_IMAGE_VIEW,
                           &image->view, name);
    if (result != VK_SUCCESS) {
        gpu_image_finish(device, image);
        return result;
    }
    return gpu_named(device, result, VK_OBJECT_TYPE_IMAGE, &image->handle, name);
}

void gpu_image_finish(const struct gpu_device *device, struct gpu_image *image)
{
    device->fn.DestroyImageView(device->handle, image->view, device->callbacks);
    device->fn.DestroyImage(device->handle, image->handle, device->callbacks);
    release(device, &image->memory);
    memset(image, 0, sizeof *image);
}
