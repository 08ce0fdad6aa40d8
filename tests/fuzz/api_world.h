/* SPDX-License-Identifier: MIT
 * A host that does what comes: objects come, change and go, settings and the camera move, updates are
 * dropped, and some calls break a rule. It knows what the scene has become. */
#ifndef TESTS_FUZZ_API_WORLD_H
#define TESTS_FUZZ_API_WORLD_H

#include "gi_test.h"
#include "test_memory.h"

#include <sdfgi/view.h>

enum {
    API_SHAPES = 4,
    API_MESHES = 5,
    API_MATERIALS = 6,
    API_LIGHTS = 5,
    API_INSTANCES = 14,
    API_STALE = 16,
    API_VIEWS = 2,
    API_PICTURE = 24 /* pixels along a side of what is gathered and drawn */
};

/* What the host has made, as it would make it again. */
struct api_scene {
    struct {
        bool live;
        uint32_t shape;
        sdfgi_mesh handle;
    } meshes[API_MESHES];
    struct {
        bool live;
        struct sdfgi_material_desc desc;
        sdfgi_material handle;
    } materials[API_MATERIALS];
    struct {
        bool live;
        struct sdfgi_light_desc desc;
        sdfgi_light handle;
    } lights[API_LIGHTS];
    struct {
        bool live;
        uint32_t mesh, material; /* slots */
        struct sdfgi_instance_desc desc;
        sdfgi_instance handle;
    } instances[API_INSTANCES];
    struct sdfgi_sky sky;
    struct sdfgi_settings settings;
};

struct api_stale {
    uint32_t ids[API_STALE], count;
};

/* Buffers and pictures of the host's, on one device for all contexts. */
struct api_device {
    struct gpu_test_buffer positions[API_SHAPES], indices[API_SHAPES], copy;
    struct sdfgi_mesh_desc shapes[API_SHAPES];
    struct gpu_test_image depth, normal, roughness, output, texture;
};

struct api_world {
    struct gi_test *t;
    struct api_device *device;
    struct test_random random;
    struct api_scene scene;
    struct api_stale meshes, materials, lights, instances; /* handles that are no longer valid */
    sdfgi_view *views[API_VIEWS];                          /* NULL: there is none */
    uint32_t refused;                                      /* calls that broke a rule */
    uint32_t calm; /* frames from now on that may be the first of all, and ask for an exposure of 1 */
};

void api_device_open(struct api_device *device, struct gi_test *t);
void api_device_close(struct api_device *device, struct gi_test *t);

/* A context without a scene; on what it holds, api_context_close looks. `t` has none before. */
void api_context_open(struct gi_test *t, const struct sdfgi_settings *settings);
/* All memory of the host's and of the device's must come back. */
void api_context_close(struct gi_test *t);

/* Settings to begin with: 32 cells, light that settles in few frames. */
struct sdfgi_settings api_settings(struct test_random *random);

uint32_t api_below(struct api_world *world, uint32_t limit);

/* Does one thing, and returns its name. */
const char *api_step(struct api_world *world);
/* Changes the sky, a light, an instance, a mesh or the settings. */
enum { API_CHANGES = 5 };
const char *api_change(struct api_world *world, uint32_t change);
/* What a host does in a frame: runs it, or drops it. */
void api_frame(struct api_world *world);
/* Views come and go, and resolve pictures. */
void api_change_view(struct api_world *world);
void api_record_views(struct api_world *world, VkCommandBuffer cmd);
void api_views_close(struct api_world *world);
/* The rules of views: whoever breaks one is refused. */
enum sdfgi_result api_wrong_view(struct api_world *world);
/* Calls that must be refused and change nothing. */
void api_break_rule(struct api_world *world);

/* Adds the objects of `scene`, where `walked` has them, to the empty context of `t`. */
void api_scene_build(struct gi_test *t, const struct api_device *device, const struct api_scene *scene,
                     const struct gi_test *walked);

struct sdfgi_material_desc api_random_material(struct test_random *random);
struct sdfgi_light_desc api_random_light(struct test_random *random);
struct sdfgi_transform api_random_transform(struct test_random *random);

#endif
