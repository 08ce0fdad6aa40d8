/* SPDX-License-Identifier: MIT
 * The same triangles give the same volumes however they are described, placed and drawn, and bad ones give
 * nothing (HARD_CASES rows 14 to 16, 25, 26 and 65). */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const float identity[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
static const double zero[3] = { 0, 0, 0 };

/* Equality needs no fine grid: 32 cells of half a metre. */
static struct sdfgi_settings coarse_settings(void)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.min_cell_size_m = 0.5f;
    return settings;
}

/* Positions in steps of 2^-10 m: transforms by small powers of two are exact in float. */
static struct test_mesh snapped(struct test_mesh mesh)
{
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; i++)
        mesh.positions[i] = (float)(round((double)mesh.positions[i] * 1024) / 1024);
    return mesh;
}

static struct test_mesh torus(void)
{
    double turned[9];
    test_rotation((double[]){ 3, 1, 2 }, 0.6, turned);
    return snapped(test_mesh_torus((double[]){ 0.3, -0.2, 0.1 }, 3, 1.2, turned, 40, 20));
}

static struct pass_volumes volumes_of(const struct test_mesh *mesh)
{
    const struct sdfgi_settings settings = coarse_settings();
    pass_scene_open(&pass_context, &settings, mesh);
    const struct pass_volumes v = pass_volumes_read(&pass_context);
    return v;
}

/* ---- Placement */

static void hard_65_mirrored_and_sheared_instances_set_the_baked_meshs_bits(void **state)
{
    (void)state;
    static const float bases[3][9] = { { -1, 0, 0, 0, 1, 0, 0, 0, 1 },
                                       { 0, 0, 1, 0, -1, 0, -1, 0, 0 },
                                       { 1, 0, 0.5f, -0.25f, 0.5f, 0, 0, 0.125f, -1 } };
    const double translation[3] = { 0.5, -1.25, 0.75 };
    for (int i = 0; i < 3; i++) {
        struct test_mesh mesh = torus(), baked = torus();
        double basis[9];
        for (int k = 0; k < 9; k++)
            basis[k] = (double)bases[i][k];
        test_mesh_transform(&baked, basis, translation);
        test_mesh_invert(&baked); /* all three mirror */
        struct pass_volumes expected = volumes_of(&baked);
        const struct sdfgi_settings settings = coarse_settings();
        gi_test_renew(&pass_context, &settings);
        pass_scene_place(&pass_context, gi_test_mesh(&pass_context, &mesh), bases[i], translation);
        gi_test_update(&pass_context, 1);
        struct pass_volumes placed = pass_volumes_read(&pass_context);
        HARD_CASE_AT_MOST(65, "bytes not those of the baked mesh", pass_volumes_differ(&placed, &expected),
                          0);
        pass_volumes_destroy(&placed);
        pass_volumes_destroy(&expected);
        test_mesh_destroy(&mesh);
        test_mesh_destroy(&baked);
    }
}

static void hard_65_a_transform_to_a_line_leaves_nothing(void **state)
{
    (void)state;
    static const float nothing[9] = { [4] = 1 };
    struct test_mesh mesh = torus();
    const struct sdfgi_settings settings = coarse_settings();
    gi_test_renew(&pass_context, &settings);
    pass_scene_place(&pass_context, gi_test_mesh(&pass_context, &mesh), nothing, zero);
    gi_test_update(&pass_context, 1);
    struct oracle_bits bits = gi_test_bits(&pass_context, 0);
    HARD_CASE_AT_MOST(65, "bits of a transform to a line", oracle_bits_count(&bits), 0);
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&mesh);
}

/* Bits and distances in cell space with scene and camera moved by whole cells. */
static void read_moved(const double cells[static 3], struct oracle_bits *bits, float **distances)
{
    const struct sdfgi_settings settings = coarse_settings();
    double translation[3];
    for (int i = 0; i < 3; i++)
        translation[i] = cells[i] * (double)settings.min_cell_size_m;
    struct test_mesh mesh = torus();
    gi_test_renew(&pass_context, &settings);
    pass_scene_place(&pass_context, gi_test_mesh(&pass_context, &mesh), identity, translation);
    pass_scene_stand(&pass_context, translation);
    gi_test_update(&pass_context, 1);
    *bits = gi_test_bits(&pass_context, 0);
    *distances = gi_test_distances(&pass_context, 0);
    test_mesh_destroy(&mesh);
}

