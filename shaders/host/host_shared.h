/* SPDX-License-Identifier: MIT
 * Layouts and bindings that the host's shaders and C code share. Only 16-byte members, so that std140, std430
 * and C agree without any device feature. Positions are relative to the frame's origin. */
#ifndef HOST_SHARED_H
#define HOST_SHARED_H

#ifdef VULKAN /* GLSL */
#define HOST_VEC4(name)     vec4 name
#define HOST_UVEC4(name)    uvec4 name
#define HOST_VEC4S(name, n) vec4 name[n]
#else
#include <stdint.h>
#define HOST_VEC4(name)     float name[4]
#define HOST_UVEC4(name)    uint32_t name[4]
#define HOST_VEC4S(name, n) float name[n][4]
#endif

#define HOST_CASCADES         4
#define HOST_MAX_SUNS         4 /* directional lights with shadow maps */
#define HOST_SUN_LAYERS       16
#define HOST_SUN_MAP_SIZE     2048
#define HOST_TEXTURE_COUNT    4
#define HOST_MAX_SAMPLES      16 /* points of the world whose light is read at a time */
#define HOST_FOG_TILE         8  /* pixels along a froxel's side, where that does not make too many */
#define HOST_FOG_SLICES       64 /* froxels along a ray */
#define HOST_FOG_AIR          2  /* froxels along a side of those in which GI is looked up */
#define HOST_FOG_THREADS      4  /* along each axis of a group of froxels */
#define HOST_FOG_COLUMNS      8  /* along each axis of a group of columns */
#define HOST_EXPOSURE_THREADS 64
#define HOST_EXPOSURE_SAMPLES 64 /* along each side of the picture */

#define HOST_SET_FRAME    0
#define HOST_SET_MATERIAL 1
#define HOST_SET_FOG      1 /* of passes that make fog */
#define HOST_SET_GI       2 /* the library's, or one with a picture of its light */

/* Of HOST_SET_FRAME, where there is fog. */
#define HOST_FOG_BINDING 5

/* enum host_aov, for shaders */
#define HOST_SHOW_COLOR            0
#define HOST_SHOW_DIRECT           1
#define HOST_SHOW_DIFFUSE_INDIRECT 2
#define HOST_SHOW_IRRADIANCE       3
#define HOST_SHOW_REFLECTION       4
#define HOST_SHOW_NORMAL           5
#define HOST_SHOW_DEPTH            6
#define HOST_SHOW_ALBEDO           7
#define HOST_SHOW_ROUGHNESS        8

#define HOST_MATERIAL_MASK         1u
#define HOST_MATERIAL_BLEND        2u
#define HOST_MATERIAL_UNLIT        4u
#define HOST_MATERIAL_LAMBERT      8u
#define HOST_MATERIAL_BASE_MAP     16u
#define HOST_MATERIAL_SURFACE_MAP  32u
#define HOST_MATERIAL_NORMAL_MAP   64u
#define HOST_MATERIAL_EMISSIVE_MAP 128u

/* Rows of an affine or projective matrix: component i of the result is dot(row[i], (p, 1)). */
struct host_push {
    HOST_VEC4S(model, 3);
    HOST_VEC4S(clip, 4);
    HOST_VEC4(params); /* x: -1 for mirrored transforms, else 1 */
};

struct host_sample_push {
    HOST_VEC4(position); /* w: which result it is */
    HOST_VEC4(normal);   /* unit; w: metres along it to the viewer */
};

struct host_sun_data {
    HOST_VEC4(direction); /* towards the light; w: tangent of half the disc's angle */
    HOST_VEC4(irradiance);
    HOST_VEC4S(rows, 3 * HOST_CASCADES); /* x, y in [-1, 1]; z: 1 at the light's side, 0 at the far side */
    HOST_VEC4S(scale, HOST_CASCADES);    /* x: metres per texel, y: metres of the depth range */
};

struct host_frame_data {
    HOST_VEC4(
        camera_position); /* orthographic: in the near plane; w: 1 if there is a picture of reflections */
    HOST_VEC4(camera_forward); /* w: 1 if the camera is orthographic, else 0 */
    HOST_VEC4(camera_right);   /* times half the width of what is seen, 1 m away or anywhere */
    HOST_VEC4(camera_up);      /* times half its height */
    HOST_VEC4(camera_range);   /* metres along the axis; x: to the near plane; y: orthographic: from there
                                  to the far plane */
    HOST_VEC4(sky_zenith);
    HOST_VEC4(sky_horizon);
    HOST_VEC4(sky_ground);
    HOST_VEC4(fog_medium);  /* rgb: albedo; w: mean cosine of the phase function */
    HOST_VEC4(fog_density); /* x: extinction at a height, 1/m, 0: fog is left out; y: that height; z: falloff,
                               1/m; w: what froxels hold over radiance */
    HOST_VEC4(fog_slices);  /* x: metres to the far side of the first slice; y: doublings of the distance per
                               slice; z: metres to the far side of the last */
    HOST_VEC4(fog_grid);    /* xy: pixels of the picture; z: along a froxel's side; w: 1 if GI has light */
    HOST_UVEC4(counts);     /* x: suns, y: punctual lights, z: HOST_SHOW_*, w: samples along a pixel's side */
#ifdef VULKAN
    host_sun_data suns[HOST_MAX_SUNS];
#else
    struct host_sun_data suns[HOST_MAX_SUNS];
#endif
};

struct host_light_data {
    HOST_VEC4(position);  /* w: 1 / range, 0 for unlimited */
    HOST_VEC4(intensity); /* w: first shadow layer, negative for none */
    HOST_VEC4(
        direction);  /* the way a spot's light travels; w: 1 if all six layers of a cube are used, else 0 */
    HOST_VEC4(cone); /* x: cos(outer), y: 1 / (cos(inner) - cos(outer)); a point light has x = -2, y = 1 */
};

/* One face of a punctual shadow map: d from the light is seen at (dot(right, d), dot(up, d)) / dot(forward,
 * d). */
struct host_layer_data {
    HOST_VEC4(right); /* w: depth of the near plane, metres */
    HOST_VEC4(up);    /* w: metres per texel at a distance of 1 m */
    HOST_VEC4(forward);
};

struct host_material_data {
    HOST_VEC4(base_color);
    HOST_VEC4(emissive);
    HOST_VEC4(surface);                     /* metallic, roughness, normal scale, alpha cutoff */
    HOST_UVEC4(flags);                      /* HOST_MATERIAL_* */
    HOST_VEC4S(uv, 2 * HOST_TEXTURE_COUNT); /* rows of the 2x3 matrices; w of the first: UV set */
};

#endif
