/* SPDX-License-Identifier: MIT
 *
 * Builds a glTF 2.0 scene in memory and writes it as one .glb file.
 *
 * Units are those of glTF: metres, linear RGB, +Y up. Handles count from 1, so that a zero-initialised
 * descriptor says "none". Running out of memory or passing a bad handle is remembered, and makes
 * glb_writer_save fail: calls in between need no checks. */
#ifndef SAMPLES_GLB_WRITER_H
#define SAMPLES_GLB_WRITER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint32_t glb_handle;

struct glb_writer;

struct glb_material {
    const char *name;
    float base_color[4]; /* linear RGBA */
    float metallic, roughness;
    float emission[3];  /* radiance, any magnitude: beyond 1 it becomes KHR_materials_emissive_strength */
    float alpha_cutoff; /* > 0: alpha mask */
    bool double_sided;
    glb_handle base_color_texture, normal_texture, emission_texture;
};

struct glb_primitive {
    uint32_t vertex_count, index_count;
    const float *positions; /* 3 per vertex */
    const float *normals;   /* 3 per vertex, or NULL */
    const float *uvs;       /* 2 per vertex, or NULL */
    const float *colors;    /* 4 per vertex, linear, [0, 1], or NULL; stored with 16 bits */
    const uint32_t *indices;
    glb_handle material;
};

enum glb_light_type { GLB_LIGHT_DIRECTIONAL, GLB_LIGHT_POINT, GLB_LIGHT_SPOT };

struct glb_light {
    const char *name;
    enum glb_light_type type;
    float position[3];
    float direction[3]; /* directional, spot: the way the light travels, need not be unit length */
    float color[3];     /* linear, [0, 1] */
    float intensity;    /* W/sr (written as candela) or W/m^2 (written as lux) */
    float range_m;      /* 0: unlimited */
    float inner_rad, outer_rad;
};

struct glb_camera {
    const char *name;
    float position[3], look_at[3];
    float yfov_rad;
};

/* Returns NULL when out of memory. */
struct glb_writer *glb_writer_create(const char *generator);
void glb_writer_destroy(struct glb_writer *writer);

/* 8-bit texels, rows from the top, `channels` 3 or 4; embedded as PNG, repeated in both directions. */
glb_handle glb_writer_add_texture(struct glb_writer *writer, const char *name, uint32_t width,
                                  uint32_t height, uint32_t channels, const uint8_t *texels);
glb_handle glb_writer_add_material(struct glb_writer *writer, const struct glb_material *material);
glb_handle glb_writer_add_mesh(struct glb_writer *writer, const char *name,
                               const struct glb_primitive *primitives, uint32_t count);

/* A node that shows `mesh`; `transform` is column-major, NULL for identity. Nodes may share a mesh. */
void glb_writer_add_node(struct glb_writer *writer, const char *name, glb_handle mesh,
                         const float *transform);
void glb_writer_add_light(struct glb_writer *writer, const struct glb_light *light);
void glb_writer_add_camera(struct glb_writer *writer, const struct glb_camera *camera);

/* Writes the file whole or not at all. On failure returns false with one line in `error`. */
bool glb_writer_save(struct glb_writer *writer, const char *path, char *error, size_t error_size);

#endif
