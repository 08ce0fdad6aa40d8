/* SPDX-License-Identifier: MIT
 *
 * Where rays leave a surface of voxels from: see voxels.h.
 */
#include "voxels_internal.h"

/* Distance from a face, and from the sides of its sub-voxel, in sub-voxels: far above the rounding of a
 * float, far below what a picture shows. */
#define FACE_OFFSET 0x1p-10

/* The voxeliser sets sub-voxels whose centre crosses a plane with a margin; this many sub-voxels cover it. */
#define REACH_MARGIN 0x1p-6

/* Moving away from one triangle may move towards another. */
enum { CLEARING_ROUNDS = 3 };

/* How far above a plane the sub-voxels can stand that stand for it, metres. A 6-separating set holds those
 * that the plane crosses on an axis-parallel line through the centre: the centre is at most half a sub-voxel
 * along the largest component of the normal away, and its highest corner half the sum of the components above
 * that. */
static float reach_m(const struct voxels *v, uint32_t cascade, struct vec3 normal)
{
    const float n[3] = { normal.x, normal.y, normal.z };
    double largest = 0.0, sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double part = fabs((double)n[k]) * voxel_grid_sub_m(&v->grid, cascade, k);
        largest = fmax(largest, part);
        sum += part;
    }
    return (float)(0.5 * (largest + sum) * (1.0 + REACH_MARGIN));
}

/* The point on a face, moved into the empty sub-voxel before it whatever rounding did to it. */
static struct vec3 before_face(const struct voxels *v, const struct voxel_hit *hit, struct vec3 position)
{
    const float p[3] = { position.x, position.y, position.z };
    float out[3];
    for (int k = 0; k < 3; k++) {
        const double size = voxel_grid_sub_m(&v->grid, hit->place.cascade, k);
        const double low = voxel_grid_sub_low(&v->grid, &hit->place, hit->sub[k], k);
        const double edge = FACE_OFFSET * size;
        out[k] = (float)fmin(fmax((double)p[k], low + edge), low + size - edge);
        if (k == hit->axis >> 1)
            out[k] = (float)(hit->axis & 1 ? low - edge : low + size + edge);
    }
    return vec3_load(out);
}

struct vec3 voxel_start(const struct voxels *v, const struct voxel_hit *hit, struct vec3 normal,
                        struct vec3 position)
{
    const struct vec3 start = before_face(v, hit, position);
    const float reach = reach_m(v, hit->place.cascade, normal);
    struct voxel_hit next;
    if (!voxel_grid_trace(&v->grid, start, normal, (double)reach, &next))
        return vec3_mad(start, normal, reach);
    return vec3_mad(start, normal, 0.5f * (float)next.t_m);
}

/* ---- Starts on triangles ---------------------------------------------------------------------------- */

/* Moves a point, at most half-way to the next triangle. */
static struct vec3 moved(const struct geometry *seen, struct vec3 from, struct vec3 direction, float way)
{
    const struct ray ray = { .origin = from, .direction = direction, .length_m = way };
    struct surface s;
    if (geometry_intersect(seen, &ray, &s))
        way = 0.5f * vec3_length(vec3_sub(s.position, from));
    return vec3_mad(from, direction, way);
}

/* Moves a point away from the triangle that lies along an axis, if that is nearer than its reach. */
static struct vec3 cleared(const struct voxels *v, uint32_t cascade, struct vec3 from, int axis)
{
    const struct vec3 along = voxel_axis(axis);
    /* A plane at distance h crosses the axis of its normal's largest component within sqrt(3) h. */
    const float farthest = 1.7320508f * reach_m(v, cascade, vec3_splat(0.57735027f)) * 1.01f;
    const struct ray ray = { .origin = from, .direction = along, .length_m = farthest };
    struct surface s;
    if (!geometry_intersect(v->seen, &ray, &s))
        return from;
    const struct vec3 away = s.geometric_normal;
    const float height = vec3_dot(vec3_sub(from, s.position), away), reach = reach_m(v, cascade, away);
    return height < reach ? moved(v->seen, from, away, reach - height) : from;
}

void voxel_adopt(const struct geometry *g, struct surface *s)
{
    const struct voxels *v = (const struct voxels *)g;
    struct voxel_place place;
    if (!voxel_grid_find_point(&v->grid, s->position, &place))
        return;
    s->start = moved(v->seen, s->start, s->geometric_normal, reach_m(v, place.cascade, s->geometric_normal));
    for (int i = 0; i < 6 * CLEARING_ROUNDS; i++)
        s->start = cleared(v, place.cascade, s->start, i % 6);
}
