/* SPDX-License-Identifier: MIT */
#include "meshes.h"

#include "test_memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

const double test_rotation_none[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

static struct test_mesh mesh_create(uint32_t vertex_count, uint32_t triangle_count)
{
    return (struct test_mesh){
        .positions = test_array_alloc(3 * (size_t)vertex_count, sizeof(float)),
        .indices = test_array_alloc(3 * (size_t)triangle_count, sizeof(uint32_t)),
        .vertex_count = vertex_count,
        .triangle_count = triangle_count,
    };
}

void test_mesh_destroy(struct test_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->indices);
    *mesh = (struct test_mesh){ 0 };
}

static void mesh_set_triangle(struct test_mesh *mesh, uint32_t triangle, uint32_t a, uint32_t b, uint32_t c)
{
    memcpy(mesh->indices + 3 * (size_t)triangle, (uint32_t[]){ a, b, c }, 3 * sizeof(uint32_t));
}

static void mesh_set_vertex(struct test_mesh *mesh, uint32_t vertex, const double position[static 3])
{
    for (int i = 0; i < 3; i++)
        mesh->positions[3 * (size_t)vertex + i] = (float)position[i];
}

/* center + rotation * local */
static void place(const double center[static 3], const double rotation[static 9],
                  const double local[static 3], double placed[static 3])
{
    for (int i = 0; i < 3; i++)
        placed[i] =
            center[i] + rotation[i] * local[0] + rotation[3 + i] * local[1] + rotation[6 + i] * local[2];
}

void test_rotation(const double axis[static 3], double angle_rad, double rotation[static 9])
{
    const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double u[3] = { axis[0] / length, axis[1] / length, axis[2] / length };
    const double c = cos(angle_rad), s = sin(angle_rad);
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            rotation[3 * column + row] = (1 - c) * u[row] * u[column] + (row == column ? c : 0);
    rotation[3 * 0 + 1] += s * u[2];
    rotation[3 * 1 + 0] -= s * u[2];
    rotation[3 * 1 + 2] += s * u[0];
    rotation[3 * 2 + 1] -= s * u[0];
    rotation[3 * 2 + 0] += s * u[1];
    rotation[3 * 0 + 2] -= s * u[1];
}

/* ---- Spheres: an icosahedron, each triangle split in four, vertices pushed out to the sphere ---- */

static struct test_mesh icosahedron(void)
{
    static const uint32_t faces[20][3] = {
        { 0, 11, 5 },  { 0, 5, 1 },  { 0, 1, 7 },  { 0, 7, 10 }, { 0, 10, 11 }, { 1, 5, 9 }, { 5, 11, 4 },
        { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 },  { 3, 9, 4 },  { 3, 4, 2 },   { 3, 2, 6 }, { 3, 6, 8 },
        { 3, 8, 9 },   { 4, 9, 5 },  { 2, 4, 11 }, { 6, 2, 10 }, { 8, 6, 7 },   { 9, 8, 1 },
    };
    const double t = (1 + sqrt(5)) / 2;
    const double corners[12][3] = {
        { -1, t, 0 },  { 1, t, 0 },  { -1, -t, 0 }, { 1, -t, 0 }, { 0, -1, t },  { 0, 1, t },
        { 0, -1, -t }, { 0, 1, -t }, { t, 0, -1 },  { t, 0, 1 },  { -t, 0, -1 }, { -t, 0, 1 },
    };
    struct test_mesh mesh = mesh_create(12, 20);
    for (uint32_t i = 0; i < 12; i++)
        mesh_set_vertex(&mesh, i, corners[i]);
    for (uint32_t i = 0; i < 20; i++)
        mesh_set_triangle(&mesh, i, faces[i][0], faces[i][1], faces[i][2]);
    return mesh;
}

struct edge {
    uint32_t low, high, midpoint;
};

static int edge_compare(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    return (p->high > q->high) - (p->high < q->high);
}

