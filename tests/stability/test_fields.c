/* SPDX-License-Identifier: MIT
 * Fields of light that are known at every point, because the test writes them where lookups read: what
 * interpolation makes of them, and at which positions pictures read them (HARD_CASES rows 41, 42, 46, 66). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RESOLUTION = 32, LARGE = 64, MOST_SIDE = LARGE / SDFGI_PROBE_SPACING + 1 };

/* Of a normal number with at most eleven bits, which is exact. */
static uint16_t half_of(double value)
{
    int exponent;
    const double mantissa = frexp(value, &exponent);
    return (uint16_t)((exponent + 14) << 10 | ((int)ldexp(mantissa, 11) & 1023));
}

/* What lookups make of 1 in the atlas or in a light cell. */
static double unit_of(const struct gi_test *t)
{
    return PI * (double)t->gi->volume.state.params.exposure_inverse;
}

/* ---- Probes in the air */

/* A value for a probe of the lattice. */
typedef double (*probe_value)(const int probe[static 3]);

/* All texels of all probes; their confidence is 1. */
static void write_probes(struct gi_test *t, probe_value value)
{
    static uint16_t texels[MOST_SIDE * MOST_SIDE * MOST_SIDE][SDFGI_IRRADIANCE_COUNT][4];
    const ivec3 wrap = t->gi->volume.state.params.cascades[0].probe_wrap;
    const int side = (int)t->gi->settings.resolution / SDFGI_PROBE_SPACING + 1, probes = side * side * side;
    for (int i = 0; i < probes; i++) {
        const int probe[3] = { i % side, i / side % side, i / side / side };
        const int slot = (probe[0] + wrap.x) % side +
                         side * ((probe[1] + wrap.y) % side + side * ((probe[2] + wrap.z) % side));
        for (int k = 0; k < SDFGI_IRRADIANCE_COUNT; k++) {
            const uint16_t half = half_of(value(probe));
            const uint16_t texel[4] = { half, half, half, 0xbc00 /* -1 */ };
            memcpy(texels[slot][k], texel, sizeof texel);
        }
    }
    const VkBuffer buffer = t->gi->volume.resources->buffers[RESOURCE_IRRADIANCE].handle;
    gpu_test_buffer_write(&t->gpu, buffer, 0, (size_t)probes * sizeof texels[0], texels);
}

/* Air under a sky, whose probes hold the field. */
static void start_air(struct gi_test *t, uint32_t resolution, probe_value value)
{
    const struct sdfgi_settings settings = light_settings(resolution, 0.25f);
    gi_test_restart(t, &settings);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 2);
    write_probes(t, value);
}

/* World space of a place in the cell space of the cascade. */
static struct gi_test_point point_at(const struct gi_test *t, const double cells[static 3],
                                     const float normal[static 3])
{
    const struct oracle_grid grid = gi_test_grid(t, 0);
    struct gi_test_point point;
    for (int i = 0; i < 3; i++) {
        point.position[i] = (float)(grid.origin[i] + 4 * grid.step[i] * cells[i]);
        point.normal[i] = normal[i];
    }
    return point;
}

static double value_at(struct gi_test *t, const double cells[static 3], const float normal[static 3])
{
    return light_white_at(t, point_at(t, cells, normal)) / unit_of(t);
}

static const float normals[6][3] = { { 1, 0, 0 },  { -1, 0, 0 }, { 0, 1, 0 },
                                     { 0, -1, 0 }, { 0, 0, 1 },  { 0, 0, -1 } };

static double rising_value(const int probe[static 3])
{
    return 1 + probe[0] / 4.0;
}

/* A probe counts by how far it faces the surface as well, so that only places between two probes that face
 * alike are their mean. Elsewhere light is that of a place that is off by a share of the way from probe to
 * probe, which is the same on both sides of the middle: there is no shift. */
