/* SPDX-License-Identifier: MIT
 * A wall of real thickness with rectangular openings: both sides and the reveals are modelled. */
#include "world.h"

#include <stdlib.h>

enum { CUTS_MAX = 2 + 2 * 8 };

static int float_compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Sorted coordinates at which the wall changes between solid and open. */
static uint32_t cuts_make(const struct wall *wall, bool upward, float cuts[CUTS_MAX])
{
    uint32_t count = 0, kept = 1;
    cuts[count++] = upward ? wall->bottom : 0;
    cuts[count++] = upward ? wall->top : wall->length;
    for (uint32_t i = 0; i < wall->opening_count && count + 2 <= CUTS_MAX; i++) {
        cuts[count++] = upward ? wall->openings[i].y0 : wall->openings[i].x0;
        cuts[count++] = upward ? wall->openings[i].y1 : wall->openings[i].x1;
    }
    qsort(cuts, count, sizeof(float), float_compare);
    for (uint32_t i = 1; i < count; i++)
        if (cuts[i] - cuts[kept - 1] > 1e-4f)
            cuts[kept++] = cuts[i];
    return kept;
}

static bool solid_at(const struct wall *wall, float x, float y)
{
    if (x < 0 || x > wall->length || y < wall->bottom || y > wall->top)
        return false;
    for (uint32_t i = 0; i < wall->opening_count; i++) {
        const struct opening *hole = &wall->openings[i];
        if (x > hole->x0 && x < hole->x1 && y > hole->y0 && y < hole->y1)
            return false;
    }
    return true;
}

/* The narrow sides of one block where its neighbours are open. */
static void reveals_add(const struct wall *wall, struct mesh *mesh, vec3s low, vec3s high)
{
    const float x0 = low.x, x1 = high.x, y0 = low.y, y1 = high.y, z0 = -wall->thickness, e = 1e-3f;
    const float x = 0.5f * (x0 + x1), y = 0.5f * (y0 + y1);
    if (!solid_at(wall, x1 + e, y))
        mesh_quad(mesh, v3(x1, y0, 0), v3(x1, y0, z0), v3(x1, y1, z0), v3(x1, y1, 0));
    if (!solid_at(wall, x0 - e, y))
        mesh_quad(mesh, v3(x0, y0, z0), v3(x0, y0, 0), v3(x0, y1, 0), v3(x0, y1, z0));
    if (!solid_at(wall, x, y1 + e))
        mesh_quad(mesh, v3(x0, y1, 0), v3(x1, y1, 0), v3(x1, y1, z0), v3(x0, y1, z0));
    if (!solid_at(wall, x, y0 - e))
        mesh_quad(mesh, v3(x0, y0, z0), v3(x1, y0, z0), v3(x1, y0, 0), v3(x0, y0, 0));
}

static void block_add(struct object *object, const struct wall *wall, mat4s frame, vec3s low, vec3s high)
{
    const float x0 = low.x, x1 = high.x, y0 = low.y, y1 = high.y, z0 = -wall->thickness;
    struct mesh *out = object_part(object, wall->material, wall->outside);
    out->transform = frame;
    mesh_quad(out, v3(x0, y0, 0), v3(x1, y0, 0), v3(x1, y1, 0), v3(x0, y1, 0));
    reveals_add(wall, out, low, high);
    struct mesh *in = object_part(object, MATERIAL_PLASTER, wall->inside);
    in->transform = frame;
    mesh_quad(in, v3(x1, y0, z0), v3(x0, y0, z0), v3(x0, y1, z0), v3(x1, y1, z0));
}

void wall_add(struct object *object, const struct wall *wall)
{
    float xs[CUTS_MAX], ys[CUTS_MAX];
    const uint32_t columns = cuts_make(wall, false, xs), rows = cuts_make(wall, true, ys);
    const mat4s frame = glms_mat4_mul(object->transform, wall->frame);
    for (uint32_t j = 0; j + 1 < rows; j++)
        for (uint32_t i = 0; i + 1 < columns; i++)
            if (solid_at(wall, 0.5f * (xs[i] + xs[i + 1]), 0.5f * (ys[j] + ys[j + 1])))
                block_add(object, wall, frame, v3(xs[i], ys[j], 0), v3(xs[i + 1], ys[j + 1], 0));
}
