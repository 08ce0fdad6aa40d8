/* SPDX-License-Identifier: MIT
 * Rays of sdfgi_trace.glsl against a walk through the same bits in double precision (HARD_CASES rows 9, 10
 * and 12). */
#include "gpu_test_compute.h"
#include "oracle_encode.h"
#include "oracle_trace.h"
#include "pass_scene.h"
#include "require.h"
#include "test_memory.h"

#include "trace_rays.comp.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RAYS = 100000 };

struct ray {
    float origin[3], range; /* cells */
    float direction[3];     /* metric, unit */
    float light_cell;       /* along x, in the cascade of the hit; -1: none */
    float distance, hit, capped, axis;
};

static struct ray rays[RAYS];

static void trace(struct gi_test *t)
{
    const struct gpu_test_shader shader = { trace_rays_comp, sizeof trace_rays_comp,
                                            sdfgi_get_descriptor_set_layout(t->gi),
                                            sdfgi_get_descriptor_set(t->gi) };
    gpu_test_compute(&t->gpu, &shader, RAYS, rays, sizeof rays);
}

/* ---- Comparison */

static struct oracle_hit oracle_ray(const struct oracle_bits *bits, const struct ray *ray,
                                    const double shift[static 3], double y_scale)
{
    double origin[3], direction[3];
    for (int k = 0; k < 3; k++) {
        origin[k] = 4 * ((double)ray->origin[k] + shift[k]);
        direction[k] = 4 * (double)ray->direction[k] / (k == 1 ? y_scale : 1);
    }
    return oracle_trace(bits, origin, direction, (double)ray->range);
}

static bool agrees(const struct ray *ray, const struct oracle_hit *expected)
{
    if (expected->hit != (ray->hit != 0))
        return false;
    return !expected->hit || fabs((double)ray->distance - expected->distance) <= 1e-3;
}

/* A ray that grazes an edge may pass on either side of it in float: it may be stopped by whatever it touches,
 * and must be by what stops all rays beside it. */
static bool agrees_nearby(const struct oracle_bits *bits, const struct ray *ray, double y_scale)
{
    struct test_random random = { 77 };
    double farthest = 0, end[3];
    for (int i = 0; i < 64; i++) {
        double shift[3];
        test_random_direction(&random, shift);
        for (int k = 0; k < 3; k++)
            shift[k] *= 1e-4 * test_random_real(&random, 0, 1);
        farthest = fmax(farthest, oracle_ray(bits, ray, shift, y_scale).distance);
    }
    if (ray->hit == 0)
        return farthest >= (double)ray->range;
    for (int k = 0; k < 3; k++)
        end[k] = 4 * ((double)ray->origin[k] +
                      (double)ray->distance * (double)ray->direction[k] / (k == 1 ? y_scale : 1));
    return oracle_bits_near(bits, end, 1e-3) && (double)ray->distance <= farthest + 1e-3;
}

/* Every ray must end where the oracle's does; returns how many hit nothing. */
static uint32_t require_rays_agree(struct gi_test *t, const char *name, double y_scale)
{
    static const double none[3] = { 0, 0, 0 };
    struct oracle_bits bits = gi_test_bits(t, 0);
    uint32_t escapes = 0, grazing = 0, capped = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        const struct oracle_hit expected = oracle_ray(&bits, &rays[i], none, y_scale);
        escapes += rays[i].hit == 0;
        capped += rays[i].capped != 0;
        if (rays[i].capped != 0 || agrees(&rays[i], &expected))
            continue;
        grazing++;
        if (!agrees_nearby(&bits, &rays[i], y_scale))
            require_fail(__FILE__, __LINE__,
                         "%s: ray %u from %.6f %.6f %.6f along %.6f %.6f %.6f hits at %.6f, not %.6f", name,
                         i, (double)rays[i].origin[0], (double)rays[i].origin[1], (double)rays[i].origin[2],
                         (double)rays[i].direction[0], (double)rays[i].direction[1],
                         (double)rays[i].direction[2], (double)rays[i].distance, expected.distance);
    }
    printf("%s: %u of %u rays escape, %u graze an edge, %u ran out of steps\n", name, escapes, RAYS, grazing,
           capped);
    oracle_bits_destroy(&bits);
    REQUIRE_CMP(capped, <, RAYS / 1000); /* HARD_CASES row 10 */
    return escapes;
}

