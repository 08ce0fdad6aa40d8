/* SPDX-License-Identifier: MIT
 * What stands inside the houses. */
#include "world.h"

#include <math.h>

static const vec3s oak = { { 0.38f, 0.24f, 0.13f } };

/* A plate on four legs, for tables, stools and beds; `low` and `high` enclose it. */
static void legged_add(struct object *object, vec3s color, vec3s low, vec3s high, float plate, float leg)
{
    object_box(object, MATERIAL_WOOD, color, v3(low.x, high.y - plate, low.z), high);
    for (int i = 0; i < 4; i++) {
        const float x = i & 1 ? high.x - leg : low.x, z = i & 2 ? high.z - leg : low.z;
        object_box(object, MATERIAL_WOOD, color, v3(x, low.y, z), v3(x + leg, high.y - plate, z + leg));
    }
}

static void table_add(struct object *object, vec3s at, vec3s cloth)
{
    legged_add(object, oak, v3(at.x - 0.8f, at.y, at.z - 0.45f), v3(at.x + 0.8f, at.y + 0.76f, at.z + 0.45f),
               0.05f, 0.07f);
    object_box(object, MATERIAL_FABRIC, cloth, v3(at.x - 0.25f, at.y + 0.76f, at.z - 0.46f),
               v3(at.x + 0.25f, at.y + 0.768f, at.z + 0.46f));
    struct mesh *bowl = object_part(object, MATERIAL_PAINT, v3(0.75f, 0.73f, 0.68f));
    mesh_cylinder(bowl, v3(at.x + 0.05f, at.y + 0.768f, at.z), 0.07f, 0.14f, 0.09f, 16);
    struct mesh *apples = object_part(object, MATERIAL_PAINT, v3(0.55f, 0.07f, 0.04f));
    mesh_sphere(apples, v3(at.x + 0.03f, at.y + 0.88f, at.z + 0.03f), 0.045f, 12);
    mesh_sphere(apples, v3(at.x + 0.1f, at.y + 0.88f, at.z - 0.03f), 0.045f, 12);
    for (int side = -1; side <= 1; side += 2) {
        const float z = at.z + (float)side * 0.75f;
        legged_add(object, oak, v3(at.x - 0.2f, at.y, z - 0.2f), v3(at.x + 0.2f, at.y + 0.45f, z + 0.2f),
                   0.04f, 0.05f);
        const float back = z + (float)side * 0.18f;
        object_box(object, MATERIAL_WOOD, oak, v3(at.x - 0.2f, at.y + 0.45f, back - 0.02f),
                   v3(at.x + 0.2f, at.y + 0.95f, back + 0.02f));
    }
}

/* Head towards -X. */
static void bed_add(struct object *object, vec3s at, vec3s blanket)
{
    legged_add(object, oak, v3(at.x - 1.05f, at.y, at.z - 0.5f), v3(at.x + 1.05f, at.y + 0.35f, at.z + 0.5f),
               0.12f, 0.09f);
    object_box(object, MATERIAL_FABRIC, v3(0.75f, 0.73f, 0.68f), v3(at.x - 1, at.y + 0.35f, at.z - 0.46f),
               v3(at.x + 1, at.y + 0.52f, at.z + 0.46f));
    object_box(object, MATERIAL_FABRIC, blanket, v3(at.x - 0.35f, at.y + 0.33f, at.z - 0.49f),
               v3(at.x + 1.02f, at.y + 0.56f, at.z + 0.49f));
    object_box(object, MATERIAL_FABRIC, v3(0.8f, 0.79f, 0.76f), v3(at.x - 0.95f, at.y + 0.52f, at.z - 0.35f),
               v3(at.x - 0.5f, at.y + 0.62f, at.z + 0.35f));
    object_box(object, MATERIAL_WOOD, oak, v3(at.x - 1.1f, at.y, at.z - 0.52f),
               v3(at.x - 1.03f, at.y + 0.95f, at.z + 0.52f));
}

