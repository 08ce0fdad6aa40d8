/* SPDX-License-Identifier: MIT
 *
 * The host renderer: a small forward renderer that uses libsdfgi as any program would, through its public
 * headers and shaders/include/sdfgi.glsl alone.
 *
 * STEP BY STEP
 *   host_device_create -> host_scene_create -> host_renderer_create -> host_render_until ->
 *   host_renderer_read_aov / host_renderer_read_picture -> destroy in reverse order.
 *
 * CONVENTIONS
 *   Errors     a function that returns bool or a pointer says false or NULL on failure; host_device_error()
 *              then holds one line. Nothing aborts.
 *   Lifetime   a device outlives its scenes, a scene its renderers. Destructors accept NULL.
 *   Threading  everything made from one device belongs to one thread.
 *   Images     rows from the top, 4 channels. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <sdfgi/debug.h>
#include <sdfgi/inspect.h>
#include <sdfgi/sdfgi.h>
#include <sdfgi/sky.h>

#include "host_view.h"

struct gltf_scene;

/* ---- Device ----------------------------------------------------------------------------------------- */

struct host_device;

struct host_device_desc {
    const char
        *select; /* an index, or a part of a name in any case; NULL: discrete, then integrated, then CPU */
    bool validation; /* validation layer with synchronization checks; SDFGI_VALIDATION=1 does the same */
    const char *const *instance_extensions; /* what a window system asks for; switches the swapchain on */
    uint32_t instance_extension_count;
    const char *cache_folder; /* where compiled pipelines are kept from run to run; NULL: they are not */
};

struct host_device_info {
    uint32_t index;
    char name[256];
    char driver[600];     /* driver name and version */
    const char *type;     /* "discrete", "integrated", "virtual", "cpu" or "other" */
    uint32_t api_version; /* VK_MAKE_API_VERSION */
    bool usable;          /* host and library can run on it */
    char reason[128];     /* why the host cannot use it; "" otherwise */
    uint64_t local_bytes; /* size of the largest device-local heap */
    bool is_cpu;          /* a software driver */
    struct sdfgi_requirements requirements;
};

/* Creates instance and device. On failure returns NULL and writes one line to `error`. */
struct host_device *host_device_create(const struct host_device_desc *desc, char *error, size_t error_size);
void host_device_destroy(struct host_device *device);

/* Fills `infos` with up to `capacity` devices and returns how many there are, 0 with `error` set if none. */
uint32_t host_device_list(struct host_device_info *infos, uint32_t capacity, char *error, size_t error_size);

void host_device_get_info(const struct host_device *device, struct host_device_info *info);

/* The line that describes the last failure. */
const char *host_device_error(const struct host_device *device);

/* Messages of warning severity or worse from the validation layer so far; 0 without it. */
uint32_t host_device_validation_count(const struct host_device *device);

/* ---- Scene ------------------------------------------------------------------------------------------ */

struct host_scene;

/* Uploads `gltf` as `view` says; neither is needed afterwards. */
struct host_scene *host_scene_create(struct host_device *device, const struct gltf_scene *gltf,
                                     const struct host_view *view);
void host_scene_destroy(struct host_scene *scene);

/* How lights change from frame to frame. */
struct host_light_motion {
    double turn_suns_deg;   /* suns turn about +Z by so much in a frame */
    double flicker_percent; /* of its light, by which each lamp is brighter or dimmer at most, as fire is */
};
/* Has the scene's lights be as they are so many frames after, or before, they were what view and file say,
 * for the next frames of its renderers. */
void host_scene_move_lights(struct host_scene *scene, const struct host_light_motion *motion, double frames);

/* ---- Renderer --------------------------------------------------------------------------------------- */

struct host_renderer;

enum host_aov {
    HOST_AOV_COLOR,            /* radiance, with sky and emission */
    HOST_AOV_DIRECT,           /* radiance from sun and punctual lights alone */
    HOST_AOV_DIFFUSE_INDIRECT, /* radiance that GI adds: irradiance * diffuse albedo / pi */
    HOST_AOV_IRRADIANCE,       /* indirect irradiance, W/m^2 */
    HOST_AOV_REFLECTION,       /* radiance that leaves the specular part, without sun and punctual lights */
    HOST_AOV_NORMAL,           /* world-space shading normal that faces the viewer */
    HOST_AOV_DEPTH,            /* distance along the camera's axis, metres; 0 where there is only sky */
    HOST_AOV_ALBEDO,           /* diffuse albedo, emission left out */
    HOST_AOV_ROUGHNESS,        /* perceptual, 1 without a specular part; 0 where there is only sky */
    HOST_AOV_COUNT,
};

/* Stable lower-case name ("color", "direct", ...). */
const char *host_aov_name(enum host_aov aov);
/* HOST_AOV_COUNT if there is none of that name. */
enum host_aov host_aov_from_name(const char *name);

/* Where GI's light is looked up for opaque surfaces. Blended ones look it up where they are shaded, whatever
 * is chosen, because their pixels show other surfaces in the prepass. */
