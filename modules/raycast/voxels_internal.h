/* SPDX-License-Identifier: MIT
 *
 * Shared by the files that make up the voxel geometry.
 */
#ifndef RAYCAST_VOXELS_INTERNAL_H
#define RAYCAST_VOXELS_INTERNAL_H

#include "voxel_grid.h"
#include "voxels.h"

/* All faces of a block that look along one axis. */
struct voxel_emitter {
    struct voxel_place first; /* cell of the block */
    int axis;
    uint32_t faces;
};

struct voxels {
    struct geometry base;
    struct voxel_grid grid;
    const struct geometry *seen;
    struct voxel_emitter *emitters;
    double *emitter_cdf; /* running share of the total, up to 1 */
    uint32_t emitter_count;
    double emitter_total; /* sum of luminance times area */
};

static inline struct vec3 voxel_axis(int axis)
{
    const float sign = axis & 1 ? -1.0f : 1.0f;
    return vec3_make(axis >> 1 == 0 ? sign : 0.0f, axis >> 1 == 1 ? sign : 0.0f,
                     axis >> 1 == 2 ? sign : 0.0f);
}

/* Radiance that a block emits along an axis. */
static inline struct vec3 voxel_emission(const struct raycast_block *b, int axis)
{
    return vec3_scale(vec3_load(b->emission), (float)b->emitting[axis] / 31.0f);
}

/* Where rays that leave a face start. */
struct vec3 voxel_start(const struct voxels *v, const struct voxel_hit *hit, struct vec3 normal,
                        struct vec3 position);

/* The same for a point that the camera sees. */
void voxel_adopt(const struct geometry *g, struct surface *s);

bool voxel_emitters_build(struct voxels *v);
void voxel_emitters_sample(const struct geometry *g, struct random *r, struct emitter_sample *out);

#endif