static void hard_42_a_field_that_rises_from_probe_to_probe(void **state)
{
    struct gi_test *t = *state;
    start_air(t, RESOLUTION, rising_value);
    double at_middle = 0, off = 0, shift = 0, fall = 0;
    for (int side = 2; side < 6; side++) {
        double before = 0;
        for (int i = 0; i <= 16; i++) {
            const double x = 12 + i / 2.0, y = side < 4 ? 19 : 13;
            const double found = value_at(t, (double[]){ x, y, 14.5 }, normals[side]),
                         mirrored = value_at(t, (double[]){ 32 - x, y, 14.5 }, normals[side]);
            const double error = found - (1 + x / 32);
            at_middle = i % 16 == 0 ? fmax(at_middle, fabs(error)) : at_middle;
            off = fmax(off, 4 * fabs(error));
            shift = fmax(shift, fabs(found + mirrored - 3));
            fall = fmax(fall, before - found);
            before = found;
        }
    }
    printf("probes: off by %.5f in the middle, elsewhere by %.4f of a spacing; shifted by %.6f\n", at_middle,
           off, shift);
    HARD_CASE_AT_MOST(42, "field in the middle between probes, off by", at_middle, 1e-3);
    HARD_CASE_AT_MOST(42, "field of probes, shift", shift, 1e-3);
    HARD_CASE_AT_MOST(42, "place that a field of probes shows, off by probe spacings", off, 0.1);
    REQUIRE_CMP(fall, <=, 1e-6);
}

/* Neighbours differ by as much as 1. */
static double uneven_value(const int probe[static 3])
{
    return 1 + (probe[0] * 5 + probe[1] * 3 + probe[2] * 7) % 8 / 8.0;
}

/* The others have a weight of 1e-4, or less. From 23 cells off the middle on light fades to the sky's. */
static void hard_46_a_point_on_a_probe_reads_that_probe(void **state)
{
    struct gi_test *t = *state;
    start_air(t, LARGE, uneven_value);
    double worst = 0;
    for (int i = 0; i < 27; i++)
        for (int side = 0; side < 6; side++) {
            const int probe[3] = { 3 + i % 3, 3 + i / 3 % 3, 3 + i / 9 };
            const double cells[3] = { 8.0 * probe[0], 8.0 * probe[1], 8.0 * probe[2] };
            worst = fmax(worst, fabs(value_at(t, cells, normals[side]) / uneven_value(probe) - 1));
            for (int k = 0; k < 3; k++) /* so near that the direction to it means little */
                for (int power = -24; power < -12; power += 3) {
                    double near[3];
                    memcpy(near, cells, sizeof near);
                    near[k] += ldexp(1, power);
                    REQUIRE_TRUE(isfinite(value_at(t, near, normals[side])));
                }
        }
    printf("on a probe: off by %.5f\n", worst);
    HARD_CASE_AT_MOST(46, "light on a probe, off that probe's by", worst, 1e-3);
}

/* ---- Light cells on a floor */

static uint32_t floor_mantissa(uint32_t x, uint32_t z)
{
    return 256 + 2 * x + 3 * z;
}

/* Writes the irradiance of the light cells on the floor, which RGB9E5 holds exactly. */
static void write_floor(struct gi_test *t, uint32_t layer, uint32_t low, uint32_t high)
{
    uint64_t size;
    uint32_t *surfaces = gi_test_read(t, RESOURCE_SURFACES, &size);
    const uint64_t room = t->gi->volume.resources->extent.light_cells;
    for (uint32_t z = low; z < high; z++)
        for (uint32_t x = low; x < high; x++) {
            const uint32_t m = floor_mantissa(x, z),
                           entry = gi_test_light_entry(t, 0, (uint32_t[]){ x, layer, z });
            surfaces[2 * room + entry] = m | m << 9 | m << 18 | 15u << 27;
        }
    gpu_test_buffer_write(&t->gpu, t->gi->volume.resources->buffers[RESOURCE_SURFACES].handle, 0, size,
                          surfaces);
    free(surfaces);
}

