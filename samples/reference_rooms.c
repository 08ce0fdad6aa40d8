/* SPDX-License-Identifier: MIT
 * Reference scenes about rooms: light that must stay out, come round a corner, or come from many places. */
#include "reference_scenes.h"

#include <math.h>

#include "random.h"

static const struct surface plaster = { .albedo = { { 0.7f, 0.7f, 0.7f } } };
static const struct surface ground = { .albedo = { { 0.4f, 0.4f, 0.4f } } };

static vec3s rotated(vec3s v, float angle_rad)
{
    return glms_mat4_mulv3(glms_rotate(glms_mat4_identity(), angle_rad, v3(0, 1, 0)), v, 1);
}

/* Two rooms of 4 x 3 x 4 m side by side: the one at +x is open to sun and sky, the other is closed by the
 * wall that the caller puts between them. */
static void two_rooms_begin(struct scene *scene, float angle_rad)
{
    const float t = 0.6f;
    scene->mesh.transform = glms_rotate(glms_mat4_identity(), angle_rad, v3(0, 1, 0));
    mesh_box(&scene->mesh, v3(-4 - t, -t, -2 - t), v3(4, 0, 2 + t));
    mesh_box(&scene->mesh, v3(-4 - t, 3, -2 - t), v3(4, 3 + t, 2 + t));
    mesh_box(&scene->mesh, v3(-4 - t, 0, -2 - t), v3(4, 3, -2));
    mesh_box(&scene->mesh, v3(-4 - t, 0, 2), v3(4, 3, 2 + t));
    mesh_box(&scene->mesh, v3(-4 - t, 0, -2), v3(-4, 3, 2));
}

/* The house is turned by the angle, so that its walls cross the voxel grid at a slant; sun and camera with
 * it. */
static void two_rooms_end(struct scene *scene, float angle_rad, float eye_x)
{
    scene_flush(scene, "house", &plaster);
    scene_sun(scene, rotated(v3(-0.8f, -0.5f, -0.33f), angle_rad), 10);
    scene_sky(scene, 1);
    scene_look(scene, rotated(v3(eye_x, 1.6f, 1.5f), angle_rad), rotated(v3(0, 1.2f, -0.5f), angle_rad), 65);
}

void two_rooms_build(struct scene *scene, float wall_m, float angle_deg)
{
    const float h = wall_m / 2;
    two_rooms_begin(scene, glm_rad(angle_deg));
    mesh_box(&scene->mesh, v3(-h, 0, -2), v3(h, 3, 2));
    two_rooms_end(scene, glm_rad(angle_deg), -3.6f);
}

void two_rooms_lit_build(struct scene *scene, float wall_m, float angle_deg)
{
    two_rooms_build(scene, wall_m, angle_deg);
    scene_look(scene, rotated(v3(3.6f, 1.6f, 1.5f), glm_rad(angle_deg)),
               rotated(v3(0, 1.2f, -0.5f), glm_rad(angle_deg)), 65);
}

/* A doorway of 1 x 2.1 m from the lit room leads into a closet that juts out into the dark one: light stands
 * behind its corners and edges. */
void two_rooms_door_build(struct scene *scene, float wall_m, float angle_deg)
{
    const float h = wall_m / 2, t = wall_m, depth = 1, top = 2.1f, near = -1, far = 0;
    struct mesh *mesh = &scene->mesh;
    two_rooms_begin(scene, glm_rad(angle_deg));
    mesh_box(mesh, v3(-h, 0, -2), v3(h, 3, near));
    mesh_box(mesh, v3(-h, 0, far), v3(h, 3, 2));
    mesh_box(mesh, v3(-h, top, -2), v3(h, 3, 2)); /* over the doorway */
    mesh_box(mesh, v3(-h - depth - t, 0, near - t), v3(h, top + t, near));
    mesh_box(mesh, v3(-h - depth - t, 0, far), v3(h, top + t, far + t));
    mesh_box(mesh, v3(-h - depth - t, 0, near - t), v3(-h - depth, top + t, far + t));
    mesh_box(mesh, v3(-h - depth - t, top, near - t), v3(h, top + t, far + t));
    two_rooms_end(scene, glm_rad(angle_deg), -3.6f);
}

