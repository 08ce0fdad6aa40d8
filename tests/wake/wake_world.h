/* SPDX-License-Identifier: MIT
 * A small world as a host describes it: plain descriptions, in which meshes and materials of instances are
 * indices. A context can be made of it, or follow a change of it. */
#ifndef TEST_WAKE_WORLD_H
#define TEST_WAKE_WORLD_H

#include "gi_test.h"

enum { WAKE_LIGHTS = 3, WAKE_MATERIALS = 4, WAKE_MESHES = 3, WAKE_INSTANCES = 4, WAKE_TEXTURES = 2 };

/* Buffers that meshes read: those of the room, those that nothing reads at first, and those that things read.
 */
enum wake_buffer {
    WAKE_ROOM_POSITIONS,
    WAKE_ROOM_INDICES,
    WAKE_OTHER_UVS,
    WAKE_OTHER_COLORS,
    WAKE_UVS,
    WAKE_COLORS,
    WAKE_INDICES,
    WAKE_OTHER_INDICES,
    WAKE_OTHER_POSITIONS,
    WAKE_POSITIONS,
    WAKE_BUFFERS,
    WAKE_THINGS = WAKE_OTHER_UVS, /* the first that is not the room's */
};

/* What the host can change behind the library's back: versions of it. */
struct wake_contents {
    uint32_t buffers[WAKE_BUFFERS];
    uint32_t textures[WAKE_TEXTURES];
};

struct wake_world {
    struct sdfgi_settings settings;
    struct sdfgi_frame_desc frame;
    struct sdfgi_sky sky;
    struct sdfgi_light_desc lights[WAKE_LIGHTS];
    struct sdfgi_material_desc materials[WAKE_MATERIALS];
    struct sdfgi_mesh_desc meshes[WAKE_MESHES];
    struct sdfgi_instance_desc instances[WAKE_INSTANCES];
    bool light_exists[WAKE_LIGHTS], instance_exists[WAKE_INSTANCES];
    struct wake_contents contents;
};

/* What a change of a field changes. */
enum wake_object {
    WAKE_SETTINGS,
    WAKE_FRAME,
    WAKE_SKY,
    WAKE_LIGHT,
    WAKE_MATERIAL,
    WAKE_MESH,
    WAKE_INSTANCE,
    WAKE_LIGHT_EXISTS,
    WAKE_INSTANCE_EXISTS,
    WAKE_BUFFER_CONTENT,
    WAKE_TEXTURE_CONTENT,
};

struct wake_context {
    sdfgi *gi;
    sdfgi_light lights[WAKE_LIGHTS];
    sdfgi_material materials[WAKE_MATERIALS];
    sdfgi_mesh meshes[WAKE_MESHES];
    sdfgi_instance instances[WAKE_INSTANCES];
};

/* A device with buffers and textures, which outlive contexts. `t.gi` is whichever context is worked with. */
struct wake_device {
    struct gi_test t;
    struct gpu_test_buffer buffers[WAKE_BUFFERS];
    struct gpu_test_image textures[WAKE_TEXTURES];
    struct wake_contents contents; /* as they are on the device */
};

void wake_device_open(struct wake_device *device);
void wake_device_close(struct wake_device *device);
/* Writes buffers and textures whose version is another. */
void wake_device_write(struct wake_device *device, const struct wake_contents *contents);

/* A room that is open to the sky, with an emitter, a thing with textures, one with holes, and three lights.
 */
void wake_world_init(struct wake_world *world, const struct wake_device *device,
                     const struct sdfgi_settings *settings);

void wake_context_create(struct wake_context *context, struct wake_device *device,
                         const struct wake_world *world);
/* Does what a host does after a change from `before` to `after`, which differ in one object. `new_first`:
 * what is replaced goes after the new is there, where both ways are open. */
void wake_context_follow(struct wake_context *context, struct wake_device *device,
                         const struct wake_world *before, const struct wake_world *after,
                         enum wake_object object, uint32_t index, bool new_first);

#endif