/* All edges, each once and sorted, with a new vertex number for the middle of each. */
static uint32_t edges_collect(const struct test_mesh *mesh, struct edge *edges)
{
    const uint32_t count = 3 * mesh->triangle_count;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t a = mesh->indices[i], b = mesh->indices[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = (struct edge){ a < b ? a : b, a < b ? b : a, 0 };
    }
    qsort(edges, count, sizeof *edges, edge_compare);
    uint32_t unique = 0;
    for (uint32_t i = 0; i < count; i++)
        if (i == 0 || edge_compare(&edges[unique - 1], &edges[i]) != 0)
            edges[unique++] = edges[i];
    for (uint32_t i = 0; i < unique; i++)
        edges[i].midpoint = mesh->vertex_count + i;
    return unique;
}

static uint32_t edge_midpoint(const struct edge *edges, uint32_t count, uint32_t a, uint32_t b)
{
    const struct edge key = { a < b ? a : b, a < b ? b : a, 0 };
    return ((const struct edge *)bsearch(&key, edges, count, sizeof *edges, edge_compare))->midpoint;
}

static void mesh_subdivide(struct test_mesh *mesh)
{
    struct edge *edges = test_array_alloc(3 * (size_t)mesh->triangle_count, sizeof *edges);
    const uint32_t edge_count = edges_collect(mesh, edges);
    struct test_mesh fine = mesh_create(mesh->vertex_count + edge_count, 4 * mesh->triangle_count);
    memcpy(fine.positions, mesh->positions, 3 * sizeof(float) * mesh->vertex_count);
    for (uint32_t i = 0; i < edge_count; i++) {
        const float *a = mesh->positions + 3 * (size_t)edges[i].low,
                    *b = mesh->positions + 3 * (size_t)edges[i].high;
        mesh_set_vertex(&fine, edges[i].midpoint,
                        (double[]){ (a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, (a[2] + b[2]) / 2.0 });
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *v = mesh->indices + 3 * (size_t)i;
        const uint32_t ab = edge_midpoint(edges, edge_count, v[0], v[1]);
        const uint32_t bc = edge_midpoint(edges, edge_count, v[1], v[2]);
        const uint32_t ca = edge_midpoint(edges, edge_count, v[2], v[0]);
        mesh_set_triangle(&fine, 4 * i, v[0], ab, ca);
        mesh_set_triangle(&fine, 4 * i + 1, v[1], bc, ab);
        mesh_set_triangle(&fine, 4 * i + 2, v[2], ca, bc);
        mesh_set_triangle(&fine, 4 * i + 3, ab, bc, ca);
    }
    free(edges);
    test_mesh_destroy(mesh);
    *mesh = fine;
}

struct test_mesh test_mesh_bumpy_sphere(const double center[static 3], double radius, double bump,
                                        uint32_t subdivisions)
{
    struct test_mesh mesh = icosahedron();
    for (uint32_t i = 0; i < subdivisions; i++)
        mesh_subdivide(&mesh);
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        const float *p = mesh.positions + 3 * (size_t)i;
        const double length = sqrt((double)p[0] * p[0] + (double)p[1] * p[1] + (double)p[2] * p[2]);
        const double d[3] = { p[0] / length, p[1] / length, p[2] / length };
        const double r = radius * (1 + bump * sin(7 * d[0]) * sin(9 * d[1]) * sin(8 * d[2]));
        mesh_set_vertex(&mesh, i,
                        (double[]){ center[0] + r * d[0], center[1] + r * d[1], center[2] + r * d[2] });
    }
    return mesh;
}

struct test_mesh test_mesh_sphere(const double center[static 3], double radius, uint32_t subdivisions)
{
    return test_mesh_bumpy_sphere(center, radius, 0, subdivisions);
}

/* ---- Boxes and rooms ---- */

/* Box from low to high in local coordinates, turned and moved; `inward` flips its faces. */
static struct test_mesh box_between(const double center[static 3], const double rotation[static 9],
                                    const double low[static 3], const double high[static 3], int inward)
{
    static const uint32_t faces[6][4] = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 },
                                          { 2, 6, 7, 3 }, { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
    struct test_mesh mesh = mesh_create(8, 12);
    for (uint32_t i = 0; i < 8; i++) {
        const double local[3] = { i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                                  i & 4 ? high[2] : low[2] };
        double placed[3];
        place(center, rotation, local, placed);
        mesh_set_vertex(&mesh, i, placed);
    }
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t *f = faces[i];
        mesh_set_triangle(&mesh, 2 * i, f[0], f[inward ? 2 : 1], f[inward ? 1 : 2]);
        mesh_set_triangle(&mesh, 2 * i + 1, f[0], f[inward ? 3 : 2], f[inward ? 2 : 3]);
    }
    return mesh;
}

