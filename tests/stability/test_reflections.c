/* SPDX-License-Identifier: MIT
 * Reflections of views where things end: rays that cascades hand over while the camera moves, and pictures of
 * one row (HARD_CASES rows 55 and 69). */
#include "hard_case.h"
#include "light_scene.h"
#include "mirror.h"
#include "oracle_gloss.h"
#include "require.h"
#include "test_group.h"

#include "shaders/shared/constants.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Cascades */

enum { SIDE = 9, PIXELS = SIDE * SIDE, STEPS = 61 };

#define WALL_M        5.1
#define COARSE_CELL_M 1.0
#define HALF_M        0.5f

/* A mirror, and a wall that glows in what it shows. */
static void build_wall(struct gi_test *t)
{
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    settings.cascades = 4;
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -2, -1.5, -2 }, (double[]){ 2, -1, 2 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    light_add_box(t, (double[]){ WALL_M, -2, -8 }, (double[]){ WALL_M + 1, 14, 8 },
                  (float[]){ 0.5f, 0.5f, 0.5f }, 1);
}

/* The farthest that distances are off, in coarse cells. */
static double distance_error(uint16_t (*texels)[4])
{
    double worst = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double x = (double)HALF_M * ((i % SIDE + 0.5) / SIDE * 2 - 1), exact = (WALL_M - x) * sqrt(2);
        worst = fmax(worst, fabs((double)gi_test_half(texels[i][3]) - exact) / COARSE_CELL_M);
    }
    return worst;
}

/* The camera walks from where the coarsest cascade alone has the wall to where the finest has it, and on
 * until the mirror is in coarser ones. */
static void hard_55_reflected_rays_cross_cascades(void **state)
{
    struct gi_test *t = *state;
    static uint16_t texels[PIXELS][4], before[PIXELS][4];
    struct mirror mirror;
    double off = 0, pop = 0, darkest = INFINITY;
    build_wall(t);
    t->frame.camera_position[0] = -3;
    gi_test_converge(t, 400);
    mirror_open(&mirror, t, SIDE, SIDE, HALF_M);
    for (int step = 0; step < STEPS; step++) {
        t->frame.camera_position[0] = -3 + 0.15 * step;
        gi_test_update(t, 1);
        mirror_read(&mirror, texels);
        off = fmax(off, distance_error(texels));
        for (int i = 0; i < PIXELS; i++) {
            const double now = (double)gi_test_half(texels[i][1]), last = (double)gi_test_half(before[i][1]);
            pop = fmax(pop, step > 0 ? fabs(now - last) / fmax(now, last) : 0);
            darkest = fmin(darkest, now);
        }
        memcpy(before, texels, sizeof texels);
    }
    printf("rays over cascades: off by %.3f coarse cells, pops of %.4f, at least %.4f\n", off, pop, darkest);
    mirror_close(&mirror);
    t->frame.camera_position[0] = 0;
    HARD_CASE_AT_MOST(55, "distance to what a ray hits, off by coarse cells", off, 1);
    HARD_CASE_AT_MOST(55, "change of a pixel from frame to frame in a walk", pop, 0.02);
    REQUIRE_CMP(darkest, >, 1.0);
}

/* ---- Extremes */

/* Nothing but a sky that is as bright as it is high: at 45 degrees 0.707 of its zenith, and 0.667 in the mean
 * over a matt surface. */
static void hard_69_views_of_one_row_reflect(void **state)
{
    struct gi_test *t = *state;
    const uint32_t most = t->gpu.properties.limits.maxImageDimension2D, longest = most < 16384 ? most : 16384;
    const uint32_t sizes[][2] = { { 1, 1 }, { longest, 1 }, { 1, longest } };
    uint16_t(*texels)[4] = calloc(longest, sizeof *texels);
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    double worst = 0;
    REQUIRE_TRUE(texels != NULL);
    gi_test_restart(t, &settings);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &(struct sdfgi_sky){ .zenith = { 1, 1, 1 } }), ==, (int)SDFGI_OK);
    gi_test_converge(t, 400);
    for (int i = 0; i < 3; i++) {
        struct mirror mirror;
        mirror_open(&mirror, t, sizes[i][0], sizes[i][1], 1);
        mirror_read(&mirror, texels);
        for (uint32_t k = 0; k < sizes[i][0] * sizes[i][1]; k++)
            worst = fmax(worst, fabs((double)gi_test_half(texels[k][1]) / sqrt(0.5) - 1));
        mirror_close(&mirror);
    }
    free(texels);
    HARD_CASE_AT_MOST(69, "reflections in pictures of one row or pixel, off by", worst, 0.002);
}

/* ---- What is mirrored looks like what is seen */

/* A wall before the mirror, a lamp before the wall, and the way from the eye to the mirror. */
struct lit_wall {
    double low[3], high[3], lamp[3];
    int axis; /* it faces against this axis */
    float towards[3];
};

