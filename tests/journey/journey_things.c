/* SPDX-License-Identifier: MIT */
#include "journey_things.h"

#include "gpu_test_check.h"
#include "require.h"

#include <vulkan/vulkan.h>

enum { CORNERS = 6, SHELVES = 15 };

static void make_picture(struct journey_poster *poster, struct gi_test *t)
{
    uint8_t texels[8][8][4];
    for (uint32_t y = 0; y < 8; y++)
        for (uint32_t x = 0; x < 8; x++) {
            const uint8_t texel[4] = { (uint8_t)(30 * x), (uint8_t)(250 - 30 * y), 90,
                                       (x * y) % 5 == 2 ? 0 : 255 };
            memcpy(texels[y][x], texel, sizeof texel);
        }
    const struct gpu_test_image_desc desc = { .format = VK_FORMAT_R8G8B8A8_UNORM,
                                              .extent = { 8, 8, 1 },
                                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                              .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                              .texels = texels,
                                              .texel_size = 4 };
    poster->picture = gpu_test_image_create(&t->gpu, &desc);
}

static sdfgi_mesh make_wall(struct journey_poster *poster, struct gi_test *t)
{
    static const float corners[CORNERS][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 0 }, { 1, 1 }, { 0, 1 } };
    float positions[CORNERS][3], colors[CORNERS][4];
    for (int i = 0; i < CORNERS; i++) {
        const float u = corners[i][0], v = corners[i][1];
        memcpy(positions[i], (float[]){ 3 * u - 1.5f, 2.5f * v - 1.5f, -1.9f }, sizeof positions[i]);
        memcpy(colors[i], (float[]){ 0.4f + 0.6f * u, 1 - 0.5f * v, 0.8f, 1 }, sizeof colors[i]);
    }
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    poster->positions = gpu_test_buffer_device(&t->gpu, sizeof positions, usage, positions);
    poster->uvs = gpu_test_buffer_device(&t->gpu, sizeof corners, usage, corners);
    poster->colors = gpu_test_buffer_device(&t->gpu, sizeof colors, usage, colors);
    const struct sdfgi_mesh_desc desc = { .position_buffer = poster->positions.buffer,
                                          .uv_buffer = poster->uvs.buffer,
                                          .color_buffer = poster->colors.buffer,
                                          .vertex_count = CORNERS,
                                          .triangle_count = CORNERS / 3,
                                          .bounds_min = { -1.5f, -1.5f, -1.9f },
                                          .bounds_max = { 1.5f, 1, -1.9f } };
    sdfgi_mesh mesh;
    REQUIRE_CMP(sdfgi_mesh_create(t->gi, &desc, &mesh), ==, SDFGI_OK);
    return mesh;
}

void journey_poster_add(struct journey_poster *poster, struct gi_test *t)
{
    make_picture(poster, t);
    const struct sdfgi_texture texture = { .view = poster->picture.view };
    const struct sdfgi_material_desc desc = { .albedo = { 0.9f, 0.9f, 0.9f },
                                              .alpha = 1,
                                              .emission = { 0.3f, 0.2f, 0.1f },
                                              .alpha_cutoff = 0.5f,
                                              .albedo_texture = texture,
                                              .emission_texture = texture };
    sdfgi_material material;
    REQUIRE_CMP(sdfgi_material_create(t->gi, &desc, &material), ==, SDFGI_OK);
    const struct sdfgi_transform transform = journey_at(0.3, 0.2, 0.1, 1);
    journey_add(t, make_wall(poster, t), material, &transform, SDFGI_STATIC);
}

void journey_poster_destroy(struct journey_poster *poster, struct gi_test *t)
{
    gpu_test_image_destroy(&t->gpu, &poster->picture);
    gpu_test_buffer_destroy(&t->gpu, &poster->positions);
    gpu_test_buffer_destroy(&t->gpu, &poster->uvs);
    gpu_test_buffer_destroy(&t->gpu, &poster->colors);
}

sdfgi_instance journey_add_shelves(struct gi_test *t, const double center[static 3], sdfgi_material material)
{
    static const double u[3] = { 0, 0, 5 }, v[3] = { 5, 0, 0 };
    struct test_mesh shelves = test_mesh_plane(center, u, v, 1);
    for (int i = 1; i < SHELVES; i++) {
        const double at[3] = { center[0], center[1] + 0.5 * ((i + 1) / 2) * (i % 2 ? 1 : -1), center[2] };
        struct test_mesh shelf = test_mesh_plane(at, u, v, 1);
        test_mesh_append(&shelves, &shelf);
        test_mesh_destroy(&shelf);
    }
    const sdfgi_instance instance = gi_test_add(t, &shelves, material);
    test_mesh_destroy(&shelves);
    return instance;
}

sdfgi_mesh journey_box_mesh(struct gi_test *t)
{
    struct test_mesh box =
        test_mesh_box((double[]){ 0, 0, 0 }, (double[]){ 0.5, 0.5, 0.5 }, test_rotation_none);
    const sdfgi_mesh mesh = gi_test_mesh(t, &box);
    test_mesh_destroy(&box);
    return mesh;
}

struct sdfgi_transform journey_at(double x, double y, double z, float size)
{
    return (struct sdfgi_transform){ { size, 0, 0, 0, size, 0, 0, 0, size }, { x, y, z } };
}

sdfgi_instance journey_add(struct gi_test *t, sdfgi_mesh mesh, sdfgi_material material,
                           const struct sdfgi_transform *transform, enum sdfgi_mobility mobility)
{
    const struct sdfgi_instance_desc desc = { mesh, material, *transform, mobility };
    sdfgi_instance instance;
    REQUIRE_CMP(sdfgi_instance_create(t->gi, &desc, &instance), ==, SDFGI_OK);
    return instance;
}
