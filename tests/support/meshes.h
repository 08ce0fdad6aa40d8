/* SPDX-License-Identifier: MIT
 * Meshes built in code: float positions and 32-bit indices, counter-clockwise seen from outside. */
#ifndef TEST_MESHES_H
#define TEST_MESHES_H

#include <stdint.h>

struct test_mesh {
    float *positions;  /* 3 per vertex, metres */
    uint32_t *indices; /* 3 per triangle */
    uint32_t vertex_count, triangle_count;
};

void test_mesh_destroy(struct test_mesh *mesh);

/* Column-major 3x3 rotation about `axis` (need not be unit length). */
void test_rotation(const double axis[static 3], double angle_rad, double rotation[static 9]);
extern const double test_rotation_none[9];

/* Icosphere: 20 * 4^subdivisions triangles whose vertices lie on the sphere. Closed; no shared vertex is
 * duplicated. */
struct test_mesh test_mesh_sphere(const double center[static 3], double radius, uint32_t subdivisions);

/* The same with the radius varied by up to +-bump (a fraction of it) in a smooth pattern. */
struct test_mesh test_mesh_bumpy_sphere(const double center[static 3], double radius, double bump,
                                        uint32_t subdivisions);

struct test_mesh test_mesh_box(const double center[static 3], const double half_extent[static 3],
                               const double rotation[static 9]);

/* Torus around the rotated y axis, `around` x `tube` quads. */
struct test_mesh test_mesh_torus(const double center[static 3], double radius, double tube_radius,
                                 const double rotation[static 9], uint32_t around, uint32_t tube);

/* A closed room: the inside is a box of `half_extent`, around it walls, floor and ceiling of `wall` metres.
 * Inner faces look inwards. rotation turns the whole room, which puts its walls at an angle to the grid. */
struct test_mesh test_mesh_room(const double center[static 3], const double half_extent[static 3],
                                double wall, const double rotation[static 9]);

/* A box divided in two along its own x = 0 by a solid wall of `wall` metres: inner faces of both halves and
 * the outer shell, also `wall` thick. */
struct test_mesh test_mesh_two_rooms(const double center[static 3], const double half_extent[static 3],
                                     double wall, const double rotation[static 9]);

/* Parallelogram center +- edge_u +- edge_v in `divisions`^2 quads; its front is edge_u x edge_v. */
struct test_mesh test_mesh_plane(const double center[static 3], const double edge_u[static 3],
                                 const double edge_v[static 3], uint32_t divisions);

/* `count` triangles with corners within `reach` of random centres in the box: they cross each other. */
struct test_mesh test_mesh_soup(uint32_t seed, uint32_t count, const double box_min[static 3],
                                const double box_max[static 3], double reach);

/* Isolated triangles of edge length `size` or less at random places in the box, no two closer than
 * `spacing`; fewer than `count` if the box is too full for them. */
struct test_mesh test_mesh_dust(uint32_t seed, uint32_t count, const double box_min[static 3],
                                const double box_max[static 3], double size, double spacing);

/* Appends a copy of `other`, which may have any number of triangles. */
void test_mesh_append(struct test_mesh *mesh, const struct test_mesh *other);

/* p' = basis * p + translation, basis column-major. Winding is left alone, mirrored or not. */
void test_mesh_transform(struct test_mesh *mesh, const double basis[static 9],
                         const double translation[static 3]);

/* Turns every triangle's front to the other side. */
void test_mesh_invert(struct test_mesh *mesh);

void test_mesh_bounds(const struct test_mesh *mesh, float bounds_min[static 3], float bounds_max[static 3]);

#endif
