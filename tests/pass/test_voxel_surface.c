/* SPDX-License-Identifier: MIT
 * What the voxeliser stores of a surface's colours: each block against the mean of what the host described
 * there. A square of 4 m lies level in a cascade; a column of sub-voxels is a 64th of it, a block an 8th. */
#include "pass_square.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <sdfgi/inspect.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    COLUMNS = SQUARE_COLUMNS,
    BLOCKS = SQUARE_BLOCKS,
    PER_BLOCK = COLUMNS / BLOCKS,
    CORNERS = SQUARE_CORNERS
};

static int open_context(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32; /* cells of 0.25 m: the square spans a half of the cascade */
    gi_test_open(&pass_context, &settings);
    return 0;
}

/* ---- Fronts */

static const float upright[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, mirrored[9] = { -1, 0, 0, 0, 1, 0, 0, 0, 1 };

/* The level of sub-voxels in which a grey square lies. */
static uint32_t grey_level(sdfgi_mesh mesh, const float basis[static 9])
{
    struct sdfgi_instance_desc instance = { .mesh = mesh };
    memcpy(instance.transform.basis, basis, sizeof instance.transform.basis);
    struct square s = square_voxelize_instance(&instance, &square_grey);
    uint32_t level = 0;
    while (!oracle_bits_get(&s.bits, s.bits.size / 2, level, s.bits.size / 2))
        level++;
    oracle_bits_destroy(&s.bits);
    return level;
}

/* The surface lies 4.8 sub-voxels above the middle of the cascade, half a sub-voxel behind its front. */
static void require_front(VkFrontFace front_face, const float basis[static 9], bool above)
{
    struct sdfgi_mesh_desc desc = square_describe(NULL, NULL);
    desc.front_face = front_face;
    REQUIRE_CMP(grey_level(square_mesh_of(&desc), basis), ==, 64 + (above ? 4u : 5u));
    const struct sdfgi_material_desc lamp = { .emission = { 2, 2, 2 } };
    struct sdfgi_instance_desc instance = { .mesh = square_mesh_of(&desc) };
    memcpy(instance.transform.basis, basis, sizeof instance.transform.basis);
    struct square s = square_voxelize_instance(&instance, &lamp);
    REQUIRE_NEAR(s.emission[above ? 0 : 1], 2, 0.01);
    REQUIRE_NEAR(s.emission[above ? 1 : 0], 0, 0);
    oracle_bits_destroy(&s.bits);
}

static void fronts_are_where_the_host_says(void **state)
{
    (void)state;
    require_front(VK_FRONT_FACE_COUNTER_CLOCKWISE, upright, true);
    require_front(VK_FRONT_FACE_CLOCKWISE, upright, false);
    require_front(VK_FRONT_FACE_COUNTER_CLOCKWISE, mirrored, true);
    require_front(VK_FRONT_FACE_CLOCKWISE, mirrored, false);
}

/* ---- Bounds */

/* Triangles that the report counts outside a square's bounds, which end at `bounds_max_x` instead of 2. */
static uint64_t outside_bounds(float bounds_max_x)
{
    struct sdfgi_mesh_desc desc = square_describe(NULL, NULL);
    desc.bounds_max[0] = bounds_max_x;
    const sdfgi_mesh mesh = square_mesh_of(&desc);
    pass_scene_place(&pass_context, mesh, upright, (double[3]){ 0 });
    gi_test_update(&pass_context, 3);
    const uint64_t count = pass_health_count(&pass_context, SDFGI_MESSAGE_BOUNDS_MISS_VERTICES);
    REQUIRE_CMP(sdfgi_mesh_destroy(pass_context.gi, mesh), ==, SDFGI_OK);
    return count;
}

static void triangles_outside_their_bounds_are_counted(void **state)
{
    (void)state;
    REQUIRE_CMP(outside_bounds(1.9f), ==, 0ul); /* by less than a cell */
    REQUIRE_CMP(outside_bounds(1), ==, 2ul);
    struct sdfgi_settings settings;
    sdfgi_get_settings(pass_context.gi, &settings);
    settings.voxelizer = SDFGI_VOXELIZER_RASTER;
    if (sdfgi_set_settings(pass_context.gi, &settings) != SDFGI_OK)
        return;
    REQUIRE_CMP(outside_bounds(1.9f), ==, 0ul);
    REQUIRE_CMP(outside_bounds(1), ==, 2ul);
    settings.voxelizer = SDFGI_VOXELIZER_COMPUTE;
    REQUIRE_CMP(sdfgi_set_settings(pass_context.gi, &settings), ==, SDFGI_OK);
}

/* ---- Alpha and colours of vertices */

static void masks_without_an_alpha_leave_all(void **state)
{
    (void)state;
    struct sdfgi_material_desc desc = square_grey;
    desc.alpha_cutoff = 0.5f;
    struct square s = square_voxelize(square_mesh(NULL, NULL), &desc);
    REQUIRE_CMP(square_columns_set(&s), ==, (uint32_t)(COLUMNS * COLUMNS));
    oracle_bits_destroy(&s.bits);
    desc.alpha = 0.4f;
    s = square_voxelize(square_mesh(NULL, NULL), &desc);
    REQUIRE_CMP(oracle_bits_count(&s.bits), ==, 0);
    oracle_bits_destroy(&s.bits);
}

/* Linear along x and z: red rises along x, green along z, blue falls along both; alpha rises along x. */
static void color_at(double x, double z, double color[static 4])
{
    color[0] = 0.2 + 0.6 * x;
    color[1] = 0.1 + 0.9 * z;
    color[2] = 1 - 0.4 * x - 0.5 * z;
    color[3] = x;
}

static void colors_of_vertices_multiply_albedo_and_alpha(void **state)
{
    (void)state;
    float colors[CORNERS][4];
    for (int i = 0; i < CORNERS; i++) {
        double color[4];
        color_at((double)square_corners[i][0], (double)square_corners[i][1], color);
        for (int k = 0; k < 4; k++)
            colors[i][k] = (float)color[k];
    }
    const struct sdfgi_material_desc desc = { .albedo = { 0.9f, 0.5f, 0.7f },
                                              .alpha = 0.8f,
                                              .alpha_cutoff = 0.2f };
    struct square s = square_voxelize(square_mesh(NULL, (const float(*)[4])colors), &desc);
    for (uint32_t z = 0; z < BLOCKS; z++)
        for (uint32_t x = 2; x < BLOCKS; x++) {
            double color[4];
            color_at((x + 0.5) / BLOCKS, (z + 0.5) / BLOCKS, color);
            for (int k = 0; k < 3; k++)
                REQUIRE_NEAR(s.albedo[z][x][k], (double)desc.albedo[k] * color[k], 0.002);
        }
    for (uint32_t z = 0; z < COLUMNS; z++)
        for (uint32_t x = 0; x < COLUMNS; x++)
            REQUIRE_CMP(square_column_is_set(&s, x, z), ==, 0.8 * (x + 0.5) / COLUMNS >= 0.2);
    oracle_bits_destroy(&s.bits);
}

/* ---- Textures */

/* A texture of `size` texels a side with all its mip levels, each texel the mean of those below. */
struct picture {
    uint32_t size;
    uint8_t (*texels)[4];
    struct gpu_test_image image;
};

static struct picture picture_create(uint32_t size, uint32_t levels,
                                     void (*texel_at)(uint32_t x, uint32_t y, uint8_t texel[static 4]))
{
    struct picture p = { size, test_array_alloc(2 * (size_t)size * size, sizeof *p.texels), { 0 } };
    for (uint32_t i = 0; i < size * size; i++)
        texel_at(i % size, i / size, p.texels[i]);
    uint8_t(*from)[4] = p.texels;
    for (uint32_t level = 1, n = size / 2; level < levels; level++, n /= 2) {
        uint8_t(*to)[4] = from + 4 * (size_t)n * n;
        for (uint32_t i = 0; i < 4 * n * n; i++) {
            const uint32_t x = i / 4 % n, y = i / 4 / n, k = i % 4;
            const uint8_t(*at)[4] = (const uint8_t(*)[4])from + 4 * (size_t)n * y + 2 * x;
            to[i / 4][k] = (uint8_t)((at[0][k] + at[1][k] + at[2 * n][k] + at[2 * n + 1][k] + 2) / 4);
        }
        from = to;
    }
    const struct gpu_test_image_desc desc = { .format = VK_FORMAT_R8G8B8A8_UNORM,
                                              .extent = { size, size, 1 },
                                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                              .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                              .texels = p.texels,
                                              .texel_size = 4,
                                              .levels = levels };
    p.image = gpu_test_image_create(&pass_context.gpu, &desc);
    return p;
}

/* No frame may be in flight. */
static void picture_destroy(struct picture *p)
{
    gpu_test_image_destroy(&pass_context.gpu, &p->image);
    free(p->texels);
}

/* Colours without a pattern; a third of the texels are transparent. */
static void noise_at(uint32_t x, uint32_t y, uint8_t texel[static 4])
{
    const uint32_t hash = (x * 73856093u ^ y * 19349663u) * 2654435761u;
    for (int k = 0; k < 3; k++)
        texel[k] = (uint8_t)(hash >> 8 * k);
    texel[3] = hash >> 24 < 85 ? 0 : 255;
}

static void opaque_noise_at(uint32_t x, uint32_t y, uint8_t texel[static 4])
{
    noise_at(x, y, texel);
    texel[3] = 255;
}

static void checkerboard_at(uint32_t x, uint32_t y, uint8_t texel[static 4])
{
    static const uint8_t colors[2][4] = { { 255, 30, 0, 255 }, { 55, 230, 0, 255 } };
    memcpy(texel, colors[(x + y) % 2], 4);
}

/* The corners' coordinates go from 0 to `repeats`. */
static sdfgi_mesh make_mapped_square(float repeats)
{
    float uvs[CORNERS][2];
    for (int i = 0; i < CORNERS; i++)
        for (int k = 0; k < 2; k++)
            uvs[i][k] = repeats * square_corners[i][k];
    return square_mesh((const float(*)[2])uvs, NULL);
}

/* The texel that lies at x texels from the side of a texture of COLUMNS texels. */
static uint32_t addressed(uint32_t x, VkSamplerAddressMode mode)
{
    if (x < COLUMNS || mode == VK_SAMPLER_ADDRESS_MODE_REPEAT)
        return x % COLUMNS;
    return mode == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE ? COLUMNS - 1 : 2 * COLUMNS - 1 - x;
}

/* The mean of the texels that a block shows, `shift` texels from the sides of the texture. */
static double texel_mean(const struct picture *p, VkSamplerAddressMode mode, uint32_t shift,
                         const uint32_t block[static 2], int channel)
{
    double mean = 0;
    for (uint32_t c = 0; c < PER_BLOCK * PER_BLOCK; c++) {
        const uint32_t x = addressed(block[0] * PER_BLOCK + c % PER_BLOCK + shift, mode),
                       z = addressed(block[1] * PER_BLOCK + c / PER_BLOCK + shift, mode);
        mean += p->texels[z * COLUMNS + x][channel] / (255.0 * PER_BLOCK * PER_BLOCK);
    }
    return mean;
}

/* A texel is as large as a column, and `shift` columns of the square lie outside the texture. Blocks along
 * the seam of both triangles are left out: columns whose centre lies on it count twice. */
static void require_area_means(const struct picture *p, VkSamplerAddressMode mode, uint32_t shift)
{
    const float part = (float)shift / COLUMNS;
    const struct sdfgi_material_desc desc = { .albedo = { 1, 0.5f, 0.75f },
                                              .albedo_texture = { .view = p->image.view,
                                                                  .uv_transform = { 1, 0, part, 0, 1, part },
                                                                  .address_u = mode,
                                                                  .address_v = mode } };
    struct square s = square_voxelize(make_mapped_square(1), &desc);
    for (uint32_t z = 0; z < BLOCKS; z++)
        for (uint32_t x = 0; x < BLOCKS; x++)
            for (int k = 0; k < 3 && x != z; k++)
                REQUIRE_NEAR(s.albedo[z][x][k],
                             (double)desc.albedo[k] * texel_mean(p, mode, shift, (uint32_t[2]){ x, z }, k),
                             0.002);
    oracle_bits_destroy(&s.bits);
}

static void blocks_hold_area_means_of_textures(void **state)
{
    (void)state;
    struct picture p = picture_create(COLUMNS, 1, opaque_noise_at);
    require_area_means(&p, VK_SAMPLER_ADDRESS_MODE_REPEAT, 0);
    require_area_means(&p, VK_SAMPLER_ADDRESS_MODE_REPEAT, 20);
    require_area_means(&p, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, 20);
    require_area_means(&p, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 20);
    picture_destroy(&p);
}

/* 13 texels a column: each block is the mean of both colours. */
static void textures_finer_than_a_sub_voxel_come_out_as_their_mean(void **state)
{
    (void)state;
    struct picture p = picture_create(64, 7, checkerboard_at);
    const struct sdfgi_material_desc desc = { .albedo = { 1, 1, 1 },
                                              .emission = { 2, 2, 2 },
                                              .albedo_texture = { .view = p.image.view },
                                              .emission_texture = { .view = p.image.view } };
    struct square s = square_voxelize(make_mapped_square(13), &desc);
    for (uint32_t i = 0; i < BLOCKS * BLOCKS; i++) {
        REQUIRE_NEAR(s.albedo[i / BLOCKS][i % BLOCKS][0], 155 / 255.0, 0.003);
        REQUIRE_NEAR(s.albedo[i / BLOCKS][i % BLOCKS][1], 130 / 255.0, 0.003);
        REQUIRE_NEAR(s.albedo[i / BLOCKS][i % BLOCKS][2], 0, 0);
    }
    REQUIRE_NEAR(s.emission[0], 2 * 130 / 255.0, 0.02);
    oracle_bits_destroy(&s.bits);
    picture_destroy(&p);
}

static void masks_leave_holes_where_alpha_is_below_the_cutoff(void **state)
{
    (void)state;
    struct picture p = picture_create(COLUMNS, 1, noise_at);
    struct sdfgi_material_desc desc = square_grey;
    desc.alpha_cutoff = 0.5f;
    desc.albedo_texture.view = p.image.view;
    struct square s = square_voxelize(make_mapped_square(1), &desc);
    for (uint32_t z = 0; z < COLUMNS; z++)
        for (uint32_t x = 0; x < COLUMNS; x++)
            REQUIRE_CMP(square_column_is_set(&s, x, z), ==, p.texels[z * COLUMNS + x][3] == 255);
    oracle_bits_destroy(&s.bits);
    picture_destroy(&p);
}

/* Nanoseconds that the device takes at best for the square of a material; 0: it has no clock. */
static uint64_t voxelize_ns(const struct sdfgi_material_desc *desc)
{
    static struct sdfgi_report report;
    uint64_t best = UINT64_MAX;
    for (int run = 0; run < 3; run++) {
        struct square s = square_voxelize(make_mapped_square(13), desc);
        oracle_bits_destroy(&s.bits);
        gi_test_update(&pass_context, 2);
        sdfgi_get_report(pass_context.gi, &report);
        const uint64_t ns = report.passes[PASS_VOXELIZE].gpu_ns;
        best = ns < best ? ns : best;
    }
    return best;
}

/* With filters along the slope of surfaces a software driver takes 2,000 times as long. */
static void textures_cost_little(void **state)
{
    (void)state;
    struct picture p = picture_create(64, 7, checkerboard_at);
    struct sdfgi_material_desc desc = square_grey;
    const uint64_t plain = voxelize_ns(&desc);
    desc.albedo_texture.view = p.image.view;
    const uint64_t textured = voxelize_ns(&desc);
    printf("a square: %llu ns plain, %llu ns with a texture\n", (unsigned long long)plain,
           (unsigned long long)textured);
    REQUIRE_CMP(textured, <=, 20 * plain);
    picture_destroy(&p);
}

TEST_GROUP(voxel_surface)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fronts_are_where_the_host_says),
        cmocka_unit_test(triangles_outside_their_bounds_are_counted),
        cmocka_unit_test(masks_without_an_alpha_leave_all),
        cmocka_unit_test(colors_of_vertices_multiply_albedo_and_alpha),
        cmocka_unit_test(blocks_hold_area_means_of_textures),
        cmocka_unit_test(textures_finer_than_a_sub_voxel_come_out_as_their_mean),
        cmocka_unit_test(textures_cost_little),
        cmocka_unit_test(masks_leave_holes_where_alpha_is_below_the_cutoff),
    };
    return cmocka_run_group_tests_name("voxel_surface", tests, open_context, pass_context_close);
}