/* ---- Rays */

static void aim(struct ray *ray, const double origin[static 3], const double direction[static 3],
                double range)
{
    for (int k = 0; k < 3; k++) {
        ray->origin[k] = (float)origin[k];
        ray->direction[k] = (float)direction[k];
    }
    ray->range = (float)range;
}

/* From random points within `reach` cells of the middle, in all directions. */
static void aim_from_inside(uint32_t seed, double reach)
{
    struct test_random random = { seed };
    for (uint32_t i = 0; i < RAYS; i++) {
        double origin[3], direction[3];
        test_random_direction(&random, direction);
        for (int k = 0; k < 3; k++)
            origin[k] = 32 + test_random_real(&random, -reach, reach);
        aim(&rays[i], origin, direction, 500);
    }
}

static void open_with(struct gi_test *t, struct test_mesh mesh, enum sdfgi_y_scale y_scale)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.y_scale = y_scale;
    pass_scene_open(t, &settings, &mesh);
    test_mesh_destroy(&mesh);
}

/* Walls of a single sub-voxel just beyond a boundary between cells: the distances on both sides never fall
 * below 0.375 cell. */
static void hard_09_no_ray_tunnels_through_a_thin_wall(void **state)
{
    (void)state;
    const double center[3] = { 0, 0, 0 }, half[3] = { 5.03125, 4.03125, 3.03125 };
    open_with(&pass_context, test_mesh_box(center, half, test_rotation_none), SDFGI_Y_SCALE_100);
    aim_from_inside(9, 11.9);
    trace(&pass_context);
    REQUIRE_CMP(require_rays_agree(&pass_context, "thin box", 1), ==, 0);
}

static void hard_09_nor_where_cells_are_flat(void **state)
{
    (void)state;
    double turned[9];
    test_rotation((double[]){ 1, 2, 3 }, 0.5, turned);
    open_with(&pass_context, test_mesh_box((double[]){ 0, 0, 0 }, (double[]){ 2.1, 1.9, 2.3 }, turned),
              SDFGI_Y_SCALE_50);
    aim_from_inside(10, 4.5);
    trace(&pass_context);
    REQUIRE_CMP(require_rays_agree(&pass_context, "turned box, y scale 0.5", 0.5), ==, 0);
}

static void hard_12_no_ray_leaves_a_closed_bumpy_sphere(void **state)
{
    (void)state;
    open_with(&pass_context, test_mesh_bumpy_sphere((double[]){ 0.11, -0.07, 0.19 }, 5, 0.2, 5),
              SDFGI_Y_SCALE_100);
    aim_from_inside(12, 8);
    trace(&pass_context);
    REQUIRE_CMP(require_rays_agree(&pass_context, "bumpy sphere", 1), ==, 0);
}

/* Probes stand on corners of cells and look in symmetric directions: their rays run exactly through edges and
 * corners of sub-voxels. */
static void hard_12_no_ray_slips_through_an_edge(void **state)
{
    (void)state;
    open_with(&pass_context, test_mesh_bumpy_sphere((double[]){ 0.11, -0.07, 0.19 }, 5, 0.2, 5),
              SDFGI_Y_SCALE_100);
    for (uint32_t i = 0; i < RAYS; i++) {
        const uint32_t probe = i / 256 % 343, texel = i % 256;
        const double square[2] = { (texel % 16 + 0.5) / 8 - 1, (texel / 16 + 0.5) / 8 - 1 };
        const double origin[3] = { 8.0 + 8 * (probe % 7), 8.0 + 8 * (probe / 7 % 7), 8.0 + 8 * (probe / 49) };
        double d[3];
        oracle_octahedral_decode(square, d);
        aim(&rays[i], origin, (double[]){ d[0], d[2], d[1] }, 500);
    }
    trace(&pass_context);
    require_rays_agree(&pass_context, "lattice", 1);
}

