/* SPDX-License-Identifier: MIT
 * Triangles far larger and far smaller than the volume, and both voxelisers (HARD_CASES rows 13, 15 and 16).
 */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct sdfgi_settings small_settings(void)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = getenv("SDFGI_TEST_FULL") ? 64 : 32;
    return settings;
}

/* ---- Tiny triangles */

/* Sub-voxel that a point in metres lies in. */
static void sub_voxel_of(const struct oracle_grid *grid, const double point[static 3], uint32_t sub[static 3])
{
    for (int i = 0; i < 3; i++)
        sub[i] = (uint32_t)((point[i] - grid->origin[i]) / grid->step[i]);
}

/* Triangles of 1e-4 sub-voxels, each alone in a sub-voxel, tilted in every way. */
static struct test_mesh specks(uint32_t count, double points[][3])
{
    struct test_random random = { 16 };
    struct test_mesh mesh = { 0 };
    const double sub = 0.0625, size = 1e-4 * sub;
    for (uint32_t i = 0; i < count; i++) {
        double u[3], v[3];
        test_random_direction(&random, u);
        test_random_direction(&random, v);
        const double lattice[3] = { i % 8 - 4.0, i / 8 % 8 - 4.0, i / 64 - 4.0 };
        float corners[9];
        for (int k = 0; k < 3; k++) {
            points[i][k] = (16 * lattice[k] + 8 + test_random_real(&random, 0.05, 0.95)) * sub;
            corners[k] = (float)points[i][k];
            corners[3 + k] = (float)(points[i][k] + size * u[k]);
            corners[6 + k] = (float)(points[i][k] + size * v[k]);
        }
        const struct test_mesh one = { corners, (uint32_t[]){ 0, 1, 2 }, 3, 1 };
        test_mesh_append(&mesh, &one);
    }
    return mesh;
}

enum { SPECKS = 512 };

/* Set, or set one sub-voxel further along one axis: a triangle that crosses no centre sets the sub-voxel of
 * its column at which its plane crosses, so that meshes of many tiny triangles stay one sub-voxel thick. */
static bool is_set_near(const struct oracle_bits *bits, const uint32_t sub[static 3])
{
    bool set = oracle_bits_get(bits, sub[0], sub[1], sub[2]);
    for (int i = 0; i < 6; i++) {
        uint32_t at[3] = { sub[0], sub[1], sub[2] };
        at[i / 2] += i & 1 ? 1u : UINT32_MAX;
        set = set || oracle_bits_get(bits, at[0], at[1], at[2]);
    }
    return set;
}

static void hard_16_every_tiny_triangle_sets_one_bit(void **state)
{
    (void)state;
    static double points[SPECKS][3];
    struct test_mesh mesh = specks(SPECKS, points);
    const struct sdfgi_settings settings = small_settings();
    pass_scene_open(&pass_context, &settings, &mesh);
    struct oracle_bits bits = gi_test_bits(&pass_context, 0);
    const struct oracle_grid grid = gi_test_grid(&pass_context, 0);
    uint32_t missing = 0;
    for (uint32_t i = 0; i < SPECKS; i++) {
        uint32_t sub[3];
        sub_voxel_of(&grid, points[i], sub);
        missing += !is_set_near(&bits, sub);
    }
    HARD_CASE_AT_MOST(16, "tiny triangles without a bit", missing, 0);
    HARD_CASE_AT_MOST(16, "bits off one a triangle", fabs((double)oracle_bits_count(&bits) - SPECKS), 0);
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&mesh);
}

/* ---- Huge triangles */

/* The plane a = height + slope b, where b is the axis after a, in cyclic order. It faces up along a. */
struct plane {
    int axis;
    double height, slope;
};

static struct test_mesh plane_mesh(const struct plane *plane, double half)
{
    const int a = plane->axis, b = (a + 1) % 3, c = (a + 2) % 3;
    double center[3] = { 0 }, edge_u[3] = { 0 }, edge_v[3] = { 0 };
    center[a] = plane->height;
    edge_u[b] = half;
    edge_u[a] = half * plane->slope;
    edge_v[c] = half;
    return test_mesh_plane(center, edge_u, edge_v, 1);
}

static bool bit_along(const struct oracle_bits *bits, int axis, const int64_t at[static 3])
{
    uint32_t sub[3];
    for (int k = 0; k < 3; k++)
        sub[(axis + k) % 3] = (uint32_t)at[k];
    return oracle_bits_get(bits, sub[0], sub[1], sub[2]);
}

/* Sub-voxels by which a column along the plane's axis misses it, at most. Every column must be set within a
 * sub-voxel of the plane, which lies half a sub-voxel lower for its inset, and nowhere else. */
static int64_t plane_error(const struct oracle_bits *bits, const struct oracle_grid *grid,
                           const struct plane *plane)
{
    const int64_t size = bits->size;
    const int a = plane->axis, b = (a + 1) % 3;
    int64_t worst = 0;
    for (int64_t i = 0; i < size * size; i++) {
        const double along = grid->origin[b] + ((double)(i % size) + 0.5) * grid->step[b];
        const int64_t wanted =
            (int64_t)floor((plane->height + plane->slope * along - grid->origin[a]) / grid->step[a] - 0.5);
        int64_t nearest = size;
        for (int64_t level = 0; level < size; level++) {
            if (!bit_along(bits, a, (int64_t[]){ level, i % size, i / size }))
                continue;
            nearest = llabs(level - wanted) < nearest ? llabs(level - wanted) : nearest;
            worst = llabs(level - wanted) > worst ? llabs(level - wanted) : worst;
        }
        worst = nearest > worst ? nearest : worst;
    }
    printf("plane across axis %d of slope %g: %lld sub-voxels off at most\n", a, plane->slope,
           (long long)worst);
    return worst;
}

