/* SPDX-License-Identifier: MIT
 * Rays of sdfgi_trace.glsl against a walk in doubles through the same bits (HARD_CASES rows 9 to 12). */
#include "gpu_test_compute.h"
#include "hard_case.h"
#include "oracle_encode.h"
#include "oracle_trace.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"
#include "trace_rays.comp.h"
#include "trace_rays_software.comp.h"

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

static void trace_with(struct gi_test *t, const uint32_t *code, size_t size)
{
    const struct gpu_test_shader shader = { code, size, sdfgi_get_descriptor_set_layout(t->gi),
                                            sdfgi_get_descriptor_set(t->gi) };
    gpu_test_compute(&t->gpu, &shader, RAYS, rays, sizeof rays);
}

/* In the loop for GPUs. */
static void trace(struct gi_test *t)
{
    trace_with(t, trace_rays_comp, sizeof trace_rays_comp);
}

/* In the loops for software drivers, which alone have the texels that these read. */
static void trace_in_software(struct gi_test *t)
{
    trace_with(t, trace_rays_software_comp, sizeof trace_rays_software_comp);
}

/* As passes on this device do. */
static void trace_as_passes(struct gi_test *t)
{
    if (sdfgi_is_software(t->gi))
        trace_in_software(t);
    else
        trace(t);
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

/* Of many rays: how many hit nothing, ran out of steps, end elsewhere than the oracle's, and tell
 * another face than the one by which they enter what they hit. */
struct tally {
    uint64_t rays, escapes, capped, grazing, wrong, turned;
};

/* True if the face is seen from outside, and the point where the oracle's ray enters a sub-voxel lies on it,
 * as closely as distances agree. A ray that begins in what it hits enters no face. */
static bool enters_face(const struct ray *ray, const struct oracle_hit *expected, double y_scale)
{
    const int axis = (int)ray->axis / 2;
    const double direction = (double)ray->direction[axis] / (axis == 1 ? y_scale : 1),
                 at = 4 * ((double)ray->origin[axis] + expected->distance * direction);
    return expected->axis < 0 ||
           (((int)ray->axis % 2 != 0) == (direction > 0) && fabs(at - round(at)) <= 4e-3);
}

static void print_wrong(uint32_t i, double expected)
{
    const struct ray *r = &rays[i];
    printf("ray %u from %.6f %.6f %.6f along %.6f %.6f %.6f hits at %.6f, not %.6f\n", i,
           (double)r->origin[0], (double)r->origin[1], (double)r->origin[2], (double)r->direction[0],
           (double)r->direction[1], (double)r->direction[2], (double)r->distance, expected);
}

static void count_rays(const struct oracle_bits *bits, double y_scale, struct tally *tally)
{
    static const double none[3] = { 0, 0, 0 };
    for (uint32_t i = 0; i < RAYS; i++) {
        const struct oracle_hit expected = oracle_ray(bits, &rays[i], none, y_scale);
        tally->escapes += rays[i].hit == 0;
        tally->capped += rays[i].capped != 0;
        if (rays[i].capped != 0)
            continue;
        if (agrees(&rays[i], &expected)) {
            tally->turned += expected.hit && !enters_face(&rays[i], &expected, y_scale);
            continue;
        }
        tally->grazing++;
        if (!agrees_nearby(bits, &rays[i], y_scale) && tally->wrong++ == 0)
            print_wrong(i, expected.distance);
    }
    tally->rays += RAYS;
}

/* Aims RAYS rays, the batch-th of several lots. */
typedef void aim_batch(uint32_t batch);

/* `full_batches` lots in suite `full`, one otherwise. */
static struct tally follow(const char *name, aim_batch *aim, uint32_t full_batches, double y_scale)
{
    struct oracle_bits bits = gi_test_bits(&pass_context, 0);
    struct tally tally = { 0 };
    const uint32_t batches = getenv("SDFGI_TEST_FULL") ? full_batches : 1;
    for (uint32_t batch = 0; batch < batches; batch++) {
        aim(batch);
        trace(&pass_context);
        count_rays(&bits, y_scale, &tally);
        if (!sdfgi_is_software(pass_context.gi))
            continue;
        aim(batch);
        trace_in_software(&pass_context);
        count_rays(&bits, y_scale, &tally);
    }
    printf("%s: %llu of %llu rays escape, %llu graze an edge, %llu ran out of steps\n", name,
           (unsigned long long)tally.escapes, (unsigned long long)tally.rays,
           (unsigned long long)tally.grazing, (unsigned long long)tally.capped);
    oracle_bits_destroy(&bits);
    REQUIRE_CMP(tally.capped, ==, 0ul); /* none comes near the number of steps in one cascade */
    return tally;
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

static void aim_in_box(uint32_t batch)
{
    aim_from_inside(9 + 100 * batch, 11.9);
}

/* Walls of a single sub-voxel just beyond a boundary between cells: the distances on both sides never fall
 * below 0.375 cell. */
static void hard_09_no_ray_tunnels_through_a_thin_wall(void **state)
{
    (void)state;
    const double center[3] = { 0, 0, 0 }, half[3] = { 5.03125, 4.03125, 3.03125 };
    open_with(&pass_context, test_mesh_box(center, half, test_rotation_none), SDFGI_Y_SCALE_100);
    const struct tally tally = follow("thin box", aim_in_box, 10, 1);
    HARD_CASE_AT_MOST(9, "rays that pass the wall", tally.escapes, 0);
    HARD_CASE_AT_MOST(9, "rays that end elsewhere than a double's", tally.wrong, 0);
    HARD_CASE_AT_MOST(11, "hits whose normal is not that of the face entered", tally.turned, 0);
}

static void aim_in_turned_box(uint32_t batch)
{
    aim_from_inside(10 + 100 * batch, 4.5);
}

static void hard_09_nor_where_cells_are_flat(void **state)
{
    (void)state;
    double turned[9];
    test_rotation((double[]){ 1, 2, 3 }, 0.5, turned);
    open_with(&pass_context, test_mesh_box((double[]){ 0, 0, 0 }, (double[]){ 2.1, 1.9, 2.3 }, turned),
              SDFGI_Y_SCALE_50);
    const struct tally tally = follow("turned box, y scale 0.5", aim_in_turned_box, 10, 0.5);
    HARD_CASE_AT_MOST(9, "rays that pass the wall", tally.escapes, 0);
    HARD_CASE_AT_MOST(9, "rays that end elsewhere than a double's", tally.wrong, 0);
    HARD_CASE_AT_MOST(11, "hits whose normal is not that of the face entered", tally.turned, 0);
}

static void open_bumpy_sphere(void)
{
    open_with(&pass_context, test_mesh_bumpy_sphere((double[]){ 0.11, -0.07, 0.19 }, 5, 0.2, 5),
              SDFGI_Y_SCALE_100);
}

static void aim_in_sphere(uint32_t batch)
{
    aim_from_inside(12 + 100 * batch, 8);
}

static void hard_12_no_ray_leaves_a_closed_bumpy_sphere(void **state)
{
    (void)state;
    open_bumpy_sphere();
    const struct tally tally = follow("bumpy sphere", aim_in_sphere, 100, 1);
    HARD_CASE_AT_MOST(12, "rays that leave the sphere", tally.escapes, 0);
    HARD_CASE_AT_MOST(12, "rays that end elsewhere than a double's", tally.wrong, 0);
    HARD_CASE_AT_MOST(11, "hits whose normal is not that of the face entered", tally.turned, 0);
}

/* Directions of the texels of an octahedral map, from every probe in turn. */
static void aim_along_lattice(uint32_t batch)
{
    const uint32_t side = getenv("SDFGI_TEST_FULL") ? 171 : 16, texels = side * side;
    for (uint32_t i = 0; i < RAYS; i++) {
        const uint32_t n = batch * RAYS + i, probe = n / texels % 343, texel = n % texels;
        const double square[2] = { 2 * (texel % side + 0.5) / side - 1, 2 * (texel / side + 0.5) / side - 1 };
        const double origin[3] = { 8.0 + 8 * (probe % 7), 8.0 + 8 * (probe / 7 % 7), 8.0 + 8 * (probe / 49) };
        double d[3];
        oracle_octahedral_decode(square, d);
        aim(&rays[i], origin, (double[]){ d[0], d[2], d[1] }, 500);
    }
}

/* Probes stand on corners of cells and look in symmetric directions: their rays run exactly through edges and
 * corners of sub-voxels. */
static void hard_12_no_ray_slips_through_an_edge(void **state)
{
    (void)state;
    open_bumpy_sphere();
    const struct tally tally = follow("lattice", aim_along_lattice, 100, 1);
    HARD_CASE_AT_MOST(12, "rays that end elsewhere than a double's", tally.wrong, 0);
    HARD_CASE_AT_MOST(11, "hits whose normal is not that of the face entered", tally.turned, 0);
}

/* 0.05 to 5 degrees from a wall: distance steps are short. */
static void aim_at_wall(uint32_t batch)
{
    const double degree = 3.14159265358979 / 180;
    struct test_random random = { 10 + batch };
    for (uint32_t i = 0; i < RAYS; i++) {
        const double down = test_random_real(&random, 0.05, 5) * degree,
                     turn = test_random_real(&random, 0, 360) * degree;
        const double direction[3] = { cos(down) * cos(turn), -sin(down), cos(down) * sin(turn) };
        const double origin[3] = { test_random_real(&random, 1, 63),
                                   32.25 + test_random_real(&random, 0.01, 1),
                                   test_random_real(&random, 1, 63) };
        aim(&rays[i], origin, direction, 500);
    }
}

static void hard_10_grazing_rays_arrive(void **state)
{
    (void)state;
    open_with(&pass_context,
              test_mesh_plane((double[]){ 0, 0.03, 0 }, (double[]){ 0, 0, 9 }, (double[]){ 9, 0, 0 }, 1),
              SDFGI_Y_SCALE_100);
    const struct tally tally = follow("grazing", aim_at_wall, 1, 1);
    HARD_CASE_AT_MOST(10, "grazing rays that end elsewhere than a double's", tally.wrong, 0);
}

/* As far as four cascades reach. */
static void hard_10_few_grazing_rays_run_out_of_steps(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.cascades = 4;
    settings.resolution = getenv("SDFGI_TEST_FULL") ? 128 : 32;
    struct test_mesh wall =
        test_mesh_plane((double[]){ 0, 0.03, 0 }, (double[]){ 0, 0, 150 }, (double[]){ 150, 0, 0 }, 1);
    pass_scene_open(&pass_context, &settings, &wall);
    test_mesh_destroy(&wall);
    aim_at_wall(1);
    for (uint32_t i = 0; i < RAYS; i++) {
        for (int k = 0; k < 3; k++)
            rays[i].origin[k] += (float)settings.resolution / 2 - 32;
        rays[i].range = 4000;
    }
    trace_as_passes(&pass_context);
    uint32_t capped = 0;
    for (uint32_t i = 0; i < RAYS; i++)
        capped += rays[i].capped != 0;
    HARD_CASE_AT_MOST(10, "grazing rays that run out of steps, share", (double)capped / RAYS, 1e-3);
}

/* Two boxes, in the lowest corner of the first cascade and in the highest one of the last. The way from one
 * to the other crosses more cells than a ray has steps, as none of them is known to be empty. */
static void open_corner(uint32_t resolution, uint32_t cascades)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = resolution;
    settings.cascades = cascades;
    settings.ray_count = 1;
    settings.frames_to_converge = 4;
    const double end = resolution / 2 * 0.25, low = 0.3 - end, high = ldexp(end, (int)cascades - 1) - 1;
    const double half[3] = { 0.2, 0.2, 0.2 };
    struct test_mesh box = test_mesh_box((double[]){ low, low, low }, half, test_rotation_none),
                     far = test_mesh_box((double[]){ high, high, high }, half, test_rotation_none);
    test_mesh_append(&box, &far);
    pass_scene_open(&pass_context, &settings, &box);
    test_mesh_destroy(&box);
    test_mesh_destroy(&far);
    pass_scene_forget_empty_space(&pass_context);
}

static uint64_t caps_reported(void)
{
    gi_test_update(&pass_context, 4);
    return pass_health_count(&pass_context, SDFGI_MESSAGE_TRACE_CAP_REACHED);
}

static void require_caps_are_hits(void)
{
    for (uint32_t i = 0; i < RAYS; i++)
        aim(&rays[i], (double[]){ 3.5, 3.4, 3.6 }, (double[]){ 0.577, 0.578, 0.577 }, 1e6);
    trace(&pass_context);
    uint32_t missed = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        REQUIRE_CMP(rays[i].capped, !=, 0.0f);
        missed += rays[i].hit == 0;
    }
    HARD_CASE_AT_MOST(10, "rays without steps that count as no hit", missed, 0);
}

