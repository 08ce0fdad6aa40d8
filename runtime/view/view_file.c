/* SPDX-License-Identifier: MIT */
#include "view_file.h"

#include "file/json_read.h"
#include "view_option.h"

#include <base/vec.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Positions in metres, about the distance to the Sun: doubles still resolve 0.03 mm there. */
static const double position_max_m = 1.5e11;
/* Radiance, irradiance and intensity; leaves room for products in float. */
static const double light_max = 1e20;

enum { LIGHTS_MAX = 4096, REASON_BYTES = 256 };

/* ---- Camera ----------------------------------------------------------------------------------------- */

/* An orthographic camera has a height instead of an angle, and planes that end it. */
static bool check_projection(const struct json_place *place, const cJSON *json, struct host_camera *camera)
{
    static const char *const orthographic[] = { "znear", "zfar" };
    const bool flat = cJSON_GetObjectItemCaseSensitive(json, "ymag") != NULL;
    for (int i = 0; i < 2; i++)
        if (!flat && cJSON_GetObjectItemCaseSensitive(json, orthographic[i]))
            return json_fail(place, "camera", "%s is for orthographic cameras, which have a ymag",
                             orthographic[i]);
    if (flat && cJSON_GetObjectItemCaseSensitive(json, "yfov_deg"))
        return json_fail(place, "camera", "yfov_deg is for perspective cameras, which have no ymag");
    if (flat && camera->zfar_m == 0)
        camera->zfar_m = HOST_ZFAR_M;
    return !flat || camera->znear_m < camera->zfar_m ||
           json_fail(place, "camera", "znear must be smaller than zfar, which is %g", (double)camera->zfar_m);
}

static bool read_camera(const struct json_place *place, const cJSON *json, struct host_camera *camera)
{
    const struct json_field fields[] = {
        { "position", JSON_DOUBLE3, camera->position, -position_max_m, position_max_m, .required = true },
        { "look_at", JSON_DOUBLE3, camera->look_at, -position_max_m, position_max_m, .required = true },
        { "up", JSON_FLOAT3, camera->up, -1e6, 1e6, .required = false },
        { "yfov_deg", JSON_DEGREES, &camera->yfov_rad, 0.1, 179, .required = false },
        { "ymag", JSON_FLOAT, &camera->ymag_m, 1e-6, 1e9, .required = false },
        { "znear", JSON_FLOAT, &camera->znear_m, 0, 1e9, .required = false },
        { "zfar", JSON_FLOAT, &camera->zfar_m, 1e-6, 1e9, .required = false },
    };
    if (!json_read_object(place, json, "camera", JSON_FIELDS(fields)) ||
        !check_projection(place, json, camera))
        return false;
    double forward[3], side[3], up[3] = { camera->up[0], camera->up[1], camera->up[2] };
    base_vec3d_sub(camera->look_at, camera->position, forward);
    if (!base_vec3d_normalize(forward))
        return json_fail(place, "camera.look_at", "equals camera.position");
    if (!base_vec3d_normalize(up))
        return json_fail(place, "camera.up", "has no direction");
    base_vec3d_cross(forward, up, side);
    /* Below a tenth of a milliradian the sideways direction is rounding. */
    if (base_vec3d_length(side) < 1e-4)
        return json_fail(place, "camera.up", "is parallel to the view direction");
    return true;
}

/* ---- Sky, environment and sun ----------------------------------------------------------------------- */

/* A string is what the option of the same name takes. */
static bool read_text(const struct json_place *place, const char *text, const char *name, view_option *read,
                      struct host_view *view)
{
    char reason[REASON_BYTES];
    return read(text, view, reason, sizeof reason) || json_fail(place, name, "%s", reason);
}