static void hard_25_far_and_negative_places_give_the_same_bits(void **state)
{
    (void)state;
    /* 128 k cells, 10^7 m and beyond 32 bits of cells; none a multiple of the resolution on all axes. */
    static const double moves[4][3] = { { -131072, 131072 + 8, -131072 - 24 },
                                        { 40, -8, -72 },
                                        { 40000000, -40000000, 40000008 },
                                        { -34359738368.0, 34359738368.0, -34359738376.0 } };
    struct oracle_bits expected, moved;
    float *expected_distances, *moved_distances;
    read_moved(zero, &expected, &expected_distances);
    REQUIRE_CMP(oracle_bits_count(&expected), >, 5000);
    for (int i = 0; i < 4; i++) {
        read_moved(moves[i], &moved, &moved_distances);
        HARD_CASE_AT_MOST(
            25, "bits that differ",
            oracle_bits_missing(&expected, &moved, NULL) + oracle_bits_missing(&moved, &expected, NULL), 0);
        REQUIRE_BYTES(moved_distances, expected_distances, sizeof(float) * 32 * 32 * 32);
        oracle_bits_destroy(&moved);
        free(moved_distances);
    }
    oracle_bits_destroy(&expected);
    free(expected_distances);
}

/* ---- Buffers */

/* A mesh whose buffers are laid out in some other way. */
struct layout {
    uint32_t stride;      /* floats between vertices */
    uint32_t vertex_skip; /* floats before the first */
    uint32_t index_skip;  /* words before the first */
    uint32_t index_size;  /* 0: none, 2 or 4 */
};

static struct gpu_test_buffer positions_buffer(struct gi_test *t, const struct test_mesh *mesh,
                                               const struct layout *l)
{
    const uint32_t count = l->index_size ? mesh->vertex_count : 3 * mesh->triangle_count;
    float *data = test_array_alloc(l->vertex_skip + (size_t)l->stride * count, sizeof *data);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t vertex = l->index_size ? i : mesh->indices[i];
        memcpy(data + l->vertex_skip + (size_t)l->stride * i, mesh->positions + 3 * (size_t)vertex, 12);
    }
    const struct gpu_test_buffer buffer =
        gpu_test_buffer_device(&t->gpu, 4 * (l->vertex_skip + (VkDeviceSize)l->stride * count),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    free(data);
    return buffer;
}

