/* SPDX-License-Identifier: MIT
 * The same triangles give the same volumes however they are described, placed and drawn, and bad ones give
 * nothing (HARD_CASES rows 14 to 16, 25, 26 and 65). */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
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
    uint32_t stride;       /* floats between vertices */
    uint32_t vertex_skip;  /* floats before the first */
    uint32_t index_size;   /* 0: none, 1, 2 or 4 */
    uint32_t index_skip;   /* bytes before the first */
    uint32_t first_index;  /* others before those of the mesh */
    int32_t vertex_offset; /* other vertices before those of the mesh; negative: added to indices */
};

static uint32_t vertices_of(const struct test_mesh *mesh, const struct layout *l)
{
    return l->index_size ? mesh->vertex_count : 3 * mesh->triangle_count;
}

/* Before the mesh's own. */
static uint32_t other_vertices(const struct layout *l)
{
    const int32_t count = l->vertex_offset + (l->index_size ? 0 : (int32_t)l->first_index);
    return count > 0 ? (uint32_t)count : 0;
}

static struct gpu_test_buffer positions_buffer(struct gi_test *t, const struct test_mesh *mesh,
                                               const struct layout *l)
{
    const uint32_t count = vertices_of(mesh, l), others = other_vertices(l);
    const size_t size = l->vertex_skip + (size_t)l->stride * (others + count);
    float *data = test_array_alloc(size, sizeof *data);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t vertex = l->index_size ? i : mesh->indices[i];
        memcpy(data + l->vertex_skip + (size_t)l->stride * (others + i), mesh->positions + 3 * (size_t)vertex,
               12);
    }
    const struct gpu_test_buffer buffer =
        gpu_test_buffer_device(&t->gpu, 4 * size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    free(data);
    return buffer;
}

static struct gpu_test_buffer index_buffer(struct gi_test *t, const struct test_mesh *mesh,
                                           const struct layout *l)
{
    const uint32_t count = l->first_index + 3 * mesh->triangle_count,
                   added = l->vertex_offset < 0 ? (uint32_t)-l->vertex_offset : 0;
    const size_t size = (l->index_skip + (size_t)count * l->index_size + 3) / 4 * 4;
    uint8_t *data = test_array_alloc(size, 1);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t index = i < l->first_index ? 77 : mesh->indices[i - l->first_index] + added;
        for (uint32_t k = 0; k < l->index_size; k++)
            data[l->index_skip + i * l->index_size + k] = (uint8_t)(index >> 8 * k);
    }
    const struct gpu_test_buffer buffer =
        gpu_test_buffer_device(&t->gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    free(data);
    return buffer;
}

