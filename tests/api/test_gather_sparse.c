/* SPDX-License-Identifier: MIT
 * Gathers at half and quarter resolution against those at full resolution. */
#include "gather_picture.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979

static const enum sdfgi_gather_resolution sparse[2] = { SDFGI_GATHER_HALF, SDFGI_GATHER_QUARTER };
static const char *const names[] = { "full", "half", "quarter" };

/* ---- Scenes */

static const double half_m[3] = { 3, 2, 2.5 }, origin[3] = { 0, 0, 0 };
static const double wall_m = 0.25;

/* All cases share the context, and those of one room its light. */
static struct gi_test context;
static struct picture_scene shown;
static bool shows_room;

static void open_context(void)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.ray_count = 125;
    settings.frames_to_converge = 4;
    gi_test_renew(&context, &settings);
    picture_scene_finish(&shown);
    shown = (struct picture_scene){ .count = 0 };
    shows_room = false;
    REQUIRE_CMP((int)sdfgi_set_sky(context.gi, &(struct sdfgi_sky){ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }),
                ==, (int)SDFGI_OK);
}

static int close_context(void **state)
{
    (void)state;
    picture_scene_finish(&shown);
    gi_test_close(&context);
    return 0;
}

static void add_box(const double center[static 3], const double half[static 3], float albedo, float emission)
{
    picture_scene_add(&shown, &context, test_mesh_box(center, half, test_rotation_none), albedo, emission);
}

enum { ROOM, LAMP, TABLE, FIRST_POST, POSTS = 5, SETTLED = 24 };

/* A room with a lamp below its ceiling, a table, and thin dark posts before the wall that is seen. */
static void open_room(void)
{
    if (shows_room)
        return;
    open_context();
    shows_room = true;
    picture_scene_add(&shown, &context, test_mesh_room(origin, half_m, wall_m, test_rotation_none), 0.7f, 0);
    add_box((double[]){ 1, 1.6, 0.5 }, (double[]){ 0.4, 0.1, 0.4 }, 0.5f, 8);
    add_box((double[]){ -0.8, -1.4, 0.2 }, (double[]){ 0.5, 0.6, 0.4 }, 0.5f, 0);
    for (int i = 0; i < POSTS; i++)
        add_box((double[]){ -2 + 0.9 * i, -0.2, -1.3 + 0.1 * i }, (double[]){ 0.03, 1.8, 0.03 }, 0.1f, 0);
    gi_test_update(&context, SETTLED);
}

/* Turned about its own axis by `roll`. */
static struct picture_camera camera_at(const double position[static 3], const double forward[static 3],
                                       const double up[static 3], double roll, double tan_x, double tan_y)
{
    struct picture_camera c = { .tan_x = tan_x, .tan_y = tan_y, .near_m = 0.05 };
    double length = 0;
    for (int k = 0; k < 3; k++)
        length += forward[k] * forward[k];
    for (int k = 0; k < 3; k++) {
        c.position[k] = position[k];
        c.forward[k] = forward[k] / sqrt(length);
    }
    double right[3], across[3], norm = 0;
    for (int k = 0; k < 3; k++)
        right[k] = c.forward[(k + 1) % 3] * up[(k + 2) % 3] - c.forward[(k + 2) % 3] * up[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        norm += right[k] * right[k];
    for (int k = 0; k < 3; k++)
        right[k] /= sqrt(norm);
    for (int k = 0; k < 3; k++)
        across[k] = right[(k + 1) % 3] * c.forward[(k + 2) % 3] - right[(k + 2) % 3] * c.forward[(k + 1) % 3];
    for (int k = 0; k < 3; k++) {
        c.right[k] = cos(roll) * right[k] + sin(roll) * across[k];
        c.up[k] = cos(roll) * across[k] - sin(roll) * right[k];
    }
    return c;
}

/* Whatever the size, pixels are as wide: a light cell on the far wall has eight. */
static struct picture_camera room_camera(uint32_t width, uint32_t height)
{
    const double pixel = 0.0056;
    return camera_at((double[]){ -0.2, 0.3, 2.3 }, (double[]){ 0.05, -0.12, -1 }, (double[]){ 0, 1, 0 }, 0.02,
                     pixel * width, pixel * height);
}

/* ---- Comparison */

struct difference {
    double worst, mean, brightest; /* worst and mean are relative to the picture's mean light */
    uint32_t equal, lit;           /* pixels */
};

static struct difference compare(const struct picture *p, float (*full)[3], float (*found)[3])
{
    struct difference d = { 0 };
    double light = 0;
    for (uint32_t i = 0; i < p->width * p->height; i++) {
        double most = 0;
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs((double)found[i][k] - (double)full[i][k]));
        d.worst = fmax(d.worst, most);
        d.mean += most;
        d.brightest = fmax(d.brightest, (double)full[i][1]);
        d.lit += full[i][1] > 0;
        d.equal += memcmp(full[i], found[i], sizeof full[i]) == 0;
        light += (double)full[i][1];
    }
    d.worst /= light / d.lit;
    d.mean /= light;
    return d;
}

