/* SPDX-License-Identifier: MIT
 * Every format that vertices may have: shaders read the numbers that its name says, and a room described with
 * it becomes the same volumes as one of floats, by both voxelisers. */
#include "format_codec.h"
#include "gpu_test_compute.h"
#include "pass_square.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include "encode_vertex.comp.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Numbers */

struct trip {
    uint32_t fetch;
    union {
        uint8_t bytes[28];
        uint32_t words[7];
    } data;
    float read[4];
};

enum { PATTERNS = 512 };

/* First each byte 256 times over, which has every smallest and largest number, then anything. */
static void fill_trip(struct trip *trip, uint32_t i, const struct vertex_format *format,
                      struct test_random *random)
{
    trip->fetch = format->fetch | (i & 3u & ~(uint32_t)(format->alignment - 1));
    for (int k = 0; k < 28; k++)
        trip->data.bytes[k] = (uint8_t)(i < 256 ? i : (uint32_t)test_random_real(random, 0, 256));
    if (i == 256) /* 0, or the least there is, where that is less than -1 */
        for (int k = 0; k < 28; k++)
            trip->data.bytes[k] = k % (format->size / format->components) ? 0x80 : 0;
}

/* Half floats of less than 2^-14 may be read as 0: Vulkan leaves that to devices. */
static bool is_flushed(const struct format_codec *codec, double wanted, float read)
{
    return codec->number == FORMAT_FLOAT && codec->bits[0] == 16 && fabs(wanted) < 0x1p-14 && read == 0;
}

/* A device may be off by 2.5 units in the last place where it divides, and by 2^-11 in powers. */
static double tolerance(const struct format_codec *codec, double wanted)
{
    const double relative[] = {
        [FORMAT_UNORM] = 0x1p-22, [FORMAT_SNORM] = 0x1p-22, [FORMAT_SRGB] = 0x1p-11, [FORMAT_FLOAT] = 0
    };
    return relative[codec->number] * fabs(wanted);
}

static void require_trip(const struct trip *trip, const struct vertex_format *format)
{
    const struct format_codec codec = format_codec_of(format->name);
    const uint8_t *element = trip->data.bytes + (trip->fetch & SDFGI_FETCH_OFFSET_MASK);
    double wanted[4];
    format_decode(&codec, element, wanted);
    for (int k = 0; k < 4; k++) {
        const float read = trip->read[k];
        if (isnan(wanted[k]) ? isnan(read)
                             : (double)read == wanted[k] || is_flushed(&codec, wanted[k], read) ||
                                   fabs((double)read - wanted[k]) <= tolerance(&codec, wanted[k]))
            continue;
        require_fail(__FILE__, __LINE__, "%s: component %d of %02x %02x %02x %02x... is %.9g, wanted %.9g",
                     format->name, k, element[0], element[1], element[2], element[3], (double)read,
                     wanted[k]);
    }
}

static void every_format_is_read_as_its_name_says(void **state)
{
    (void)state;
    const size_t count = sdfgi_vertex_format_count * PATTERNS;
    struct trip *trips = test_array_alloc(count, sizeof *trips);
    struct test_random random = { 7 };
    REQUIRE_CMP(sdfgi_vertex_format_count, ==, 67ul);
    for (size_t i = 0; i < count; i++)
        fill_trip(&trips[i], i % PATTERNS, &sdfgi_vertex_formats[i / PATTERNS], &random);
    gpu_test_compute_alone(encode_vertex_comp, sizeof encode_vertex_comp, (uint32_t)count, trips,
                           count * sizeof *trips);
    for (size_t i = 0; i < count; i++)
        require_trip(&trips[i], &sdfgi_vertex_formats[i / PATTERNS]);
    free(trips);
}

static void rows_are_of_the_size_and_alignment_that_their_names_say(void **state)
{
    (void)state;
    for (size_t i = 0; i < sdfgi_vertex_format_count; i++) {
        const struct vertex_format *row = &sdfgi_vertex_formats[i];
        const struct format_codec codec = format_codec_of(row->name);
        REQUIRE_CMP(row->size, ==, codec.size);
        REQUIRE_CMP(row->components, ==, codec.components);
        REQUIRE_CMP(row->alignment, ==, strstr(row->name, "_PACK32") ? 4u : codec.bits[0] / 8);
        REQUIRE_TRUE(sdfgi_vertex_format(row->format) == row);
    }
    REQUIRE_TRUE(sdfgi_vertex_format(VK_FORMAT_UNDEFINED) == NULL);
    REQUIRE_TRUE(sdfgi_vertex_format((VkFormat)-1) == NULL);
    REQUIRE_TRUE(sdfgi_vertex_format(VK_FORMAT_R64G64B64_SFLOAT) == NULL);
}

