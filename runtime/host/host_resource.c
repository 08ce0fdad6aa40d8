/* SPDX-License-Identifier: MIT
 * Buffers, images, uploads and downloads. */
#include "host_internal.h"

#include <string.h>

static bool memory_type_find(const struct host_device *device, uint32_t allowed, VkMemoryPropertyFlags wanted,
                             uint32_t *type)
{
    for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++) {
        if ((allowed >> i & 1) && (device->memory.memoryTypes[i].propertyFlags & wanted) == wanted) {
            *type = i;
            return true;
        }
    }
    return false;
}

static bool memory_allocate(struct host_device *device, VkMemoryRequirements need,
                            VkMemoryPropertyFlags wanted, VkDeviceMemory *out)
{
    uint32_t type = 0;
    if (!memory_type_find(device, need.memoryTypeBits, wanted, &type) &&
        !memory_type_find(device, need.memoryTypeBits, wanted & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, &type))
        return host_fail(device, "the device has no suitable memory type");
    const VkMemoryAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = need.size,
                                        .memoryTypeIndex = type };
    const VkResult result = vkAllocateMemory(device->device, &info, NULL, out);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return host_fail(device, "out of memory: %llu bytes were asked for", (unsigned long long)need.size);
    return host_check(device, result, "allocating memory");
}

static bool buffer_init(struct host_device *device, VkBufferUsageFlags usage, bool host_visible,
                        struct host_buffer *buffer)
{
    const VkBufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                      .size = buffer->size,
                                      .usage = usage };
    const VkMemoryPropertyFlags properties =
        host_visible ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                     : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (!host_check(device, vkCreateBuffer(device->device, &info, NULL, &buffer->buffer),
                    "creating a buffer"))
        return false;
    VkMemoryRequirements need;
    vkGetBufferMemoryRequirements(device->device, buffer->buffer, &need);
    if (!memory_allocate(device, need, properties, &buffer->memory) ||
        !host_check(device, vkBindBufferMemory(device->device, buffer->buffer, buffer->memory, 0),
                    "binding a buffer"))
        return false;
    return !host_visible ||
           host_check(device,
                      vkMapMemory(device->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped),
                      "mapping a buffer");
}

bool host_buffer_create(struct host_device *device, VkDeviceSize size, VkBufferUsageFlags usage,
                        bool host_visible, struct host_buffer *out)
{
    *out = (struct host_buffer){ .size = size > 0 ? size : 16 };
    if (buffer_init(device, usage, host_visible, out))
        return true;
    host_buffer_destroy(device, out);
    return false;
}

void host_buffer_destroy(struct host_device *device, struct host_buffer *buffer)
{
    vkDestroyBuffer(device->device, buffer->buffer, NULL);
    vkFreeMemory(device->device, buffer->memory, NULL);
    *buffer = (struct host_buffer){ 0 };
}

static VkImageAspectFlags aspect_of(VkFormat format)
{
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

static bool image_init(struct host_device *device, VkImageUsageFlags usage, bool array_view,
                       struct host_image *image)
{
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = image->depth > 0 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
        .format = image->format,
        .extent = { image->width, image->height, image->depth > 0 ? image->depth : 1 },
        .mipLevels = image->mips,
        .arrayLayers = image->layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = usage,
    };
    if (!host_check(device, vkCreateImage(device->device, &info, NULL, &image->image), "creating an image"))
        return false;
    VkMemoryRequirements need;
    vkGetImageMemoryRequirements(device->device, image->image, &need);
    if (!memory_allocate(device, need, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, &image->memory) ||
        !host_check(device, vkBindImageMemory(device->device, image->image, image->memory, 0),
                    "binding an image"))
        return false;
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image->image,
        .viewType = image->depth > 0 ? VK_IMAGE_VIEW_TYPE_3D
                    : array_view     ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                     : VK_IMAGE_VIEW_TYPE_2D,
        .format = image->format,
        .subresourceRange = { aspect_of(image->format), 0, image->mips, 0, image->layers },
    };
    return host_check(device, vkCreateImageView(device->device, &view, NULL, &image->view),
                      "creating an image view");
}

bool host_image_create(struct host_device *device, const struct host_image_desc *desc, struct host_image *out)
{
    *out = (struct host_image){ .format = desc->format,
                                .width = desc->width,
                                .height = desc->height,
                                .depth = desc->depth,
                                .layers = desc->layers > 0 ? desc->layers : 1,
                                .mips = desc->mips > 0 ? desc->mips : 1 };
    if (out->width > device->limits.maxImageDimension2D || out->height > device->limits.maxImageDimension2D)
        return host_fail(device, "an image of %ux%u is beyond the device's limit of %u", out->width,
                         out->height, device->limits.maxImageDimension2D);
    if (image_init(device, desc->usage, desc->array_view, out))
        return true;
    host_image_destroy(device, out);
    return false;
}

