/* SPDX-License-Identifier: MIT
 * The scene of the sample hosts, as a renderer of their own would have it: meshes that share a vertex and an
 * index buffer, a table of materials, objects with matrices, a lamp with a shadow map, a camera. Nothing here
 * knows of libsdfgi. Metres, +Y up in the world, and +Y down in clip space, as Vulkan has it. Matrices are
 * column-major. */
#ifndef SAMPLE_SCENE_H
#define SAMPLE_SCENE_H

#include "sample_draw.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SAMPLE_MAX_VERTICES = 64, SAMPLE_MAX_INDICES = 128, SAMPLE_MESHES = 2, SAMPLE_OBJECTS = 6 };
enum { SAMPLE_MATERIALS = 5, SAMPLE_SHADOW_SIDE = 1024 };

struct sample_vertex {
    int8_t normal[4]; /* signed normalised */
    float position[3];
};

struct sample_mesh {
    uint32_t first_vertex, vertex_count, first_index, index_count; /* indices count from first_vertex */
    float low[3], high[3];
};

struct sample_material {
    float base_color[4]; /* linear; a: share of metal */
    float glow[4];       /* radiance, W/(m^2 sr); a: roughness */
};

struct sample_object {
    uint32_t mesh, material;
    float matrix[16];
};

/* What all shaders of a frame read: sample_frame.glsl has the same. */
struct sample_view {
    float clip_from_world[16], world_from_clip[16], lamp_clip_from_world[16];
    float eye[4];
    float lamp_position[4], lamp_direction[4]; /* w: cosines of the inner and the outer half angle */
    float lamp_intensity[4];                   /* W/sr */
    float sky[4];                              /* radiance */
};

/* What a mesh is drawn with: sample_mesh.vert has the same. */
struct sample_push {
    float matrix[16];
    struct sample_material material;
};

struct sample_scene {
    struct sample_vertex vertices[SAMPLE_MAX_VERTICES];
    uint16_t indices[SAMPLE_MAX_INDICES];
    uint32_t vertex_count, index_count;
    struct sample_mesh meshes[SAMPLE_MESHES];
    struct sample_material materials[SAMPLE_MATERIALS];
    struct sample_object objects[SAMPLE_OBJECTS];
    struct sample_view view;
};

/* A grey floor, a red wall, a white one, a block that keeps the lamp's light off a part of the floor, and a
 * plate of smooth metal. */
void sample_scene_make(struct sample_scene *scene, float aspect);
/* Makes +Y point down: mirrors vertices, matrices and places. What is seen stays; triangles wind the other
 * way. */
void sample_scene_flip(struct sample_scene *scene);

/* The scene on a device. */
struct sample_drawing {
    struct sample_buffer vertices, indices, view;
    struct sample_image shadow;
    struct sample_pass shadow_pass;
    struct sample_pipeline shadow_pipeline;
};

/* `usage` is what buffers of vertices and indices are for beside drawing. */
struct sample_drawing sample_drawing_make(struct sample_gpu *gpu, const struct sample_scene *scene,
                                          VkBufferUsageFlags usage);
/* Draws the shadow map, which is the same in every frame. */
void sample_drawing_draw_shadow(const struct sample_drawing *drawing, const struct sample_scene *scene,
                                VkCommandBuffer cmd);
/* Draws all objects with the pipeline that is bound. */
void sample_drawing_draw(const struct sample_drawing *drawing, const struct sample_scene *scene,
                         VkPipelineLayout layout, VkCommandBuffer cmd);

#ifdef __cplusplus
}
#endif
#endif
