/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "far_stage.h"

#include "far_scene.h"
#include "files.h"
#include "host_test.h"

#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>

int far_place_open(struct host_device **device)
{
    *device = host_test_open();
    if (!*device)
        return HOST_TEST_SKIP;
    return files_setup(NULL) == 0 ? 0 : EXIT_FAILURE;
}

int far_place_close(struct host_device *device, int failed)
{
    failed += files_teardown(NULL) != 0;
    return host_test_close(device, failed);
}

static struct sdfgi_settings settings_of(bool gi)
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.enabled = gi;
    settings.cascades = 2;
    settings.resolution = 32;
    settings.min_cell_size_m = 0.25f;
    settings.ray_count = 125;
    settings.frames_to_converge = 4;
    return settings;
}

void far_stage_open(struct far_stage *stage, struct host_device *device, const double shift[3], bool gi,
                    uint32_t seed)
{
    char error[256];
    const struct sdfgi_settings settings = settings_of(gi);
    const struct host_renderer_desc desc = {
        .width = FAR_WIDTH, .height = FAR_HEIGHT, .settings = &settings, .seed = seed
    };
    const struct host_until_desc until = { .frames = gi ? 8 : 1 };
    stage->view = far_scene_view(shift, stage->lights);
    stage->gltf = gltf_scene_load(far_scene_write(shift), error, sizeof error);
    if (!stage->gltf)
        fail_msg("%s", error);
    stage->scene = host_scene_create(device, stage->gltf, &stage->view);
    stage->renderer = stage->scene ? host_renderer_create(device, stage->scene, &desc) : NULL;
    if (!stage->renderer || !host_render_until(stage->renderer, &stage->view.camera, &until, NULL))
        fail_msg("%s", host_device_error(device));
}

void far_stage_close(struct far_stage *stage)
{
    host_renderer_destroy(stage->renderer);
    host_scene_destroy(stage->scene);
    gltf_scene_destroy(stage->gltf);
}