static struct difference compare_with(float (*full)[3], const struct picture *p,
                                      enum sdfgi_gather_resolution resolution)
{
    float(*found)[3] = picture_gather(&context, p, resolution);
    const struct difference d = compare(p, full, found);
    printf("%ux%u at %s resolution: off by %.4f in the mean, %.4f at most; %u of %u pixels are equal\n",
           p->width, p->height, names[resolution], d.mean, d.worst, d.equal, p->width * p->height);
    free(found);
    return d;
}

/* ---- Rooms */

/* Multiples of no tile, smaller than a tile, and several tiles. In suite `full` a column and a pixel, too:
 * for sides that are powers of two software drivers compile once more. */
static void half_and_quarter_equal_full_in_a_room_of_any_size(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {
        { 3, 40 }, { 37, 23 }, { 61, 29 }, { 104, 76 }, { 1, 40 }, { 1, 1 }
    };
    const size_t all = sizeof sizes / sizeof *sizes, count = getenv("SDFGI_TEST_FULL") ? all : all - 2;
    open_room();
    for (size_t i = 0; i < count; i++) {
        const struct picture_camera camera = room_camera(sizes[i][0], sizes[i][1]);
        struct picture p = picture_draw(&shown, &camera, sizes[i][0], sizes[i][1]);
        float(*full)[3] = picture_gather(&context, &p, SDFGI_GATHER_FULL);
        for (int r = 0; r < 2; r++) {
            const struct difference d = compare_with(full, &p, sparse[r]);
            REQUIRE_CMP(d.brightest, >, 0.5);
            REQUIRE_CMP(d.mean, <=, r == 0 ? 0.003 : 0.006);
            REQUIRE_CMP(d.worst, <=, 0.5);
        }
        free(full);
        picture_finish(&p);
    }
}

static bool is_thin(const struct picture *p, uint32_t i)
{
    return p->objects[i] >= FIRST_POST && i % p->width > 0 && i % p->width + 1 < p->width &&
           p->objects[i - 1] != p->objects[i] && p->objects[i + 1] != p->objects[i];
}

/* Posts are one pixel wide here. Those between samples are looked up, the others interpolate along the post.
 */
static void thin_things_are_as_at_full_resolution(void **state)
{
    (void)state;
    open_room();
    const struct picture_camera camera = camera_at(
        (double[]){ -0.2, 0.3, 2.3 }, (double[]){ 0.05, -0.12, -1 }, (double[]){ 0, 1, 0 }, 0.02, 0.9, 0.65);
    struct picture p = picture_draw(&shown, &camera, 91, 67);
    float(*full)[3] = picture_gather(&context, &p, SDFGI_GATHER_FULL);
    for (int r = 0; r < 2; r++) {
        float(*found)[3] = picture_gather(&context, &p, sparse[r]);
        uint32_t thin = 0, equal = 0;
        double worst = 0;
        for (uint32_t i = 0; i < p.width * p.height; i++) {
            if (!is_thin(&p, i))
                continue;
            thin++;
            equal += memcmp(full[i], found[i], sizeof full[i]) == 0;
            worst = fmax(worst, fabs((double)found[i][1] / (double)full[i][1] - 1));
        }
        printf("thin things at %s resolution: off by %.4f at most; %u of %u pixels are equal\n",
               names[sparse[r]], worst, equal, thin);
        REQUIRE_CMP(thin, >=, 100u);
        REQUIRE_CMP(worst, <=, 0.15);
        REQUIRE_CMP(2 * equal, >=, thin);
        free(found);
    }
    free(full);
    picture_finish(&p);
}

/* ---- Edges */

/* Two rooms without a door, of which one has a lamp, seen from above the wall between them. The near plane
 * cuts off the ceiling. */
