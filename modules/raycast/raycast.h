/* SPDX-License-Identifier: MIT
 *
 * Ground truth: an unbiased path tracer over a glTF scene, for comparing a renderer with.
 *
 * It shares the scene's data with the renderer and none of its lighting code. Progressive, seeded, and
 * deterministic: the same scene, view, settings and seed give the same bits whatever the number of threads,
 * and whether or not the run was interrupted and resumed.
 *
 * Conventions: glTF coordinates, metres, linear RGB; radiance in W/(m^2 sr), irradiance in W/m^2; pictures
 * start with the top row. A Lambertian surface of albedo a leaves a * E / pi.
 *
 * Light: sun, point and spot lights, sky and emissive triangles, sampled directly and weighted against
 * sampling of the surface. No value is clamped; samples that are not finite are left out and counted.
 *
 * Surfaces: Lambertian times 1 - F of the view's angle, under GGX with the light that goes from facet to
 * facet (modules/raycast/bsdf.h). All faces block and bounce light from both sides; emission leaves the front
 * only unless the material is double-sided; alpha masks cut, blended alpha lets its share of the rays pass;
 * an unlit material shows its base colour to the camera and scatters as Lambertian for every other ray. The
 * ambient-occlusion texture is not used: occlusion is computed.
 *
 * Lifetime: a tracer reads textures and vertices from the scene it was made from, so the scene must outlive
 * it.
 *
 * Threading: one thread at a time per tracer; the work itself is spread over `threads`.
 */
#ifndef RAYCAST_H
#define RAYCAST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

struct gltf_scene;
struct raycast;

struct raycast_camera {
    double position[3], look_at[3];
    float up[3];
    float yfov_deg; /* of a pinhole, (0, 180) */
    /* Above 0: the camera is orthographic, and this is half the height of what it shows. Nothing nearer than
     * znear_m along its axis is shown, or farther than zfar_m; 0 <= znear_m < zfar_m. */
    float ymag_m, znear_m, zfar_m;
};

/* Radiance from direction d: lerp(horizon, d.y >= 0 ? zenith : ground, |d.y|). All zero: no sky. */
struct raycast_sky {
    float zenith[3], horizon[3], ground[3];
};

/* Radiance from all directions, in place of the sky: rows from +Y down to -Y, columns from +Z around by -X,
 * -Z, in the middle, and +X. Texels are not mixed. */
struct raycast_environment {
    const float *rgb; /* 3 * width * height, finite and not negative; outlives the tracer. NULL: none */
    uint32_t width, height;
};

struct raycast_sun {
    float direction[3];  /* the way the light travels; any length but zero */
    float irradiance[3]; /* on a plane facing the sun; all zero: no sun */
    float angle_deg;     /* apparent diameter, [0, 90] */
};

enum raycast_light_type { RAYCAST_LIGHT_POINT, RAYCAST_LIGHT_SPOT };

struct raycast_light {
    enum raycast_light_type type;
    double position[3];
    float direction[3];         /* spot: the way the light travels */
    float intensity[3];         /* W/sr */
    float inner_deg, outer_deg; /* spot: half angles, 0 <= inner < outer <= 90 */
    float radius_m;             /* 0: a point; else a sphere of the same intensity, unseen by the camera */
    float range_m;              /* no light beyond; 0: unlimited */
};

enum raycast_materials { RAYCAST_MATERIALS_GLTF, RAYCAST_MATERIALS_LAMBERT };

/* What a VIEW.json file says. Nothing has a default here: fill in every field. */
struct raycast_view {
    struct raycast_camera camera;
    struct raycast_sky sky;
    struct raycast_environment environment;
    struct raycast_sun sun;
    const struct raycast_light *lights; /* beside those of the scene; copied */
    uint32_t light_count;
    float punctual_scale; /* of the lights of the scene */
    float emissive_scale;
    enum raycast_materials materials;
    float default_albedo[3]; /* of primitives without a material */
};

enum raycast_aov {
    RAYCAST_AOV_RADIANCE,         /* the picture: the sum of the next four */
    RAYCAST_AOV_EMISSION,         /* emission and sky seen by the camera itself */
    RAYCAST_AOV_DIRECT,           /* sun, point and spot lights after one reflection */
    RAYCAST_AOV_DIFFUSE_INDIRECT, /* all other light leaving the Lambertian part of the first surface */
    RAYCAST_AOV_REFLECTION,       /* all other light leaving its specular part */
    RAYCAST_AOV_IRRADIANCE, /* E at the first surface without sun, point and spot lights, before albedo */
    RAYCAST_AOV_NORMAL,     /* world space, shading normal on the camera's side, averaged */
    RAYCAST_AOV_DEPTH,    /* metres along the viewing axis, averaged over the hits; 0 where nothing is hit */
    RAYCAST_AOV_ALBEDO,   /* of the Lambertian part: base colour * (1 - metallic) */
    RAYCAST_AOV_VARIANCE, /* of RADIANCE as returned: sample variance / samples, per channel */
    RAYCAST_AOV_COUNT
};

/* 1 for depth, else 3. */
uint32_t raycast_aov_channels(enum raycast_aov aov);

/* As on the command line: "direct", "diffuse_indirect", ... */
const char *raycast_aov_name(enum raycast_aov aov);

enum { RAYCAST_MAX_CASCADES = 8, RAYCAST_NO_SLOPE = 127 };

