/* SPDX-License-Identifier: MIT
 * Reference scenes about reflections: mirrors, brushed metal, wet ground. */
#include "reference_scenes.h"

#include <math.h>

static struct surface glossy(float r, float g, float b, float roughness)
{
    return (struct surface){ .albedo = v3(r, g, b), .roughness = roughness };
}

static struct surface metal(float r, float g, float b, float roughness)
{
    return (struct surface){ .albedo = v3(r, g, b), .roughness = roughness, .metallic = 1 };
}

static struct surface lamp(float r, float g, float b)
{
    return (struct surface){ .emission = v3(r, g, b) };
}

static void ball(struct scene *scene, const char *name, vec3s center, float radius,
                 const struct surface *surface)
{
    mesh_sphere(&scene->mesh, center, radius, 64);
    scene_flush(scene, name, surface);
}

static void pillar(struct scene *scene, const char *name, vec3s foot, float radius, float height,
                   const struct surface *surface)
{
    mesh_cylinder(&scene->mesh, foot, radius, radius, height, 48);
    scene_flush(scene, name, surface);
}

/* A level panel that shines down. */
static void ceiling_panel(struct scene *scene, vec3s low, vec3s high, const struct surface *surface)
{
    mesh_quad(&scene->mesh, v3(low.x, low.y, low.z), v3(high.x, low.y, low.z), v3(high.x, low.y, high.z),
              v3(low.x, low.y, high.z));
    scene_flush(scene, "panel", surface);
}

/* ---- Single metals ----------------------------------------------------------------------------------- */

/* White metals of four roughnesses under a uniform sky: none may be told from the sky. */
void white_metal_furnace_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    static const float roughness[] = { 0.05f, 0.3f, 0.6f, 1 };
    for (int i = 0; i < 4; i++) {
        const struct surface white = metal(1, 1, 1, roughness[i]);
        mesh_sphere(&scene->mesh, v3(1.2f * (float)i - 1.8f, 0, 0), 0.5f, 192);
        scene_flush(scene, "white metal", &white);
    }
    scene->view.lambert = false;
    scene_sky(scene, 1);
    scene_look(scene, v3(0, 0.8f, 5), v3(0, 0, 0), 32);
}

/* Sky, a lamp, tiles and a coloured wall, all of them large: they tell reflections apart, and paths find
 * them. */
void metal_sphere_build(struct scene *scene, float roughness, float unused)
{
    (void)unused;
    const struct surface light = matt(0.75f, 0.73f, 0.7f), dark = matt(0.12f, 0.13f, 0.16f),
                         orange = matt(0.8f, 0.3f, 0.08f), white = lamp(3, 3, 2.8f),
                         gold = metal(0.92f, 0.82f, 0.6f, roughness);
    scene_tiles(scene, 12, 8, &light, &dark);
    scene_box(scene, "back", v3(-6, 0, -4.4f), v3(6, 4, -4), &orange);
    scene_box(scene, "lamp", v3(-4, 0.4f, -1.5f), v3(-3.6f, 2.4f, 0.5f), &white);
    mesh_sphere(&scene->mesh, v3(0, 1, 0), 1, 128);
    scene_flush(scene, "ball", &gold);
    scene->view.lambert = false;
    scene->view.has_sky = true;
    scene->view.sky_zenith = v3(0.35f, 0.5f, 0.8f);
    scene->view.sky_horizon = v3(0.8f, 0.75f, 0.7f);
    scene->view.sky_ground = v3(0.2f, 0.2f, 0.2f);
    scene_look(scene, v3(0, 2, 5.2f), v3(0, 0.95f, 0), 32);
}

/* ---- Rooms ------------------------------------------------------------------------------------------- */

/* A wall that mirrors nearly all of it, a copper panel that mirrors the mirror, and behind the camera what
 * only the mirror shows. */