static void indices_of_every_size_are_read_at_every_byte(void **state)
{
    (void)state;
    static const uint32_t sizes[] = { 1, 2, 4 };
    struct trip trips[3 * 12] = { 0 };
    struct test_random random = { 5 };
    for (uint32_t i = 0; i < 36; i++) {
        trips[i].fetch = 8 * sizes[i % 3] << SDFGI_FETCH_BITS_SHIFT | i / 3;
        for (int k = 0; k < 28; k++)
            trips[i].data.bytes[k] = (uint8_t)test_random_real(&random, 0, 256);
    }
    gpu_test_compute_alone(encode_vertex_comp, sizeof encode_vertex_comp, 36, trips, sizeof trips);
    for (uint32_t i = 0; i < 36; i++) {
        uint32_t wanted = 0, read;
        for (uint32_t k = 0; k < sizes[i % 3]; k++)
            wanted |= (uint32_t)trips[i].data.bytes[i / 3 + k] << 8 * k;
        memcpy(&read, trips[i].read, sizeof read);
        REQUIRE_CMP(read, ==, wanted);
    }
}

/* ---- Rooms: a box of which everything is 0 or 1, what every format holds */

enum { CORNERS = 8, TRIANGLES = 12, BEFORE = 268 /* bytes before the first attribute */ };

static double corner_of(uint32_t corner, int axis)
{
    return corner >> axis & 1;
}

/* Positions, places in a texture and colours of a vertex follow each other in one format. */
static VkBuffer upload_corners(const struct format_codec *codec, uint32_t part, uint32_t stride)
{
    const uint32_t size = (BEFORE + CORNERS * stride + 3) / 4 * 4;
    uint8_t *bytes = test_array_alloc(size, 1);
    for (uint32_t c = 0; c < CORNERS; c++) {
        uint8_t *vertex = bytes + BEFORE + (size_t)c * stride;
        const double x = corner_of(c, 0), y = corner_of(c, 1), z = corner_of(c, 2);
        format_encode(codec, (double[4]){ x, y, z, 1 }, vertex);
        format_encode(codec, (double[4]){ y, x, 0, 1 }, vertex + part);
        format_encode(codec, (double[4]){ z, x, y, 1 }, vertex + 2 * (size_t)part);
    }
    const VkBuffer buffer = square_upload(size, bytes);
    free(bytes);
    return buffer;
}

/* A corner is the sum of x, 2 y and 4 z. */
static const uint32_t box_indices[3 * TRIANGLES] = { 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5 };

/* Colours need a format of three components: others have none. */
static struct sdfgi_mesh_desc describe_room(VkFormat format)
{
    const struct format_codec codec = format_codec_of(sdfgi_vertex_format(format)->name);
    const uint32_t alignment = sdfgi_vertex_format(format)->alignment,
                   part = (codec.size + alignment - 1) / alignment * alignment, stride = 3 * part + alignment;
    const VkBuffer buffer = upload_corners(&codec, part, stride);
    return (struct sdfgi_mesh_desc){
        .position_buffer = buffer,
        .position_offset = BEFORE,
        .position_range = (CORNERS - 1) * stride + codec.size,
        .position_stride = stride,
        .position_format = format,
        .uv_buffer = buffer,
        .uv_offset = BEFORE + part,
        .uv_stride = stride,
        .uv_format = format,
        .color_buffer = codec.components > 2 ? buffer : VK_NULL_HANDLE,
        .color_offset = BEFORE + 2 * part,
        .color_stride = stride,
        .color_format = codec.components > 2 ? format : VK_FORMAT_UNDEFINED,
        .index_buffer = square_upload(sizeof box_indices, box_indices),
        .index_type = VK_INDEX_TYPE_UINT32,
        .vertex_count = CORNERS,
        .triangle_count = TRIANGLES,
        .bounds_max = { 1, 1, 1 },
    };
}