enum host_lookup {
    HOST_LOOKUP_FORWARD, /* where they are shaded */
    HOST_LOOKUP_FULL,    /* for the whole picture after the prepass, by sdfgi_gather, at this resolution */
    HOST_LOOKUP_HALF,
    HOST_LOOKUP_QUARTER,
    HOST_LOOKUP_COUNT,
};

/* Stable lower-case name ("forward", "full", ...). */
const char *host_lookup_name(enum host_lookup lookup);
/* HOST_LOOKUP_COUNT if there is none of that name. */
enum host_lookup host_lookup_from_name(const char *name);

struct host_lookups {
    enum host_lookup diffuse, reflection; /* HOST_LOOKUP_FORWARD of diffuse light holds for both */
};

struct host_renderer_desc {
    uint32_t width, height;                /* [1, 16384] after supersampling */
    uint32_t supersample;                  /* samples along each side of a pixel, [1, 4]; 0: 1 */
    const struct sdfgi_settings *settings; /* NULL: defaults, that is, GI is off */
    struct sdfgi_log log; /* warnings of the library, and less; its errors are in host_device_error() */
    uint32_t seed;
    float gi_exposure; /* sdfgi_frame_desc::exposure */
    struct host_lookups lookups;
    float eye_distance_m; /* above 0: two eyes so far apart, each in a half of the picture; 0: one */
};

struct host_renderer *host_renderer_create(struct host_device *device, struct host_scene *scene,
                                           const struct host_renderer_desc *desc);
void host_renderer_destroy(struct host_renderer *renderer);

/* Switches GI on and off and changes its settings. */
bool host_renderer_set_settings(struct host_renderer *renderer, const struct sdfgi_settings *settings);
void host_renderer_get_settings(const struct host_renderer *renderer, struct sdfgi_settings *settings);
void host_renderer_get_report(const struct host_renderer *renderer, struct sdfgi_report *report);

/* Effects of the picture. */
struct host_effects {
    bool reflections; /* of opaque surfaces; without them they reflect as much as rough ones */
    bool fog;
};

/* What pictures may have: as the scene calls for it, and where light is looked up. */
struct host_effects host_renderer_possible_effects(const struct host_renderer *renderer);
/* Leaves effects out of the frames that follow, at no cost for what is left out. */
void host_renderer_leave_out(struct host_renderer *renderer, const struct host_effects *left_out);

/* Adopts a new size; the pictures made so far are lost. */
bool host_renderer_resize(struct host_renderer *renderer, uint32_t width, uint32_t height);

/* Records and submits one frame: GI update, shadow maps that are missing, prepass, lookup, fog, forward
 * pass. */
bool host_renderer_frame(struct host_renderer *renderer, const struct host_camera *camera);

/* The same without update and lookup, for its time. GI is left as it is, and pictures that are read
 * afterwards show it again. */
bool host_renderer_frame_without_gi(struct host_renderer *renderer, const struct host_camera *camera);

/* GPU time of the newest finished frame, GI included; 0 while there is none. */
uint64_t host_renderer_frame_gpu_ns(const struct host_renderer *renderer);

/* GPU times of a frame; all 0 where they are not known. */
struct host_times {
    uint64_t frame_ns;  /* all of it */
    uint64_t update_ns; /* of this, what sdfgi_update recorded */
    uint64_t shadow_ns; /* of this, shadow maps: only those that are missing are drawn */
    uint64_t fog_ns;    /* of this, fog's froxels, of one eye; 0 without fog */
};

/* Those of the newest finished frame. */
void host_renderer_get_times(const struct host_renderer *renderer, struct host_times *times);

struct host_frame {
    uint32_t index;                    /* of the frame just submitted, from 0 */
    uint64_t gpu_ns;                   /* as host_renderer_frame_gpu_ns */
    const struct sdfgi_report *report; /* valid during the call */
};

/* Called after each frame; returning false stops the loop, which is not an error. */
typedef bool (*host_progress_fn)(void *user, const struct host_frame *frame);

struct host_until_desc {
    uint32_t frames;           /* how many to render; 0: until GI has converged */
    uint32_t max_frames;       /* limit while waiting for convergence; 0: 8000 */
    host_progress_fn progress; /* may be NULL */
    void *user;
};

/* Renders frames from a camera at rest, waits for the last one, and says how many there were (may be NULL).
 * Without GI, convergence takes one frame. */
bool host_render_until(struct host_renderer *renderer, const struct host_camera *camera,
                       const struct host_until_desc *desc, uint32_t *frames);

/* Draws `aov` with the camera and the light of the last frame, and reads it: width * height * 4 floats, alpha
 * 1 where there is geometry or sky. Supersamples are averaged. */
bool host_renderer_read_aov(struct host_renderer *renderer, enum host_aov aov, float *rgba);

struct host_picture_desc {
    float exposure;                     /* factor on radiance; 0: found from the picture */
    float *exposure_out;                /* the factor that was used; may be NULL */
    const enum sdfgi_debug_view *debug; /* drawn instead; NULL or SDFGI_DEBUG_VIEW_COUNT: none */
    bool without_gi;                    /* the frame is drawn again without update and lookup */
};

