/* SPDX-License-Identifier: MIT
 * What the host renderer's files share among themselves. */
#ifndef HOST_INTERNAL_H
#define HOST_INTERNAL_H

#include <stdatomic.h>
#include <vulkan/vulkan.h>

#include "host.h"
#include "host_code.h"
#include "modules/gltf/gltf_scene.h"
#include "shaders/host/host_shared.h"

#define HOST_COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* ---- Device (host_device.c, host_cache.c, host_resource.c)
 * -------------------------------------------------- */

/* Pipelines kept on disk (host_cache.c). */
struct host_cache {
    VkPipelineCache handle;  /* VK_NULL_HANDLE: none is kept */
    char path[1024];         /* of the file */
    uint64_t saved_checksum; /* of what the file holds; size 0: nothing that could be used */
    size_t saved_size;
};

struct host_device {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue;
    VkCommandPool pool;
    VkPhysicalDeviceMemoryProperties memory;
    VkPhysicalDeviceLimits limits;
    struct host_cache cache;
    bool anisotropy;
    VkFormat hdr_format;     /* RGBA32F where it can be blended, else RGBA16F */
    uint64_t timestamp_mask; /* valid bits of the queue's timestamps; 0: none */
    struct host_device_info info;
    atomic_uint validation_count; /* GI may be prepared by another thread */
    char error[256];
};

/* Makes the device's cache and fills it from the file in `folder`; NULL: no cache. */
void host_cache_init(struct host_device *device, const char *folder);
/* Writes what has changed, and destroys the cache. */
void host_cache_finish(struct host_device *device);

/* Records the failure and returns false unless `result` is a success. */
bool host_check(struct host_device *device, VkResult result, const char *what);
/* Records a formatted failure and returns false. */
bool host_fail(struct host_device *device, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* calloc that records its failure. */
void *host_device_alloc(struct host_device *device, size_t count, size_t size);

struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped; /* host-visible buffers alone */
};

struct host_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkFormat format;
    uint32_t width, height, depth, layers, mips; /* depth: 0: two dimensions */
};

struct host_image_desc {
    VkFormat format;
    uint32_t width, height, depth, layers, mips; /* depth: 0: two dimensions; layers, mips: 0: 1 */
    bool array_view;                             /* 2D_ARRAY even with one layer */
    VkImageUsageFlags usage;
};

bool host_buffer_create(struct host_device *device, VkDeviceSize size, VkBufferUsageFlags usage,
                        bool host_visible, struct host_buffer *out);
void host_buffer_destroy(struct host_device *device, struct host_buffer *buffer);
bool host_image_create(struct host_device *device, const struct host_image_desc *desc,
                       struct host_image *out);
void host_image_destroy(struct host_device *device, struct host_image *image);

/* A command buffer that is submitted and waited for at once. */
VkCommandBuffer host_commands_begin(struct host_device *device);
bool host_commands_finish(struct host_device *device, VkCommandBuffer cmd);

void host_image_barrier(VkCommandBuffer cmd, VkImage image, uint32_t first_mip, uint32_t mips,
                        const VkImageLayout layouts[2], const VkPipelineStageFlags stages[2],
                        const VkAccessFlags accesses[2]);

/* Copies bytes into a device-local buffer. */
bool host_buffer_upload(struct host_device *device, struct host_buffer *buffer, VkDeviceSize offset,
                        const void *data, VkDeviceSize size);

/* Reads a colour image that is in SHADER_READ_ONLY_OPTIMAL, and leaves it so; `data` holds whole texels. */
bool host_image_download(struct host_device *device, const struct host_image *image, VkDeviceSize texel_bytes,
                         void *data);

/* ---- Scene (host_scene.c, host_material.c, host_texture.c, host_lights.c) --------------------------- */

/* Byte offsets into the scene's geometry buffer. */
struct host_primitive {
    VkDeviceSize positions, normals, tangents, uv[2], colors, indices;
    uint32_t vertex_count, index_count;
    int32_t material;
    bool has_colors;
    float bounds_min[3], bounds_max[3];
};

struct host_instance {
    uint32_t primitive;
    double transform[16];
    double center[3], radius; /* bounding sphere, world */
    bool mirrored;
};

enum host_cull { HOST_CULL_NONE, HOST_CULL_BACK, HOST_CULL_FRONT, HOST_CULL_COUNT };