void sealed_room_build(struct scene *scene, float wall_m, float unused)
{
    (void)unused;
    scene_box(scene, "ground", v3(-12, -2, -12), v3(12, -1, 12), &ground);
    scene_shell(scene, v3(-2, 0, -2), v3(2, 3, 2), wall_m, &plaster);
    scene_sun(scene, v3(-0.5f, -0.7f, -0.5f), 10);
    scene_sky(scene, 1);
    scene_look(scene, v3(-1.6f, 1.6f, 1.6f), v3(1, 1, -1.5f), 65);
}

/* A lit room, and a corridor that leaves it through a doorway and turns off: light falls fast along it. */
void corridor_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const float t = 0.3f;
    struct mesh *mesh = &scene->mesh;
    mesh_box(mesh, v3(-4 - t, -t, -2 - t), v3(12 + t, 0, 8 + t));
    mesh_box(mesh, v3(-4 - t, 3, -2 - t), v3(12 + t, 3 + t, 8 + t));
    mesh_box(mesh, v3(-4 - t, 0, -2 - t), v3(12 + t, 3, -2)); /* far side of the room and corridor */
    mesh_box(mesh, v3(-4 - t, 0, -2), v3(-4, 3, 2));
    mesh_box(mesh, v3(-4 - t, 0, 2), v3(1, 3, 2 + t));
    mesh_box(mesh, v3(1, 0, -0.2f), v3(1 + t, 3, 2 + t)); /* beside the doorway */
    mesh_box(mesh, v3(1, 2.2f, -2), v3(1 + t, 3, -0.2f)); /* over it */
    mesh_box(mesh, v3(1 + t, 0, -0.2f), v3(9.5f, 3, -0.2f + t));
    mesh_box(mesh, v3(9.5f, 0, -0.2f), v3(9.5f + t, 3, 8));
    mesh_box(mesh, v3(12, 0, -2), v3(12 + t, 3, 8));
    mesh_box(mesh, v3(9.5f, 0, 8), v3(12 + t, 3, 8 + t));
    scene_flush(scene, "walls", &plaster);
    const struct surface lamp = { .emission = v3(25, 22, 18) };
    mesh_quad(mesh, v3(-2.5f, 2.98f, -0.5f), v3(-1.5f, 2.98f, -0.5f), v3(-1.5f, 2.98f, 0.5f),
              v3(-2.5f, 2.98f, 0.5f));
    scene_flush(scene, "lamp", &lamp);
    scene_look(scene, v3(9.2f, 1.6f, -1.1f), v3(0, 1.2f, -1.1f), 60);
}

void corridor_turn_build(struct scene *scene, float unused_a, float unused_b)
{
    corridor_build(scene, unused_a, unused_b);
    scene_look(scene, v3(10.9f, 1.6f, 5.5f), v3(10.7f, 1.2f, -2), 60);
}

/* Six by six cells of 2 m between thin walls, roofed but for the middle: light must follow the ways. */
void maze_build(struct scene *scene, float wall_m, float unused)
{
    (void)unused;
    enum { CELLS = 6 };
    const float h = wall_m / 2, side = 2, half = CELLS * side / 2;
    struct mesh *mesh = &scene->mesh;
    for (uint32_t j = 0; j < CELLS; j++)
        for (uint32_t i = 0; i < CELLS; i++) {
            /* Binary-tree maze: every cell opens either towards +x or towards +z. */
            const float x = -half + (float)(i + 1) * side, z = -half + (float)(j + 1) * side;
            const bool open_x = j + 1 == CELLS || (i + 1 < CELLS && random_hash3(5, i, j) & 1);
            if (!open_x || i + 1 == CELLS)
                mesh_box(mesh, v3(x - h, 0, z - side), v3(x + h, 2.5f, z));
            if (open_x || j + 1 == CELLS)
                mesh_box(mesh, v3(x - side, 0, z - h), v3(x, 2.5f, z + h));
        }
    mesh_box(mesh, v3(-half - h, 0, -half), v3(-half + h, 2.5f, half));
    mesh_box(mesh, v3(-half, 0, -half - h), v3(half, 2.5f, -half + h));
    mesh_box(mesh, v3(-half - 0.3f, -0.3f, -half - 0.3f), v3(half + 0.3f, 0, half + 0.3f));
    /* The roof leaves one cell beside the middle open. */
    mesh_box(mesh, v3(-half, 2.5f, -half), v3(half, 2.8f, 0));
    mesh_box(mesh, v3(-half, 2.5f, side), v3(half, 2.8f, half));
    mesh_box(mesh, v3(-half, 2.5f, 0), v3(0, 2.8f, side));
    mesh_box(mesh, v3(side, 2.5f, 0), v3(half, 2.8f, side));
    scene_flush(scene, "maze", &plaster);
    scene_sky(scene, 2);
    scene_sun(scene, v3(0.2f, -0.9f, 0.3f), 10);
    scene_look(scene, v3(0.3f, 1.6f, 1.7f), v3(3, 1, -1), 75);
}

