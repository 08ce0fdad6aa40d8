/* SPDX-License-Identifier: MIT
 * A change of lights lights the cells again that it reaches, and no others; and direct light is afterwards as
 * if there never had been other lights. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Closed rooms of 2.4 m side by side, 0.6 m apart. Cells of 0.2 m. */
#define HALF_M 1.2
#define LEFT_M -1.5

static struct sdfgi_settings room_settings(void)
{
    struct sdfgi_settings settings = light_settings(32, 0.2f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 8 * SDFGI_VISIT_RAYS;
    settings.cell_rays_per_frame = 4096; /* a frame visits few cells: others follow the light alone */
    return settings;
}

static void open(struct gi_test *t)
{
    const struct sdfgi_settings settings = room_settings();
    gi_test_open(t, &settings);
    t->frame.exposure = 1;
}

static void open_rooms(struct gi_test *t)
{
    open(t);
    for (int i = 0; i < 2; i++) {
        const double centre[] = { i == 0 ? LEFT_M : -LEFT_M, 0, 0 }, half[] = { HALF_M, HALF_M, HALF_M };
        light_add(t, test_mesh_room(centre, half, 0.3, test_rotation_none), 0.5f, 0);
    }
}

/* ---- Which cells are lit */

struct list {
    uint32_t *cells, *direct, *light;
    uint32_t count;
    uint64_t room;
};

static struct list read_list(struct gi_test *t)
{
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    const uint32_t count = counters[SDFGI_COUNTER_LIGHT_CELLS];
    free(counters);
    return (struct list){ .cells = gi_test_read(t, RESOURCE_LIGHT_CELLS, NULL),
                          .direct = gi_test_read(t, RESOURCE_DIRECT, NULL),
                          .light = gi_test_read(t, RESOURCE_LIGHT, NULL),
                          .count = count,
                          .room = t->gi->volume.resources->extent.light_cells };
}

static void free_list(struct list *list)
{
    free(list->cells);
    free(list->direct);
    free(list->light);
}

/* Whether an entry has been lit by the last change of lights. */
static bool was_lit(const struct gi_test *t, const struct list *list, uint32_t entry)
{
    return list->direct[2 * list->room + entry] >> SDFGI_LIGHT_BITS == t->gi->volume.state.relight.lit;
}

/* Whether it lies in the half of the world that the left room is in. */
static bool is_left(const struct gi_test *t, const struct list *list, uint32_t entry)
{
    const uint32_t n = t->gi->settings.resolution;
    const uint32_t texel = list->cells[entry] & (n - 1);
    const uint32_t x = (texel - (uint32_t)t->gi->volume.state.params.cascades[0].wrap.x) & (n - 1);
    return t->gi->volume.state.params.cascades[0].origin_rel.x + 0.2f * ((float)x + 0.5f) < 0;
}

struct lit {
    uint32_t left, right, brighter, dimmer;
};

/* What leaves an entry's surfaces, of the axis with most of it, as far as its words tell order. */
static uint32_t brightest(const struct list *list, uint32_t entry)
{
    uint32_t most = 0;
    for (uint32_t axis = 0; axis < 6; axis++) {
        const uint32_t word = list->light[axis * list->room + entry], exponent = word >> 27;
        for (uint32_t shift = 0; shift < 27; shift += 9)
            most =
                (exponent << 9 | (word >> shift & 511)) > most ? exponent << 9 | (word >> shift & 511) : most;
    }
    return most;
}

/* Changes a light, and tells which cells were lit in the next frame, and how what leaves them changed. */
static struct lit change_light(struct gi_test *t, sdfgi_light light, const struct sdfgi_light_desc *desc)
{
    struct lit lit = { 0 };
    struct list before = read_list(t);
    REQUIRE_CMP((int)sdfgi_light_update(t->gi, light, desc), ==, (int)SDFGI_OK);
    gi_test_update(t, 1);
    struct list after = read_list(t);
    REQUIRE_CMP(before.count, ==, after.count);
    for (uint32_t i = 0; i < after.count; i++) {
        if (!was_lit(t, &after, i))
            continue;
        *(is_left(t, &after, i) ? &lit.left : &lit.right) += 1;
        lit.brighter += brightest(&after, i) > brightest(&before, i);
        lit.dimmer += brightest(&after, i) < brightest(&before, i);
    }
    free_list(&before);
    free_list(&after);
    return lit;
}

static void a_lamp_that_dims_lights_what_it_has_lit(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_light_desc lamp = light_point(LEFT_M + 0.5, 0.6, 0.4, 4),
                                  dim = light_point(LEFT_M + 0.5, 0.6, 0.4, 1),
                                  other = light_point(-LEFT_M, 0.2, 0.1, 3);
    open_rooms(&t);
    const sdfgi_light light = light_create(&t, &lamp);
    light_create(&t, &other);
    gi_test_update(&t, 120);
    const struct lit dims = change_light(&t, light, &dim);
    printf("a lamp dims: %u cells lit in its room, of which %u are dimmer; %u next door\n", dims.left,
           dims.dimmer, dims.right);
    REQUIRE_CMP(dims.left, >, 500u);
    REQUIRE_CMP(dims.dimmer, ==, dims.left);
    REQUIRE_CMP(dims.right, ==, 0u);
    const struct lit brightens = change_light(&t, light, &lamp);
    REQUIRE_CMP(brightens.left, ==, dims.left);
    REQUIRE_CMP(brightens.brighter, ==, dims.left);
    REQUIRE_CMP(brightens.right, ==, 0u);
    gi_test_close(&t);
}

/* A lamp that was off lights nothing yet, and one that moves something else than before. */
static void a_lamp_that_goes_on_or_moves_lights_what_it_reaches(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_light_desc off = light_point(LEFT_M + 0.5, 0.6, 0.4, 0),
                                  on = light_point(LEFT_M + 0.5, 0.6, 0.4, 4),
                                  away = light_point(-LEFT_M + 0.5, 0.6, 0.4, 4);
    open_rooms(&t);
    const sdfgi_light light = light_create(&t, &off);
    gi_test_update(&t, 20);
    const struct lit goes_on = change_light(&t, light, &on);
    REQUIRE_CMP(goes_on.brighter, >, 500u);
    const struct lit moves = change_light(&t, light, &away);
    printf("a lamp goes on: %u cells are brighter; it moves next door: %u and %u\n", goes_on.brighter,
           moves.brighter, moves.dimmer);
    /* One cell in fifteen is visited in the frame, and may change with what it finds. */
    REQUIRE_CMP(moves.dimmer, >=, goes_on.brighter * 9 / 10);
    REQUIRE_CMP(moves.brighter, >=, goes_on.brighter * 9 / 10);
    gi_test_close(&t);
}

/* ---- After many changes, in a hall. More lights than there are bits: some share one. At first lights go and
 * come, then they move, and a post with them; at last they dim. What was missed stays. */

#define HALL_M 2.8

enum { LIGHTS = SDFGI_LIGHT_BITS + 6, STEPS = 40, MOVES_FROM = 20, DIMS_FROM = 30 };

struct crowd {
    struct gi_test t;
    sdfgi_light lights[LIGHTS];
    struct sdfgi_light_desc descs[LIGHTS];
    bool exists[LIGHTS];
    sdfgi_instance post;
};

static struct sdfgi_light_desc any_light(struct test_random *random)
{
    const double x = test_random_real(random, -HALL_M, HALL_M), y = test_random_real(random, -1, 1),
                 z = test_random_real(random, -HALL_M, HALL_M);
    struct sdfgi_light_desc desc = light_point(x, y, z, (float)test_random_real(random, 0, 2));
    double way[3];
    test_random_direction(random, way);
    for (int k = 0; k < 3; k++)
        desc.direction[k] = (float)way[k];
    desc.type = (enum sdfgi_light_type)(test_random_uint(random) % 3);
    desc.range_m = test_random_uint(random) % 2 ? (float)test_random_real(random, 0.5, 2) : 0;
    desc.inner_angle_rad = 0.3f;
    desc.outer_angle_rad = (float)test_random_real(random, 0.4, 1.5);
    desc.casts_shadow = test_random_uint(random) % 8 != 0;
    return desc;
}

static void create(struct crowd *c, uint32_t i)
{
    c->lights[i] = light_create(&c->t, &c->descs[i]);
    c->exists[i] = true;
}

enum { DIMS, DIMS_TOO, MOVES, GOES };

static void change_one(struct crowd *c, struct test_random *random, uint32_t step)
{
    const uint32_t i = test_random_uint(random) % LIGHTS,
                   kinds = step < MOVES_FROM  ? GOES + 1
                           : step < DIMS_FROM ? MOVES + 1
                                              : DIMS + 1,
                   what = test_random_uint(random) % kinds;
    if (!c->exists[i]) {
        create(c, i);
        return;
    }
    if (what == GOES) {
        REQUIRE_CMP((int)sdfgi_light_destroy(c->t.gi, c->lights[i]), ==, (int)SDFGI_OK);
        c->exists[i] = false;
        return;
    }
    if (what == MOVES)
        c->descs[i] = any_light(random);
    else
        for (int k = 0; k < 3; k++)
            c->descs[i].intensity[k] =
                test_random_uint(random) % 4 ? (float)test_random_real(random, 0.1, 2) : 0;
    REQUIRE_CMP((int)sdfgi_light_update(c->t.gi, c->lights[i], &c->descs[i]), ==, (int)SDFGI_OK);
}

static sdfgi_instance add_post(struct gi_test *t, double z)
{
    return light_add_box(t, (double[]){ -0.2, -HALF_M, z }, (double[]){ 0.2, 0.6, z + 0.4 },
                         (float[]){ 0.7f, 0.2f, 0.1f }, 0);
}

static void move_post(struct crowd *c, double z)
{
    if (c->post.id)
        REQUIRE_CMP((int)sdfgi_instance_destroy(c->t.gi, c->post), ==, (int)SDFGI_OK);
    c->post = add_post(&c->t, z);
}

static void open_hall(struct gi_test *t)
{
    const double centre[] = { 0, 0, 0 }, half[] = { HALL_M, HALF_M, HALL_M };
    open(t);
    light_add(t, test_mesh_room(centre, half, 0.3, test_rotation_none), 0.5f, 0);
}

static void require_none_waits(const struct gi_test *t)
{
    REQUIRE_TRUE(!sdfgi_relight_is_due(&t->gi->volume.state.relight));
}

/* In the order in which they are listed. */
static void add_in_order(struct gi_test *t, const struct crowd *c)
{
    const struct pool *pool = &c->t.gi->scene.lights;
    for (uint32_t slot = 0; slot < LIGHTS; slot++)
        for (uint32_t i = 0; i < LIGHTS; i++)
            if (sdfgi_pool_index(pool, c->lights[i].id) == slot)
                light_create(t, &c->descs[i]);
}

static void require_same_direct_light(struct gi_test *a, struct gi_test *b)
{
    struct list x = read_list(a), y = read_list(b);
    uint32_t lit = 0, differ = 0;
    REQUIRE_CMP(x.count, ==, y.count);
    for (uint32_t i = 0; i < x.count; i++) {
        const struct gi_test_direct p = gi_test_direct_at(x.direct, x.room, 0, i),
                                    q = gi_test_direct_at(y.direct, y.room, 0, i);
        lit += q.color != 0;
        differ += x.cells[i] != y.cells[i] || memcmp(&p, &q, sizeof p) != 0;
    }
    printf("after many changes of %d lights: %u of %u light cells are lit, %u otherwise than anew\n", LIGHTS,
           lit, x.count, differ);
    REQUIRE_CMP(lit, >, 1000u);
    REQUIRE_CMP(differ, ==, 0u);
    free_list(&x);
    free_list(&y);
}

static void many_changes_leave_the_direct_light_of_the_last(void **state)
{
    (void)state;
    static struct crowd c;
    static struct gi_test fresh;
    struct test_random random = { 20261128 };
    open_hall(&c.t);
    for (uint32_t i = 0; i < LIGHTS; i++) {
        c.descs[i] = any_light(&random);
        create(&c, i);
    }
    gi_test_update(&c.t, 4);
    double post_z = 0;
    for (uint32_t step = 0; step < STEPS; step++) {
        for (uint32_t i = 0; step == MOVES_FROM && i < LIGHTS; i++)
            if (!c.exists[i])
                create(&c, i);
        for (uint32_t n = 1 + test_random_uint(&random) % 3; n > 0; n--)
            change_one(&c, &random, step);
        if (step < DIMS_FROM && step % 5 == 4)
            move_post(&c, post_z = test_random_real(&random, -2, 2));
        gi_test_update(&c.t, 1);
    }
    /* Lights that change in each frame keep no cell waiting. */
    require_none_waits(&c.t);

    open_hall(&fresh);
    add_post(&fresh, post_z);
    add_in_order(&fresh, &c);
    gi_test_update(&fresh, 10);
    require_none_waits(&fresh);
    require_same_direct_light(&c.t, &fresh);
    gi_test_close(&fresh);
    gi_test_close(&c.t);
}

TEST_GROUP(lamps)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_that_dims_lights_what_it_has_lit),
        cmocka_unit_test(a_lamp_that_goes_on_or_moves_lights_what_it_reaches),
        cmocka_unit_test(many_changes_leave_the_direct_light_of_the_last),
    };
    return cmocka_run_group_tests_name("lamps", tests, NULL, NULL);
}