struct host_material {
    VkDescriptorSet set;
    uint32_t flags; /* HOST_MATERIAL_* */
    bool double_sided;
    bool casts_shadow; /* false for blended materials of which less than half is there */
    bool shadow_test;  /* casts, with holes */
    int32_t gi_uv_set; /* of gi's textures */
    struct sdfgi_material_desc gi;
};

/* A light as scene and view give it, world space. */
struct host_scene_light {
    enum host_light_type type;
    double position[3];
    double direction[3], rest[3];  /* unit; at rest: before it moved, as host_scene_move_lights has it */
    float intensity[3], steady[3]; /* likewise */
    float range_m, inner_rad, outer_rad, angle_rad;
    bool cube; /* needs six shadow layers */
};

enum { HOST_SAMPLER_COUNT = 36 };

struct host_textures {
    struct host_image *images; /* two per image of the file: linear, sRGB; made on demand */
    uint32_t image_count;
    struct host_image white;
    VkSampler samplers[HOST_SAMPLER_COUNT];
};

/* A picture of all directions (host_environment.c). */
struct host_environment_map {
    bool exists;
    struct host_image image;
    VkSampler sampler;
    struct sdfgi_sky_harmonics harmonics;
};

struct host_scene {
    struct host_device *device;
    struct host_buffer geometry, material_data;
    struct host_textures textures;
    VkDescriptorSetLayout material_layout;
    VkDescriptorPool material_pool;
    struct host_primitive *primitives;
    struct host_instance *instances;
    struct host_material *materials;
    struct host_scene_light *suns, *lights;
    struct host_sky sky;
    struct host_environment_map environment;
    struct host_fog fog;
    uint32_t primitive_count, instance_count, material_count, sun_count, light_count;
    double center[3], radius; /* of everything drawn; the centre in whole 1/64 m */
};

const struct host_material *host_instance_material(const struct host_scene *scene, uint32_t instance);
/* Single-sided faces are invisible from behind; a mirrored instance turns its triangles round. */
enum host_cull host_instance_cull(const struct host_scene *scene, uint32_t instance);

bool host_materials_init(struct host_scene *scene, const struct gltf_scene *gltf,
                         const struct host_view *view);
void host_materials_finish(struct host_scene *scene);
bool host_lights_init(struct host_scene *scene, const struct gltf_scene *gltf, const struct host_view *view);

/* ---- GI (host_gi.c, and host_volumes.c for what only tools ask): all that calls the library --------- */

struct host_gi;

struct host_gi *host_gi_create(struct host_device *device, const struct host_scene *scene,
                               const struct host_renderer_desc *desc, uint32_t frames_in_flight);
void host_gi_destroy(struct host_gi *gi);
sdfgi *host_gi_context(const struct host_gi *gi);
VkDescriptorSetLayout host_gi_layout(const struct host_gi *gi);
VkDescriptorSet host_gi_set(const struct host_gi *gi); /* VK_NULL_HANDLE while lookups give nothing */
bool host_gi_update(struct host_gi *gi, VkCommandBuffer cmd, const struct host_scene *scene,
                    const struct sdfgi_frame_desc *frame);
/* NULL on failure. */
sdfgi_view *host_gi_view_create(struct host_gi *gi, const struct sdfgi_view_desc *desc);
void host_gi_view_destroy(struct host_gi *gi, sdfgi_view *view);
bool host_gi_resolve(struct host_gi *gi, sdfgi_view *view, VkCommandBuffer cmd,
                     const struct sdfgi_resolve_desc *desc);
bool host_gi_debug(struct host_gi *gi, VkCommandBuffer cmd, const struct sdfgi_debug_desc *desc);
bool host_gi_set_settings(struct host_gi *gi, const struct sdfgi_settings *settings);
void host_gi_get_settings(const struct host_gi *gi, struct sdfgi_settings *settings);
void host_gi_get_report(const struct host_gi *gi, struct sdfgi_report *report);

/* ---- Pipelines (host_passes.c, host_pipeline.c) ----------------------------------------------------- */

/* What the forward shader knows of GI: nothing, the lookup, or pictures of what was looked up before. */
enum host_forward { HOST_FORWARD_PLAIN, HOST_FORWARD_GI, HOST_FORWARD_GATHERED, HOST_FORWARD_COUNT };

struct host_passes {
    VkRenderPass prepass, forward, shadow, picture;
};

