/* SPDX-License-Identifier: MIT
 * Defaults of a view, and cameras resolved for a frame. */
#include "host_internal.h"
#include "host_math.h"

#include <string.h>

void host_view_default(struct host_view *view)
{
    *view = (struct host_view){
        .camera = { .position = { 0, 0, 5 }, .up = { 0, 1, 0 }, .yfov_rad = 1.0471976f },
        .punctual_scale = 1.0f,
        .emissive_scale = 1.0f,
        .materials = HOST_MATERIALS_GLTF,
        .default_albedo = { 0.8f, 0.8f, 0.8f },
    };
}

/* Right and up from the view direction; any up will do where the given one is parallel to it. */
static void resolve_axes(const struct host_camera *camera, struct host_camera_frame *out)
{
    double up[3];
    for (int i = 0; i < 3; i++) {
        out->forward[i] = camera->look_at[i] - camera->position[i];
        up[i] = (double)camera->up[i];
    }
    if (host_normalize3(out->forward) == 0.0)
        out->forward[2] = -1.0;
    host_normalize3(up);
    host_cross3(out->forward, up, out->right);
    if (host_normalize3(out->right) < 1e-6) {
        double unused[3];
        host_frame3(out->forward, out->right, unused);
    }
    host_cross3(out->right, out->forward, out->up);
}

/* Vulkan's y points down. Depth is reversed. In perspective it has no far plane: z = near, w = distance along
 * the axis; orthographic it falls evenly: z = 1 - distance from the near plane / range, w = 1. */
static void fill_clip(struct host_camera_frame *out)
{
    const bool flat = out->orthographic;
    const double *const axes[4] = { out->right, out->up, out->forward, out->forward };
    const double scale[4] = { 1.0 / out->half_x, -1.0 / out->half_y, flat ? -1.0 / out->range_m : 0.0,
                              flat ? 0.0 : 1.0 };
    const double constant[4] = { 0.0, 0.0, flat ? 1.0 : out->near_m, flat ? 1.0 : 0.0 };
    double relative[3];
    for (int i = 0; i < 3; i++)
        relative[i] = out->position[i] - out->origin[i];
    for (int row = 0; row < 4; row++) {
        for (int i = 0; i < 3; i++)
            out->clip[row][i] = (float)(scale[row] * axes[row][i]);
        out->clip[row][3] = (float)(constant[row] - scale[row] * host_dot3(axes[row], relative));
    }
}

void host_camera_resolve(const struct host_camera *camera, double aspect, struct host_camera_frame *out)
{
    *out = (struct host_camera_frame){ .near_m = 0.01, .orthographic = camera->ymag_m > 0.0f };
    resolve_axes(camera, out);
    out->half_y = tan(0.5 * (double)camera->yfov_rad);
    if (out->orthographic) {
        out->half_y = (double)camera->ymag_m;
        out->near_m = (double)camera->znear_m;
        out->range_m = (double)camera->zfar_m - out->near_m;
    }
    out->half_x = out->half_y * aspect;
    for (int i = 0; i < 3; i++) {
        out->position[i] = camera->position[i] + (out->orthographic ? out->near_m * out->forward[i] : 0.0);
        out->origin[i] = floor(out->position[i] + 0.5);
    }
    fill_clip(out);
}

void host_camera_move_aside(struct host_camera_frame *camera, double distance_m)
{
    for (int i = 0; i < 3; i++)
        camera->position[i] += distance_m * camera->right[i];
    fill_clip(camera);
}

void host_camera_center(const struct host_camera_frame *camera, const double scene_center[3], double out[3])
{
    double offset[3], along = 0.0;
    for (int i = 0; i < 3; i++)
        offset[i] = scene_center[i] - camera->position[i];
    if (camera->orthographic)
        along = fmin(fmax(host_dot3(offset, camera->forward), 0.0), camera->range_m);
    for (int i = 0; i < 3; i++)
        out[i] = camera->position[i] + along * camera->forward[i];
}

/* Columns. In perspective a clip position (x, y, z, 1) becomes
 * (z camera + near (x right half_x - y up half_y + forward), z), orthographic
 * (camera + x right half_x - y up half_y + (1 - z) range forward, 1). */
void host_camera_fill_inverse(const struct host_camera_frame *camera, float m[static 16])
{
    const bool flat = camera->orthographic;
    const double aside = flat ? 1.0 : camera->near_m;
    memset(m, 0, 16 * sizeof(*m));
    for (int i = 0; i < 3; i++) {
        const double relative = camera->position[i] - camera->origin[i];
        m[i] = (float)(aside * camera->half_x * camera->right[i]);
        m[4 + i] = (float)(-aside * camera->half_y * camera->up[i]);
        m[8 + i] = (float)(flat ? -camera->range_m * camera->forward[i] : relative);
        m[12 + i] = (float)(flat ? relative + camera->range_m * camera->forward[i]
                                 : camera->near_m * camera->forward[i]);
    }
    m[flat ? 15 : 11] = 1.0f;
}