static void mesh_take(struct test_mesh *mesh, struct test_mesh other)
{
    test_mesh_append(mesh, &other);
    test_mesh_destroy(&other);
}

struct test_mesh test_mesh_box(const double center[static 3], const double half_extent[static 3],
                               const double rotation[static 9])
{
    const double low[3] = { -half_extent[0], -half_extent[1], -half_extent[2] };
    return box_between(center, rotation, low, half_extent, 0);
}

/* The outside of a room: a box larger by `wall` on every side. */
static struct test_mesh room_shell(const double center[static 3], const double half_extent[static 3],
                                   double wall, const double rotation[static 9])
{
    const double outer[3] = { half_extent[0] + wall, half_extent[1] + wall, half_extent[2] + wall };
    return test_mesh_box(center, outer, rotation);
}

struct test_mesh test_mesh_room(const double center[static 3], const double half_extent[static 3],
                                double wall, const double rotation[static 9])
{
    const double low[3] = { -half_extent[0], -half_extent[1], -half_extent[2] };
    struct test_mesh mesh = room_shell(center, half_extent, wall, rotation);
    mesh_take(&mesh, box_between(center, rotation, low, half_extent, 1));
    return mesh;
}

struct test_mesh test_mesh_two_rooms(const double center[static 3], const double half_extent[static 3],
                                     double wall, const double rotation[static 9])
{
    const double *h = half_extent;
    struct test_mesh mesh = room_shell(center, half_extent, wall, rotation);
    mesh_take(&mesh, box_between(center, rotation, (double[]){ -h[0], -h[1], -h[2] },
                                 (double[]){ -wall / 2, h[1], h[2] }, 1));
    mesh_take(&mesh, box_between(center, rotation, (double[]){ wall / 2, -h[1], -h[2] },
                                 (double[]){ h[0], h[1], h[2] }, 1));
    return mesh;
}

/* ---- Sheets ---- */

struct test_mesh test_mesh_torus(const double center[static 3], double radius, double tube_radius,
                                 const double rotation[static 9], uint32_t around, uint32_t tube)
{
    struct test_mesh mesh = mesh_create(around * tube, 2 * around * tube);
    for (uint32_t i = 0; i < around * tube; i++) {
        const uint32_t u = i % around, v = i / around, next_u = (u + 1) % around, next_v = (v + 1) % tube;
        const double a = 2 * PI * u / around, b = 2 * PI * v / tube, r = radius + tube_radius * cos(b);
        double placed[3];
        place(center, rotation, (double[]){ r * cos(a), tube_radius * sin(b), r * sin(a) }, placed);
        mesh_set_vertex(&mesh, i, placed);
        mesh_set_triangle(&mesh, 2 * i, i, next_v * around + next_u, v * around + next_u);
        mesh_set_triangle(&mesh, 2 * i + 1, i, next_v * around + u, next_v * around + next_u);
    }
    return mesh;
}

struct test_mesh test_mesh_plane(const double center[static 3], const double edge_u[static 3],
                                 const double edge_v[static 3], uint32_t divisions)
{
    const uint32_t side = divisions + 1;
    struct test_mesh mesh = mesh_create(side * side, 2 * divisions * divisions);
    for (uint32_t i = 0; i < side * side; i++) {
        const double s = 2.0 * (i % side) / divisions - 1, t = 2.0 * (i / side) / divisions - 1;
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = center[k] + s * edge_u[k] + t * edge_v[k];
        mesh_set_vertex(&mesh, i, p);
    }
    for (uint32_t i = 0; i < divisions * divisions; i++) {
        const uint32_t corner = i / divisions * side + i % divisions;
        mesh_set_triangle(&mesh, 2 * i, corner, corner + 1, corner + side + 1);
        mesh_set_triangle(&mesh, 2 * i + 1, corner, corner + side + 1, corner + side);
    }
    return mesh;
}

/* ---- Loose triangles ---- */

