/* SPDX-License-Identifier: MIT */
#include "oracle_edt.h"

#include "test_memory.h"

#include <math.h>
#include <stdlib.h>

/* Sub-voxel centres are at k + 0.5 and cell centres at 4 i + 2, in sub-voxels along each axis. */
static double sub_center(uint32_t sub)
{
    return sub + 0.5;
}

static double cell_center(uint32_t cell)
{
    return ORACLE_SUB_PER_CELL * (cell + 0.5);
}

/* Distance along x from each cell centre to the nearest set bit of a row. */
static void row_distances(const struct oracle_bits *bits, uint32_t y, uint32_t z, float *distance)
{
    const uint32_t cells = bits->size / ORACLE_SUB_PER_CELL;
    double last = -INFINITY;
    uint32_t sub = 0;
    for (uint32_t cell = 0; cell < cells; cell++) {
        for (; sub_center(sub) < cell_center(cell); sub++)
            if (oracle_bits_get(bits, sub, y, z))
                last = sub_center(sub);
        distance[cell] = (float)(cell_center(cell) - last);
    }
    double next = INFINITY;
    sub = bits->size;
    for (uint32_t cell = cells; cell-- > 0;) {
        for (; sub > 0 && sub_center(sub - 1) > cell_center(cell); sub--)
            if (oracle_bits_get(bits, sub - 1, y, z))
                next = sub_center(sub - 1);
        distance[cell] = fminf(distance[cell], (float)(next - cell_center(cell)));
    }
}

/* Lower envelope of the parabolas height[i] + weight * (q - sub_center(i))^2. */
struct envelope {
    uint32_t count;
    uint32_t *vertex; /* parabola numbers from left to right */
    double *start;    /* where each begins to be the lowest */
};

static struct envelope envelope_create(uint32_t size)
{
    return (struct envelope){ .vertex = test_array_alloc(size, sizeof(uint32_t)),
                              .start = test_array_alloc(size, sizeof(double)) };
}

static void envelope_destroy(struct envelope *envelope)
{
    free(envelope->vertex);
    free(envelope->start);
}

/* Where parabola `right` gets below parabola `left`. */
static double envelope_crossing(const float *height, double weight, uint32_t left, uint32_t right)
{
    const double l = sub_center(left), r = sub_center(right);
    return ((double)height[right] - height[left]) / (2 * weight * (r - l)) + (l + r) / 2;
}

static void envelope_build(struct envelope *envelope, const float *height, uint32_t size, double weight)
{
    envelope->count = 0;
    for (uint32_t i = 0; i < size; i++) {
        if (isinf(height[i]))
            continue;
        double start = -INFINITY;
        while (envelope->count) {
            start = envelope_crossing(height, weight, envelope->vertex[envelope->count - 1], i);
            if (start > envelope->start[envelope->count - 1])
                break;
            envelope->count--;
            start = -INFINITY;
        }
        envelope->vertex[envelope->count] = i;
        envelope->start[envelope->count++] = start;
    }
}

/* out[cell] = the envelope's height over each cell centre. */
static void envelope_sample(const struct envelope *envelope, const float *height, uint32_t cells,
                            double weight, float *out)
{
    uint32_t current = 0;
    for (uint32_t cell = 0; cell < cells; cell++) {
        if (!envelope->count) {
            out[cell] = INFINITY;
            continue;
        }
        const double q = cell_center(cell);
        while (current + 1 < envelope->count && envelope->start[current + 1] <= q)
            current++;
        const double offset = q - sub_center(envelope->vertex[current]);
        out[cell] = (float)(height[envelope->vertex[current]] + weight * offset * offset);
    }
}

/* A plane z of sub-voxels reduced to cells x cells squared distances within that plane. */
static void plane_distances(const struct oracle_bits *bits, uint32_t z, double y_scale,
                            struct envelope *envelope, float *rows, float *column, float *plane)
{
    const uint32_t size = bits->size, cells = size / ORACLE_SUB_PER_CELL;
    for (uint32_t y = 0; y < size; y++)
        row_distances(bits, y, z, rows + (size_t)y * cells);
    for (uint32_t x = 0; x < cells; x++) {
        for (uint32_t y = 0; y < size; y++)
            column[y] = rows[(size_t)y * cells + x] * rows[(size_t)y * cells + x];
        envelope_build(envelope, column, size, y_scale * y_scale);
        envelope_sample(envelope, column, cells, y_scale * y_scale, plane + (size_t)x * cells);
    }
}

/* planes[z][x][y] over sub-voxel planes z, to squared distances at cell centres. */
static void depth_distances(const float *planes, uint32_t cells, struct envelope *envelope, float *column,
                            float *distance_cells)
{
    const uint32_t size = cells * ORACLE_SUB_PER_CELL;
    float *sampled = test_array_alloc(cells, sizeof *sampled);
    for (uint32_t i = 0; i < cells * cells; i++) {
        const uint32_t x = i / cells, y = i % cells;
        for (uint32_t z = 0; z < size; z++)
            column[z] = planes[(size_t)z * cells * cells + i];
        envelope_build(envelope, column, size, 1);
        envelope_sample(envelope, column, cells, 1, sampled);
        for (uint32_t z = 0; z < cells; z++)
            distance_cells[x + (size_t)cells * (y + (size_t)cells * z)] =
                (float)(sqrt(sampled[z]) / ORACLE_SUB_PER_CELL);
    }
    free(sampled);
}

float *oracle_edt_cells(const struct oracle_bits *bits, double y_scale)
{
    const uint32_t size = bits->size, cells = size / ORACLE_SUB_PER_CELL;
    float *rows = test_array_alloc((size_t)size * cells, sizeof *rows);
    float *column = test_array_alloc(size, sizeof *column);
    float *planes = test_array_alloc((size_t)size * cells * cells, sizeof *planes);
    float *distance = test_array_alloc((size_t)cells * cells * cells, sizeof *distance);
    struct envelope envelope = envelope_create(size);
    for (uint32_t z = 0; z < size; z++)
        plane_distances(bits, z, y_scale, &envelope, rows, column, planes + (size_t)z * cells * cells);
    depth_distances(planes, cells, &envelope, column, distance);
    envelope_destroy(&envelope);
    free(planes);
    free(column);
    free(rows);
    return distance;
}