void mirror_room_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface white = matt(0.75f, 0.74f, 0.72f), wood = glossy(0.42f, 0.26f, 0.14f, 0.5f),
                         silver = metal(0.95f, 0.94f, 0.92f, 0.03f),
                         copper = metal(0.95f, 0.64f, 0.54f, 0.05f), green = matt(0.16f, 0.5f, 0.18f),
                         red = matt(0.7f, 0.09f, 0.07f), blue = matt(0.1f, 0.2f, 0.65f),
                         yellow = glossy(0.8f, 0.62f, 0.1f, 0.3f), light = lamp(3.6f, 3.4f, 3),
                         glow = lamp(2.4f, 0.9f, 0.2f);
    scene_shell(scene, v3(-3, 0, -3), v3(3, 3, 3), 0.3f, &white);
    scene_box(scene, "floor", v3(-3, -0.1f, -3), v3(3, 0.02f, 3), &wood);
    scene_box(scene, "mirror", v3(-2.7f, 0.3f, -3), v3(2.7f, 2.7f, -2.8f), &silver);
    scene_box(scene, "copper panel", v3(-3, 0.5f, -1.8f), v3(-2.8f, 2.4f, 1.2f), &copper);
    scene_box(scene, "green wall", v3(2.8f, 0, -2.6f), v3(3, 3, 3), &green);
    scene_box(scene, "red screen", v3(-1.9f, 0, 2.6f), v3(-0.3f, 2.2f, 2.8f), &red);
    ceiling_panel(scene, v3(-1.6f, 2.96f, -1), v3(1.6f, 2.96f, 1), &light);
    scene_box(scene, "blue block", v3(-1.5f, 0.02f, -1.5f), v3(-0.8f, 0.9f, -0.8f), &blue);
    ball(scene, "yellow ball", v3(0.2f, 0.47f, -1.2f), 0.45f, &yellow);
    pillar(scene, "white pillar", v3(1.5f, 0.02f, -1.4f), 0.25f, 1.5f, &white);
    ball(scene, "glow", v3(-0.5f, 0.27f, -0.3f), 0.25f, &glow);
    scene->view.lambert = false;
    scene_look(scene, v3(1.3f, 1.6f, 2.5f), v3(-0.3f, 1.1f, -2.8f), 62);
}

/* Ten metres between walls of brushed steel. The light stands at the far end. */
void brushed_corridor_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface concrete = glossy(0.4f, 0.39f, 0.37f, 0.8f), paint = matt(0.7f, 0.7f, 0.7f),
                         steel = metal(0.66f, 0.64f, 0.61f, 0.3f), dull = metal(0.75f, 0.6f, 0.45f, 0.45f),
                         red = matt(0.65f, 0.1f, 0.08f), teal = matt(0.06f, 0.4f, 0.42f),
                         white_light = lamp(4, 3.7f, 3.2f), orange_light = lamp(3, 1, 0.2f),
                         blue_light = lamp(0.3f, 1, 3);
    scene_shell(scene, v3(-1.4f, 0, -8), v3(1.4f, 2.6f, 2), 0.3f, &paint);
    scene_box(scene, "floor", v3(-1.4f, -0.1f, -8), v3(1.4f, 0.02f, 2), &concrete);
    scene_box(scene, "steel wall", v3(-1.4f, 0.02f, -8), v3(-1.2f, 2.6f, 2), &steel);
    scene_box(scene, "bronze wall", v3(1.2f, 0.02f, -8), v3(1.4f, 2.6f, 2), &dull);
    mesh_quad(&scene->mesh, v3(-0.9f, 0.3f, -7.98f), v3(0.9f, 0.3f, -7.98f), v3(0.9f, 2.3f, -7.98f),
              v3(-0.9f, 2.3f, -7.98f));
    scene_flush(scene, "end lamp", &white_light);
    scene_box(scene, "orange lamp", v3(-1.2f, 0.02f, -6.2f), v3(-1, 1.4f, -5.8f), &orange_light);
    scene_box(scene, "blue lamp", v3(1, 1.2f, -4.1f), v3(1.2f, 2.2f, -3.7f), &blue_light);
    scene_box(scene, "red crate", v3(0.4f, 0.02f, -5.2f), v3(1.1f, 0.72f, -4.5f), &red);
    scene_box(scene, "teal crate", v3(-1, 0.02f, -2.4f), v3(-0.5f, 0.9f, -1.9f), &teal);
    scene->view.lambert = false;
    scene_look(scene, v3(0.15f, 1.55f, 1.6f), v3(0, 1.2f, -6), 60);
}

