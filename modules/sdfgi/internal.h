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
#include "shaders/shared/counters.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/scratch.h"

enum {
    SDFGI_MAX_LIGHTS = 1024,
    SDFGI_MAX_MATERIALS = 4096,
    SDFGI_MAX_FRAMES_IN_FLIGHT = 8,
    SDFGI_MAX_GATHERS = 8, /* per update */
    SDFGI_RELIGHT_CELLS = 16384, /* light cells a frame that are lit again since others changed */
    SDFGI_CALM_FRAMES = 3,       /* at a slow pace, between frames in which cascades become complete */
};

/* A ring has settled when no probe texel changes by more than this share of its value from one ring to the
 * next. With a loop gain g the light still missing is at most g / (1 - g) times as much: 0.4 % of a white
 * room of albedo 0.8. */
#define SDFGI_CONVERGED_CHANGE (1.0f / 1024.0f)

/* ---- Sizes: memory.c */

/* Elements per cascade, and what else sizes in the resource table depend on. */
struct extent {
    uint64_t cells, blocks, probes, probes_per_side, cascades, ring_samples, scratch, occlusion;
    uint64_t light_cells, light_cells_max; /* room in the list, and how much it may become */
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
    struct gpu_buffer buffers[RESOURCE_COUNT];
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
    uint64_t light_cells_refused; /* how many cells there was no room for; 0: always enough */
    uint64_t retired_at;
    struct resources *next_retired;
};

/* ---- Pipelines, for the context's whole life: pipelines.c */