struct host_pipelines {
    VkDescriptorSetLayout frame_layout, post_layout, light_layout;
    VkPipelineLayout layouts[HOST_FORWARD_COUNT]; /* sets frame, material[, GI or its pictures]; plain also
                                                     for all but forward */
    VkPipelineLayout post_pipeline_layout;
    VkPipeline prepass[HOST_CULL_COUNT];
    /* Those that the scene needs, once they are wanted; [whether it is blended][whether it reflects]. */
    VkPipeline forward[HOST_FORWARD_COUNT][HOST_CULL_COUNT][2][2];
    bool forward_made[HOST_FORWARD_COUNT];
    float rays_end, blended_end; /* roughness from which on opaque materials do not, and blended ones */
    VkPipeline shadow_solid, shadow_tested;
    VkPipeline sky, exposure, tonemap;
};

/* Instead of an exposure: colours are shown as they are. */
#define HOST_TONE_NONE (-1.0f)

struct host_tone_push {
    float exposure;
    int32_t supersample;
    int32_t first_column; /* of the picture that is filled */
};

bool host_passes_init(struct host_device *device, struct host_passes *passes);
void host_passes_finish(struct host_device *device, struct host_passes *passes);
/* A pass that fills one colour image and leaves it in `final_layout`. */
bool host_pass_picture_create(struct host_device *device, VkFormat format, VkImageLayout final_layout,
                              VkRenderPass *out);
/* `fog`: frames have fog. */
bool host_pipelines_init(const struct host_scene *scene, const struct host_passes *passes,
                         VkDescriptorSetLayout gi_layout, bool fog, struct host_pipelines *pipelines);
/* Whose layout the sky's pipeline has. */
enum host_forward host_sky_kind(const struct host_scene *scene);
void host_pipelines_finish(struct host_device *device, struct host_pipelines *pipelines);
/* Bindings from 0 on, one descriptor each. */
bool host_set_layout_create(struct host_device *device, const VkDescriptorType *types, uint32_t count,
                            VkShaderStageFlags stages, VkDescriptorSetLayout *out);
/* A push constant range of size 0 is none. */
bool host_pipeline_layout_create(struct host_device *device, const VkDescriptorSetLayout *sets,
                                 uint32_t set_count, VkPushConstantRange push, VkPipelineLayout *out);
bool host_pipeline_compute_create(struct host_device *device, struct host_code code, VkPipelineLayout layout,
                                  VkPipeline *out);
bool host_pipeline_tonemap_create(struct host_device *device, const struct host_pipelines *pipelines,
                                  VkRenderPass pass, VkPipeline *out);

/* ---- Eyes (host_eye.c) ------------------------------------------------------------------------------ */

#include "host_eye.h"

/* ---- Shadow maps (host_shadow.c, host_shadow_sun.c) ------------------------------------------------- */

enum { HOST_MAX_LAYERS = 192 }; /* 32 point lights */

/* Relative to the scene's centre. */
struct host_sun_cascade {
    bool rendered;
    double direction[3];  /* of the sun */
    double center[2];     /* along right and up of the light's space; whole texels */
    double half_m;        /* half the side of the map */
    double near_m, far_m; /* along forward */
};

struct host_shadows {
    struct host_image sun_map, punctual_map;
    VkImageView sun_views[HOST_SUN_LAYERS], punctual_views[HOST_MAX_LAYERS];
    VkFramebuffer sun_targets[HOST_SUN_LAYERS], punctual_targets[HOST_MAX_LAYERS];
    struct host_sun_cascade cascades[HOST_SUN_LAYERS];
    uint32_t layer_count;               /* of punctual_map */
    uint32_t cube_runs, single_runs;    /* how many lights of either kind have maps at a time */
    int32_t run_light[HOST_MAX_LAYERS]; /* whose map a run of layers holds; -1: nobody's */
    int32_t *light_layer;               /* per light of the scene: its first layer; -1: none */
    bool *wanted;                       /* scratch, per light */
    struct host_layer_data layers[HOST_MAX_LAYERS];
    VkSampler sampler;
};

struct host_renderer;

bool host_shadows_init(struct host_renderer *renderer);
void host_shadows_finish(struct host_renderer *renderer);
/* Chooses this frame's maps and records the missing ones. */
void host_shadows_record(struct host_renderer *renderer, VkCommandBuffer cmd);
void host_sun_record(struct host_renderer *renderer, VkCommandBuffer cmd);
void host_sun_fill(const struct host_renderer *renderer, uint32_t sun, struct host_sun_data *out);

/* ---- Frame (host_camera.c, host_draw.c, host_lookup.c, host_fog.c, host_renderer.c, host_frame.c,
 * host_read.c)
 * ----------------- */

