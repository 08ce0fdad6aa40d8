/* SPDX-License-Identifier: MIT */
#include "json_write.h"

#include "output_file.h"

#include <base/text.h>
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

bool json_add_item(cJSON *object, const char *name, cJSON *item)
{
    if (item && cJSON_AddItemToObject(object, name, item))
        return true;
    cJSON_Delete(item);
    return false;
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

bool json_write_file(cJSON *json, const char *path, char *error, size_t error_size)
{
    char *text = json ? cJSON_Print(json) : NULL;
    cJSON_Delete(json);
    if (!text)
        return base_text_error(error, error_size, "%s: out of memory", path);
    struct output_file file;
    const bool begun = output_file_begin(&file, path, error, error_size);
    if (begun)
        fprintf(file.stream, "%s\n", text);
    cJSON_free(text);
    return begun && output_file_commit(&file, error, error_size);
}
