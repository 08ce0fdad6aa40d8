/* SPDX-License-Identifier: MIT
 * Strict reading of JSON objects by tables: unknown keys, wrong types, numbers out of range and missing keys
 * are errors that name the file and the key. */
#ifndef RUNTIME_JSON_READ_H
#define RUNTIME_JSON_READ_H

#include <cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum json_type {
    JSON_FLOAT,   /* float in [minimum, maximum] */
    JSON_DEGREES, /* float in [minimum, maximum] degrees, stored in radians */
    JSON_DOUBLE,  /* double in [minimum, maximum] */
    JSON_FLOAT3,  /* float[3], each in [minimum, maximum] */
    JSON_DOUBLE3, /* double[3], each in [minimum, maximum] */
    JSON_CHOICE,  /* uint32_t: index of the string among `choices` */
    JSON_ANY,     /* const cJSON *: any value, for the caller to read */
};

struct json_field {
    const char *key;
    enum json_type type;
    void *target;
    double minimum, maximum; /* inclusive */
    bool required;
    const char *choices; /* JSON_CHOICE: names separated by commas */
};

/* Where messages come from. */
struct json_place {
    const char *path; /* of the file */
    char *error;
    size_t error_size;
};

#define JSON_FIELDS(array) (array), (uint32_t)(sizeof(array) / sizeof((array)[0]))

/* Reads and parses a whole file; NULL with a line in `place->error` if it is missing, too large or broken.
 * Free with cJSON_Delete. */
cJSON *json_load(const struct json_place *place);

/* Reads `object`, called `name` in messages ("" at the top), into the targets. Keys that are absent leave
 * theirs. */
bool json_read_object(const struct json_place *place, const cJSON *object, const char *name,
                      const struct json_field *fields, uint32_t count);

/* The path of the file that the string `item` names: beside the file of `place`, unless it begins with "/".
 * NULL with a message on failure. For free(). */
char *json_read_file_name(const struct json_place *place, const cJSON *item, const char *name);

/* Writes "path: name: ..." into the error; returns false. */
__attribute__((format(printf, 3, 4))) bool json_fail(const struct json_place *place, const char *name,
                                                     const char *format, ...);

#endif
