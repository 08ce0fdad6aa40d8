/* SPDX-License-Identifier: MIT
 * The voxel references and the walks through them, against their definitions. */
#include "oracle_voxel.h"
#include "test_memory.h"
#include "require.h"

static const struct oracle_grid unit_grid = { { 0, 0, 0 }, { 1, 1, 1 } };

static void require_same_bits(const struct oracle_bits *a, const struct oracle_bits *b)
{
    uint32_t first[3] = { 0 };
    const uint64_t lost = oracle_bits_missing(a, b, first), extra = oracle_bits_missing(b, a, first);
    if (lost || extra)
        require_fail(__FILE__, __LINE__, "%llu bits missing, %llu extra, one at (%u, %u, %u)",
                     (unsigned long long)lost, (unsigned long long)extra, first[0], first[1], first[2]);
}

/* Triangles on a lattice of 1/8 voxel: double arithmetic is exact there, and edges meet voxel centres, faces
 * and corners all the time. Every fourth is flattened to an edge-on, a line or a point. */
static struct test_mesh lattice_soup(uint32_t seed, uint32_t count, double size)
{
    const double low[3] = { 0, 0, 0 }, high[3] = { size, size, size };
    struct test_mesh mesh = test_mesh_soup(seed, count, low, high, 3);
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; i++)
        mesh.positions[i] = rintf(mesh.positions[i] * 8) / 8;
    for (uint32_t i = 0; i < count; i += 4) {
        float *v = mesh.positions + 9 * (size_t)i;
        const uint32_t axis = i / 4 % 3, kind = i / 12 % 4;
        const float flat = floorf(v[axis]) + (kind & 1 ? 0.5f : 0.0f);
        v[axis] = v[3 + axis] = v[6 + axis] = flat;
        if (kind >= 2)
            memcpy(v + 6, v + 3, 3 * sizeof *v);
        if (i % 48 == 0)
            memcpy(v + 3, v, 3 * sizeof *v);
    }
    return mesh;
}

/* The definition itself: a voxel's cross is three boxes without thickness. */
static bool cross_is_touched(const double (*triangle)[3], const double center[static 3])
{
    for (int axis = 0; axis < 3; axis++) {
        double half[3] = { 0, 0, 0 };
        half[axis] = 0.5;
        if (oracle_triangle_touches_box(triangle, center, half))
            return true;
    }
    return false;
}

static void voxelize_by_definition(struct oracle_bits *bits, const struct test_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        double v[3][3];
        for (int i = 0; i < 9; i++)
            v[i / 3][i % 3] = mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)t + i / 3] + i % 3];
        for (uint32_t z = 0; z < bits->size; z++)
            for (uint32_t y = 0; y < bits->size; y++)
                for (uint32_t x = 0; x < bits->size; x++)
                    if (cross_is_touched((const double(*)[3])v, (double[]){ x + 0.5, y + 0.5, z + 0.5 }))
                        oracle_bits_set(bits, x, y, z);
    }
}

static void separating_bits_are_those_whose_cross_is_touched(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; seed++) {
        struct test_mesh mesh = lattice_soup(seed, 96, 12);
        struct oracle_bits fast = oracle_bits_create(12), slow = oracle_bits_create(12);
        oracle_voxel_separating(&fast, &unit_grid, &mesh, 0);
        voxelize_by_definition(&slow, &mesh);
        REQUIRE_CMP(oracle_bits_count(&slow), >, 200);
        require_same_bits(&slow, &fast);
        oracle_bits_destroy(&fast);
        oracle_bits_destroy(&slow);
        test_mesh_destroy(&mesh);
    }
}

static void shrunken_bits_are_fewer_and_touched_bits_more(void **state)
{
    (void)state;
    struct test_mesh mesh = lattice_soup(9, 200, 24);
    struct oracle_bits less = oracle_bits_create(24), just = oracle_bits_create(24),
                       more = oracle_bits_create(24);
    oracle_voxel_separating(&less, &unit_grid, &mesh, 0.05);
    oracle_voxel_separating(&just, &unit_grid, &mesh, 0);
    oracle_voxel_touched(&more, &unit_grid, &mesh, 0);
    REQUIRE_CMP(oracle_bits_missing(&just, &less, NULL), ==, 0);
    REQUIRE_CMP(oracle_bits_missing(&more, &just, NULL), ==, 0);
    REQUIRE_CMP(oracle_bits_count(&less), <, oracle_bits_count(&just));
    REQUIRE_CMP(oracle_bits_count(&just), <, oracle_bits_count(&more));
    oracle_bits_destroy(&less);
    oracle_bits_destroy(&just);
    oracle_bits_destroy(&more);
    test_mesh_destroy(&mesh);
}