/* From the centres of cells to those of the nearest sub-voxels of the floor, which lie a little aside. They
 * are not interpolated. */
static double distances_off(struct gi_test *t, uint32_t layer)
{
    float *distances = gi_test_distances(t, 0);
    double worst = 0;
    for (uint32_t y = layer; y < layer + 14; y++)
        for (uint32_t x = 0; x < RESOLUTION; x++) {
            const double height = y - layer + 0.875, exact = sqrt(height * height + 2 * 0.125 * 0.125);
            const float found = distances[x + RESOLUTION * (y + RESOLUTION * x)];
            worst = fmax(worst, fabs((double)found - exact));
        }
    free(distances);
    return worst;
}

static void hard_42_a_field_that_rises_from_light_cell_to_light_cell(void **state)
{
    enum { LOW = 8, HIGH = 24, POINTS = 200, LAYER = 16 };
    struct gi_test *t = *state;
    struct test_random random = { 42 };
    const struct sdfgi_settings settings = light_settings(RESOLUTION, 0.25f);
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -7, -1, -7 }, (double[]){ 7, -0.05, 7 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 2);
    write_floor(t, LAYER, LOW, HIGH);
    double worst = 0;
    for (int i = 0; i < POINTS; i++) {
        const double x = test_random_real(&random, LOW + 1.5, HIGH - 1.5),
                     z = test_random_real(&random, LOW + 1.5, HIGH - 1.5);
        const double exact = (256 + 2 * (x - 0.5) + 3 * (z - 0.5)) / 512;
        worst = fmax(worst, fabs(value_at(t, (double[]){ x, LAYER - 0.2, z }, normals[2]) / exact - 1));
    }
    printf("light cells: off by %.6f\n", worst);
    HARD_CASE_AT_MOST(42, "field of light cells, off by", worst, 1e-3);
    HARD_CASE_AT_MOST(42, "distance over a plane, off by cells", distances_off(t, LAYER), 1e-3);
}

/* ---- Octahedral maps of irradiance */

/* Texels on the edge of the map stand for the same directions twice. */
static uint32_t texels_that_differ(struct gi_test *t)
{
    enum { TEXELS = SDFGI_IRRADIANCE_TEXELS, LAST = TEXELS - 1 };
    const uint32_t probes = (uint32_t)t->gi->volume.resources->extent.probes;
    uint64_t(*texels)[TEXELS][TEXELS] = gi_test_read(t, RESOURCE_IRRADIANCE, NULL);
    uint32_t differ = 0, lit = 0;
    for (uint32_t i = 0; i < probes; i++)
        for (int k = 0; k < TEXELS; k++) {
            lit += texels[i][0][k] != 0;
            differ += texels[i][0][k] != texels[i][0][LAST - k];
            differ += texels[i][LAST][k] != texels[i][LAST][LAST - k];
            differ += texels[i][k][0] != texels[i][LAST - k][0];
            differ += texels[i][k][LAST] != texels[i][LAST - k][LAST];
        }
    free(texels);
    REQUIRE_CMP(lit, >, probes);
    return differ;
}

/* Around the lower half of the sphere, a degree a step: the map's edges are at multiples of 90 degrees. The
 * largest change of a step over an edge, relative to that of steps within a quarter. */
static double jump_at_seams(struct gi_test *t)
{
    enum { STEPS = 360 };
    static struct gi_test_point points[STEPS];
    static float found[STEPS][3];
    double seam = 0, within = 0;
    for (int i = 0; i < STEPS; i++) {
        const double angle = (i + 0.5) * PI / 180;
        points[i] = (struct gi_test_point){ { 0.3f, 0.4f, -0.2f },
                                            { (float)(0.6 * cos(angle)), -0.8f, (float)(0.6 * sin(angle)) } };
    }
    gi_test_irradiance(t, points, STEPS, found);
    for (int i = 0; i < STEPS; i++) {
        const double step = fabs((double)found[(i + 1) % STEPS][1] - (double)found[i][1]);
        if ((i + 1) % 90 == 0)
            seam = fmax(seam, step);
        else
            within = fmax(within, step);
    }
    REQUIRE_CMP(within, >, 0.0);
    return seam / within;
}

