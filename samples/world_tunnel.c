/* SPDX-License-Identifier: MIT
 * The tunnel: a vaulted tube of stone that bends once, so that its middle sees no sky, with a wet floor. */
#include "world.h"

#include <math.h>

enum { STEPS = 28, ARCH = 14 };

static const float half_width_m = 2.1f, spring_m = 1.9f, masonry_m = 0.5f;

vec3s world_tunnel_point(float t)
{
    const float bend = sinf(GLM_PIf * t);
    return v3((float)TUNNEL_START_M + t * (float)(TUNNEL_END_M - TUNNEL_START_M), 0.04f, 7 * bend * bend);
}

/* Outline of the vault from the foot at -z to the one at +z, `out` metres outside of its inner face, below
 * its floor too; k in [0, ARCH + 2]. */
static vec3s outline(vec3s center, int k, float out)
{
    const float half = half_width_m + out;
    float side = k == 0 ? -half : half, up = -out;
    if (k > 0 && k < ARCH + 2) {
        const float angle = GLM_PIf * (float)(k - 1) / ARCH;
        side = -half * cosf(angle);
        up = spring_m + half * sinf(angle);
    }
    return v3(center.x, center.y + up, center.z + side);
}

/* The masonry's outside, never seen: without it the vault would be a sheet with daylight behind it. */
static void outside_add(struct object *object, vec3s a, vec3s b)
{
    struct mesh *stone = object_part(object, MATERIAL_STONE, v3(0.3f, 0.28f, 0.26f));
    for (int k = 0; k <= ARCH + 1; k++)
        mesh_quad(stone, outline(a, k, masonry_m), outline(a, k + 1, masonry_m), outline(b, k + 1, masonry_m),
                  outline(b, k, masonry_m));
    mesh_quad(stone, outline(b, 0, masonry_m), outline(b, ARCH + 2, masonry_m),
              outline(a, ARCH + 2, masonry_m), outline(a, 0, masonry_m));
}

static void segment_add(struct object *object, int step)
{
    const vec3s a = world_tunnel_point((float)step / STEPS),
                b = world_tunnel_point((float)(step + 1) / STEPS);
    struct mesh *stone = object_part(object, MATERIAL_STONE, v3(0.55f, 0.52f, 0.48f));
    for (int k = 0; k <= ARCH + 1; k++)
        mesh_quad(stone, outline(b, k, 0), outline(b, k + 1, 0), outline(a, k + 1, 0), outline(a, k, 0));
    struct mesh *floor = object_part(object, MATERIAL_COBBLES, v3(0.45f, 0.43f, 0.42f));
    mesh_quad(floor, outline(a, 0, 0), outline(a, ARCH + 2, 0), outline(b, ARCH + 2, 0), outline(b, 0, 0));
    outside_add(object, a, b);
    /* A kerb along each side. */
    for (int side = -1; side <= 1; side += 2) {
        const float in = (float)side * (half_width_m - 0.35f), out = (float)side * half_width_m;
        const vec3s kerb[4] = { v3(a.x, 0.18f, a.z + in), v3(b.x, 0.18f, b.z + in), v3(b.x, 0.18f, b.z + out),
                                v3(a.x, 0.18f, a.z + out) };
        const vec3s foot_a = v3(a.x, 0, a.z + in), foot_b = v3(b.x, 0, b.z + in);
        struct mesh *mesh = object_part(object, MATERIAL_STONE, v3(0.6f, 0.58f, 0.55f));
        if (side > 0) {
            mesh_quad(mesh, kerb[3], kerb[2], kerb[1], kerb[0]);
            mesh_quad(mesh, foot_b, foot_a, kerb[0], kerb[1]);
        } else {
            mesh_quad(mesh, kerb[0], kerb[1], kerb[2], kerb[3]);
            mesh_quad(mesh, foot_a, foot_b, kerb[1], kerb[0]);
        }
    }
}

/* The portal's wall with its arched opening, in columns; faces away from the hill towards `outward` (x). */
static void portal_add(struct object *object, float x, float outward)
{
    const float width = 8, height = 5.7f, thickness = 1.6f, foot = -0.6f;
    const float near = x, far = x - thickness * outward, behind = x - 0.05f * outward;
    struct mesh *stone = object_part(object, MATERIAL_STONE, v3(0.68f, 0.64f, 0.58f));
    for (int i = 0; i < ARCH; i++) {
        const vec3s center = v3(near, 0.04f, 0);
        const vec3s p = outline(center, i + 1, 0), q = outline(center, i + 2, 0);
        const vec3s top_p = v3(near, height, p.z), top_q = v3(near, height, q.z);
        if (outward < 0)
            mesh_quad(stone, p, q, top_q, top_p);
        else
            mesh_quad(stone, q, p, top_p, top_q);
    }
    for (int side = -1; side <= 1; side += 2) {
        const float a = (float)side * half_width_m, b = (float)side * width;
        mesh_box(stone, v3(fminf(near, far), foot, fminf(a, b)), v3(fmaxf(near, far), height, fmaxf(a, b)));
        const float buttress = (float)side * 5.5f, front = near + 0.7f * outward;
        mesh_box(stone, v3(fminf(near, front), foot, buttress - 0.5f),
                 v3(fmaxf(near, front), 4.6f, buttress + 0.5f));
    }
    /* Over the vault, so that nothing looks in between the wall and the hillside. */
    mesh_box(stone, v3(fminf(behind, far), spring_m + half_width_m + 0.1f, -half_width_m),
             v3(fmaxf(behind, far), height, half_width_m));
    const float lip = near + 0.25f * outward;
    object_box(object, MATERIAL_STONE, v3(0.75f, 0.72f, 0.66f), v3(fminf(lip, far), height, -width - 0.2f),
               v3(fmaxf(lip, far), height + 0.35f, width + 0.2f));
}

static void lamps_add(struct world *world, struct object *object)
{
    for (int i = 0; i < 3; i++) {
        const vec3s at = world_tunnel_point(0.26f + 0.24f * (float)i);
        const float z = at.z + half_width_m - 0.3f;
        object_box(object, MATERIAL_IRON, v3(0.25f, 0.24f, 0.23f), v3(at.x - 0.03f, 2.36f, z - 0.05f),
                   v3(at.x + 0.03f, 2.42f, z + 0.5f));
        world_lamp_add(world, object, v3(at.x, 2, z), v3(1, 0.62f, 0.28f), 5, 0.1f);
    }
}

void world_tunnel_add(struct world *world)
{
    struct object object;
    object_begin(&object, glms_mat4_identity());
    for (int i = 0; i < STEPS; i++)
        segment_add(&object, i);
    portal_add(&object, TUNNEL_START_M, -1);
    portal_add(&object, TUNNEL_END_M, 1);
    lamps_add(world, &object);
    object_place(world, &object, "tunnel");
}
