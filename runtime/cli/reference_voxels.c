/* SPDX-License-Identifier: MIT */
#include "reference_voxels.h"

#include "cli.h"
#include "run_options.h"

#include <stdlib.h>
#include <string.h>

/* The size of a picture that is never drawn. */
enum { UNUSED_PIXELS = 16 };

static struct raycast_block block_convert(const struct sdfgi_inspect_surface *from)
{
    struct raycast_block to;
    memcpy(to.emission, from->emission, sizeof to.emission);
    memcpy(to.albedo, from->albedo, sizeof to.albedo);
    memcpy(to.emitting, from->emitting, sizeof to.emitting);
    memcpy(to.slopes, from->slopes, sizeof to.slopes);
    for (int k = 0; k < 3; k++)
        if (!from->has_normal[k])
            to.slopes[k][0] = RAYCAST_NO_SLOPE;
    return to;
}

static bool convert(struct reference_voxels *out)
{
    out->voxels.cascade_count = out->volumes.count;
    for (uint32_t c = 0; c < out->volumes.count; c++) {
        const struct host_volume *const from = &out->volumes.cascades[c];
        const size_t n = from->where.resolution, count = n * n * n / 8;
        struct raycast_cascade *const to = &out->voxels.cascades[c];
        out->blocks[c] = malloc(count * sizeof *out->blocks[c]);
        if (!out->blocks[c])
            return false;
        for (size_t i = 0; i < count; i++)
            out->blocks[c][i] = block_convert(&from->blocks[i]);
        memcpy(to->low_m, from->where.origin_m, sizeof to->low_m);
        memcpy(to->cell_m, from->where.cell_m, sizeof to->cell_m);
        to->resolution = from->where.resolution;
        to->bits = from->bits;
        to->blocks = out->blocks[c];
    }
    return true;
}

/* What shapes volumes is kept; light is of no use here, and gets as little work as can be. */
static struct sdfgi_settings volumes_alone(const struct sdfgi_settings *settings)
{
    struct sdfgi_settings s = *settings;
    s.enabled = true;
    s.use_occlusion = false;
    s.ray_count = 1;
    return s;
}

static bool read_volumes(struct host_device *device, const struct gltf_scene *gltf,
                         const struct host_view *view, const struct sdfgi_settings *settings,
                         struct host_volumes *out)
{
    const struct sdfgi_settings s = volumes_alone(settings);
    const struct host_renderer_desc desc = {
        .width = UNUSED_PIXELS, .height = UNUSED_PIXELS, .settings = &s, .log = { run_log, NULL }
    };
    struct host_scene *const scene = host_scene_create(device, gltf, view);
    struct host_renderer *const renderer = scene ? host_renderer_create(device, scene, &desc) : NULL;
    const bool ok = renderer && host_renderer_read_volumes(renderer, &view->camera, out);
    if (!ok)
        cli_error("%s", host_device_error(device));
    host_renderer_destroy(renderer);
    host_scene_destroy(scene);
    return ok;
}

bool reference_voxels_read(const struct gltf_scene *gltf, const struct host_view *view,
                           const struct sdfgi_settings *settings, const char *device,
                           struct reference_voxels *out)
{
    struct host_device *const opened = run_open_device(device);
    if (!opened)
        return false;
    bool ok = read_volumes(opened, gltf, view, settings, &out->volumes);
    host_device_destroy(opened);
    if (ok && !convert(out)) {
        cli_error("reference: out of memory");
        ok = false;
    }
    return ok;
}

void reference_voxels_finish(struct reference_voxels *voxels)
{
    host_volumes_finish(&voxels->volumes);
    for (int c = 0; c < RAYCAST_MAX_CASCADES; c++)
        free(voxels->blocks[c]);
    *voxels = (struct reference_voxels){ 0 };
}
