/* SPDX-License-Identifier: MIT */
#include "mesh_builder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void *grow(void *memory, size_t count, size_t size)
{
    void *grown = realloc(memory, count * size);
    if (!grown) {
        fprintf(stderr, "out of memory while building a mesh\n");
        exit(EXIT_FAILURE);
    }
    return grown;
}

void mesh_init(struct mesh *mesh)
{
    *mesh = (struct mesh){ .transform = glms_mat4_identity(), .color = v3(1, 1, 1), .uv_per_m = 1 };
}

void mesh_finish(struct mesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->colors);
    free(mesh->indices);
    mesh_init(mesh);
}

static void vertices_reserve(struct mesh *mesh)
{
    if (mesh->vertex_count < mesh->vertex_capacity)
        return;
    const uint32_t capacity = mesh->vertex_capacity ? mesh->vertex_capacity * 2 : 64;
    mesh->positions = grow(mesh->positions, capacity, 3 * sizeof(float));
    mesh->normals = grow(mesh->normals, capacity, 3 * sizeof(float));
    mesh->uvs = grow(mesh->uvs, capacity, 2 * sizeof(float));
    mesh->colors = grow(mesh->colors, capacity, 4 * sizeof(float));
    mesh->vertex_capacity = capacity;
}

uint32_t mesh_vertex(struct mesh *mesh, vec3s position, vec3s normal, float u, float v)
{
    vertices_reserve(mesh);
    const uint32_t at = mesh->vertex_count++;
    const vec3s p = glms_mat4_mulv3(mesh->transform, position, 1);
    const vec3s n = glms_vec3_normalize(glms_mat4_mulv3(mesh->transform, normal, 0));
    for (uint32_t i = 0; i < 3; i++) {
        mesh->positions[3 * at + i] = p.raw[i];
        mesh->normals[3 * at + i] = n.raw[i];
        mesh->colors[4 * at + i] = mesh->color.raw[i];
    }
    mesh->colors[4 * at + 3] = 1;
    mesh->uvs[2 * at] = u;
    mesh->uvs[2 * at + 1] = v;
    return at;
}

void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    if (mesh->index_count + 3 > mesh->index_capacity) {
        mesh->index_capacity = mesh->index_capacity ? mesh->index_capacity * 2 : 96;
        mesh->indices = grow(mesh->indices, mesh->index_capacity, sizeof(uint32_t));
    }
    mesh->indices[mesh->index_count++] = a;
    mesh->indices[mesh->index_count++] = b;
    mesh->indices[mesh->index_count++] = c;
}

static vec3s face_normal(vec3s a, vec3s b, vec3s c)
{
    return glms_vec3_normalize(glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a)));
}

/* Projects along the dominant axis of the normal; v grows downwards, as rows of a texture do. */
static uint32_t vertex_projected(struct mesh *mesh, vec3s p, vec3s n)
{
    const float k = mesh->uv_per_m;
    if (fabsf(n.y) > fabsf(n.x) && fabsf(n.y) > fabsf(n.z))
        return mesh_vertex(mesh, p, n, p.x * k, p.z * k);
    if (fabsf(n.x) > fabsf(n.z))
        return mesh_vertex(mesh, p, n, (n.x > 0 ? -p.z : p.z) * k, -p.y * k);
    return mesh_vertex(mesh, p, n, (n.z > 0 ? p.x : -p.x) * k, -p.y * k);
}

void mesh_quad(struct mesh *mesh, vec3s a, vec3s b, vec3s c, vec3s d)
{
    const vec3s n = face_normal(a, b, c);
    const uint32_t first = vertex_projected(mesh, a, n);
    vertex_projected(mesh, b, n);
    vertex_projected(mesh, c, n);
    vertex_projected(mesh, d, n);
    mesh_triangle(mesh, first, first + 1, first + 2);
    mesh_triangle(mesh, first, first + 2, first + 3);
}

void mesh_card(struct mesh *mesh, vec3s a, vec3s b, vec3s c, vec3s d, vec3s normal)
{
    const uint32_t first = mesh_vertex(mesh, a, normal, 0, 1);
    mesh_vertex(mesh, b, normal, 1, 1);
    mesh_vertex(mesh, c, normal, 1, 0);
    mesh_vertex(mesh, d, normal, 0, 0);
    mesh_triangle(mesh, first, first + 1, first + 2);
    mesh_triangle(mesh, first, first + 2, first + 3);
}

void mesh_face3(struct mesh *mesh, vec3s a, vec3s b, vec3s c)
{
    const vec3s n = face_normal(a, b, c);
    const uint32_t first = vertex_projected(mesh, a, n);
    vertex_projected(mesh, b, n);
    vertex_projected(mesh, c, n);
    mesh_triangle(mesh, first, first + 1, first + 2);
}

