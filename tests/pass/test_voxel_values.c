/* SPDX-License-Identifier: MIT
 * Colours, coordinates and texels that are no numbers, negative or huge: what the voxeliser stores of them is
 * what it stores of the nearest sensible ones (HARD_CASES row 60). */
#include "hard_case.h"
#include "pass_square.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct {
    const char *name;
    float value, meant;
} values[] = {
    { "NaN", NAN, 0 }, { "-1", -1, 0 }, { "1e30", 1e30f, 1 }, { "inf", INFINITY, 1 }, { "0.5", 0.5f, 0.5f },
};
enum { VALUES = sizeof values / sizeof *values };

static int open_context(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    gi_test_renew(&pass_context, &settings);
    return 0;
}

/* Of all blocks, how far the albedo is from what is meant. */
static double albedo_error(const struct square *s, const double meant[static 3])
{
    double worst = 0;
    for (uint32_t i = 0; i < SQUARE_BLOCKS * SQUARE_BLOCKS; i++)
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(s->albedo[i / SQUARE_BLOCKS][i % SQUARE_BLOCKS][k] - meant[k]));
    return worst;
}

static void require_whole(const struct square *s)
{
    REQUIRE_CMP(square_columns_set(s), ==, (uint32_t)(SQUARE_COLUMNS * SQUARE_COLUMNS));
}

static void hard_60_colors_of_vertices_that_are_no_colors(void **state)
{
    (void)state;
    const struct sdfgi_material_desc white = { .albedo = { 1, 1, 1 } };
    for (int i = 0; i < VALUES; i++) {
        float colors[SQUARE_CORNERS][4];
        for (int c = 0; c < SQUARE_CORNERS; c++)
            memcpy(colors[c], (float[4]){ values[i].value, 0.25f, values[i].value, 1 }, sizeof colors[c]);
        struct square s = square_voxelize(square_mesh(NULL, (const float(*)[4])colors), &white);
        const double meant = (double)values[i].meant,
                     error = albedo_error(&s, (double[]){ meant, 0.25, meant });
        printf("colours of %s: %.4f off\n", values[i].name, error);
        HARD_CASE_AT_MOST(60, "albedo of a vertex colour off what is meant", error, 0.001);
        require_whole(&s);
        oracle_bits_destroy(&s.bits);
    }
}

/* Which texel they name is nobody's to say: one of them. */
static void hard_60_coordinates_that_are_no_places(void **state)
{
    (void)state;
    static const float texels[4][4] = {
        { 0.5f, 0.5f, 0.5f, 1 }, { 0.5f, 0.5f, 0.5f, 1 }, { 0.5f, 0.5f, 0.5f, 1 }, { 0.5f, 0.5f, 0.5f, 1 }
    };
    const struct gpu_test_image_desc image = { .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                               .extent = { 2, 2, 1 },
                                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                               .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                               .texels = texels,
                                               .texel_size = 16 };
    struct gpu_test_image texture = gpu_test_image_create(&pass_context.gpu, &image);
    const struct sdfgi_material_desc desc = { .albedo = { 1, 1, 1 },
                                              .albedo_texture = { .view = texture.view } };
    for (int i = 0; i < VALUES; i++) {
        float uvs[SQUARE_CORNERS][2];
        for (int c = 0; c < SQUARE_CORNERS; c++)
            memcpy(uvs[c], (float[2]){ c == 1 ? 0.25f : values[i].value, values[i].value }, sizeof uvs[c]);
        struct square s = square_voxelize(square_mesh((const float(*)[2])uvs, NULL), &desc);
        const double error = albedo_error(&s, (double[]){ 0.5, 0.5, 0.5 });
        printf("coordinates of %s: %.4f off\n", values[i].name, error);
        HARD_CASE_AT_MOST(60, "albedo at a coordinate off the texture's", error, 0.001);
        require_whole(&s);
        oracle_bits_destroy(&s.bits);
    }
    gpu_test_image_destroy(&pass_context.gpu, &texture);
}

/* The same texel everywhere, of an albedo and of an emission. */
static struct square voxelize_texel(float value)
{
    const float texel[4] = { value, value, 0.25f, 1 };
    const struct gpu_test_image_desc image = { .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                               .extent = { 1, 1, 1 },
                                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                               .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                               .texels = texel,
                                               .texel_size = 16 };
    struct gpu_test_image texture = gpu_test_image_create(&pass_context.gpu, &image);
    const struct sdfgi_material_desc desc = { .albedo = { 1, 1, 1 },
                                              .emission = { 2, 2, 2 },
                                              .albedo_texture = { .view = texture.view },
                                              .emission_texture = { .view = texture.view } };
    struct square s = square_voxelize(square_mesh(square_corners, NULL), &desc);
    gpu_test_image_destroy(&pass_context.gpu, &texture);
    return s;
}

static void hard_60_texels_that_are_no_light(void **state)
{
    (void)state;
    for (int i = 0; i < VALUES; i++) {
        if (isinf(values[i].value)) /* filters may make NaN of it */
            continue;
        struct square s = voxelize_texel(values[i].value);
        const double meant = (double)values[i].meant,
                     error = albedo_error(&s, (double[]){ meant, meant, 0.25 });
        printf("texels of %s: %.4f off, emission %g\n", values[i].name, error, s.emission[0]);
        HARD_CASE_AT_MOST(60, "albedo of a texel off what is meant", error, 0.001);
        REQUIRE_TRUE(isfinite(s.emission[0]));
        if (values[i].meant == 0)
            HARD_CASE_AT_MOST(60, "emission of a texel that is none", s.emission[0], 0);
        else if (values[i].value < 1)
            REQUIRE_NEAR(s.emission[0], 1, 0.02);
        else
            REQUIRE_CMP(s.emission[0], >, 1000);
        require_whole(&s);
        oracle_bits_destroy(&s.bits);
    }
}

TEST_GROUP(voxel_values)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_60_colors_of_vertices_that_are_no_colors),
        cmocka_unit_test(hard_60_coordinates_that_are_no_places),
        cmocka_unit_test(hard_60_texels_that_are_no_light),
    };
    return cmocka_run_group_tests_name("voxel_values", tests, open_context, pass_context_close);
}
