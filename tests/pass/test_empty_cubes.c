/* SPDX-License-Identifier: MIT
 * Cubes of empty cells, by which rays on GPUs cross the air, against all cells of a cascade one by one. */
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include "shaders/shared/constants.h"

#include <stdio.h>
#include <stdlib.h>

enum { OCTANTS = 8 };

/* Sizes of cubes, N^3 for each octant. */
struct cubes {
    uint32_t n;
    uint8_t *sizes;
};

static uint8_t *cube_at(const struct cubes *cubes, uint32_t octant, uint32_t x, uint32_t y, uint32_t z)
{
    const size_t n = cubes->n;
    return &cubes->sizes[((octant * n + z) * n + y) * n + x];
}

static bool cell_is_occupied(const struct oracle_bits *bits, uint32_t x, uint32_t y, uint32_t z)
{
    for (uint32_t i = 0; i < 64; i++)
        if (oracle_bits_get(bits, 4 * x + (i & 3), 4 * y + (i >> 2 & 3), 4 * z + (i >> 4)))
            return true;
    return false;
}

/* The cube at the next cell along some axes of an octant: the largest beyond the cascade. */
static uint32_t next_size(const struct cubes *cubes, uint32_t octant, const uint32_t cell[static 3],
                          uint32_t axes)
{
    uint32_t next[3];
    for (uint32_t k = 0; k < 3; k++) {
        next[k] = cell[k] + ((axes >> k & 1) == 0 ? 0 : (octant >> k & 1) != 0 ? UINT32_MAX : 1);
        if (next[k] >= cubes->n)
            return SDFGI_LARGEST_CUBE;
    }
    return *cube_at(cubes, octant, next[0], next[1], next[2]);
}

/* One cell more than the smallest of the seven cubes behind the cell's own faces, edges and corner. */
static uint8_t size_at(const struct cubes *cubes, uint32_t octant, const uint32_t cell[static 3])
{
    uint32_t least = SDFGI_LARGEST_CUBE - 1;
    for (uint32_t axes = 1; axes < 8; axes++) {
        const uint32_t size = next_size(cubes, octant, cell, axes);
        least = size < least ? size : least;
    }
    return (uint8_t)(least + 1);
}

static void fill_octant(const struct cubes *cubes, uint32_t octant, const struct oracle_bits *bits)
{
    const uint32_t n = cubes->n;
    for (uint32_t i = 0; i < n * n * n; i++) {
        const uint32_t along[3] = { i % n, i / n % n, i / n / n };
        uint32_t cell[3]; /* those behind it come first */
        for (int k = 0; k < 3; k++)
            cell[k] = octant >> k & 1 ? along[k] : n - 1 - along[k];
        *cube_at(cubes, octant, cell[0], cell[1], cell[2]) =
            cell_is_occupied(bits, cell[0], cell[1], cell[2]) ? 0 : size_at(cubes, octant, cell);
    }
}

/* Sizes that some cell has, a bit each. */
static uint64_t require_octant(const struct cubes *cubes, uint32_t (*cells)[2], uint32_t cascade,
                               uint32_t octant)
{
    const uint32_t n = cubes->n;
    uint64_t sizes = 0;
    for (uint32_t i = 0; i < n * n * n; i++) {
        const uint32_t x = i % n, y = i / n % n, z = i / n / n,
                       *cell = cells[gi_test_cell(&pass_context, cascade, x, y, z)],
                       size = cell[1] == SDFGI_CUBES_MARK ? cell[0] >> 4 * octant & 15 : 0,
                       expected = *cube_at(cubes, octant, x, y, z);
        if (size != expected)
            require_fail(__FILE__, __LINE__, "octant %u of cell %u, %u, %u in cascade %u: %u instead of %u",
                         (unsigned)octant, (unsigned)x, (unsigned)y, (unsigned)z, (unsigned)cascade,
                         (unsigned)size, (unsigned)expected);
        sizes |= UINT64_C(1) << expected;
    }
    return sizes;
}

