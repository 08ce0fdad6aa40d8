/* SPDX-License-Identifier: MIT
 * What scene, volumes and views share: the host's device and hooks, pipelines, and the queue of objects that
 * frames in flight may still use. */
#ifndef SDFGI_BACKEND_H
#define SDFGI_BACKEND_H

#include "core/hooks.h"
#include "gpu.h"
#include "pass_rows.h"
#include "resource_table.h"

#include <pthread.h>

struct pipelines {
    VkDescriptorSetLayout sets[2]; /* by enum resource_set */
    VkDescriptorSetLayout mesh, material, view;
    VkPipelineLayout layouts[PASS_SET_COUNT]; /* by the set beside LOOKUP and WORK */
    VkPipeline passes[PASS_COUNT][PASS_VARIANTS];
    VkSampler nearest;
};

struct backend {
    struct gpu_device device;
    VkAllocationCallbacks callbacks;
    struct sdfgi_device_allocator device_allocator;
    struct hooks hooks;
    struct pipelines pipelines;
    struct gpu_retire_queue retired; /* counts frames, too */
    /* Guards what a thread in sdfgi_prepare shares with the other: pipelines.passes, held, the preparation of
     * context.h, and the scene's instance_room. Nothing else is called meanwhile. */
    pthread_mutex_t lock;
    bool software;            /* passes are those for software drivers: SDFGI_SOFTWARE in shaders */
    struct sdfgi_memory held; /* device bytes of all buffers, retired ones included */
};

/* Frames recorded so far modulo the frames in flight. */
uint32_t sdfgi_backend_slot(const struct backend *backend);
/* Number of the newest frame: no two in flight have the same. */
uint32_t sdfgi_backend_number(const struct backend *backend);

/* Has device memory come from a host's allocator; one without functions changes nothing. The device must have
 * been imported. */
void sdfgi_backend_set_allocator(struct backend *backend, const struct sdfgi_device_allocator *allocator);

/* Device bytes held now. */
struct sdfgi_memory sdfgi_backend_held(const struct backend *backend);

/* A buffer whose size counts in `held`. */
VkResult sdfgi_backend_buffer_init(struct backend *backend, struct gpu_buffer *buffer, uint64_t size,
                                   VkBufferUsageFlags usage, enum gpu_placement placement,
                                   enum sdfgi_memory_category category, const char *name);
/* Accepts a buffer that was never made. */
void sdfgi_backend_buffer_finish(struct backend *backend, struct gpu_buffer *buffer,
                                 enum sdfgi_memory_category category);

/* Likewise a 2D image. */
VkResult sdfgi_backend_image_init(struct backend *backend, struct gpu_image *image, VkFormat format,
                                  uint32_t width, uint32_t height, VkImageUsageFlags usage,
                                  enum sdfgi_memory_category category, const char *name);
void sdfgi_backend_image_finish(struct backend *backend, struct gpu_image *image,
                                enum sdfgi_memory_category category);

/* Sampler and layouts. */
VkResult sdfgi_pipelines_init(struct backend *backend);
void sdfgi_pipelines_finish(struct backend *backend);
/* True if passes read a resource as texels: SDFGI_BINDING_TEXELS. */
bool sdfgi_pipelines_read_texels(const struct backend *backend, enum resource resource);
bool sdfgi_pipelines_has(struct backend *backend, enum pass pass, uint32_t variant);
/* Makes the pipeline of a variant unless it is there. Two threads may ask for the same one. */
VkResult sdfgi_pipelines_require(struct backend *backend, enum pass pass, uint32_t variant);
/* Those that frames with these settings may need at any time. */
VkResult sdfgi_pipelines_require_all(struct backend *backend, const struct sdfgi_settings *settings);
/* Makes a variant of a raster pass for its render pass, which draws into `extent` pixels a side. */
VkResult sdfgi_pipelines_raster(struct backend *backend, enum pass pass, uint32_t variant,
                                VkRenderPass render_pass, uint32_t extent, VkPipeline *pipeline);

/* A pool for `sets` descriptor sets, with room for descriptors of `count` types in all. */
VkResult sdfgi_backend_pool_create(const struct backend *backend, const char *name, uint32_t sets,
                                   const VkDescriptorPoolSize *sizes, uint32_t count,
                                   VkDescriptorPoolCreateFlags flags, VkDescriptorPool *pool);
/* One set from a pool. */
VkResult sdfgi_backend_set_allocate(const struct backend *backend, const char *name, VkDescriptorPool pool,
                                    VkDescriptorSetLayout layout, VkDescriptorSet *set);

#endif