void mesh_box(struct mesh *mesh, vec3s low, vec3s high)
{
    const float x0 = low.x, y0 = low.y, z0 = low.z, x1 = high.x, y1 = high.y, z1 = high.z;
    mesh_quad(mesh, v3(x1, y0, z1), v3(x1, y0, z0), v3(x1, y1, z0), v3(x1, y1, z1));
    mesh_quad(mesh, v3(x0, y0, z0), v3(x0, y0, z1), v3(x0, y1, z1), v3(x0, y1, z0));
    mesh_quad(mesh, v3(x0, y1, z1), v3(x1, y1, z1), v3(x1, y1, z0), v3(x0, y1, z0));
    mesh_quad(mesh, v3(x0, y0, z0), v3(x1, y0, z0), v3(x1, y0, z1), v3(x0, y0, z1));
    mesh_quad(mesh, v3(x0, y0, z1), v3(x1, y0, z1), v3(x1, y1, z1), v3(x0, y1, z1));
    mesh_quad(mesh, v3(x1, y0, z0), v3(x0, y0, z0), v3(x0, y1, z0), v3(x1, y1, z0));
}

void mesh_room(struct mesh *mesh, vec3s low, vec3s high)
{
    const uint32_t first_vertex = mesh->vertex_count, first_index = mesh->index_count;
    mesh_box(mesh, low, high);
    for (uint32_t i = 3 * first_vertex; i < 3 * mesh->vertex_count; i++)
        mesh->normals[i] = -mesh->normals[i];
    for (uint32_t i = first_index; i < mesh->index_count; i += 3) {
        const uint32_t swapped = mesh->indices[i + 1];
        mesh->indices[i + 1] = mesh->indices[i + 2];
        mesh->indices[i + 2] = swapped;
    }
}

void mesh_cylinder(struct mesh *mesh, vec3s foot, float foot_radius, float top_radius, float height,
                   uint32_t segments)
{
    const vec3s top = v3(foot.x, foot.y + height, foot.z);
    const float slope = (foot_radius - top_radius) / height;
    const uint32_t first = mesh->vertex_count;
    for (uint32_t i = 0; i <= segments; i++) {
        const float angle = (float)i / (float)segments * 2 * GLM_PIf, c = cosf(angle), s = sinf(angle);
        const float u = (float)i / (float)segments * 2 * GLM_PIf * foot_radius * mesh->uv_per_m;
        const vec3s n = v3(c, slope, s);
        mesh_vertex(mesh, v3(foot.x + foot_radius * c, foot.y, foot.z + foot_radius * s), n, u, 0);
        mesh_vertex(mesh, v3(top.x + top_radius * c, top.y, top.z + top_radius * s), n, u,
                    -height * mesh->uv_per_m);
    }
    for (uint32_t i = first; i < first + 2 * segments; i += 2) {
        mesh_triangle(mesh, i, i + 1, i + 2);
        mesh_triangle(mesh, i + 1, i + 3, i + 2);
    }
    for (uint32_t i = 0; i < segments; i++) {
        const float a = (float)i / (float)segments * 2 * GLM_PIf,
                    b = (float)(i + 1) / (float)segments * 2 * GLM_PIf;
        const vec3s da = v3(cosf(a), 0, sinf(a)), db = v3(cosf(b), 0, sinf(b));
        mesh_face3(mesh, foot, glms_vec3_add(foot, glms_vec3_scale(da, foot_radius)),
                   glms_vec3_add(foot, glms_vec3_scale(db, foot_radius)));
        if (top_radius > 0)
            mesh_face3(mesh, top, glms_vec3_add(top, glms_vec3_scale(db, top_radius)),
                       glms_vec3_add(top, glms_vec3_scale(da, top_radius)));
    }
}

void mesh_sphere(struct mesh *mesh, vec3s center, float radius, uint32_t segments)
{
    const uint32_t rings = segments / 2, row = segments + 1, first = mesh->vertex_count;
    for (uint32_t j = 0; j <= rings; j++)
        for (uint32_t i = 0; i <= segments; i++) {
            const float u = (float)i / (float)segments, v = (float)j / (float)rings;
            const float around = u * 2 * GLM_PIf, down = v * GLM_PIf;
            const vec3s n = v3(sinf(down) * cosf(around), cosf(down), -sinf(down) * sinf(around));
            mesh_vertex(mesh, glms_vec3_add(center, glms_vec3_scale(n, radius)), n, u, v);
        }
    for (uint32_t j = 0; j < rings; j++)
        for (uint32_t i = 0; i < segments; i++) {
            const uint32_t a = first + j * row + i, b = a + row;
            if (j > 0)
                mesh_triangle(mesh, a, b, a + 1);
            if (j + 1 < rings)
                mesh_triangle(mesh, a + 1, b, b + 1);
        }
}

mat4s placement(vec3s position, float yaw_rad, float scale)
{
    const mat4s moved = glms_translate(glms_mat4_identity(), position);
    return glms_scale_uni(glms_rotate(moved, yaw_rad, v3(0, 1, 0)), scale);
}

struct glb_primitive mesh_primitive(const struct mesh *mesh, glb_handle material, bool colored)
{
    return (struct glb_primitive){ .vertex_count = mesh->vertex_count,
                                   .index_count = mesh->index_count,
                                   .positions = mesh->positions,
                                   .normals = mesh->normals,
                                   .uvs = mesh->uvs,
                                   .colors = colored ? mesh->colors : NULL,
                                   .indices = mesh->indices,
                                   .material = material };
}
