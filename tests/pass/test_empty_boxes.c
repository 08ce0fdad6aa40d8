/* SPDX-License-Identifier: MIT
 * Empty boxes, by which rays on GPUs cross the air, against all cells of a cascade one by one. */
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include "shaders/shared/boxes.h"

#include <stdio.h>
#include <stdlib.h>

enum { OCTANTS = 8, N = 32, SIDES = N + 1 };

static const uint32_t ranks[SDFGI_BOX_SIZES][4] = SDFGI_BOX_RANKS;

/* Occupied cells before each cell: sums[z][y][x] counts those below x, y and z. */
static uint32_t sums[SIDES][SIDES][SIDES];

static uint32_t cell_is_occupied(const struct oracle_bits *bits, uint32_t x, uint32_t y, uint32_t z)
{
    for (uint32_t i = 0; i < 64; i++)
        if (oracle_bits_get(bits, 4 * x + (i & 3), 4 * y + (i >> 2 & 3), 4 * z + (i >> 4)))
            return 1;
    return 0;
}

static void sum_cells(uint32_t cascade)
{
    struct oracle_bits bits = gi_test_bits(&pass_context, cascade);
    REQUIRE_CMP(bits.size, ==, 4u * N);
    for (uint32_t z = 0; z < N; z++)
        for (uint32_t y = 0; y < N; y++)
            for (uint32_t x = 0; x < N; x++)
                sums[z + 1][y + 1][x + 1] = cell_is_occupied(&bits, x, y, z) + sums[z][y + 1][x + 1] +
                                            sums[z + 1][y][x + 1] + sums[z + 1][y + 1][x] -
                                            sums[z][y][x + 1] - sums[z][y + 1][x] - sums[z + 1][y][x] +
                                            sums[z][y][x];
    oracle_bits_destroy(&bits);
}

/* Occupied cells of a box that begins at a cell and leads into an octant. */
static uint32_t occupied_in(const int cell[static 3], uint32_t octant, const int sides[static 3])
{
    int low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = octant >> k & 1 ? cell[k] + 1 - sides[k] : cell[k];
        high[k] = low[k] + sides[k];
        low[k] = low[k] < 0 ? 0 : low[k];
        high[k] = high[k] > N ? N : high[k];
    }
    uint32_t count = 0;
    for (int i = 0; i < 8; i++) {
        const uint32_t at =
            sums[i & 4 ? low[2] : high[2]][i & 2 ? low[1] : high[1]][i & 1 ? low[0] : high[0]];
        count += __builtin_popcount((unsigned)i) & 1 ? 0 - at : at;
    }
    return count;
}

/* A size, and above it a bit for each axis along which the side is twice as long. */
static uint32_t rank_of(uint32_t box)
{
    return box ? ranks[(box & 7) - 1][__builtin_popcount(box >> 3)] : 0;
}

static bool is_empty(const int cell[static 3], uint32_t octant, uint32_t box)
{
    int sides[3];
    for (int k = 0; k < 3; k++)
        sides[k] = (int)((box & 7) << (box >> (3 + k) & 1));
    return occupied_in(cell, octant, sides) == 0;
}

static uint32_t best_rank(const int cell[static 3], uint32_t octant)
{
    uint32_t best = 0;
    for (uint32_t box = 1; box < 64; box++)
        if ((box & 7) != 0 && rank_of(box) > best && is_empty(cell, octant, box))
            best = rank_of(box);
    return best;
}

static uint32_t stored_box(const uint32_t words[static 2], uint32_t octant)
{
    return (words[1] & SDFGI_BOXES_MASK) == SDFGI_BOXES_MARK
               ? (words[0] >> 4 * octant & 15) | (words[1] >> 2 * octant & 3) << 4
               : 0;
}

/* Boxes that some cell has, a bit each. */
static uint64_t require_octant(uint32_t (*words)[2], uint32_t cascade, uint32_t octant)
{
    uint64_t seen = 0;
    for (int i = 0; i < N * N * N; i++) {
        const int cell[3] = { i % N, i / N % N, i / N / N };
        const uint32_t box = stored_box(words[gi_test_cell(&pass_context, cascade, (uint32_t)cell[0],
                                                           (uint32_t)cell[1], (uint32_t)cell[2])],
                                        octant),
                       best = best_rank(cell, octant);
        if (rank_of(box) != best || (box && !is_empty(cell, octant, box)))
            require_fail(__FILE__, __LINE__, "octant %u of cell %d, %d, %d in cascade %u: 0x%x of rank %u",
                         (unsigned)octant, cell[0], cell[1], cell[2], (unsigned)cascade, (unsigned)box,
                         (unsigned)best);
        seen |= UINT64_C(1) << box;
    }
    return seen;
}

/* Returns how many boxes of different sides there are. */
static int require_boxes(uint32_t cascade)
{
    sum_cells(cascade);
    uint64_t seen = 0;
    uint32_t(*words)[2] = gi_test_read(&pass_context, RESOURCE_BITS, NULL);
    for (uint32_t octant = 0; octant < OCTANTS; octant++)
        seen |= require_octant(words, cascade, octant);
    free(words);
    return __builtin_popcountll(seen);
}

static struct sdfgi_settings settings_with(uint32_t cascades)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = N;
    settings.cascades = cascades;
    return settings;
}

static void boxes_are_the_best_empty_ones(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = settings_with(2);
    struct test_mesh mesh = test_mesh_bumpy_sphere((double[]){ 0.61, -0.87, 1.19 }, 4, 0.3, 5);
    pass_scene_open(&pass_context, &settings, &mesh);
    test_mesh_destroy(&mesh);
    int seen = 0;
    for (uint32_t c = 0; c < 2; c++)
        seen += require_boxes(c);
    REQUIRE_CMP(seen, >, 57); /* all in one cascade, and some in the other */
}

/* Cells of a cascade that has scrolled lie elsewhere than where they are stored. */
static void boxes_follow_a_cascade_that_scrolls(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = settings_with(1);
    struct test_mesh mesh = test_mesh_bumpy_sphere((double[]){ 2.11, 1.07, -2.19 }, 3, 0.2, 5);
    pass_scene_open(&pass_context, &settings, &mesh);
    test_mesh_destroy(&mesh);
    pass_scene_stand(&pass_context, (double[]){ 4.1, 2.2, -6.3 });
    gi_test_update(&pass_context, 30);
    REQUIRE_CMP(require_boxes(0), >, 40);
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

/* Sub-voxels can look like the mark of a cell that holds boxes: the cell gets one more, and no other does. */
static void chequered_cell_is_not_taken_for_empty(void **state)
{
    (void)state;
    const uint32_t mark = SDFGI_BOXES_MARK, all_but_one = mark & (mark - 1);
    REQUIRE_CMP(upper_half_of_cell(mark), ==, mark | SDFGI_BOXES_MARK_OTHER);
    REQUIRE_CMP(upper_half_of_cell(all_but_one), ==, all_but_one);
    REQUIRE_CMP(upper_half_of_cell(~SDFGI_BOXES_MARK_OTHER), ==, UINT32_MAX);
}

TEST_GROUP(empty_boxes)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_are_the_best_empty_ones),
        cmocka_unit_test(boxes_follow_a_cascade_that_scrolls),
        cmocka_unit_test(chequered_cell_is_not_taken_for_empty),
    };
    return cmocka_run_group_tests_name("empty_boxes", tests, NULL, pass_context_close);
}