struct pipelines {
    VkDescriptorSetLayout set_layout, mesh_layout, material_layout, gather_layout;
    VkPipelineLayout layout, voxelize_layout, gather_layout_pipeline;
    VkPipeline passes[PASS_COUNT];
    VkPipeline voxelize_textured;
    VkSampler nearest;
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

/* Local cells [low, high) of a cascade; empty if low >= high along an axis. */
struct cell_box {
    int32_t low[3], high[3];
};

/* What a cascade is making new, step by step. */
struct change {
    bool active;
    struct cell_box boxes[SDFGI_MAX_CHANGES]; /* those within the cascade are generated; rays may end elsewhere in all */
    uint32_t count;
    struct cell_box kept;      /* complete all the while */
    int32_t before[3];         /* low corner of the cells that were complete, in the new place's cells */
    bool begun;                /* voxels have been made */
    uint32_t box;              /* of `boxes`: next to be voxelised, ... */
    int32_t slice;             /* ... from this cell on along its longest axis */
    uint32_t layer;            /* of blocks: next to get distances */
    uint64_t cells_left;
    bool at_once;              /* in sight: as fast as the budget allows */
};

struct cascade {
    int64_t origin[3];   /* world index of the low corner's cell, a multiple of SDFGI_PROBE_SPACING */
    double cell_size[3]; /* metres */
    bool placed;
    bool rebuild;   /* make it new whatever is there */
    bool relist;    /* the list of its light cells was lost: write it again */
    bool fresh;     /* no ring has been completed since nothing was there */
    bool published; /* its probes hold light */
    bool waits;     /* the camera is too fast for it to step */
    bool left_behind; /* it is to step for all that */
    uint32_t relight_next, relight_left; /* entries of its list: next to be lit again, still to be lit again */
    uint64_t listed_at;                  /* frame in which its light cells were listed last */
    struct cell_box window;  /* complete cells, which shaders may read */
    double share_low[3], share_high[3]; /* the part of it that lookups read, see border.c */
    bool share_moves;        /* it still widens */
    double spare[3];         /* cells that it leaves free on the side that the camera leaves: the low one if positive */
    struct change change;
    struct box edits[SDFGI_MAX_CHANGES]; /* world: geometry changed there since the last change began */
    uint32_t edit_count;
    bool edited;    /* its last change was one of geometry */
};

/* Places a cascade around a camera: at first centred to within half a probe; then moved by whole probe spacings,
 * once the camera is more than one off centre along any axis, along all axes at once that lookups leave free to step:
 * see border.c. A camera that oscillates around any point causes one step at most. Returns true if it moved. */
bool cascade_place(struct cascade *cascade, uint32_t resolution, const double camera[3]);
struct box cascade_box(const struct cascade *cascade, uint32_t resolution);
/* Cells that a box in the world touches, widened to whole probe spacings, clipped to the cascade. */
struct cell_box cascade_cells(const struct cascade *cascade, uint32_t resolution, const struct box *box);
struct cell_box cell_box_whole(uint32_t resolution);
struct cell_box cell_box_shifted(const struct cell_box *box, const int32_t by[3]);
struct cell_box cell_box_common(const struct cell_box *a, const struct cell_box *b);
bool cell_box_empty(const struct cell_box *box);
uint64_t cell_box_cells(const struct cell_box *box);
/* Cuts what is in `box` but not in `hole`, which it contains, into up to three boxes; returns how many. */
uint32_t cell_box_difference(const struct cell_box *box, const struct cell_box *hole, struct cell_box out[3]);
bool box_overlaps(const struct box *a, const struct box *b);
/* Floored division and remainder: right for negative coordinates too. */
int64_t floor_div(int64_t a, int64_t b);
int64_t floor_mod(int64_t a, int64_t b);

/* ---- Plan: plan.c */

enum need {
    NEED_VOXELS,
    NEED_VOXELS_RASTER,
    NEED_GENERATE,
    NEED_COMPLETE,
    NEED_SEED,
    NEED_LIST,
    NEED_EXACT,
    NEED_FLOOD,
    NEED_OCCLUSION,
    NEED_MASKS,
    NEED_DIRECT,
    NEED_LIGHT,
    NEED_TRACE,
    NEED_RAYS,
    NEED_BLEND,
    NEED_GATHER,
    NEED_COUNT,
};

/* What is known about the scene and this frame when the plan is made. */
struct situation {
    bool enabled, has_geometry, has_lights, converged, lights_changed, publish, gathers;
    bool generates, measures, completes; /* geometry, distances, cascades in this frame */
    bool fresh;                          /* nothing was there before */
    bool relights, list_grew;
    bool light_waits;                    /* for the next frame */
    bool rays_missing;                   /* some of this frame's are not remembered */
    bool raster, flood, occlusion, masks;
};

struct decision {
    bool run;
    const char *reason; /* static; for either outcome */
};

/* Pure: the same situation gives the same plan. */
void plan_make(const struct situation *situation, struct decision plan[PASS_COUNT]);

/* ---- Schedule: schedule.c */

enum step_kind { STEP_VOXELS, STEP_DISTANCE, STEP_COMPLETE };

struct step {
    enum step_kind kind;
    uint32_t cascade;
    struct cell_box box;   /* voxels */
    uint32_t first, count; /* distances: layers of 4^3 blocks along x */
};

enum { SDFGI_MAX_STEPS = 64 };

struct schedule {
    double camera[3];       /* m */
    double last_step, pace; /* along the fastest axis, probe spacings of cascade 0: of this frame, lasting */
    double heading[3];      /* share of that along each axis: a running mean */
    bool has_camera;
    struct step steps[SDFGI_MAX_STEPS]; /* of this frame */
    uint32_t step_count;
    bool from_nothing;      /* no cascade was complete before this frame */
    uint64_t cells;         /* voxelised or given distances in this frame */
    uint64_t steps_begun;   /* since the start */
    uint32_t calm_frames;   /* before this one, in a row, in which no cascade became complete */
};

/* Starts what cascades need and decides how much of it this frame does. */
void schedule_frame(struct sdfgi *gi, const double camera[3]);
/* Marks what was done as done, once it has been recorded. */
void schedule_finish(struct sdfgi *gi);
bool schedule_has(const struct sdfgi *gi, enum step_kind kind);
/* True if a cascade becomes complete in this frame. */
bool schedule_completes(const struct sdfgi *gi, uint32_t cascade);
bool schedule_idle(const struct sdfgi *gi);

/* ---- What lookups read: border.c */

/* Leaves cells free on the sides that the camera leaves, ... */
void border_leave(struct sdfgi *gi);
/* ... and moves all borders towards where the camera and the windows would have them. */
void border_move(struct sdfgi *gi);
bool border_rests(const struct sdfgi *gi);

/* ---- Convergence: settle.c */

struct settling {
    float change, least; /* of the newest ring since light was disturbed, and of all since then */
    uint32_t rings_without_fall;
};

void settle_reset(struct settling *settling);
/* Takes in the largest relative change of a probe texel over a ring. */
void settle_ring(struct settling *settling, float change);
bool settle_done(const struct settling *settling);

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
    struct schedule schedule;
    bool materials_changed, lights_changed, params_changed;
    uint32_t relight_budget, relight_cascade; /* cells a frame; the cascade whose turn it is */
    uint32_t relight_waits;                   /* frames in a row that have put it off */
    bool takes_step;                          /* a step of a cascade becomes complete in this frame */
    float emission_unit; /* radiance of the brightest material */
    struct sdfgi_frame_params params;
    double origin[3];
    float exposure;
    uint32_t seed;

