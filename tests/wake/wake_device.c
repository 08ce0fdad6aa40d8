/* SPDX-License-Identifier: MIT
 * Buffers and textures with contents in versions. */
#include "wake_world.h"

#include "require.h"
#include "shared_pipelines.h"
#include "test_memory.h"

#include <stdlib.h>
#include <vulkan/vulkan.h>

/* Fields of meshes may make any of the first SPAN words be read as any others of the same buffer. */
enum { SPAN = 512, TRIANGLES = 15, CORNERS = 3 * TRIANGLES, TEXELS = 8, LEVELS = 4 };

/* ---- Buffers */

/* A box, and three triangles in it, without common corners. */
static void fill_box(float words[static SPAN], double size, double turn)
{
    double rotation[9];
    test_rotation((double[]){ 1, 2, 0.5 }, turn, rotation);
    const double half[3] = { size, 0.7 * size, 0.9 * size }, center[3] = { 0, 0, 0 };
    struct test_mesh box = test_mesh_box(center, half, rotation);
    for (uint32_t i = 0; i < SPAN; i++) {
        const uint32_t corner = i / 3 % CORNERS;
        const uint32_t of = box.indices[(corner < 36 ? corner : 5 * corner) % 36];
        words[i] = box.positions[3 * of + i % 3];
    }
    test_mesh_destroy(&box);
}

static void fill_random(float words[static SPAN], uint32_t seed, double low, double high)
{
    struct test_random random = { seed };
    for (uint32_t i = 0; i < SPAN; i++)
        words[i] = (float)test_random_real(&random, low, high);
}

/* Triangles in another order, from some on with the other side in front. */
static void fill_indices(uint32_t words[static SPAN], uint32_t version, bool turned)
{
    for (uint32_t i = 0; i < SPAN; i++) {
        const uint32_t triangle = (i / 3 + 4 * version) % TRIANGLES, corner = i % 3;
        words[i] = 3 * triangle + (turned && triangle > 6 ? 2 - corner : corner);
    }
}

static void fill_buffer(enum wake_buffer buffer, uint32_t version, void *words)
{
    switch (buffer) {
    case WAKE_POSITIONS:
        fill_box(words, 0.6 - 0.15 * version, 0.1);
        break;
    case WAKE_OTHER_POSITIONS:
        fill_box(words, 0.45 + 0.1 * version, 0.8);
        break;
    case WAKE_INDICES:
    case WAKE_OTHER_INDICES:
        fill_indices(words, version, buffer == WAKE_OTHER_INDICES);
        break;
    case WAKE_UVS:
    case WAKE_OTHER_UVS:
        fill_random(words, 3 * (uint32_t)buffer + version, -0.5, 1.5);
        break;
    case WAKE_COLORS:
    case WAKE_OTHER_COLORS:
        fill_random(words, 3 * (uint32_t)buffer + version, 0.1, 1);
        break;
    case WAKE_ROOM_POSITIONS:
    case WAKE_ROOM_INDICES:
    case WAKE_BUFFERS:
        require_fail(__FILE__, __LINE__, "buffer %d has no versions", (int)buffer);
    }
}

static void write_buffer(struct wake_device *device, enum wake_buffer buffer, uint32_t version)
{
    uint32_t words[SPAN];
    fill_buffer(buffer, version, words);
    gpu_test_buffer_write(&device->t.gpu, device->buffers[buffer].buffer, 0, sizeof words, words);
}

/* ---- The room: a floor and four walls, open to the sky */

static struct test_mesh room_mesh(void)
{
    static const double boxes[5][2][3] = {
        { { 0, -2.1, 0 }, { 2.6, 0.4, 2.6 } },     { { -2.3, 0, 0 }, { 0.3, 1.7, 2.6 } },
        { { 2.3, -0.6, 0 }, { 0.3, 1.1, 2.6 } },   { { 0, 0, -2.3 }, { 2.6, 1.7, 0.3 } },
        { { 0.7, -0.4, 2.3 }, { 1.9, 1.3, 0.3 } },
    };
    struct test_mesh room = test_mesh_box(boxes[0][0], boxes[0][1], test_rotation_none);
    for (int i = 1; i < 5; i++) {
        struct test_mesh wall = test_mesh_box(boxes[i][0], boxes[i][1], test_rotation_none);
        test_mesh_append(&room, &wall);
        test_mesh_destroy(&wall);
    }
    return room;
}

