/* SPDX-License-Identifier: MIT */
#include "host_fly.h"

#include "host_math.h"

#include <string.h>

static void fly_forward(const struct host_fly *fly, double out[3])
{
    out[0] = sin(fly->yaw) * cos(fly->pitch);
    out[1] = sin(fly->pitch);
    out[2] = -cos(fly->yaw) * cos(fly->pitch);
}

/* Upwards in the picture. */
static void fly_up(const struct host_fly *fly, float out[3])
{
    out[0] = (float)(-sin(fly->yaw) * sin(fly->pitch));
    out[1] = (float)cos(fly->pitch);
    out[2] = (float)(cos(fly->yaw) * sin(fly->pitch));
}

/* Where a camera heads that looks straight up or down, its picture's upper side tells. */
static double yaw_of(const double forward[3], const float up[3])
{
    if (hypot(forward[0], forward[2]) > 1e-6)
        return atan2(forward[0], -forward[2]);
    const double sign = forward[1] < 0.0 ? 1.0 : -1.0;
    return atan2(sign * (double)up[0], -sign * (double)up[2]);
}

void host_fly_init(struct host_fly *fly, const struct host_camera *from, double scene_radius)
{
    double forward[3];
    for (int i = 0; i < 3; i++) {
        fly->position[i] = from->position[i];
        forward[i] = from->look_at[i] - from->position[i];
    }
    host_normalize3(forward);
    fly->yaw = yaw_of(forward, from->up);
    fly->pitch = asin(fmin(fmax(forward[1], -1.0), 1.0));
    fly->lens = *from;
    fly->speed_m_s = fmin(fmax(scene_radius * 0.2, 0.5), 10.0);
}

static double key_axis(GLFWwindow *glfw, int more, int less)
{
    return (glfwGetKey(glfw, more) == GLFW_PRESS) - (glfwGetKey(glfw, less) == GLFW_PRESS);
}

static void turn(struct host_fly *fly, GLFWwindow *glfw, bool has_mouse)
{
    double cursor[2];
    glfwGetCursorPos(glfw, &cursor[0], &cursor[1]);
    const bool held = glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                      glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    if (held && has_mouse) {
        fly->yaw += 0.003 * (cursor[0] - fly->cursor[0]);
        fly->pitch -= 0.003 * (cursor[1] - fly->cursor[1]);
        fly->pitch = fmin(fmax(fly->pitch, -1.55), 1.55);
    }
    memcpy(fly->cursor, cursor, sizeof(cursor));
}

static void move(struct host_fly *fly, GLFWwindow *glfw, double seconds)
{
    const bool hurry = glfwGetKey(glfw, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS;
    const double step_m = fly->speed_m_s * (hurry ? 5.0 : 1.0) * seconds;
    double ahead = key_axis(glfw, GLFW_KEY_W, GLFW_KEY_S);
    const double aside = key_axis(glfw, GLFW_KEY_D, GLFW_KEY_A);
    const double above = key_axis(glfw, GLFW_KEY_E, GLFW_KEY_Q);
    double forward[3];
    if (fly->lens.ymag_m > 0.0f) {
        const double larger = exp(-ahead * seconds * (hurry ? 5.0 : 1.0));
        fly->lens.ymag_m = (float)fmin(fmax((double)fly->lens.ymag_m * larger, 1e-3), 1e6);
        ahead = 0.0;
    }
    fly_forward(fly, forward);
    fly->position[0] += step_m * (ahead * forward[0] + aside * cos(fly->yaw));
    fly->position[1] += step_m * (ahead * forward[1] + above);
    fly->position[2] += step_m * (ahead * forward[2] + aside * sin(fly->yaw));
}

void host_fly_step(struct host_fly *fly, GLFWwindow *glfw, double seconds, bool has_keys, bool has_mouse)
{
    turn(fly, glfw, has_mouse);
    if (has_keys)
        move(fly, glfw, seconds);
}

struct host_camera host_fly_camera(const struct host_fly *fly)
{
    struct host_camera out = fly->lens;
    double forward[3];
    fly_forward(fly, forward);
    fly_up(fly, out.up);
    for (int i = 0; i < 3; i++) {
        out.position[i] = fly->position[i];
        out.look_at[i] = fly->position[i] + forward[i];
    }
    return out;
}
