/* SPDX-License-Identifier: MIT */
#include "voxel_scene.h"

#include "oracle_voxel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N = VOXEL_RESOLUTION, BLOCKS = N / 2, BLOCK_COUNT = BLOCKS * BLOCKS * BLOCKS };

/* Sums over what is set in a block. */
struct sums {
    double albedo[3], emission[3], slopes[3][2];
    uint32_t samples, emissive, normals[3];
    bool facing[6];
};

static void *zeroed(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    assert_non_null(memory);
    return memory;
}

/* Unit normal of a triangle. */
static void normal_of(const float p[3][3], double n[3])
{
    double a[3], b[3], length2 = 0;
    for (int k = 0; k < 3; k++) {
        a[k] = (double)p[1][k] - (double)p[0][k];
        b[k] = (double)p[2][k] - (double)p[0][k];
    }
    for (int k = 0; k < 3; k++) {
        n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        length2 += n[k] * n[k];
    }
    for (int k = 0; k < 3; k++)
        n[k] /= sqrt(length2);
}

static void sums_add(struct sums *s, const struct gltf_material *m, const double n[3])
{
    const int major = fabs(n[0]) >= fabs(n[1]) && fabs(n[0]) >= fabs(n[2]) ? 0
                      : fabs(n[1]) >= fabs(n[2])                           ? 1
                                                                           : 2;
    s->samples++;
    s->normals[major]++;
    for (int k = 0; k < 2; k++)
        s->slopes[major][k] += n[(major + 1 + k) % 3] / n[major];
    for (int k = 0; k < 3; k++) {
        s->albedo[k] += (double)m->base_color[k];
        s->emission[k] += (double)m->emissive[k];
    }
    if (!(m->emissive[0] > 0))
        return;
    s->emissive++;
    for (int axis = 0; axis < 6; axis++)
        s->facing[axis] = s->facing[axis] || n[axis / 2] * (axis % 2 == 0 ? 1 : -1) > 0.2;
}

static struct raycast_block block_from_sums(const struct sums *s)
{
    struct raycast_block b = { 0 };
    for (int k = 0; k < 3; k++) {
        const uint32_t count = s->normals[k];
        for (int axis = 0; axis < 6 && s->samples > 0; axis++)
            b.albedo[axis][k] = (uint16_t)lrint(1023 * s->albedo[k] / s->samples);
        if (s->emissive > 0)
            b.emission[k] = (float)(s->emission[k] / s->emissive);
        b.slopes[k][0] = RAYCAST_NO_SLOPE;
        for (int i = 0; i < 2 && count > 0; i++)
            b.slopes[k][i] = (int8_t)lrint(15 * s->slopes[k][i] / count);
    }
    for (int axis = 0; axis < 6; axis++)
        b.emitting[axis] = s->facing[axis] ? 31 : 0;
    return b;
}

/* Sets the sub-voxels of one triangle, and adds them to their blocks. */
static void add_triangle(const struct oracle_grid *grid, const float p[3][3], const struct gltf_material *m,
                         uint64_t *cells, struct sums *sums)
{
    uint32_t indices[3] = { 0, 1, 2 };
    float positions[9];
    memcpy(positions, p, sizeof positions);
    const struct test_mesh mesh = { positions, indices, 3, 1 };
    struct oracle_bits bits = oracle_bits_create(4 * N);
    double n[3];
    normal_of(p, n);
    struct test_mesh inset = oracle_voxel_inset(grid, &mesh, 0);
    oracle_voxel_separating(&bits, grid, m->emissive[0] > 0 ? &mesh : &inset, 0);
    test_mesh_destroy(&inset);
    for (uint32_t z = 0; z < 4 * N; z++)
        for (uint32_t y = 0; y < 4 * N; y++)
            for (uint32_t x = 0; x < 4 * N; x++) {
                if (!oracle_bits_get(&bits, x, y, z))
                    continue;
                cells[x / 4 + N * (y / 4 + N * (z / 4))] |= UINT64_C(1)
                                                            << (x % 4 + 4 * (y % 4) + 16 * (z % 4));
                sums_add(&sums[x / 8 + BLOCKS * (y / 8 + BLOCKS * (z / 8))], m, n);
            }
    oracle_bits_destroy(&bits);
}

