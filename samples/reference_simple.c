/* SPDX-License-Identifier: MIT
 * Reference scenes with a known answer, and small ones with a known difficulty. */
#include "reference_scenes.h"

#include <math.h>

/* Walls emit 1 - albedo, so that the radiance everywhere is exactly 1 whatever the albedo. */
void furnace_build(struct scene *scene, float albedo, float unused)
{
    (void)unused;
    const float e = 1 - albedo;
    const struct surface inside = { .albedo = v3(albedo, albedo, albedo), .emission = v3(e, e, e) };
    const struct surface outside = matt(albedo, albedo, albedo);
    mesh_room(&scene->mesh, v3(-2, -2, -2), v3(2, 2, 2));
    scene_flush(scene, "inside", &inside);
    scene_box(scene, "outside", v3(-2.6f, -2.6f, -2.6f), v3(2.6f, 2.6f, 2.6f), &outside);
    scene_look(scene, v3(-1.4f, 0.3f, 1.2f), v3(1.5f, -0.4f, -2), 60);
}

/* Radiance albedo * E * cos / pi everywhere. */
void sun_plane_build(struct scene *scene, float albedo, float unused)
{
    (void)unused;
    const struct surface white = matt(albedo, albedo, albedo);
    scene_box(scene, "plane", v3(-20, -1, -20), v3(20, 0, 20), &white);
    scene_sun(scene, v3(0.6f, -0.8f, 0), 12.5f);
    scene_look(scene, v3(0, 4, 5), v3(0, 0, 0), 50);
}

/* Radiance equals the albedo everywhere. */
void sky_plane_build(struct scene *scene, float albedo, float unused)
{
    (void)unused;
    const struct surface white = matt(albedo, albedo, albedo);
    scene_box(scene, "plane", v3(-20, -1, -20), v3(20, 0, 20), &white);
    scene_sky(scene, 1);
    scene_look(scene, v3(0, 4, 5), v3(0, 0, 0), 50);
}

/* A floor at the foot of a black wall sees the share (1 + d / sqrt(d^2 + h^2)) / 2 of the sky at distance d:
 * a half right at the wall. */
void right_angle_build(struct scene *scene, float albedo, float unused)
{
    (void)unused;
    const struct surface white = matt(albedo, albedo, albedo), black = matt(0, 0, 0);
    scene_box(scene, "floor", v3(-60, -1, 0), v3(60, 0, 60), &white);
    scene_box(scene, "wall", v3(-60, -1, -1), v3(60, 8, 0), &black);
    scene_sky(scene, 1);
    scene_look(scene, v3(3, 2.5f, 5), v3(0, 0, 0.5f), 50);
}

/* Radiance albedo * I * cos / (pi d^2) under a lamp at 2 m over black ground's white plate. */
void point_light_build(struct scene *scene, float albedo, float unused)
{
    (void)unused;
    const struct surface white = matt(albedo, albedo, albedo);
    scene_box(scene, "plane", v3(-20, -1, -20), v3(20, 0, 20), &white);
    scene_point_light(scene, v3(0, 2, 0), v3(1, 1, 1), 10);
    scene_look(scene, v3(0, 4, 5), v3(0, 0, 0), 50);
}

/* ---- Cornell box ------------------------------------------------------------------------------------- */

/* The room of Cornell University's Program of Computer Graphics, with the dimensions published for it, in
 * millimetres, x to the left. Its paints and its lamp were published as spectra; the colours here are plain
 * linear RGB values that look like them, not computed from those spectra. */
static vec3s cornell_point(float x, float y, float z)
{
    return v3(0.001f * x, 0.001f * y, 0.001f * z);
}

static void cornell_face(struct scene *scene, const float corners[4][3])
{
    mesh_quad(&scene->mesh, cornell_point(corners[0][0], corners[0][1], corners[0][2]),
              cornell_point(corners[1][0], corners[1][1], corners[1][2]),
              cornell_point(corners[2][0], corners[2][1], corners[2][2]),
              cornell_point(corners[3][0], corners[3][1], corners[3][2]));
}

/* A block over four ground corners, given anticlockwise seen from above. */
static void cornell_block(struct scene *scene, const float ground[4][2], float height)
{
    float top[4][3];
    for (int i = 0; i < 4; i++) {
        const float *a = ground[i], *b = ground[(i + 1) % 4];
        const float side[4][3] = {
            { a[0], 0, a[1] }, { b[0], 0, b[1] }, { b[0], height, b[1] }, { a[0], height, a[1] }
        };
        cornell_face(scene, side);
        top[i][0] = a[0];
        top[i][1] = height;
        top[i][2] = a[1];
    }
    cornell_face(scene, (const float(*)[3])top);
}

