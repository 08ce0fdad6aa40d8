/* SPDX-License-Identifier: MIT
 *
 * Refuses views and settings that have no picture.
 */
#include <stdarg.h>
#include <stdio.h>

#include "internal.h"

#define MAX_SIZE_PIXELS 16384
#define MAX_MAP_SIDE    32768
#define MAX_BOUNCES     65536
#define MAX_THREADS     256

bool raycast_fail(char *error, size_t error_size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, error_size, format, arguments);
    va_end(arguments);
    return false;
}

static bool are_finite_f(const float *v, int count)
{
    for (int k = 0; k < count; k++) {
        if (!isfinite(v[k]))
            return false;
    }
    return true;
}

static bool are_finite_d(const double *v, int count)
{
    for (int k = 0; k < count; k++) {
        if (!isfinite(v[k]))
            return false;
    }
    return true;
}

/* Finite and not negative: light and albedo. */
static bool are_amounts(const float *v, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        if (!isfinite(v[k]) || v[k] < 0.0f)
            return false;
    }
    return true;
}

static bool has_length(const float v[3])
{
    return are_finite_f(v, 3) && (v[0] != 0.0f || v[1] != 0.0f || v[2] != 0.0f);
}

static bool camera_check(const struct raycast_camera *c, char *error, size_t size)
{
    if (!are_finite_d(c->position, 3) || !are_finite_d(c->look_at, 3))
        return raycast_fail(error, size, "camera: position and look_at must be finite");
    if (!has_length(c->up))
        return raycast_fail(error, size, "camera.up: must be a direction");
    if (!are_amounts(&c->ymag_m, 1))
        return raycast_fail(error, size, "camera.ymag: must be finite and not negative");
    if (c->ymag_m > 0.0f && !(c->znear_m >= 0.0f && c->zfar_m > c->znear_m && isfinite(c->zfar_m)))
        return raycast_fail(error, size, "camera: needs 0 <= znear < zfar");
    if (c->ymag_m == 0.0f && !(c->yfov_deg > 0.0f && c->yfov_deg < 180.0f))
        return raycast_fail(error, size, "camera.yfov_deg: %g is not between 0 and 180", (double)c->yfov_deg);
    double f[3], sine2 = 0.0, length2 = 0.0, up2 = 0.0;
    for (int k = 0; k < 3; k++)
        f[k] = c->look_at[k] - c->position[k];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double cross = f[i] * c->up[j] - f[j] * c->up[i];
        sine2 += cross * cross;
        length2 += f[k] * f[k];
        up2 += (double)c->up[k] * c->up[k];
    }
    if (!(length2 > 0.0))
        return raycast_fail(error, size, "camera.look_at: is the camera's position");
    if (!(sine2 > 1e-12 * length2 * up2))
        return raycast_fail(error, size, "camera.up: is parallel to the viewing direction");
    return true;
}

static bool light_check(const struct raycast_light *l, uint32_t index, char *error, size_t size)
{
    if (!are_finite_d(l->position, 3))
        return raycast_fail(error, size, "lights[%u].position: must be finite", index);
    if (!are_amounts(l->intensity, 3))
        return raycast_fail(error, size, "lights[%u].intensity: must be finite and not negative", index);
    if (!are_amounts(&l->radius_m, 1))
        return raycast_fail(error, size, "lights[%u].radius: must be finite and not negative", index);
    if (!are_amounts(&l->range_m, 1))
        return raycast_fail(error, size, "lights[%u].range: must be finite and not negative", index);
    if (l->type != RAYCAST_LIGHT_SPOT)
        return true;
    if (!has_length(l->direction))
        return raycast_fail(error, size, "lights[%u].direction: must be a direction", index);
    if (!(l->inner_deg >= 0.0f && l->inner_deg < l->outer_deg && l->outer_deg <= 90.0f))
        return raycast_fail(error, size, "lights[%u]: needs 0 <= inner_deg < outer_deg <= 90", index);
    return true;
}

static bool sun_check(const struct raycast_sun *s, char *error, size_t size)
{
    if (!are_amounts(s->irradiance, 3))
        return raycast_fail(error, size, "sun.irradiance: must be finite and not negative");
    if (!(s->angle_deg >= 0.0f && s->angle_deg <= 90.0f))
        return raycast_fail(error, size, "sun.angle_deg: %g is not between 0 and 90", (double)s->angle_deg);
    const bool is_on = s->irradiance[0] > 0.0f || s->irradiance[1] > 0.0f || s->irradiance[2] > 0.0f;
    if (is_on && !has_length(s->direction))
        return raycast_fail(error, size, "sun.direction: must be a direction");
    return true;
}

bool raycast_view_check(const struct raycast_view *view, char *error, size_t size)
{
    if (!camera_check(&view->camera, error, size) || !sun_check(&view->sun, error, size))
        return false;
    if (!are_amounts(view->sky.zenith, 3) || !are_amounts(view->sky.horizon, 3) ||
        !are_amounts(view->sky.ground, 3))
        return raycast_fail(error, size, "sky: radiance must be finite and not negative");
    const struct raycast_environment *const map = &view->environment;
    if (map->rgb &&
        (map->width < 1 || map->height < 1 || map->width > MAX_MAP_SIDE || map->height > MAX_MAP_SIDE))
        return raycast_fail(error, size, "environment: %ux%u texels, the limits are 1 and %d", map->width,
                            map->height, MAX_MAP_SIDE);
    if (map->rgb && !are_amounts(map->rgb, 3 * (size_t)map->width * map->height))
        return raycast_fail(error, size, "environment: radiance must be finite and not negative");
    for (uint32_t i = 0; i < view->light_count; i++) {
        if (!light_check(&view->lights[i], i, error, size))
            return false;
    }
    if (!are_amounts(&view->punctual_scale, 1))
        return raycast_fail(error, size, "punctual_scale: must be finite and not negative");
    if (!are_amounts(&view->emissive_scale, 1))
        return raycast_fail(error, size, "emissive_scale: must be finite and not negative");
    if (!are_amounts(view->default_albedo, 3))
        return raycast_fail(error, size, "default_albedo: must be finite and not negative");
    return true;
}

bool raycast_settings_check(const struct raycast_settings *s, char *error, size_t size)
{
    if (s->width > MAX_SIZE_PIXELS || s->height > MAX_SIZE_PIXELS)
        return raycast_fail(error, size, "size: %ux%u is beyond the limit of %u pixels a side", s->width,
                            s->height, MAX_SIZE_PIXELS);
    if (s->max_bounces > MAX_BOUNCES)
        return raycast_fail(error, size, "bounces: %u is beyond the limit of %u", s->max_bounces,
                            MAX_BOUNCES);
    if (s->threads > MAX_THREADS)
        return raycast_fail(error, size, "threads: %u is beyond the limit of %u", s->threads, MAX_THREADS);
    if (s->aovs >= 1u << RAYCAST_AOV_COUNT)
        return raycast_fail(error, size, "aovs: unknown bits in 0x%x", s->aovs);
    return true;
}
