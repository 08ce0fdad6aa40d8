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

/* Reversed depth without a far plane: z = near, w = distance along the axis. Vulkan's y points down. */
static void fill_clip(struct host_camera_frame *out)
{
    const double *const axes[4] = { out->right, out->up, NULL, out->forward };
    const double scale[4] = { 1.0 / out->tan_x, -1.0 / out->tan_y, 0.0, 1.0 };
    double relative[3];
    for (int i = 0; i < 3; i++)
        relative[i] = out->position[i] - out->origin[i];
    for (int row = 0; row < 4; row++) {
        memset(out->clip[row], 0, sizeof(out->clip[row]));
        for (int i = 0; i < 3 && axes[row]; i++)
            out->clip[row][i] = (float)(scale[row] * axes[row][i]);
        if (axes[row])
            out->clip[row][3] = (float)(-scale[row] * host_dot3(axes[row], relative));
    }
    out->clip[2][3] = (float)out->near_m;
}

void host_camera_resolve(const struct host_camera *camera, double aspect, struct host_camera_frame *out)
{
    *out = (struct host_camera_frame){ .near_m = 0.01 };
    for (int i = 0; i < 3; i++) {
        out->position[i] = camera->position[i];
        out->origin[i] = floor(camera->position[i] + 0.5);
    }
    resolve_axes(camera, out);
    out->tan_y = tan(0.5 * (double)camera->yfov_rad);
    out->tan_x = out->tan_y * aspect;
    fill_clip(out);
}

/* Columns. A clip position (x, y, z, 1) becomes (z camera + near (x right tan_x - y up tan_y + forward), z).
 */
void host_camera_fill_inverse(const struct host_camera_frame *camera, float m[static 16])
{
    for (int i = 0; i < 3; i++) {
        m[i] = (float)(camera->near_m * camera->tan_x * camera->right[i]);
        m[4 + i] = (float)(-camera->near_m * camera->tan_y * camera->up[i]);
        m[8 + i] = (float)(camera->position[i] - camera->origin[i]);
        m[12 + i] = (float)(camera->near_m * camera->forward[i]);
    }
    m[11] = 1.0f;
}