static bool read_sky(const struct json_place *place, const cJSON *json, struct host_view *view)
{
    struct host_sky *const sky = &view->sky;
    if (!json || cJSON_IsNull(json))
        return true;
    if (cJSON_IsString(json))
        return read_text(place, json->valuestring, "sky", view_option_sky, view);
    if (cJSON_GetObjectItemCaseSensitive(json, "radiance")) {
        const struct json_field uniform[] = { { "radiance", JSON_FLOAT3, sky->horizon, 0, light_max,
                                                .required = true } };
        if (!json_read_object(place, json, "sky", JSON_FIELDS(uniform)))
            return false;
        memcpy(sky->zenith, sky->horizon, sizeof sky->zenith);
        memcpy(sky->ground, sky->horizon, sizeof sky->ground);
        return true;
    }
    const struct json_field gradient[] = {
        { "zenith", JSON_FLOAT3, sky->zenith, 0, light_max, .required = true },
        { "horizon", JSON_FLOAT3, sky->horizon, 0, light_max, .required = true },
        { "ground", JSON_FLOAT3, sky->ground, 0, light_max, .required = true },
    };
    return json_read_object(place, json, "sky", JSON_FIELDS(gradient));
}

static bool read_environment(const struct json_place *place, const cJSON *json, const cJSON *sky,
                             struct host_view *view)
{
    if (!json || cJSON_IsNull(json))
        return true;
    if (sky && !cJSON_IsNull(sky))
        return json_fail(place, "environment", "and sky: give one of them");
    char *const path = json_read_file_name(place, json, "environment");
    const bool complete = path && read_text(place, path, "environment", view_option_environment, view);
    free(path);
    return complete;
}

static bool has_direction(const float direction[3])
{
    double copy[3] = { direction[0], direction[1], direction[2] };
    return base_vec3d_normalize(copy);
}

static bool read_sun(const struct json_place *place, const cJSON *json, struct host_view *view)
{
    struct host_sun *const sun = &view->sun;
    if (!json || cJSON_IsNull(json))
        return true;
    if (cJSON_IsString(json))
        return read_text(place, json->valuestring, "sun", view_option_sun, view);
    const struct json_field fields[] = {
        { "direction", JSON_FLOAT3, sun->direction, -1e6, 1e6, .required = true },
        { "irradiance", JSON_FLOAT3, sun->irradiance, 0, light_max, .required = true },
        { "angle_deg", JSON_DEGREES, &sun->angle_rad, 0, 90, .required = false },
    };
    if (!json_read_object(place, json, "sun", JSON_FIELDS(fields)))
        return false;
    sun->enabled = true;
    return has_direction(sun->direction) || json_fail(place, "sun.direction", "has no direction");
}

/* ---- Fog -------------------------------------------------------------------------------------------- */

static bool read_fog(const struct json_place *place, const cJSON *json, struct host_fog *fog)
{
    if (!json || cJSON_IsNull(json))
        return true;
    *fog = (struct host_fog){ .albedo = { 1, 1, 1 } };
    const struct json_field fields[] = {
        { "density", JSON_FLOAT, &fog->density, 0, 1e3, .required = true },
        { "albedo", JSON_FLOAT3, fog->albedo, 0, 1, .required = false },
        { "height_falloff", JSON_FLOAT, &fog->height_falloff, 0, 1e3, .required = false },
        { "height", JSON_DOUBLE, &fog->height_m, -position_max_m, position_max_m, .required = false },
        { "anisotropy", JSON_FLOAT, &fog->anisotropy, -0.9, 0.9, .required = false },
    };
    return json_read_object(place, json, "fog", JSON_FIELDS(fields));
}

/* ---- Lights ----------------------------------------------------------------------------------------- */

