/* SPDX-License-Identifier: MIT
 * Emission keeps its value whatever else the scene holds. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <sdfgi/inspect.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float levels[] = { 1e-4f, 3e-3f, 0.5f, 40, 2e3f, 1e6f };
enum { LEVELS = sizeof levels / sizeof *levels };

static double level_x(int level)
{
    return 2.5 * level - 6.25;
}

/* A slab for each level, whose top lies in the middle of a layer of blocks. */
static void add_slabs(struct gi_test *t)
{
    for (int i = 0; i < LEVELS; i++) {
        const float emission[3] = { levels[i], 0.5f * levels[i], 0.25f * levels[i] };
        struct test_mesh slab = test_mesh_box((double[]){ level_x(i), -0.5, 0 }, (double[]){ 0.8, 0.75, 0.8 },
                                              test_rotation_none);
        gi_test_add(t, &slab, gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, emission));
        test_mesh_destroy(&slab);
    }
}

/* As many digits as nine bits hold, over ten powers of ten, beside a material that nothing shows and that is
 * brighter still. */
static void emission_keeps_its_digits(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    gi_test_material(&t, (float[]){ 0, 0, 0 }, (float[]){ 6e7f, 6e7f, 6e7f });
    add_slabs(&t);
    gi_test_update(&t, 1);
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP(sdfgi_inspect_get_cascade(t.gi, 0, &where), ==, SDFGI_OK);
    uint32_t *emission = gi_test_read(&t, RESOURCE_EMISSION, NULL);
    for (int i = 0; i < LEVELS; i++) {
        const double top[3] = { level_x(i), 0.2, 0 };
        uint32_t cell[3];
        for (int k = 0; k < 3; k++)
            cell[k] = (uint32_t)floor((top[k] - where.origin_m[k]) / where.cell_m[k]);
        const uint64_t block = sdfgi_inspect_block(&where, cell[0], cell[1], cell[2]);
        struct sdfgi_inspect_surface s;
        sdfgi_inspect_decode_block(NULL, emission + 2 * block, 0, where.emission_unit, &s);
        printf("%g is stored as %g %g %g\n", (double)levels[i], (double)s.emission[0],
               2 * (double)s.emission[1], 4 * (double)s.emission[2]);
        for (int k = 0; k < 3; k++) /* RGB9E5: half a step */
            REQUIRE_NEAR(s.emission[k] / levels[i], ldexp(1, -k), 1 / 512.0 + 1e-6);
    }
    free(emission);
    gi_test_close(&t);
}

/* ---- Textures */

/* A level square of 4 m: texels are as large as its columns of sub-voxels, and all texels of a block agree.
 */
enum { BLOCKS = 8, TEXELS = 64 };
static const float square_height = 0.3f, factor = 16;

/* Half floats from 6.3e-6 to 6.3e4, evenly spread over the powers of two. */
static uint16_t half_of_block(uint32_t x, uint32_t z)
{
    return (uint16_t)(0x0069 + (0x7ba0 - 0x0069) / (BLOCKS * BLOCKS - 1) * (BLOCKS * z + x));
}

static struct gpu_test_image create_texture(struct gi_test *t)
{
    static uint16_t texels[TEXELS][TEXELS][4];
    for (uint32_t z = 0; z < TEXELS; z++)
        for (uint32_t x = 0; x < TEXELS; x++)
            for (int k = 0; k < 4; k++)
                texels[z][x][k] = half_of_block(x / (TEXELS / BLOCKS), z / (TEXELS / BLOCKS));
    return gpu_test_image_create(
        &t->gpu, &(struct gpu_test_image_desc){ .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                .extent = { TEXELS, TEXELS, 1 },
                                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                                .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                .texels = texels,
                                                .texel_size = sizeof texels[0][0],
                                                .levels = 1 });
}

static VkBuffer upload(struct gi_test *t, VkDeviceSize size, const void *data)
{
    t->buffers[t->buffer_count] =
        gpu_test_buffer_device(&t->gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    return t->buffers[t->buffer_count++].buffer;
}

static void add_square(struct gi_test *t, VkImageView view)
{
    static const float uvs[4][2] = { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } };
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    float positions[4][3];
    for (int i = 0; i < 4; i++)
        memcpy(positions[i], (float[3]){ 4 * uvs[i][0] - 2, square_height, 4 * uvs[i][1] - 2 },
               sizeof positions[i]);
    const struct sdfgi_mesh_desc mesh = { .position_buffer = upload(t, sizeof positions, positions),
                                          .uv_buffer = upload(t, sizeof uvs, uvs),
                                          .index_buffer = upload(t, sizeof indices, indices),
                                          .index_type = VK_INDEX_TYPE_UINT32,
                                          .vertex_count = 4,
                                          .triangle_count = 2,
                                          .bounds_min = { -2, square_height, -2 },
                                          .bounds_max = { 2, square_height, 2 } };
    const struct sdfgi_material_desc lamp = { .emission = { factor, factor, factor },
                                              .emission_texture = { .view = view } };
    struct sdfgi_instance_desc instance = { .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } } };
    sdfgi_instance unused;
    REQUIRE_CMP((int)sdfgi_mesh_create(t->gi, &mesh, &instance.mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &lamp, &instance.material), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_instance_create(t->gi, &instance, &unused), ==, (int)SDFGI_OK);
}

