/* SPDX-License-Identifier: MIT
 * Copies of the volumes hold what was voxelised, at the places the header says. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <sdfgi/inspect.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct copy {
    struct gi_test *test;
    uint32_t cascade;
    enum sdfgi_volume volume;
    VkBuffer to;
    enum sdfgi_result result;
};

static void record_copy(VkCommandBuffer cmd, uint32_t index, void *user)
{
    struct copy *c = user;
    (void)index;
    c->result = sdfgi_inspect_copy(c->test->gi, cmd, c->cascade, c->volume, c->to, 0);
}

static uint32_t *read_volume(struct gi_test *t, uint32_t cascade, enum sdfgi_volume volume)
{
    const uint64_t bytes = sdfgi_inspect_volume_size(t->gi, volume);
    REQUIRE_CMP(bytes, >, 0ul);
    struct gpu_test_buffer buffer = gpu_test_buffer_host(&t->gpu, bytes, 0, NULL);
    struct copy c = { t, cascade, volume, buffer.buffer, SDFGI_ERROR_UNSUPPORTED };
    gpu_test_submit(&t->gpu, record_copy, &c);
    REQUIRE_CMP(c.result, ==, SDFGI_OK);
    uint32_t *words = malloc(bytes);
    REQUIRE_TRUE(words);
    memcpy(words, buffer.mapped, bytes);
    gpu_test_buffer_destroy(&t->gpu, &buffer);
    return words;
}

static const float albedo[3] = { 0.25f, 0.5f, 0.75f }, emission[3] = { 2, 0, 8 };
static const double box_center[3] = { -100.2, 7.3, 33.1 };

/* Emits from its front alone, unlike gi_test_material. */
static sdfgi_material one_sided_material(struct gi_test *t)
{
    struct sdfgi_material_desc desc = { .alpha = 1 };
    sdfgi_material material;
    memcpy(desc.albedo, albedo, sizeof desc.albedo);
    memcpy(desc.emission, emission, sizeof desc.emission);
    REQUIRE_CMP(sdfgi_material_create(t->gi, &desc, &material), ==, SDFGI_OK);
    return material;
}

/* An emissive box far enough from the origin for the volumes to wrap at odd places. */
static void open_box(struct gi_test *t, uint32_t cascades)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.cascades = cascades;
    gi_test_open(t, &settings);
    memcpy(t->frame.camera_position, box_center, sizeof box_center);
    struct test_mesh mesh = test_mesh_box(box_center, (double[]){ 1.1, 0.9, 1.3 }, test_rotation_none);
    gi_test_add(t, &mesh, one_sided_material(t));
    test_mesh_destroy(&mesh);
    gi_test_update(t, 1);
}

static void bits_are_where_the_header_says(void **state)
{
    (void)state;
    struct gi_test t;
    open_box(&t, 2);
    for (uint32_t cascade = 0; cascade < 2; cascade++) {
        struct sdfgi_inspect_cascade where;
        REQUIRE_CMP(sdfgi_inspect_get_cascade(t.gi, cascade, &where), ==, SDFGI_OK);
        const struct oracle_grid grid = gi_test_grid(&t, cascade);
        for (int i = 0; i < 3; i++) {
            REQUIRE_NEAR(where.origin_m[i], grid.origin[i], 1e-9);
            REQUIRE_NEAR(where.cell_m[i], 4 * grid.step[i], 1e-9);
            REQUIRE_NEAR((double)where.origin_cells[i] * where.cell_m[i], where.origin_m[i], 1e-6);
        }
        struct oracle_bits bits = gi_test_bits(&t, cascade);
        uint32_t *words = read_volume(&t, cascade, SDFGI_VOLUME_BITS);
        uint64_t set = 0;
        for (uint32_t z = 0; z < bits.size; z++)
            for (uint32_t y = 0; y < bits.size; y++)
                for (uint32_t x = 0; x < bits.size; x++) {
                    const uint64_t cell = sdfgi_inspect_cell(&where, x / 4, y / 4, z / 4);
                    const uint32_t bit = x % 4 + 4 * (y % 4) + 16 * (z % 4);
                    const bool is_set = sdfgi_inspect_bits(&words[2 * cell]) >> bit & 1;
                    REQUIRE_TRUE(is_set == oracle_bits_get(&bits, x, y, z));
                    set += is_set;
                }
        REQUIRE_CMP(set, >, 100ul);
        free(words);
        oracle_bits_destroy(&bits);
    }
    gi_test_close(&t);
}

