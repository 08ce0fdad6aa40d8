/* SPDX-License-Identifier: MIT
 * Houses one can walk into: walls with openings, shutters, doors, floors, ceilings and gable roofs. */
#include "world.h"

#include <math.h>

#include "noise.h"

static const float roof_slope = 0.84f, eaves_m = 0.45f, slab_m = 0.16f, floor_m = HOUSE_FLOOR_MM / 1000.0f;

static const vec3s timber = { { 0.28f, 0.17f, 0.09f } };

vec3s house_point(const struct house *house, vec3s local)
{
    return glms_mat4_mulv3(placement(house->position, house->yaw_rad, 1), local, 1);
}

void world_houses_layout(uint32_t seed, struct house houses[HOUSE_COUNT])
{
    static const float lots[6] = { -49, -33, -17, 17, 33, 49 };
    static const vec3s walls[5] = { { { 0.82f, 0.74f, 0.60f } },
                                    { { 0.80f, 0.62f, 0.42f } },
                                    { { 0.78f, 0.76f, 0.72f } },
                                    { { 0.70f, 0.48f, 0.36f } },
                                    { { 0.62f, 0.66f, 0.62f } } };
    static const vec3s accents[4] = { { { 0.20f, 0.36f, 0.55f } },
                                      { { 0.62f, 0.44f, 0.14f } },
                                      { { 0.28f, 0.42f, 0.22f } },
                                      { { 0.58f, 0.22f, 0.16f } } };
    static const vec3s roofs[3] = { { { 0.50f, 0.20f, 0.12f } },
                                    { { 0.42f, 0.23f, 0.16f } },
                                    { { 0.30f, 0.29f, 0.31f } } };
    struct random random = { random_hash(seed + 400) };
    for (int i = 0; i < HOUSE_COUNT; i++) {
        struct house *house = &houses[i];
        const float side = i < 6 ? -1.0f : 1.0f;
        *house = (struct house){ .width = random_range(&random, 7.4f, 9.6f),
                                 .depth = random_range(&random, 6.2f, 7.6f),
                                 .height = random_range(&random, 2.75f, 3.05f),
                                 .wall = random_range(&random, 0.2f, 0.3f),
                                 .outside = walls[random_hash3(seed, (uint32_t)i, 1) % 5],
                                 .inside = v3(0.78f, 0.75f, 0.68f),
                                 .accent = accents[random_hash3(seed, (uint32_t)i, 2) % 4],
                                 .roof = roofs[random_hash3(seed, (uint32_t)i, 3) % 3],
                                 .seed = random_hash3(seed, (uint32_t)i, 4) };
        const float setback = 5.5f + house->depth / 2 + random_range(&random, 0, 1.5f);
        house->position = v3(lots[i % 6] + random_range(&random, -1, 1), 0, side * setback);
        house->yaw_rad = (side < 0 ? 0 : GLM_PIf) + random_range(&random, -0.07f, 0.07f);
        house->position.y = world_height(seed, house->position.x, house->position.z);
    }
    houses[2].role = HOUSE_SUNLIT;
    houses[3].role = HOUSE_COLORED;
    houses[9].role = HOUSE_LAMPLIT;
}

/* ---- Roof -------------------------------------------------------------------------------------------- */

static void roof_side_add(struct object *object, const struct house *house, float side)
{
    const float half = house->width / 2 + eaves_m, depth = house->depth / 2,
                top = house->height + depth * roof_slope;
    const float eave_y = house->height - eaves_m * roof_slope, eave_z = side * (depth + eaves_m);
    const vec3s ridge_l = v3(-half, top, 0), ridge_r = v3(half, top, 0);
    const vec3s eave_l = v3(-half, eave_y, eave_z), eave_r = v3(half, eave_y, eave_z), up = v3(0, slab_m, 0);
    const vec3s top_rl = glms_vec3_add(ridge_l, up), top_rr = glms_vec3_add(ridge_r, up);
    const vec3s top_el = glms_vec3_add(eave_l, up), top_er = glms_vec3_add(eave_r, up);
    struct mesh *tiles = object_part(object, MATERIAL_ROOF, house->roof);
    struct mesh *wood = object_part(object, MATERIAL_WOOD, timber);
    if (side > 0) {
        mesh_quad(tiles, top_el, top_er, top_rr, top_rl);
        mesh_quad(wood, ridge_l, ridge_r, eave_r, eave_l);
        mesh_quad(wood, eave_l, eave_r, top_er, top_el);
        mesh_quad(wood, eave_r, ridge_r, top_rr, top_er);
        mesh_quad(wood, ridge_l, eave_l, top_el, top_rl);
    } else {
        mesh_quad(tiles, top_er, top_el, top_rl, top_rr);
        mesh_quad(wood, ridge_r, ridge_l, eave_l, eave_r);
        mesh_quad(wood, eave_r, eave_l, top_el, top_er);
        mesh_quad(wood, ridge_r, eave_r, top_er, top_rr);
        mesh_quad(wood, eave_l, ridge_l, top_rl, top_el);
    }
}