/* 0.05 to 5 degrees from a wall: distance steps are short. */
static void hard_10_grazing_rays_arrive(void **state)
{
    (void)state;
    const double degree = 3.14159265358979 / 180;
    open_with(&pass_context,
              test_mesh_plane((double[]){ 0, 0.03, 0 }, (double[]){ 0, 0, 9 }, (double[]){ 9, 0, 0 }, 1),
              SDFGI_Y_SCALE_100);
    struct test_random random = { 10 };
    for (uint32_t i = 0; i < RAYS; i++) {
        const double down = test_random_real(&random, 0.05, 5) * degree,
                     turn = test_random_real(&random, 0, 360) * degree;
        const double direction[3] = { cos(down) * cos(turn), -sin(down), cos(down) * sin(turn) };
        const double origin[3] = { test_random_real(&random, 1, 63),
                                   32.25 + test_random_real(&random, 0.01, 1),
                                   test_random_real(&random, 1, 63) };
        aim(&rays[i], origin, direction, 500);
    }
    trace(&pass_context);
    REQUIRE_CMP(require_rays_agree(&pass_context, "grazing", 1), <, RAYS);
}

/* ---- Light cells */

/* A thin wall across x, and one across z where it ends, in the second cascade. */
static void open_beside_wall(struct gi_test *t)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.cascades = 2;
    const double cell = (double)settings.min_cell_size_m, end = 41 * cell;
    struct test_mesh wall = test_mesh_plane((double[]){ 0.8 * cell, 0, end / 2 },
                                            (double[]){ 0, 12 * cell, 0 }, (double[]){ 0, 0, end / 2 }, 1);
    struct test_mesh back = test_mesh_plane((double[]){ 0, 0, end }, (double[]){ 12 * cell, 0, 0 },
                                            (double[]){ 0, 12 * cell, 0 }, 1);
    test_mesh_append(&wall, &back);
    pass_scene_open(t, &settings, &wall);
    test_mesh_destroy(&back);
    test_mesh_destroy(&wall);
}

/* Rays that come from the first cascade so close along the wall that all their cells of the second are
 * occupied, down to where they began. Cells beyond the wall lie beside those too. */
static void no_light_comes_from_beyond_a_thin_wall(void **state)
{
    (void)state;
    open_beside_wall(&pass_context);
    struct test_random random = { 54 };
    for (uint32_t i = 0; i < RAYS; i++) {
        const double from = test_random_real(&random, 1.1, 1.9), to = test_random_real(&random, 1.1, 1.9),
                     z = test_random_real(&random, 28, 31), length = hypot(41 - z, to - from);
        const double origin[3] = { 32 + from, 32 + test_random_real(&random, -8, 8), 32 + z };
        aim(&rays[i], origin, (double[]){ (to - from) / length, 0, (41 - z) / length }, 500);
    }
    trace(&pass_context);
    uint32_t found = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        REQUIRE_CMP(rays[i].hit, !=, 0.0f);
        REQUIRE_TRUE(rays[i].light_cell == -1 || rays[i].light_cell == 33); /* beyond the wall is 31 */
        found += rays[i].light_cell == 33;
        if (rays[i].direction[0] < 0) /* the ray comes from that side */
            REQUIRE_CMP(rays[i].light_cell, ==, 33.0f);
    }
    printf("%u of %u rays find a light cell\n", found, RAYS);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_09_no_ray_tunnels_through_a_thin_wall),
        cmocka_unit_test(hard_09_nor_where_cells_are_flat),
        cmocka_unit_test(hard_10_grazing_rays_arrive),
        cmocka_unit_test(hard_12_no_ray_leaves_a_closed_bumpy_sphere),
        cmocka_unit_test(hard_12_no_ray_slips_through_an_edge),
        cmocka_unit_test(no_light_comes_from_beyond_a_thin_wall),
    };
    return cmocka_run_group_tests_name("trace", tests, NULL, pass_context_close);
}