/* The volumes that tell what surfaces are like, of cascade 0. */
struct surface_volumes {
    struct sdfgi_inspect_cascade where;
    uint32_t *words[SDFGI_VOLUME_COUNT];
};

static struct surface_volumes read_surfaces(struct gi_test *t)
{
    struct surface_volumes v = { 0 };
    REQUIRE_CMP(sdfgi_inspect_get_cascade(t->gi, 0, &v.where), ==, SDFGI_OK);
    for (int i = SDFGI_VOLUME_ALBEDO; i < SDFGI_VOLUME_COUNT; i++)
        v.words[i] = read_volume(t, 0, (enum sdfgi_volume)i);
    return v;
}

static void free_surfaces(struct surface_volumes *v)
{
    for (int i = 0; i < SDFGI_VOLUME_COUNT; i++)
        free(v->words[i]);
}

/* What the block of a cell holds. */
static struct sdfgi_inspect_surface surface_at(const struct surface_volumes *v, const uint32_t cell[static 3])
{
    const uint64_t block = sdfgi_inspect_block(&v->where, cell[0], cell[1], cell[2]);
    struct sdfgi_inspect_surface s;
    sdfgi_inspect_decode_block(v->words[SDFGI_VOLUME_ALBEDO] + 2 * block,
                               v->words[SDFGI_VOLUME_EMISSION] + 2 * block,
                               v->words[SDFGI_VOLUME_NORMALS][block], v->where.emission_unit, &s);
    return s;
}

/* Blocks of a side of the box: what it is made of, and that it faces and emits outwards. */
static void blocks_tell_what_they_hold(void **state)
{
    (void)state;
    struct gi_test t;
    open_box(&t, 1);
    struct surface_volumes v = read_surfaces(&t);
    const double half[3] = { 1.1, 0.9, 1.3 };
    for (int axis = 0; axis < 6; axis++) {
        uint32_t cell[3];
        for (int i = 0; i < 3; i++) {
            const double side = i == axis / 2 ? (axis % 2 ? -half[i] : half[i]) : 0;
            cell[i] = (uint32_t)floor((box_center[i] + side - v.where.origin_m[i]) / v.where.cell_m[i]);
        }
        const struct sdfgi_inspect_surface s = surface_at(&v, cell);
        for (int i = 0; i < 3; i++) {
            REQUIRE_NEAR((double)s.albedo[axis][i], 1023 * (double)albedo[i], 1);
            REQUIRE_NEAR((double)s.emission[i], (double)emission[i], 0.02);
            REQUIRE_TRUE(s.has_normal[i] == (i == axis / 2));
            REQUIRE_CMP(s.slopes[i][0], ==, 0);
            REQUIRE_CMP(s.slopes[i][1], ==, 0);
        }
        for (int other = 0; other < 6; other++)
            REQUIRE_CMP(s.emitting[other], ==, (other == axis ? 31 : 0));
    }
    free_surfaces(&v);
    gi_test_close(&t);
}

/* A plate that emits on both sides, two sub-voxels before a dark wall in the same block. */
static void add_plate_before_wall(struct gi_test *t, int axis)
{
    static const float none[3] = { 0, 0, 0 };
    const bool low = axis % 2;
    for (int wall = 0; wall < 2; wall++) {
        double center[3] = { 0.25, 0.25, 0.25 }, u[3] = { 0 }, v[3] = { 0 };
        center[axis / 2] = low == (bool)wall ? 0.3 : 0.17;
        u[(axis / 2 + 1) % 3] = 3;
        v[(axis / 2 + 2) % 3] = 3;
        struct test_mesh mesh = test_mesh_plane(center, u, v, 1);
        gi_test_add(t, &mesh, gi_test_material(t, albedo, wall ? none : emission));
        test_mesh_destroy(&mesh);
    }
}