static struct gpu_test_image room_texture(void)
{
    uint8_t texels[64][4];
    for (uint32_t i = 0; i < 64; i++)
        memcpy(texels[i], (uint8_t[4]){ (uint8_t)(100 + 2 * i), (uint8_t)(255 - 3 * i), 200, 255 }, 4);
    return gpu_test_image_create(
        &pass_context.gpu, &(struct gpu_test_image_desc){ .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                          .extent = { 8, 8, 1 },
                                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                                          .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                          .texels = texels,
                                                          .texel_size = 4 });
}

/* What a room of 5 m, turned, becomes; and nothing of it is left. */
static struct pass_volumes voxelize_room(VkFormat format, sdfgi_material material)
{
    const struct sdfgi_mesh_desc desc = describe_room(format);
    struct sdfgi_instance_desc instance = { .mesh = square_mesh_of(&desc), .material = material };
    sdfgi_instance unused;
    double turned[9];
    test_rotation((double[]){ 3, 1, 2 }, 0.6, turned);
    for (int i = 0; i < 9; i++)
        instance.transform.basis[i] = (float)(5 * turned[i]);
    memcpy(instance.transform.translation, (double[]){ -2.5, -3, -1.5 }, sizeof(double[3]));
    REQUIRE_CMP(sdfgi_instance_create(pass_context.gi, &instance, &unused), ==, SDFGI_OK);
    gi_test_update(&pass_context, 1);
    struct pass_volumes volumes = pass_volumes_read(&pass_context);
    REQUIRE_CMP(sdfgi_mesh_destroy(pass_context.gi, instance.mesh), ==, SDFGI_OK);
    for (int i = 0; i < 2; i++)
        gpu_test_buffer_destroy(&pass_context.gpu, &pass_context.buffers[--pass_context.buffer_count]);
    return volumes;
}

/* Every fourth format without SDFGI_TEST_FULL: all kinds of numbers and sizes are among them. */
static void require_rooms_are_equal(enum sdfgi_voxelizer voxelizer)
{
    const size_t stride = getenv("SDFGI_TEST_FULL") ? 1 : 4;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.voxelizer = voxelizer;
    gi_test_renew(&pass_context, &settings);
    struct gpu_test_image texture = room_texture();
    sdfgi_material material;
    const struct sdfgi_material_desc desc = { .albedo = { 1, 1, 1 },
                                              .albedo_texture = { .view = texture.view } };
    REQUIRE_CMP(sdfgi_material_create(pass_context.gi, &desc, &material), ==, SDFGI_OK);
    struct pass_volumes expected[5] = { 0 }; /* by components */
    expected[2] = voxelize_room(VK_FORMAT_R32G32_SFLOAT, material);
    expected[3] = expected[4] = voxelize_room(VK_FORMAT_R32G32B32A32_SFLOAT, material);
    REQUIRE_TRUE(pass_volumes_differ(&expected[2], &expected[3]) > 10000);
    for (size_t i = 0; i < sdfgi_vertex_format_count; i += stride) {
        const struct vertex_format *row = &sdfgi_vertex_formats[i];
        struct pass_volumes read = voxelize_room(row->format, material);
        if (pass_volumes_differ(&read, &expected[row->components]) > 0)
            require_fail(__FILE__, __LINE__, "a room of %s differs", row->name);
        pass_volumes_destroy(&read);
    }
    pass_volumes_destroy(&expected[2]);
    pass_volumes_destroy(&expected[3]);
    gpu_test_image_destroy(&pass_context.gpu, &texture);
}

static void rooms_of_all_formats_are_the_rooms_of_floats(void **state)
{
    (void)state;
    require_rooms_are_equal(SDFGI_VOXELIZER_COMPUTE);
}

static void raster_reads_them_too(void **state)
{
    (void)state;
    if (!pass_raster_is_available())
        skip();
    require_rooms_are_equal(SDFGI_VOXELIZER_RASTER);
}

TEST_GROUP(vertex_formats)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_read_as_its_name_says),
        cmocka_unit_test(rows_are_of_the_size_and_alignment_that_their_names_say),
        cmocka_unit_test(indices_of_every_size_are_read_at_every_byte),
        cmocka_unit_test(rooms_of_all_formats_are_the_rooms_of_floats),
        cmocka_unit_test(raster_reads_them_too),
    };
    return cmocka_run_group_tests_name("vertex_formats", tests, NULL, pass_context_close);
}