    /* Convergence: rings are numbered from 1. */
    uint64_t ring, disturbed_ring, known_ring;
    uint32_t ring_frame; /* frame within the ring */
    uint32_t rays_missing; /* frames of rays until all of a ring are remembered */
    bool light_waits;    /* this frame sends none */
    float known_change, known_brightest;
    struct settling settling;
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
/* What not every host uses is made when it is asked for: on lavapipe these two take 0.23 s of 0.59. */
VkResult pipelines_make_gather(struct sdfgi *gi);
VkResult pipelines_make_textured(struct sdfgi *gi);
void pipelines_finish(struct sdfgi *gi);
struct gpu_shader shader_voxelize_raster_vert(void);
struct gpu_shader shader_voxelize_raster_frag(bool textured);

enum sdfgi_result resources_create(struct sdfgi *gi, const struct sdfgi_settings *settings,
                                   struct resources **out);
void resources_destroy(struct sdfgi *gi, struct resources *resources);
/* Destroys them once no frame in flight can use them. */
void resources_retire(struct sdfgi *gi);
/* Exchanges the list of light cells for an empty one with room for `light_cells` a cascade, and the descriptor
 * sets with it. Changes nothing if memory is short. */
bool resources_grow_light_cells(struct sdfgi *gi, uint64_t light_cells);
void resources_collect(struct sdfgi *gi, bool all);

void scene_init(struct sdfgi *gi);
void scene_finish(struct sdfgi *gi);
void scene_collect(struct sdfgi *gi);
/* Has the cascades that a box touches make it new, and restarts convergence. */
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
    bool grouped, group_timed; /* between pass_group_begin and _end; the group's first pass has begun */
};

/* Push constants of a pass. */
struct pass_args {
    uint32_t size;
    const void *data;
};
#define PASS_ARGS(args) ((struct pass_args){ sizeof(args), &(args) })
#define NO_ARGS         ((struct pass_args){ 0, NULL })

void pass_begin(struct frame *frame, enum pass pass);
void pass_end(struct frame *frame);
/* Passes that touch nothing in common run side by side. Timestamps between them would have each wait for the one before: a group
 * has one time, that of its first pass. */
void pass_group_begin(struct frame *frame);
void pass_group_end(struct frame *frame);
/* Barrier, push constants and dispatch of one step of a pass that has begun. */
void pass_dispatch(struct frame *frame, enum pass pass, struct pass_args args, uint32_t x,
                   uint32_t y, uint32_t z);
void pass_dispatch_cells(struct frame *frame, enum pass pass, struct pass_args args);
/* One thread per `per_thread` cells of a box. */
void pass_dispatch_box(struct frame *frame, enum pass pass, struct pass_args args, const struct cell_box *box,
                       uint32_t per_thread);
/* With the workgroups of a record of indirect arguments. */
void pass_dispatch_indirect(struct frame *frame, enum pass pass, struct pass_args args,
                            uint32_t record);
