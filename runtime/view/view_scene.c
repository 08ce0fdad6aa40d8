/* SPDX-License-Identifier: MIT
 * A view for a scene that comes without a VIEW.json. */
#include "view_file.h"

#include <base/vec.h>
#include <modules/gltf/gltf_scene.h>

static void use_camera(const struct gltf_camera *from, struct host_camera *camera)
{
    const double *m = from->transform;
    double forward[3] = { -m[8], -m[9], -m[10] };
    if (!base_vec3d_normalize(forward))
        return;
    for (int i = 0; i < 3; i++) {
        camera->position[i] = m[12 + i];
        camera->look_at[i] = m[12 + i] + forward[i];
        camera->up[i] = (float)m[4 + i];
    }
    if (from->yfov_rad > 0)
        camera->yfov_rad = from->yfov_rad;
    camera->ymag_m = from->ymag;
    camera->znear_m = from->znear;
    camera->zfar_m = from->zfar;
}

/* Stands where the sphere around the scene just fits the field of view. */
static void frame_bounds(const struct gltf_scene *scene, struct host_camera *camera)
{
    double direction[3] = { 1, 0.7, 1.3 }, size[3];
    base_vec3d_normalize(direction);
    base_vec3d_sub(scene->bounds_max, scene->bounds_min, size);
    double radius_m = base_vec3d_length(size) / 2;
    if (!(radius_m > 0) || !isfinite(radius_m))
        radius_m = 1;
    for (int i = 0; i < 3; i++) {
        camera->look_at[i] = (scene->bounds_min[i] + scene->bounds_max[i]) / 2;
        camera->position[i] = camera->look_at[i] + direction[i] * radius_m / sin(camera->yfov_rad / 2.0);
    }
}

static bool has_light(const struct gltf_scene *scene)
{
    bool found = scene->light_count > 0;
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int c = 0; c < 3; c++)
            found |= scene->materials[i].emissive[c] > 0;
    return found;
}

/* An overcast afternoon, in units where white paper is about 1. */
static void add_daylight(struct host_view *view)
{
    view->sky = (struct host_sky){ { 0.35f, 0.5f, 0.8f }, { 0.6f, 0.65f, 0.7f }, { 0.2f, 0.18f, 0.15f } };
    view->sun = (struct host_sun){ true, { -0.5f, -1, -0.35f }, { 3, 2.8f, 2.5f }, 0 };
}

void view_file_from_scene(const struct gltf_scene *scene, struct host_view *view)
{
    host_view_default(view);
    if (scene->camera_count > 0)
        use_camera(&scene->cameras[0], &view->camera);
    else
        frame_bounds(scene, &view->camera);
    if (!has_light(scene))
        add_daylight(view);
}
