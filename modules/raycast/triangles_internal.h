/* SPDX-License-Identifier: MIT
 *
 * Shared by the files that make up the triangle geometry.
 */
#ifndef RAYCAST_TRIANGLES_INTERNAL_H
#define RAYCAST_TRIANGLES_INTERNAL_H

#include <embree3/rtcore.h>

#include "material.h"
#include "triangles.h"

/* An instance of the scene, its vertices already in the tracer's space. Instances are not shared in Embree:
 * transforms in single precision would open seams between neighbours. */
struct mesh {
    const struct triangles *owner;
    const struct gltf_primitive *primitive;
    const struct gltf_material *material;
    const float *positions;     /* 3 per vertex; owned by Embree */
    const uint32_t *indices;    /* owned by Embree */
    struct vec3 linear[3];      /* columns of the transform's linear part */
    struct vec3 normal_rows[3]; /* rows of its inverse transpose, up to a positive factor */
    bool mirrored;              /* the transform swaps front and back */
    float *emitter_density; /* per triangle: density per area of picking a point on it; NULL: no emitter */
};

struct emitter {
    uint32_t mesh, triangle;
};

struct triangles {
    struct geometry base;
    RTCDevice device;
    RTCScene scene;
    struct material_context materials;
    struct gltf_material default_material; /* of primitives that name none */
    bool cull_back_faces;
    struct mesh *meshes; /* index = Embree's geometry id */
    uint32_t mesh_count;
    struct emitter *emitters;
    double *emitter_cdf; /* running share of the total power, up to 1 */
    uint32_t emitter_count;
};

struct corners {
    struct vec3 p[3];
};

/* A hit as Embree reports it. */
struct triangle_hit {
    uint32_t mesh, triangle;
    float u, v;
};

struct corners mesh_corners(const struct mesh *m, uint32_t triangle);

/* Twice the area times the unit normal of the front side. */
struct vec3 mesh_front(const struct mesh *m, const struct corners *c);

struct material_point mesh_material_point(const struct mesh *m, uint32_t triangle, float u, float v);

/* Fill in the transform parts of a mesh from a column-major matrix. */
void mesh_transform_set(struct mesh *m, const double transform[16]);

void triangle_surface(const struct triangles *t, const struct ray *ray, const struct triangle_hit *hit,
                      struct surface *out);

/* List the emissive triangles; false: out of memory. */
bool emitters_build(struct triangles *t);
void emitters_sample(const struct geometry *g, struct random *r, struct emitter_sample *out);

#endif