static void open_two_rooms(double wall)
{
    open_context();
    picture_scene_add(&shown, &context, test_mesh_two_rooms(origin, half_m, wall, test_rotation_none), 0.7f,
                      0);
    add_box((double[]){ 1.5, 1.2, 0 }, (double[]){ 0.4, 0.1, 0.4 }, 0.5f, 8);
    gi_test_update(&context, SETTLED);
}

/* How a pixel lies to the wall: -1 in the dark room, 1 in the lit one, 0 in the wall. */
static int side_of(const struct picture *p, const struct picture_camera *c, uint32_t i, double wall)
{
    const double u = 2 * (i % p->width + 0.5) / p->width - 1, v = 2 * (i / p->width + 0.5) / p->height - 1;
    const double range = c->near_m / (double)p->depth[i];
    const double x =
        c->position[0] + range * (u * c->tan_x * c->right[0] - v * c->tan_y * c->up[0] + c->forward[0]);
    return x < -wall / 2 - 1e-3 ? -1 : x > wall / 2 + 1e-3 ? 1 : 0;
}

/* Brightest pixels of the dark room, of the lit one, and of the dark one at full resolution. */
static void require_dark(const struct picture_camera *camera, uint32_t width, uint32_t height, double wall)
{
    struct picture p = picture_draw(&shown, camera, width, height);
    float(*full)[3] = picture_gather(&context, &p, SDFGI_GATHER_FULL);
    for (int r = 0; r < 2; r++) {
        float(*found)[3] = picture_gather(&context, &p, sparse[r]);
        double dark = 0, dark_full = 0, lit = 0;
        uint32_t pixels = 0;
        for (uint32_t i = 0; i < width * height; i++) {
            const int side = side_of(&p, camera, i, wall);
            if (side > 0)
                lit = fmax(lit, (double)full[i][1]);
            if (side >= 0)
                continue;
            pixels++;
            dark = fmax(dark, (double)found[i][1]);
            dark_full = fmax(dark_full, (double)full[i][1]);
        }
        printf("%ux%u, wall %.4f m, at %s resolution: dark room %.2e, at full %.2e, lit room %.2f\n", width,
               height, wall, names[sparse[r]], dark, dark_full, lit);
        REQUIRE_CMP(pixels, >=, width * height / 3);
        REQUIRE_CMP(lit, >, 1.0);
        REQUIRE_CMP(dark, <=, dark_full + 1e-6);
        REQUIRE_CMP(dark_full, <=, 1e-3 * lit);
        free(found);
    }
    free(full);
    picture_finish(&p);
}

/* The wall is between one and five pixels wide, and crosses the pixels at many angles. */
static void no_light_crosses_a_wall_seen_edge_on(void **state)
{
    (void)state;
    static const double walls[] = { 0.25, 0.0625 };
    static const uint32_t sizes[][2] = { { 37, 23 }, { 53, 41 }, { 72, 48 } };
    for (int w = 0; w < 2; w++) {
        open_two_rooms(walls[w]);
        for (int i = 0; i < 6; i++) {
            struct picture_camera camera = camera_at((double[]){ 0.1, 6, 0.05 }, (double[]){ 0, -1, 0 },
                                                     (double[]){ 0, 0, -1 }, i / 6.0 * PI, 0.3, 0.2);
            camera.near_m = 5;
            require_dark(&camera, sizes[i % 3][0], sizes[i % 3][1], walls[w]);
        }
    }
}

/* ---- Odd input */

/* Background, and normals of which nothing can be made, among good pixels. */
static void spoil(struct picture *p)
{
    for (uint32_t i = 0; i < p->width * p->height; i++) {
        float *normal = p->normals[i];
        if (i % 11 == 0)
            p->depth[i] = 0;
        if (i % 7 == 0)
            memset(normal, 0, sizeof p->normals[i]);
        if (i % 13 == 0)
            normal[1] = NAN;
        if (i % 17 == 0)
            normal[2] = INFINITY;
        if (i % 19 == 0)
            normal[0] = 3e38f;
    }
}