static int64_t voxelized_plane_error(const struct plane *plane, const struct test_mesh *mesh)
{
    const struct sdfgi_settings settings = small_settings();
    pass_scene_open(&pass_context, &settings, mesh);
    struct oracle_bits bits = gi_test_bits(&pass_context, 0);
    const struct oracle_grid grid = gi_test_grid(&pass_context, 0);
    const int64_t error = plane_error(&bits, &grid, plane);
    oracle_bits_destroy(&bits);
    return error;
}

static void hard_15_huge_triangles_stay_within_a_sub_voxel(void **state)
{
    (void)state;
    static const double slopes[2] = { 0, 0.3 };
    for (int i = 0; i < 6; i++) {
        const struct plane plane = { i / 2, 0.53, slopes[i % 2] };
        struct test_mesh mesh = plane_mesh(&plane, 1e6);
        HARD_CASE_AT_MOST(15, "off the plane, sub-voxels", voxelized_plane_error(&plane, &mesh), 1);
        test_mesh_destroy(&mesh);
    }
}

/* A ground of two triangles in a mesh of many that a sub-voxel holds, as when a whole level is one mesh. */
static void two_large_triangles_among_many_small_ones_are_complete(void **state)
{
    (void)state;
    const struct plane plane = { 1, 0.53, 0 };
    const double beside[3] = { 8.5, -8, -8 }, far[3] = { 10, 8, 8 };
    struct test_mesh mesh = plane_mesh(&plane, 20);
    struct test_mesh others = test_mesh_soup(15, 100000, beside, far, 0.01);
    test_mesh_append(&mesh, &others);
    REQUIRE_CMP(voxelized_plane_error(&plane, &mesh), <=, 1);
    test_mesh_destroy(&others);
    test_mesh_destroy(&mesh);
}

/* ---- The raster voxeliser */

static void require_voxelizers_agree(struct test_mesh mesh, enum sdfgi_y_scale y_scale)
{
    struct pass_volumes volumes[2];
    for (int i = 0; i < 2; i++) {
        struct sdfgi_settings settings = small_settings();
        settings.voxelizer = (enum sdfgi_voxelizer)i;
        settings.y_scale = y_scale;
        pass_scene_open(&pass_context, &settings, &mesh);
        volumes[i] = pass_volumes_read(&pass_context);
    }
    pass_volumes_require_equal(&volumes[1], &volumes[0]);
    pass_volumes_destroy(&volumes[0]);
    pass_volumes_destroy(&volumes[1]);
    test_mesh_destroy(&mesh);
}

static void raster_voxelizer_gives_the_same_volumes(void **state)
{
    (void)state;
    if (!pass_raster_is_available())
        skip();
    static double points[SPECKS][3];
    const double center[3] = { 0.11, -0.07, 0.19 }, low[3] = { -9, -9, -9 }, high[3] = { 9, 9, 9 };
    double turned[9];
    test_rotation((double[]){ 1, 2, 3 }, 0.7, turned);
    require_voxelizers_agree(test_mesh_sphere(center, 3.6, 4), SDFGI_Y_SCALE_100);
    require_voxelizers_agree(test_mesh_box(center, (double[]){ 2.3, 2.6, 9.1 }, turned), SDFGI_Y_SCALE_75);
    require_voxelizers_agree(test_mesh_bumpy_sphere(center, 1.5, 0.2, 5), SDFGI_Y_SCALE_100);
    require_voxelizers_agree(test_mesh_soup(7, 600, low, high, 1.5), SDFGI_Y_SCALE_100);
    require_voxelizers_agree(specks(SPECKS, points), SDFGI_Y_SCALE_100);
}

/* Needles: the widened triangle that the raster voxeliser draws has its corners far out. */
static void raster_voxelizer_gives_the_same_needles(void **state)
{
    (void)state;
    if (!pass_raster_is_available())
        skip();
    struct test_random random = { 5 };
    struct test_mesh mesh = { 0 };
    for (int i = 0; i < 300; i++) {
        float corners[9];
        const double width = pow(10, test_random_real(&random, -6, -1));
        for (int k = 0; k < 3; k++) {
            corners[k] = (float)test_random_real(&random, -7, 7);
            corners[3 + k] = (float)test_random_real(&random, -7, 7);
            const double along = (double)(corners[k] + corners[3 + k]) / 2;
            corners[6 + k] = (float)(along + test_random_real(&random, -width, width));
        }
        const struct test_mesh one = { corners, (uint32_t[]){ 0, 1, 2 }, 3, 1 };
        test_mesh_append(&mesh, &one);
    }
    require_voxelizers_agree(mesh, SDFGI_Y_SCALE_100);
}

TEST_GROUP(voxel_extremes)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_15_huge_triangles_stay_within_a_sub_voxel),
        cmocka_unit_test(two_large_triangles_among_many_small_ones_are_complete),
        cmocka_unit_test(hard_16_every_tiny_triangle_sets_one_bit),
        cmocka_unit_test(raster_voxelizer_gives_the_same_volumes),
        cmocka_unit_test(raster_voxelizer_gives_the_same_needles),
    };
    return cmocka_run_group_tests_name("voxel_extremes", tests, NULL, pass_context_close);
}
