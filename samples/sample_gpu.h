/* SPDX-License-Identifier: MIT
 * What the sample hosts need of Vulkan before they know anything of light: a device, memory, frames in flight
 * and a picture in a file. A failed call ends the program with one line. */
#ifndef SAMPLE_GPU_H
#define SAMPLE_GPU_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SAMPLE_FRAMES = 2, SAMPLE_MAX_OBJECTS = 96 };

/* Vulkan's errors are below 0, and so are those of libsdfgi. */
#define SAMPLE_CHECK(call) sample_require((call) >= 0, #call)

/* Unless `good`, prints `what` and ends the program. */
void sample_require(bool good, const char *what);

/* An object that sample_gpu_close destroys. */
struct sample_object_kept {
    VkObjectType type;
    uint64_t handle;
};

struct sample_frame {
    VkCommandBuffer cmd;
    VkFence fence;
};

struct sample_gpu {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family; /* graphics and compute */
    VkQueue queue;
    VkCommandPool pool;
    VkDescriptorPool sets;
    VkPhysicalDeviceMemoryProperties memory;
    struct sample_frame frames[SAMPLE_FRAMES];
    uint64_t frame; /* number of the one that is recorded */
    struct sample_object_kept kept[SAMPLE_MAX_OBJECTS];
    uint32_t kept_count;
};

/* Makes an instance of Vulkan `api_version` with these extensions, and finds the first device with a queue
 * for graphics and compute. */
void sample_gpu_find(struct sample_gpu *gpu, uint32_t api_version, const char *const *extensions,
                     uint32_t extension_count);
/* Makes the device with these features and extensions. */
void sample_gpu_open(struct sample_gpu *gpu, const VkPhysicalDeviceFeatures *features,
                     const char *const *extensions, uint32_t extension_count);
/* Destroys all that was kept, the newest first, the device and the instance. The device must be idle. */
void sample_gpu_close(struct sample_gpu *gpu);

/* Hands an object over to sample_gpu_close. */
void sample_keep(struct sample_gpu *gpu, VkObjectType type, uint64_t handle);
#define SAMPLE_KEEP(gpu, type, handle) sample_keep(gpu, VK_OBJECT_TYPE_##type, (uint64_t)(handle))

/* A buffer that the host writes and reads through `mapped`. */
struct sample_buffer {
    VkBuffer buffer;
    void *mapped;
};

struct sample_buffer sample_buffer_make(struct sample_gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage);

struct sample_image {
    VkImage image;
    VkImageView view;
    VkFormat format;
    uint32_t width, height;
};

struct sample_image sample_image_make(struct sample_gpu *gpu, uint32_t width, uint32_t height,
                                      VkFormat format, VkImageUsageFlags usage);

/* Waits until the frame before the last has finished, and begins the next one's command buffer. */
VkCommandBuffer sample_frame_begin(struct sample_gpu *gpu);
/* Ends and submits it. Either semaphore may be VK_NULL_HANDLE. */
void sample_frame_submit(struct sample_gpu *gpu, VkSemaphore wait, VkSemaphore signal);

/* Orders all that was recorded before against all that comes after, and changes an image's layout. */
void sample_image_barrier(VkCommandBuffer cmd, const struct sample_image *image, VkImageLayout from,
                          VkImageLayout to);

/* Writes an image of four half floats, in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, once the device is idle:
 * FILE.pfm has its radiance, FILE.ppm what a display shows of it. */
void sample_picture_write(struct sample_gpu *gpu, const struct sample_image *image, const char *path);

#ifdef __cplusplus
}
#endif
#endif