static void require_cubes(uint32_t cascade)
{
    struct oracle_bits bits = gi_test_bits(&pass_context, cascade);
    struct cubes cubes = { .n = bits.size / 4 };
    cubes.sizes = test_array_alloc(OCTANTS, (uint64_t)cubes.n * cubes.n * cubes.n);
    uint64_t sizes = 0;
    uint32_t(*cells)[2] = gi_test_read(&pass_context, RESOURCE_BITS, NULL);
    for (uint32_t octant = 0; octant < OCTANTS; octant++) {
        fill_octant(&cubes, octant, &bits);
        sizes |= require_octant(&cubes, cells, cascade, octant);
    }
    REQUIRE_CMP(sizes, ==, (UINT64_C(2) << SDFGI_LARGEST_CUBE) - 1); /* all, and 0 */
    free(cells);
    free(cubes.sizes);
    oracle_bits_destroy(&bits);
}

static void cubes_are_the_largest_empty_ones(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.cascades = 2;
    struct test_mesh mesh = test_mesh_bumpy_sphere((double[]){ 0.61, -0.87, 1.19 }, 4, 0.3, 5);
    pass_scene_open(&pass_context, &settings, &mesh);
    test_mesh_destroy(&mesh);
    for (uint32_t c = 0; c < 2; c++)
        require_cubes(c);
}

/* Cells of a cascade that has scrolled lie elsewhere than where they are stored. */
static void cubes_follow_a_cascade_that_scrolls(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = gi_test_settings();
    struct test_mesh mesh = test_mesh_bumpy_sphere((double[]){ 2.11, 1.07, -2.19 }, 3, 0.2, 5);
    pass_scene_open(&pass_context, &settings, &mesh);
    test_mesh_destroy(&mesh);
    pass_scene_stand(&pass_context, (double[]){ 4.1, 2.2, -6.3 });
    gi_test_update(&pass_context, 30);
    require_cubes(0);
}

/* A patch in each of a cell's sub-voxels of z = 2 and 3 that have a bit in `subvoxels`; returns the bits of
 * these that the cell then has. */
static uint32_t upper_half_of_cell(uint32_t subvoxels)
{
    const double width = 0.0625, u[3] = { 0.1 * width, 0, 0 }, v[3] = { 0, 0.1 * width, 0 };
    struct test_mesh mesh = { 0 };
    for (uint32_t rest = subvoxels; rest; rest &= rest - 1) {
        const int bit = __builtin_ctz(rest);
        const double center[3] = { (bit % 4 + 0.5) * width, (bit / 4 % 4 + 0.5) * width,
                                   (bit / 16 + 2.6) * width };
        struct test_mesh patch = test_mesh_plane(center, u, v, 1);
        test_mesh_append(&mesh, &patch);
        test_mesh_destroy(&patch);
    }
    const struct sdfgi_settings settings = gi_test_settings();
    pass_scene_open(&pass_context, &settings, &mesh);
    test_mesh_destroy(&mesh);
    uint64_t *cells = gi_test_subvoxels(&pass_context);
    const uint64_t cell = cells[gi_test_cell(&pass_context, 0, 32, 32, 32)];
    free(cells);
    REQUIRE_CMP((uint32_t)cell, ==, 0u);
    return (uint32_t)(cell >> 32);
}

/* Sub-voxels can look like the mark of a cell that holds cubes: the cell gets one more, and no other does. */
static void chequered_cell_is_not_taken_for_empty(void **state)
{
    (void)state;
    const uint32_t mark = SDFGI_CUBES_MARK, all_but_one = mark & (mark - 1);
    REQUIRE_CMP(upper_half_of_cell(mark), ==, mark | SDFGI_CUBES_MARK_OTHER);
    REQUIRE_CMP(upper_half_of_cell(all_but_one), ==, all_but_one);
    REQUIRE_CMP(upper_half_of_cell(~SDFGI_CUBES_MARK_OTHER), ==, UINT32_MAX);
}

TEST_GROUP(empty_cubes)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_are_the_largest_empty_ones),
        cmocka_unit_test(cubes_follow_a_cascade_that_scrolls),
        cmocka_unit_test(chequered_cell_is_not_taken_for_empty),
    };
    return cmocka_run_group_tests_name("empty_cubes", tests, NULL, pass_context_close);
}
