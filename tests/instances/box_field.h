/* SPDX-License-Identifier: MIT
 * A field of boxes on the ground, as many instances of one mesh or as one mesh with as many triangles. */
#ifndef TEST_BOX_FIELD_H
#define TEST_BOX_FIELD_H

#include "gi_test.h"

/* Boxes stand in a square around the origin, `spacing_m` apart, each of half that width and of a height of
 * its own. */
struct box_field {
    uint32_t count;
    double spacing_m;
};

struct test_mesh box_field_unit(void);
/* Where box `index` is. Its numbers are such that floats hold what the transform gives without rounding. */
struct sdfgi_transform box_field_place(const struct box_field *field, uint32_t index);
/* All boxes as one mesh; the caller destroys it. */
struct test_mesh box_field_mesh(const struct box_field *field);

#endif
