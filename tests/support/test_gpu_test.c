/* SPDX-License-Identifier: MIT
 * The GPU harness: data survives the round trip, and mistakes are caught. */
#include "gpu_test.h"
#include "require.h"

#include <stdlib.h>

static void buffers_keep_what_is_written(void **state)
{
    (void)state;
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    uint32_t data[256], back[256];
    for (uint32_t i = 0; i < 256; i++)
        data[i] = i * 2654435761u;
    struct gpu_test_buffer host = gpu_test_buffer_host(&gpu, sizeof data, 0, data);
    struct gpu_test_buffer device =
        gpu_test_buffer_device(&gpu, sizeof data, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    gpu_test_buffer_read(&gpu, host.buffer, 0, sizeof back, back);
    REQUIRE_BYTES(data, back, sizeof data);
    gpu_test_buffer_read(&gpu, device.buffer, 64, sizeof back - 64, back);
    REQUIRE_BYTES(data + 16, back, sizeof data - 64);
    gpu_test_buffer_destroy(&gpu, &host);
    gpu_test_buffer_destroy(&gpu, &device);
    gpu_test_close(&gpu);
}

static void require_image_round_trip(struct gpu_test *gpu, VkFormat format, VkExtent3D extent,
                                     VkImageUsageFlags usage)
{
    const uint32_t count = extent.width * extent.height * extent.depth;
    float *data = calloc(count, sizeof *data), *back = calloc(count, sizeof *back);
    for (uint32_t i = 0; i < count; i++)
        data[i] = (float)i / (float)count;
    const struct gpu_test_image_desc desc = {
        .format = format,
        .extent = extent,
        .usage = usage,
        .layout = VK_IMAGE_LAYOUT_GENERAL,
        .texels = data,
        .texel_size = sizeof *data,
    };
    struct gpu_test_image image = gpu_test_image_create(gpu, &desc);
    gpu_test_image_read(gpu, image.image, image.layout, image.aspect, extent, sizeof *back, back);
    REQUIRE_BYTES(data, back, count * sizeof *data);
    gpu_test_image_destroy(gpu, &image);
    free(data);
    free(back);
}

static void images_keep_what_is_uploaded(void **state)
{
    (void)state;
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    require_image_round_trip(&gpu, VK_FORMAT_R32_SFLOAT, (VkExtent3D){ 17, 5, 1 },
                             VK_IMAGE_USAGE_STORAGE_BIT);
    require_image_round_trip(&gpu, VK_FORMAT_R32_SFLOAT, (VkExtent3D){ 8, 6, 4 }, VK_IMAGE_USAGE_SAMPLED_BIT);
    require_image_round_trip(&gpu, VK_FORMAT_D32_SFLOAT, (VkExtent3D){ 9, 7, 1 },
                             VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    gpu_test_close(&gpu);
}

static void misuse_is_counted_as_an_error(void **state)
{
    (void)state;
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    if (!gpu.messenger)
        skip();
    gpu.messages->quiet = true;
    const VkBufferCreateInfo nothing = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                         .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT };
    VkBuffer buffer = VK_NULL_HANDLE;
    if (vkCreateBuffer(gpu.device, &nothing, NULL, &buffer) == VK_SUCCESS)
        vkDestroyBuffer(gpu.device, buffer, NULL);
    REQUIRE_CMP(gpu_test_take_messages(&gpu).errors, >=, 1);
    gpu_test_close(&gpu);
}

/* Each command buffer fills the same bytes `fills` times without a barrier. */
struct fill {
    VkBuffer buffer;
    uint32_t fills;
};

static void fill_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct fill *fill = user;
    for (uint32_t i = 0; i < fill->fills; i++)
        vkCmdFillBuffer(cmd, fill->buffer, 0, VK_WHOLE_SIZE, index + i);
}

static void a_missing_barrier_is_counted_as_an_error(void **state)
{
    (void)state;
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    if (!gpu.messenger)
        skip();
    gpu.messages->quiet = true;
    struct gpu_test_buffer buffer = gpu_test_buffer_device(&gpu, 256, 0, NULL);
    gpu_test_submit(&gpu, fill_record, &(struct fill){ buffer.buffer, 1 });
    REQUIRE_CMP(gpu_test_take_messages(&gpu).errors, ==, 0);
    gpu_test_submit(&gpu, fill_record, &(struct fill){ buffer.buffer, 2 });
    REQUIRE_CMP(gpu_test_take_messages(&gpu).errors, >=, 1);
    gpu_test_buffer_destroy(&gpu, &buffer);
    gpu_test_close(&gpu);
}

static void a_missing_barrier_between_submissions_is_counted_as_an_error(void **state)
{
    (void)state;
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    if (!gpu.messenger)
        skip();
    gpu.messages->quiet = true;
    struct gpu_test_buffer buffer = gpu_test_buffer_device(&gpu, 256, 0, NULL);
    gpu_test_submit_many(&gpu, 2, fill_record, &(struct fill){ buffer.buffer, 1 });
    REQUIRE_CMP(gpu_test_take_messages(&gpu).errors, >=, 1);
    gpu_test_buffer_destroy(&gpu, &buffer);
    gpu_test_close(&gpu);
}

/* A device that is destroyed with a buffer still alive. */
static void a_leaked_object_is_counted_as_an_error(void **state)
{
    (void)state;
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    if (!gpu.messenger)
        skip();
    gpu.messages->quiet = true;
    const VkBufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                      .size = 16,
                                      .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT };
    VkBuffer leaked;
    REQUIRE_CMP(vkCreateBuffer(gpu.device, &info, NULL, &leaked), ==, VK_SUCCESS);
    vkDestroyCommandPool(gpu.device, gpu.command_pool, NULL);
    vkDestroyDevice(gpu.device, NULL);
    gpu.device = VK_NULL_HANDLE;
    REQUIRE_CMP(gpu_test_take_messages(&gpu).errors, >=, 1);
    gpu_test_close(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_keep_what_is_written),
        cmocka_unit_test(images_keep_what_is_uploaded),
        cmocka_unit_test(misuse_is_counted_as_an_error),
        cmocka_unit_test(a_missing_barrier_is_counted_as_an_error),
        cmocka_unit_test(a_missing_barrier_between_submissions_is_counted_as_an_error),
        cmocka_unit_test(a_leaked_object_is_counted_as_an_error),
    };
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    return cmocka_run_group_tests_name("gpu harness", tests, NULL, NULL);
}