/* Every voxel, tested one by one against every triangle. */
static void touched_bits_are_those_whose_box_is_touched(void **state)
{
    (void)state;
    struct test_mesh mesh = lattice_soup(5, 60, 10);
    struct oracle_bits fast = oracle_bits_create(10), slow = oracle_bits_create(10);
    oracle_voxel_touched(&fast, &unit_grid, &mesh, 0.25);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        double v[3][3];
        for (int i = 0; i < 9; i++)
            v[i / 3][i % 3] = mesh.positions[9 * (size_t)t + i];
        for (uint32_t i = 0; i < 1000; i++) {
            const double center[3] = { i % 10 + 0.5, i / 10 % 10 + 0.5, i / 100 + 0.5 };
            if (oracle_triangle_touches_box((const double(*)[3])v, center, (double[]){ 0.75, 0.75, 0.75 }))
                oracle_bits_set(&slow, i % 10, i / 10 % 10, i / 100);
        }
    }
    require_same_bits(&slow, &fast);
    oracle_bits_destroy(&fast);
    oracle_bits_destroy(&slow);
    test_mesh_destroy(&mesh);
}

/* The box test, against points: a box and a triangle touch if a sample of one lies in the other, and a
 * sampled triangle point never lies in a box that the test calls untouched. */
static void box_test_agrees_with_sampled_points(void **state)
{
    (void)state;
    struct test_random random = { 11 };
    const double center[3] = { 0, 0, 0 }, half[3] = { 0.5, 0.5, 0.5 };
    uint32_t touched = 0, sampled = 0;
    for (uint32_t i = 0; i < 2000; i++) {
        double v[3][3];
        for (int k = 0; k < 9; k++)
            v[k / 3][k % 3] = test_random_real(&random, -1.5, 1.5);
        bool inside = false;
        for (uint32_t s = 0; s <= 40 * 40 && !inside; s++) {
            const double a = s % 41 / 40.0, b = s / 41 / 40.0 * (1 - a);
            inside = true;
            for (int k = 0; k < 3; k++)
                inside = inside && fabs(v[0][k] + a * (v[1][k] - v[0][k]) + b * (v[2][k] - v[0][k])) <= 0.5;
        }
        const bool touches = oracle_triangle_touches_box((const double(*)[3])v, center, half);
        REQUIRE_CMP((int)inside, <=, (int)touches);
        touched += touches;
        sampled += inside;
    }
    REQUIRE_CMP(sampled, >, 500);
    REQUIRE_CMP(touched - sampled, <, touched / 20); /* grazed corners that sampling misses */
}

static void unusable_triangles_leave_no_bits(void **state)
{
    (void)state;
    struct test_mesh mesh = lattice_soup(3, 4, 12);
    mesh.positions[0] = NAN;
    mesh.positions[9] = INFINITY;
    mesh.indices[7] = 12;
    mesh.positions[27] = 1e30f; /* finite: its other two corners keep it in */
    struct oracle_bits bits = oracle_bits_create(12);
    mesh.triangle_count = 3;
    oracle_voxel_separating(&bits, &unit_grid, &mesh, 0);
    REQUIRE_CMP(oracle_bits_count(&bits), ==, 0);
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&mesh);
}

static void huge_triangles_voxelize_like_small_ones(void **state)
{
    (void)state;
    const double center[3] = { 16, 7.25, 16 };
    struct test_mesh small = test_mesh_plane(center, (double[]){ 0, 0, 32 }, (double[]){ 32, 0, 0 }, 1);
    struct test_mesh huge = test_mesh_plane(center, (double[]){ 0, 0, 1e6 }, (double[]){ 1e6, 0, 0 }, 1);
    struct oracle_bits a = oracle_bits_create(32), b = oracle_bits_create(32);
    oracle_voxel_separating(&a, &unit_grid, &small, 0);
    oracle_voxel_separating(&b, &unit_grid, &huge, 0);
    REQUIRE_CMP(oracle_bits_count(&a), ==, 32 * 32);
    require_same_bits(&a, &b);
    oracle_bits_destroy(&a);
    oracle_bits_destroy(&b);
    test_mesh_destroy(&small);
    test_mesh_destroy(&huge);
}

/* ---- Walks ---- */

struct closed_case {
    const char *name;
    struct test_mesh mesh;
    uint32_t inside[3];
};

static void require_closed(struct closed_case *shape)
{
    struct oracle_bits bits = oracle_bits_create(64);
    oracle_voxel_separating(&bits, &unit_grid, &shape->mesh, 0);
    uint64_t reached = 0;
    if (oracle_bits_walk_escapes(&bits, shape->inside, &reached))
        require_fail(__FILE__, __LINE__, "%s: a walk from inside gets out (%llu sub-voxels)", shape->name,
                     (unsigned long long)reached);
    REQUIRE_CMP(reached, >, 1000);
    REQUIRE_TRUE(oracle_bits_walk_escapes(&bits, (uint32_t[]){ 0, 0, 0 }, &reached));
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&shape->mesh);
}

