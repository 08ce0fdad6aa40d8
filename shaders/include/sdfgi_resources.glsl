/* SPDX-License-Identifier: MIT
 * The library's descriptor set. A pass defines SDFGI_WRITES_<NAME> before including this for what it writes;
 * all else is read-only. A host defines SDFGI_SET, the index at which it binds the set. */
#ifndef SDFGI_RESOURCES_GLSL
#define SDFGI_RESOURCES_GLSL

#include "../shared/constants.h"
#include "../shared/bindings.h"
#include "../shared/frame.h"

#ifndef SDFGI_SET
#define SDFGI_SET 0
#endif

#ifdef SDFGI_WRITES_BITS
#define SDFGI_ACCESS_BITS
#else
#define SDFGI_ACCESS_BITS readonly
#endif
#ifdef SDFGI_WRITES_DISTANCE
#define SDFGI_ACCESS_DISTANCE
#else
#define SDFGI_ACCESS_DISTANCE readonly
#endif
#ifdef SDFGI_WRITES_LIGHT
#define SDFGI_ACCESS_LIGHT
#else
#define SDFGI_ACCESS_LIGHT readonly
#endif
#ifdef SDFGI_WRITES_MASKS
#define SDFGI_ACCESS_MASKS
#else
#define SDFGI_ACCESS_MASKS readonly
#endif
#ifdef SDFGI_WRITES_PROBES
#define SDFGI_ACCESS_PROBES
#else
#define SDFGI_ACCESS_PROBES readonly
#endif
#ifdef SDFGI_WRITES_IRRADIANCE
#define SDFGI_ACCESS_IRRADIANCE
#else
#define SDFGI_ACCESS_IRRADIANCE readonly
#endif
#ifdef SDFGI_WRITES_OCCLUSION
#define SDFGI_ACCESS_OCCLUSION
#else
#define SDFGI_ACCESS_OCCLUSION readonly
#endif

/* All members are vec4-sized: std140 lays them out as C does. */
layout(std140, set = SDFGI_SET, binding = SDFGI_BINDING_FRAME) uniform sdfgi_frame_buffer
{
    sdfgi_frame_params sdfgi_frame;
};

/* Solid bits: per cell 64 sub-voxels, bit x + 4 y + 16 z; x holds z = 0, 1 and y holds z = 2, 3. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_BITS) SDFGI_ACCESS_BITS buffer sdfgi_bits_buffer
{
    uvec2 sdfgi_bits[];
};

/* Distance from a cell's centre to the nearest set sub-voxel's centre: 16 bits per cell, two cells per word.
 */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_DISTANCE) SDFGI_ACCESS_DISTANCE buffer sdfgi_distance_buffer
{
    uint sdfgi_distances[];
};

/* Outgoing radiance per light cell, lib/light_pack.glsl. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_LIGHT) SDFGI_ACCESS_LIGHT buffer sdfgi_light_buffer
{
    uvec2 sdfgi_light[];
};

/* Eight bits per cell: which probes of its cage a light cell sees. Four cells per word. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_MASKS) SDFGI_ACCESS_MASKS buffer sdfgi_masks_buffer
{
    uint sdfgi_masks[];
};

/* Where each probe really is, see sdfgi_space.glsl. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_PROBES) SDFGI_ACCESS_PROBES buffer sdfgi_probes_buffer
{
    uint sdfgi_probes[];
};

/* (mean, mean of squares) of depth as unorm16 of the range, 18 x 18 texels a probe. Empty unless probe_depth
 * is on. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_OCCLUSION) SDFGI_ACCESS_OCCLUSION buffer sdfgi_occlusion_buffer
{
    uint sdfgi_occlusion[];
};

/* Irradiance over pi times exposure, four half floats a texel, SDFGI_IRRADIANCE_COUNT texels a probe. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_IRRADIANCE) SDFGI_ACCESS_IRRADIANCE buffer sdfgi_irradiance_buffer
{
    uvec2 sdfgi_irradiance_texels[];
};

#endif