/* A camera resolved for one frame. Everything in float is relative to `origin`. */
struct host_camera_frame {
    double origin[3];
    double position[3];                 /* orthographic: where the axis meets the near plane */
    double right[3], up[3], forward[3]; /* unit */
    bool orthographic;
    double half_x, half_y; /* of what is seen: 1 m away; orthographic: anywhere */
    double near_m;         /* from the camera to the near plane */
    double range_m;        /* orthographic: from there to the far plane */
    float clip[4][4];      /* rows */
};

/* Along its right axis. */
void host_camera_move_aside(struct host_camera_frame *camera, double distance_m);
void host_camera_resolve(const struct host_camera *camera, double aspect, struct host_camera_frame *out);
/* Where cascades are to be centred. How far an orthographic camera stands off what it shows means nothing:
 * the point of its axis beside the centre of the scene. */
void host_camera_center(const struct host_camera_frame *camera, const double scene_center[3], double out[3]);

enum { HOST_SLOTS = 2 };

/* Where frames take the time. */
enum host_stamp {
    HOST_STAMP_BEGIN,
    HOST_STAMP_UPDATED,
    HOST_STAMP_SHADOWED,
    HOST_STAMP_END,
    HOST_STAMP_PLAIN_COUNT,                   /* without fog there are no others */
    HOST_STAMP_SEEN = HOST_STAMP_PLAIN_COUNT, /* fog begins */
    HOST_STAMP_FOGGED,
    HOST_STAMP_COUNT
};

struct host_slot {
    VkCommandBuffer cmd;
    VkFence fence;
    bool in_flight;
    struct host_buffer lights, layers;
    struct host_slot_eye eyes[HOST_EYES];
};

/* Debug views (host_debug.c). */
struct host_debug_desc {
    enum sdfgi_debug_view view;
    float exposure; /* factor on light; 0: the library's hint */
};

/* Light at single points (host_sample.c). */
struct host_sampler {
    bool ready;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    struct host_buffer results;
};

/* Froxels, and the passes that fill them (host_fog.c); all empty where there is no fog. */
struct host_fog_passes {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout, air_layout; /* sets frame, fog[, GI] */
    VkPipeline tiles, scatter, integrate;
    VkPipeline air; /* once GI has light */
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkSampler sampler;
    struct host_image volume; /* froxels, and a slice more: see fog_integrate.comp */
    struct host_image blocks; /* of froxels: GI's light in the air */
    struct host_buffer seen;  /* of the picture, by columns */
    uint32_t tile_side;       /* pixels of the target */
    float scale;              /* what froxels hold over radiance */
    double range_m;           /* to the far side of the last slice */
};

struct host_renderer {
    struct host_device *device;
    struct host_scene *scene;
    struct host_gi *gi;
    uint32_t width, height, supersample; /* of an eye's picture, in pixels */
    uint32_t picture_width;              /* of the whole one */
    uint32_t eye_count, eye;             /* eye: the one that is being recorded */
    float eye_distance_m;
    uint32_t seed;
    float gi_exposure;
    struct host_lookups lookups;
    bool without_gi; /* the frame being recorded */
    struct host_effects left_out;
    struct host_passes passes;
    struct host_pipelines pipelines;
    struct host_shadows shadows;
    struct host_targets targets;
    struct host_slot slots[HOST_SLOTS];
    VkDescriptorPool pool;
    VkDescriptorSet environment_set;                             /* none if there is no environment */
    VkDescriptorSet post_sets[HOST_EYES], debug_sets[HOST_EYES]; /* of the passes that follow */
    VkSampler nearest;
    struct host_buffer exposure;
    struct host_sampler sampler;
    struct host_fog_passes fog;
    VkQueryPool queries;     /* HOST_STAMP_COUNT per slot */
    struct host_times times; /* of the newest finished frame */
    uint64_t submit_count;
    bool has_frame;
    struct host_camera_frame head;   /* of the last frame */
    struct host_camera_frame camera; /* of what is being recorded: an eye's, or the head's */
    enum host_aov shown;
    uint32_t *blend_order; /* scratch, one per instance */
    double *blend_distance;
};

struct host_frustum {
    double planes[5][4]; /* inside: dot(n, p) + d >= 0 for positions relative to `origin` */
    uint32_t count;
    double origin[3];
};