static VkIndexType index_type_of(uint32_t size)
{
    return size == 1 ? VK_INDEX_TYPE_UINT8_EXT : (size == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
}

static struct sdfgi_mesh_desc describe(struct gi_test *t, const struct test_mesh *mesh,
                                       const struct test_mesh *bounded, const struct layout *l)
{
    struct sdfgi_mesh_desc desc = { .position_offset = 4 * l->vertex_skip,
                                    .position_stride = 4 * l->stride,
                                    .first_index = l->first_index,
                                    .vertex_offset = l->vertex_offset,
                                    .vertex_count = vertices_of(mesh, l) + other_vertices(l),
                                    .triangle_count = mesh->triangle_count };
    t->buffers[t->buffer_count] = positions_buffer(t, mesh, l);
    desc.position_buffer = t->buffers[t->buffer_count++].buffer;
    if (l->index_size) {
        t->buffers[t->buffer_count] = index_buffer(t, mesh, l);
        desc.index_buffer = t->buffers[t->buffer_count++].buffer;
        desc.index_offset = l->index_skip;
        desc.index_type = index_type_of(l->index_size);
    }
    test_mesh_bounds(bounded, desc.bounds_min, desc.bounds_max);
    return desc;
}

static void place_described(struct gi_test *t, const struct sdfgi_mesh_desc *desc)
{
    sdfgi_mesh handle;
    REQUIRE_CMP(sdfgi_mesh_create(t->gi, desc, &handle), ==, SDFGI_OK);
    pass_scene_place(t, handle, identity, zero);
}

static void require_layout_reads(const struct layout *l, enum sdfgi_voxelizer voxelizer,
                                 const struct test_mesh *mesh, const struct pass_volumes *expected)
{
    struct sdfgi_settings settings = coarse_settings();
    settings.voxelizer = voxelizer;
    gi_test_renew(&pass_context, &settings);
    const struct sdfgi_mesh_desc desc = describe(&pass_context, mesh, mesh, l);
    place_described(&pass_context, &desc);
    gi_test_update(&pass_context, 1);
    struct pass_volumes read = pass_volumes_read(&pass_context);
    if (pass_volumes_differ(&read, expected) > 0)
        require_fail(__FILE__, __LINE__, "indices of %u bytes at byte %u, from index %u on, plus %d",
                     l->index_size, l->index_skip, l->first_index, (int)l->vertex_offset);
    REQUIRE_CMP(pass_health_count(&pass_context, SDFGI_MESSAGE_TRIANGLES_SKIPPED), ==, 0ul);
    pass_volumes_destroy(&read);
}

/* Of less than 256 vertices. */
static struct test_mesh small_torus(void)
{
    return snapped(test_mesh_torus((double[]){ 0.3, -0.2, 0.1 }, 3, 1.2, test_rotation_none, 16, 12));
}

static void require_layouts_read(enum sdfgi_voxelizer voxelizer)
{
    static const struct layout layouts[] = {
        { 3, 0, 2, 0, 0, 0 },   { 3, 5, 2, 28, 0, 0 },     { 8, 1, 4, 12, 0, 0 },     { 3, 0, 0, 0, 0, 0 },
        { 5, 2, 0, 0, 0, 0 },   { 3, 0, 1, 0, 0, 0 },      { 3, 0, 1, 3, 0, 0 },      { 3, 0, 2, 2, 0, 0 },
        { 3, 0, 2, 7, 1, 0 },   { 3, 0, 4, 1, 0, 0 },      { 3, 0, 4, 4, 301, 0 },    { 3, 90, 1, 0, 5, 40 },
        { 4, 0, 1, 1, 2, -60 }, { 3, 0, 2, 0, 301, 1000 }, { 3, 0, 4, 0, 1, -70000 }, { 3, 1, 0, 0, 7, 0 },
        { 3, 1, 0, 0, 9, -3 },  { 3, 1, 0, 0, 0, 100 },
    };
    struct test_mesh mesh = small_torus();
    struct pass_volumes expected = volumes_of(&mesh);
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        require_layout_reads(&layouts[i], voxelizer, &mesh, &expected);
    pass_volumes_destroy(&expected);
    test_mesh_destroy(&mesh);
}

static void buffers_of_every_layout_give_the_same_volumes(void **state)
{
    (void)state;
    require_layouts_read(SDFGI_VOXELIZER_COMPUTE);
}

static void raster_reads_every_layout_too(void **state)
{
    (void)state;
    if (!pass_raster_is_available())
        skip();
    require_layouts_read(SDFGI_VOXELIZER_RASTER);
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
    const struct sdfgi_mesh_desc desc =
        describe(t, &mesh, good, &(struct layout){ .stride = 3, .index_size = 4 });
    place_described(t, &desc);
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

TEST_GROUP(voxel_input)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_65_mirrored_and_sheared_instances_set_the_baked_meshs_bits),
        cmocka_unit_test(hard_65_a_transform_to_a_line_leaves_nothing),
        cmocka_unit_test(hard_25_far_and_negative_places_give_the_same_bits),
        cmocka_unit_test(buffers_of_every_layout_give_the_same_volumes),
        cmocka_unit_test(raster_reads_every_layout_too),
        cmocka_unit_test(hard_14_bad_triangles_are_skipped_and_counted),
        cmocka_unit_test(hard_14_raster_skips_and_counts_them_too),
    };
    return cmocka_run_group_tests_name("voxel_input", tests, NULL, pass_context_close);
}
