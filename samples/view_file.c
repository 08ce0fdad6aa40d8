/* SPDX-License-Identifier: MIT */
#include "view_file.h"

#include <stdio.h>
#include <string.h>

#include <cJSON.h>

#include "file_write.h"

/* Rounded to a tenth of a millimetre or 1e-4 W: readable files, and the same text on every machine. */
static void vector_add(cJSON *parent, const char *name, vec3s v)
{
    cJSON *array = cJSON_AddArrayToObject(parent, name);
    for (int i = 0; i < 3; i++) {
        char text[48];
        snprintf(text, sizeof(text), "%.4f", (double)v.raw[i]);
        cJSON_AddItemToArray(array, cJSON_CreateRaw(text));
    }
}

static void sky_add(cJSON *root, const struct view *view)
{
    if (!view->has_sky) {
        cJSON_AddNullToObject(root, "sky");
        return;
    }
    cJSON *sky = cJSON_AddObjectToObject(root, "sky");
    if (glms_vec3_eqv(view->sky_zenith, view->sky_horizon) &&
        glms_vec3_eqv(view->sky_zenith, view->sky_ground)) {
        vector_add(sky, "radiance", view->sky_zenith);
        return;
    }
    vector_add(sky, "zenith", view->sky_zenith);
    vector_add(sky, "horizon", view->sky_horizon);
    vector_add(sky, "ground", view->sky_ground);
}

static void sun_add(cJSON *root, const struct view *view)
{
    if (!view->has_sun) {
        cJSON_AddNullToObject(root, "sun");
        return;
    }
    cJSON *sun = cJSON_AddObjectToObject(root, "sun");
    vector_add(sun, "direction", view->sun_direction);
    vector_add(sun, "irradiance", view->sun_irradiance);
    cJSON_AddNumberToObject(sun, "angle_deg", 0);
}

static void lights_add(cJSON *root, const struct view *view)
{
    if (!view->light_count)
        return;
    cJSON *lights = cJSON_AddArrayToObject(root, "lights");
    for (uint32_t i = 0; i < view->light_count; i++) {
        cJSON *light = cJSON_CreateObject();
        cJSON_AddStringToObject(light, "type", "point");
        vector_add(light, "position", view->lights[i].position);
        vector_add(light, "intensity", view->lights[i].intensity);
        cJSON_AddItemToArray(lights, light);
    }
}

static bool json_save(cJSON *root, const char *path, char *error, size_t error_size)
{
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    if (!text) {
        snprintf(error, error_size, "%s: out of memory", path);
        return false;
    }
    const struct file_part parts[] = { { text, strlen(text) }, { "\n", 1 } };
    const bool ok = file_write_parts(path, parts, 2, error, error_size);
    cJSON_free(text);
    return ok;
}

bool view_save(const struct view *view, const char *path, char *error, size_t error_size)
{
    cJSON *root = cJSON_CreateObject();
    cJSON *camera = cJSON_AddObjectToObject(root, "camera");
    vector_add(camera, "position", view->position);
    vector_add(camera, "look_at", view->look_at);
    vector_add(camera, "up", (vec3s){ { 0, 1, 0 } });
    cJSON_AddNumberToObject(camera, "yfov_deg", (double)view->yfov_deg);
    sky_add(root, view);
    sun_add(root, view);
    lights_add(root, view);
    cJSON_AddStringToObject(root, "materials", view->lambert ? "lambert" : "gltf");
    return json_save(root, path, error, error_size);
}

bool walk_save(const struct walk_point *points, uint32_t count, float speed_m_s, const char *view,
               const char *path, char *error, size_t error_size)
{
    cJSON *root = cJSON_CreateObject();
    cJSON *list = cJSON_AddArrayToObject(root, "points");
    for (uint32_t i = 0; i < count; i++) {
        cJSON *point = cJSON_CreateObject();
        vector_add(point, "position", points[i].position);
        vector_add(point, "look_at", points[i].look_at);
        cJSON_AddItemToArray(list, point);
    }
    cJSON_AddNumberToObject(root, "speed_m_s", (double)speed_m_s);
    cJSON_AddStringToObject(root, "view", view);
    return json_save(root, path, error, error_size);
}
