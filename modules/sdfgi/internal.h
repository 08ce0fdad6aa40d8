/* SPDX-License-Identifier: MIT
 * What the library's own files share. Nothing here is visible to a host. */
#ifndef SDFGI_INTERNAL_H
#define SDFGI_INTERNAL_H

#include <sdfgi/sdfgi.h>

#include "gpu.h"
#include "pass_table.h"
#include "pool.h"
#include "resource_table.h"

#include "shaders/shared/args.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/frame.h"

enum {
    SDFGI_MAX_LIGHTS = 1024,
    SDFGI_MAX_MATERIALS = 4096,
    SDFGI_MAX_FRAMES_IN_FLIGHT = 8,
    SDFGI_MAX_GATHERS = 8, /* per update */
};

/* A ring has settled when no probe texel changes by more than this share of its value from one ring to the
 * next. With a loop gain g the light still missing is at most g / (1 - g) times as much: 0.4 % of a white
 * room of albedo 0.8. */
#define SDFGI_CONVERGED_CHANGE (1.0f / 1024.0f)

/* ---- Sizes: memory.c */

/* Elements per cascade, and what else sizes in the resource table depend on. */
struct extent {
    uint64_t cells, blocks, probes, probes_per_side, light_cells, cascades, ring_samples, scratch, occlusion;
    uint32_t atlas_width, atlas_height;
};

struct extent extent_from_settings(const struct sdfgi_settings *settings);
uint64_t resource_size(enum resource resource, const struct extent *extent);
const char *resource_name(enum resource resource);
enum sdfgi_memory_category resource_category(enum resource resource);
/* How a buffer is bound. */
VkDescriptorType resource_descriptor(enum resource resource);
uint64_t readback_size(uint32_t frames_in_flight);
/* Height of a cell over its width. */
double y_scale_factor(enum sdfgi_y_scale scale);
/* Rays per ring: every one of the 25 texels gets the same number. */
uint32_t ring_samples(const struct sdfgi_settings *settings);

/* ---- Device objects of a context that is switched on: resources.c */

struct resources {
    struct gpu_buffer buffers[RESOURCE_BUFFER_COUNT];
    struct gpu_image irradiance;
    struct gpu_buffer readback; /* counters of the frames in flight */
    struct gpu_timer timer;
    uint32_t timer_tags[SDFGI_MAX_FRAMES_IN_FLIGHT * GPU_TIMER_SPANS];
    uint32_t timer_counts[SDFGI_MAX_FRAMES_IN_FLIGHT];
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkDescriptorSet gather_sets[SDFGI_MAX_FRAMES_IN_FLIGHT][SDFGI_MAX_GATHERS];
    VkRenderPass raster_pass;
    VkFramebuffer raster_target;
    VkPipeline raster_pipelines[2]; /* without and with textures */
    struct extent extent;
    bool atlas_ready; /* the atlas is in VK_IMAGE_LAYOUT_GENERAL */
    uint64_t retired_at;
    struct resources *next_retired;
};

/* ---- Pipelines, for the context's whole life: pipelines.c */

struct pipelines {
    VkDescriptorSetLayout set_layout, mesh_layout, material_layout, gather_layout;
    VkPipelineLayout layout, voxelize_layout, gather_layout_pipeline;
    VkPipeline passes[PASS_COUNT];
    VkPipeline voxelize_textured;
    VkSampler linear, nearest;
};

/* ---- Scene: scene.c */

struct mesh {
    struct sdfgi_mesh_desc desc;
    VkDescriptorSet set;
    VkDescriptorPool pool;
};

struct material {
    struct sdfgi_material_desc desc;
    VkDescriptorSet set; /* null: no textures */
    VkDescriptorPool pool;
};

struct box {
    double min[3], max[3];
};

struct instance {
    struct sdfgi_instance_desc desc;
    struct box bounds; /* world */
};

struct light {
    struct sdfgi_light_desc desc;
};

