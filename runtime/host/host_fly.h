/* SPDX-License-Identifier: MIT
 * A camera that flies: WASD moves, Q and E sink and rise, Shift hurries, a held mouse button turns. W and S
 * zoom an orthographic camera, which going ahead would not change. */
#ifndef HOST_FLY_H
#define HOST_FLY_H

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "host_view.h"

struct host_fly {
    double position[3];
    double yaw, pitch;       /* radians; yaw 0 looks along -Z */
    struct host_camera lens; /* what the camera is like, wherever it is */
    double speed_m_s;
    double cursor[2]; /* when it was last asked for */
};

void host_fly_init(struct host_fly *fly, const struct host_camera *from, double scene_radius);
/* Follows keys and mouse for `seconds`, unless something else has them. */
void host_fly_step(struct host_fly *fly, GLFWwindow *glfw, double seconds, bool has_keys, bool has_mouse);
struct host_camera host_fly_camera(const struct host_fly *fly);

#endif
