/* SPDX-License-Identifier: MIT */
#include "json_read.h"

#include "input_file.h"

#include <base/text.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILE_BYTES_MAX = 16 << 20, NAME_BYTES = 96 };

static const double radians_per_degree = 3.14159265358979323846 / 180;

bool json_fail(const struct json_place *place, const char *name, const char *format, ...)
{
    char reason[256];
    va_list args;
    va_start(args, format);
    base_text_error_va(reason, sizeof reason, format, args);
    va_end(args);
    return base_text_error(place->error, place->error_size, "%s: %s%s%s", place->path, name,
                           name[0] ? ": " : "", reason);
}

/* ---- Files ------------------------------------------------------------------------------------------ */

static char *read_text(const struct json_place *place, size_t *size)
{
    char reason[128] = "larger than 16 MiB";
    uint64_t bytes;
    FILE *file = input_file_open(place->path, &bytes, reason, sizeof reason);
    char *text = file && bytes <= FILE_BYTES_MAX ? input_file_read(file, bytes, reason, sizeof reason) : NULL;
    if (file)
        fclose(file);
    if (text)
        *size = (size_t)bytes;
    else
        json_fail(place, "", "%s", reason);
    return text;
}

static uint32_t line_of(const char *text, const char *at)
{
    uint32_t line = 1;
    for (; text < at; text++)
        line += *text == '\n';
    return line;
}

cJSON *json_load(const struct json_place *place)
{
    size_t size;
    char *text = read_text(place, &size);
    if (!text)
        return NULL;
    const char *end = text;
    /* A byte of zero inside the text would hide what follows it. */
    errno = 0; /* all that tells text that is broken from a tree that finds no memory */
    cJSON *json = strlen(text) == size ? cJSON_ParseWithOpts(text, &end, true) : NULL;
    if (!json && errno == ENOMEM)
        json_fail(place, "", "out of memory");
    else if (!json)
        json_fail(place, "", "broken JSON in line %u",
                  line_of(text, strlen(text) == size ? end : text + strlen(text)));
    free(text);
    return json;
}

/* ---- Values ----------------------------------------------------------------------------------------- */

static bool read_number(const struct json_place *place, const cJSON *item, const char *name,
                        const struct json_field *field, double *value)
{
    if (!cJSON_IsNumber(item))
        return json_fail(place, name, "expected a number");
    if (!isfinite(item->valuedouble) || item->valuedouble < field->minimum ||
        item->valuedouble > field->maximum)
        return json_fail(place, name, "is %g, expected a number from %g to %g", item->valuedouble,
                         field->minimum, field->maximum);
    *value = item->valuedouble;
    return true;
}

static bool read_number3(const struct json_place *place, const cJSON *item, const char *name,
                         const struct json_field *field, double values[3])
{
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 3)
        return json_fail(place, name, "expected an array of 3 numbers");
    for (int i = 0; i < 3; i++)
        if (!read_number(place, cJSON_GetArrayItem(item, i), name, field, &values[i]))
            return false;
    return true;
}

static bool read_choice(const struct json_place *place, const cJSON *item, const char *name,
                        const struct json_field *field)
{
    const char *choice = field->choices;
    for (uint32_t index = 0; cJSON_IsString(item) && *choice; index++) {
        const size_t length = strcspn(choice, ",");
        if (strlen(item->valuestring) == length && strncmp(item->valuestring, choice, length) == 0) {
            *(uint32_t *)field->target = index;
            return true;
        }
        choice += length + (choice[length] == ',');
    }
    return json_fail(place, name, "expected one of %s", field->choices);
}

static bool read_field(const struct json_place *place, const cJSON *item, const char *name,
                       const struct json_field *field)
{
    double values[3] = { 0 };
    switch (field->type) {
    case JSON_ANY:
        *(const cJSON **)field->target = item;
        return true;
    case JSON_CHOICE:
        return read_choice(place, item, name, field);
    case JSON_FLOAT:
    case JSON_DEGREES:
        if (!read_number(place, item, name, field, values))
            return false;
        *(float *)field->target =
            (float)(field->type == JSON_DEGREES ? values[0] * radians_per_degree : values[0]);
        return true;
    case JSON_FLOAT3:
        if (!read_number3(place, item, name, field, values))
            return false;
        for (int i = 0; i < 3; i++)
            ((float *)field->target)[i] = (float)values[i];
        return true;
    case JSON_DOUBLE:
        return read_number(place, item, name, field, field->target);
    case JSON_DOUBLE3:
        break;
    }
    return read_number3(place, item, name, field, field->target);
}

/* ---- Objects ---------------------------------------------------------------------------------------- */

static void join_names(char out[NAME_BYTES], const char *name, const char *key)
{
    base_text_error(out, NAME_BYTES, "%s%s%s", name, name[0] ? "." : "", key);
}

static const struct json_field *find_field(const struct json_field *fields, uint32_t count, const char *key)
{
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(fields[i].key, key) == 0)
            return &fields[i];
    return NULL;
}

static bool check_required(const struct json_place *place, const cJSON *object, const char *name,
                           const struct json_field *fields, uint32_t count)
{
    char full_name[NAME_BYTES];
    for (uint32_t i = 0; i < count; i++) {
        if (!fields[i].required || cJSON_GetObjectItemCaseSensitive(object, fields[i].key))
            continue;
        join_names(full_name, name, fields[i].key);
        return json_fail(place, full_name, "is missing");
    }
    return true;
}

bool json_read_object(const struct json_place *place, const cJSON *object, const char *name,
                      const struct json_field *fields, uint32_t count)
{
    if (!cJSON_IsObject(object))
        return json_fail(place, name, "expected an object");
    for (const cJSON *item = object->child; item; item = item->next) {
        char full_name[NAME_BYTES];
        join_names(full_name, name, item->string);
        const struct json_field *field = find_field(fields, count, item->string);
        if (!field)
            return json_fail(place, full_name, "unknown key");
        if (cJSON_GetObjectItemCaseSensitive(object, item->string) != item)
            return json_fail(place, full_name, "given twice");
        if (!read_field(place, item, full_name, field))
            return false;
    }
    return check_required(place, object, name, fields, count);
}

/* ---- Names of files --------------------------------------------------------------------------------- */

char *json_read_file_name(const struct json_place *place, const cJSON *item, const char *name)
{
    if (!cJSON_IsString(item) || !item->valuestring[0]) {
        json_fail(place, name, "expected the name of a file");
        return NULL;
    }
    const char *const slash = strrchr(place->path, '/');
    const int folder = slash && item->valuestring[0] != '/' ? (int)(slash + 1 - place->path) : 0;
    const size_t size = (size_t)folder + strlen(item->valuestring) + 1;
    char *const path = malloc(size);
    if (path)
        snprintf(path, size, "%.*s%s", folder, place->path, item->valuestring);
    else
        json_fail(place, name, "out of memory");
    return path;
}