/* Tone-maps the colour of the last frame: width * height * 4 bytes, sRGB. Debug views have the colours of the
 * library, and the picture's exposure; they fail while GI is off. */
bool host_renderer_read_picture(struct host_renderer *renderer, const struct host_picture_desc *desc,
                                uint8_t *rgba);

/* Draws a debug view of the last frame: width * height * 4 floats, linear from 0 to 1. Supersamples are
 * averaged. `exposure` is a factor on light; 0: found from the picture. */
bool host_renderer_read_debug(struct host_renderer *renderer, enum sdfgi_debug_view view, float exposure,
                              float *rgba);

struct host_sample {
    double position[3];
    float normal[3]; /* need not be unit length */
};

/* Indirect irradiance (W/m^2, linear RGB) after the last frame at up to 16 points of the world, wherever the
 * camera looks. Fails while GI is off. Waits for the GPU. */
bool host_renderer_sample(struct host_renderer *renderer, const struct host_sample *samples, uint32_t count,
                          float (*irradiance)[3]);

/* ---- Volumes ---------------------------------------------------------------------------------------- */

/* What the library holds of a cascade, cells and blocks in plain order: x fastest, then y. */
struct host_volume {
    struct sdfgi_inspect_cascade where;
    uint64_t *bits;                       /* per cell */
    struct sdfgi_inspect_surface *blocks; /* per 2x2x2 cells */
};

struct host_volumes {
    uint32_t count;
    struct host_volume cascades[8];
};

/* Has the library voxelise the scene around a camera, draws nothing, and reads what it made of it. */
bool host_renderer_read_volumes(struct host_renderer *renderer, const struct host_camera *camera,
                                struct host_volumes *out);
void host_volumes_finish(struct host_volumes *volumes);

/* ---- Window ----------------------------------------------------------------------------------------- */

/* Where the camera of frame `frame` is; false closes the window. */
typedef bool (*host_camera_fn)(void *user, uint32_t frame, struct host_camera *camera);

struct GLFWwindow;

/* What an overlay draws with: into the window's render pass, which it finds begun. */
struct host_overlay_vulkan {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue;
    VkPipelineCache pipeline_cache;
    VkRenderPass pass;
    uint32_t frames_in_flight;
};

/* What an overlay sees before a frame, and what it may change. */
struct host_overlay_frame {
    bool open;                         /* F1 opens and closes it */
    struct sdfgi_settings settings;    /* asked for; may be changed. GI that is off is prepared first */
    enum sdfgi_debug_view debug;       /* what is shown; may be changed */
    struct host_effects possible;      /* what the picture may have */
    struct host_effects left_out;      /* may be changed */
    const struct sdfgi_report *report; /* valid during the call */
    uint64_t gpu_ns;                   /* of the newest finished frame */
    double frame_s;                    /* since the frame before */
    const char *error;            /* why settings were refused that it asked for last; NULL: they were not */
    bool takes_mouse, takes_keys; /* to be filled in: the window leaves them to it */
};

/* Something that is drawn over the picture of a window. Keys and mouse reach it through GLFW. */
struct host_overlay {
    bool (*begin)(void *user, struct GLFWwindow *window, const struct host_overlay_vulkan *vulkan,
                  char *error, size_t error_size);
    void (*frame)(void *user, struct host_overlay_frame *frame);
    void (*record)(void *user, VkCommandBuffer cmd);
    void (*end)(void *user); /* of one that has begun; the device is idle */
    void *user;
};

struct host_window_desc {
    const char *device_select; /* as host_device_desc::select */
    const char *cache_folder;  /* as host_device_desc::cache_folder */
    bool validation;
    const struct gltf_scene *gltf;
    const struct host_view *view;
    const struct sdfgi_settings *settings; /* GI starts as `enabled` says */
    struct host_lookups lookups;
    float eye_distance_m;               /* as host_renderer_desc::eye_distance_m */
    const enum sdfgi_debug_view *debug; /* what is shown at first; NULL or SDFGI_DEBUG_VIEW_COUNT: the
                                           picture */
    uint32_t width, height;             /* 0: 1280 x 720 */
    uint32_t frames;                    /* closes after that many; 0: when the user does */
    struct host_light_motion lights;    /* frame 0 has them as view and file say */
    struct sdfgi_log log;
    const struct host_overlay *overlay; /* NULL: none */
    host_camera_fn camera;              /* NULL: the user flies */
    host_progress_fn progress; /* after each frame; may be NULL. Its GPU time is that of two frames before */
    void *user;                /* of both */
    bool (*stop)(void);        /* asked before each frame; true closes the window; may be NULL */
    struct host_device_info *device_info; /* filled once there is a device; may be NULL */
};

/* Opens a window and runs until it is closed. On failure returns false and writes one line to `error`.
 * Present only when built with the `window` feature. */
bool host_window_run(const struct host_window_desc *desc, char *error, size_t error_size);

#endif
