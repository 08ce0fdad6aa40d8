/* SPDX-License-Identifier: MIT */
#include "pass_square.h"

#include "require.h"

#include <sdfgi/inspect.h>
#include <stdlib.h>

const float square_height = 0.3f;
const float square_corners[SQUARE_CORNERS][2] = { { 0, 0 }, { 0, 1 }, { 1, 1 }, { 1, 0 } };

VkBuffer square_upload(VkDeviceSize size, const void *data)
{
    pass_context.buffers[pass_context.buffer_count] =
        gpu_test_buffer_device(&pass_context.gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    return pass_context.buffers[pass_context.buffer_count++].buffer;
}

struct sdfgi_mesh_desc square_describe(const float (*uvs)[2], const float (*colors)[4])
{
    float positions[SQUARE_CORNERS][3];
    for (int i = 0; i < SQUARE_CORNERS; i++)
        memcpy(positions[i],
               (float[3]){ 4 * square_corners[i][0] - 2, square_height, 4 * square_corners[i][1] - 2 },
               sizeof positions[i]);
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    return (struct sdfgi_mesh_desc){
        .position_buffer = square_upload(sizeof positions, positions),
        .uv_buffer = uvs ? square_upload(SQUARE_CORNERS * sizeof *uvs, uvs) : NULL,
        .color_buffer = colors ? square_upload(SQUARE_CORNERS * sizeof *colors, colors) : NULL,
        .index_buffer = square_upload(sizeof indices, indices),
        .index_type = VK_INDEX_TYPE_UINT32,
        .vertex_count = SQUARE_CORNERS,
        .triangle_count = 2,
        .bounds_min = { -2, square_height, -2 },
        .bounds_max = { 2, square_height, 2 }
    };
}

sdfgi_mesh square_mesh_of(const struct sdfgi_mesh_desc *desc)
{
    sdfgi_mesh mesh;
    REQUIRE_CMP(sdfgi_mesh_create(pass_context.gi, desc, &mesh), ==, SDFGI_OK);
    return mesh;
}

sdfgi_mesh square_mesh(const float (*uvs)[2], const float (*colors)[4])
{
    const struct sdfgi_mesh_desc desc = square_describe(uvs, colors);
    return square_mesh_of(&desc);
}

static void read_albedo(struct square *s)
{
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP(sdfgi_inspect_get_cascade(pass_context.gi, 0, &where), ==, SDFGI_OK);
    uint32_t *words = gi_test_read(&pass_context, RESOURCE_ALBEDO, NULL);
    for (uint32_t z = 0; z < SQUARE_BLOCKS; z++)
        for (uint32_t x = 0; x < SQUARE_BLOCKS; x++) {
            const uint32_t cell[3] = { (uint32_t)((-2 - where.origin_m[0]) / where.cell_m[0]) + 2 * x,
                                       (uint32_t)((square_height - where.origin_m[1]) / where.cell_m[1]),
                                       (uint32_t)((-2 - where.origin_m[2]) / where.cell_m[2]) + 2 * z };
            struct sdfgi_inspect_surface surface;
            sdfgi_inspect_decode_block(words + 2 * sdfgi_inspect_block(&where, cell[0], cell[1], cell[2]),
                                       (uint32_t[2]){ 0 }, 0, 1, &surface);
            for (int k = 0; k < 3; k++)
                s->albedo[z][x][k] = surface.albedo[2][k] / 1023.0;
        }
    free(words);
}

static void read_emission(struct square *s)
{
    struct sdfgi_inspect_cascade where;
    REQUIRE_CMP(sdfgi_inspect_get_cascade(pass_context.gi, 0, &where), ==, SDFGI_OK);
    uint32_t *words = gi_test_read(&pass_context, RESOURCE_EMISSION, NULL);
    const uint32_t middle = where.resolution / 2,
                   level = (uint32_t)(((double)square_height - where.origin_m[1]) / where.cell_m[1]);
    struct sdfgi_inspect_surface surface;
    sdfgi_inspect_decode_block(NULL, words + 2 * sdfgi_inspect_block(&where, middle, level, middle), 0,
                               where.emission_unit, &surface);
    for (int side = 0; side < 2; side++)
        s->emission[side] = (double)surface.emission[1] * surface.emitting[2 + side] / 31;
    free(words);
}

/* Of another material, beyond all cascades: neither the square's material nor its instance is then the first
 * of their lists. */
static sdfgi_material add_first(sdfgi_mesh mesh)
{
    static const struct sdfgi_material_desc desc = { .albedo = { 0.9f, 0.1f, 0.6f } };
    struct sdfgi_instance_desc instance = {
        .mesh = mesh, .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, .translation = { 10000, 0, 0 } }
    };
    sdfgi_instance unused;
    REQUIRE_CMP(sdfgi_material_create(pass_context.gi, &desc, &instance.material), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instance_create(pass_context.gi, &instance, &unused), ==, SDFGI_OK);
    return instance.material;
}

struct square square_voxelize_instance(struct sdfgi_instance_desc *instance,
                                       const struct sdfgi_material_desc *desc)
{
    struct square s;
    sdfgi_instance unused;
    const sdfgi_material first = add_first(instance->mesh);
    REQUIRE_CMP(sdfgi_material_create(pass_context.gi, desc, &instance->material), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instance_create(pass_context.gi, instance, &unused), ==, SDFGI_OK);
    gi_test_update(&pass_context, 1);
    s.bits = gi_test_bits(&pass_context, 0);
    read_albedo(&s);
    read_emission(&s);
    REQUIRE_CMP(sdfgi_mesh_destroy(pass_context.gi, instance->mesh), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_material_destroy(pass_context.gi, instance->material), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_material_destroy(pass_context.gi, first), ==, SDFGI_OK);
    return s;
}

struct square square_voxelize(sdfgi_mesh mesh, const struct sdfgi_material_desc *desc)
{
    struct sdfgi_instance_desc instance = { .mesh = mesh,
                                            .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } } };
    return square_voxelize_instance(&instance, desc);
}

bool square_column_is_set(const struct square *s, uint32_t x, uint32_t z)
{
    const uint32_t edge = (s->bits.size - SQUARE_COLUMNS) / 2;
    bool set = false;
    for (uint32_t y = 0; y < s->bits.size; y++)
        set = set || oracle_bits_get(&s->bits, edge + x, y, edge + z);
    return set;
}

uint32_t square_columns_set(const struct square *s)
{
    uint32_t count = 0;
    for (uint32_t z = 0; z < SQUARE_COLUMNS; z++)
        for (uint32_t x = 0; x < SQUARE_COLUMNS; x++)
            count += square_column_is_set(s, x, z);
    return count;
}

const struct sdfgi_material_desc square_grey = { .albedo = { 0.5f, 0.5f, 0.5f } };
