/* SPDX-License-Identifier: MIT
 * Depths around probes against rays in double precision through the same bits, filtered alike (HARD_CASES
 * rows 41 and 43). */
#include "hard_case.h"
#include "oracle_encode.h"
#include "oracle_trace.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEXELS = SDFGI_OCCLUSION_TEXELS, STRIDE = SDFGI_OCCLUSION_STRIDE };

static const double range = SDFGI_OCCLUSION_RANGE;

struct moments {
    double mean, square; /* cells, cells squared */
};

/* Rays from lattice corners in symmetric directions run exactly through edges of sub-voxels: whether those
 * stop them is a matter of rounding. */
struct depths {
    double low[TEXELS][TEXELS], high[TEXELS][TEXELS];
};

struct comparison {
    double mean_error, variance_error; /* of texels that no such ray reaches; for others, how far outside */
    uint32_t probes, texels, doubtful, wrong_borders;
};

/* ---- The reference */

static void texel_direction(int texel, double direction[static 3])
{
    const double square[2] = { (texel % TEXELS + 0.5) * 2 / TEXELS - 1,
                               (texel / TEXELS + 0.5) * 2 / TEXELS - 1 };
    double d[3];
    oracle_octahedral_decode(square, d);
    /* The library's maps have +Y in the middle where the reference has +Z. */
    direction[0] = 4 * d[0];
    direction[1] = 4 * d[2];
    direction[2] = 4 * d[1];
}

/* Depths between which the stored one must be: what a ray touches may stop it, what stops all beside it must.
 */
static void trace_depth(const struct oracle_bits *bits, const double position[static 3], int texel,
                        double *low, double *high)
{
    double direction[3];
    texel_direction(texel, direction);
    *high = 0;
    for (int neighbour = 0; neighbour < 8; neighbour++) {
        double origin[3];
        for (int k = 0; k < 3; k++)
            origin[k] = 4 * position[k] + (neighbour >> k & 1 ? 2e-4 : -2e-4) * (k + 1);
        *high = fmax(*high, fmin(oracle_trace(bits, origin, direction, range).distance, range));
    }
    const double origin[3] = { 4 * position[0], 4 * position[1], 4 * position[2] };
    *low = fmin(oracle_trace_touch(bits, origin, direction, range, 1e-3), *high);
}

static void trace_depths(const struct oracle_bits *bits, const double position[static 3],
                         struct depths *depths)
{
    for (int i = 0; i < TEXELS * TEXELS; i++)
        trace_depth(bits, position, i, &depths->low[i / TEXELS][i % TEXELS],
                    &depths->high[i / TEXELS][i % TEXELS]);
}

/* A 3x3 tent around texel (x, y) of the map with its border, 1 to 16. */
static struct moments filtered(double depths[TEXELS][TEXELS], int x, int y)
{
    struct moments m = { 0, 0 };
    for (int i = 0; i < 9; i++) {
        const int dx = i % 3 - 1, dy = i / 3 - 1;
        uint32_t source[2];
        oracle_octahedral_border(TEXELS, (uint32_t)(x + dx), (uint32_t)(y + dy), source);
        const double d = depths[source[1] - 1][source[0] - 1], weight = (2 - abs(dx)) * (2 - abs(dy)) / 16.0;
        m.mean += weight * d;
        m.square += weight * d * d;
    }
    return m;
}

/* ---- What the library stored */

static struct moments stored(uint32_t packed)
{
    return (struct moments){ (packed & 0xffff) / 65535.0 * range, (packed >> 16) / 65535.0 * range * range };
}

/* Position of a probe in cells; false if it is dead. sdfgi_space.glsl says how a moved one is packed. */
static bool probe_position(uint32_t state, const uint32_t probe[static 3], double position[static 3])
{
    for (int k = 0; k < 3; k++) {
        position[k] = 8.0 * probe[k];
        if (state >> 30 & 1)
            position[k] += (double)(state >> (5 * k) & 31) - 16 + 0.5;
    }
    return !(state >> 31);
}

/* How many texels of the border are not the bits of those that they repeat. */
static uint32_t wrong_border_texels(const uint32_t *map)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < STRIDE * STRIDE; i++) {
        uint32_t source[2];
        oracle_octahedral_border(TEXELS, i % STRIDE, i / STRIDE, source);
        wrong += map[i] != map[source[0] + STRIDE * source[1]];
    }
    return wrong;
}

static void compare_texel(struct comparison *c, struct depths *depths, int x, int y, struct moments have)
{
    const struct moments low = filtered(depths->low, x, y), high = filtered(depths->high, x, y);
    c->texels++;
    c->mean_error = fmax(c->mean_error, fmax(low.mean - have.mean, have.mean - high.mean));
    if (high.mean - low.mean > 2e-4) {
        c->doubtful++;
        return;
    }
    const double middle = (low.mean + high.mean) / 2, square = (low.square + high.square) / 2;
    const double variance = (have.square - have.mean * have.mean) - (square - middle * middle);
    c->variance_error = fmax(c->variance_error, fabs(variance));
}