/* Chrome from a mirror's roughness to a satin one, round a lamp on a table. */
void chrome_lamp_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface cream = matt(0.75f, 0.7f, 0.6f), wood = glossy(0.45f, 0.25f, 0.12f, 0.4f),
                         red = matt(0.68f, 0.1f, 0.08f), blue = matt(0.1f, 0.22f, 0.6f),
                         carpet = matt(0.25f, 0.32f, 0.2f), globe = lamp(8, 6.2f, 4),
                         skylight = lamp(0.9f, 1.1f, 1.4f);
    const struct surface chrome[] = { metal(0.9f, 0.9f, 0.9f, 0.02f), metal(0.9f, 0.9f, 0.9f, 0.1f),
                                      metal(0.9f, 0.9f, 0.9f, 0.2f) };
    scene_shell(scene, v3(-2.5f, 0, -2.5f), v3(2.5f, 2.8f, 2.5f), 0.3f, &cream);
    scene_box(scene, "carpet", v3(-2.5f, -0.1f, -2.5f), v3(2.5f, 0.02f, 2.5f), &carpet);
    scene_box(scene, "red wall", v3(-2.5f, 0.02f, -2.5f), v3(-2.3f, 2.8f, 2.5f), &red);
    scene_box(scene, "blue wall", v3(2.3f, 0.02f, -2.5f), v3(2.5f, 2.8f, 2.5f), &blue);
    scene_box(scene, "table", v3(-1.4f, 0.02f, -1.2f), v3(1.4f, 0.75f, 0.2f), &wood);
    ceiling_panel(scene, v3(-1.5f, 2.76f, -1), v3(1.5f, 2.76f, 1.5f), &skylight);
    pillar(scene, "lamp foot", v3(-0.15f, 0.75f, -0.6f), 0.08f, 0.3f, &chrome[1]);
    ball(scene, "lamp", v3(-0.15f, 1.31f, -0.6f), 0.28f, &globe);
    ball(scene, "mirror ball", v3(-0.85f, 1.1f, -0.4f), 0.35f, &chrome[0]);
    ball(scene, "chrome ball", v3(0.55f, 1.0f, -0.2f), 0.25f, &chrome[1]);
    ball(scene, "satin ball", v3(1.05f, 1.05f, -0.7f), 0.3f, &chrome[2]);
    pillar(scene, "chrome tube", v3(0.3f, 0.75f, -0.85f), 0.12f, 0.75f, &chrome[0]);
    scene_box(scene, "satin block", v3(-0.35f, 0.75f, -0.15f), v3(0.05f, 0.95f, 0.12f), &chrome[2]);
    scene->view.lambert = false;
    scene_look(scene, v3(0.3f, 1.75f, 2.1f), v3(0, 1.05f, -0.5f), 50);
}

/* ---- Street ------------------------------------------------------------------------------------------ */

static void puddle(struct scene *scene, float x, float z, float half_x, float half_z)
{
    scene->mesh.transform =
        glms_scale(glms_translate(glms_mat4_identity(), v3(x, -0.2f, z)), v3(half_x, 1, half_z));
    mesh_cylinder(&scene->mesh, v3(0, 0, 0), 1, 1, 0.205f, 48);
    scene->mesh.transform = glms_mat4_identity();
}

