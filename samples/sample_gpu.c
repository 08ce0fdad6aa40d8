/* SPDX-License-Identifier: MIT */
#include "sample_gpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void sample_require(bool good, const char *what)
{
    if (good)
        return;
    fprintf(stderr, "failed: %s\n", what);
    exit(EXIT_FAILURE);
}

/* ---- Objects that end with the device */

void sample_keep(struct sample_gpu *gpu, VkObjectType type, uint64_t handle)
{
    sample_require(gpu->kept_count < SAMPLE_MAX_OBJECTS, "SAMPLE_MAX_OBJECTS are too few");
    gpu->kept[gpu->kept_count++] = (struct sample_object_kept){ type, handle };
}

#define DESTROY(TYPE, Name)                                                                                  \
    case VK_OBJECT_TYPE_##TYPE:                                                                              \
        vkDestroy##Name(device, (Vk##Name)handle, NULL);                                                     \
        break

static void destroy(VkDevice device, VkObjectType type, uint64_t handle)
{
    switch (type) {
        DESTROY(BUFFER, Buffer);
        DESTROY(COMMAND_POOL, CommandPool);
        DESTROY(DESCRIPTOR_POOL, DescriptorPool);
        DESTROY(DESCRIPTOR_SET_LAYOUT, DescriptorSetLayout);
        DESTROY(FENCE, Fence);
        DESTROY(FRAMEBUFFER, Framebuffer);
        DESTROY(IMAGE, Image);
        DESTROY(IMAGE_VIEW, ImageView);
        DESTROY(PIPELINE, Pipeline);
        DESTROY(PIPELINE_LAYOUT, PipelineLayout);
        DESTROY(RENDER_PASS, RenderPass);
        DESTROY(SAMPLER, Sampler);
        DESTROY(SEMAPHORE, Semaphore);
    case VK_OBJECT_TYPE_DEVICE_MEMORY:
        vkFreeMemory(device, (VkDeviceMemory)handle, NULL);
        break;
    default:
        sample_require(false, "destroying an object of a type that is kept");
    }
}

/* ---- Instance and device */

static bool find_queue(struct sample_gpu *gpu, VkPhysicalDevice candidate)
{
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(candidate, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        if ((families[i].queueFlags & wanted) != wanted)
            continue;
        gpu->physical_device = candidate;
        gpu->queue_family = i;
        return true;
    }
    return false;
}

void sample_gpu_find(struct sample_gpu *gpu, uint32_t api_version, const char *const *extensions,
                     uint32_t extension_count)
{
    memset(gpu, 0, sizeof *gpu);
    const VkApplicationInfo application = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .apiVersion = api_version };
    const VkInstanceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &application,
                                        .enabledExtensionCount = extension_count,
                                        .ppEnabledExtensionNames = extensions };
    SAMPLE_CHECK(vkCreateInstance(&info, NULL, &gpu->instance));
    VkPhysicalDevice candidates[16];
    uint32_t count = 16;
    SAMPLE_CHECK(vkEnumeratePhysicalDevices(gpu->instance, &count, candidates));
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++)
        found = find_queue(gpu, candidates[i]);
    sample_require(found, "finding a device with a queue for graphics and compute");
    vkGetPhysicalDeviceMemoryProperties(gpu->physical_device, &gpu->memory);
}

static void make_frames(struct sample_gpu *gpu)
{
    const VkCommandPoolCreateInfo pool = { .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                           .queueFamilyIndex = gpu->queue_family };
    SAMPLE_CHECK(vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->pool));
    SAMPLE_KEEP(gpu, COMMAND_POOL, gpu->pool);
    const VkCommandBufferAllocateInfo take = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = gpu->pool,
                                               .commandBufferCount = 1 };
    const VkFenceCreateInfo fence = { .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                      .flags = VK_FENCE_CREATE_SIGNALED_BIT };
    for (int i = 0; i < SAMPLE_FRAMES; i++) {
        SAMPLE_CHECK(vkAllocateCommandBuffers(gpu->device, &take, &gpu->frames[i].cmd));
        SAMPLE_CHECK(vkCreateFence(gpu->device, &fence, NULL, &gpu->frames[i].fence));
        SAMPLE_KEEP(gpu, FENCE, gpu->frames[i].fence);
    }
}

static void make_descriptor_pool(struct sample_gpu *gpu)
{
    const VkDescriptorPoolSize sizes[] = { { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 8 },
                                           { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16 },
                                           { VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 8 } };
    const VkDescriptorPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                              .maxSets = 8,
                                              .poolSizeCount = sizeof sizes / sizeof *sizes,
                                              .pPoolSizes = sizes };
    SAMPLE_CHECK(vkCreateDescriptorPool(gpu->device, &info, NULL, &gpu->sets));
    SAMPLE_KEEP(gpu, DESCRIPTOR_POOL, gpu->sets);
}

void sample_gpu_open(struct sample_gpu *gpu, const VkPhysicalDeviceFeatures *features,
                     const char *const *extensions, uint32_t extension_count)
{
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = { .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = gpu->queue_family,
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority };
    const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = extension_count,
                                      .ppEnabledExtensionNames = extensions,
                                      .pEnabledFeatures = features };
    SAMPLE_CHECK(vkCreateDevice(gpu->physical_device, &info, NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->queue_family, 0, &gpu->queue);
    make_frames(gpu);
    make_descriptor_pool(gpu);
}

