/* SPDX-License-Identifier: MIT */
#include "camera.h"

static void normalize(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static struct vec3 scaled(const double v[3], double s)
{
    return vec3_make((float)(v[0] * s), (float)(v[1] * s), (float)(v[2] * s));
}

/* A whole number of metres near the camera: single precision is finest where the picture is, and a scene
 * moved by whole metres gives the same bits. */
static void origin_near(const double position[3], double origin[3])
{
    for (int k = 0; k < 3; k++)
        origin[k] = round(position[k]);
}

void raycast_camera_init(struct camera *c, const struct raycast_camera *view, uint32_t width, uint32_t height)
{
    double forward[3], right[3], up[3];
    const double view_up[3] = { view->up[0], view->up[1], view->up[2] };
    for (int k = 0; k < 3; k++)
        forward[k] = view->look_at[k] - view->position[k];
    normalize(forward);
    cross(forward, view_up, right);
    normalize(right);
    cross(right, forward, up);
    c->orthographic = view->ymag_m > 0.0f;
    c->near_m = c->orthographic ? view->znear_m : 0.0f;
    c->length_m = c->orthographic ? view->zfar_m - view->znear_m : INFINITY;
    double position[3];
    for (int k = 0; k < 3; k++)
        position[k] = view->position[k] + (double)c->near_m * forward[k];
    origin_near(position, c->origin);
    c->position = vec3_make((float)(position[0] - c->origin[0]), (float)(position[1] - c->origin[1]),
                            (float)(position[2] - c->origin[2]));
    const double half_height =
        c->orthographic ? (double)view->ymag_m : tan(0.5 * view->yfov_deg * (3.14159265358979323846 / 180.0));
    c->forward = scaled(forward, 1.0);
    c->right = scaled(right, half_height * width / height);
    c->up = scaled(up, half_height);
}