/* Only what is seen first counts: nothing of the plate from behind the wall. */
static void plates_emit_away_from_the_wall_behind_them(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    for (int axis = 0; axis < 6; axis++) {
        gi_test_restart(&t, &settings);
        add_plate_before_wall(&t, axis);
        gi_test_update(&t, 1);
        struct sdfgi_inspect_cascade where;
        REQUIRE_CMP(sdfgi_inspect_get_cascade(t.gi, 0, &where), ==, SDFGI_OK);
        uint32_t cell[3];
        for (int i = 0; i < 3; i++)
            cell[i] = (uint32_t)floor((0.25 - where.origin_m[i]) / where.cell_m[i]);
        const uint64_t block = sdfgi_inspect_block(&where, cell[0], cell[1], cell[2]);
        uint32_t *words = read_volume(&t, 0, SDFGI_VOLUME_EMISSION);
        struct sdfgi_inspect_surface s;
        sdfgi_inspect_decode_block(NULL, words + 2 * block, 0, where.emission_unit, &s);
        for (int i = 0; i < 3; i++)
            REQUIRE_NEAR((double)s.emission[i], (double)emission[i], 0.02);
        for (int other = 0; other < 6; other++)
            REQUIRE_CMP(s.emitting[other], ==, (other == axis ? 31 : 0));
        free(words);
    }
    gi_test_close(&t);
}

