/* SPDX-License-Identifier: MIT
 * Descriptions of meshes that shaders could not read, or that name more than a buffer has, are refused with
 * the numbers in the message. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>
#include <string.h>

static struct gi_test t;

enum { VERTICES = 100, BUFFER_BYTES = 4096 };

static struct sdfgi_mesh_desc good_mesh(void)
{
    return (struct sdfgi_mesh_desc){ .position_buffer = t.buffers[0].buffer,
                                     .vertex_count = VERTICES,
                                     .triangle_count = 10,
                                     .bounds_max = { 1, 1, 0 } };
}

static struct sdfgi_mesh_desc with_all(void)
{
    struct sdfgi_mesh_desc d = good_mesh();
    d.uv_buffer = d.color_buffer = d.index_buffer = d.position_buffer;
    return d;
}

static void require_accepted(const struct sdfgi_mesh_desc *d)
{
    sdfgi_mesh mesh;
    REQUIRE_CMP((int)sdfgi_mesh_create(t.gi, d, &mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_mesh_destroy(t.gi, mesh), ==, (int)SDFGI_OK);
}

/* Refused, with all of the words in the message. */
static void require_refused(const struct sdfgi_mesh_desc *d, const char *const words[static 5])
{
    sdfgi_mesh mesh = { 77 };
    REQUIRE_CMP((int)sdfgi_mesh_create(t.gi, d, &mesh), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(mesh.id, ==, 77u);
    for (int i = 0; i < 5 && words[i]; i++)
        if (!strstr(t.last_message, words[i]))
            require_fail(__FILE__, __LINE__, "'%s' is not in: %s", words[i], t.last_message);
}

#define REFUSED(start, change, ...)                                                                          \
    do {                                                                                                     \
        struct sdfgi_mesh_desc d = start();                                                                  \
        change;                                                                                              \
        require_refused(&d, (const char *[5]){ "sdfgi_mesh_create", __VA_ARGS__ });                          \
    } while (0)
#define ACCEPTED(start, change)                                                                              \
    do {                                                                                                     \
        struct sdfgi_mesh_desc d = start();                                                                  \
        change;                                                                                              \
        require_accepted(&d);                                                                                \
    } while (0)

static void formats_that_vertices_cannot_have_are_told_by_number(void **state)
{
    (void)state;
    REFUSED(with_all, d.position_format = VK_FORMAT_R64G64B64_SFLOAT, "position_format", " 118,");
    REFUSED(with_all, d.uv_format = VK_FORMAT_R32G32_UINT, "uv_format", " 101,");
    REFUSED(with_all, d.color_format = VK_FORMAT_BC7_SRGB_BLOCK, "color_format", " 146,");
    REFUSED(with_all, d.color_format = VK_FORMAT_R16G16_UNORM, "color_format", "VK_FORMAT_R16G16_UNORM",
            "at least 3 components");
    REFUSED(with_all, d.uv_format = VK_FORMAT_R32_SFLOAT, "uv_format", " 100,");
    REFUSED(with_all, d.uv_format = (VkFormat)1000156000, "uv_format", "1000156000");
    REFUSED(with_all, d.uv_format = (VkFormat)-5, "uv_format", "-5");
}

static void offsets_and_strides_fit_the_format(void **state)
{
    (void)state;
    REFUSED(with_all, d.position_offset = 2, "position_offset", " 2,", "multiple of 4",
            "VK_FORMAT_R32G32B32_SFLOAT");
    ACCEPTED(with_all, (d.position_offset = 2, d.position_format = VK_FORMAT_R16G16B16_SFLOAT));
    REFUSED(with_all, (d.position_offset = 1, d.position_format = VK_FORMAT_R16G16B16_SFLOAT),
            "position_offset", " 1,", "multiple of 2");
    ACCEPTED(with_all, (d.color_offset = 3, d.color_format = VK_FORMAT_R8G8B8_SRGB));
    REFUSED(with_all, (d.color_offset = 2, d.color_format = VK_FORMAT_A8B8G8R8_SRGB_PACK32), "color_offset",
            " 2,", "multiple of 4");
    REFUSED(with_all, (d.color_stride = 2, d.color_format = VK_FORMAT_R8G8B8_SRGB), "color_stride", " 2,",
            "multiple of 1", "at least 3");
    REFUSED(with_all, (d.uv_stride = 7, d.uv_format = VK_FORMAT_R16G16_UNORM), "uv_stride", " 7,",
            "multiple of 2", "at least 4");
    ACCEPTED(with_all, (d.uv_stride = 6, d.uv_format = VK_FORMAT_R16G16_UNORM));
    ACCEPTED(good_mesh, (d.uv_stride = 3, d.color_format = VK_FORMAT_R8_UNORM)); /* not read */
}

static void ranges_hold_what_the_mesh_reads(void **state)
{
    (void)state;
    ACCEPTED(good_mesh, d.position_range = 1200);
    REFUSED(good_mesh, d.position_range = 1199, "position_range", "1199", "1200");
    ACCEPTED(good_mesh, (d.position_range = 99 * 16 + 12, d.position_stride = 16));
    REFUSED(good_mesh, (d.position_range = 99 * 16 + 11, d.position_stride = 16), "position_range", "1595",
            "1596");
    REFUSED(with_all, d.color_range = 1599, "color_range", "1599", "1600");
    REFUSED(with_all, (d.uv_range = 199, d.uv_format = VK_FORMAT_R8G8_UNORM), "uv_range", "199", "200");
    ACCEPTED(with_all, d.index_range = 60);
    REFUSED(with_all, d.index_range = 59, "index_range", "59", "60");
    REFUSED(with_all, (d.index_range = 61, d.first_index = 1), "index_range", "61", "62");
    ACCEPTED(with_all, (d.index_range = 31, d.first_index = 1, d.index_type = VK_INDEX_TYPE_UINT8_EXT));
}

static void buffers_hold_what_the_mesh_reads(void **state)
{
    (void)state;
    ACCEPTED(good_mesh, d.position_offset = BUFFER_BYTES - 1200);
    REFUSED(good_mesh, d.position_offset = BUFFER_BYTES, "position_buffer", "1200 bytes", "4096");
    REFUSED(good_mesh, d.position_offset = UINT64_MAX - 3, "position_buffer", "18446744073709551612");
    REFUSED(good_mesh, d.vertex_count = 4000, "position_buffer", "48000 bytes");
    REFUSED(good_mesh, (d.vertex_count = UINT32_MAX, d.position_stride = UINT32_MAX - 3), "position_buffer");
    REFUSED(with_all, d.index_offset = 5000, "index_buffer", "60 bytes", "index_offset = 5000");
    REFUSED(with_all, (d.triangle_count = UINT32_MAX, d.index_type = VK_INDEX_TYPE_UINT32), "index_buffer",
            "51539607540 bytes");
    REFUSED(with_all, d.first_index = UINT32_MAX, "index_buffer", "8589934650 bytes");
}

static void vertices_without_indices_exist(void **state)
{
    (void)state;
    ACCEPTED(good_mesh, d.triangle_count = 33);
    REFUSED(good_mesh, d.triangle_count = 34, "triangle_count", "34", "33");
    ACCEPTED(good_mesh, (d.triangle_count = 33, d.first_index = 1));
    REFUSED(good_mesh, (d.triangle_count = 33, d.first_index = 2), "triangle_count", "33", "32", "100");
    ACCEPTED(good_mesh, (d.triangle_count = 33, d.first_index = 5, d.vertex_offset = -4));
    REFUSED(good_mesh, d.vertex_offset = -1, "first_index + vertex_offset", "-1");
    REFUSED(good_mesh, d.first_index = UINT32_MAX, "triangle_count", "at most 0");
    ACCEPTED(with_all, d.vertex_offset = -1000);
}

/* A limit of a device's that no buffer of a test reaches. */
static void what_a_device_cannot_bind_is_refused(void **state)
{
    (void)state;
    uint32_t *limit = &t.gi->backend.device.limits.maxStorageBufferRange;
    const uint32_t before = *limit;
    *limit = 1200;
    ACCEPTED(good_mesh, d.position_offset = 256);
    REFUSED(good_mesh, d.position_offset = 260, "position_buffer", "1200 bytes", "maxStorageBufferRange");
    *limit = before;
}

static int open_context(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    t.buffers[t.buffer_count++] =
        gpu_test_buffer_device(&t.gpu, BUFFER_BYTES, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, NULL);
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    gi_test_close(&t);
    return 0;
}

TEST_GROUP(mesh_input)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_that_vertices_cannot_have_are_told_by_number),
        cmocka_unit_test(offsets_and_strides_fit_the_format),
        cmocka_unit_test(ranges_hold_what_the_mesh_reads),
        cmocka_unit_test(buffers_hold_what_the_mesh_reads),
        cmocka_unit_test(vertices_without_indices_exist),
        cmocka_unit_test(what_a_device_cannot_bind_is_refused),
    };
    return cmocka_run_group_tests_name("mesh_input", tests, open_context, close_context);
}