static void gable_add(struct object *object, const struct house *house, float side)
{
    const float x = side * house->width / 2, in = x - side * house->wall, d = house->depth / 2;
    const float low = house->height, top = low + d * roof_slope;
    struct mesh *mesh = object_part(object, MATERIAL_PLASTER, house->outside);
    mesh_face3(mesh, v3(x, low, side * d), v3(x, low, -side * d), v3(x, top, 0));
    mesh_face3(mesh, v3(in, low, -side * d), v3(in, low, side * d), v3(in, top, 0));
    /* A small round-headed vent of dark wood gives the gable a scale. */
    object_box(object, MATERIAL_WOOD, timber, v3(fminf(x, x + side * 0.04f), low + 0.9f, -0.25f),
               v3(fmaxf(x, x + side * 0.04f), low + 1.5f, 0.25f));
}

static void chimney_add(struct object *object, const struct house *house)
{
    const float x = 0.28f * house->width, ridge = house->height + house->depth / 2 * roof_slope;
    object_box(object, MATERIAL_STONE, v3(0.6f, 0.52f, 0.46f), v3(x - 0.35f, house->height, -1.35f),
               v3(x + 0.35f, ridge + 0.6f, -0.65f));
}

/* ---- Doors and windows ------------------------------------------------------------------------------- */

/* A board of `width` hinged at (x, z = 0), opened by `angle` from lying in the wall's plane towards +x. */
static void leaf_add(struct object *object, mat4s frame, vec3s hinge, float width, float height,
                     float thickness, float angle_rad, vec3s color)
{
    const mat4s before = object->transform;
    const mat4s turned = glms_rotate(glms_translate(frame, hinge), angle_rad, v3(0, 1, 0));
    object->transform = glms_mat4_mul(before, turned);
    object_box(object, MATERIAL_WOOD, color, v3(0, 0, 0), v3(width, height, thickness));
    object->transform = before;
}

static void window_add(struct object *object, const struct wall *wall, const struct opening *hole,
                       vec3s color, bool closed)
{
    const mat4s before = object->transform;
    const float z = -0.5f * wall->thickness, bar = 0.025f, x = 0.5f * (hole->x0 + hole->x1);
    const float half = 0.5f * (hole->x1 - hole->x0), height = hole->y1 - hole->y0,
                y = hole->y0 + 0.6f * height;
    object->transform = glms_mat4_mul(before, wall->frame);
    const vec3s white = v3(0.72f, 0.69f, 0.62f);
    object_box(object, MATERIAL_WOOD, white, v3(x - bar, hole->y0, z - bar), v3(x + bar, hole->y1, z + bar));
    object_box(object, MATERIAL_WOOD, white, v3(hole->x0, y - bar, z - bar), v3(hole->x1, y + bar, z + bar));
    object_box(object, MATERIAL_STONE, v3(0.7f, 0.67f, 0.6f), v3(hole->x0 - 0.08f, hole->y0 - 0.08f, -0.02f),
               v3(hole->x1 + 0.08f, hole->y0, 0.1f));
    object->transform = before;
    const float open = closed ? 0 : 2.85f;
    leaf_add(object, wall->frame, v3(hole->x0, hole->y0, 0.01f), half, height, 0.035f, -open, color);
    /* The other leaf is the same one, turned around: closed at 180 degrees. */
    leaf_add(object, wall->frame, v3(hole->x1, hole->y0, 0.045f), half, height, 0.035f, GLM_PIf + open,
             color);
}

/* ---- Walls ------------------------------------------------------------------------------------------- */

/* Side 0 is the front (+Z), then right (+X), back and left, each seen from outside. */
static struct wall house_wall(const struct house *house, int side)
{
    const bool gable = side & 1;
    const float length = gable ? house->depth - 2 * house->wall : house->width;
    const float out = gable ? house->width / 2 : house->depth / 2;
    const mat4s turned = glms_rotate(glms_mat4_identity(), (float)side * GLM_PI_2f, v3(0, 1, 0));
    return (struct wall){ .frame = glms_translate(turned, v3(-length / 2, 0, out)),
                          .length = length,
                          .bottom = 0,
                          .top = house->height,
                          .thickness = house->wall,
                          .material = MATERIAL_PLASTER,
                          .outside = house->outside,
                          .inside = house->inside };
}

