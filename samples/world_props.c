/* SPDX-License-Identifier: MIT
 * Well, tower, a copper globe on a stone, lanterns along the street, fences round the gardens. */
#include "world.h"

#include <math.h>

static const vec3s masonry = { { 0.62f, 0.59f, 0.53f } };
static const vec3s timber = { { 0.33f, 0.22f, 0.13f } };

/* A wall in a circle, both sides and its rim; an upright tube. */
static void tube_add(struct mesh *mesh, vec3s foot, float outer, float inner, float height, uint32_t segments)
{
    for (uint32_t i = 0; i < segments; i++) {
        const float a = (float)i / (float)segments * 2 * GLM_PIf,
                    b = (float)(i + 1) / (float)segments * 2 * GLM_PIf;
        const vec3s da = v3(cosf(a), 0, sinf(a)), db = v3(cosf(b), 0, sinf(b)), up = v3(0, height, 0);
        const vec3s oa = glms_vec3_add(foot, glms_vec3_scale(da, outer)),
                    ob = glms_vec3_add(foot, glms_vec3_scale(db, outer));
        const vec3s ia = glms_vec3_add(foot, glms_vec3_scale(da, inner)),
                    ib = glms_vec3_add(foot, glms_vec3_scale(db, inner));
        mesh_quad(mesh, ob, oa, glms_vec3_add(oa, up), glms_vec3_add(ob, up));
        mesh_quad(mesh, ia, ib, glms_vec3_add(ib, up), glms_vec3_add(ia, up));
        mesh_quad(mesh, glms_vec3_add(ia, up), glms_vec3_add(ib, up), glms_vec3_add(ob, up),
                  glms_vec3_add(oa, up));
    }
}

/* Wet paving round the well, which mirrors the houses. */
static void square_add(struct object *object)
{
    struct mesh *mesh = object_part(object, MATERIAL_COBBLES, v3(0.42f, 0.4f, 0.38f));
    const uint32_t segments = 40;
    for (uint32_t i = 0; i < segments; i++) {
        const float a = (float)i / (float)segments * 2 * GLM_PIf,
                    b = (float)(i + 1) / (float)segments * 2 * GLM_PIf;
        mesh_face3(mesh, v3(0, 0.05f, 0), v3(8.6f * cosf(b), 0.03f, 8.6f * sinf(b)),
                   v3(8.6f * cosf(a), 0.03f, 8.6f * sinf(a)));
    }
    tube_add(object_part(object, MATERIAL_STONE, masonry), v3(0, -0.3f, 0), 8.9f, 8.6f, 0.4f, segments);
}

static void well_add(struct object *object, vec3s at)
{
    tube_add(object_part(object, MATERIAL_STONE, masonry), v3(at.x, at.y - 0.2f, at.z), 1.1f, 0.8f, 1.05f,
             24);
    struct mesh *water = object_part(object, MATERIAL_WATER, v3(0.03f, 0.05f, 0.06f));
    mesh_cylinder(water, v3(at.x, at.y, at.z), 0.8f, 0.8f, 0.45f, 24);
    for (int side = -1; side <= 1; side += 2)
        object_box(object, MATERIAL_WOOD, timber,
                   v3(at.x + (float)side * 0.95f - 0.07f, at.y + 0.8f, at.z - 0.07f),
                   v3(at.x + (float)side * 0.95f + 0.07f, at.y + 2.3f, at.z + 0.07f));
    object_box(object, MATERIAL_WOOD, timber, v3(at.x - 1.05f, at.y + 1.75f, at.z - 0.05f),
               v3(at.x + 1.05f, at.y + 1.85f, at.z + 0.05f));
    struct mesh *roof = object_part(object, MATERIAL_ROOF, v3(0.5f, 0.2f, 0.12f));
    mesh_cylinder(roof, v3(at.x, at.y + 2.2f, at.z), 1.5f, 0.03f, 0.9f, 8);
    struct mesh *bucket = object_part(object, MATERIAL_COPPER, v3(0.8f, 0.45f, 0.3f));
    tube_add(bucket, v3(at.x + 0.2f, at.y + 1.2f, at.z), 0.16f, 0.14f, 0.26f, 16);
}

static void globe_add(struct object *object, vec3s at)
{
    object_box(object, MATERIAL_STONE, masonry, v3(at.x - 0.45f, at.y - 0.2f, at.z - 0.45f),
               v3(at.x + 0.45f, at.y + 1, at.z + 0.45f));
    object_box(object, MATERIAL_STONE, masonry, v3(at.x - 0.55f, at.y + 1, at.z - 0.55f),
               v3(at.x + 0.55f, at.y + 1.1f, at.z + 0.55f));
    mesh_sphere(object_part(object, MATERIAL_COPPER, v3(0.87f, 0.5f, 0.36f)), v3(at.x, at.y + 1.6f, at.z),
                0.5f, 40);
}

