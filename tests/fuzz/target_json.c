/* SPDX-License-Identifier: MIT
 * View files and walk paths. */
#include "fuzz.h"

#include "require.h"
#include "view/view_file.h"
#include "walk/walk_path.h"

#include <math.h>

static void require_finite(const float *values, int count)
{
    for (int i = 0; i < count; i++)
        REQUIRE_TRUE(isfinite(values[i]));
}

static void require_finite_double(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        REQUIRE_TRUE(isfinite(values[i]));
}

static void require_not_negative(const float *values, int count)
{
    require_finite(values, count);
    for (int i = 0; i < count; i++)
        REQUIRE_CMP(values[i], >=, 0.0f);
}

static void require_direction(const float *direction)
{
    require_finite(direction, 3);
    REQUIRE_TRUE(direction[0] != 0 || direction[1] != 0 || direction[2] != 0);
}

static void check_camera(const struct host_camera *camera)
{
    require_finite_double(camera->position, 3);
    require_finite_double(camera->look_at, 3);
    require_direction(camera->up);
    REQUIRE_TRUE(camera->yfov_rad > 0 && (double)camera->yfov_rad < 3.14159265358979);
    REQUIRE_TRUE(camera->ymag_m >= 0 && camera->ymag_m <= 1e9f);
    if (camera->ymag_m > 0)
        REQUIRE_TRUE(camera->znear_m >= 0 && camera->znear_m < camera->zfar_m && camera->zfar_m <= 1e9f);
    REQUIRE_TRUE(memcmp(camera->position, camera->look_at, sizeof camera->position) != 0);
}

static void check_fog(const struct host_fog *fog)
{
    require_finite_double(&fog->height_m, 1);
    require_not_negative((const float[]){ fog->density, fog->height_falloff }, 2);
    require_not_negative(fog->albedo, 3);
    for (int i = 0; i < 3; i++)
        REQUIRE_CMP(fog->albedo[i], <=, 1.0f);
    REQUIRE_CMP(fabsf(fog->anisotropy), <=, 0.9f);
}

static void check_light(const struct host_light *light)
{
    require_finite_double(light->position, 3);
    require_not_negative(light->intensity, 3);
    require_not_negative((const float[]){ light->range_m, light->radius_m }, 2);
    if (light->type == HOST_LIGHT_SPOT) {
        require_direction(light->direction);
        REQUIRE_TRUE(light->inner_rad >= 0 && light->inner_rad < light->outer_rad);
        REQUIRE_CMP(light->outer_rad, <=, 1.5707964f); /* pi / 2 as a float */
    }
}

static bool read_view(const char *path, char *error, size_t error_size)
{
    struct host_view view;
    if (!view_file_load(path, &view, error, error_size))
        return false;
    check_camera(&view.camera);
    require_not_negative(view.sky.zenith, 3);
    require_not_negative(view.sky.horizon, 3);
    require_not_negative(view.sky.ground, 3);
    if (view.sun.enabled)
        require_direction(view.sun.direction);
    require_not_negative(view.sun.irradiance, 3);
    check_fog(&view.fog);
    require_not_negative((const float[]){ view.punctual_scale, view.emissive_scale }, 2);
    require_not_negative(view.default_albedo, 3);
    for (uint32_t i = 0; i < view.light_count; i++)
        check_light(&view.lights[i]);
    view_file_finish(&view);
    return true;
}

static bool read_path(const char *path, char *error, size_t error_size)
{
    struct walk_path walk;
    if (!walk_path_load(path, &walk, error, error_size))
        return false;
    REQUIRE_TRUE(walk.length_m > 0 && isfinite(walk.length_m));
    REQUIRE_TRUE(walk.speed_m_s > 0 && walk.fps > 0 && walk.smooth_m >= 0);
    for (uint32_t i = 1; i < walk.station_count; i++)
        REQUIRE_CMP(walk.stations[i].distance_m, >=, walk.stations[i - 1].distance_m);
    for (int i = -1; i <= 9; i++) {
        struct host_camera camera;
        walk_path_camera(&walk, walk.length_m * i / 8, &camera);
        require_finite_double(camera.position, 3);
        require_finite_double(camera.look_at, 3);
    }
    walk_path_finish(&walk);
    return true;
}

const struct fuzz_target fuzz_view = { ".json", read_view, fuzz_json_mutate, NULL };
const struct fuzz_target fuzz_path = { ".json", read_path, fuzz_json_mutate, NULL };
