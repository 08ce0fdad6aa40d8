/* SPDX-License-Identifier: MIT
 * Adding to JSON. Memory may run out in any of these; all accept a parent that is NULL for that reason, so
 * that a caller adds everything and asks once. */
#ifndef RUNTIME_JSON_WRITE_H
#define RUNTIME_JSON_WRITE_H

#include <cJSON.h>
#include <stdbool.h>
#include <stddef.h>

/* The new member or element; NULL if there is no memory. */
cJSON *json_add_object(cJSON *parent, const char *name);
cJSON *json_add_element(cJSON *array);

/* Takes `item` over, and deletes it where it cannot be added; NULL stands for want of memory. */
bool json_add_item(cJSON *object, const char *name, cJSON *item);

/* null where the number is not finite, or the text NULL. */
bool json_add_number(cJSON *object, const char *name, double value);
bool json_add_text(cJSON *object, const char *name, const char *text);

/* Writes a file whole or not at all, and deletes `json`; NULL stands for want of memory. On failure false,
 * and one line in `error`. */
bool json_write_file(cJSON *json, const char *path, char *error, size_t error_size);

#endif