static void tower_add(struct object *object, vec3s at)
{
    struct mesh *stone = object_part(object, MATERIAL_STONE, v3(0.6f, 0.57f, 0.52f));
    tube_add(stone, v3(at.x, at.y - 1, at.z), 3.2f, 2.6f, 13, 28);
    tube_add(stone, v3(at.x, at.y + 11.4f, at.z), 3.6f, 2.6f, 0.6f, 28);
    for (int i = 0; i < 12; i++) {
        const mat4s before = object->transform;
        object->transform = glms_rotate(glms_translate(before, at), (float)i * GLM_PIf / 6, v3(0, 1, 0));
        object_box(object, MATERIAL_STONE, v3(0.6f, 0.57f, 0.52f), v3(-0.5f, 12, 3), v3(0.5f, 12.9f, 3.55f));
        object->transform = before;
    }
    mesh_cylinder(object_part(object, MATERIAL_WOOD, timber), v3(at.x, at.y + 11, at.z), 2.6f, 2.6f, 0.2f,
                  28);
}

/* Post, arm and a glass that hangs from it; the light sits just under the glass. */
static void lantern_add(struct world *world, struct object *object, vec3s at, float towards)
{
    const vec3s iron = v3(0.22f, 0.21f, 0.2f);
    const float x = at.x, y = at.y, z = at.z, arm = z + towards * 0.7f;
    mesh_cylinder(object_part(object, MATERIAL_IRON, iron), v3(x, y - 0.2f, z), 0.07f, 0.045f, 3.3f, 8);
    object_box(object, MATERIAL_IRON, iron, v3(x - 0.025f, y + 2.98f, fminf(z, arm)),
               v3(x + 0.025f, y + 3.03f, fmaxf(z, arm)));
    mesh_cylinder(object_part(object, MATERIAL_IRON, iron), v3(x, y + 2.84f, arm), 0.17f, 0.03f, 0.14f, 8);
    world_lamp_add(world, object, v3(x, y + 2.46f, arm), v3(1, 0.64f, 0.3f), 9, 0.1f);
}

/* Pickets of 2 cm and rails of 4 cm between (x0, z0) and (x1, z1). */
static void fence_add(struct object *object, uint32_t seed, float x0, float z0, float x1, float z1)
{
    const float length = hypotf(x1 - x0, z1 - z0), yaw = -atan2f(z1 - z0, x1 - x0);
    const int posts = (int)(length / 2) + 1, pickets = (int)(length / 0.16f);
    const mat4s before = object->transform;
    object->transform = glms_mat4_mul(before, placement(v3(x0, world_height(seed, x0, z0), z0), yaw, 1));
    const vec3s white = v3(0.74f, 0.71f, 0.64f);
    for (int i = 0; i <= posts; i++) {
        const float x = length * (float)i / (float)posts;
        object_box(object, MATERIAL_WOOD, white, v3(x - 0.05f, -0.4f, -0.05f), v3(x + 0.05f, 1.12f, 0.05f));
    }
    for (int i = 0; i < 2; i++)
        object_box(object, MATERIAL_WOOD, white, v3(0, 0.3f + 0.5f * (float)i, 0.02f),
                   v3(length, 0.38f + 0.5f * (float)i, 0.06f));
    for (int i = 0; i < pickets; i++) {
        const float x = 0.08f + 0.16f * (float)i, top = 0.95f + 0.05f * random_unit(random_hash((uint32_t)i));
        object_box(object, MATERIAL_WOOD, white, v3(x - 0.04f, 0.06f, 0.06f), v3(x + 0.04f, top, 0.08f));
    }
    object->transform = before;
}

static void fences_add(struct world *world)
{
    struct object object;
    object_begin(&object, glms_mat4_identity());
    for (int side = -1; side <= 1; side += 2) {
        const float z = (float)side * 21, near = (float)side * 12.5f;
        fence_add(&object, world->seed, -56, z, -24, z);
        fence_add(&object, world->seed, 24, z, 56, z);
        fence_add(&object, world->seed, -56, near, -56, z);
        fence_add(&object, world->seed, 56, near, 56, z);
    }
    fence_add(&object, world->seed, -12, 12, -4, 12);
    fence_add(&object, world->seed, 4, 12, 12, 12);
    object_place(world, &object, "fences");
}

void world_props_add(struct world *world)
{
    struct object object;
    object_begin(&object, glms_mat4_identity());
    square_add(&object);
    well_add(&object, v3(-2.5f, 0, -2.5f));
    globe_add(&object, v3(4, 0, 3.5f));
    tower_add(&object, v3(-76, world_height(world->seed, -76, -27), -27));
    for (int i = 0; i < 4; i++) {
        const float x = -41 + 26 * (float)i, z = i & 1 ? -3.3f : 3.3f;
        lantern_add(world, &object, v3(x, world_height(world->seed, x, z), z), z > 0 ? -1 : 1);
    }
    object_place(world, &object, "props");
    fences_add(world);
}
