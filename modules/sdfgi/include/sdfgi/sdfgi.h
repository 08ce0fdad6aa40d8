/* SPDX-License-Identifier: MIT
 *
 * libsdfgi: real-time global illumination for any Vulkan renderer.
 *
 * DOES
 *   voxelise the host's meshes into cascades around the camera, make distance fields of them,
 *   trace light probes, and answer "how much indirect light arrives at this point" in the host's own shaders
 *   (shaders/include/sdfgi.glsl) or as a screen pass (sdfgi_gather).
 *
 * DOES NOT
 *   create a device, own a queue, submit, wait, print, or keep any global state. It records commands into a
 *   command buffer of the host's and nothing else.
 *
 * STEP BY STEP
 *   1. sdfgi_get_requirements: ask whether a physical device will do and which features to switch on.
 *   2. sdfgi_create with the host's device; GI starts disabled and holds at most 64 KiB of device memory.
 *   3. sdfgi_material_create, sdfgi_mesh_create, sdfgi_instance_create, sdfgi_light_create, sdfgi_set_sky.
 *   4. sdfgi_set_settings with `enabled` set: the one switch.
 *   5. Every frame: sdfgi_update(cmd), then draw with the set from sdfgi_get_descriptor_set, or sdfgi_gather.
 *   6. sdfgi_get_report to see what ran, why, how long it took and whether the light has converged.
 *
 * CONVENTIONS
 *   Units      metres, radians, W/m^2 (irradiance), W/(m^2 sr) (radiance), W/sr (intensity), linear RGB.
 *   Space      right handed with +Y up, or as sdfgi_desc::up_axis and left_handed say.
 *   Positions  cross this interface as double[3] in world space.
 *   Lifetime   descriptors and what they point to need only outlive the call. Vulkan handles are borrowed and
 *              must outlive the object that was made from them.
 *   Defaults   a zero-initialised descriptor is valid unless a field says otherwise; settings are different,
 *              since 0 means something there: start from sdfgi_settings_default.
 *   NULL       a destructor accepts NULL; no other pointer may be NULL unless its comment says so.
 *   Errors     a call that fails changes nothing, writes nothing to its outputs and reports why through the
 *              log callback, which names function, object, field, value and limit. Nothing aborts.
 *              After SDFGI_ERROR_DEVICE_LOST only sdfgi_destroy is useful.
 *   Threading  one context may be used by one thread at a time, except that a second one may be in
 *              sdfgi_prepare; different contexts are independent.
 */
#ifndef SDFGI_H
#define SDFGI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

#include <sdfgi/memory.h>
#include <sdfgi/messages.h>
#include <sdfgi/settings.h>
#include <sdfgi/version.h>

