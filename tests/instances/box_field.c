/* SPDX-License-Identifier: MIT */
#include "box_field.h"

#include "test_memory.h"

#include <math.h>
#include <string.h>

/* From -1 to 1 along each axis. */
struct test_mesh box_field_unit(void)
{
    return test_mesh_box((double[3]){ 0, 0, 0 }, (double[3]){ 1, 1, 1 }, test_rotation_none);
}

struct sdfgi_transform box_field_place(const struct box_field *field, uint32_t index)
{
    const uint32_t side = (uint32_t)ceil(sqrt(field->count));
    const double half = field->spacing_m / 4, height = half * (1 + index % 5 * 0.25);
    const double x = (double)(index % side) - side / 2, z = (double)(index / side) - side / 2;
    return (struct sdfgi_transform){ .basis = { (float)half, 0, 0, 0, (float)height, 0, 0, 0, (float)half },
                                     .translation = { x * field->spacing_m, height, z * field->spacing_m } };
}

struct test_mesh box_field_mesh(const struct box_field *field)
{
    struct test_mesh unit = box_field_unit(), all;
    const uint32_t corners = unit.vertex_count, triangles = unit.triangle_count;
    all.vertex_count = field->count * corners;
    all.triangle_count = field->count * triangles;
    all.positions = test_array_alloc(3 * (size_t)all.vertex_count, sizeof *all.positions);
    all.indices = test_array_alloc(3 * (size_t)all.triangle_count, sizeof *all.indices);
    for (uint32_t i = 0; i < field->count; i++) {
        const struct sdfgi_transform t = box_field_place(field, i);
        for (uint32_t v = 0; v < 3 * corners; v++)
            all.positions[3 * (size_t)corners * i + v] =
                (float)((double)t.basis[4 * (v % 3)] * (double)unit.positions[v] + t.translation[v % 3]);
        for (uint32_t k = 0; k < 3 * triangles; k++)
            all.indices[3 * (size_t)triangles * i + k] = corners * i + unit.indices[k];
    }
    test_mesh_destroy(&unit);
    return all;
}
