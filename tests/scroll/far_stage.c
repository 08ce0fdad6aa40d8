/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "far_stage.h"

#include "far_scene.h"

#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SKIP = 77 };

int far_place_open(struct far_place *place)
{
    char error[256];
    const struct host_device_desc desc = { .select = getenv("SDFGI_TEST_DEVICE") };
    place->device = host_device_create(&desc, error, sizeof error);
    if (!place->device) {
        fprintf(stderr, "skipped: %s\n", error);
        return SKIP;
    }
    strcpy(place->folder, "sdfgi-test-far-XXXXXX");
    if (mkdtemp(place->folder))
        return 0;
    host_device_destroy(place->device);
    return EXIT_FAILURE;
}

int far_place_close(struct far_place *place, int failed)
{
    static const char *const names[] = { "far.gltf", "far.bin" };
    for (int i = 0; i < 2; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/%s", place->folder, names[i]);
        unlink(path);
    }
    failed += rmdir(place->folder) != 0;
    failed += host_device_validation_count(place->device) > 0;
    host_device_destroy(place->device);
    return failed;
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

void far_stage_open(struct far_stage *stage, const struct far_place *place, const double shift[3], bool gi,
                    uint32_t seed)
{
    char path[64], error[256] = "the files cannot be written";
    const struct sdfgi_settings settings = settings_of(gi);
    const struct host_renderer_desc desc = {
        .width = FAR_WIDTH, .height = FAR_HEIGHT, .settings = &settings, .seed = seed
    };
    const struct host_until_desc until = { .frames = gi ? 8 : 1 };
    snprintf(path, sizeof path, "%s/far.gltf", place->folder);
    stage->view = far_scene_view(shift, stage->lights);
    const bool written = far_scene_write(place->folder, shift);
    stage->gltf = written ? gltf_scene_load(path, error, sizeof error) : NULL;
    if (!stage->gltf)
        fail_msg("%s", error);
    stage->scene = host_scene_create(place->device, stage->gltf, &stage->view);
    stage->renderer = stage->scene ? host_renderer_create(place->device, stage->scene, &desc) : NULL;
    if (!stage->renderer || !host_render_until(stage->renderer, &stage->view.camera, &until, NULL))
        fail_msg("%s", host_device_error(place->device));
}

void far_stage_close(struct far_stage *stage)
{
    host_renderer_destroy(stage->renderer);
    host_scene_destroy(stage->scene);
    gltf_scene_destroy(stage->gltf);
}