/* What a voxel renderer knows of the surfaces in 2x2x2 cells. Axes: +x -x +y -y +z -z. */
struct raycast_block {
    float emission[3];     /* mean radiance of what emits, W/(m^2 sr) */
    uint16_t albedo[6][3]; /* per axis that a surface faces, in 1/1023 */
    uint8_t emitting[6];   /* per axis, in 1/31: the share of what is seen from there that emits */
    /* Per largest component k, x to z: mean normal of such triangles, up to its sign: 1 along k, then in 1/15
     * along the next axis and the one after that, in cyclic order. RAYCAST_NO_SLOPE in the first: there are
     * none. */
    int8_t slopes[3][2];
};

struct raycast_cascade {
    double low_m[3];      /* world position of the low corner */
    double cell_m[3];     /* twice those of the cascade before */
    uint32_t resolution;  /* cells along a side, even */
    const uint64_t *bits; /* per cell, x fastest, then y: bit x + 4 y + 16 z of its 4^3 sub-voxels */
    const struct raycast_block *blocks; /* resolution / 2 along a side, in the same order */
};

/* The volumes of a voxel renderer, finest first, all on the cells of the finest. */
struct raycast_voxels {
    uint32_t cascade_count;
    struct raycast_cascade cascades[RAYCAST_MAX_CASCADES];
};

/* Zero means the default. */
struct raycast_settings {
    uint32_t width, height; /* pixels; default 320x180, at most 16384 each */
    uint64_t seed;          /* default 0; every value is a seed of its own */
    uint32_t max_bounces;   /* reflections of a path; default 64, at most 65536 */
    uint32_t threads;       /* default: one per processor */
    uint32_t aovs;          /* bits 1 << RAYCAST_AOV_*; radiance and variance are always kept */
    bool cull_back_faces;   /* camera rays pass the backs of single-sided faces, as a rasteriser's do */
    /* NULL: all rays meet triangles. Else the camera, and the sun, point and spot lights of what it sees,
     * meet triangles, and every other ray meets these, which must outlive the tracer;
     * modules/raycast/voxels.h says how. */
    const struct raycast_voxels *voxels;
};

/* Asked by all threads many times a second; return true to stop. `user` is that of raycast_render. */
typedef bool raycast_stop_fn(void *user);

/* When to stop: whichever comes first; zero: no such limit (but one is needed). */
struct raycast_budget {
    uint32_t samples; /* per pixel, counted from the start of the picture, resumed samples included */
    double seconds;   /* of this call */
    double error;     /* mean over the pixels of standard error / luminance (of at least 1 % of the mean) */
    raycast_stop_fn *stop; /* NULL: nobody asks for an end */
};

struct raycast_progress {
    uint32_t samples;    /* of each pixel, so far: of those that have the fewest */
    double mean_samples; /* of all pixels */
    double fraction;     /* of the time of this call, by the nearest limit, [0, 1] */
    double seconds;      /* of this call */
    double seconds_left; /* estimated; infinite where nothing can be foreseen */
    double error;        /* as in the budget; infinite before 16 samples */
    uint64_t rays;       /* of this call, shadow rays included */
    uint64_t not_finite; /* samples left out */
};

/* Called about once a second; return false to stop there. */
typedef bool raycast_progress_fn(const struct raycast_progress *progress, void *user);

/* Prepare a tracer. Returns NULL with one line in `error` when the view or the settings are wrong (naming the
 * field) or memory runs out. */
struct raycast *raycast_create(const struct gltf_scene *scene, const struct raycast_view *view,
                               const struct raycast_settings *settings, char *error, size_t error_size);

/* NULL is accepted. */
void raycast_destroy(struct raycast *rc);

/* The settings in force, defaults filled in. */
const struct raycast_settings *raycast_settings_get(const struct raycast *rc);

/* Add samples until the budget is spent. `progress` may be NULL; `last` (may be NULL) receives the final
 * state. Returns false when a callback stopped it before. A run that is stopped, or that has spent its time,
 * keeps all samples: some tiles of the picture may have more than others. */
bool raycast_render(struct raycast *rc, const struct raycast_budget *budget, raycast_progress_fn *progress,
                    void *user, struct raycast_progress *last);

/* Copy a picture: width * height * channels floats. False when the AOV was not asked for at creation, or
 * there is a pixel without a sample. */
bool raycast_image(const struct raycast *rc, enum raycast_aov aov, float *out);

/* Write the accumulated sums; false when the stream fails. */
bool raycast_state_write(const struct raycast *rc, FILE *file);

/* Take such sums up again. A state of another scene, view or setting is refused, and so is one without
 * samples, or one that is cut short or damaged. On failure: false, one line in `error`, and the tracer
 * unchanged. */
bool raycast_state_load(struct raycast *rc, const char *path, char *error, size_t error_size);

/* Irradiance on a small one-sided plane at a point in free space. */
struct raycast_irradiance {
    float indirect[3];       /* from sky, emission and every bounce */
    float direct[3];         /* from sun, point and spot lights */
    float indirect_error[3]; /* standard error of `indirect` */
};

/* E at `count` points (3 doubles each, world space, metres) facing `normals` (3 floats each, any length but
 * zero), `samples` paths each. Point i draws from the stream of pixel i: the result does not depend on the
 * threads, and depends on the seed. */
void raycast_irradiance_gather(struct raycast *rc, const double *points, const float *normals, uint32_t count,
                               uint32_t samples, struct raycast_irradiance *out);

#ifdef __cplusplus
}
#endif
#endif
