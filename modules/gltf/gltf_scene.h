/* SPDX-License-Identifier: MIT
 *
 * A glTF 2.0 scene, flattened into plain arrays that a renderer or a path tracer can use directly.
 *
 * Conventions: glTF's own coordinates (+Y up, right handed, metres), linear RGB, candela and lux taken as
 * W/sr and W/m^2. An index of -1 means "none". All arrays belong to the scene and live until it is destroyed.
 * Thread-safety: a loaded scene is read-only and may be read from any thread.
 */
#ifndef GLTF_SCENE_H
#define GLTF_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum gltf_alpha_mode { GLTF_ALPHA_OPAQUE, GLTF_ALPHA_MASK, GLTF_ALPHA_BLEND };
enum gltf_wrap { GLTF_WRAP_REPEAT, GLTF_WRAP_MIRROR, GLTF_WRAP_CLAMP };
enum gltf_filter { GLTF_FILTER_LINEAR, GLTF_FILTER_NEAREST };
enum gltf_light_type { GLTF_LIGHT_DIRECTIONAL, GLTF_LIGHT_POINT, GLTF_LIGHT_SPOT };

/* 8-bit RGBA, rows from the top. `srgb` says that colours are stored in sRGB (base colour, emission). An
 * image used both ways appears once; the texture that refers to it says how it is to be read. */
struct gltf_image {
    uint32_t width, height;
    uint8_t *texels; /* 4 * width * height bytes */
};

struct gltf_texture {
    int32_t image;
    enum gltf_wrap wrap_u, wrap_v;
    enum gltf_filter min_filter, mag_filter;
};

/* A material's use of a texture. `uv_transform` is a row-major 2x3 matrix (KHR_texture_transform), already
 * composed: uv' = M * (u, v, 1). A texture that is referred to always has an image. */
struct gltf_texture_ref {
    int32_t texture; /* -1: none */
    int32_t uv_set;  /* 0 or 1 */
    float uv_transform[6];
};

struct gltf_material {
    char *name;          /* up to 255 bytes of UTF-8 */
    float base_color[4]; /* linear RGBA factor */
    float metallic;      /* [0, 1] */
    float roughness;     /* [0, 1] */
    float emissive[3];   /* radiance, W/(m^2 sr): emissive factor times KHR_materials_emissive_strength */
    float normal_scale;
    float occlusion_strength;
    float alpha_cutoff; /* [0, 1], for GLTF_ALPHA_MASK */
    enum gltf_alpha_mode alpha_mode;
    bool double_sided;
    bool unlit;
    struct gltf_texture_ref base_color_texture;         /* sRGB colour, linear alpha */
    struct gltf_texture_ref metallic_roughness_texture; /* linear: G roughness, B metallic */
    struct gltf_texture_ref normal_texture;             /* linear, tangent space */
    struct gltf_texture_ref occlusion_texture;          /* linear: R */
    struct gltf_texture_ref emissive_texture;           /* sRGB */
};

/* Indexed triangles with one material. Strips, fans, sparse and quantised accessors are already unpacked,
 * missing normals and tangents already made. Points and lines are left out and counted in the warning. */
struct gltf_primitive {
    uint32_t vertex_count, index_count; /* index_count is a multiple of 3; every index < vertex_count */
    float *positions;                   /* 3 per vertex, metres, finite */
    float *normals;                     /* 3 per vertex, unit length */
    float *tangents;                    /* 4 per vertex: unit tangent and handedness +-1 */
    float *uv0;                         /* 2 per vertex; never NULL (zeros when the file has none) */
    float *uv1;                         /* 2 per vertex; NULL only where no texture of the material uses it */
    float *colors;                      /* 4 per vertex, linear RGBA, or NULL */
    uint32_t *indices;
    int32_t material; /* never -1: primitives without one refer to an appended default material */
    float bounds_min[3], bounds_max[3];
};

/* One drawn primitive: a node of the file times a primitive of its mesh. */
struct gltf_instance {
    uint32_t primitive;
    double transform[16]; /* column-major, object to world, affine, finite */
    char *node_name;      /* may be NULL */
};

struct gltf_light {
    enum gltf_light_type type;
    double position[3];         /* point, spot */
    float direction[3];         /* directional, spot: unit, the way the light travels */
    float intensity[3];         /* W/sr (point, spot) or W/m^2 (directional): colour times intensity */
    float range;                /* metres; 0: unlimited */
    float inner_rad, outer_rad; /* spot: half angles, 0 <= inner < outer <= pi/2 */
    char *name;                 /* up to 255 bytes of UTF-8 */
};

struct gltf_camera {
    double transform[16]; /* column-major, camera to world, rigid; looks along -Z */
    float yfov_rad;       /* 0: orthographic, with the members below */
    float ymag;           /* half the height of the picture, metres */
    float znear, zfar;    /* metres along the axis, 0 <= znear < zfar */
    char *name;           /* up to 255 bytes of UTF-8 */
};

struct gltf_scene {
    struct gltf_image *images;
    struct gltf_texture *textures;
    struct gltf_material *materials;
    struct gltf_primitive *primitives;
    struct gltf_instance *instances;
    struct gltf_light *lights;
    struct gltf_camera *cameras;
    uint32_t image_count, texture_count, material_count, primitive_count, instance_count, light_count,
        camera_count;
    double bounds_min[3], bounds_max[3]; /* hold all instances' boxes, world space; zero without instances */
    char *warning;                       /* one line naming what the file uses and we do not, or NULL */
};

/* A moment of the file's animations. They play together, but where two move the same property of a node, the
 * first does. Before its first key and after its last a property keeps their values. */
struct gltf_pose {
    double time_s;
};

/* Read `path` (.glb or .gltf), with nodes, skins and morph targets at rest. Returns NULL on failure, with one
 * line in `error` that names the file and what is wrong with it; `error` holds `error_size` bytes and is
 * always terminated. Never crashes on broken input: every offset, count and index is checked again after the
 * parser. Files that it names must lie below its folder: neither their names nor links may lead outside. */
struct gltf_scene *gltf_scene_load(const char *path, char *error, size_t error_size);

/* The same at a moment of the animations; a `pose` of NULL is at rest. Skinned vertices are then where their
 * joints take them, and their instances are not turned. */
struct gltf_scene *gltf_scene_load_posed(const char *path, const struct gltf_pose *pose, char *error,
                                         size_t error_size);

/* Frees the scene; NULL is accepted. */
void gltf_scene_destroy(struct gltf_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