static void add_primitive(const struct oracle_grid *grid, const struct built_scene *s,
                          const struct gltf_primitive *primitive, uint64_t *cells, struct sums *sums)
{
    for (uint32_t i = 0; i < primitive->index_count; i += 3) {
        float p[3][3];
        for (int k = 0; k < 3; k++)
            memcpy(p[k], primitive->positions + 3 * (size_t)primitive->indices[i + (uint32_t)k], sizeof p[k]);
        add_triangle(grid, (const float(*)[3])p, &s->materials[primitive->material], cells, sums);
    }
}

void voxel_scene_init(struct voxel_scene *v, const struct built_scene *s, double cell_m, double y_scale,
                      uint32_t cascades)
{
    *v = (struct voxel_scene){ .voxels.cascade_count = cascades };
    for (uint32_t c = 0; c < cascades; c++) {
        struct raycast_cascade *to = &v->voxels.cascades[c];
        struct oracle_grid grid;
        struct sums *sums = zeroed(BLOCK_COUNT, sizeof *sums);
        v->bits[c] = zeroed((size_t)N * N * N, sizeof *v->bits[c]);
        v->blocks[c] = zeroed(BLOCK_COUNT, sizeof *v->blocks[c]);
        *to = (struct raycast_cascade){ .resolution = N, .bits = v->bits[c], .blocks = v->blocks[c] };
        for (int k = 0; k < 3; k++) {
            to->cell_m[k] = ldexp(cell_m, (int)c) * (k == 1 ? y_scale : 1);
            to->low_m[k] = -N / 2 * to->cell_m[k];
            grid.origin[k] = to->low_m[k];
            grid.step[k] = to->cell_m[k] / 4;
        }
        for (uint32_t i = 0; i < s->gltf.primitive_count; i++)
            add_primitive(&grid, s, &s->primitives[i], v->bits[c], sums);
        for (int i = 0; i < BLOCK_COUNT; i++)
            v->blocks[c][i] = block_from_sums(&sums[i]);
        free(sums);
    }
}

void voxel_scene_finish(struct voxel_scene *v)
{
    for (int c = 0; c < RAYCAST_MAX_CASCADES; c++) {
        free(v->bits[c]);
        free(v->blocks[c]);
    }
}

void scene_add_mesh(struct built_scene *s, struct test_mesh mesh)
{
    const uint32_t vertices = 3 * mesh.triangle_count, index = s->gltf.primitive_count++;
    assert_true(index < SCENE_CAPACITY);
    struct gltf_primitive p = { .vertex_count = vertices,
                                .index_count = vertices,
                                .positions = zeroed(vertices, 3 * sizeof(float)),
                                .normals = zeroed(vertices, 3 * sizeof(float)),
                                .tangents = zeroed(vertices, 4 * sizeof(float)),
                                .uv0 = zeroed(vertices, 2 * sizeof(float)),
                                .indices = zeroed(vertices, sizeof(uint32_t)),
                                .material = (int32_t)s->gltf.material_count - 1 };
    for (uint32_t i = 0; i < vertices; i++) {
        memcpy(p.positions + 3 * (size_t)i, mesh.positions + 3 * (size_t)mesh.indices[i], 3 * sizeof(float));
        p.indices[i] = i;
    }
    for (uint32_t i = 0; i < vertices; i++) {
        double n[3];
        normal_of((const float(*)[3])(p.positions + 9 * (size_t)(i / 3)), n);
        for (int k = 0; k < 3; k++)
            p.normals[3 * (size_t)i + (size_t)k] = (float)n[k];
    }
    s->primitives[index] = p;
    struct gltf_instance *instance = &s->instances[s->gltf.instance_count++];
    *instance = (struct gltf_instance){ .primitive = index };
    for (int k = 0; k < 4; k++)
        instance->transform[5 * k] = 1;
    test_mesh_destroy(&mesh);
}
