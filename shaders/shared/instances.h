/* SPDX-License-Identifier: MIT
 * Instances as voxelisers read them, and the list of those that a dispatch draws. */
#ifndef SDFGI_SHARED_INSTANCES_H
#define SDFGI_SHARED_INSTANCES_H

#include "types.h"

/* Instances that are listed at once: as many as one vkCmdUpdateBuffer takes. */
#define SDFGI_MAX_DRAWS 16384

/* An element of the list: the slot of an instance, and whether its triangles have been checked. */
#define SDFGI_DRAW_CHECKED 0x80000000u

/* Parts of a sub-voxel of cascade 0 in which an instance's place is stored. In a cascade it is rounded to
 * half as fine a part of that one's sub-voxels, so that far from the world's origin, where doubles are
 * coarser, it comes out the same. Well below the margin of edges. */
#define SDFGI_PLACE_BITS 13

/* Material of an instance: its index, and whether its fronts are clockwise once it is transformed. */
#define SDFGI_INSTANCE_REVERSED 0x80000000u

/* Whatever cascade is made, in sub-voxels of cascade 0. A place is a signed number of 64 bits. */
struct sdfgi_instance_params {
    vec3 row_x; /* rows of the basis: object space to sub-voxels */
    uint place_low_x;
    vec3 row_y;
    uint place_low_y;
    vec3 row_z;
    uint place_low_z;
    ivec3 place_high;
    uint material;
};
SDFGI_ASSERT_SIZE(sdfgi_instance_params, 64);

#endif
