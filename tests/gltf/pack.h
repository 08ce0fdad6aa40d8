/* SPDX-License-Identifier: MIT
 *
 * A grid of vertices, and its compressed forms. */
#ifndef TESTS_GLTF_PACK_H
#define TESTS_GLTF_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    GRID_SIDE = 6,
    GRID_VERTICES = GRID_SIDE * GRID_SIDE,
    GRID_TRIANGLES = 2 * (GRID_SIDE - 1) * (GRID_SIDE - 1)
};

struct grid {
    float positions[3 * GRID_VERTICES], normals[3 * GRID_VERTICES], uv[2 * GRID_VERTICES];
    uint32_t indices[3 * GRID_TRIANGLES];
};

#ifdef __cplusplus
extern "C" {
#endif

/* Draco's stream of the grid; its attributes 0, 1 and 2 are positions, normals and uv. Nothing is rounded. */
size_t draco_encode(const struct grid *grid, bool edgebreaker, uint8_t *out, size_t capacity);

#ifdef __cplusplus
}
#endif

#endif