void cornell_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    static const float floor[4][3] = {
        { 552.8f, 0, 0 }, { 0, 0, 0 }, { 0, 0, 559.2f }, { 549.6f, 0, 559.2f }
    };
    static const float ceiling[4][3] = {
        { 556, 548.8f, 0 }, { 556, 548.8f, 559.2f }, { 0, 548.8f, 559.2f }, { 0, 548.8f, 0 }
    };
    static const float back[4][3] = {
        { 549.6f, 0, 559.2f }, { 0, 0, 559.2f }, { 0, 548.8f, 559.2f }, { 556, 548.8f, 559.2f }
    };
    static const float right[4][3] = {
        { 0, 0, 559.2f }, { 0, 0, 0 }, { 0, 548.8f, 0 }, { 0, 548.8f, 559.2f }
    };
    static const float left[4][3] = {
        { 552.8f, 0, 0 }, { 549.6f, 0, 559.2f }, { 556, 548.8f, 559.2f }, { 556, 548.8f, 0 }
    };
    /* A tenth of a millimetre below the ceiling, which has no hole here. */
    static const float lamp[4][3] = {
        { 343, 548.7f, 227 }, { 343, 548.7f, 332 }, { 213, 548.7f, 332 }, { 213, 548.7f, 227 }
    };
    static const float low[4][2] = { { 130, 65 }, { 82, 225 }, { 240, 272 }, { 290, 114 } };
    static const float tall[4][2] = { { 423, 247 }, { 265, 296 }, { 314, 456 }, { 472, 406 } };
    const struct surface white = matt(0.73f, 0.72f, 0.68f), red = matt(0.61f, 0.056f, 0.062f),
                         green = matt(0.12f, 0.44f, 0.11f);
    const struct surface light = { .albedo = v3(0.78f, 0.78f, 0.78f), .emission = v3(18.4f, 12.3f, 5.9f) };
    /* Ten times its size: walls then span many cells at the default cell size. */
    scene->mesh.transform = glms_scale_uni(glms_mat4_identity(), 10);
    cornell_face(scene, floor);
    cornell_face(scene, ceiling);
    cornell_face(scene, back);
    cornell_block(scene, low, 165);
    cornell_block(scene, tall, 330);
    scene_flush(scene, "white", &white);
    cornell_face(scene, left);
    scene_flush(scene, "red", &red);
    cornell_face(scene, right);
    scene_flush(scene, "green", &green);
    cornell_face(scene, lamp);
    scene_flush(scene, "lamp", &light);
    scene_look(scene, v3(2.78f, 2.73f, -8), v3(2.78f, 2.73f, 0), 39.3f);
}

/* ---- Difficult ones ---------------------------------------------------------------------------------- */

/* One lamp of 20 W/sr straight down whatever its size: radiance times area is constant. */
void emitter_build(struct scene *scene, float side_m, float unused)
{
    (void)unused;
    const float radiance = 20 / (side_m * side_m), h = side_m / 2, y = 2.98f;
    const struct surface white = matt(0.7f, 0.7f, 0.7f);
    const struct surface lamp = { .albedo = v3(0, 0, 0), .emission = v3(radiance, radiance, radiance) };
    scene_shell(scene, v3(-3, 0, -3), v3(3, 3, 3), 0.4f, &white);
    mesh_quad(&scene->mesh, v3(-h, y, -h), v3(h, y, -h), v3(h, y, h), v3(-h, y, h));
    scene_flush(scene, "lamp", &lamp);
    scene_box(scene, "block", v3(0.6f, 0, -1.2f), v3(1.6f, 1.1f, -0.2f), &white);
    scene_look(scene, v3(-2.4f, 1.6f, 2.6f), v3(0.6f, 0.7f, -1), 60);
}

/* A white box whose sides are pure colours, lit from the open front: the middle takes on both. */
void color_bleed_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface white = matt(0.8f, 0.8f, 0.8f), red = matt(0.8f, 0.02f, 0.02f),
                         blue = matt(0.02f, 0.05f, 0.8f);
    scene_box(scene, "floor", v3(-2.4f, -0.4f, -2.4f), v3(2.4f, 0, 6), &white);
    scene_box(scene, "ceiling", v3(-2.4f, 4, -2.4f), v3(2.4f, 4.4f, 2), &white);
    scene_box(scene, "back", v3(-2.4f, 0, -2.4f), v3(2.4f, 4, -2), &white);
    scene_box(scene, "left", v3(-2.4f, 0, -2), v3(-2, 4, 2), &red);
    scene_box(scene, "right", v3(2, 0, -2), v3(2.4f, 4, 2), &blue);
    mesh_sphere(&scene->mesh, v3(0, 0.8f, 0), 0.8f, 48);
    scene_flush(scene, "ball", &white);
    scene_sun(scene, v3(-0.25f, -0.55f, -0.8f), 10);
    scene_sky(scene, 0.4f);
    scene_look(scene, v3(0, 2, 8.5f), v3(0, 1.8f, 0), 38);
}

/* Two rows over a patterned floor: metals and dielectrics, roughness from a mirror's to 1. */
void glossy_spheres_build(struct scene *scene, float unused_a, float unused_b)
{
    (void)unused_a;
    (void)unused_b;
    const struct surface light = matt(0.75f, 0.73f, 0.7f), dark = matt(0.12f, 0.13f, 0.16f);
    scene_tiles(scene, 12, 8, &light, &dark);
    const struct surface orange = matt(0.8f, 0.3f, 0.08f);
    scene_box(scene, "back", v3(-6, 0, -4.4f), v3(6, 4, -4), &orange);
    for (int i = 0; i < 10; i++) {
        const bool metal = i < 5;
        const struct surface ball = { .albedo = metal ? v3(0.92f, 0.82f, 0.6f) : v3(0.1f, 0.3f, 0.6f),
                                      .roughness = fmaxf(0.02f, 0.25f * (float)(i % 5)),
                                      .metallic = metal };
        mesh_sphere(&scene->mesh, v3(1.9f * (float)(i % 5 - 2), 0.75f, metal ? -1.4f : 1), 0.75f, 64);
        scene_flush(scene, metal ? "metal ball" : "glossy ball", &ball);
    }
    scene->view.lambert = false;
    scene_sky(scene, 0.8f);
    scene_sun(scene, v3(0.4f, -0.8f, -0.45f), 8);
    scene_look(scene, v3(0, 2.6f, 7.5f), v3(0, 0.7f, -0.5f), 45);
}