static void mesh_scatter_triangle(struct test_mesh *mesh, uint32_t triangle, struct test_random *random,
                                  const double center[static 3], double reach)
{
    for (uint32_t corner = 0; corner < 3; corner++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = center[k] + test_random_real(random, -reach, reach);
        mesh_set_vertex(mesh, 3 * triangle + corner, p);
    }
    mesh_set_triangle(mesh, triangle, 3 * triangle, 3 * triangle + 1, 3 * triangle + 2);
}

struct test_mesh test_mesh_soup(uint32_t seed, uint32_t count, const double box_min[static 3],
                                const double box_max[static 3], double reach)
{
    struct test_random random = { seed };
    struct test_mesh mesh = mesh_create(3 * count, count);
    for (uint32_t i = 0; i < count; i++) {
        double center[3];
        for (int k = 0; k < 3; k++)
            center[k] = test_random_real(&random, box_min[k], box_max[k]);
        mesh_scatter_triangle(&mesh, i, &random, center, reach);
    }
    return mesh;
}

static int far_from_all(const double (*centers)[3], uint32_t count, const double p[static 3], double spacing)
{
    for (uint32_t i = 0; i < count; i++) {
        const double d[3] = { centers[i][0] - p[0], centers[i][1] - p[1], centers[i][2] - p[2] };
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < spacing * spacing)
            return 0;
    }
    return 1;
}

struct test_mesh test_mesh_dust(uint32_t seed, uint32_t count, const double box_min[static 3],
                                const double box_max[static 3], double size, double spacing)
{
    const double reach =
        size / (2 * sqrt(3)); /* corners in a cube of this half side are at most `size` apart */
    struct test_random random = { seed };
    struct test_mesh mesh = mesh_create(3 * count, count);
    double(*centers)[3] = test_array_alloc(count, sizeof *centers);
    uint32_t placed = 0;
    for (uint64_t attempt = 0; placed < count && attempt < 20 * (uint64_t)count; attempt++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = test_random_real(&random, box_min[k] + reach, box_max[k] - reach);
        if (!far_from_all((const double(*)[3])centers, placed, p, spacing + size))
            continue;
        memcpy(centers[placed], p, sizeof p);
        mesh_scatter_triangle(&mesh, placed++, &random, p, reach);
    }
    mesh.triangle_count = placed;
    mesh.vertex_count = 3 * placed;
    free(centers);
    return mesh;
}

/* ---- Whole meshes ---- */

void test_mesh_append(struct test_mesh *mesh, const struct test_mesh *other)
{
    const uint32_t vertices = mesh->vertex_count + other->vertex_count;
    const uint32_t triangles = mesh->triangle_count + other->triangle_count;
    mesh->positions = test_array_resize(mesh->positions, 3 * (size_t)vertices, sizeof(float));
    mesh->indices = test_array_resize(mesh->indices, 3 * (size_t)triangles, sizeof(uint32_t));
    memcpy(mesh->positions + 3 * (size_t)mesh->vertex_count, other->positions,
           3 * sizeof(float) * other->vertex_count);
    for (size_t i = 0; i < 3 * (size_t)other->triangle_count; i++)
        mesh->indices[3 * (size_t)mesh->triangle_count + i] = other->indices[i] + mesh->vertex_count;
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
}

void test_mesh_transform(struct test_mesh *mesh, const double basis[static 9],
                         const double translation[static 3])
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->positions + 3 * (size_t)i;
        double placed[3];
        place(translation, basis, (double[]){ p[0], p[1], p[2] }, placed);
        mesh_set_vertex(mesh, i, placed);
    }
}

void test_mesh_invert(struct test_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t *corners = mesh->indices + 3 * (size_t)i;
        const uint32_t second = corners[1];
        corners[1] = corners[2];
        corners[2] = second;
    }
}

void test_mesh_bounds(const struct test_mesh *mesh, float bounds_min[static 3], float bounds_max[static 3])
{
    for (int k = 0; k < 3; k++) {
        bounds_min[k] = INFINITY;
        bounds_max[k] = -INFINITY;
        for (uint32_t i = 0; i < mesh->vertex_count; i++) {
            bounds_min[k] = fminf(bounds_min[k], mesh->positions[3 * (size_t)i + k]);
            bounds_max[k] = fmaxf(bounds_max[k], mesh->positions[3 * (size_t)i + k]);
        }
    }
}
