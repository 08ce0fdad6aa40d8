/* SPDX-License-Identifier: MIT
 * A headless Vulkan device for tests, with validation and synchronization validation switched on. Every
 * message from the validation layer fails the test, unless the waiver table in gpu_test.c names it with a
 * reason.
 *
 *   int main(void)
 *   {
 *       if (!gpu_test_available())
 *           return GPU_TEST_SKIP;
 *       ...cmocka groups whose tests call gpu_test_open, do their work, and call gpu_test_close...
 *   }
 *
 * Environment:
 *   SDFGI_TEST_DEVICE      index of a device, or part of its name; unset: the first CPU device, else the
 * first SDFGI_TEST_VALIDATION  0: do without the validation layer, for machines that lack it
 *
 * Every function reports failure through cmocka and does not return then. */
#ifndef TEST_GPU_TEST_H
#define TEST_GPU_TEST_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

#include <sdfgi/sdfgi.h>

enum { GPU_TEST_SKIP = 77 }; /* exit code of a program that found no device */

typedef enum sdfgi_result (*gpu_test_requirements_fn)(VkInstance instance, VkPhysicalDevice physical_device,
                                                      PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                                      struct sdfgi_requirements *requirements);

struct gpu_test_messages {
    uint32_t errors, warnings, waived;
    bool quiet; /* count without printing: for tests that provoke messages */
};

/* The pipeline of the last shader that gpu_test_compute ran: compiling takes much longer than running. */
struct gpu_test_pipeline {
    const uint32_t *code;
    bool given;                       /* the caller gave a layout of set 0 */
    VkDescriptorSetLayout layouts[2]; /* of sets 0 and 1 */
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

enum { GPU_TEST_IDLE_MOST = 8 };

struct gpu_test {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger; /* VK_NULL_HANDLE without validation */
    struct gpu_test_messages *messages; /* owned */
    VkPhysicalDevice physical_device;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory_properties;
    VkDevice device;
    uint32_t queue_family_index; /* graphics and compute */
    VkQueue queue;
    VkCommandPool command_pool;
    VkCommandBuffer idle[GPU_TEST_IDLE_MOST]; /* recorded before, and no longer in use */
    uint32_t idle_count;
    struct gpu_test_pipeline kept;
};

/* True if there is any Vulkan device; otherwise says so on stderr. */
bool gpu_test_available(void);

/* Makes an instance and a device with the features that `requirements` asks for: sdfgi_get_requirements, or
 * NULL for a device without any. */
void gpu_test_open(struct gpu_test *gpu, gpu_test_requirements_fn requirements);

/* True for a driver that has the processor do all work. */
bool gpu_test_is_software(const struct gpu_test *gpu);

/* How often suite `full` repeats what it asks for `count` times on a GPU: a sixteenth of that on a software
 * driver, where all of it would take hours. */
uint32_t gpu_test_repeats(const struct gpu_test *gpu, uint32_t count);

/* Destroys everything, then fails the test if the layer had anything to say. */
void gpu_test_close(struct gpu_test *gpu);
/* The same outside of a test. Returns what the layer had to say. */
struct gpu_test_messages gpu_test_destroy(struct gpu_test *gpu);
/* Fails the test if the layer had anything to say. */
void gpu_test_require_silence(struct gpu_test *gpu);

/* Messages so far, which are forgotten; `quiet` stays as it is. */
struct gpu_test_messages gpu_test_take_messages(struct gpu_test *gpu);

/* ---- Work ---- */

/* Records into `cmd`; `index` counts the command buffers of one call. */
typedef void (*gpu_test_record_fn)(VkCommandBuffer cmd, uint32_t index, void *user);

/* Records one command buffer, submits it and waits. */
void gpu_test_submit(struct gpu_test *gpu, gpu_test_record_fn record, void *user);

/* Records `count` command buffers, submits them one by one and waits once, at the end: what only looks right
 * because of the wait between submissions shows as a hazard. */
void gpu_test_submit_many(struct gpu_test *gpu, uint32_t count, gpu_test_record_fn record, void *user);
/* Records a command buffer that never runs. */
void gpu_test_record_and_drop(struct gpu_test *gpu, gpu_test_record_fn record, void *user);

/* ---- Buffers ---- */

struct gpu_test_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped; /* NULL for device memory */
};

/* Host-visible and coherent. `data` (may be NULL) fills it. Transfer usage is added to `usage`. */
struct gpu_test_buffer gpu_test_buffer_host(struct gpu_test *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                                            const void *data);

/* In device memory; `data` (may be NULL) is uploaded. Transfer usage is added to `usage`. */
struct gpu_test_buffer gpu_test_buffer_device(struct gpu_test *gpu, VkDeviceSize size,
                                              VkBufferUsageFlags usage, const void *data);

void gpu_test_buffer_destroy(struct gpu_test *gpu, struct gpu_test_buffer *buffer);

/* Copies bytes of any buffer with transfer usage to and from host memory, and waits. */
void gpu_test_buffer_read(struct gpu_test *gpu, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                          void *data);
void gpu_test_buffer_write(struct gpu_test *gpu, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                           const void *data);

/* ---- Images: one layer; 3D if depth > 1 ---- */

struct gpu_test_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkFormat format;
    VkImageAspectFlags aspect;
    VkExtent3D extent;
    uint32_t levels;
    VkImageLayout layout; /* after creation; update it if your commands change it */
};

struct gpu_test_image_desc {
    VkFormat format;
    VkExtent3D extent;
    VkImageUsageFlags usage; /* transfer usage is added */
    VkImageLayout layout;    /* wanted after creation */
    const void *texels;      /* tightly packed, level after level; NULL: zero bytes */
    uint32_t texel_size;     /* bytes */
    uint32_t levels;         /* of mips, each half as large as the one before; 0: 1 */
};

struct gpu_test_image gpu_test_image_create(struct gpu_test *gpu, const struct gpu_test_image_desc *desc);
void gpu_test_image_destroy(struct gpu_test *gpu, struct gpu_test_image *image);

/* Reads all texels of level 0, tightly packed, from an image that is in `layout` and stays in it. */
void gpu_test_image_read(struct gpu_test *gpu, VkImage image, VkImageLayout layout, VkImageAspectFlags aspect,
                         VkExtent3D extent, uint32_t texel_size, void *texels);

#endif
