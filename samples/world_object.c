/* SPDX-License-Identifier: MIT
 * Materials of the sample world, and objects made of several of them. */
#include "world.h"

#include "texture_maker.h"

static const struct material_row {
    const char *name;
    enum texture_kind texture;
    float uv_per_m;
    float metallic, roughness;
    vec3s emission;
    bool cutout;    /* what the texture leaves out is not there */
    bool two_sided; /* one card is seen from both sides */
} rows[MATERIAL_COUNT] = {
    [MATERIAL_GROUND] = { "ground", TEXTURE_GROUND, 0.25f, 0, 0.95f, { { 0 } }, false, false },
    [MATERIAL_WATER] = { "water", TEXTURE_NONE, 1, 0, 0.06f, { { 0 } }, false, false },
    [MATERIAL_PLASTER] = { "plaster", TEXTURE_PLASTER, 0.4f, 0, 0.9f, { { 0 } }, false, false },
    [MATERIAL_STONE] = { "stone", TEXTURE_STONE, 0.5f, 0, 0.85f, { { 0 } }, false, false },
    [MATERIAL_ROOF] = { "roof", TEXTURE_TILES, 0.5f, 0, 0.8f, { { 0 } }, false, false },
    [MATERIAL_WOOD] = { "wood", TEXTURE_PLANKS, 0.9f, 0, 0.65f, { { 0 } }, false, false },
    [MATERIAL_COBBLES] = { "wet cobbles", TEXTURE_COBBLES, 0.4f, 0, 0.18f, { { 0 } }, false, false },
    [MATERIAL_COPPER] = { "copper", TEXTURE_NONE, 1, 1, 0.22f, { { 0 } }, false, false },
    [MATERIAL_IRON] = { "iron", TEXTURE_NONE, 1, 1, 0.5f, { { 0 } }, false, false },
    [MATERIAL_BARK] = { "bark", TEXTURE_BARK, 0.8f, 0, 0.9f, { { 0 } }, false, false },
    [MATERIAL_LEAVES] = { "leaves", TEXTURE_LEAVES, 1, 0, 0.75f, { { 0 } }, true, true },
    [MATERIAL_NEEDLES] = { "needles", TEXTURE_NEEDLES, 1, 0, 0.8f, { { 0 } }, true, true },
    [MATERIAL_GRASS] = { "grass", TEXTURE_GRASS, 1, 0, 0.85f, { { 0 } }, true, false },
    [MATERIAL_FABRIC] = { "fabric", TEXTURE_WOVEN, 1.5f, 0, 0.95f, { { 0 } }, false, false },
    [MATERIAL_PAINT] = { "paint", TEXTURE_NONE, 1, 0, 0.5f, { { 0 } }, false, false },
    /* A flame behind glass looks bright but must not outshine the point light that stands for it. */
    [MATERIAL_GLOW] = { "lamp glass", TEXTURE_NONE, 1, 0, 0.5f, { { 14, 8.4f, 3.6f } }, false, false },
};

void world_materials_make(struct world *world)
{
    for (int i = 0; i < MATERIAL_COUNT; i++) {
        const struct material_row *row = &rows[i];
        struct glb_material material = { .name = row->name,
                                         .base_color = { 1, 1, 1, 1 },
                                         .metallic = row->metallic,
                                         .roughness = row->roughness,
                                         .emission = { row->emission.x, row->emission.y, row->emission.z },
                                         .alpha_cutoff = row->cutout ? 0.5f : 0,
                                         .double_sided = row->two_sided };
        if (row->texture != TEXTURE_NONE) {
            const struct texture_pair pair = texture_make(world->writer, row->texture, world->seed);
            material.base_color_texture = pair.color;
            material.normal_texture = pair.normal;
        }
        world->materials[i] = glb_writer_add_material(world->writer, &material);
    }
}

void object_begin(struct object *object, mat4s transform)
{
    for (int i = 0; i < MATERIAL_COUNT; i++)
        mesh_init(&object->parts[i]);
    object->transform = transform;
}

struct mesh *object_part(struct object *object, enum world_material material, vec3s color)
{
    struct mesh *part = &object->parts[material];
    part->transform = object->transform;
    part->color = color;
    part->uv_per_m = rows[material].uv_per_m;
    return part;
}

void object_box(struct object *object, enum world_material material, vec3s color, vec3s low, vec3s high)
{
    mesh_box(object_part(object, material, color), low, high);
}

glb_handle object_finish(struct world *world, struct object *object, const char *name)
{
    struct glb_primitive primitives[MATERIAL_COUNT];
    uint32_t count = 0;
    for (int i = 0; i < MATERIAL_COUNT; i++)
        if (object->parts[i].index_count) {
            primitives[count++] = mesh_primitive(&object->parts[i], world->materials[i], true);
            world->triangle_count += object->parts[i].index_count / 3;
        }
    const glb_handle mesh = count ? glb_writer_add_mesh(world->writer, name, primitives, count) : 0;
    for (int i = 0; i < MATERIAL_COUNT; i++)
        mesh_finish(&object->parts[i]);
    return mesh;
}

void object_place(struct world *world, struct object *object, const char *name)
{
    const glb_handle mesh = object_finish(world, object, name);
    if (mesh)
        glb_writer_add_node(world->writer, name, mesh, NULL);
}

void world_lamp_add(struct world *world, struct object *object, vec3s position, vec3s color, float intensity,
                    float radius_m)
{
    const vec3s at = glms_mat4_mulv3(object->transform, position, 1);
    struct mesh *glass = object_part(object, MATERIAL_GLOW, v3(1, 1, 1));
    mesh_sphere(glass, v3(position.x, position.y + 2.6f * radius_m, position.z), radius_m, 12);
    glb_writer_add_light(world->writer, &(struct glb_light){ .name = "lamp",
                                                             .type = GLB_LIGHT_POINT,
                                                             .position = { at.x, at.y, at.z },
                                                             .color = { color.x, color.y, color.z },
                                                             .intensity = intensity,
                                                             .range_m = 24 });
}