static const struct lit_wall lit_walls[] = {
    { { 1.25, -1.5, -1.5 }, { 2, 1.5, 1.5 }, { -0.25, 0, -0.75 }, 0, { 1, -1, 0 } },
    { { -1.5, 0, -1.5 }, { 1.75, 1, 1.5 }, { 0.5, -1.5, -0.75 }, 1, { 1, -1, 0 } },
    { { -1.5, -1.5, 1.25 }, { 1.5, 1.5, 2 }, { -0.75, 0, -0.25 }, 2, { 0, -1, 1 } },
};

#define START_M (0.45 * 0.25) /* above the mirror, where its rays start */

/* Light that the lamp, of 1 W/sr, sends by way of the wall, of albedo 0.5, to a place of the mirror. */
static double light_by_wall(const struct lit_wall *wall, double x, double z)
{
    const double height = wall->low[wall->axis] - wall->lamp[wall->axis], from[3] = { x, -1 + START_M, z };
    const double up[3] = { wall->towards[0], 1, wall->towards[2] };
    const double length = (wall->low[wall->axis] - from[wall->axis]) / up[wall->axis];
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += pow(from[i] + length * up[i] - wall->lamp[i], 2);
    return 0.5 / PI * height / pow(square, 1.5);
}

enum { ROW = 24 };

/* What a pixel shows over what it should. */
static double share_shown(const struct lit_wall *wall, uint16_t (*texels)[4], int x, int z)
{
    const double half_m = (double)HALF_M;
    return (double)gi_test_half(texels[ROW * z + x][1]) /
           light_by_wall(wall, half_m * ((x + 0.5) / ROW * 2 - 1), half_m * ((z + 0.5) / ROW * 2 - 1));
}

/* Seen along the wall's `towards`. */
static void look_along(struct mirror *mirror, const float towards[static 3])
{
    for (int i = 0; i < 3; i++) {
        mirror->desc.inverse_view_projection[8 + i] = 2 * towards[i];
        mirror->desc.inverse_view_projection[12 + i] = (float)-(i == 1) - towards[i];
    }
}

/* Light falls off along both sides of the wall's cells, which are 6 pixels wide. A mirror that showed each
 * cell by itself would have steps of 0.18 between pixels. Between cells light is a line where it should be a
 * curve, which is up to 0.063 off, but without steps. */
static void a_mirror_shows_no_cells_of_a_wall(void **state)
{
    struct gi_test *t = *state;
    static uint16_t texels[ROW * ROW][4];
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    for (size_t k = 0; k < sizeof lit_walls / sizeof *lit_walls; k++) {
        const struct lit_wall *wall = &lit_walls[k];
        const struct sdfgi_light_desc lamp = light_point(wall->lamp[0], wall->lamp[1], wall->lamp[2], 1);
        struct mirror mirror;
        double off = 0, step = 0;
        gi_test_restart(t, &settings);
        light_add_box(t, wall->low, wall->high, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
        light_create(t, &lamp);
        gi_test_converge(t, 400);
        mirror_open(&mirror, t, ROW, ROW, HALF_M);
        look_along(&mirror, wall->towards);
        mirror_read(&mirror, texels);
        mirror_close(&mirror);
        for (int i = 0; i < (ROW - 1) * (ROW - 1); i++) {
            const int x = i % (ROW - 1), z = i / (ROW - 1);
            const double here = share_shown(wall, texels, x, z);
            off = fmax(off, fabs(here - 1));
            step = fmax(step, fabs(share_shown(wall, texels, x + 1, z) - here));
            step = fmax(step, fabs(share_shown(wall, texels, x, z + 1) - here));
        }
        printf("a wall along axis %d in a mirror, off by %.4f, steps of %.4f\n", wall->axis, off, step);
        REQUIRE_CMP(off, <=, 0.08);
        REQUIRE_CMP(step, <=, 0.02);
    }
}

/* Rays begin in the sub-voxels of what is as near as that, and hit the face towards the mirror. Its other
 * faces are far off, and black where the mirror is. */
static void a_mirror_close_below_a_lamp_shows_it(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    uint16_t texel[1][4];
    struct mirror mirror;
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -2, -0.9, -2 }, (double[]){ 2, -0.4, 2 }, (float[]){ 0, 0, 0 }, 1);
    gi_test_update(t, 20);
    mirror_open(&mirror, t, 1, 1, HALF_M);
    look_along(&mirror, (float[]){ 0.2f, -0.96f, 0.2f });
    mirror_read(&mirror, texel);
    mirror_close(&mirror);
    printf("10 cm below a lamp a mirror shows %.3f of it\n", (double)gi_test_half(texel[0][1]));
    REQUIRE_NEAR(gi_test_half(texel[0][1]), 1, 0.03);
}

