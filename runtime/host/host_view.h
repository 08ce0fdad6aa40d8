/* SPDX-License-Identifier: MIT
 * What a VIEW.json says about a scene, as plain data: camera, sky, lights and how materials are read.
 *
 * Conventions: glTF coordinates (+Y up, metres), linear RGB, W/m^2, W/sr and W/(m^2 sr), angles in radians.
 * The arrays belong to whoever filled the struct in and need only outlive the calls they are given to. */
#ifndef HOST_VIEW_H
#define HOST_VIEW_H

#include <stdbool.h>
#include <stdint.h>

struct host_camera {
    double position[3];
    double look_at[3]; /* differs from position */
    float up[3];       /* need not be unit or orthogonal; not parallel to the view direction */
    float yfov_rad;    /* of a perspective camera, (0, pi) */
    /* Above 0: the camera is orthographic, and this is half the height of what it shows. Nothing is shown
     * that is nearer along its axis than znear_m or farther than zfar_m; 0 <= znear_m < zfar_m. */
    float ymag_m, znear_m, zfar_m;
};

/* Where an orthographic camera ends that does not say it. */
#define HOST_ZFAR_M 10000

/* Radiance L(d) = lerp(horizon, d.y >= 0 ? zenith : ground, |d.y|); all zero is no sky. */
struct host_sky {
    float zenith[3], horizon[3], ground[3];
};

/* Radiance from all directions, in place of the sky's colours: a picture whose rows go from +Y down to -Y,
 * and whose columns go around from +Z by -X, -Z, in the middle, and +X. */
struct host_environment {
    float *rgb; /* 3 * width * height, in [0, HOST_ENVIRONMENT_MAX]; NULL: none */
    uint32_t width, height;
};
#define HOST_ENVIRONMENT_MAX 65504 /* of half floats */

struct host_sun {
    bool enabled;
    float direction[3];  /* the way the light travels; need not be unit length */
    float irradiance[3]; /* on a plane that faces it, W/m^2 */
    float angle_rad;     /* full angle of the disc: softens shadow edges only */
};

/* A medium that fills all space. It scatters the light of sun, lamps and GI, none of which it dims on the way
 * to where it is scattered: surfaces get as much as without it. */
struct host_fog {
    float density;        /* extinction at `height_m`, 1/m; 0: there is no fog */
    float albedo[3];      /* share of what is extinct that is scattered, [0, 1] */
    float height_falloff; /* 1/m: density times exp(-falloff * (y - height)); 0: the same everywhere */
    double height_m;
    float anisotropy; /* mean cosine of Henyey and Greenstein's phase function, (-1, 1) */
};

enum host_light_type { HOST_LIGHT_POINT, HOST_LIGHT_SPOT, HOST_LIGHT_DIRECTIONAL };

struct host_light {
    enum host_light_type type;
    double position[3];         /* point, spot */
    float direction[3];         /* spot, directional: the way the light travels */
    float intensity[3];         /* W/sr, or W/m^2 for directional lights */
    float range_m;              /* 0: unlimited */
    float radius_m;             /* 0: a point; the renderer treats all lights as points */
    float inner_rad, outer_rad; /* spot: half angles, 0 <= inner < outer <= pi/2 */
};

enum host_materials { HOST_MATERIALS_GLTF, HOST_MATERIALS_LAMBERT };

struct host_view {
    struct host_camera camera;
    struct host_sky sky;
    struct host_environment environment;
    struct host_sun sun;
    struct host_fog fog;
    struct host_light *lights; /* in addition to those of the scene file */
    uint32_t light_count;
    float punctual_scale; /* factor on the lights of the scene file; 0 switches them off */
    float emissive_scale; /* factor on all emission */
    enum host_materials materials;
    float default_albedo[3]; /* base colour of primitives that name no material in the file */
};

/* Camera 5 m in front of the origin, no sky, no sun, no fog, scales of 1, glTF materials, default albedo 0.8.
 */
void host_view_default(struct host_view *view);

#endif