static void hard_41_maps_of_irradiance_have_no_seams(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(RESOLUTION, 0.25f);
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -3, -2, -3 }, (double[]){ 3, -1, 3 }, (float[]){ 0.2f, 0.5f, 0.1f }, 0);
    light_add_box(t, (double[]){ 1.2, -1, -0.4 }, (double[]){ 1.6, 0, 0.9 }, (float[]){ 0.5f, 0.5f, 0.5f },
                  3);
    light_set_uniform_sky(t, 0.5f);
    gi_test_converge(t, 200);
    const double jump = jump_at_seams(t);
    printf("seams: %.3f of the largest step within\n", jump);
    HARD_CASE_AT_MOST(41, "texels of irradiance on a seam that are no copies", texels_that_differ(t), 0);
    HARD_CASE_AT_MOST(41, "step over a seam over the largest within a quarter", jump, 1.5);
}

/* ---- Positions from depth */

#define FAR_M  10240.0 /* the middle of a cascade */
#define CELL_M 64.0    /* less than that of any cascade which reaches so far from a camera: 84 m at 256^3 */

enum { PIXELS = 256 };

static double deep_value(const int probe[static 3])
{
    return 1 + probe[2];
}

struct lens {
    double near_m, far_m; /* far 0: infinite, and reversed */
    bool as_integers;     /* of 24 bits */
    bool parallel;        /* an orthographic camera, with reversed depth */
};

static float depth_of(const struct lens *lens, double range_m)
{
    const double n = lens->near_m, f = lens->far_m;
    if (lens->parallel)
        return (float)((f - range_m) / (f - n));
    const double depth = f > 0 ? (1 / n - 1 / range_m) / (1 / n - 1 / f) : n / range_m;
    return (float)(lens->as_integers ? floor(depth * 0xffffff + 0.5) / 0xffffff : depth);
}

/* The eye is in the origin and looks along -z; pixels cover two hundredths of the distance. */
static struct sdfgi_gather_desc lens_desc(const struct lens *lens)
{
    struct sdfgi_gather_desc desc = { .width = PIXELS,
                                      .height = 1,
                                      .background_depth = lens->far_m > 0 ? 1 : 0 };
    float *m = desc.inverse_view_projection;
    const double n = lens->near_m, f = lens->far_m;
    if (lens->parallel) {
        desc.background_depth = 0;
        m[0] = m[5] = (float)(0.01 * FAR_M);
        m[10] = (float)(f - n);
        m[14] = (float)-f;
        m[15] = 1;
        return desc;
    }
    m[0] = m[5] = 0.01f;
    m[11] = (float)(f > 0 ? 1 / f - 1 / n : 1 / n);
    m[14] = -1;
    m[15] = f > 0 ? (float)(1 / n) : 0;
    return desc;
}

/* Some way before and behind the middle of the cascade, at probes and between them. */
static double pixel_range(int pixel)
{
    return FAR_M + 300 * sin(pixel * 0.37);
}

static void gather_pixels(struct gi_test *t, const struct lens *lens, uint16_t found[static PIXELS][4])
{
    static float depth[PIXELS], normal[PIXELS][4];
    for (int i = 0; i < PIXELS; i++) {
        depth[i] = depth_of(lens, pixel_range(i));
        normal[i][1] = 1;
    }
    struct gpu_test_image images[3] = {
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, PIXELS, 1, depth),
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, PIXELS, 1, normal),
        gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, PIXELS, 1, NULL),
    };
    struct sdfgi_gather_desc desc = lens_desc(lens);
    desc.depth = images[0].view;
    desc.normal = images[1].view;
    desc.output = images[2].view;
    gi_test_gather(t, &desc);
    gpu_test_image_read(&t->gpu, images[2].image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        images[2].extent, 8, found);
    for (int i = 0; i < 3; i++)
        gpu_test_image_destroy(&t->gpu, &images[i]);
}