static struct gpu_test_buffer index_buffer(struct gi_test *t, const struct test_mesh *mesh,
                                           const struct layout *l)
{
    const uint32_t count = 3 * mesh->triangle_count;
    uint32_t *data = test_array_alloc(l->index_skip + count, sizeof *data);
    for (uint32_t i = 0; i < count; i++)
        if (l->index_size == 4)
            data[l->index_skip + i] = mesh->indices[i];
        else
            data[l->index_skip + i / 2] |= mesh->indices[i] << (i & 1 ? 16 : 0);
    const struct gpu_test_buffer buffer = gpu_test_buffer_device(
        &t->gpu, 4 * (VkDeviceSize)(l->index_skip + count), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    free(data);
    return buffer;
}

static void require_layout_reads(const struct layout *l, const struct test_mesh *mesh,
                                 const struct pass_volumes *expected)
{
    const struct sdfgi_settings settings = coarse_settings();
    gi_test_renew(&pass_context, &settings);
    pass_context.buffers[pass_context.buffer_count++] = positions_buffer(&pass_context, mesh, l);
    struct sdfgi_mesh_desc desc = { .position_buffer = pass_context.buffers[0].buffer,
                                    .position_offset = 4 * l->vertex_skip,
                                    .position_stride = 4 * l->stride,
                                    .vertex_count =
                                        l->index_size ? mesh->vertex_count : 3 * mesh->triangle_count,
                                    .triangle_count = mesh->triangle_count };
    if (l->index_size) {
        pass_context.buffers[pass_context.buffer_count++] = index_buffer(&pass_context, mesh, l);
        desc.index_buffer = pass_context.buffers[1].buffer;
        desc.index_offset = 4 * l->index_skip;
        desc.index_type = l->index_size == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32;
    }
    test_mesh_bounds(mesh, desc.bounds_min, desc.bounds_max);
    sdfgi_mesh handle;
    REQUIRE_CMP(sdfgi_mesh_create(pass_context.gi, &desc, &handle), ==, SDFGI_OK);
    pass_scene_place(&pass_context, handle, identity, zero);
    gi_test_update(&pass_context, 1);
    struct pass_volumes read = pass_volumes_read(&pass_context);
    pass_volumes_require_equal(&read, expected);
    pass_volumes_destroy(&read);
}

static void buffers_of_every_layout_give_the_same_volumes(void **state)
{
    (void)state;
    static const struct layout layouts[] = {
        { 3, 0, 0, 2 }, { 3, 5, 7, 2 }, { 8, 1, 3, 4 }, { 3, 0, 0, 0 }, { 5, 2, 0, 0 }
    };
    struct test_mesh mesh = torus();
    struct pass_volumes expected = volumes_of(&mesh);
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        require_layout_reads(&layouts[i], &mesh, &expected);
    pass_volumes_destroy(&expected);
    test_mesh_destroy(&mesh);
}

/* ---- Bad triangles */

static void append_triangle(struct test_mesh *mesh, const float corners[static 9])
{
    const struct test_mesh one = { (float *)(uintptr_t)corners, (uint32_t[]){ 0, 1, 2 }, 3, 1 };
    test_mesh_append(mesh, &one);
}

enum { SKIPPED_TRIANGLES = 8 };

/* Eight triangles that are skipped and counted, four without area, which are only skipped, and all good ones
 * once more: means are the same. */
static struct test_mesh spoiled(const struct test_mesh *good)
{
    const float bad[] = { NAN, INFINITY, -INFINITY, 1e30f, -3e38f, 1e12f };
    struct test_mesh mesh = { 0 };
    test_mesh_append(&mesh, good);
    test_mesh_append(&mesh, good);
    for (int i = 0; i < 6; i++) {
        float corners[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
        corners[(4 * i) % 9] = bad[i];
        append_triangle(&mesh, corners);
    }
    append_triangle(&mesh, (float[9]){ 1, 1, 1, 1, 1, 1, 1, 1, 1 });
    append_triangle(&mesh, (float[9]){ 0, 0, 0, 1, 0, 0, 3, 0, 0 });
    append_triangle(&mesh, (float[9]){ -2, -2, -2, 1, 1, 1, 0, 0, 0 });
    append_triangle(&mesh, (float[9]){ 0, 1, 2, 0.5f, 1.5f, 2, 0, 1, 2 });
    for (int i = 0; i < 2; i++)
        append_triangle(&mesh, (float[9]){ 0, 0, 0, 1, 0, 0, 0, 1, 0 });
    mesh.indices[3 * mesh.triangle_count - 1] = mesh.vertex_count;
    mesh.indices[3 * mesh.triangle_count - 5] = UINT32_MAX;
    return mesh;
}

/* A mesh with bad triangles claims the bounds of its good ones, as an importer would. */
static void open_spoiled(struct gi_test *t, const struct sdfgi_settings *settings,
                         const struct test_mesh *good)
{
    struct test_mesh mesh = spoiled(good);
    gi_test_renew(t, settings);
    const struct layout plain = { 3, 0, 0, 4 };
    t->buffers[t->buffer_count++] = positions_buffer(t, &mesh, &plain);
    t->buffers[t->buffer_count++] = index_buffer(t, &mesh, &plain);
    struct sdfgi_mesh_desc desc = { .position_buffer = t->buffers[0].buffer,
                                    .index_buffer = t->buffers[1].buffer,
                                    .index_type = VK_INDEX_TYPE_UINT32,
                                    .vertex_count = mesh.vertex_count,
                                    .triangle_count = mesh.triangle_count };
    test_mesh_bounds(good, desc.bounds_min, desc.bounds_max);
    sdfgi_mesh handle;
    REQUIRE_CMP(sdfgi_mesh_create(t->gi, &desc, &handle), ==, SDFGI_OK);
    pass_scene_place(t, handle, identity, zero);
    gi_test_update(t, 4);
    test_mesh_destroy(&mesh);
}

static void require_bad_triangles_are_skipped(enum sdfgi_voxelizer voxelizer)
{
    struct sdfgi_settings settings = coarse_settings();
    settings.voxelizer = voxelizer;
    struct test_mesh good = torus();
    struct pass_volumes expected = volumes_of(&good);
    open_spoiled(&pass_context, &settings, &good);
    struct pass_volumes read = pass_volumes_read(&pass_context);
    HARD_CASE_AT_MOST(14, "bytes not those of the scene without them", pass_volumes_differ(&read, &expected),
                      0);
    HARD_CASE_AT_MOST(
        14, "bad triangles less those counted",
        fabs((double)pass_health_count(&pass_context, SDFGI_MESSAGE_TRIANGLES_SKIPPED) - SKIPPED_TRIANGLES),
        0);
    pass_volumes_destroy(&read);
    pass_volumes_destroy(&expected);
    test_mesh_destroy(&good);
}

static void hard_14_bad_triangles_are_skipped_and_counted(void **state)
{
    (void)state;
    require_bad_triangles_are_skipped(SDFGI_VOXELIZER_COMPUTE);
}

static void hard_14_raster_skips_and_counts_them_too(void **state)
{
    (void)state;
    if (!pass_raster_is_available())
        skip();
    require_bad_triangles_are_skipped(SDFGI_VOXELIZER_RASTER);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_65_mirrored_and_sheared_instances_set_the_baked_meshs_bits),
        cmocka_unit_test(hard_65_a_transform_to_a_line_leaves_nothing),
        cmocka_unit_test(hard_25_far_and_negative_places_give_the_same_bits),
        cmocka_unit_test(buffers_of_every_layout_give_the_same_volumes),
        cmocka_unit_test(hard_14_bad_triangles_are_skipped_and_counted),
        cmocka_unit_test(hard_14_raster_skips_and_counts_them_too),
    };
    return cmocka_run_group_tests_name("voxel_input", tests, NULL, pass_context_close);
}