static vec3s inside_color(const struct house *house, int side)
{
    if (house->role == HOUSE_COLORED)
        return side == 1   ? v3(0.08f, 0.42f, 0.12f)
               : side == 3 ? v3(0.66f, 0.06f, 0.05f)
                           : v3(0.8f, 0.79f, 0.76f);
    return side == 2 && house->role == HOUSE_PLAIN ? glms_vec3_lerp(house->inside, house->accent, 0.6f)
                                                   : house->inside;
}

static void front_add(struct object *object, const struct house *house)
{
    struct wall wall = house_wall(house, 0);
    const float w = house->width, sill = 0.9f, head = 2.25f;
    const struct opening holes[3] = { { 0.12f * w, 0.12f * w + 1.7f, sill, head },
                                      { 0.5f * w - 0.5f, 0.5f * w + 0.5f, floor_m, 2.25f },
                                      { 0.88f * w - 1.7f, 0.88f * w, sill, head } };
    wall.inside = inside_color(house, 0);
    wall.openings = holes;
    wall.opening_count = 3;
    wall_add(object, &wall);
    const bool closed = house->role == HOUSE_LAMPLIT;
    window_add(object, &wall, &holes[0], house->accent, closed);
    window_add(object, &wall, &holes[2], house->accent, closed);
    const float ajar = closed ? 0 : house->role == HOUSE_PLAIN && house->seed % 3 == 0 ? 0.35f : 1.9f;
    const vec3s hinge = v3(holes[1].x0, floor_m, -house->wall);
    leaf_add(object, wall.frame, hinge, 1.0f, holes[1].y1 - floor_m, 0.05f, ajar,
             glms_vec3_scale(house->accent, 0.8f));
    object_box(object, MATERIAL_STONE, v3(0.62f, 0.6f, 0.56f), v3(-0.8f, -0.4f, house->depth / 2),
               v3(0.8f, floor_m, house->depth / 2 + 0.7f));
}

static void other_walls_add(struct object *object, const struct house *house)
{
    for (int side = 1; side < 4; side++) {
        struct wall wall = house_wall(house, side);
        const float x = 0.5f * wall.length, half = 0.65f;
        const struct opening hole = { x - half, x + half, 0.95f, 2.2f };
        const bool lit = house->role == HOUSE_PLAIN && (side == 2 || house->seed & (1u << side));
        wall.inside = inside_color(house, side);
        wall.openings = &hole;
        wall.opening_count = lit ? 1 : 0;
        wall_add(object, &wall);
        if (lit)
            window_add(object, &wall, &hole, house->accent, house->seed % 5 == 1);
    }
}

/* A wall across the house with a doorway, in two thirds of the plain houses. */
static void partition_add(struct object *object, const struct house *house)
{
    struct wall wall = house_wall(house, 1);
    const struct opening door = { 0.3f, 1.2f, 0, 2.1f };
    wall.frame = glms_translate(wall.frame, v3(0, 0, -house->width * 0.38f));
    wall.bottom = floor_m;
    wall.top = house->height - slab_m;
    wall.thickness = 0.12f;
    wall.outside = house->inside;
    wall.openings = &door;
    wall.opening_count = 1;
    wall_add(object, &wall);
}

void world_house_add(struct world *world, const struct house *house, uint32_t index)
{
    const float w = house->width / 2, d = house->depth / 2, t = house->wall, h = house->height;
    struct object object;
    object_begin(&object, placement(house->position, house->yaw_rad, 1));
    object_box(&object, MATERIAL_STONE, v3(0.58f, 0.55f, 0.5f), v3(-w - 0.06f, -1, -d - 0.06f),
               v3(w + 0.06f, floor_m - 0.05f, d + 0.06f));
    /* Floor and ceiling reach into the walls: edges that only touch leave cracks of a pixel. */
    const float x = w - 0.5f * t, z = d - 0.5f * t;
    object_box(&object, MATERIAL_WOOD, v3(0.56f, 0.4f, 0.25f), v3(-x, floor_m - 0.05f, -z),
               v3(x, floor_m, z));
    object_box(&object, MATERIAL_PLASTER, v3(0.8f, 0.79f, 0.76f), v3(-x, h - slab_m, -z),
               v3(x, h - 0.01f, z));
    front_add(&object, house);
    other_walls_add(&object, house);
    if (house->role == HOUSE_PLAIN && index % 3)
        partition_add(&object, house);
    for (int side = -1; side <= 1; side += 2) {
        roof_side_add(&object, house, (float)side);
        gable_add(&object, house, (float)side);
    }
    chimney_add(&object, house);
    house_furnish(world, &object, house);
    object_place(world, &object, "house");
}
