/* SPDX-License-Identifier: MIT
 * Trees, bushes, grass and rocks: a few meshes of each, shown many times. */
#include "world.h"

#include <math.h>

#include "noise.h"

enum { KINDS = 6, TREES = 260, TUFTS = 150, ROCKS = 70 };

struct plant_kind {
    glb_handle mesh;
    uint32_t triangle_count;
};

static vec3s random_direction(struct random *random)
{
    const float y = random_range(random, -1, 1), around = random_range(random, 0, 2 * GLM_PIf),
                r = sqrtf(1 - y * y);
    return v3(r * cosf(around), y, r * sinf(around));
}

/* A leaf card around `center`, lying roughly across `out` with its front that way, so that a crown is lit as
 * a whole: the normals are those of the crown. */
static void card_add(struct mesh *mesh, struct random *random, vec3s center, vec3s out, float size)
{
    const vec3s tilted =
        glms_vec3_normalize(glms_vec3_add(out, glms_vec3_scale(random_direction(random), 0.9f)));
    const vec3s helper = fabsf(tilted.y) < 0.9f ? v3(0, 1, 0) : v3(1, 0, 0);
    const vec3s side = glms_vec3_normalize(glms_vec3_cross(helper, tilted)),
                up = glms_vec3_cross(tilted, side);
    const float turn = random_range(random, 0, 2 * GLM_PIf), c = size * cosf(turn), s = size * sinf(turn);
    const vec3s u = glms_vec3_add(glms_vec3_scale(side, c), glms_vec3_scale(up, s));
    const vec3s v = glms_vec3_add(glms_vec3_scale(side, -s), glms_vec3_scale(up, c));
    const vec3s low = glms_vec3_sub(center, u), high = glms_vec3_add(center, u);
    mesh_card(mesh, glms_vec3_sub(low, v), glms_vec3_sub(high, v), glms_vec3_add(high, v),
              glms_vec3_add(low, v), out);
}

static void blob_add(struct object *object, struct random *random, vec3s center, float radius, int cards,
                     vec3s color)
{
    for (int i = 0; i < cards; i++) {
        const vec3s out = random_direction(random);
        const float reach = radius * random_range(random, 0.5f, 1.05f);
        const vec3s at = glms_vec3_add(center, glms_vec3_scale(v3(out.x, 0.75f * out.y, out.z), reach));
        const vec3s tone = glms_vec3_scale(color, random_range(random, 0.8f, 1.15f));
        card_add(object_part(object, MATERIAL_LEAVES, tone), random, at, out, 0.33f * radius);
    }
}

static void broadleaf_build(struct object *object, struct random *random, float height, vec3s bark,
                            vec3s leaf)
{
    const float trunk = 0.42f * height, radius = 0.03f * height;
    mesh_cylinder(object_part(object, MATERIAL_BARK, bark), v3(0, -0.3f, 0), radius * 1.3f, radius * 0.75f,
                  trunk + 0.3f, 9);
    for (int i = 0; i < 5; i++) {
        const float around = 2.4f * (float)i, lean = random_range(random, 0.5f, 0.9f);
        const mat4s before = object->transform;
        const mat4s limb =
            glms_rotate(glms_rotate(glms_translate(before, v3(0, trunk * 0.95f, 0)), around, v3(0, 1, 0)),
                        i ? lean : 0.08f, v3(0, 0, 1));
        object->transform = limb;
        const float length = 0.3f * height * random_range(random, 0.8f, 1.1f);
        mesh_cylinder(object_part(object, MATERIAL_BARK, bark), v3(0, 0, 0), radius * 0.6f, radius * 0.2f,
                      length, 6);
        const vec3s tip = glms_mat4_mulv3(limb, v3(0, length, 0), 1);
        object->transform = before;
        blob_add(object, random, tip, 0.21f * height, i ? 27 : 34, leaf);
    }
}

static void conifer_build(struct object *object, struct random *random, float height, vec3s leaf)
{
    mesh_cylinder(object_part(object, MATERIAL_BARK, v3(0.22f, 0.15f, 0.1f)), v3(0, -0.3f, 0),
                  0.022f * height, 0.004f * height, height * 0.98f, 8);
    for (int ring = 0; ring < 11; ring++) {
        const float t = (float)ring / 11, y = height * mix(0.14f, 0.97f, t),
                    reach = 0.24f * height * (1.04f - t);
        for (int i = 0; i < 7; i++) {
            const float around = (float)i * 0.897f + (float)ring * 0.7f + random_range(random, -0.2f, 0.2f);
            const vec3s out = v3(cosf(around), -0.45f, sinf(around)),
                        side = v3(-sinf(around) * 0.34f, 0, cosf(around) * 0.34f);
            const vec3s root = v3(0, y, 0), tip = glms_vec3_add(root, glms_vec3_scale(out, reach));
            const vec3s across = glms_vec3_scale(side, reach), normal = v3(out.x * 0.6f, 0.8f, out.z * 0.6f);
            const vec3s tone = glms_vec3_scale(leaf, random_range(random, 0.8f, 1.15f));
            mesh_card(object_part(object, MATERIAL_NEEDLES, tone), glms_vec3_add(root, across),
                      glms_vec3_add(tip, across), glms_vec3_sub(tip, across), glms_vec3_sub(root, across),
                      normal);
        }
    }
}

