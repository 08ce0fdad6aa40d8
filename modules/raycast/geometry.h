/* SPDX-License-Identifier: MIT
 *
 * What light meets. The integrator sees geometry through this interface alone, so that other representations
 * of a scene than its triangles can be traced with the same estimators.
 *
 * Positions are relative to an origin near the camera (origin_near in camera.c), in metres.
 */
#ifndef RAYCAST_GEOMETRY_H
#define RAYCAST_GEOMETRY_H

#include <stdbool.h>
#include <stdint.h>

#include "random.h"
#include "vec3.h"

struct ray {
    struct vec3 origin, direction; /* direction of unit length */
    float length_m;                /* INFINITY: no end */
    uint32_t key;                  /* decides at blended surfaces */
    bool from_camera;
};

/* A point on a surface, as a ray meets it: both normals are turned to the side the ray came from. */
struct surface {
    struct vec3 position;
    struct vec3 start;                    /* of rays that leave it */
    struct vec3 geometric_normal, normal; /* unit; `normal` is for shading */
    struct vec3 diffuse;                  /* albedo of the Lambertian part */
    struct vec3 specular;                 /* reflectance at normal incidence; unused unless `glossy` */
    float alpha;                          /* of GGX: roughness squared */
    bool glossy;
    bool emits;
    struct vec3 emission; /* towards the ray, W/(m^2 sr) */
    float emission_pdf;   /* density with which `emitter_sample` picks this point, per area across the ray; 0:
                             never */
};

/* A point on an emitter. */
struct emitter_sample {
    struct vec3 position, normal; /* unit; front side */
    struct vec3 front, back;      /* emission to either side, W/(m^2 sr) */
    float pdf;                    /* density per area */
};

struct geometry {
    const struct geometry_methods *methods;
    float emitter_power; /* luminous W of all emitters; 0: there are none */
    float radius_m;      /* of a sphere around everything */
};

struct geometry_methods {
    /* The nearest surface along the ray; false: none. */
    bool (*intersect)(const struct geometry *g, const struct ray *ray, struct surface *out);
    /* Whether anything lies on the ray within its length. */
    bool (*occluded)(const struct geometry *g, const struct ray *ray);
    /* Choose a point on an emitter, more often on brighter ones; only where there are emitters. */
    void (*emitter_sample)(const struct geometry *g, struct random *r, struct emitter_sample *out);
    /* Turn a surface of another geometry in the same space into one that rays can leave through this one. */
    void (*adopt)(const struct geometry *g, struct surface *s);
    void (*destroy)(struct geometry *g);
};

static inline bool geometry_intersect(const struct geometry *g, const struct ray *ray, struct surface *out)
{
    return g->methods->intersect(g, ray, out);
}

static inline bool geometry_occluded(const struct geometry *g, const struct ray *ray)
{
    return g->methods->occluded(g, ray);
}

/* Move a point off its surface along `normal`, by a distance that covers the rounding of the intersection:
 * 256 units in the last place far from the origin (2^-16 of the coordinate), and nearer than 1/32 m the
 * length used there (the numbers of Wächter and Binder 2019, "A Fast and Robust Method for Avoiding
 * Self-Intersection", Ray Tracing Gems 6). */
static inline struct vec3 geometry_offset(struct vec3 position, struct vec3 normal)
{
    const float largest = fmaxf(fabsf(position.x), fmaxf(fabsf(position.y), fabsf(position.z)));
    return vec3_mad(position, normal, fmaxf(largest, 1.0f / 32.0f) * 0x1p-16f);
}

#endif