/* Before the first update, out of range, with no buffer: refused, and nothing is written. */
static void wrong_requests_are_refused(void **state)
{
    (void)state;
    struct gi_test t;
    struct sdfgi_settings settings = gi_test_settings();
    struct sdfgi_inspect_cascade where = { .resolution = 7 };
    gi_test_open(&t, &settings);
    struct gpu_test_buffer buffer =
        gpu_test_buffer_host(&t.gpu, sdfgi_inspect_volume_size(t.gi, SDFGI_VOLUME_BITS), 0, NULL);
    struct copy c = { &t, 0, SDFGI_VOLUME_BITS, buffer.buffer, SDFGI_OK };
    REQUIRE_CMP(sdfgi_inspect_get_cascade(t.gi, 0, &where), ==, SDFGI_ERROR_INVALID_ARGUMENT);
    gpu_test_submit(&t.gpu, record_copy, &c);
    REQUIRE_CMP(c.result, ==, SDFGI_ERROR_INVALID_ARGUMENT);
    gi_test_update(&t, 1);
    REQUIRE_CMP(sdfgi_inspect_get_cascade(t.gi, 1, &where), ==, SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(where.resolution, ==, 7u);
    c.cascade = 1;
    gpu_test_submit(&t.gpu, record_copy, &c);
    REQUIRE_CMP(c.result, ==, SDFGI_ERROR_INVALID_ARGUMENT);
    c = (struct copy){ &t, 0, SDFGI_VOLUME_COUNT, buffer.buffer, SDFGI_OK };
    gpu_test_submit(&t.gpu, record_copy, &c);
    REQUIRE_CMP(c.result, ==, SDFGI_ERROR_INVALID_ARGUMENT);
    c = (struct copy){ &t, 0, SDFGI_VOLUME_BITS, VK_NULL_HANDLE, SDFGI_OK };
    gpu_test_submit(&t.gpu, record_copy, &c);
    REQUIRE_CMP(c.result, ==, SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(sdfgi_inspect_volume_size(t.gi, SDFGI_VOLUME_COUNT), ==, 0ul);
    gpu_test_buffer_destroy(&t.gpu, &buffer);
    gi_test_close(&t);
}

/* 2,100 quads in one place: sums of emission would wrap from 1,024 on. */
static void coincident_emitters_keep_their_colour(void **state)
{
    (void)state;
    enum { QUADS = 2100 };
    struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    struct test_mesh mesh = { 0 };
    for (int i = 0; i < QUADS; i++) {
        struct test_mesh quad =
            test_mesh_plane((double[]){ 0.1, 0.1, 0.1 }, (double[]){ 0, 0, 0.4 }, (double[]){ 0.4, 0, 0 }, 1);
        test_mesh_append(&mesh, &quad);
        test_mesh_destroy(&quad);
    }
    const struct sdfgi_material_desc desc = { .alpha = 1,
                                              .albedo = { 0.25f, 0.5f, 0.75f },
                                              .emission = { 1, 0.3f, 0.1f } };
    sdfgi_material material;
    REQUIRE_CMP(sdfgi_material_create(t.gi, &desc, &material), ==, SDFGI_OK);
    gi_test_add(&t, &mesh, material);
    test_mesh_destroy(&mesh);
    gi_test_update(&t, 1);
    gi_test_update(&t, 2);
    REQUIRE_CMP(t.gi->volume.feedback.counters[SDFGI_COUNTER_SAMPLES_CUT], >, 0u);
    struct surface_volumes v = read_surfaces(&t);
    const uint32_t middle = v.where.resolution / 2;
    const struct sdfgi_inspect_surface s = surface_at(&v, (uint32_t[]){ middle, middle, middle });
    for (int i = 0; i < 3; i++) {
        printf("emission %.4f, albedo %.4f\n", (double)s.emission[i], s.albedo[2][i] / 1023.0);
        REQUIRE_NEAR(s.emission[i], desc.emission[i], 1 / 512.0f + 1e-5f); /* RGB9E5 */
        REQUIRE_NEAR(s.albedo[2][i] / 1023.0f / desc.albedo[i], 1, 0.01);
    }
    free_surfaces(&v);
    gi_test_close(&t);
}

/* A square, half a side and its middle in metres, which faces along +x -x +y -y +z -z. */
struct square {
    double at[3];
    int axis;
    double half;
};

static void add_square(struct gi_test *t, const struct square *square, sdfgi_material material)
{
    double u[3] = { 0 }, v[3] = { 0 };
    u[(square->axis / 2 + 1) % 3] = square->half;
    v[(square->axis / 2 + 2) % 3] = square->axis % 2 ? -square->half : square->half;
    struct test_mesh mesh = test_mesh_plane(square->at, u, v, 1);
    gi_test_add(t, &mesh, material);
    test_mesh_destroy(&mesh);
}

/* What the block shows whose low corner is the origin. */
static struct sdfgi_inspect_surface middle_block(struct gi_test *t)
{
    gi_test_update(t, 1);
    struct surface_volumes v = read_surfaces(t);
    uint32_t cell[3];
    for (int i = 0; i < 3; i++)
        cell[i] = (uint32_t)lrint(-v.where.origin_m[i] / v.where.cell_m[i]);
    const struct sdfgi_inspect_surface s = surface_at(&v, cell);
    free_surfaces(&v);
    return s;
}

/* The same with two squares alone. */
static struct sdfgi_inspect_surface block_of(const struct square squares[static 2],
                                             const float *const colors[static 2])
{
    struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    for (int i = 0; i < 2; i++)
        add_square(&t, &squares[i], gi_test_material(&t, colors[i], (float[3]){ 0 }));
    const struct sdfgi_inspect_surface s = middle_block(&t);
    gi_test_close(&t);
    return s;
}

static void require_color(const uint16_t found[static 3], const float color[static 3])
{
    for (int i = 0; i < 3; i++)
        REQUIRE_NEAR((double)found[i], 1023 * (double)color[i], 2); /* nine bits, and rounding */
}

static const float red[3] = { 0.75f, 0.125f, 0.0625f }, white[3] = { 0.9f, 0.85f, 0.95f };

/* Beyond 1 it is cut. */
static void gloss_is_added_to_albedo(void **state)
{
    (void)state;
    struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    const struct sdfgi_material_desc desc = { .albedo = { 0.25f, 0.5f, 0.95f }, .specular_albedo = 0.125f };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t.gi, &desc, &material), ==, (int)SDFGI_OK);
    add_square(&t, &(struct square){ { 0, 0.12, 0 }, 2, 1 }, material);
    const struct sdfgi_inspect_surface s = middle_block(&t);
    require_color(s.albedo[2], (float[]){ 0.375f, 0.625f, 1 });
    gi_test_close(&t);
}