/* A lamp and what is black, in one block of cells above the mirror: beside each other, and one behind the
 * other. */
static const struct lamp_and_black {
    double lamp[2][3], black[2][3];
} lamps_and_black[] = {
    { { { 0, 0, 0 }, { 0.1875, 0.25, 0.5 } }, { { 0.1875, 0, 0 }, { 0.5, 0.25, 0.5 } } },
    { { { 0, 0, 0.3125 }, { 0.5, 0.5, 0.5 } }, { { 0, 0, 0 }, { 0.5, 0.5, 0.3125 } } },
    { { { 0.125, 0, 0.25 }, { 0.3125, 0.125, 0.5 } }, { { 0, 0.25, 0 }, { 0.5, 0.5, 0.5 } } },
};

/* Metres by which a place of the mirror lies within the sides of a box above it. */
static double within(const double box[2][3], double x, double z)
{
    return fmin(fmin(x - box[0][0], box[1][0] - x), fmin(z - box[0][2], box[1][2] - z));
}

/* A side of a block has one emission, a mean. What the lamp has of it is known to 1/31 of its root. */
static void a_mirror_tells_a_lamp_from_what_is_beside_it(void **state)
{
    struct gi_test *t = *state;
    static uint16_t texels[ROW * ROW][4];
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    for (size_t k = 0; k < sizeof lamps_and_black / sizeof *lamps_and_black; k++) {
        const struct lamp_and_black *scene = &lamps_and_black[k];
        struct mirror mirror;
        double off = 0, black = 0;
        gi_test_restart(t, &settings);
        light_add_box(t, scene->lamp[0], scene->lamp[1], (float[]){ 0, 0, 0 }, 1);
        light_add_box(t, scene->black[0], scene->black[1], (float[]){ 0, 0, 0 }, 0);
        gi_test_update(t, 20);
        mirror_open(&mirror, t, ROW, ROW, HALF_M);
        look_along(&mirror, (float[]){ 0, -1, 0 });
        mirror_read(&mirror, texels);
        mirror_close(&mirror);
        for (int i = 0; i < ROW * ROW; i++) {
            const double inside = within(scene->lamp, ((i % ROW + 0.5) / ROW - 0.5) * 2 * (double)HALF_M,
                                         ((i / ROW + 0.5) / ROW - 0.5) * 2 * (double)HALF_M);
            const double light = (double)gi_test_half(texels[i][1]);
            off = fmax(off, inside > 0.03 ? fabs(light - 1) : 0);
            black = fmax(black, inside < -0.03 ? light : 0);
        }
        printf("a mirrored lamp is off by %.3f, what is beside it shows %.3f\n", off, black);
        REQUIRE_CMP(off, <=, 0.07);
        REQUIRE_CMP(black, <=, 0);
    }
}

/* ---- Metal in mirrors */

/* The ray goes up to a wall and from there, mirrored again, up to the sky. As long as the wall is matt, the
 * ray shows what arrives there from all around. The far walls lie where two cascades hand over. */
static void metal_shows_in_a_mirror_what_it_reflects(void **state)
{
    static const double walls_m[] = { 1.5, 2, 2.5, 2.75, 3, 3.25 };
    struct gi_test *t = *state;
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    uint16_t texels[PIXELS][4];
    double nearest[2] = { INFINITY, INFINITY }, farthest[2] = { 0, 0 };
    settings.cascades = 2;
    for (size_t k = 0; k <= sizeof walls_m / sizeof *walls_m; k++) {
        const int metal = k > 0;
        const double wall_m = walls_m[metal ? k - 1 : 0];
        struct mirror mirror;
        gi_test_restart(t, &settings);
        REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &(struct sdfgi_sky){ .zenith = { 1, 1, 1 } }), ==,
                    (int)SDFGI_OK);
        light_add_metal(t,
                        test_mesh_box((double[]){ wall_m, wall_m - 1.25, 0 }, (double[]){ 0.25, 1, 1.25 },
                                      test_rotation_none),
                        0.8f, (float)metal);
        gi_test_converge(t, 400);
        mirror_open(&mirror, t, SIDE, SIDE, HALF_M);
        mirror_read(&mirror, texels);
        mirror_close(&mirror);
        for (int i = 0; i < PIXELS; i++) {
            const double off = fabs((double)gi_test_half(texels[i][1]) / (0.8 * sqrt(0.5)) - 1);
            nearest[metal] = fmin(nearest[metal], off);
            farthest[metal] = fmax(farthest[metal], off);
        }
        printf("a wall at %.2f m: off by %.4f to %.4f so far\n", wall_m, nearest[metal], farthest[metal]);
    }
    REQUIRE_CMP(farthest[1], <=, 0.01);
    REQUIRE_CMP(nearest[0], >, 0.2);
}

