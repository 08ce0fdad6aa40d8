/* SPDX-License-Identifier: MIT
 * Buffers and images of gpu_test.h. */
#include "gpu_test.h"

#include "gpu_test_check.h"

static VkDeviceMemory memory_allocate(struct gpu_test *gpu, const VkMemoryRequirements *needed,
                                      VkMemoryPropertyFlags flags, bool device_address)
{
    const VkMemoryAllocateFlagsInfo address = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
        .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT,
    };
    VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .pNext = device_address ? &address : NULL,
        .allocationSize = needed->size,
        .memoryTypeIndex = UINT32_MAX,
    };
    for (uint32_t i = gpu->memory_properties.memoryTypeCount; i-- > 0;)
        if (needed->memoryTypeBits >> i & 1 &&
            (gpu->memory_properties.memoryTypes[i].propertyFlags & flags) == flags)
            info.memoryTypeIndex = i;
    REQUIRE_CMP(info.memoryTypeIndex, !=, UINT32_MAX);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    GPU_CHECK(vkAllocateMemory(gpu->device, &info, NULL, &memory));
    return memory;
}

/* ---- Buffers ---- */

static struct gpu_test_buffer buffer_create(struct gpu_test *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                                            VkMemoryPropertyFlags flags)
{
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    struct gpu_test_buffer buffer = { .size = size };
    GPU_CHECK(vkCreateBuffer(gpu->device, &info, NULL, &buffer.buffer));
    VkMemoryRequirements needed;
    vkGetBufferMemoryRequirements(gpu->device, buffer.buffer, &needed);
    buffer.memory = memory_allocate(gpu, &needed, flags, usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    GPU_CHECK(vkBindBufferMemory(gpu->device, buffer.buffer, buffer.memory, 0));
    return buffer;
}

struct gpu_test_buffer gpu_test_buffer_host(struct gpu_test *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                                            const void *data)
{
    struct gpu_test_buffer buffer = buffer_create(
        gpu, size, usage, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    GPU_CHECK(vkMapMemory(gpu->device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped));
    if (data)
        memcpy(buffer.mapped, data, size);
    return buffer;
}

struct gpu_test_buffer gpu_test_buffer_device(struct gpu_test *gpu, VkDeviceSize size,
                                              VkBufferUsageFlags usage, const void *data)
{
    struct gpu_test_buffer buffer = buffer_create(gpu, size, usage, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (data)
        gpu_test_buffer_write(gpu, buffer.buffer, 0, size, data);
    return buffer;
}

void gpu_test_buffer_destroy(struct gpu_test *gpu, struct gpu_test_buffer *buffer)
{
    vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
    vkFreeMemory(gpu->device, buffer->memory, NULL);
    *buffer = (struct gpu_test_buffer){ 0 };
}

struct buffer_copy {
    VkBuffer source, target;
    VkBufferCopy region;
};

static void buffer_copy_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct buffer_copy *copy = user;
    (void)index;
    vkCmdCopyBuffer(cmd, copy->source, copy->target, 1, &copy->region);
}

void gpu_test_buffer_read(struct gpu_test *gpu, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                          void *data)
{
    struct gpu_test_buffer staging = gpu_test_buffer_host(gpu, size, 0, NULL);
    struct buffer_copy copy = { buffer, staging.buffer, { offset, 0, size } };
    gpu_test_submit(gpu, buffer_copy_record, &copy);
    memcpy(data, staging.mapped, size);
    gpu_test_buffer_destroy(gpu, &staging);
}

void gpu_test_buffer_write(struct gpu_test *gpu, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                           const void *data)
{
    struct gpu_test_buffer staging = gpu_test_buffer_host(gpu, size, 0, data);
    struct buffer_copy copy = { staging.buffer, buffer, { 0, offset, size } };
    gpu_test_submit(gpu, buffer_copy_record, &copy);
    gpu_test_buffer_destroy(gpu, &staging);
}

/* ---- Images ---- */

static VkDeviceSize texels_size(VkExtent3D extent, uint32_t texel_size)
{
    return (VkDeviceSize)extent.width * extent.height * extent.depth * texel_size;
}

static uint32_t half_of(uint32_t size)
{
    return size > 1 ? size / 2 : 1;
}

static VkExtent3D level_extent(VkExtent3D extent, uint32_t level)
{
    for (uint32_t i = 0; i < level; i++)
        extent = (VkExtent3D){ half_of(extent.width), half_of(extent.height), half_of(extent.depth) };
    return extent;
}

static VkDeviceSize levels_size(VkExtent3D extent, uint32_t texel_size, uint32_t levels)
{
    VkDeviceSize size = 0;
    for (uint32_t i = 0; i < levels; i++)
        size += texels_size(level_extent(extent, i), texel_size);
    return size;
}

static bool format_has_depth(VkFormat format)
{
    return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT &&
           format != VK_FORMAT_S8_UINT;
}

static void image_allocate(struct gpu_test *gpu, struct gpu_test_image *image, VkImageUsageFlags usage)
{
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = image->extent.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
        .format = image->format,
        .extent = image->extent,
        .mipLevels = image->levels,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
    };
    GPU_CHECK(vkCreateImage(gpu->device, &info, NULL, &image->image));
    VkMemoryRequirements needed;
    vkGetImageMemoryRequirements(gpu->device, image->image, &needed);
    image->memory = memory_allocate(gpu, &needed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, false);
    GPU_CHECK(vkBindImageMemory(gpu->device, image->image, image->memory, 0));
}

/* Transfer usage alone allows no view, and then there is none. */
static void image_view_create(struct gpu_test *gpu, struct gpu_test_image *image, VkImageUsageFlags usage)
{
    const VkImageViewCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = image->extent.depth > 1 ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D,
        .format = image->format,
        .subresourceRange = { image->aspect, 0, image->levels, 0, 1 },
    };
    if (usage & ~(VkImageUsageFlags)(VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        GPU_CHECK(vkCreateImageView(gpu->device, &info, NULL, &image->view));
}

struct image_copy {
    VkImage image;
    VkImageAspectFlags aspect;
    VkExtent3D extent;
    VkBuffer buffer;
    VkImageLayout before, after; /* read: both the image's own */
    uint32_t levels, texel_size; /* write */
};

static VkBufferImageCopy image_copy_region(const struct image_copy *copy, uint32_t level)
{
    return (VkBufferImageCopy){
        .bufferOffset = levels_size(copy->extent, copy->texel_size, level),
        .imageSubresource = { copy->aspect, level, 0, 1 },
        .imageExtent = level_extent(copy->extent, level),
    };
}

/* Orders everything before against everything after: tests read and write whole images between steps. */
static void image_transition(VkCommandBuffer cmd, const struct image_copy *copy, VkImageLayout from,
                             VkImageLayout to)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = copy->image,
        .subresourceRange = { copy->aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1 },
    };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         NULL, 0, NULL, 1, &barrier);
}