/* Open shelves against the wall behind them (-Z), with books and jars. */
static void shelf_add(struct object *object, vec3s at, struct random *random)
{
    const float half = 0.6f, deep = 0.3f, height = 1.8f;
    for (int side = -1; side <= 1; side += 2)
        object_box(object, MATERIAL_WOOD, oak, v3(at.x + (float)side * half - 0.02f, at.y, at.z),
                   v3(at.x + (float)side * half + 0.02f, at.y + height, at.z + deep));
    object_box(object, MATERIAL_WOOD, oak, v3(at.x - half, at.y, at.z),
               v3(at.x + half, at.y + height, at.z + 0.02f));
    for (int level = 0; level < 5; level++) {
        const float y = at.y + 0.1f + 0.42f * (float)level;
        object_box(object, MATERIAL_WOOD, oak, v3(at.x - half, y - 0.03f, at.z),
                   v3(at.x + half, y, at.z + deep));
        float x = at.x - half + 0.06f;
        while (level < 4 && x < at.x + half - 0.12f) {
            const float thick = random_range(random, 0.03f, 0.07f), tall = random_range(random, 0.2f, 0.32f);
            const vec3s color = v3(random_range(random, 0.1f, 0.6f), random_range(random, 0.08f, 0.4f),
                                   random_range(random, 0.06f, 0.35f));
            if (random_next(random) < 0.8f)
                object_box(object, MATERIAL_PAINT, color, v3(x, y, at.z + 0.05f),
                           v3(x + thick, y + tall, at.z + 0.24f));
            x += thick + 0.004f;
        }
    }
}

/* Burning logs between stones would need fire; a cold hearth is enough. */
static void hearth_add(struct object *object, vec3s at, float top)
{
    const vec3s stone = v3(0.5f, 0.46f, 0.42f);
    object_box(object, MATERIAL_STONE, stone, v3(at.x - 0.75f, at.y, at.z),
               v3(at.x - 0.45f, at.y + 1.1f, at.z + 0.6f));
    object_box(object, MATERIAL_STONE, stone, v3(at.x + 0.45f, at.y, at.z),
               v3(at.x + 0.75f, at.y + 1.1f, at.z + 0.6f));
    object_box(object, MATERIAL_STONE, stone, v3(at.x - 0.8f, at.y + 1.1f, at.z),
               v3(at.x + 0.8f, at.y + 1.3f, at.z + 0.65f));
    object_box(object, MATERIAL_STONE, stone, v3(at.x - 0.5f, at.y + 1.3f, at.z),
               v3(at.x + 0.5f, top, at.z + 0.45f));
    struct mesh *kettle = object_part(object, MATERIAL_COPPER, v3(0.8f, 0.42f, 0.28f));
    mesh_sphere(kettle, v3(at.x, at.y + 0.2f, at.z + 0.3f), 0.18f, 20);
}

static void lamp_add(struct world *world, struct object *object, const struct house *house, vec3s at,
                     float intensity)
{
    object_box(object, MATERIAL_IRON, v3(0.25f, 0.24f, 0.23f), v3(at.x - 0.012f, at.y + 0.3f, at.z - 0.012f),
               v3(at.x + 0.012f, house->height, at.z + 0.012f));
    world_lamp_add(world, object, at, v3(1, 0.66f, 0.34f), intensity, 0.09f);
}

void house_furnish(struct world *world, struct object *object, const struct house *house)
{
    struct random random = { house->seed };
    const float w = house->width / 2 - house->wall, d = house->depth / 2 - house->wall,
                y = HOUSE_FLOOR_MM / 1000.0f;
    const bool colored = house->role == HOUSE_COLORED;
    const vec3s rug =
        colored ? v3(0.75f, 0.74f, 0.7f) : glms_vec3_lerp(house->accent, v3(0.6f, 0.1f, 0.06f), 0.5f);
    object_box(object, MATERIAL_FABRIC, rug, v3(-w * 0.75f, y, -d * 0.45f),
               v3(w * 0.1f, y + 0.02f, d * 0.55f));
    object_box(object, MATERIAL_FABRIC, glms_vec3_scale(rug, 0.5f),
               v3(-w * 0.75f - 0.1f, y, -d * 0.45f - 0.1f),
               v3(w * 0.1f + 0.1f, y + 0.012f, d * 0.55f + 0.1f));
    table_add(object, v3(-w * 0.32f, y + 0.02f, -0.1f), house->accent);
    hearth_add(object, v3(-w * 0.45f, y, -d), house->height - 0.16f);
    shelf_add(object, v3(w * 0.28f, y, -d), &random);
    bed_add(object, v3(w - 1.15f, y, -d + 1.6f), colored ? v3(0.75f, 0.74f, 0.7f) : house->accent);
    if (house->role == HOUSE_LAMPLIT)
        lamp_add(world, object, house, v3(-w * 0.32f, 1.95f, -0.1f), 7);
}