/* Over ten powers of ten in one texture, beside a material that is brighter still. Both triangles cover
 * columns along their common edge, in the blocks where x = z: a mean all the same. */
static void emission_textures_keep_their_digits(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    gi_test_material(&t, (float[]){ 0, 0, 0 }, (float[]){ 6e7f, 6e7f, 6e7f });
    struct gpu_test_image texture = create_texture(&t);
    add_square(&t, texture.view);
    gi_test_update(&t, 1);
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP((int)sdfgi_inspect_get_cascade(t.gi, 0, &where), ==, (int)SDFGI_OK);
    uint32_t *emission = gi_test_read(&t, RESOURCE_EMISSION, NULL);
    double worst = 0;
    for (uint32_t i = 0; i < BLOCKS * BLOCKS; i++) {
        const uint32_t x = i % BLOCKS, z = i / BLOCKS;
        const uint64_t block =
            sdfgi_inspect_block(&where, (uint32_t)((-2 - where.origin_m[0]) / where.cell_m[0]) + 2 * x,
                                (uint32_t)(((double)square_height - where.origin_m[1]) / where.cell_m[1]),
                                (uint32_t)((-2 - where.origin_m[2]) / where.cell_m[2]) + 2 * z);
        struct sdfgi_inspect_surface s;
        sdfgi_inspect_decode_block(NULL, emission + 2 * block, 0, where.emission_unit, &s);
        const double expected = (double)(factor * gi_test_half(half_of_block(x, z)));
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)s.emission[k] / expected - 1));
    }
    printf("emission of a texture from 1e-4 to 1e6 is off by %.2g at most\n", worst);
    REQUIRE_CMP(worst, <=, 1 / 512.0 + 1e-6); /* RGB9E5: half a step */
    free(emission);
    gpu_test_image_destroy(&t.gpu, &texture);
    gi_test_close(&t);
}

static const enum resource stored_light[] = { RESOURCE_LIGHT,     RESOURCE_SURFACES, RESOURCE_GATHERED,
                                              RESOURCE_EMISSION,  RESOURCE_SUMS,     RESOURCE_PREVIOUS,
                                              RESOURCE_IRRADIANCE };
enum { STORED = sizeof stored_light / sizeof *stored_light };

/* Every bit of stored light is that of copies, which are freed. */
static void require_stored_light(struct gi_test *t, void *copies[static STORED])
{
    for (size_t i = 0; i < STORED; i++) {
        uint64_t size;
        void *now = gi_test_read(t, stored_light[i], &size);
        REQUIRE_BYTES(now, copies[i], size);
        free(now);
        free(copies[i]);
    }
}

/* Settled light stays to the bit, and nothing is recorded: neither in the frame after such a material has
 * come or gone, nor later; nor if a host says in each frame what its materials are. */
static void brighter_materials_leave_settled_light_alone(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct sdfgi_report report;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.ray_count = 25;
    settings.frames_to_converge = 5;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = SDFGI_VISIT_RAYS;
    gi_test_open(&t, &settings);
    struct test_mesh lamp =
        test_mesh_box((double[]){ 0, 1, 0 }, (double[]){ 0.5, 0.25, 0.5 }, test_rotation_none);
    const sdfgi_material shown = gi_test_material(&t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 3, 2, 1 });
    gi_test_add(&t, &lamp, shown);
    test_mesh_destroy(&lamp);
    gi_test_converge(&t, 400);
    gi_test_update(&t, 2);
    void *before[STORED];
    for (size_t i = 0; i < STORED; i++)
        before[i] = gi_test_read(&t, stored_light[i], NULL);
    const sdfgi_material brighter = gi_test_material(&t, (float[]){ 0, 0, 0 }, (float[]){ 6e5f, 6e5f, 6e5f });
    const struct sdfgi_material_desc as_before = { .albedo = { 0.5f, 0.5f, 0.5f },
                                                   .emission = { 3, 2, 1 },
                                                   .double_sided_emission = true };
    for (int frame = 0; frame < 6; frame++) {
        if (frame == 3)
            REQUIRE_CMP((int)sdfgi_material_destroy(t.gi, brighter), ==, (int)SDFGI_OK);
        REQUIRE_CMP((int)sdfgi_material_update(t.gi, shown, &as_before), ==, (int)SDFGI_OK);
        gi_test_update(&t, 1);
        sdfgi_get_report(t.gi, &report);
        REQUIRE_TRUE(report.converged);
        REQUIRE_CMP(report.command_count, ==, 0u);
    }
    require_stored_light(&t, before);
    gi_test_close(&t);
}

TEST_GROUP(emission)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emission_keeps_its_digits),
        cmocka_unit_test(emission_textures_keep_their_digits),
        cmocka_unit_test(brighter_materials_leave_settled_light_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
