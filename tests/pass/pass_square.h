/* SPDX-License-Identifier: MIT
 * A level square of 4 m in a cascade of 32^3 cells of 0.25 m, and what the voxeliser stores of it. A column
 * of sub-voxels is a 64th of its side, a block an 8th. */
#ifndef TEST_PASS_SQUARE_H
#define TEST_PASS_SQUARE_H

#include "pass_scene.h"

enum { SQUARE_COLUMNS = 64, SQUARE_BLOCKS = 8, SQUARE_CORNERS = 4 };

extern const float square_height;
/* As parts of a side, along x and z. */
extern const float square_corners[SQUARE_CORNERS][2];
extern const struct sdfgi_material_desc square_grey;

VkBuffer square_upload(VkDeviceSize size, const void *data);
/* Its front is above. `uvs` and `colors`, of the corners, may be NULL. */
struct sdfgi_mesh_desc square_describe(const float (*uvs)[2], const float (*colors)[4]);
sdfgi_mesh square_mesh_of(const struct sdfgi_mesh_desc *desc);
sdfgi_mesh square_mesh(const float (*uvs)[2], const float (*colors)[4]);

/* What a square of a material became. */
struct square {
    struct oracle_bits bits;
    double albedo[SQUARE_BLOCKS][SQUARE_BLOCKS][3]; /* by z, x */
    double emission[2];                             /* in the middle: up, down */
};

/* Makes the instance alone in the cascade. Its mesh and its material are destroyed. */
struct square square_voxelize_instance(struct sdfgi_instance_desc *instance,
                                       const struct sdfgi_material_desc *desc);
struct square square_voxelize(sdfgi_mesh mesh, const struct sdfgi_material_desc *desc);

/* Whether a column of the square sets its sub-voxel. */
bool square_column_is_set(const struct square *s, uint32_t x, uint32_t z);
uint32_t square_columns_set(const struct square *s);

#endif