/* Over the light cells in the blocks of a cascade that were renewed last. */
void pass_dispatch_dirty(struct frame *frame, enum pass pass, struct pass_args args, uint32_t cascade);
/* Zeroes a part of a buffer. */
void pass_clear(struct frame *frame, enum resource resource, uint64_t offset, uint64_t bytes);
uint64_t pass_reads(enum pass pass);
uint64_t pass_writes(enum pass pass);
const char *pass_name(enum pass pass);
const char *pass_unit(enum pass pass);

void voxelize_record(struct frame *frame, uint32_t cascade, const struct cell_box *box);
/* Axis across which boxes around what goes and comes lie in strips (dirty_bounds.glsl); -1: nobody asks for any. */
int32_t change_bounds_axis(const struct change *change);

/* Layers of blocks of 4^3 cells along x whose distances to make. Where anything is known of how bits changed, cells outside
 * `changed` have the bits that their stored distances were made from, and hold those distances; inside, the bits are new and
 * the distances are not looked at. The same boxes go with all parts of a change. */
struct distance_part {
    uint32_t first, count;
    const struct cell_box *changed; /* up to SDFGI_MAX_CHANGES */
    uint32_t dirty_count;         /* 0: everything is new */
};

/* Makes distances equal, bit for bit, to those made of the same bits as a whole. Searches only blocks that a change may have
 * reached. The flood cannot be cut: it makes all of a cascade with its first layer, and nothing with the others. */
void distance_field_record(struct frame *frame, uint32_t cascade, const struct distance_part *part);
void occlusion_record(struct frame *frame, uint32_t cascade);
void probe_place_record(struct frame *frame, uint32_t cascade);
/* Makes room where the newest counters known say that the list was too short. */
void light_cache_make_room(struct sdfgi *gi);
/* Decides whose direct light is to be made again, from what this frame completes. */
void light_cache_plan(struct sdfgi *gi);
/* True if cells that stay wait for direct light. */
bool light_cache_relights(const struct sdfgi *gi);
/* True if all light cells of a cascade are listed as new in this frame. */
bool light_cache_is_new(const struct sdfgi *gi, uint32_t cascade);
/* Empties the scratch buffer for a list; marks a cascade's light cells there, lists them; gives those in renewed blocks masks and
 * direct light, then light that bounces. */
void light_cache_clear_record(struct frame *frame);
void light_cache_mark_record(struct frame *frame, uint32_t cascade);
void light_cache_list_record(struct frame *frame, uint32_t cascade);
void light_cache_renew_record(struct frame *frame, uint32_t cascade);
void light_cache_renew_bounce_record(struct frame *frame, uint32_t cascade);
/* Direct light of all cells of a cascade; of as many of those that wait for it as one frame may make. */
void light_cache_direct_record(struct frame *frame, uint32_t cascade);
void light_cache_relight_record(struct frame *frame);
/* What leaves the surfaces, in all cascades. */
void light_cache_bounce_record(struct frame *frame);
/* Empties the sums of this ring, the one before and the ray cache. */
void probe_reset_record(struct frame *frame, uint32_t cascade);
void probe_seed_record(struct frame *frame, uint32_t cascade);
/* In the finest `cascades` of them. */
void ray_invalidate_record(struct frame *frame, uint32_t cascades);
/* Lists those rays of this frame that are not remembered, and traces them; adds up what light all of them find; publishes it. */
void ray_list_record(struct frame *frame);
void probe_trace_record(struct frame *frame);
void probe_sum_record(struct frame *frame);
void probe_blend_record(struct frame *frame, bool ring_ends);

/* Takes in what a finished frame left in its slot. */
void readback_read(struct sdfgi *gi, uint32_t slot);
/* Copies the counters to the host at the end of a frame. */
void readback_record(struct frame *frame);
uint32_t ring_frames(const struct sdfgi_settings *settings);

#define RESOURCE_BIT(id) (UINT64_C(1) << RESOURCE_##id)

#endif
