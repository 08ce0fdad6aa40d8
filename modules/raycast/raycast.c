/* SPDX-License-Identifier: MIT */
#include "internal.h"

#include <stdio.h>
#include <stdlib.h>

#include "parallel.h"
#include "triangles.h"
#include "voxels.h"

static struct raycast_settings settings_resolve(const struct raycast_settings *in)
{
    struct raycast_settings s = *in;
    s.width = s.width != 0 ? s.width : 320;
    s.height = s.height != 0 ? s.height : 180;
    s.max_bounces = s.max_bounces != 0 ? s.max_bounces : 64;
    s.threads = s.threads != 0 ? s.threads : raycast_parallel_processor_count();
    s.aovs |= 1u << RAYCAST_AOV_RADIANCE | 1u << RAYCAST_AOV_VARIANCE;
    return s;
}

static bool build_geometry(struct raycast *rc, const struct gltf_scene *scene,
                           const struct raycast_view *view, char *error, size_t error_size)
{
    struct integrator *it = &rc->integrator;
    struct triangles_desc desc = { .scene = scene,
                                   .view = view,
                                   .cull_back_faces = rc->settings.cull_back_faces };
    for (int k = 0; k < 3; k++)
        desc.origin[k] = rc->camera.origin[k];
    it->seen = triangles_create(&desc, error, error_size);
    it->geometry = it->seen;
    if (it->seen != NULL && rc->settings.voxels != NULL)
        it->geometry = voxels_create(rc->settings.voxels, rc->camera.origin, it->seen, error, error_size);
    return it->geometry != NULL;
}

static bool build(struct raycast *rc, const struct gltf_scene *scene, const struct raycast_view *view,
                  char *error, size_t error_size)
{
    const struct raycast_settings *s = &rc->settings;
    raycast_camera_init(&rc->camera, &view->camera, s->width, s->height);
    rc->integrator.max_bounces = s->max_bounces;
    /* A mirror's irradiance needs rays that its reflection has no use for. */
    rc->integrator.min_diffuse_share = s->aovs & 1u << RAYCAST_AOV_IRRADIANCE ? 0.25f : 0.0f;
    if (view->materials == RAYCAST_MATERIALS_GLTF)
        lobe_init(&rc->integrator.lobe);
    if (!raycast_film_init(&rc->film, s->width, s->height, s->aovs)) {
        snprintf(error, error_size, "reference: out of memory for a picture of %ux%u", s->width, s->height);
        return false;
    }
    if (!raycast_lights_init(&rc->integrator.lights, scene, view, rc->camera.origin)) {
        snprintf(error, error_size, "reference: out of memory for the lights");
        return false;
    }
    if (!build_geometry(rc, scene, view, error, error_size))
        return false;
    integrator_start(&rc->integrator);
    return true;
}

struct raycast *raycast_create(const struct gltf_scene *scene, const struct raycast_view *view,
                               const struct raycast_settings *settings, char *error, size_t error_size)
{
    if (!raycast_view_check(view, error, error_size) || !raycast_settings_check(settings, error, error_size))
        return NULL;
    struct raycast *rc = calloc(1, sizeof(*rc));
    if (rc == NULL) {
        snprintf(error, error_size, "reference: out of memory");
        return NULL;
    }
    rc->settings = settings_resolve(settings);
    if (!build(rc, scene, view, error, error_size)) {
        raycast_destroy(rc);
        return NULL;
    }
    rc->identity = raycast_hash_inputs(scene, view, &rc->settings);
    return rc;
}

void raycast_destroy(struct raycast *rc)
{
    if (rc == NULL)
        return;
    struct geometry *seen = rc->integrator.seen, *geometry = rc->integrator.geometry;
    if (geometry != NULL && geometry != seen)
        geometry->methods->destroy(geometry);
    if (seen != NULL)
        seen->methods->destroy(seen);
    raycast_lights_finish(&rc->integrator.lights);
    raycast_film_finish(&rc->film);
    free(rc);
}

const struct raycast_settings *raycast_settings_get(const struct raycast *rc)
{
    return &rc->settings;
}

bool raycast_image(const struct raycast *rc, enum raycast_aov aov, float *out)
{
    return film_image(&rc->film, aov, out);
}
