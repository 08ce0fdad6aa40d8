/* SPDX-License-Identifier: MIT
 * Textures whose content is encoded as sRGB: a view that the device decodes and one that the library is told
 * to decode give the same albedo and the same emission, which are those of IEC 61966-2-1. */
#include "pass_square.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>

static const uint8_t texels[][4] = { { 0, 8, 255, 255 },    { 10, 11, 64, 255 }, { 128, 188, 240, 255 },
                                     { 200, 100, 50, 255 }, { 1, 2, 254, 255 },  { 90, 160, 220, 255 } };
enum { TEXELS = sizeof texels / sizeof *texels };

static double decoded(double value)
{
    const double v = value / 255;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static struct gpu_test_image one_texel(const uint8_t texel[static 4], VkFormat format)
{
    return gpu_test_image_create(
        &pass_context.gpu, &(struct gpu_test_image_desc){ .format = format,
                                                          .extent = { 1, 1, 1 },
                                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                                          .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                          .texels = texel,
                                                          .texel_size = 4 });
}

/* A square with the texel everywhere; the green channel is that of emission, 4 times as bright. */
static struct square voxelize(const uint8_t texel[static 4], VkFormat format, bool decode_albedo,
                              bool decode_emission)
{
    struct gpu_test_image texture = one_texel(texel, format);
    const struct sdfgi_material_desc desc = {
        .albedo = { 1, 1, 1 },
        .emission = { 4, 4, 4 },
        .albedo_texture = { .view = texture.view, .decode_srgb = decode_albedo },
        .emission_texture = { .view = texture.view, .decode_srgb = decode_emission },
    };
    struct square s = square_voxelize(square_mesh(square_corners, NULL), &desc);
    oracle_bits_destroy(&s.bits);
    gpu_test_image_destroy(&pass_context.gpu, &texture);
    return s;
}

/* What an error of half a step of the encoded value, which devices may make, is once it is decoded. */
static double half_step(uint8_t value)
{
    return (decoded(value + 0.5) - decoded(value - 0.5)) / 2;
}

/* Albedo is stored in steps of 1/1023, emission with 9 bits for its brightest channel. A view that decodes
 * may be off by half a step. */
static void require_light(const struct square *s, const uint8_t texel[static 4], bool linear_albedo,
                          bool linear_emission, bool by_device)
{
    const double slack = by_device ? 1 : 0;
    for (int k = 0; k < 3; k++)
        REQUIRE_NEAR(s->albedo[3][4][k], linear_albedo ? decoded(texel[k]) : texel[k] / 255.0,
                     0.5 / 1023 + 1e-4 + slack * half_step(texel[k]));
    const double green = linear_emission ? decoded(texel[1]) : texel[1] / 255.0;
    double brightest = 0;
    for (int k = 0; k < 3; k++)
        brightest = fmax(brightest, linear_emission ? decoded(texel[k]) : texel[k] / 255.0);
    REQUIRE_NEAR(s->emission[0], 4 * green, 4 * (brightest / 256 + slack * half_step(texel[1])));
}

static void require_paths_agree(enum sdfgi_voxelizer voxelizer)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.voxelizer = voxelizer;
    gi_test_renew(&pass_context, &settings);
    for (int i = 0; i < TEXELS; i++) {
        const struct square by_device = voxelize(texels[i], VK_FORMAT_R8G8B8A8_SRGB, false, false),
                            by_library = voxelize(texels[i], VK_FORMAT_R8G8B8A8_UNORM, true, true),
                            albedo_only = voxelize(texels[i], VK_FORMAT_R8G8B8A8_UNORM, true, false),
                            emission_only = voxelize(texels[i], VK_FORMAT_R8G8B8A8_UNORM, false, true);
        require_light(&by_device, texels[i], true, true, true);
        require_light(&by_library, texels[i], true, true, false);
        require_light(&albedo_only, texels[i], true, false, false);
        require_light(&emission_only, texels[i], false, true, false);
    }
}

static void device_and_library_decode_alike(void **state)
{
    (void)state;
    require_paths_agree(SDFGI_VOXELIZER_COMPUTE);
}

static void raster_decodes_too(void **state)
{
    (void)state;
    if (!pass_raster_is_available())
        skip();
    require_paths_agree(SDFGI_VOXELIZER_RASTER);
}

/* Alpha is never encoded: 128 of 255 stays above a cut-off of 0.45, and below one of 0.55. */
static void alpha_is_left_alone(void **state)
{
    (void)state;
    static const uint8_t texel[4] = { 128, 128, 128, 128 };
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    gi_test_renew(&pass_context, &settings);
    struct gpu_test_image texture = one_texel(texel, VK_FORMAT_R8G8B8A8_UNORM);
    for (int i = 0; i < 2; i++) {
        const struct sdfgi_material_desc desc = { .albedo = { 1, 1, 1 },
                                                  .alpha_cutoff = i ? 0.55f : 0.45f,
                                                  .albedo_texture = { .view = texture.view,
                                                                      .decode_srgb = true } };
        struct square s = square_voxelize(square_mesh(square_corners, NULL), &desc);
        REQUIRE_CMP(square_columns_set(&s), ==, i ? 0u : (uint32_t)(SQUARE_COLUMNS * SQUARE_COLUMNS));
        oracle_bits_destroy(&s.bits);
    }
    gpu_test_image_destroy(&pass_context.gpu, &texture);
}

TEST_GROUP(srgb_textures)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(device_and_library_decode_alike),
        cmocka_unit_test(raster_decodes_too),
        cmocka_unit_test(alpha_is_left_alone),
    };
    return cmocka_run_group_tests_name("srgb_textures", tests, NULL, pass_context_close);
}
