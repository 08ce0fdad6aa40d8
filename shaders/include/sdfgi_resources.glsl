/* SPDX-License-Identifier: MIT
 * The LOOKUP set: what lookups read. All of it is read-only; a pass that writes a buffer defines
 * SDFGI_WRITES_<NAME> before it includes this file. A host defines SDFGI_SET, the index at which it binds the
 * set. */
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

/* Occupancy bits: 64 per cell, bit x + 4 y + 16 z per sub-voxel; .x holds z = 0, 1 and .y holds z = 2, 3. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_BITS) SDFGI_ACCESS_BITS buffer sdfgi_bits_buffer
{
    uvec2 sdfgi_bits[];
};

/* Distance field: from a cell's centre to that of the nearest set sub-voxel, 16 bits per cell, two cells per
 * word. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_DISTANCE) SDFGI_ACCESS_DISTANCE buffer sdfgi_distance_buffer
{
    uint sdfgi_distances[];
};

/* Outgoing radiance per light cell, packed by lib/light_pack.glsl. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_LIGHT) SDFGI_ACCESS_LIGHT buffer sdfgi_light_buffer
{
    uvec2 sdfgi_light[];
};

/* Visibility bits: eight per cell, which probes of its cage a light cell sees. Four cells per word. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_MASKS) SDFGI_ACCESS_MASKS buffer sdfgi_masks_buffer
{
    uint sdfgi_masks[];
};

/* The state of each probe: where it stands, whether it is dead, and its links. See sdfgi_space.glsl. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_PROBES) SDFGI_ACCESS_PROBES buffer sdfgi_probes_buffer
{
    uint sdfgi_probes[];
};

/* Mean and mean of squares of depth as unorm16 of SDFGI_OCCLUSION_RANGE, 18 x 18 texels per probe. Empty
 * unless the visibility method is PROBE_DEPTH. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_OCCLUSION) SDFGI_ACCESS_OCCLUSION buffer sdfgi_occlusion_buffer
{
    uint sdfgi_occlusion[];
};

/* The irradiance atlas: irradiance over pi times exposure, packed by lib/irradiance_pack.glsl,
 * SDFGI_IRRADIANCE_COUNT texels per probe. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_IRRADIANCE) SDFGI_ACCESS_IRRADIANCE buffer sdfgi_irradiance_buffer
{
    uvec2 sdfgi_irradiance_texels[];
};

#endif
