/* SPDX-License-Identifier: MIT
 *
 * Geometry made of a voxel renderer's volumes: what its rays hit, with the albedo, emission and normals that
 * it would find there.
 *
 * A hit is a face of a set sub-voxel. Albedo, emission and normal are those of its block of 2x2x2 cells;
 * emission is read for the axis of the face, and light is reflected as by a Lambertian surface with the
 * block's mean normal towards that axis, for a staircase of voxels stands for the slope it was made from.
 *
 * Where rays start: light arrives not in the face but one reach above it, along the normal. The reach is the
 * height to which the voxels of a plane can stand out of it, so that a slope's own steps do not shade it.
 * Half of the way is taken where something set lies before that. From a triangle (voxels_create: `seen`) the
 * same distance is kept from every triangle near by, on the side of the triangle that was seen: then the
 * start is outside of the voxels of all of them, and on the right side of the thinnest wall. A ray that
 * starts in a set sub-voxel all the same leaves those that follow on from it without a gap before it can hit
 * any, and meets triangles on that way.
 */
#ifndef RAYCAST_VOXELS_H
#define RAYCAST_VOXELS_H

#include <stddef.h>

#include "geometry.h"

struct raycast_voxels;

/* `seen` is what the camera sees, in the same space, and outlives the result, as do the volumes. NULL on
 * failure, with one line in `error`. */
struct geometry *voxels_create(const struct raycast_voxels *volumes, const double origin[3],
                               const struct geometry *seen, char *error, size_t error_size);

#endif