/* Descriptor sets that a frame in flight may still use. */
struct retired_set {
    VkDescriptorSet set;
    VkDescriptorPool pool;
    uint64_t frame;
};

struct set_pool {
    VkDescriptorPool handle;
    uint32_t free;
    struct set_pool *next;
};

struct scene {
    struct pool meshes, materials, instances, lights;
    struct set_pool *set_pools;
    struct retired_set *retired;
    uint32_t retired_count, retired_capacity;
    struct sdfgi_sky sky;
};

/* ---- Cascades: cascade.c */

struct cascade {
    int64_t origin[3];   /* world index of the low corner's cell, a multiple of SDFGI_PROBE_SPACING */
    double cell_size[3]; /* metres */
    bool placed;
    bool dirty;     /* geometry: generate it again */
    bool fresh;     /* no ring has been completed since it was generated */
    bool published; /* its probes hold light */
};

/* Places a cascade around a camera: centred to within half a probe, moved only when the camera is more than a
 * whole probe spacing off centre. Returns true if it moved. */
bool cascade_place(struct cascade *cascade, uint32_t resolution, const double camera[3]);
struct box cascade_box(const struct cascade *cascade, uint32_t resolution);
bool box_overlaps(const struct box *a, const struct box *b);
/* Floored division and remainder: right for negative coordinates too. */
int64_t floor_div(int64_t a, int64_t b);
int64_t floor_mod(int64_t a, int64_t b);

/* ---- Plan: plan.c */

enum need {
    NEED_VOXELS,
    NEED_VOXELS_RASTER,
    NEED_GENERATE,
    NEED_EXACT,
    NEED_FLOOD,
    NEED_OCCLUSION,
    NEED_MASKS,
    NEED_DIRECT,
    NEED_LIGHT,
    NEED_TRACE,
    NEED_BLEND,
    NEED_GATHER,
    NEED_COUNT,
};

/* What is known about the scene and this frame when the plan is made. */
struct situation {
    bool enabled, any_dirty, has_geometry, has_lights, converged, lights_changed, publish, gathers;
    bool raster, flood, occlusion, masks;
};

struct decision {
    bool run;
    const char *reason; /* static; for either outcome */
};

/* Pure: the same situation gives the same plan. */
void plan_make(const struct situation *situation, struct decision plan[PASS_COUNT]);

/* ---- Context */

/* One frame in flight. */
struct frame_slot {
    bool timed;   /* spans may have been recorded */
    bool counted; /* counters were copied */
    bool ring_ends;
    uint64_t ring;
};

struct pass_state {
    uint32_t dispatches;
    uint64_t work;
    uint64_t gpu_ns;
    bool gpu_ns_valid;
};

struct sdfgi {
    struct gpu_device device;
    VkAllocationCallbacks callbacks;
    struct sdfgi_allocator allocator;
    struct sdfgi_log log;
    struct sdfgi_settings settings;
    uint32_t frames_in_flight;
    bool device_lost;

    struct pipelines pipelines;
    struct scene scene;
    struct resources *resources; /* NULL while disabled */
    struct resources *retired;
    uint64_t frame; /* calls of sdfgi_update */

    struct cascade cascades[SDFGI_MAX_CASCADES];
    bool materials_changed, lights_changed, params_changed;
    float emission_unit; /* radiance of the brightest material */
    struct sdfgi_frame_params params;
    double origin[3];
    float exposure;
    uint32_t seed;

    /* Convergence: rings are numbered from 1. */
    uint64_t ring, disturbed_ring, known_ring;
    uint32_t ring_frame; /* frame within the ring */
    float known_change, known_brightest;
    bool converged, active;

    struct frame_slot slots[SDFGI_MAX_FRAMES_IN_FLIGHT];
    uint32_t gathers; /* since the last update */

    struct decision plan[PASS_COUNT];
    struct pass_state passes[PASS_COUNT];
    uint32_t counters[SDFGI_COUNTER_COUNT]; /* of the newest finished frame */
    uint64_t update_count;
    uint32_t command_count;
};

