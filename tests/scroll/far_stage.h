/* SPDX-License-Identifier: MIT
 * The far scene on a device, with a picture and, if wanted, eight frames of GI. Failures end the test. */
#ifndef TEST_FAR_STAGE_H
#define TEST_FAR_STAGE_H

#include "host.h"

struct gltf_scene;

enum { FAR_WIDTH = 160, FAR_HEIGHT = 90, FAR_PIXELS = FAR_WIDTH * FAR_HEIGHT };

struct far_stage {
    struct host_light lights[2];
    struct host_view view;
    struct gltf_scene *gltf;
    struct host_scene *scene;
    struct host_renderer *renderer;
};

/* All tests of a program share one device and the folder of files.h. Returns 0, or the exit code with which
 * to leave. */
int far_place_open(struct host_device **device);
/* Adds messages of the validation layer to `failed`, and returns it. */
int far_place_close(struct host_device *device, int failed);

/* Cells of 1/4 m, the coarsest of 1/2 m: a shift by a power of two metres is a whole number of probes, so
 * that the cascades lie alike. */
void far_stage_open(struct far_stage *stage, struct host_device *device, const double shift[3], bool gi,
                    uint32_t seed);
void far_stage_close(struct far_stage *stage);

#endif