static void make_buffers(struct wake_device *device)
{
    struct gpu_test *gpu = &device->t.gpu;
    struct test_mesh room = room_mesh();
    device->buffers[WAKE_ROOM_POSITIONS] = gpu_test_buffer_device(
        gpu, 12 * (VkDeviceSize)room.vertex_count, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, room.positions);
    device->buffers[WAKE_ROOM_INDICES] = gpu_test_buffer_device(
        gpu, 12 * (VkDeviceSize)room.triangle_count, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, room.indices);
    test_mesh_destroy(&room);
    for (int i = WAKE_THINGS; i < WAKE_BUFFERS; i++) {
        device->buffers[i] = gpu_test_buffer_device(gpu, 4 * SPAN, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, NULL);
        write_buffer(device, (enum wake_buffer)i, 0);
    }
}

/* ---- Textures */

/* Blocks of two texels; coarser levels are the mean of none, which tells levels apart. */
static void fill_texels(uint32_t texture, uint32_t version, uint8_t (*texels)[4])
{
    struct test_random random = { 100 + 10 * texture + version };
    for (uint32_t i = 0; i < TEXELS * TEXELS * 2; i++)
        for (int k = 0; k < 4; k++)
            texels[i][k] = (uint8_t)test_random_real(&random, k == 3 ? 0 : 40, 256);
}

struct texture_write {
    const struct gpu_test_image *image;
    VkBuffer from;
};

static void transition(VkCommandBuffer cmd, VkImage image, VkImageLayout before, VkImageLayout after)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .oldLayout = before,
        .newLayout = after,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, 1 },
    };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                         NULL, 0, NULL, 1, &barrier);
}

static void record_texture_write(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct texture_write *w = user;
    const VkImage image = w->image->image;
    VkDeviceSize offset = 0;
    transition(cmd, image, w->image->layout, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    for (uint32_t level = 0; level < LEVELS; level++) {
        const uint32_t side = TEXELS >> level;
        const VkBufferImageCopy region = { .bufferOffset = offset,
                                           .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1 },
                                           .imageExtent = { side, side, 1 } };
        vkCmdCopyBufferToImage(cmd, w->from, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        offset += 4 * (VkDeviceSize)side * side;
    }
    transition(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, w->image->layout);
}

static void write_texture(struct wake_device *device, uint32_t texture, uint32_t version)
{
    uint8_t texels[2 * TEXELS * TEXELS][4];
    fill_texels(texture, version, texels);
    struct gpu_test_buffer from = gpu_test_buffer_host(&device->t.gpu, sizeof texels, 0, texels);
    struct texture_write write = { &device->textures[texture], from.buffer };
    gpu_test_submit(&device->t.gpu, record_texture_write, &write);
    gpu_test_buffer_destroy(&device->t.gpu, &from);
}

static void make_textures(struct wake_device *device)
{
    const struct gpu_test_image_desc desc = { .format = VK_FORMAT_R8G8B8A8_UNORM,
                                              .extent = { TEXELS, TEXELS, 1 },
                                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                              .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                              .texel_size = 4,
                                              .levels = LEVELS };
    for (uint32_t i = 0; i < WAKE_TEXTURES; i++) {
        device->textures[i] = gpu_test_image_create(&device->t.gpu, &desc);
        write_texture(device, i, 0);
    }
}

/* ---- Device */

void wake_device_open(struct wake_device *device)
{
    memset(device, 0, sizeof *device);
    gpu_test_open(&device->t.gpu, sdfgi_get_requirements);
    make_buffers(device);
    make_textures(device);
}

void wake_device_close(struct wake_device *device)
{
    struct gpu_test *gpu = &device->t.gpu;
    for (int i = 0; i < WAKE_BUFFERS; i++)
        gpu_test_buffer_destroy(gpu, &device->buffers[i]);
    for (int i = 0; i < WAKE_TEXTURES; i++)
        gpu_test_image_destroy(gpu, &device->textures[i]);
    shared_pipelines_destroy(gpu->device);
    gpu_test_close(gpu);
}

void wake_device_write(struct wake_device *device, const struct wake_contents *contents)
{
    for (uint32_t i = 0; i < WAKE_BUFFERS; i++)
        if (contents->buffers[i] != device->contents.buffers[i])
            write_buffer(device, (enum wake_buffer)i, contents->buffers[i]);
    for (uint32_t i = 0; i < WAKE_TEXTURES; i++)
        if (contents->textures[i] != device->contents.textures[i])
            write_texture(device, i, contents->textures[i]);
    device->contents = *contents;
}