static bool read_light(const struct json_place *place, const cJSON *json, const char *name,
                       struct host_light *light)
{
    uint32_t type = HOST_LIGHT_POINT;
    const struct json_field fields[] = {
        { "type", JSON_CHOICE, &type, .required = true, .choices = "point,spot" },
        { "position", JSON_DOUBLE3, light->position, -position_max_m, position_max_m, .required = true },
        { "intensity", JSON_FLOAT3, light->intensity, 0, light_max, .required = true },
        { "radius", JSON_FLOAT, &light->radius_m, 0, 1e6, .required = false },
        { "range", JSON_FLOAT, &light->range_m, 0, 1e12, .required = false },
        { "direction", JSON_FLOAT3, light->direction, -1e6, 1e6, .required = false },
        { "inner_deg", JSON_DEGREES, &light->inner_rad, 0, 90, .required = false },
        { "outer_deg", JSON_DEGREES, &light->outer_rad, 0, 90, .required = false },
    };
    if (!json_read_object(place, json, name, JSON_FIELDS(fields)))
        return false;
    light->type = (enum host_light_type)type;
    const bool spot = light->type == HOST_LIGHT_SPOT;
    static const char *const spot_keys[] = { "direction", "inner_deg", "outer_deg" };
    for (int i = 0; i < 3; i++)
        if ((cJSON_GetObjectItemCaseSensitive(json, spot_keys[i]) != NULL) != spot)
            return json_fail(place, name, "%s %s", spot_keys[i],
                             spot ? "is missing" : "is for spot lights only");
    if (spot && !has_direction(light->direction))
        return json_fail(place, name, "direction has no direction");
    return !spot || light->inner_rad < light->outer_rad ||
           json_fail(place, name, "inner_deg must be smaller than outer_deg");
}

static bool read_lights(const struct json_place *place, const cJSON *json, struct host_view *view)
{
    if (!json)
        return true;
    if (!cJSON_IsArray(json))
        return json_fail(place, "lights", "expected an array");
    const int count = cJSON_GetArraySize(json);
    if (count > LIGHTS_MAX)
        return json_fail(place, "lights", "are %d, expected at most %d", count, LIGHTS_MAX);
    view->lights = count ? calloc((size_t)count, sizeof *view->lights) : NULL;
    if (count && !view->lights)
        return json_fail(place, "lights", "out of memory");
    const cJSON *item;
    cJSON_ArrayForEach(item, json)
    {
        char name[32];
        snprintf(name, sizeof name, "lights[%u]", view->light_count);
        if (!read_light(place, item, name, &view->lights[view->light_count]))
            return false;
        view->light_count++;
    }
    return true;
}

/* ---- Whole files ------------------------------------------------------------------------------------ */

static bool read_view(const struct json_place *place, const cJSON *json, struct host_view *view)
{
    const cJSON *camera = NULL, *sky = NULL, *environment = NULL, *sun = NULL, *fog = NULL, *lights = NULL;
    uint32_t materials = HOST_MATERIALS_GLTF;
    const struct json_field fields[] = {
        { "camera", JSON_ANY, &camera, .required = true },
        { "sky", JSON_ANY, &sky, .required = false },
        { "environment", JSON_ANY, &environment, .required = false },
        { "sun", JSON_ANY, &sun, .required = false },
        { "fog", JSON_ANY, &fog, .required = false },
        { "lights", JSON_ANY, &lights, .required = false },
        { "punctual_scale", JSON_FLOAT, &view->punctual_scale, 0, 1e9, .required = false },
        { "emissive_scale", JSON_FLOAT, &view->emissive_scale, 0, 1e9, .required = false },
        { "materials", JSON_CHOICE, &materials, .choices = "gltf,lambert" },
        { "default_albedo", JSON_FLOAT3, view->default_albedo, 0, 1, .required = false },
    };
    if (!json_read_object(place, json, "", JSON_FIELDS(fields)))
        return false;
    view->materials = (enum host_materials)materials;
    return read_camera(place, camera, &view->camera) && read_sky(place, sky, view) &&
           read_environment(place, environment, sky, view) && read_sun(place, sun, view) &&
           read_fog(place, fog, &view->fog) && read_lights(place, lights, view);
}

bool view_file_load(const char *path, struct host_view *view, char *error, size_t error_size)
{
    const struct json_place place = { path, error, error_size };
    host_view_default(view);
    cJSON *json = json_load(&place);
    const bool complete = json && read_view(&place, json, view);
    cJSON_Delete(json);
    if (!complete)
        view_file_finish(view);
    return complete;
}

void view_file_finish(struct host_view *view)
{
    free(view->lights);
    free(view->environment.rgb);
    view->environment.rgb = NULL;
    view->lights = NULL;
    view->light_count = 0;
}