/* ---- Gloss */

/* What facets of a dielectric send to a viewer from a direction, up to a factor. Y is up. */
static double gloss_sends(const double eye[static 3], const double dir[static 3], double alpha)
{
    const double cosine = eye[0] * dir[0] + eye[1] * dir[1] + eye[2] * dir[2], alpha2 = alpha * alpha;
    const double of_facet = sqrt(fmax(0.5 + 0.5 * cosine, 1e-12)), up = (eye[1] + dir[1]) / (2 * of_facet);
    const double spread = up * up * (alpha2 - 1) + 1;
    return oracle_fresnel(0.04, of_facet) * oracle_smith(eye[1], dir[1], alpha) / (spread * spread);
}

/* True if a ray that starts above the middle of the surface, in the plane y = -1, meets a box. */
static bool meets_box(const double low[static 3], const double high[static 3], const double dir[static 3])
{
    double enters = 0, leaves = INFINITY;
    for (int i = 0; i < 3; i++) {
        const double from = i == 1 ? -1 + START_M : 0, a = (low[i] - from) / dir[i],
                     b = (high[i] - from) / dir[i];
        enters = fmax(enters, fmin(a, b));
        leaves = fmin(leaves, fmax(a, b));
    }
    return enters < leaves;
}

/* The mean over the lobe in the light of a box that glows evenly, by quadrature. */
static double gloss_of_box(const double low[static 3], const double high[static 3],
                           const double eye[static 3], double alpha)
{
    enum { STRATA = 500 };
    double light = 0, all = 0;
    for (int i = 0; i < STRATA * STRATA; i++) {
        const double y = (i / STRATA + 0.5) / STRATA, turn = 2 * PI * (i % STRATA + 0.5) / STRATA,
                     out = sqrt(1 - y * y), dir[3] = { out * cos(turn), y, out * sin(turn) };
        const double weight = gloss_sends(eye, dir, alpha);
        light += meets_box(low, high, dir) ? weight : 0;
        all += weight;
    }
    return light / all;
}

/* The mean of a picture whose pixels all have this roughness, and see about the same. */
static double shown_by_gloss(struct gi_test *t, float gloss, const float towards[static 3])
{
    static uint16_t texels[ROW * ROW][4];
    static float roughness[ROW * ROW];
    struct mirror surface;
    double sum = 0;
    for (int i = 0; i < ROW * ROW; i++)
        roughness[i] = gloss;
    mirror_open_rough(&surface, t, ROW, ROW, 0.05f, roughness);
    look_along(&surface, towards);
    mirror_read(&surface, texels);
    mirror_close(&surface);
    for (int i = 0; i < ROW * ROW; i++)
        sum += (double)gi_test_half(texels[i][1]);
    return sum / (ROW * ROW);
}

/* Under a ceiling that glows. Facets that lean hide each other from what comes along the ground, and reflect
 * more of that. */
static void facets_of_gloss_count_by_what_they_send(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    const double low[3] = { -2, 0, -2 }, high[3] = { 2, 1, 2 };
    const float along[] = { 0.7f, 1.5f }, gloss[] = { 0.25f, 0.35f, 0.49f };
    double worst = 0;
    gi_test_restart(t, &settings);
    light_add_box(t, low, high, (float[]){ 0, 0, 0 }, 1);
    gi_test_update(t, 4);
    for (int i = 0; i < 6; i++) {
        const double x = (double)along[i / 3], alpha = (double)(gloss[i % 3] * gloss[i % 3]),
                     eye[3] = { -x / sqrt(1 + x * x), 1 / sqrt(1 + x * x), 0 };
        const double want = gloss_of_box(low, high, eye, alpha),
                     shown = shown_by_gloss(t, gloss[i % 3], (float[]){ along[i / 3], -1, 0 });
        printf("gloss of %.2f, seen from a cosine of %.2f: %.4f instead of %.4f\n", (double)gloss[i % 3],
               eye[1], shown, want);
        worst = fmax(worst, fabs(shown / want - 1));
    }
    REQUIRE_CMP(worst, <=, 0.02);
}

TEST_GROUP(reflections)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_55_reflected_rays_cross_cascades),
        cmocka_unit_test(hard_69_views_of_one_row_reflect),
        cmocka_unit_test(a_mirror_shows_no_cells_of_a_wall),
        cmocka_unit_test(a_mirror_close_below_a_lamp_shows_it),
        cmocka_unit_test(a_mirror_tells_a_lamp_from_what_is_beside_it),
        cmocka_unit_test(metal_shows_in_a_mirror_what_it_reflects),
        cmocka_unit_test(facets_of_gloss_count_by_what_they_send),
    };
    return cmocka_run_group_tests_name("reflections", tests, light_open, light_close);
}
