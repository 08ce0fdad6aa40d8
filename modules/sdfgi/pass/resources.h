/* SPDX-License-Identifier: MIT
 * Device objects of a volume: the rows of resource_table.h, their descriptor sets, timers. */
#ifndef SDFGI_RESOURCES_H
#define SDFGI_RESOURCES_H

#include "backend.h"
#include "resource_rows.h"

/* Where the raster voxeliser draws: nothing but its fragments' stores. */
struct raster_target {
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipeline pipelines[PASS_VARIANTS];
    uint32_t extent; /* pixels a side */
};

struct resources {
    struct gpu_retired retired;
    struct sdfgi_settings settings; /* that it was made for */
    uint32_t made;                  /* objects so far, of sdfgi_resources_object_count */
    bool used;                      /* a frame that uses it has been recorded */
    struct gpu_buffer buffers[RESOURCE_COUNT];
    struct gpu_buffer readback; /* counters of the frames in flight */
    struct gpu_timer timer;
    uint32_t timer_tags[SDFGI_MAX_FRAMES_IN_FLIGHT * GPU_TIMER_STAMPS];
    uint32_t timer_counts[SDFGI_MAX_FRAMES_IN_FLIGHT];
    VkDescriptorPool pool;
    VkDescriptorSet sets[RESOURCE_SET_COUNT];
    struct raster_target raster;
    struct extent extent;
};

/* What a scene calls for besides what settings do. */
struct scene_extent {
    uint64_t instances;
    bool emits;     /* something in it does, or will */
    bool low_light; /* a view has reflections, or will have */
};

/* Begins resources without any object, with room for a scene. Reports failures, in words of the `caller`;
 * leaves *out as it was then. */
enum sdfgi_result sdfgi_resources_begin(struct backend *backend, const struct sdfgi_settings *settings,
                                        struct scene_extent scene, const char *caller,
                                        struct resources **out);
/* Objects that settings call for: buffers, and what else may take a while to make. */
uint32_t sdfgi_resources_object_count(const struct sdfgi_settings *settings);
/* Makes the next object. After a failure the resources are good for nothing but to be destroyed. */
VkResult sdfgi_resources_make_next(struct backend *backend, struct resources *resources);
/* All at once. Reports failures; leaves *out as it was then. */
enum sdfgi_result sdfgi_resources_create(struct backend *backend, const struct sdfgi_settings *settings,
                                         struct resources **out);
/* Destroys them at once: no update has used them. NULL is accepted. */
void sdfgi_resources_destroy(struct backend *backend, struct resources *resources);
/* Destroys them once no frame in flight can use them. NULL is accepted. */
void sdfgi_resources_retire(struct backend *backend, struct resources *resources);
/* Exchanges the light lists for empty ones with room for `light_cells` in each cascade, and the descriptor
 * sets with them. Changes nothing and returns false if memory is short. */
bool sdfgi_resources_grow_light_cells(struct backend *backend, struct resources *resources,
                                      uint64_t light_cells);
/* Adds what only scenes need in which something emits; it is not cleared. Changes nothing and returns false
 * if memory is short. */
bool sdfgi_resources_add_emitters(struct backend *backend, struct resources *resources);
/* Adds what light cells need that keep from where they get their light; it is not cleared. Likewise. */
bool sdfgi_resources_add_low_light(struct backend *backend, struct resources *resources);

/* Exchanges the buffer of instances for an empty one with room for `instances`. Changes nothing and returns
 * false if memory is short, or if no buffer of the device can be so long. */
bool sdfgi_resources_grow_instances(struct backend *backend, struct resources *resources, uint64_t instances);

/* The LOOKUP set of a context that has no light to show: every lookup is black. At most 64 KiB, and no
 * command. */
struct blank_set {
    struct gpu_buffer buffer;
    VkBufferView views[RESOURCE_COUNT]; /* of resources that are read as texels */
    VkDescriptorPool pool;
    VkDescriptorSet set;
};

VkResult sdfgi_blank_set_init(struct backend *backend, struct blank_set *blank);
void sdfgi_blank_set_finish(struct backend *backend, struct blank_set *blank);

#endif
