/* SPDX-License-Identifier: MIT */
#include "json_write.h"

#include <math.h>

cJSON *json_add_object(cJSON *parent, const char *name)
{
    return cJSON_AddObjectToObject(parent, name);
}

cJSON *json_add_element(cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    if (object && cJSON_AddItemToArray(array, object))
        return object;
    cJSON_Delete(object);
    return NULL;
}

bool json_add_number(cJSON *object, const char *name, double value)
{
    return (isfinite(value) ? cJSON_AddNumberToObject(object, name, value)
                            : cJSON_AddNullToObject(object, name)) != NULL;
}

bool json_add_text(cJSON *object, const char *name, const char *text)
{
    return (text ? cJSON_AddStringToObject(object, name, text) : cJSON_AddNullToObject(object, name)) != NULL;
}
