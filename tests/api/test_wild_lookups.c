/* SPDX-License-Identifier: MIT
 * A host's shader passes what it has: the normal of a triangle without area, the position of a vertex that
 * went wrong. Every lookup ends and answers with finite light, not below zero, no brighter than what shines.
 */
#include "require.h"
#include "test_group.h"
#include "test_memory.h"
#include "host_lookup.h"

#include <math.h>
#include <stdlib.h>

enum { OUTPUTS = HOST_LOOKUP_ANSWERS, CELLS = 32, PLACES = 3 };

static const double CELL = 0.25; /* m */
static const float SKY = 2, PI = 3.14159265f, SKY_M = 65504;
static const float wild_values[] = { NAN, INFINITY, -INFINITY, 3e38f, -3e38f, 1e20f, -1e-38f, 0 };
enum { WILD = sizeof wild_values / sizeof wild_values[0], WILD_VECTORS = 4 * WILD };
enum { LOOKUPS = WILD_VECTORS * 4 * PLACES };

/* All components are wild, or one of them. */
static void wild_vector(uint32_t index, const float usual[static 3], float out[3])
{
    for (uint32_t k = 0; k < 3; k++)
        out[k] = index < WILD || index / WILD - 1 == k ? wild_values[index % WILD] : usual[k];
}

/* Thin sheets at a distance of a cell in the lower half of the cascade and along its top: cells that hold a
 * surface and have open faces, and no empty cell beside them. A ball in the air between. */
static void add_scene(struct gi_test *t)
{
    const sdfgi_material grey = gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 0, 0, 0 });
    struct test_mesh mesh = test_mesh_sphere((double[]){ 0.1, 1.5, 0.2 }, 0.8, 3);
    for (int i = 0; i < CELLS; i += i == CELLS / 2 ? CELLS / 2 - 4 : 1) {
        struct test_mesh sheet = test_mesh_plane((double[]){ 0, CELL * (i + 0.6) - CELL * CELLS / 2, 0 },
                                                 (double[]){ 0, 0, 4.5 }, (double[]){ 4.5, 0, 0 }, 1);
        test_mesh_append(&mesh, &sheet);
        test_mesh_destroy(&sheet);
    }
    gi_test_add(t, &mesh, grey);
    test_mesh_destroy(&mesh);
    const struct sdfgi_sky sky = { { SKY, SKY, SKY }, { SKY, SKY, SKY }, { SKY, SKY, SKY } };
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &sky), ==, (int)SDFGI_OK);
}

/* Usual inputs at a sheet within the pile, at the ball and in the air, of which one is replaced by a wild
 * one, or all three. */
static void fill(struct host_lookup *lookup, uint32_t index)
{
    static const float positions[PLACES][3] = { { 0.1f, -2.1f, 0.2f }, { 0.1f, 2.3f, 0.2f }, { -2, 1, 2 } };
    static const float normal[3] = { 0, 1, 0 }, to_eye[3] = { 0.5f, 1, 0.3f };
    const uint32_t vector = index % WILD_VECTORS, which = index / WILD_VECTORS % 4,
                   place = index / WILD_VECTORS / 4 % PLACES;
    *lookup = (struct host_lookup){ .roughness = index & 1 ? 0 : wild_values[index / 2 % WILD],
                                    .rays = (float)(index % 3) };
    memcpy(lookup->position, positions[place], sizeof lookup->position);
    memcpy(lookup->normal, normal, sizeof normal);
    memcpy(lookup->to_eye, to_eye, sizeof to_eye);
    if (which == 0 || which == 3)
        wild_vector(vector, positions[place], lookup->position);
    if (which == 1 || which == 3)
        wild_vector(vector, normal, lookup->normal);
    if (which == 2 || which == 3)
        wild_vector(vector, to_eye, lookup->to_eye);
    /* What a shader that does not write leaves behind must not look like light. */
    for (int i = 0; i < OUTPUTS; i++)
        lookup->answers[i][0] = NAN;
}

static bool is_light(const struct host_lookup *lookup)
{
    bool good = lookup->answers[2][3] >= 0 && lookup->answers[2][3] <= SKY_M;
    for (int i = 0; i < OUTPUTS; i++)
        for (int k = 0; k < 3; k++)
            good =
                good && lookup->answers[i][k] >= 0 && lookup->answers[i][k] <= (i < 2 ? PI : 1) * SKY * 1.01f;
    return good;
}

static void show(const struct host_lookup *l)
{
    print_message("position %g %g %g, roughness %g, normal %g %g %g, to_eye %g %g %g\n",
                  (double)l->position[0], (double)l->position[1], (double)l->position[2],
                  (double)l->roughness, (double)l->normal[0], (double)l->normal[1], (double)l->normal[2],
                  (double)l->to_eye[0], (double)l->to_eye[1], (double)l->to_eye[2]);
    for (int i = 0; i < OUTPUTS; i++)
        print_message("  answer %d: %g %g %g, %g\n", i, (double)l->answers[i][0], (double)l->answers[i][1],
                      (double)l->answers[i][2], (double)l->answers[i][3]);
}

static void lookups_of_anything_give_finite_light(void **state)
{
    (void)state;
    struct gi_test t = { 0 };
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = CELLS;
    settings.min_cell_size_m = (float)CELL;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 2 * SDFGI_VISIT_RAYS;
    gi_test_open(&t, &settings);
    add_scene(&t);
    gi_test_converge(&t, 400);
    struct host_lookup *lookups = test_array_alloc(LOOKUPS, sizeof *lookups);
    for (uint32_t i = 0; i < LOOKUPS; i++)
        fill(&lookups[i], i);
    host_lookup_run(&t, lookups, LOOKUPS);
    uint32_t bad = 0;
    for (uint32_t i = 0; i < LOOKUPS; i++)
        if (!is_light(&lookups[i]) && bad++ < 8)
            show(&lookups[i]);
    free(lookups);
    gi_test_close(&t);
    REQUIRE_CMP(bad, ==, 0);
}

TEST_GROUP(wild_lookups)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = { cmocka_unit_test(lookups_of_anything_give_finite_light) };
    return cmocka_run_group_tests_name("api_wild_lookups", tests, NULL, NULL);
}
