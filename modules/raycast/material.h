/* SPDX-License-Identifier: MIT
 *
 * glTF materials at a point: textures, factors, and what `lambert` makes of them.
 */
#ifndef RAYCAST_MATERIAL_H
#define RAYCAST_MATERIAL_H

#include "../gltf/gltf_scene.h"
#include "raycast.h"
#include "vec3.h"

struct material_context {
    const struct gltf_scene *scene;
    enum raycast_materials mode;
    float emissive_scale;
    float srgb[256]; /* 8-bit sRGB to linear */
};

void material_context_init(struct material_context *c, const struct gltf_scene *scene,
                           const struct raycast_view *view);

/* Whether a material is the one the importer appends for primitives that name none. */
bool material_is_default(const struct gltf_scene *scene, int32_t index);

/* What such primitives are made of: the view's albedo, which means no metal. */
struct gltf_material material_default(const struct gltf_scene *scene, int32_t index, const float albedo[3]);

/* Interpolated inputs of a point. */
struct material_point {
    float uv[2][2]; /* per set */
    float color[4]; /* of the vertices, linear; ones when there is none */
};

struct rgba {
    float r, g, b, a;
};

struct rgba material_base_color(const struct material_context *c, const struct gltf_material *m,
                                const struct material_point *p);

/* Share of rays the surface stops: 0 or 1 for masks, alpha for blends, 1 for opaque ones. */
float material_coverage(const struct material_context *c, const struct gltf_material *m,
                        const struct material_point *p);

/* Radiance of the emitting side, scaled by the view's emissive scale. */
struct vec3 material_emission(const struct material_context *c, const struct gltf_material *m,
                              const struct material_point *p);

/* x: roughness, y: metallic. */
void material_roughness_metallic(const struct material_context *c, const struct gltf_material *m,
                                 const struct material_point *p, float *roughness, float *metallic);

/* Normal in tangent space from the map; false: there is no map. */
bool material_tangent_normal(const struct material_context *c, const struct gltf_material *m,
                             const struct material_point *p, struct vec3 *normal);

static inline bool material_emits(const struct gltf_material *m)
{
    return m->emissive[0] > 0.0f || m->emissive[1] > 0.0f || m->emissive[2] > 0.0f;
}

#endif
