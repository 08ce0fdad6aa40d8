/* SPDX-License-Identifier: MIT
 * A view for a scene that comes without a VIEW.json. */
#include "view_file.h"

#include "view_frame.h"
#include "view_glow.h"

#include <base/vec.h>
#include <modules/gltf/gltf_scene.h>

/* What glows lights a scene by itself from here on: mean irradiance in W/m^2, where white paper in daylight
 * has about 3. */
static const double enough_glow = 0.05;

void view_camera_from_file(const struct gltf_camera *from, struct host_camera *camera)
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

/* An overcast afternoon, in units where white paper is about 1. */
const struct host_sky view_day_sky = { { 0.35f, 0.5f, 0.8f }, { 0.6f, 0.65f, 0.7f }, { 0.2f, 0.18f, 0.15f } };
const struct host_sun view_day_sun = { true, { -0.5f, -0.9f, -0.7f }, { 3, 2.8f, 2.5f }, 0 };

void view_light_from_scene(const struct gltf_scene *scene, struct host_view *view)
{
    if (scene->light_count > 0 || view_glow_irradiance(scene) >= enough_glow)
        return;
    view->sky = view_day_sky;
    view->sun = view_day_sun;
}

void view_file_from_scene(const struct gltf_scene *scene, double aspect, struct host_view *view)
{
    host_view_default(view);
    if (scene->camera_count > 0)
        view_camera_from_file(&scene->cameras[0], &view->camera);
    else
        view_frame_scene(scene, aspect, &view->camera);
    view_light_from_scene(scene, view);
}
