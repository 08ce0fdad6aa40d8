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
#ifdef SDFGI_WRITES_LIGHT_BLOCKS
#define SDFGI_ACCESS_LIGHT_BLOCKS
#else
#define SDFGI_ACCESS_LIGHT_BLOCKS readonly
#endif
#ifdef SDFGI_WRITES_SURFACES
#define SDFGI_ACCESS_SURFACES
#else
#define SDFGI_ACCESS_SURFACES readonly
#endif
#ifdef SDFGI_WRITES_EMISSION
#define SDFGI_ACCESS_EMISSION
#else
#define SDFGI_ACCESS_EMISSION readonly
#endif

/* All members are vec4-sized: std140 lays them out as C does. A host may define
 * SDFGI_ZERO, an expression that is 0, for software drivers (docs/integration.md, "What it costs"). */
layout(std140, set = SDFGI_SET, binding = SDFGI_BINDING_FRAME) uniform sdfgi_frame_buffer
{
#ifdef SDFGI_ZERO
    sdfgi_frame_params sdfgi_frames[1];
};
#define sdfgi_frame sdfgi_frames[SDFGI_ZERO]
#else
    sdfgi_frame_params sdfgi_frame;
};
#endif

/* Where loops of lookups start whose rounds are long: software drivers do not copy the rounds one after
 * another then, which takes longer to compile than it saves. In passes, which have it, SDFGI_ZERO does. */
#ifdef SDFGI_ZERO
#define SDFGI_FIRST SDFGI_ZERO
#else
#define SDFGI_FIRST 0u
#endif

/* Occupancy bits: 64 per cell, bit x + 4 y + 16 z per sub-voxel; .x holds z = 0, 1 and .y holds z = 2, 3. An
 * empty cell may hold its empty boxes instead (shared/boxes.h): see sdfgi_subvoxels. */
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

/* Outgoing radiance of light cells times exposure, as RGB9E5: per cascade and axis a value per entry of the
 * light list. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_LIGHT) SDFGI_ACCESS_LIGHT buffer sdfgi_light_buffer
{
    uint sdfgi_light[];
};

/* The state of each probe: where it stands, whether it is dead, and its links. See sdfgi_space.glsl. */
layout(std430, set = SDFGI_SET, binding = SDFGI_BINDING_PROBES) SDFGI_ACCESS_PROBES buffer sdfgi_probes_buffer
{
    uint sdfgi_probes[];
};

/* The irradiance atlas: irradiance over pi times exposure, packed by lib/irradiance_pack.glsl,
 * SDFGI_IRRADIANCE_COUNT texels per probe. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_IRRADIANCE) SDFGI_ACCESS_IRRADIANCE buffer sdfgi_irradiance_buffer
{
    uvec2 sdfgi_irradiance_texels[];
};

/* Per half of a light block (4 x 4 x 2 texels of 4^3) where its light cells are in the light list. x: a bit
 * per light cell, x + 4 y + 16 z. y: the entry of the first; the others follow in the order of their bits. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_LIGHT_BLOCKS) SDFGI_ACCESS_LIGHT_BLOCKS buffer sdfgi_light_blocks_buffer
{
    uvec2 sdfgi_light_blocks[];
};

/* The irradiance that arrives at the surfaces of light cells, over pi and times exposure, as RGB9E5: per
 * cascade and axis a value per entry of the light list. SDFGI_SURFACE_NONE where no surface faces the axis,
 * SDFGI_SURFACE_UNKNOWN where nothing is known yet. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_SURFACES) SDFGI_ACCESS_SURFACES buffer sdfgi_surfaces_buffer
{
    uint sdfgi_surfaces[];
};

/* Emission of albedo blocks. x: RGB9E5 mean radiance of the block, seen from the side on which it emits most,
 * in one of two units. y: 5 bits per axis, the fraction of that radiance which leaves along this axis, and
 * two flags: see sdfgi_emission.glsl. */
layout(std430, set = SDFGI_SET,
       binding = SDFGI_BINDING_EMISSION) SDFGI_ACCESS_EMISSION buffer sdfgi_emission_buffer
{
    uvec2 sdfgi_emission[];
};

#include "sdfgi_texels.glsl"

#endif