static void closed_meshes_let_no_walk_through(void **state)
{
    (void)state;
    const double center[3] = { 31.7, 32.4, 32.1 };
    double turned[9];
    test_rotation((double[]){ 1, 2, 3 }, 0.7, turned);
    struct closed_case shapes[] = {
        { "sphere", test_mesh_sphere(center, 24.3, 4), { 32, 32, 32 } },
        { "bumpy sphere", test_mesh_bumpy_sphere(center, 22, 0.2, 5), { 32, 32, 32 } },
        { "cube", test_mesh_box(center, (double[]){ 15, 16, 17 }, turned), { 32, 32, 32 } },
        { "aligned cube",
          test_mesh_box((double[]){ 32, 32, 32 }, (double[]){ 20, 20.5, 21 }, test_rotation_none),
          { 32, 32, 32 } },
        { "torus", test_mesh_torus(center, 18, 8, test_rotation_none, 64, 32), { 50, 32, 32 } },
        { "room", test_mesh_room(center, (double[]){ 14, 14, 14 }, 1, turned), { 32, 32, 32 } },
        { "left room", test_mesh_two_rooms(center, (double[]){ 20, 14, 14 }, 2, turned), { 24, 26, 32 } },
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        require_closed(&shapes[i]);
}

static void one_missing_bit_lets_the_walk_out(void **state)
{
    (void)state;
    const double center[3] = { 32, 32, 32 };
    struct test_mesh mesh = test_mesh_box(center, (double[]){ 20.25, 20.25, 20.25 }, test_rotation_none);
    struct oracle_bits bits = oracle_bits_create(64);
    oracle_voxel_separating(&bits, &unit_grid, &mesh, 0);
    REQUIRE_TRUE(!oracle_bits_walk_escapes(&bits, (uint32_t[]){ 32, 32, 32 }, NULL));
    REQUIRE_TRUE(oracle_bits_get(&bits, 40, 40, 52));
    oracle_bits_row(&bits, 40, 52)[0] &= ~(UINT64_C(1) << 40);
    REQUIRE_TRUE(oracle_bits_walk_escapes(&bits, (uint32_t[]){ 32, 32, 32 }, NULL));
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&mesh);
}

/* Grows the reached set by one step in all directions until nothing changes. */
static struct oracle_bits walk_by_definition(const struct oracle_bits *solid, const uint32_t seed[static 3])
{
    static const int steps[6][3] = { { 1, 0, 0 },  { -1, 0, 0 }, { 0, 1, 0 },
                                     { 0, -1, 0 }, { 0, 0, 1 },  { 0, 0, -1 } };
    struct oracle_bits reached = oracle_bits_create(solid->size);
    const int64_t size = solid->size;
    if (!oracle_bits_get(solid, seed[0], seed[1], seed[2]))
        oracle_bits_set(&reached, seed[0], seed[1], seed[2]);
    for (bool changed = true; changed;) {
        changed = false;
        for (int64_t i = 0; i < size * size * size * 6; i++) {
            const int64_t c[3] = { i / 6 % size, i / 6 / size % size, i / 6 / size / size };
            const int64_t n[3] = { c[0] + steps[i % 6][0], c[1] + steps[i % 6][1], c[2] + steps[i % 6][2] };
            if (n[0] < 0 || n[1] < 0 || n[2] < 0 || n[0] >= size || n[1] >= size || n[2] >= size ||
                !oracle_bits_get(&reached, (uint32_t)c[0], (uint32_t)c[1], (uint32_t)c[2]) ||
                oracle_bits_get(solid, (uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2]) ||
                oracle_bits_get(&reached, (uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2]))
                continue;
            oracle_bits_set(&reached, (uint32_t)n[0], (uint32_t)n[1], (uint32_t)n[2]);
            changed = true;
        }
    }
    return reached;
}

/* 70 does not divide into words, and this density is near the percolation threshold, where paths wind. */
static void walk_reaches_what_single_steps_reach(void **state)
{
    (void)state;
    const uint32_t sizes[2] = { 20, 70 };
    for (int i = 0; i < 2; i++) {
        const uint32_t size = sizes[i], seed[3] = { size / 2, size / 2, size / 3 };
        struct oracle_bits solid = oracle_bits_random(7, size, size * size * size);
        memset(oracle_bits_row(&solid, seed[1], seed[2]), 0, solid.row_words * sizeof *solid.words);
        struct oracle_bits fast = oracle_bits_walk(&solid, seed), slow = walk_by_definition(&solid, seed);
        REQUIRE_CMP(oracle_bits_count(&slow), >, size * size);
        require_same_bits(&slow, &fast);
        oracle_bits_destroy(&solid);
        oracle_bits_destroy(&fast);
        oracle_bits_destroy(&slow);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(separating_bits_are_those_whose_cross_is_touched),
        cmocka_unit_test(shrunken_bits_are_fewer_and_touched_bits_more),
        cmocka_unit_test(touched_bits_are_those_whose_box_is_touched),
        cmocka_unit_test(box_test_agrees_with_sampled_points),
        cmocka_unit_test(unusable_triangles_leave_no_bits),
        cmocka_unit_test(huge_triangles_voxelize_like_small_ones),
        cmocka_unit_test(closed_meshes_let_no_walk_through),
        cmocka_unit_test(one_missing_bit_lets_the_walk_out),
        cmocka_unit_test(walk_reaches_what_single_steps_reach),
    };
    return cmocka_run_group_tests_name("oracle_voxel", tests, NULL, NULL);
}