static void hard_10_shadow_rays_without_steps_are_hits_and_reported(void **state)
{
    (void)state;
    open_corner(64, 8);
    require_caps_are_hits();
    REQUIRE_CMP(caps_reported(), ==, 0ul); /* no probe looks along the few ways that are so long */
    const struct sdfgi_light_desc sun = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                          .casts_shadow = true,
                                          .direction = { -1, -1, -1 },
                                          .intensity = { 1, 1, 1 } };
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_light_create(pass_context.gi, &sun, &light), ==, SDFGI_OK);
    HARD_CASE_AT_LEAST(10, "shadow rays without steps that are reported", caps_reported(), 1);
}

/* 1,740 m from the box: all rays to it would be reported. EFFECTS row 9. */
static void lamp_out_of_range_calls_for_no_ray(void **state)
{
    (void)state;
    open_corner(64, 8);
    struct sdfgi_light_desc lamp = { .type = SDFGI_LIGHT_POINT, .range_m = 1000, .casts_shadow = true };
    for (int k = 0; k < 3; k++)
        lamp.position[k] = lamp.intensity[k] = 1000;
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_light_create(pass_context.gi, &lamp, &light), ==, SDFGI_OK);
    REQUIRE_CMP(caps_reported(), ==, 0ul);
    lamp.range_m = 0;
    REQUIRE_CMP(sdfgi_light_update(pass_context.gi, light, &lamp), ==, SDFGI_OK);
    REQUIRE_CMP(caps_reported(), >, 0ul);
}