void sample_gpu_close(struct sample_gpu *gpu)
{
    while (gpu->kept_count > 0) {
        const struct sample_object_kept *last = &gpu->kept[--gpu->kept_count];
        destroy(gpu->device, last->type, last->handle);
    }
    vkDestroyDevice(gpu->device, NULL);
    vkDestroyInstance(gpu->instance, NULL);
}

/* ---- Memory */

static VkDeviceMemory allocate(struct sample_gpu *gpu, const VkMemoryRequirements *needs,
                               VkMemoryPropertyFlags wanted)
{
    VkMemoryAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = needs->size };
    uint32_t type = 0;
    while (type < gpu->memory.memoryTypeCount &&
           (!(needs->memoryTypeBits >> type & 1) ||
            (gpu->memory.memoryTypes[type].propertyFlags & wanted) != wanted))
        type++;
    sample_require(type < gpu->memory.memoryTypeCount, "finding a memory type");
    info.memoryTypeIndex = type;
    VkDeviceMemory memory;
    SAMPLE_CHECK(vkAllocateMemory(gpu->device, &info, NULL, &memory));
    SAMPLE_KEEP(gpu, DEVICE_MEMORY, memory);
    return memory;
}

struct sample_buffer sample_buffer_make(struct sample_gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage)
{
    struct sample_buffer made;
    const VkBufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                      .size = size,
                                      .usage = usage };
    SAMPLE_CHECK(vkCreateBuffer(gpu->device, &info, NULL, &made.buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu->device, made.buffer, &needs);
    const VkDeviceMemory memory =
        allocate(gpu, &needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    SAMPLE_KEEP(gpu, BUFFER, made.buffer);
    SAMPLE_CHECK(vkBindBufferMemory(gpu->device, made.buffer, memory, 0));
    SAMPLE_CHECK(vkMapMemory(gpu->device, memory, 0, VK_WHOLE_SIZE, 0, &made.mapped));
    return made;
}

static VkImageAspectFlags aspect_of(VkFormat format)
{
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

struct sample_image sample_image_make(struct sample_gpu *gpu, uint32_t width, uint32_t height,
                                      VkFormat format, VkImageUsageFlags usage)
{
    struct sample_image made = { .format = format, .width = width, .height = height };
    const VkImageCreateInfo info = { .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = format,
                                     .extent = { width, height, 1 },
                                     .mipLevels = 1,
                                     .arrayLayers = 1,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage = usage };
    SAMPLE_CHECK(vkCreateImage(gpu->device, &info, NULL, &made.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(gpu->device, made.image, &needs);
    const VkDeviceMemory memory = allocate(gpu, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    SAMPLE_KEEP(gpu, IMAGE, made.image);
    SAMPLE_CHECK(vkBindImageMemory(gpu->device, made.image, memory, 0));
    const VkImageViewCreateInfo view = { .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = made.image,
                                         .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                         .format = format,
                                         .subresourceRange = { aspect_of(format), 0, 1, 0, 1 } };
    SAMPLE_CHECK(vkCreateImageView(gpu->device, &view, NULL, &made.view));
    SAMPLE_KEEP(gpu, IMAGE_VIEW, made.view);
    return made;
}

/* ---- Frames */

VkCommandBuffer sample_frame_begin(struct sample_gpu *gpu)
{
    const struct sample_frame *frame = &gpu->frames[gpu->frame % SAMPLE_FRAMES];
    SAMPLE_CHECK(vkWaitForFences(gpu->device, 1, &frame->fence, VK_TRUE, UINT64_MAX));
    SAMPLE_CHECK(vkResetFences(gpu->device, 1, &frame->fence));
    const VkCommandBufferBeginInfo info = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
    SAMPLE_CHECK(vkBeginCommandBuffer(frame->cmd, &info));
    return frame->cmd;
}

void sample_frame_submit(struct sample_gpu *gpu, VkSemaphore wait, VkSemaphore signal)
{
    const struct sample_frame *frame = &gpu->frames[gpu->frame++ % SAMPLE_FRAMES];
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    SAMPLE_CHECK(vkEndCommandBuffer(frame->cmd));
    const VkSubmitInfo info = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                .waitSemaphoreCount = wait != VK_NULL_HANDLE,
                                .pWaitSemaphores = &wait,
                                .pWaitDstStageMask = &stage,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &frame->cmd,
                                .signalSemaphoreCount = signal != VK_NULL_HANDLE,
                                .pSignalSemaphores = &signal };
    SAMPLE_CHECK(vkQueueSubmit(gpu->queue, 1, &info, frame->fence));
}

void sample_image_barrier(VkCommandBuffer cmd, const struct sample_image *image, VkImageLayout from,
                          VkImageLayout to)
{
    const VkImageMemoryBarrier barrier = { .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                           .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                           .dstAccessMask =
                                               VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                           .oldLayout = from,
                                           .newLayout = to,
                                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .image = image->image,
                                           .subresourceRange = { aspect_of(image->format), 0, 1, 0, 1 } };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         NULL, 0, NULL, 1, &barrier);
}
