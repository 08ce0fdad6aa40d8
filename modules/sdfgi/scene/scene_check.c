/* SPDX-License-Identifier: MIT */
#include "scene_check.h"

#include <math.h>

bool sdfgi_check_finite_floats(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

bool sdfgi_check_finite_doubles(const double *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

bool sdfgi_check_non_negative(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!(isfinite(v[i]) && v[i] >= 0))
            return false;
    return true;
}

enum sdfgi_result sdfgi_check_out_of_slots(const struct scene *scene, const char *what, uint32_t limit)
{
    sdfgi_message_log(&scene->backend->hooks, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY,
                      "%s: out of host memory, more than %u of them, or no handle left", what, limit);
    return SDFGI_ERROR_OUT_OF_MEMORY;
}

enum sdfgi_result sdfgi_check_unknown_handle(const struct scene *scene, const char *what, uint32_t id)
{
    sdfgi_message_log(&scene->backend->hooks, SDFGI_MESSAGE_INVALID_HANDLE, "%s: no object with handle %u",
                      what, id);
    return SDFGI_ERROR_INVALID_ARGUMENT;
}