/* A card for either side: both are lit like the ground around, from above, and none is seen from behind its
 * normal. */
static void blade_add(struct mesh *mesh, vec3s foot, float dx, float dz, float tall)
{
    for (int side = -1; side <= 1; side += 2) {
        const vec3s along = v3((float)side * dx, 0, (float)side * dz), up = v3(0, tall, 0);
        const vec3s left = glms_vec3_sub(foot, along), right = glms_vec3_add(foot, along);
        const vec3s normal = glms_vec3_normalize(v3(-along.z, 0.5f, along.x));
        mesh_card(mesh, left, right, glms_vec3_add(right, up), glms_vec3_add(left, up), normal);
    }
}

static void tuft_build(struct object *object, struct random *random, vec3s color)
{
    for (int i = 0; i < 22; i++) {
        const float x = random_range(random, -1.3f, 1.3f), z = random_range(random, -1.3f, 1.3f);
        const float around = random_range(random, 0, 2 * GLM_PIf), half = random_range(random, 0.2f, 0.32f);
        const float tall = random_range(random, 0.25f, 0.5f), dx = half * cosf(around),
                    dz = half * sinf(around);
        struct mesh *mesh =
            object_part(object, MATERIAL_GRASS, glms_vec3_scale(color, random_range(random, 0.8f, 1.2f)));
        blade_add(mesh, v3(x, -0.03f, z), dx, dz, tall + 0.03f);
    }
}

static void rock_build(struct object *object, uint32_t seed)
{
    struct mesh *mesh = object_part(object, MATERIAL_GROUND, v3(0.36f, 0.34f, 0.31f));
    mesh_sphere(mesh, v3(0, 0, 0), 1, 14);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float *p = &mesh->positions[3 * i];
        const float bump = 1 + 0.45f * noise_value(seed, p[0] * 1.3f + 9, p[1] * 1.3f + p[2] * 1.7f, 0);
        for (int c = 0; c < 3; c++)
            p[c] *= bump * (c == 1 ? 0.7f : 1);
    }
}

static struct plant_kind kind_finish(struct world *world, struct object *object, const char *name)
{
    const uint32_t before = world->triangle_count;
    struct plant_kind kind = { .mesh = object_finish(world, object, name) };
    kind.triangle_count = world->triangle_count - before;
    world->triangle_count = before;
    return kind;
}

static void tree_kinds_make(struct world *world, struct plant_kind kinds[KINDS])
{
    struct random random = { random_hash(world->seed + 900) };
    struct object object;
    for (int i = 0; i < KINDS; i++) {
        object_begin(&object, glms_mat4_identity());
        if (i < 2)
            broadleaf_build(&object, &random, 8 + 2 * (float)i, v3(0.26f, 0.2f, 0.15f),
                            v3(0.16f, 0.27f, 0.05f));
        else if (i == 2)
            broadleaf_build(&object, &random, 9, v3(0.75f, 0.72f, 0.66f), v3(0.30f, 0.34f, 0.06f));
        else if (i == 3)
            blob_add(&object, &random, v3(0, 0.6f, 0), 1.1f, 46, v3(0.13f, 0.23f, 0.06f));
        else
            conifer_build(&object, &random, 9 + 3 * (float)(i - 4), v3(0.09f, 0.18f, 0.08f));
        kinds[i] = kind_finish(world, &object, i == 3 ? "bush" : i > 3 ? "conifer" : "broadleaf");
    }
}

static void plant_place(struct world *world, const struct plant_kind *kind, struct random *random, vec3s at,
                        float scale, const char *name)
{
    const mat4s transform = placement(at, random_range(random, 0, 2 * GLM_PIf), scale);
    glb_writer_add_node(world->writer, name, kind->mesh, (const float *)transform.raw);
    world->triangle_count += kind->triangle_count;
}