void host_image_destroy(struct host_device *device, struct host_image *image)
{
    vkDestroyImageView(device->device, image->view, NULL);
    vkDestroyImage(device->device, image->image, NULL);
    vkFreeMemory(device->device, image->memory, NULL);
    *image = (struct host_image){ 0 };
}

VkCommandBuffer host_commands_begin(struct host_device *device)
{
    const VkCommandBufferAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = device->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    const VkCommandBufferBeginInfo begin = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT };
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    if (!host_check(device, vkAllocateCommandBuffers(device->device, &info, &cmd),
                    "allocating a command buffer"))
        return VK_NULL_HANDLE;
    if (!host_check(device, vkBeginCommandBuffer(cmd, &begin), "beginning a command buffer")) {
        vkFreeCommandBuffers(device->device, device->pool, 1, &cmd);
        return VK_NULL_HANDLE;
    }
    return cmd;
}

/* Whoever submitted frees what the work uses, so that a wait that fails is tried again in another way. */
static bool queue_wait(struct host_device *device)
{
    const VkResult result = vkQueueWaitIdle(device->queue);
    if (result != VK_SUCCESS)
        vkDeviceWaitIdle(device->device);
    return host_check(device, result, "waiting for the queue");
}

bool host_commands_finish(struct host_device *device, VkCommandBuffer cmd)
{
    const VkSubmitInfo submit = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                  .commandBufferCount = 1,
                                  .pCommandBuffers = &cmd };
    const bool ok =
        host_check(device, vkEndCommandBuffer(cmd), "ending a command buffer") &&
        host_check(device, vkQueueSubmit(device->queue, 1, &submit, VK_NULL_HANDLE), "submitting") &&
        queue_wait(device);
    vkFreeCommandBuffers(device->device, device->pool, 1, &cmd);
    return ok;
}

void host_image_barrier(VkCommandBuffer cmd, VkImage image, uint32_t first_mip, uint32_t mips,
                        const VkImageLayout layouts[2], const VkPipelineStageFlags stages[2],
                        const VkAccessFlags accesses[2])
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = accesses[0],
        .dstAccessMask = accesses[1],
        .oldLayout = layouts[0],
        .newLayout = layouts[1],
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, first_mip, mips, 0, 1 },
    };
    vkCmdPipelineBarrier(cmd, stages[0], stages[1], 0, 0, NULL, 0, NULL, 1, &barrier);
}

static bool upload_staged(struct host_device *device, const struct host_buffer *staging,
                          struct host_buffer *buffer, VkDeviceSize offset, VkDeviceSize size)
{
    VkCommandBuffer cmd = host_commands_begin(device);
    if (!cmd)
        return false;
    vkCmdCopyBuffer(cmd, staging->buffer, buffer->buffer, 1,
                    &(VkBufferCopy){ .dstOffset = offset, .size = size });
    return host_commands_finish(device, cmd);
}

bool host_buffer_upload(struct host_device *device, struct host_buffer *buffer, VkDeviceSize offset,
                        const void *data, VkDeviceSize size)
{
    struct host_buffer staging;
    if (size == 0)
        return true;
    if (!host_buffer_create(device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true, &staging))
        return false;
    memcpy(staging.mapped, data, size);
    const bool ok = upload_staged(device, &staging, buffer, offset, size);
    host_buffer_destroy(device, &staging);
    return ok;
}

static bool download_staged(struct host_device *device, const struct host_image *image,
                            const struct host_buffer *staging)
{
    static const VkImageLayout to_source[] = { VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL };
    static const VkImageLayout back[] = { VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL };
    VkCommandBuffer cmd = host_commands_begin(device);
    if (!cmd)
        return false;
    host_image_barrier(
        cmd, image->image, 0, 1, to_source,
        (const VkPipelineStageFlags[]){ VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT },
        (const VkAccessFlags[]){ VK_ACCESS_MEMORY_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT });
    const VkBufferImageCopy region = { .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
                                       .imageExtent = { image->width, image->height, 1 } };
    vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging->buffer, 1,
                           &region);
    host_image_barrier(
        cmd, image->image, 0, 1, back,
        (const VkPipelineStageFlags[]){ VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT },
        (const VkAccessFlags[]){ VK_ACCESS_TRANSFER_READ_BIT, VK_ACCESS_MEMORY_READ_BIT });
    const VkMemoryBarrier to_host = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                      .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                      .dstAccessMask = VK_ACCESS_HOST_READ_BIT };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0,
                         NULL, 0, NULL);
    return host_commands_finish(device, cmd);
}

bool host_image_download(struct host_device *device, const struct host_image *image, VkDeviceSize texel_bytes,
                         void *data)
{
    struct host_buffer staging;
    const VkDeviceSize size = texel_bytes * image->width * image->height;
    if (!host_buffer_create(device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &staging))
        return false;
    const bool ok = download_staged(device, image, &staging);
    if (ok)
        memcpy(data, staging.mapped, size);
    host_buffer_destroy(device, &staging);
    return ok;
}