/* ---- Messages: message.c */

void message(const struct sdfgi *gi, enum sdfgi_message id, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
const char *message_hint(enum sdfgi_message id);
/* Reports a failed Vulkan call and turns it into a result. */
enum sdfgi_result message_vulkan(struct sdfgi *gi, VkResult result, const char *what);
enum sdfgi_result invalid(const struct sdfgi *gi, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

void *host_alloc(const struct sdfgi_allocator *allocator, size_t size);
void host_free(const struct sdfgi_allocator *allocator, void *memory);

/* ---- Parts */

VkResult pipelines_init(struct sdfgi *gi);
void pipelines_finish(struct sdfgi *gi);
struct gpu_shader shader_voxelize_raster_vert(void);
struct gpu_shader shader_voxelize_raster_frag(bool textured);

enum sdfgi_result resources_create(struct sdfgi *gi, const struct sdfgi_settings *settings,
                                   struct resources **out);
void resources_destroy(struct sdfgi *gi, struct resources *resources);
/* Destroys them once no frame in flight can use them. */
void resources_retire(struct sdfgi *gi);
void resources_collect(struct sdfgi *gi, bool all);

void scene_init(struct sdfgi *gi);
void scene_finish(struct sdfgi *gi);
void scene_collect(struct sdfgi *gi);
/* Marks the cascades that a box touches, and restarts convergence. */
void scene_touch(struct sdfgi *gi, const struct box *box);
/* The light is no longer what it was: go on until it has settled again. */
void light_disturb(struct sdfgi *gi);

void upload_params(struct sdfgi *gi);
void upload_record(struct sdfgi *gi, struct gpu_recorder *rec);

/* What a stage needs to record itself. */
struct frame {
    struct sdfgi *gi;
    struct gpu_recorder rec;
    uint32_t slot;
};

void pass_begin(struct frame *frame, enum pass pass);
void pass_end(struct frame *frame);
/* Barrier, push constants and dispatch of one step of a pass that has begun. */
void pass_dispatch(struct frame *frame, enum pass pass, const struct sdfgi_pass_args *args, uint32_t x,
                   uint32_t y, uint32_t z);
void pass_dispatch_cells(struct frame *frame, enum pass pass, const struct sdfgi_pass_args *args);
void pass_dispatch_light_cells(struct frame *frame, enum pass pass, const struct sdfgi_pass_args *args);
/* Zeroes a part of a buffer. */
void pass_clear(struct frame *frame, enum resource resource, uint64_t offset, uint64_t bytes);
uint64_t pass_reads(enum pass pass);
uint64_t pass_writes(enum pass pass);
const char *pass_name(enum pass pass);
const char *pass_unit(enum pass pass);

void voxelize_record(struct frame *frame, uint32_t cascade);
void distance_field_record(struct frame *frame, uint32_t cascade);
void occlusion_record(struct frame *frame, uint32_t cascade);
void probe_place_record(struct frame *frame, uint32_t cascade);
void light_cache_list_record(struct frame *frame, uint32_t cascade);
void light_cache_direct_record(struct frame *frame, uint32_t cascade);
void light_cache_bounce_record(struct frame *frame, uint32_t cascade);
/* Empties the sums of this ring, and the ray cache too if rays may end somewhere new. */
void probe_reset_record(struct frame *frame, uint32_t cascade, bool rays_too);
void probe_trace_record(struct frame *frame, uint32_t cascade);
void probe_blend_record(struct frame *frame, uint32_t cascade, bool ring_ends);

/* Takes in what a finished frame left in its slot. */
void readback_read(struct sdfgi *gi, uint32_t slot);
/* Copies the counters to the host at the end of a frame. */
void readback_record(struct frame *frame);
uint32_t ring_frames(const struct sdfgi_settings *settings);

#define RESOURCE_BIT(id) (UINT64_C(1) << RESOURCE_##id)

#endif
