/* SPDX-License-Identifier: MIT
 * Recording of the voxelisers: one draw or dispatch per instance. */
#ifndef SDFGI_VOXELIZE_H
#define SDFGI_VOXELIZE_H

#include "pass/pass_record.h"
#include "scene/scene.h"
#include "volume/cascade.h"

#include "shaders/shared/bindings.h"

struct voxelizer {
    struct pass_recorder *rec;
    const struct scene *scene;
    const struct cascades *cascades;
};

/* An item of a pass over DOMAIN_INSTANCES. */
void sdfgi_voxelize_record(const struct voxelizer *voxelizer, const struct work *work);

#endif