#ifdef __cplusplus
extern "C" {
#endif

enum sdfgi_result {
    SDFGI_OK = 0,
    SDFGI_ERROR_INVALID_ARGUMENT = -1, /* the call broke a documented rule; the log names it */
    SDFGI_ERROR_UNSUPPORTED = -2,      /* the device lacks something sdfgi_get_requirements lists */
    SDFGI_ERROR_OUT_OF_MEMORY = -3,    /* host or device memory; the previous state is intact */
    SDFGI_ERROR_DEVICE_LOST = -4,
};

enum sdfgi_log_level { SDFGI_LOG_ERROR, SDFGI_LOG_WARNING, SDFGI_LOG_INFO };

/* Receives one message: `text` is a single line valid during the call. */
typedef void (*sdfgi_log_fn)(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text);

struct sdfgi_log {
    sdfgi_log_fn fn; /* NULL: no messages */
    void *user;
};

/* Host memory. Both functions or neither; neither means malloc and free. */
struct sdfgi_allocator {
    void *(*alloc)(void *user, size_t size); /* may return NULL: the call then fails cleanly */
    void (*free)(void *user, void *memory);
    void *user;
};

/* ---- Before a device exists ------------------------------------------------------------------------- */

enum { SDFGI_MAX_REASONS = 16, SDFGI_MAX_EXTENSIONS = 4 };

struct sdfgi_requirements {
    bool supported;
    uint32_t reason_count; /* why not; 0 when supported */
    char reasons[SDFGI_MAX_REASONS][96];
    uint32_t api_version;     /* VkApplicationInfo::apiVersion must be so much: Vulkan 1.2. The library cannot
                                 ask an instance for it: see sdfgi_vulkan */
    uint32_t extension_count; /* device extensions to enable: none so far */
    const char *extensions[SDFGI_MAX_EXTENSIONS];
    /* Features to enable, and no others are used. Chain them in VkDeviceCreateInfo::pNext, or set the same
     * bits in structures of your own. The pNext members are NULL. */
    VkPhysicalDeviceFeatures features;
    VkPhysicalDeviceVulkan12Features features_12; /* sType set; all unused bits are VK_FALSE */
};

/* Fills `requirements` for a device of `instance`. `get_instance_proc_addr` is the loader's. */
SDFGI_API enum sdfgi_result sdfgi_get_requirements(VkInstance instance, VkPhysicalDevice physical_device,
                                                   PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                                   struct sdfgi_requirements *requirements);

/* Stable lower-case name of a category, for reports. */
SDFGI_API const char *sdfgi_memory_category_name(enum sdfgi_memory_category category);

/* Device bytes that a context with these settings will allocate when it is switched on: exactly what
 * sdfgi_get_report says afterwards. Scenes of more than 1024 instances take 64 more for each, rounded up to a
 * power of two of instances. Needs no device. `settings` may be NULL for the defaults. */
SDFGI_API enum sdfgi_result sdfgi_estimate_memory(const struct sdfgi_settings *settings,
                                                  uint32_t frames_in_flight, struct sdfgi_memory *memory);

/* ---- Context ---------------------------------------------------------------------------------------- */

struct sdfgi_vulkan {
    VkInstance instance; /* with VK_EXT_debug_utils: all that the library makes has a name, "sdfgi ..." */
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family_index; /* of the command buffers given to sdfgi_update: compute, and graphics too
                                    if the raster voxelizer is chosen */
    PFN_vkGetInstanceProcAddr get_instance_proc_addr;
    const VkAllocationCallbacks *allocation_callbacks; /* may be NULL; copied */
    uint32_t api_version; /* VkApplicationInfo::apiVersion of the instance; 0: not said. Where it is known to
                             be below Vulkan 1.2, sdfgi_create fails with SDFGI_ERROR_UNSUPPORTED: say it,
                             because not every driver shows it */
};

/* Where up is in the world. The sky follows it, and lookups at level ground. sdfgi_y_scale does not: cells
 * are flattened along Y, and with Z up nothing but 100 % is taken. */
enum sdfgi_up_axis { SDFGI_UP_Y = 0, SDFGI_UP_Z, SDFGI_UP_MINUS_Y, SDFGI_UP_MINUS_Z };

struct sdfgi_desc {
    struct sdfgi_vulkan vulkan;
    uint32_t frames_in_flight;             /* 1..8; 0: 2. A command buffer recorded by sdfgi_update must have
                                              finished by the time this many further updates are recorded */
    const struct sdfgi_settings *settings; /* NULL: defaults, that is, disabled */
    struct sdfgi_log log;
    struct sdfgi_allocator allocator;               /* host memory */
    struct sdfgi_device_allocator device_allocator; /* device memory: sdfgi/memory.h */
    /* The host's; VK_NULL_HANDLE: none. Every pipeline of the context is made with it: by sdfgi_create,
     * sdfgi_prepare, sdfgi_set_settings, sdfgi_material_create and sdfgi_gather. The cache is borrowed and
     * must outlive the context. The host saves it and loads it. Vulkan wants no call to vkMergePipelineCaches
     * into the cache during these functions; if VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT is set,
     * no other thread may use the cache at all meanwhile. */
    VkPipelineCache pipeline_cache;
    bool log_info; /* whether `log` receives SDFGI_LOG_INFO, too: what goes as it should */
    /* False: sdfgi_create makes the pipelines that frames with `settings` may need; sdfgi_set_settings makes
     * those that other settings call for. True: sdfgi_create makes none, and is over at once; sdfgi_prepare
     * makes them, or else the sdfgi_set_settings that switches on. */
    bool pipelines_later;
    enum sdfgi_up_axis up_axis; /* 0: +Y */
    /* Whether the world's X, Y and Z are those of a left hand, as in Direct3D and Unreal. Only
     * sdfgi_mesh_desc::front_face depends on it: what is clockwise to one hand is counter-clockwise to the
     * other. A flipped viewport does not make a world left-handed. */
    bool left_handed;
};

typedef struct sdfgi sdfgi;

/* Creates a context. While settings->enabled is false it holds at most 64 KiB of device memory, for lookups
 * that answer black; estimate and report do not count these. Thread-safety: see THREADING above, for all
 * functions that take a context. */
SDFGI_API enum sdfgi_result sdfgi_create(const struct sdfgi_desc *desc, sdfgi **out);

/* Destroys the context, and every object made from it. The device must not be using any of them any more. */
SDFGI_API void sdfgi_destroy(sdfgi *gi);

/* Validates and takes over `settings`. Switching off releases all device memory as soon as the frames in
 * flight are over, unless sdfgi_prepare has asked to keep it; switching on allocates it, and on failure
 * leaves the previous settings in force. Properties marked "re-create" rebuild everything, and the picture is
 * black until the next sdfgi_update. Allocation may stall the frame: sdfgi_prepare (sdfgi/prepare.h) does it
 * ahead. */
SDFGI_API enum sdfgi_result sdfgi_set_settings(sdfgi *gi, const struct sdfgi_settings *settings);

/* The settings in force, every value as it is really used. */
SDFGI_API void sdfgi_get_settings(const sdfgi *gi, struct sdfgi_settings *settings);

/* ---- Scene ------------------------------------------------------------------------------------------ */

/* Handles: 0 is never valid. A stale handle is refused with SDFGI_ERROR_INVALID_ARGUMENT. There may be 1,024
 * lights, 4,096 materials, 1,048,574 meshes and as many instances: SDFGI_ERROR_OUT_OF_MEMORY refuses more. */
typedef struct {
    uint32_t id;
} sdfgi_mesh;
typedef struct {
    uint32_t id;
} sdfgi_material;
typedef struct {
    uint32_t id;
} sdfgi_instance;
typedef struct {
    uint32_t id;
} sdfgi_light;

/* A texture of a material. view == VK_NULL_HANDLE: none, the factor alone counts. The image must be in
 * `layout` whenever a command buffer from sdfgi_update executes. The library samples it linearly, with a
 * sampler of its own, at the mip level whose texels are as large as sub-voxels: give the view all levels. A
 * texture without them is sampled at points, and details finer than a sub-voxel may be missed. */
struct sdfgi_texture {
    VkImageView view;      /* 2D, of a format that can be filtered */
    VkImageLayout layout;  /* VK_IMAGE_LAYOUT_UNDEFINED (0): SHADER_READ_ONLY_OPTIMAL */
    float uv_transform[6]; /* row-major 2x3, uv' = M * (u, v, 1); all zero: identity */
    /* What lies outside [0, 1]: VK_SAMPLER_ADDRESS_MODE_REPEAT (0), _MIRRORED_REPEAT or _CLAMP_TO_EDGE. */
    VkSamplerAddressMode address_u, address_v;
    /* Whether RGB is encoded as sRGB in a view whose format is not: the library then decodes it, as a host's
     * shader would, after filtering. A view of an sRGB format needs no flag: the device decodes, and filters
     * better. */
    bool decode_srgb;
};

struct sdfgi_material_desc {
    float albedo[3];            /* linear diffuse reflectance factor, [0, 1]; 0: black, with a texture too */
    float alpha;                /* [0, 1], 0 means 1; times the texture's alpha; only for alpha_cutoff */
    float emission[3];          /* radiance, W/(m^2 sr), >= 0; 0: none, with a texture too */
    float alpha_cutoff;         /* [0, 1]: samples with alpha below it are holes; 0: there are none */
    bool double_sided_emission; /* false: emits from the front side only; see front_face */
    float smoothness;           /* [0, 1]: 1 - roughness where the material is smoothest; 0: matt. Views make
                                   reflections only while a material calls for them */
    float specular_albedo;      /* [0, 1]: share of even light that a glossy interface sends back before it
                                   meets the colour below. Added to albedo and its texture, at most to 1.
                                   About 0.09 for smooth plastic and water, 0.02 for rough stone; 0: none */
    float metallic; /* [0, 1]: share of albedo that is metal's. Above 0.5, with a smoothness of 0.4 or
                       more, rays that meet the surface go on as it reflects them; 0: no metal */
    struct sdfgi_texture albedo_texture;   /* RGB times albedo, A times alpha */
    struct sdfgi_texture emission_texture; /* RGB times emission */
};

SDFGI_API enum sdfgi_result sdfgi_material_create(sdfgi *gi, const struct sdfgi_material_desc *desc,
                                                  sdfgi_material *out);
/* May be called in each frame: what is as before costs nothing. Else all that shows the material is voxelised
 * anew, as if it had moved, and light follows as after sdfgi_light_update. The time that the call takes grows
 * with the number of all instances. Views of former textures must stay until the frames in flight are over.
 * If the call fails, the material stays as it was. */
SDFGI_API enum sdfgi_result sdfgi_material_update(sdfgi *gi, sdfgi_material material,
                                                  const struct sdfgi_material_desc *desc);
/* Fails while an instance uses the material. */
SDFGI_API enum sdfgi_result sdfgi_material_destroy(sdfgi *gi, sdfgi_material material);

/* Triangles in buffers of the host's, which must have VK_BUFFER_USAGE_STORAGE_BUFFER_BIT: those that it draws
 * from, as they are. Normals are not read. Triangles with a non-finite or out-of-range vertex are skipped and
 * counted. Those that leave the bounds by more than a cell are counted, too: they may be missing, wholly or
 * in part.
 *
 * Formats, whose values are those of Vulkan's vertex input; what a format lacks is 0, alpha 1:
 *
 *   R8G8, A2R10G10B10_PACK32, A2B10G10R10_PACK32     UNORM, SNORM, USCALED, SSCALED, UINT, SINT
 *   R8G8B8, R8G8B8A8, A8B8G8R8_PACK32                these and SRGB
 *   R16G16, R16G16B16, R16G16B16A16                  these and SFLOAT, not SRGB
 *   B8G8R8, B8G8R8A8                                 UNORM, SRGB
 *   R32G32, R32G32B32, R32G32B32A32                  SFLOAT
 *
 * UINT and SINT count as USCALED and SSCALED: as the numbers that they are. A device need not know any of
 * these for vertex input, because shaders of the library decode them. Offsets and strides are multiples of
 * the bytes of a component, of 4 for packed formats.
 *
 * Of a buffer are read: from its offset, `vertex_count` elements, a stride apart; or the indices that
 * `triangle_count` needs. They must lie in the buffer, with what is missing to the next multiple of 4 bytes
 * from its beginning: shaders read words. They may be at most maxStorageBufferRange - 258 bytes long,
 * wherever in the buffer. A range says how many bytes from the offset belong to the mesh: more are refused.
 * 0: whatever the buffer has.
 *
 * What earlier work of the same queue has written to the buffers is visible to sdfgi_update. After
 * sdfgi_mesh_destroy they must stay until the frames in flight are over. */
struct sdfgi_mesh_desc {
    VkBuffer position_buffer;
    VkDeviceSize position_offset, position_range; /* bytes */
    uint32_t position_stride;                     /* bytes; 0: those of the format */
    VkFormat position_format; /* 2 to 4 components, of which a fourth is not read; 0: R32G32B32_SFLOAT.
                                 Normalised ones need the transform that makes metres of them, as always */
    VkBuffer uv_buffer;       /* VK_NULL_HANDLE: (0, 0) */
    VkDeviceSize uv_offset, uv_range;
    uint32_t uv_stride;
    VkFormat uv_format;    /* 2 to 4 components, of which two are read; 0: R32G32_SFLOAT */
    VkBuffer color_buffer; /* multiplied into the albedo, linear but for SRGB; VK_NULL_HANDLE: white */
    VkDeviceSize color_offset, color_range;
    uint32_t color_stride;
    VkFormat color_format;                  /* 3 or 4 components; 0: R32G32B32A32_SFLOAT */
    VkBuffer index_buffer;                  /* VK_NULL_HANDLE: indices are 0, 1, 2, ... */
    VkDeviceSize index_offset, index_range; /* any multiple of 1 byte */
    VkIndexType index_type; /* VK_INDEX_TYPE_UINT16 (0), VK_INDEX_TYPE_UINT32 or VK_INDEX_TYPE_UINT8_EXT.
                               Whether the device draws with 8 bits is no matter */
    uint32_t first_index;   /* as in vkCmdDrawIndexed: indices before the first that is used */
    int32_t vertex_offset; /* as in vkCmdDrawIndexed: added to every index, with the sum below vertex_count */
    uint32_t vertex_count; /* > 0; elements from the offsets on */
    uint32_t triangle_count; /* > 0; three indices each */
    float bounds_min[3];     /* object space, containing every vertex; instances are culled by them. */
    float bounds_max[3];     /* Not all six may be 0 */
    VkFrontFace front_face; /* winding of fronts as seen from before them: COUNTER_CLOCKWISE (0) or CLOCKWISE,
                               for meshes baked with an axis flipped. Surfaces lie behind their fronts, and
                               emit from there. The transform of an instance does not change the front */
};

SDFGI_API enum sdfgi_result sdfgi_mesh_create(sdfgi *gi, const struct sdfgi_mesh_desc *desc, sdfgi_mesh *out);
SDFGI_API enum sdfgi_result sdfgi_mesh_destroy(sdfgi *gi, sdfgi_mesh mesh); /* and its instances */

/* Object to world: world = basis * object + translation. basis is column-major 3x3, any finite matrix
 * (mirrored, sheared and flat too) that is not 0: a basis that was forgotten is refused. Where an object has
 * shrunk to nothing, destroy its instance. */
struct sdfgi_transform {
    float basis[9];
    double translation[3];
};

enum sdfgi_mobility {
    SDFGI_STATIC = 0, /* in the volumes */
    SDFGI_EXCLUDED,   /* receives light, neither blocks nor bounces it */
};

struct sdfgi_instance_desc {
    sdfgi_mesh mesh;
    sdfgi_material material;
    struct sdfgi_transform transform;
    enum sdfgi_mobility mobility;
};

/* A scene may have 1,048,574 instances. One more is refused with SDFGI_ERROR_OUT_OF_MEMORY and a message that
 * names the limit, and those that are there stay. Each takes 240 bytes of host memory and 64 of the device's,
 * and as much again where room has just been doubled. What a frame costs depends on the instances that it
 * voxelises and on those that have changed, not on how many there are. */
SDFGI_API enum sdfgi_result sdfgi_instance_create(sdfgi *gi, const struct sdfgi_instance_desc *desc,
                                                  sdfgi_instance *out);
/* Creates `count` instances, or none: an error leaves the scene and `handles` as they are. Its message names
 * the index of the first description that is wrong: "descs[17]". All handles of `descs` and `handles` are as
 * those of sdfgi_instance_create. `count` may be 0. */
SDFGI_API enum sdfgi_result sdfgi_instances_create(sdfgi *gi, uint32_t count,
                                                   const struct sdfgi_instance_desc *descs,
                                                   sdfgi_instance *handles);
/* Destroys `count` instances, or none: a handle that is stale, or there twice, is an error, whose message
 * names its index. `count` may be 0. */
SDFGI_API enum sdfgi_result sdfgi_instances_destroy(sdfgi *gi, uint32_t count, const sdfgi_instance *handles);
SDFGI_API enum sdfgi_result sdfgi_instance_set_transform(sdfgi *gi, sdfgi_instance instance,
                                                         const struct sdfgi_transform *transform);
SDFGI_API enum sdfgi_result sdfgi_instance_destroy(sdfgi *gi, sdfgi_instance instance);

enum sdfgi_light_type { SDFGI_LIGHT_DIRECTIONAL, SDFGI_LIGHT_POINT, SDFGI_LIGHT_SPOT };

struct sdfgi_light_desc {
    enum sdfgi_light_type type;
    double position[3];    /* point, spot */
    float direction[3];    /* directional, spot: the way the light travels; need not be unit length */
    float intensity[3];    /* W/sr (point, spot) or irradiance W/m^2 (directional), >= 0 */
    float range_m;         /* point, spot: no light beyond; 0: unlimited */
    float inner_angle_rad; /* spot: half angles, 0 <= inner < outer <= pi/2, outer never 0; falloff */
    float outer_angle_rad; /*   saturate((cos t - cos outer) / (cos inner - cos outer))^2 */
    float indirect_energy; /* factor on what this light contributes to GI, >= 0; 1 is physical, 0 means 1.
                              For nothing at all set `intensity` to 0, or destroy the light */
    bool casts_shadow;     /* false: reaches every surface that faces it, through walls too */
};

SDFGI_API enum sdfgi_result sdfgi_light_create(sdfgi *gi, const struct sdfgi_light_desc *desc,
                                               sdfgi_light *out);
/* May be called in each frame. What is as before costs nothing, nor does a light of no intensity that moves.
 * Light follows at once, noisily for some frames; but smoothly, up to a second later and at no cost, where
 * suns and the sky change by less than a tenth of their light within 17 frames (an angle in radians counts as
 * such a part), as the day goes by. Where nothing but the intensity of a lamp changes, again and again,
 * between a third and three times its mean, the lamp flickers: bounced light is that of its mean over half a
 * second. */
SDFGI_API enum sdfgi_result sdfgi_light_update(sdfgi *gi, sdfgi_light light,
                                               const struct sdfgi_light_desc *desc);
SDFGI_API enum sdfgi_result sdfgi_light_destroy(sdfgi *gi, sdfgi_light light);

/* Sky radiance in direction d, a unit vector of height h = dot(d, up), with up as sdfgi_desc::up_axis says:
 * lerp(horizon, h >= 0 ? zenith : ground, |h|). A uniform sky has three equal colours; all zero, the initial
 * state, is no sky. */
struct sdfgi_sky {
    float zenith[3], horizon[3], ground[3]; /* W/(m^2 sr), >= 0 */
};

/* May be called in each frame, as sdfgi_light_update. Cube maps and harmonics, which add to it: sdfgi/sky.h.
 */
SDFGI_API enum sdfgi_result sdfgi_set_sky(sdfgi *gi, const struct sdfgi_sky *sky);

/* Says that the triangles, textures or materials inside a world-space box have changed behind the library's
 * back. NULL corners are not accepted. Whatever the box touches is voxelised again. */
SDFGI_API enum sdfgi_result sdfgi_invalidate_box(sdfgi *gi, const double box_min[3], const double box_max[3]);

/* ---- Frame ------------------------------------------------------------------------------------------ */

struct sdfgi_frame_desc {
    double camera_position[3]; /* cascades are centred on it. How far an orthographic camera is from what it
                                  shows means nothing: give the middle of that */
    double origin[3]; /* world position of (0, 0, 0) in the host's shaders; for worlds of more than a few
                         kilometres use a point near the camera */
    uint32_t seed;  /* of the random sequence. Another one rebuilds everything once two updates in a row give
                       it: a number that is different in every frame changes nothing */
    float exposure; /* a hint: > 0, factor that brings what the picture shows near 1; 0: 1. Small formats
                       keep their precision, and light settles, down to 1/4096 of that. May change in every
                       frame and by any factor: what is stored stays, or is rescaled by a power of two,
                       and goes on to settle where a far larger one shows what was too dim.
                       However large it is, the scene's brightest light fits. Light that lookups return
                       does not depend on it */
    bool cut; /* This picture has nothing to do with the one before: a teleport, a change of shots. Lookups
                 take what is made at the new place as soon as it is there, within the same budget, and not at
                 a pace that nobody sees; the way that the camera came says nothing of where it goes. Unlike
                 with sdfgi_reset, light that is known there stays */
    bool forward_reflections; /* Shaders of the host's own call sdfgi_lighting, and their rough surfaces are
                                 to reflect light by where it comes from: see sdfgi_rough_lobes. Costs nothing
                                 where all materials are matt, and is needless where a view has reflections */
};

/* Records one frame of GI work into `cmd`, which must be recording outside a render pass instance. It waits
 * for all earlier work of the queue, and leaves pipelines, sets and push constants of its own bound.
 * Afterwards the descriptor set may be used by graphics and compute work later in the same queue: the
 * barriers are recorded. Records nothing at all while GI is disabled. Where surfaces outgrow the list of
 * light cells, allocates a longer one, and likewise for instances. Without memory for these, one message says
 * so, and the last ones are left out of the volumes until there is memory and the scene changes again. */
SDFGI_API enum sdfgi_result sdfgi_update(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_frame_desc *desc);

/* Undoes the last sdfgi_update, whose command buffer has not run and will not: the swapchain was out of date,
 * say. Everything is as if that update had not been recorded; what changed in the scene since then is kept.
 * Call it before the next sdfgi_update, which it replaces as a frame in flight. Without an update to undo it
 * does nothing. Gathers and resolves of that command buffer need no undoing.
 *
 * An update that did not run and that nobody cancelled is noticed frames_in_flight updates later: the library
 * logs UPDATE_LOST and begins anew, as sdfgi_reset does. Until then lookups may give anything. */
SDFGI_API void sdfgi_cancel_update(sdfgi *gi);

/* Forgets all light and everything voxelised, and keeps memory and scene: the next sdfgi_update is as the
 * first of a context. For cuts to another world, whose light has nothing in common with the one before. */
SDFGI_API void sdfgi_reset(sdfgi *gi);

/* True when lookups give light: GI is enabled, and an update has been recorded since it was. */
SDFGI_API bool sdfgi_is_active(const sdfgi *gi);

/* Layout and set for shaders/include/sdfgi.glsl. Both are always valid. The layout lives as long as the
 * context. While GI is off, and before the first update, the set is one whose lookups answer black at next to
 * no cost: a host needs one shader and one pipeline per material, whatever the switch. The set may change
 * with settings and with sdfgi_update: fetch it every frame, after the update. The set before stays valid for
 * the frames in flight. */
SDFGI_API VkDescriptorSetLayout sdfgi_get_descriptor_set_layout(const sdfgi *gi);
SDFGI_API VkDescriptorSet sdfgi_get_descriptor_set(const sdfgi *gi);

/* True where the device is a CPU. A host's shader that defines SDFGI_SOFTWARE before it includes sdfgi.glsl
 * works with the sets of such a context alone. Its lookups take half as long there. Constant for a context's
 * life. */
SDFGI_API bool sdfgi_is_software(const sdfgi *gi);

/* Which pixels of a picture sdfgi_gather looks up: all, or every second or fourth one along each axis. The
 * others interpolate those around them that lie in their plane and face as they do. Where none fit, at things
 * and edges narrower than the gap, and where those that fit differ by more than a quarter, they are looked up
 * as well. Edges therefore stay as sharp as at full resolution. The bumps of normal maps come out smoother.
 */
enum sdfgi_gather_resolution {
    SDFGI_GATHER_FULL,
    SDFGI_GATHER_HALF,
    SDFGI_GATHER_QUARTER,
};

/* Indirect diffuse light for a whole screen: irradiance E (W/m^2, not times albedo) per pixel, times `scale`.
 *
 *   image    format                          layout on entry and exit       usage
 *   depth    any sampled depth/float, 0..1   SHADER_READ_ONLY or GENERAL    SAMPLED
 *   normal   any sampled float, xyz unit     SHADER_READ_ONLY or GENERAL    SAMPLED
 *   output   R16G16B16A16_SFLOAT             GENERAL                        STORAGE
 *
 * A pixel whose position or normal is not finite, or whose normal is 0, counts as background. Half floats
 * end at 65504: more is written as that. Give bright scenes a scale: the exposure of the picture that the
 * light is added to, or one that the host divides by again. */
struct sdfgi_gather_desc {
    VkImageView depth, normal, output;
    VkImageLayout input_layout;        /* of depth and normal; UNDEFINED (0): SHADER_READ_ONLY_OPTIMAL */
    uint32_t width, height;            /* pixels of all three: 1 to the device's maxImageDimension2D */
    float inverse_view_projection[16]; /* column-major: clip to position relative to sdfgi_frame_desc::origin;
                                          not 0. Perspective or orthographic. Clip space has y = -1 at the
                                          first row of the images, as a viewport of positive height gives it:
                                          with a negative height negate elements 4 to 7 */
    float background_depth;            /* pixels with exactly this depth get 0: 1, or 0 for reversed depth */
    enum sdfgi_gather_resolution resolution; /* 0: SDFGI_GATHER_FULL */
    float scale;                             /* factor on the output, >= 0 and finite; 0 means 1 */
};

/* Records the gather into `cmd`, after sdfgi_update in the same queue. Host writes to depth and normal must
 * be made visible to compute shader reads by the host; the output is made visible to later compute and
 * fragment reads. Does nothing and returns SDFGI_OK while GI is not active: the output keeps what it has, and
 * a host clears it when it switches GI off. The images have one sample a pixel. The first call makes its
 * pipeline, as the first material with a texture makes one, unless sdfgi_prepare has.
 *
 * Light of what the picture shows is gathered before that of other places, in the updates that follow.
 * Lookups in the host's shaders have no such effect. */
SDFGI_API enum sdfgi_result sdfgi_gather(sdfgi *gi, VkCommandBuffer cmd,
                                         const struct sdfgi_gather_desc *desc);

#ifdef __cplusplus
}
#endif

#include <sdfgi/prepare.h>
#include <sdfgi/report.h>
#include <sdfgi/view.h>
#endif
