/* SPDX-License-Identifier: MIT
 * Where the pictures of the sample world are taken from, and the walk through it. */
#include "world.h"

#include <stdio.h>
#include <string.h>

#include "view_file.h"

static const float eye_m = 1.65f;

struct named_view {
    const char *name;
    vec3s position, look_at;
    float yfov_deg;
};

/* A clear morning: the sun stands 32 degrees high in the south-east and looks into the windows of the north
 * side. */
static struct view morning(const struct named_view *named)
{
    return (struct view){ .position = named->position,
                          .look_at = named->look_at,
                          .yfov_deg = named->yfov_deg,
                          .has_sky = true,
                          .has_sun = true,
                          .sky_zenith = v3(0.32f, 0.62f, 1.35f),
                          .sky_horizon = v3(1.15f, 1.25f, 1.4f),
                          .sky_ground = v3(0.28f, 0.26f, 0.22f),
                          .sun_direction = v3(-0.5f, -0.53f, -0.69f),
                          .sun_irradiance = v3(17, 14.2f, 10.6f) };
}

static vec3s at_eye(const struct world *world, float x, float z)
{
    return v3(x, world_height(world->seed, x, z) + eye_m, z);
}

static vec3s in_house(const struct house *house, float x, float y, float z)
{
    return house_point(house, v3(x, HOUSE_FLOOR_MM / 1000.0f + y, z));
}

/* Positions inside in shares of the room's half width and half depth. */
static struct named_view room_view(const char *name, const struct house *house, vec3s from, vec3s to)
{
    const float w = house->width / 2 - house->wall, d = house->depth / 2 - house->wall;
    return (struct named_view){ name, in_house(house, from.x * w, from.y, from.z * d),
                                in_house(house, to.x * w, to.y, to.z * d), 66 };
}

static const struct house *house_of(const struct house houses[HOUSE_COUNT], enum house_role role)
{
    for (int i = 0; i < HOUSE_COUNT; i++)
        if (houses[i].role == role)
            return &houses[i];
    return &houses[0];
}

enum { VIEW_COUNT = 8 };

static void views_make(const struct world *world, const struct house houses[HOUSE_COUNT],
                       struct named_view views[VIEW_COUNT])
{
    vec3s hill = at_eye(world, -84, 66);
    hill.y += 16;
    const vec3s inside = world_tunnel_point(0.13f), ahead = world_tunnel_point(0.36f);
    views[0] = (struct named_view){ "village_street", at_eye(world, -27, 1.2f), v3(6, 1.9f, -1.5f), 60 };
    views[1] = (struct named_view){ "valley_overview", hill, v3(10, 0, -8), 48 };
    views[2] = (struct named_view){ "tree_and_fence", at_eye(world, -2.2f, 17.5f), v3(-9, 1.9f, 11.5f), 60 };
    views[3] = (struct named_view){ "square", at_eye(world, 8.2f, 7), v3(-1.5f, 1.1f, -2), 60 };
    views[4] = (struct named_view){ "tunnel", v3(inside.x, inside.y + eye_m, inside.z),
                                    v3(ahead.x, ahead.y + 1.4f, ahead.z), 62 };
    views[5] = room_view("house_window", house_of(houses, HOUSE_SUNLIT), v3(0.8f, eye_m, -0.25f),
                         v3(-0.5f, 1, 0.2f));
    views[6] = room_view("house_lamp", house_of(houses, HOUSE_LAMPLIT), v3(0.86f, eye_m, 0.8f),
                         v3(-0.7f, 0.95f, -0.6f));
    views[7] = room_view("house_colors", house_of(houses, HOUSE_COLORED), v3(0.5f, eye_m, 0.9f),
                         v3(-0.2f, 0.85f, -0.6f));
}

/* Down the street, through the sunlit house's door and out again, across the square, to the tunnel and
 * through. */
static uint32_t walk_make(const struct world *world, const struct house houses[HOUSE_COUNT],
                          struct walk_point *points)
{
    const struct house *house = house_of(houses, HOUSE_SUNLIT);
    const float front = house->depth / 2;
    uint32_t n = 0;
    points[n++] = (struct walk_point){ at_eye(world, -42, 0.5f), v3(-10, 1.6f, -2) };
    points[n++] =
        (struct walk_point){ at_eye(world, house->position.x - 3, 0.2f), in_house(house, 0, eye_m, 0) };
    points[n++] =
        (struct walk_point){ in_house(house, 0, eye_m, front + 2.5f), in_house(house, 0, eye_m, 0) };
    points[n++] =
        (struct walk_point){ in_house(house, 0, eye_m, front - 1.2f), in_house(house, -1.5f, 1, -1.5f) };
    points[n++] =
        (struct walk_point){ in_house(house, 0.2f, eye_m, front - 2), in_house(house, -2, 1, -0.5f) };
    points[n++] =
        (struct walk_point){ in_house(house, 0, eye_m, front - 0.9f), in_house(house, 0, eye_m, front + 4) };
    points[n++] = (struct walk_point){ in_house(house, 0, eye_m, front + 2.5f), v3(0, 1.2f, 0) };
    points[n++] = (struct walk_point){ at_eye(world, -7, 3), v3(-2.5f, 1, -2.5f) };
    points[n++] = (struct walk_point){ at_eye(world, 7, 0.5f), v3(40, 1.8f, 0) };
    points[n++] = (struct walk_point){ at_eye(world, 60, 0), v3(97, 2, 0) };
    points[n++] = (struct walk_point){ at_eye(world, 92, 0), v3(110, 1.6f, 1) };
    for (int i = 0; i <= 8; i++) {
        const vec3s at = world_tunnel_point((float)i / 8), ahead = world_tunnel_point((float)(i + 1) / 8);
        points[n++] =
            (struct walk_point){ v3(at.x, at.y + eye_m, at.z), v3(ahead.x, ahead.y + eye_m, ahead.z) };
    }
    points[n++] = (struct walk_point){ at_eye(world, 166, 0), v3(200, 6, 0) };
    return n;
}

bool world_views_save(const struct world *world, const struct house houses[HOUSE_COUNT], const char *folder,
                      char *error, size_t error_size)
{
    char path[1024];
    struct named_view views[VIEW_COUNT];
    views_make(world, houses, views);
    for (int i = 0; i < VIEW_COUNT; i++) {
        const struct view view = morning(&views[i]);
        snprintf(path, sizeof(path), "%s/%s.view.json", folder, views[i].name);
        if (!view_save(&view, path, error, error_size))
            return false;
    }
    struct walk_point points[32];
    const uint32_t count = walk_make(world, houses, points);
    snprintf(path, sizeof(path), "%s/walk.json", folder);
    return walk_save(points, count, 5, "village_street.view.json", path, error, error_size);
}
