/* SPDX-License-Identifier: MIT
 * What a ray of a reflection takes for the light of the surface that it has hit: that of light cells before
 * the surface. Of a light cell whose surfaces face along other axes alone their mean counts, where nothing
 * else tells. */
#include "host_lookup.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 32, ROWS = 2, COLUMNS = 13, HITS = ROWS * COLUMNS };

static const float SKY = 2;
/* Metres that a ray goes: it begins 0.45 cells before the mirror. */
static const double WAY = 1 - 0.45 * 0.25;

static void add_box(struct gi_test *t, double albedo, const double low[static 3], const double high[static 3])
{
    const double center[] = { (low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2 },
                 half[] = { (high[0] - low[0]) / 2, (high[1] - low[1]) / 2, (high[2] - low[2]) / 2 };
    struct test_mesh box = test_mesh_box(center, half, test_rotation_none);
    const float grey = (float)albedo;
    gi_test_add(t, &box, gi_test_material(t, (float[]){ grey, grey, grey }, (float[]){ 0, 0, 0 }));
    test_mesh_destroy(&box);
}

/* Cells of 0.25 m and a white sky. */
static void open_yard(struct gi_test *t)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = CELLS;
    settings.min_cell_size_m = 0.25f;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    gi_test_open(t, &settings);
    const struct sdfgi_sky sky = { { SKY, SKY, SKY }, { SKY, SKY, SKY }, { SKY, SKY, SKY } };
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &sky), ==, (int)SDFGI_OK);
}

/* A mirror a metre before a point, which shows the point along `dir`. */
static struct host_lookup mirror_of(const float point[static 3], const float dir[static 3])
{
    struct host_lookup lookup = { .rays = 1 };
    for (int k = 0; k < 3; k++) {
        lookup.position[k] = point[k] - dir[k];
        lookup.normal[k] = lookup.to_eye[k] = dir[k];
    }
    return lookup;
}

static float reflected(const struct host_lookup *lookup)
{
    return lookup->answers[2][1];
}

/* Beyond the end of the wall there are light cells as well, of the white floor. */
static void a_black_wall_takes_no_light_from_beyond_its_end(void **state)
{
    (void)state;
    struct gi_test t;
    open_yard(&t);
    add_box(&t, 0.8, (double[]){ -4, -0.5, -4 }, (double[]){ 4, 0, 4 });
    add_box(&t, 0, (double[]){ -1.25, 0, -1 }, (double[]){ -1, 1.5, 1 });
    gi_test_converge(&t, 400);
    struct host_lookup lookups[HITS];
    for (int i = 0; i < HITS; i++)
        lookups[i] = mirror_of(
            (float[]){ -1, 0.12f + 0.06f * (float)(i / COLUMNS), 0.25f + 0.06f * (float)(i % COLUMNS) },
            (float[]){ -1, 0, 0 });
    host_lookup_run(&t, lookups, HITS);
    gi_test_close(&t);
    float most = 0;
    for (int i = 0; i < HITS; i++) {
        REQUIRE_NEAR(lookups[i].answers[2][3], WAY, 0.05); /* it has met the wall */
        most = fmaxf(most, reflected(&lookups[i]));
    }
    printf("a black wall reflects %.5f at most of a sky of %.0f\n", (double)most, (double)SKY);
    REQUIRE_CMP((double)most, <=, 0.001 * (double)SKY);
}

/* A gap that is narrower than a cell, of which no light cell faces the walls: the one above faces up. */
static void walls_of_a_narrow_gap_have_the_light_above_it(void **state)
{
    (void)state;
    struct gi_test t;
    open_yard(&t);
    add_box(&t, 0.8, (double[]){ -1.25, -1.5, -1 }, (double[]){ -1, 0, 1 });
    add_box(&t, 0.8, (double[]){ -0.85, -1.5, -1 }, (double[]){ -0.6, 0, 1 });
    gi_test_converge(&t, 400);
    struct host_lookup lookup = mirror_of((float[]){ -1, -0.1f, 0.1f }, (float[]){ -0.0995f, -0.995f, 0 });
    host_lookup_run(&t, &lookup, 1);
    gi_test_close(&t);
    printf("the wall of a gap reflects %.3f of a sky of %.0f\n", (double)reflected(&lookup), (double)SKY);
    REQUIRE_NEAR(lookup.answers[2][3], WAY, 0.05);
    REQUIRE_CMP((double)reflected(&lookup), >=, 0.5 * (double)SKY);
    REQUIRE_CMP((double)reflected(&lookup), <=, (double)SKY);
}

TEST_GROUP(hit_light)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_black_wall_takes_no_light_from_beyond_its_end),
        cmocka_unit_test(walls_of_a_narrow_gap_have_the_light_above_it),
    };
    return cmocka_run_group_tests_name("api_hit_light", tests, NULL, NULL);
}