/* How far a pixel's light is from that at its place, in cells: light rises along the way. */
static double position_error(struct gi_test *t, const struct lens *lens)
{
    static uint16_t found[PIXELS][4];
    static struct gi_test_point points[2 * PIXELS];
    static float light[2 * PIXELS][3];
    gather_pixels(t, lens, found);
    for (int i = 0; i < 2 * PIXELS; i++) {
        const double range = pixel_range(i / 2), x = 2 * (i / 2 + 0.5) / PIXELS - 1,
                     z = -range + (i % 2 ? CELL_M / 2 : -CELL_M / 2);
        points[i] = (struct gi_test_point){ { (float)(0.01 * x * range), 0, (float)z }, { 0, 1, 0 } };
    }
    gi_test_irradiance_from(t, (float[]){ 0, 0, 0 }, points, 2 * PIXELS, light);
    double worst = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double before = (double)light[2 * i][1], after = (double)light[2 * i + 1][1];
        REQUIRE_CMP(after - before, >, 0.05 * unit_of(t));
        worst = fmax(worst, fabs(((double)gi_test_half(found[i][1]) - before) / (after - before) - 0.5));
    }
    printf("near plane %g m, %s: positions at 10 km are off by %.4f cells at most\n", lens->near_m,
           lens->as_integers ? "24 bits"
           : lens->parallel  ? "floats of parallel rays"
                             : "floats",
           worst);
    return worst;
}

/* With a near plane of 0.1 m a depth of 24 bits has steps of 60 m at 10 km, and so has the host's matrix of
 * floats: no position can be told from them. */
static void hard_66_positions_at_ten_kilometres(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(RESOLUTION, (float)CELL_M);
    gi_test_restart(t, &settings);
    t->frame.camera_position[2] = -FAR_M;
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 2);
    write_probes(t, deep_value);
    HARD_CASE_AT_MOST(66, "24 bits, near plane of 1 m, off by cells",
                      position_error(t, &(struct lens){ 1, 20000, true, false }), 0.25);
    HARD_CASE_AT_MOST(66, "reversed floats, near plane of 0.1 m, off by cells",
                      position_error(t, &(struct lens){ 0.1, 0, false, false }), 0.25);
    HARD_CASE_AT_MOST(66, "reversed floats, near plane of 1 mm, off by cells",
                      position_error(t, &(struct lens){ 0.001, 0, false, false }), 0.25);
    HARD_CASE_AT_MOST(66, "parallel rays, reversed floats over 20 km, off by cells",
                      position_error(t, &(struct lens){ 0.001, 20000, .parallel = true }), 0.25);
    HARD_CASE_AT_LEAST(66, "24 bits, near plane of 0.1 m, off by cells",
                       position_error(t, &(struct lens){ 0.1, 20000, true, false }), 0.25);
}

TEST_GROUP(fields)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    static struct gi_test t;
    const struct sdfgi_settings settings = light_settings(RESOLUTION, 0.25f);
    gi_test_open(&t, &settings);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(hard_42_a_field_that_rises_from_probe_to_probe, &t),
        cmocka_unit_test_prestate(hard_46_a_point_on_a_probe_reads_that_probe, &t),
        cmocka_unit_test_prestate(hard_42_a_field_that_rises_from_light_cell_to_light_cell, &t),
        cmocka_unit_test_prestate(hard_41_maps_of_irradiance_have_no_seams, &t),
        cmocka_unit_test_prestate(hard_66_positions_at_ten_kilometres, &t),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gi_test_close(&t);
    return failed;
}
