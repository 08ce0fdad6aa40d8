/* SPDX-License-Identifier: MIT
 *
 * Grows triangle meshes from simple shapes, for the scene generators. Shapes pass through the mesh's current
 * transform and take its current colour. Texture coordinates of flat faces are in metres along the face,
 * before the transform, times uv_per_m. Running out of memory ends the program with a message. */
#ifndef SAMPLES_MESH_BUILDER_H
#define SAMPLES_MESH_BUILDER_H

#include <stdbool.h>
#include <stdint.h>

#include <cglm/struct.h>

#include "glb_writer.h"

struct mesh {
    float *positions, *normals, *uvs, *colors;
    uint32_t *indices;
    uint32_t vertex_count, vertex_capacity, index_count, index_capacity;
    mat4s transform;
    vec3s color;
    float uv_per_m;
};

static inline vec3s v3(float x, float y, float z)
{
    return (vec3s){ { x, y, z } };
}

void mesh_init(struct mesh *mesh);
void mesh_finish(struct mesh *mesh);

uint32_t mesh_vertex(struct mesh *mesh, vec3s position, vec3s normal, float u, float v);
void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c);

/* A flat face, counter-clockwise seen from its front. */
void mesh_quad(struct mesh *mesh, vec3s a, vec3s b, vec3s c, vec3s d);
/* The same with texture coordinates from (0, 1) at `a` to (1, 0) at `c`, and one normal of the caller's. */
void mesh_card(struct mesh *mesh, vec3s a, vec3s b, vec3s c, vec3s d, vec3s normal);
void mesh_face3(struct mesh *mesh, vec3s a, vec3s b, vec3s c);

void mesh_box(struct mesh *mesh, vec3s low, vec3s high);
/* The same box seen from within. */
void mesh_room(struct mesh *mesh, vec3s low, vec3s high);
/* An upright cone stump with caps. */
void mesh_cylinder(struct mesh *mesh, vec3s foot, float foot_radius, float top_radius, float height,
                   uint32_t segments);
void mesh_sphere(struct mesh *mesh, vec3s center, float radius, uint32_t segments);

/* Translation, rotation about +Y and scale, in the order scale, rotation, translation. */
mat4s placement(vec3s position, float yaw_rad, float scale);

/* The mesh as a primitive of a glb file. `colored`: with vertex colours. */
struct glb_primitive mesh_primitive(const struct mesh *mesh, glb_handle material, bool colored);

#endif