/* The forward pipelines of frames as things are, for blended surfaces or for others. */
enum host_forward host_forward_kind(const struct host_renderer *renderer, bool blended);
/* Makes those that the scene needs and that are missing. Drivers compile the lookup for long, so that
 * pipelines of the other kind, or for materials that the scene lacks, would cost every start seconds. */
bool host_forward_prepare(struct host_renderer *renderer);
VkPipeline host_forward_pipeline(const struct host_renderer *renderer, enum host_forward kind,
                                 uint32_t instance);

bool host_frustum_sees(const struct host_frustum *frustum, const struct host_instance *instance);

/* State between draws; positions are relative to `origin`. */
struct host_draw_context {
    VkCommandBuffer cmd;
    VkPipelineLayout layout;
    double origin[3];
    VkPipeline bound;
    int32_t material;
};

void host_draw_instance(struct host_renderer *renderer, struct host_draw_context *draw, uint32_t instance,
                        VkPipeline pipeline);
/* `clip`: 16 floats, rows. */
void host_draw_shadow(struct host_renderer *renderer, VkCommandBuffer cmd, const struct host_frustum *frustum,
                      const double origin[3], const float *clip);
void host_draw_prepass(struct host_renderer *renderer, VkCommandBuffer cmd);
void host_draw_forward(struct host_renderer *renderer, const struct host_slot *slot);
void host_viewport_set(VkCommandBuffer cmd, uint32_t x, uint32_t width, uint32_t height);

/* Resolves the view, if there is one, from what the prepass has drawn. */
bool host_lookup_record(struct host_renderer *renderer, struct host_slot *slot);
/* Makes the view of a picture of this size, unless lookups are made where surfaces are shaded. */
bool host_lookup_init(struct host_renderer *renderer, uint32_t width, uint32_t height);

bool host_fog_exists(const struct host_scene *scene);
/* These do nothing where there is no fog. */
bool host_fog_init(struct host_renderer *renderer);
void host_fog_finish(struct host_renderer *renderer);
/* Of the size of the targets, into the sets of all slots. */
bool host_fog_targets_init(struct host_renderer *renderer);
void host_fog_targets_finish(struct host_renderer *renderer);
/* Makes the pipeline that is missing, if GI has come. */
bool host_fog_prepare(struct host_renderer *renderer);
void host_fog_fill(const struct host_renderer *renderer, struct host_frame_data *out);
/* Fills the froxels of what the prepass has drawn. Only where there is fog. */
void host_fog_record(struct host_renderer *renderer, VkCommandBuffer cmd, VkDescriptorSet frame_set);

/* A camera's clip positions to positions relative to its origin: 16 floats, columns. */
void host_camera_fill_inverse(const struct host_camera_frame *camera, float m[static 16]);

/* Fills the images of debug views, which are made when they are missing. */
bool host_debug_record(struct host_renderer *renderer, VkCommandBuffer cmd,
                       const struct host_debug_desc *desc);

void host_sampler_finish(struct host_renderer *renderer);

bool host_targets_init(struct host_renderer *renderer);
void host_targets_finish(struct host_renderer *renderer);

/* Waits for a slot and begins its command buffer; NULL on failure. */
struct host_slot *host_slot_begin(struct host_renderer *renderer);
bool host_slot_submit(struct host_renderer *renderer, struct host_slot *slot,
                      const VkSemaphore semaphores[2]);
bool host_slot_wait(struct host_renderer *renderer, struct host_slot *slot);
bool host_slots_wait(struct host_renderer *renderer);
/* Begins a frame and records all of it but the tone mapping; NULL on failure. */
struct host_slot *host_renderer_frame_begin(struct host_renderer *renderer, const struct host_camera *camera,
                                            enum host_aov shown);
/* Records the scene as seen by the renderer's camera into the HDR target; GI is updated on request. */
bool host_frame_record(struct host_renderer *renderer, struct host_slot *slot, bool update_gi);
void host_exposure_record(struct host_renderer *renderer, VkCommandBuffer cmd);
void host_tonemap_record(struct host_renderer *renderer, VkCommandBuffer cmd, VkPipeline pipeline,
                         float exposure);
/* Shows the images of debug views instead. */
void host_debug_show(struct host_renderer *renderer, VkCommandBuffer cmd, VkPipeline pipeline);
/* Writes the set that shows an image, which is in SHADER_READ_ONLY_OPTIMAL then. */
void host_post_set_write(struct host_renderer *renderer, VkDescriptorSet set, const struct host_image *image);

#endif