static bool in_house(const struct house houses[HOUSE_COUNT], float x, float z, float margin)
{
    for (int i = 0; i < HOUSE_COUNT; i++) {
        const float dx = x - houses[i].position.x, dz = z - houses[i].position.z;
        if (fabsf(dx) < houses[i].width / 2 + margin && fabsf(dz) < houses[i].depth / 2 + margin)
            return true;
    }
    return false;
}

static bool on_tunnel(float x, float z)
{
    return x > TUNNEL_START_M - 16 && x < TUNNEL_END_M + 16 && fabsf(z) < 11;
}

/* Places where nothing may grow: houses, the street and square, the stream, the cuttings before the tunnel.
 */
static bool is_clear(const struct house houses[HOUSE_COUNT], float x, float z, float margin)
{
    return !in_house(houses, x, z, 1.2f + margin) && fabsf(z - world_path_z(x)) > 3.2f + margin &&
           !on_tunnel(x, z) && x * x + z * z > (11 + margin) * (11 + margin) &&
           fabsf(z - world_stream_z(x)) > 8;
}

/* Denser near the village, where the eye is, and in woods on the slopes. */
static void trees_add(struct world *world, const struct house houses[HOUSE_COUNT])
{
    struct plant_kind kinds[KINDS];
    tree_kinds_make(world, kinds);
    struct random random = { random_hash(world->seed + 910) };
    for (int placed = 0, tried = 0; placed < TREES && tried < 40 * TREES; tried++) {
        const float reach = placed < TREES / 3 ? 75 : placed < 2 * TREES / 3 ? 190 : 420;
        const float x = random_range(&random, -reach, reach), z = random_range(&random, -reach, reach) * 0.8f;
        const float wood = noise_fractal(world->seed + 33, x / 45, z / 45, 0, 2);
        const float height = world_height(world->seed, x, z);
        if (!is_clear(houses, x, z, 1.3f) || wood < (reach < 100 ? -0.2f : 0.0f) || height > 120)
            continue;
        const bool high = height > 14 + 10 * wood;
        const int kind = high ? 4 + (int)(random_next(&random) * 2) : (int)(random_next(&random) * 4);
        plant_place(world, &kinds[kind], &random, v3(x, height - 0.1f, z), random_range(&random, 0.75f, 1.2f),
                    "tree");
        placed++;
    }
    /* The one that a view looks at, beside a fence. */
    plant_place(world, &kinds[1], &random, v3(-8.5f, world_height(world->seed, -8.5f, 14), 14), 0.8f, "tree");
}

static void tufts_add(struct world *world, const struct house houses[HOUSE_COUNT])
{
    struct random random = { random_hash(world->seed + 930) };
    struct plant_kind kinds[2];
    for (int i = 0; i < 2; i++) {
        struct object object;
        object_begin(&object, glms_mat4_identity());
        tuft_build(&object, &random, i ? v3(0.32f, 0.32f, 0.1f) : v3(0.17f, 0.27f, 0.06f));
        kinds[i] = kind_finish(world, &object, "grass");
    }
    for (int placed = 0, tried = 0; placed < TUFTS && tried < 40 * TUFTS; tried++) {
        const float x = random_range(&random, -65, 65), z = random_range(&random, -40, 40);
        if (!is_clear(houses, x, z, 0.4f))
            continue;
        plant_place(world, &kinds[placed & 1], &random, v3(x, world_height(world->seed, x, z), z), 1,
                    "grass");
        placed++;
    }
}

static void rocks_add(struct world *world, const struct house houses[HOUSE_COUNT])
{
    struct random random = { random_hash(world->seed + 950) };
    struct plant_kind kinds[3];
    for (uint32_t i = 0; i < 3; i++) {
        struct object object;
        object_begin(&object, glms_mat4_identity());
        rock_build(&object, random_hash3(world->seed, i, 951));
        kinds[i] = kind_finish(world, &object, "rock");
    }
    for (int i = 0; i < ROCKS; i++) {
        const float x = random_range(&random, -160, 160);
        const float bank =
            world_stream_z(x) + (random_next(&random) < 0.5f ? -1.0f : 1.0f) * random_range(&random, 4, 9);
        const float z = i % 3 ? bank : random_range(&random, -140, 140);
        const float scale = random_range(&random, 0.25f, i % 3 ? 1.0f : 1.8f);
        if (i % 3 || is_clear(houses, x, z, 2))
            plant_place(world, &kinds[i % 3], &random, v3(x, world_height(world->seed, x, z), z), scale,
                        "rock");
    }
}

void world_plants_add(struct world *world, const struct house houses[HOUSE_COUNT])
{
    trees_add(world, houses);
    tufts_add(world, houses);
    rocks_add(world, houses);
}
