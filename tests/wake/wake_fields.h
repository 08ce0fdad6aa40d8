/* SPDX-License-Identifier: MIT
 * Every field of every description that hosts give: where it is in a world and which values it takes. What is
 * missing from the tables does not compile. */
#ifndef TEST_WAKE_FIELDS_H
#define TEST_WAKE_FIELDS_H

#include "wake_world.h"

enum wake_type {
    WAKE_TYPE_BOOL,
    WAKE_TYPE_U32, /* enums and indices, too */
    WAKE_TYPE_U64,
    WAKE_TYPE_F32,
    WAKE_TYPE_F64,
    WAKE_TYPE_BUFFER, /* values are enum wake_buffer, or -1 for none */
    WAKE_TYPE_VIEW,   /* values are textures, or -1 for none */
};

/* A field of a structure. */
struct wake_part {
    const char *name;
    bool shows; /* some change of it changes volumes or light */
    enum wake_type type;
    size_t offset;
    uint32_t count; /* elements of an array, or 1 */
    const double *values;
    uint32_t value_count;
};

/* Structures in struct wake_world that are alike. */
struct wake_group {
    const char *name;
    enum wake_object object;
    uint32_t first, end;   /* those whose fields change */
    size_t offset, stride; /* of the one with index 0, and from one to the next */
    const struct wake_part *parts;
    uint32_t part_count;
};

struct wake_field {
    const struct wake_group *group;
    const struct wake_part *part;
};

uint32_t wake_field_count(void);
struct wake_field wake_field_get(uint32_t index);

/* Value of an element of a field of an object, and writing one. */
double wake_field_read(const struct wake_field *field, const struct wake_device *device,
                       const struct wake_world *world, uint32_t object, uint32_t element);
void wake_field_write(const struct wake_field *field, const struct wake_device *device,
                      struct wake_world *world, uint32_t object, uint32_t element, double value);

#endif
