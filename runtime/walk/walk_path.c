/* SPDX-License-Identifier: MIT
 * Camera paths: the file. walk_curve.c measures the curve. */
#include "walk_curve.h"

#include "file/json_read.h"

#include <base/text.h>
#include <base/vec.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As far as a VIEW.json reaches: doubles still resolve 0.03 mm there. */
static const double position_max_m = 1.5e11;
/* The roots of smaller distances are lost beside those of a long way. */
static const double distance_min_m = 1e-6;

/* ---- Points ----------------------------------------------------------------------------------------- */

static bool read_point(const struct json_place *place, const cJSON *json, const char *name,
                       struct walk_point *point)
{
    /* A bare position is read as if it stood in an object. */
    if (cJSON_IsArray(json)) {
        for (int i = 0; i < 3; i++) {
            const cJSON *item = cJSON_GetArrayItem(json, i);
            if (cJSON_GetArraySize(json) != 3 || !cJSON_IsNumber(item))
                return json_fail(place, name, "expected an array of 3 numbers");
            if (!(fabs(item->valuedouble) <= position_max_m))
                return json_fail(place, name, "is %g, expected a number from %g to %g", item->valuedouble,
                                 -position_max_m, position_max_m);
            point->position[i] = item->valuedouble;
        }
        return true;
    }
    const struct json_field fields[] = {
        { "position", JSON_DOUBLE3, point->position, -position_max_m, position_max_m, .required = true },
        { "look_at", JSON_DOUBLE3, point->look_at, -position_max_m, position_max_m, .required = false },
    };
    point->looks = cJSON_GetObjectItemCaseSensitive(json, "look_at") != NULL;
    return json_read_object(place, json, name, JSON_FIELDS(fields));
}

static bool are_apart(const double a[3], const double b[3])
{
    double chord[3];
    base_vec3d_sub(a, b, chord);
    return base_vec3d_length(chord) >= distance_min_m;
}

/* What no curve or view can be made of. */
static bool check_point(const struct json_place *place, const struct walk_path *walk, uint32_t index)
{
    const struct walk_point *point = &walk->points[index];
    char name[32];
    snprintf(name, sizeof name, "points[%u]", index);
    if (index > 0 && !are_apart(point->position, point[-1].position))
        return json_fail(place, name, "equals the point before it, or is less than %g m away from it",
                         distance_min_m);
    if (point->looks && !are_apart(point->position, point->look_at))
        return json_fail(place, name, "look_at equals position, or is less than %g m away from it",
                         distance_min_m);
    return !point->looks || !walk->looks ||
           json_fail(place, name, "look_at is given for the whole path as well");
}

static bool read_points(const struct json_place *place, const cJSON *json, struct walk_path *walk)
{
    const int count = cJSON_IsArray(json) ? cJSON_GetArraySize(json) : 0;
    if (!cJSON_IsArray(json))
        return json_fail(place, "points", "expected an array");
    if (count < 2 || count > WALK_POINTS_MAX)
        return json_fail(place, "points", "are %d, expected 2 to %d", count, WALK_POINTS_MAX);
    walk->points = calloc((size_t)count, sizeof *walk->points);
    if (!walk->points)
        return json_fail(place, "points", "out of memory");
    const cJSON *item;
    cJSON_ArrayForEach(item, json)
    {
        char name[32];
        snprintf(name, sizeof name, "points[%u]", walk->point_count);
        if (!read_point(place, item, name, &walk->points[walk->point_count]) ||
            !check_point(place, walk, walk->point_count))
            return false;
        walk->point_count++;
    }
    return true;
}

/* ---- Whole files ------------------------------------------------------------------------------------ */

static bool read_view_name(const struct json_place *place, const cJSON *json, struct walk_path *walk)
{
    walk->view = json ? json_read_file_name(place, json, "view") : NULL;
    return !json || walk->view;
}

static bool read_walk(const struct json_place *place, const cJSON *json, struct walk_path *walk)
{
    const cJSON *points = NULL, *view = NULL;
    float speed_m_s = 5, fps = 60, smooth_m = 2;
    const struct json_field fields[] = {
        { "points", JSON_ANY, &points, .required = true },
        { "speed_m_s", JSON_FLOAT, &speed_m_s, 1e-3, 1e6, .required = false },
        { "fps", JSON_FLOAT, &fps, 1e-3, 1e4, .required = false },
        { "yfov_deg", JSON_DEGREES, &walk->yfov_rad, 0.1, 179, .required = false },
        { "look_at", JSON_DOUBLE3, walk->look_at, -position_max_m, position_max_m, .required = false },
        { "smooth_m", JSON_FLOAT, &smooth_m, 0, 1e6, .required = false },
        { "view", JSON_ANY, &view, .required = false },
    };
    walk->looks = cJSON_GetObjectItemCaseSensitive(json, "look_at") != NULL;
    if (!json_read_object(place, json, "", JSON_FIELDS(fields)) || !read_points(place, points, walk) ||
        !read_view_name(place, view, walk))
        return false;
    walk->speed_m_s = (double)speed_m_s;
    walk->fps = (double)fps;
    walk->smooth_m = (double)smooth_m;
    return walk_curve_measure(walk) || json_fail(place, "points", "out of memory");
}

bool walk_path_load(const char *path, struct walk_path *walk, char *error, size_t error_size)
{
    const struct json_place place = { path, error, error_size };
    *walk = (struct walk_path){ .yfov_rad = 1.0471976f };
    cJSON *json = json_load(&place);
    const bool complete = json && read_walk(&place, json, walk);
    cJSON_Delete(json);
    if (!complete)
        walk_path_finish(walk);
    return complete;
}

void walk_path_finish(struct walk_path *walk)
{
    free(walk->points);
    free(walk->stations);
    free(walk->view);
    *walk = (struct walk_path){ 0 };
}