/* Four wings round a court, arcades on two sides; no sun, so that the sky alone shades it. */
void courtyard_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface stone = { .albedo = v3(0.62f, 0.55f, 0.45f) },
                         paving = { .albedo = v3(0.45f, 0.43f, 0.4f) };
    scene_box(scene, "paving", v3(-12, -0.5f, -12), v3(12, 0, 12), &paving);
    mesh_box(&scene->mesh, v3(-12, 0, -12), v3(12, 8, -8));
    mesh_box(&scene->mesh, v3(-12, 0, 8), v3(12, 8, 12));
    for (int side = -1; side <= 1; side += 2) {
        const float out = (float)side * 12, in = (float)side * 6, back = (float)side * 9;
        mesh_box(&scene->mesh, v3(fminf(out, back), 0, -8), v3(fmaxf(out, back), 8, 8));
        mesh_box(&scene->mesh, v3(fminf(in, back), 3.4f, -8), v3(fmaxf(in, back), 8, 8));
        for (int i = 0; i < 5; i++) {
            const float z = -8 + 4 * (float)i, post = in + (float)side * 0.3f;
            mesh_box(&scene->mesh, v3(post - 0.3f, 0, fmaxf(z - 0.3f, -8)),
                     v3(post + 0.3f, 3.4f, fminf(z + 0.3f, 8)));
        }
    }
    scene_flush(scene, "stone", &stone);
    scene->view.has_sky = true;
    scene->view.sky_zenith = v3(0.5f, 0.8f, 1.4f);
    scene->view.sky_horizon = v3(1.2f, 1.25f, 1.3f);
    scene->view.sky_ground = v3(0.2f, 0.2f, 0.2f);
    scene_look(scene, v3(4.5f, 1.7f, 7), v3(-5, 2.2f, -5), 65);
}

/* Pillars from 0.1 to 0.8 m thick on a floor under the sky: darkness must gather at their feet. */
void pillars_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    scene_box(scene, "floor", v3(-12, -0.5f, -12), v3(12, 0, 12), &plaster);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 8; i++) {
            const float x = -5.6f + 1.6f * (float)i, z = -4.8f + 2.4f * (float)j,
                        r = 0.05f + 0.05f * (float)i;
            if (j & 1)
                mesh_cylinder(&scene->mesh, v3(x, 0, z), r, r, 2.5f, 24);
            else
                mesh_box(&scene->mesh, v3(x - r, 0, z - r), v3(x + r, 2.5f, z + r));
        }
    scene_flush(scene, "pillars", &plaster);
    scene_sky(scene, 1);
    scene_look(scene, v3(-1, 2.2f, 7.5f), v3(0.5f, 0.6f, -2), 55);
}

/* A hall with a grid of coloured lamps near the ceiling. */
void many_lights_build(struct scene *scene, float count, float unused)
{
    (void)unused;
    const int total = (int)count, columns = (int)ceilf(sqrtf(count));
    scene_shell(scene, v3(-8, 0, -8), v3(8, 4, 8), 0.4f, &plaster);
    for (int i = 0; i < 9; i++) {
        const float x = -5 + 5 * (float)(i % 3), z = -5 + 5 * (float)(i / 3);
        scene_box(scene, "block", v3(x - 0.5f, 0, z - 0.5f),
                  v3(x + 0.5f, 1 + 0.25f * (float)(i % 4), z + 0.5f), &plaster);
    }
    for (int i = 0; i < total; i++) {
        const float step = 15.0f / (float)columns, x = -7.5f + step * ((float)(i % columns) + 0.5f);
        const float z = -7.5f + step * ((float)(i / columns) + 0.5f),
                    hue = 6.2832f * random_unit(random_hash((uint32_t)i));
        const vec3s color =
            v3(0.6f + 0.4f * cosf(hue), 0.6f + 0.4f * cosf(hue - 2.094f), 0.6f + 0.4f * cosf(hue + 2.094f));
        scene_point_light(scene, v3(x, 3, z), color, 64 / count);
    }
    scene_look(scene, v3(-7.2f, 2, 7.2f), v3(1, 1, -1), 65);
}