static void background_and_useless_normals_give_0_and_spoil_nothing(void **state)
{
    (void)state;
    open_room();
    const struct picture_camera camera = room_camera(61, 29);
    struct picture p = picture_draw(&shown, &camera, 61, 29);
    float(*clean)[3] = picture_gather(&context, &p, SDFGI_GATHER_FULL);
    spoil(&p);
    for (int r = SDFGI_GATHER_FULL; r <= SDFGI_GATHER_QUARTER; r++) {
        float(*found)[3] = picture_gather(&context, &p, (enum sdfgi_gather_resolution)r);
        for (uint32_t i = 0; i < p.width * p.height; i++) {
            const bool useless = i % 11 == 0 || i % 7 == 0 || i % 13 == 0 || i % 17 == 0 || i % 19 == 0;
            if (useless)
                REQUIRE_CMP((double)found[i][1], ==, 0.0);
            else
                REQUIRE_NEAR(found[i][1], clean[i][1], 0.05 * (double)clean[i][1]);
        }
        free(found);
    }
    memset(p.depth, 0, p.width * p.height * sizeof *p.depth);
    for (int r = SDFGI_GATHER_FULL; r <= SDFGI_GATHER_QUARTER; r++) {
        float(*found)[3] = picture_gather(&context, &p, (enum sdfgi_gather_resolution)r);
        for (uint32_t i = 0; i < p.width * p.height; i++)
            REQUIRE_CMP((double)found[i][1], ==, 0.0);
        free(found);
    }
    free(clean);
    picture_finish(&p);
}

static double brightest(const struct picture *p, enum sdfgi_gather_resolution resolution)
{
    float(*found)[3] = picture_gather(&context, p, resolution);
    double most = 0;
    for (uint32_t i = 0; i < p->width * p->height; i++)
        most = fmax(most, (double)found[i][1]);
    free(found);
    return most;
}

/* A sky of 1e6 lights a plane with pi times as much: more than half floats hold. */
static void more_light_than_half_floats_hold_is_cut_or_scaled(void **state)
{
    (void)state;
    open_context();
    const float sky = 1e6f;
    REQUIRE_CMP(
        (int)sdfgi_set_sky(context.gi, &(struct sdfgi_sky){ { sky, sky, sky }, { sky, sky, sky }, { 0 } }),
        ==, (int)SDFGI_OK);
    add_box((double[]){ 0, -3, 0 }, (double[]){ 5, 1, 5 }, 0.5f, 0);
    context.frame.exposure = 1e-4f;
    gi_test_update(&context, 20);
    const struct picture_camera camera =
        camera_at((double[]){ 0, 0, 0 }, (double[]){ 0.2, -1, 0 }, (double[]){ 0, 0, -1 }, 0, 0.3, 0.2);
    struct picture p = picture_draw(&shown, &camera, 37, 23);
    for (int r = SDFGI_GATHER_FULL; r <= SDFGI_GATHER_QUARTER; r++) {
        p.desc.scale = 0;
        REQUIRE_CMP(brightest(&p, (enum sdfgi_gather_resolution)r), ==, 65504.0);
        p.desc.scale = 1e-4f;
        REQUIRE_NEAR(brightest(&p, (enum sdfgi_gather_resolution)r) / (100 * PI), 1, 0.02);
    }
    picture_finish(&p);
}

/* ---- Repetition */

static void the_same_picture_comes_out_the_same_to_the_bit(void **state)
{
    (void)state;
    open_room();
    gi_test_update(&context, 1); /* the report counts gathers from here on */
    const struct picture_camera camera = room_camera(104, 76);
    struct picture p = picture_draw(&shown, &camera, 104, 76);
    for (int r = 0; r < 2; r++) {
        float(*first)[3] = picture_gather(&context, &p, sparse[r]);
        for (int i = 0; i < 4; i++) {
            float(*again)[3] = picture_gather(&context, &p, sparse[r]);
            REQUIRE_CMP(memcmp(first, again, p.width * p.height * sizeof *first), ==, 0);
            free(again);
        }
        free(first);
    }
    static struct sdfgi_report report;
    sdfgi_get_report(context.gi, &report);
    REQUIRE_CMP(report.passes[PASS_GATHER_SPARSE].dispatches, ==, 10u);
    REQUIRE_CMP(report.passes[PASS_GATHER_SPARSE].work, ==, (uint64_t)10 * p.width * p.height);
    REQUIRE_CMP(report.passes[PASS_GATHER].dispatches, ==, 0u);
    picture_finish(&p);
}

TEST_GROUP(gather_sparse)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_and_quarter_equal_full_in_a_room_of_any_size),
        cmocka_unit_test(thin_things_are_as_at_full_resolution),
        cmocka_unit_test(background_and_useless_normals_give_0_and_spoil_nothing),
        cmocka_unit_test(the_same_picture_comes_out_the_same_to_the_bit),
        cmocka_unit_test(no_light_crosses_a_wall_seen_edge_on),
        cmocka_unit_test(more_light_than_half_floats_hold_is_cut_or_scaled),
    };
    return cmocka_run_group_tests(tests, NULL, close_context);
}