static void image_upload_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct image_copy *copy = user;
    (void)index;
    image_transition(cmd, copy, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    for (uint32_t i = 0; i < copy->levels; i++) {
        const VkBufferImageCopy region = image_copy_region(copy, i);
        vkCmdCopyBufferToImage(cmd, copy->buffer, copy->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &region);
    }
    image_transition(cmd, copy, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, copy->after);
}

static void image_download_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct image_copy *copy = user;
    const VkBufferImageCopy region = image_copy_region(copy, 0);
    (void)index;
    image_transition(cmd, copy, copy->before, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(cmd, copy->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy->buffer, 1, &region);
    image_transition(cmd, copy, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy->after);
}

struct gpu_test_image gpu_test_image_create(struct gpu_test *gpu, const struct gpu_test_image_desc *desc)
{
    struct gpu_test_image image = {
        .format = desc->format,
        .aspect = format_has_depth(desc->format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
        .extent = desc->extent,
        .levels = desc->levels ? desc->levels : 1,
        .layout = desc->layout,
    };
    image_allocate(gpu, &image, desc->usage);
    image_view_create(gpu, &image, desc->usage);
    const VkDeviceSize size = levels_size(image.extent, desc->texel_size, image.levels);
    struct gpu_test_buffer staging = gpu_test_buffer_host(gpu, size, 0, desc->texels);
    if (!desc->texels)
        memset(staging.mapped, 0, size);
    struct image_copy copy = { image.image, image.aspect, image.extent, staging.buffer,
                               0,           desc->layout, image.levels, desc->texel_size };
    gpu_test_submit(gpu, image_upload_record, &copy);
    gpu_test_buffer_destroy(gpu, &staging);
    return image;
}

void gpu_test_image_destroy(struct gpu_test *gpu, struct gpu_test_image *image)
{
    vkDestroyImageView(gpu->device, image->view, NULL);
    vkDestroyImage(gpu->device, image->image, NULL);
    vkFreeMemory(gpu->device, image->memory, NULL);
    *image = (struct gpu_test_image){ 0 };
}

void gpu_test_image_read(struct gpu_test *gpu, VkImage image, VkImageLayout layout, VkImageAspectFlags aspect,
                         VkExtent3D extent, uint32_t texel_size, void *texels)
{
    const VkDeviceSize size = texels_size(extent, texel_size);
    struct gpu_test_buffer staging = gpu_test_buffer_host(gpu, size, 0, NULL);
    struct image_copy copy = { image, aspect, extent, staging.buffer, layout, layout, 1, texel_size };
    gpu_test_submit(gpu, image_download_record, &copy);
    memcpy(texels, staging.mapped, size);
    gpu_test_buffer_destroy(gpu, &staging);
}