/* Every ray of this light would be reported. EFFECTS row 9. */
static void light_that_casts_no_shadow_calls_for_no_ray(void **state)
{
    (void)state;
    open_corner(64, 8);
    struct sdfgi_light_desc sun = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                    .direction = { -1, -1, -1 },
                                    .intensity = { 1, 1, 1 } };
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_light_create(pass_context.gi, &sun, &light), ==, SDFGI_OK);
    REQUIRE_CMP(caps_reported(), ==, 0ul);
    sun.casts_shadow = true;
    sun.direction[0] = sun.direction[1] = sun.direction[2] = 1; /* from behind all surfaces */
    REQUIRE_CMP(sdfgi_light_update(pass_context.gi, light, &sun), ==, SDFGI_OK);
    REQUIRE_CMP(caps_reported(), ==, 0ul);
    sun.direction[0] = sun.direction[1] = sun.direction[2] = -1;
    REQUIRE_CMP(sdfgi_light_update(pass_context.gi, light, &sun), ==, SDFGI_OK);
    REQUIRE_CMP(caps_reported(), >, 0ul);
}

/* In suite `full` alone: probes look along such ways where cascades are larger. */
static void hard_10_probes_rays_without_steps_are_reported(void **state)
{
    (void)state;
    if (!getenv("SDFGI_TEST_FULL"))
        skip();
    open_corner(128, 5);
    HARD_CASE_AT_LEAST(10, "rays of probes without steps that are reported", caps_reported(), 1);
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
    uint32_t found = 0, beyond = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        REQUIRE_CMP(rays[i].hit, !=, 0.0f);
        beyond += rays[i].light_cell != -1 && rays[i].light_cell != 33; /* beyond the wall is 31 */
        found += rays[i].light_cell == 33;
        if (rays[i].direction[0] < 0) /* the ray comes from that side */
            REQUIRE_CMP(rays[i].light_cell, ==, 33.0f);
    }
    HARD_CASE_AT_LEAST(64, "rays along a wall that find a light cell, share", (double)found / RAYS, 0.5);
    HARD_CASE_AT_MOST(64, "rays that read light beyond a wall", beyond, 0);
}

TEST_GROUP(trace)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_09_no_ray_tunnels_through_a_thin_wall),
        cmocka_unit_test(hard_09_nor_where_cells_are_flat),
        cmocka_unit_test(hard_10_grazing_rays_arrive),
        cmocka_unit_test(hard_10_few_grazing_rays_run_out_of_steps),
        cmocka_unit_test(hard_10_shadow_rays_without_steps_are_hits_and_reported),
        cmocka_unit_test(light_that_casts_no_shadow_calls_for_no_ray),
        cmocka_unit_test(lamp_out_of_range_calls_for_no_ray),
        cmocka_unit_test(hard_10_probes_rays_without_steps_are_reported),
        cmocka_unit_test(hard_12_no_ray_leaves_a_closed_bumpy_sphere),
        cmocka_unit_test(hard_12_no_ray_slips_through_an_edge),
        cmocka_unit_test(no_light_comes_from_beyond_a_thin_wall),
    };
    return cmocka_run_group_tests_name("trace", tests, NULL, pass_context_close);
}