static void compare_probe(struct comparison *c, const struct oracle_bits *bits,
                          const double position[static 3], const uint32_t *map)
{
    static struct depths depths;
    trace_depths(bits, position, &depths);
    c->wrong_borders += wrong_border_texels(map);
    for (int y = 1; y <= TEXELS; y++)
        for (int x = 1; x <= TEXELS; x++)
            compare_texel(c, &depths, x, y, stored(map[x + STRIDE * y]));
    c->probes++;
}

static uint32_t probe_slot(const struct gi_test *t, const uint32_t probe[static 3], uint32_t side)
{
    const ivec3 wrap = t->gi->volume.state.params.cascades[0].probe_wrap;
    const uint32_t x = (probe[0] + (uint32_t)wrap.x) % side, y = (probe[1] + (uint32_t)wrap.y) % side,
                   z = (probe[2] + (uint32_t)wrap.z) % side;
    return x + side * (y + side * z);
}

/* Every probe that is alive and stands inside the volume. */
static struct comparison compare_probes(struct gi_test *t)
{
    struct comparison c = { 0 };
    const uint32_t side = t->gi->settings.resolution / SDFGI_PROBE_SPACING + 1;
    struct oracle_bits bits = gi_test_bits(t, 0);
    uint32_t *states = gi_test_read(t, RESOURCE_PROBES, NULL),
             *maps = gi_test_read(t, RESOURCE_OCCLUSION, NULL);
    for (uint32_t i = 0; i < side * side * side; i++) {
        const uint32_t probe[3] = { i % side, i / side % side, i / side / side },
                       slot = probe_slot(t, probe, side);
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside = inside && probe[k] > 0 && probe[k] + 1 < side;
        double position[3];
        if (probe_position(states[slot], probe, position) && inside)
            compare_probe(&c, &bits, position, maps + (size_t)STRIDE * STRIDE * slot);
    }
    free(states);
    free(maps);
    oracle_bits_destroy(&bits);
    return c;
}

static void check_scene(const char *name, struct test_mesh mesh)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    gi_test_renew(&pass_context, &settings);
    const double place[3] = { 10.3, -4.1, 6.2 }; /* slots wrap */
    const float identity[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    pass_scene_place(&pass_context, gi_test_mesh(&pass_context, &mesh), identity, place);
    pass_scene_stand(&pass_context, place);
    gi_test_update(&pass_context, 1);
    const struct comparison c = compare_probes(&pass_context);
    printf("%s: %u probes, mean %.5f cell off, variance %.5f; %u of %u texels graze edges\n", name, c.probes,
           c.mean_error, c.variance_error, c.doubtful, c.texels);
    REQUIRE_CMP(c.probes, >, 200u);
    HARD_CASE_AT_MOST(41, "border texels of depths that are no copies", c.wrong_borders, 0);
    HARD_CASE_AT_MOST(43, "mean of stored depths, off by cells", c.mean_error, 0.002);
    HARD_CASE_AT_MOST(43, "variance of stored depths, off by cells squared", c.variance_error, 0.02);
    REQUIRE_CMP(c.doubtful, <, c.texels / 4);
    test_mesh_destroy(&mesh);
}

/* By default walls that are turned and a torus, whose variance is farthest off; in suite `full` others too.
 */
static void hard_43_depths_of_flat_walls_keep_their_variance(void **state)
{
    (void)state;
    const double center[3] = { 0.1, 0, 0.05 };
    double turned[9];
    test_rotation((double[]){ 1, 2, 3 }, 0.4, turned);
    if (getenv("SDFGI_TEST_FULL"))
        check_scene("room", test_mesh_room(center, (double[]){ 6.1, 5.3, 5.7 }, 0.3, test_rotation_none));
    check_scene("turned room", test_mesh_room(center, (double[]){ 5.1, 4.3, 4.7 }, 0.3, turned));
}

static void hard_43_depths_of_curved_walls_keep_their_variance(void **state)
{
    (void)state;
    const double center[3] = { 0.11, -0.07, 0.19 };
    if (getenv("SDFGI_TEST_FULL"))
        check_scene("bumpy sphere", test_mesh_bumpy_sphere(center, 5, 0.2, 5));
    check_scene("torus", test_mesh_torus(center, 4.5, 2, test_rotation_none, 64, 32));
}

TEST_GROUP(occlusion)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_43_depths_of_flat_walls_keep_their_variance),
        cmocka_unit_test(hard_43_depths_of_curved_walls_keep_their_variance),
    };
    return cmocka_run_group_tests_name("occlusion", tests, NULL, pass_context_close);
}