/* Two colours within a cell, back to back. */
static void faces_of_a_thin_wall_have_colours_of_their_own(void **state)
{
    (void)state;
    for (int axis = 0; axis < 6; axis++) {
        struct square sides[2] = { { .axis = axis, .half = 1 }, { .axis = axis ^ 1, .half = 1 } };
        sides[0].at[axis / 2] = axis % 2 ? 0.08 : 0.14;
        sides[1].at[axis / 2] = axis % 2 ? 0.14 : 0.08;
        const struct sdfgi_inspect_surface s = block_of(sides, (const float *[]){ red, white });
        require_color(s.albedo[axis], red);
        require_color(s.albedo[axis ^ 1], white);
    }
}

/* All of a block, or half of it, shows the nearer of two squares that face alike. */
static void require_nearer(const struct square squares[static 2], const float *const colors[static 2],
                           bool half_covered)
{
    const struct sdfgi_inspect_surface s = block_of(squares, colors);
    float mean[3];
    for (int i = 0; i < 3; i++)
        mean[i] = half_covered ? 0.5f * (colors[0][i] + colors[1][i]) : colors[1][i];
    require_color(s.albedo[squares[0].axis], mean);
}

/* Where a square of 2 m begins in the middle of the block. */
static double aside(bool half_covered)
{
    return half_covered ? 1 + (double)gi_test_settings().min_cell_size_m : 0;
}

/* A rug on a floor, or a poster on a wall: 2 cm before it, in the same sub-voxels of 6.25 cm. Colours are
 * those that fronts can hold. */
static void a_rug_hides_the_floor(void **state)
{
    (void)state;
    static const float rug[3] = { 96 / 127.0f, 32 / 255.0f, 16 / 127.0f },
                       floor[3] = { 20 / 127.0f, 200 / 255.0f, 120 / 127.0f };
    for (int axis = 0; axis < 6; axis++)
        for (int half_covered = 0; half_covered < 2; half_covered++) {
            struct square squares[2] = { { .axis = axis, .half = 2 }, { .axis = axis, .half = 1 } };
            squares[0].at[axis / 2] = axis % 2 ? 0.09 : 0.1;
            squares[1].at[axis / 2] = axis % 2 ? 0.07 : 0.12;
            squares[1].at[(axis / 2 + 1) % 3] = aside(half_covered);
            require_nearer(squares, (const float *[]){ floor, rug }, half_covered);
        }
}

/* A floor above the ground: of what faces alike the nearer counts, and what lies behind it as far as it
 * shows. */
static void what_lies_behind_counts_as_far_as_it_shows(void **state)
{
    (void)state;
    const double above = 0.12 + (double)gi_test_settings().min_cell_size_m;
    for (int half_covered = 0; half_covered < 2; half_covered++)
        require_nearer(
            (struct square[]){ { { 0, 0.12, 0 }, 2, 2 }, { { aside(half_covered), above, 0 }, 2, 1 } },
            (const float *[]){ red, white }, half_covered);
}

TEST_GROUP(inspect)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_are_where_the_header_says),
        cmocka_unit_test(blocks_tell_what_they_hold),
        cmocka_unit_test(gloss_is_added_to_albedo),
        cmocka_unit_test(faces_of_a_thin_wall_have_colours_of_their_own),
        cmocka_unit_test(a_rug_hides_the_floor),
        cmocka_unit_test(what_lies_behind_counts_as_far_as_it_shows),
        cmocka_unit_test(coincident_emitters_keep_their_colour),
        cmocka_unit_test(plates_emit_away_from_the_wall_behind_them),
        cmocka_unit_test(wrong_requests_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
