/* SPDX-License-Identifier: MIT
 * Recording of the voxelisers: a draw or a dispatch for instances of a mesh. */
#ifndef SDFGI_VOXELIZE_H
#define SDFGI_VOXELIZE_H

#include "draw_list.h"
#include "pass/pass_record.h"
#include "scene/scene.h"
#include "volume/cascade.h"

#include "shaders/shared/bindings.h"

struct voxelizer {
    struct pass_recorder *rec;
    const struct scene *scene;
    const struct cascades *cascades;
    struct draw_list *draws;
};

/* An item of a pass over DOMAIN_INSTANCES. */
void sdfgi_voxelize_record(const struct voxelizer *voxelizer, const struct work *work);

#endif