/* A front along z at x = `face`, its house behind it, with two rows of windows: warm, cold or dark. */
static void house(struct scene *scene, float face, float z0, float z1, const struct surface *wall, int seed)
{
    const struct surface panes[] = { lamp(3, 1.8f, 0.7f), glossy(0.03f, 0.03f, 0.04f, 0.12f),
                                     lamp(0.9f, 1.3f, 1.8f), glossy(0.03f, 0.03f, 0.04f, 0.12f) };
    const float side = face > 0 ? 1 : -1, back = face + 3 * side, x = face - 0.02f * side,
                half = 0.55f * side;
    scene_box(scene, "house", v3(fminf(face, back), 0, z0), v3(fmaxf(face, back), 6, z1), wall);
    for (int i = 0; i < 4; i++) {
        const float z = z0 + (z1 - z0) * (0.25f + 0.5f * (float)(i & 1)), y = i < 2 ? 1.1f : 3.6f;
        mesh_quad(&scene->mesh, v3(x, y, z - half), v3(x, y, z + half), v3(x, y + 1.4f, z + half),
                  v3(x, y + 1.4f, z - half));
        scene_flush(scene, "window", &panes[(i + seed) % 4]);
    }
}

/* The glass hangs over the light, so that it does not enclose it. */
static void street_lamp(struct scene *scene, float x, float z)
{
    const struct surface iron = metal(0.2f, 0.2f, 0.2f, 0.5f), glass = lamp(12, 8.5f, 4.5f);
    pillar(scene, "post", v3(x, 0, z), 0.07f, 3.4f, &iron);
    ball(scene, "glass", v3(x, 3.62f, z), 0.2f, &glass);
    scene_point_light(scene, v3(x - copysignf(0.3f, x), 3.3f, z), v3(1, 0.72f, 0.4f), 25);
}

/* Night: dark asphalt with puddles mirrors windows, lamps and signs. */
void wet_street_night_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface asphalt = glossy(0.05f, 0.05f, 0.055f, 0.4f),
                         water = glossy(0.02f, 0.02f, 0.02f, 0.08f), kerb = glossy(0.2f, 0.2f, 0.2f, 0.3f),
                         brick = matt(0.5f, 0.2f, 0.14f), ochre = matt(0.6f, 0.45f, 0.2f),
                         grey = matt(0.4f, 0.42f, 0.48f), pink_sign = lamp(6, 0.4f, 2.4f),
                         cyan_sign = lamp(0.3f, 4, 5);
    scene_box(scene, "asphalt", v3(-7, -0.5f, -17), v3(7, 0, 7), &asphalt);
    puddle(scene, -0.9f, 0.2f, 1.5f, 1.1f);
    puddle(scene, 1.2f, -2.9f, 1.1f, 1.7f);
    puddle(scene, -1.1f, -6.5f, 1.3f, 2.2f);
    puddle(scene, 1.5f, -9.5f, 0.8f, 1.6f);
    scene_flush(scene, "water", &water);
    mesh_box(&scene->mesh, v3(-4, 0, -14), v3(-2.8f, 0.12f, 7));
    mesh_box(&scene->mesh, v3(2.8f, 0, -14), v3(4, 0.12f, 7));
    scene_flush(scene, "kerb", &kerb);
    const struct surface *walls[] = { &brick, &ochre, &grey };
    for (int i = 0; i < 4; i++) {
        const float z = -14 + 5.25f * (float)i;
        house(scene, -4, z, z + 5.25f, walls[i % 3], i);
        house(scene, 4, z, z + 5.25f, walls[(i + 1) % 3], i + 2);
    }
    scene_box(scene, "end house", v3(-7, 0, -17), v3(7, 7, -14), &ochre);
    scene_box(scene, "pink sign", v3(3.6f, 2.7f, -4.2f), v3(3.8f, 3.2f, -2.6f), &pink_sign);
    scene_box(scene, "cyan sign", v3(-1.2f, 2.4f, -14), v3(1.2f, 3, -13.8f), &cyan_sign);
    street_lamp(scene, -3, -3.5f);
    street_lamp(scene, 3, -9);
    scene->view.lambert = false;
    scene->view.has_sky = true;
    scene->view.sky_zenith = v3(0.002f, 0.003f, 0.006f);
    scene->view.sky_horizon = v3(0.006f, 0.006f, 0.008f);
    scene->view.sky_ground = v3(0, 0, 0);
    scene_look(scene, v3(0.2f, 1.6f, 5.5f), v3(-0.1f, 1.1f, -6), 60);
}
