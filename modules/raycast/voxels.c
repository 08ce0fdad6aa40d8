/* SPDX-License-Identifier: MIT */
#include "voxels_internal.h"

#include <stdio.h>
#include <stdlib.h>

/* Mean normal of the block's triangles whose largest component is `major`; false: it has none. */
static bool class_normal(const struct raycast_block *b, int major, struct vec3 *out)
{
    if (b->slopes[major][0] == RAYCAST_NO_SLOPE)
        return false;
    float n[3];
    n[major] = 1.0f;
    n[(major + 1) % 3] = (float)b->slopes[major][0] / 15.0f;
    n[(major + 2) % 3] = (float)b->slopes[major][1] / 15.0f;
    *out = vec3_normalize(vec3_load(n));
    return true;
}

/* The renderer's rule: triangles that face the axis most, else those that lean towards it by more than 0.2,
 * else the axis. */
static struct vec3 block_normal(const struct raycast_block *b, int axis)
{
    const struct vec3 towards = voxel_axis(axis);
    struct vec3 n, best = towards;
    if (class_normal(b, axis >> 1, &n))
        return axis & 1 ? vec3_negate(n) : n;
    float best_height = 0.2f;
    for (int major = 0; major < 3; major++) {
        if (!class_normal(b, major, &n))
            continue;
        const float height = vec3_dot(n, towards);
        if (fabsf(height) > best_height) {
            best_height = fabsf(height);
            best = height > 0.0f ? n : vec3_negate(n);
        }
    }
    return best;
}

static void emission_set(const struct voxels *v, const struct raycast_block *b, int axis,
                         struct vec3 direction, struct surface *out)
{
    out->emission = voxel_emission(b, axis);
    out->emits = vec3_max(out->emission) > 0.0f;
    if (!out->emits || !(v->emitter_total > 0.0))
        return;
    const double facing = fmax((double)fabsf(vec3_dot(voxel_axis(axis), direction)), 1e-12);
    out->emission_pdf = (float)((double)vec3_luminance(out->emission) / v->emitter_total / facing);
}

/* Where two surfaces are nearer than the voxels that stand for them, a ray may start in set sub-voxels, and
 * on its way out of them pass a wall. Along that way triangles stop it. */
static bool meets_triangle(const struct voxels *v, const struct ray *ray, const struct voxel_hit *hit,
                           struct surface *out)
{
    struct ray way = *ray;
    way.length_m = fminf((float)hit->left_m, ray->length_m);
    return hit->left_m > 0.0 && geometry_intersect(v->seen, &way, out);
}

static bool voxels_intersect(const struct geometry *g, const struct ray *ray, struct surface *out)
{
    const struct voxels *v = (const struct voxels *)g;
    struct voxel_hit hit;
    const bool is_hit = voxel_grid_trace(&v->grid, ray->origin, ray->direction, (double)ray->length_m, &hit);
    if (meets_triangle(v, ray, &hit, out)) {
        /* Emission is the voxels' own: it would count twice. */
        out->emits = false;
        voxel_adopt(g, out);
        return true;
    }
    if (!is_hit)
        return false;
    const struct raycast_block *b = voxel_grid_block(&v->grid, &hit.place);
    const uint16_t *albedo = b->albedo[hit.axis];
    *out = (struct surface){ 0 };
    out->position = vec3_mad(ray->origin, ray->direction, (float)hit.t_m);
    out->normal = out->geometric_normal = block_normal(b, hit.axis);
    out->diffuse = vec3_scale(vec3_make(albedo[0], albedo[1], albedo[2]), 1.0f / 1023.0f);
    emission_set(v, b, hit.axis, ray->direction, out);
    out->start = voxel_start(v, &hit, out->normal, out->position);
    return true;
}

static bool voxels_occluded(const struct geometry *g, const struct ray *ray)
{
    const struct voxels *v = (const struct voxels *)g;
    struct voxel_hit hit;
    struct surface s;
    return voxel_grid_trace(&v->grid, ray->origin, ray->direction, (double)ray->length_m, &hit) ||
           meets_triangle(v, ray, &hit, &s);
}

static void voxels_destroy(struct geometry *g)
{
    struct voxels *v = (struct voxels *)g;
    free(v->emitters);
    free(v->emitter_cdf);
    voxel_grid_finish(&v->grid);
    free(v);
}

static const struct geometry_methods voxels_methods = {
    .intersect = voxels_intersect,
    .occluded = voxels_occluded,
    .emitter_sample = voxel_emitters_sample,
    .adopt = voxel_adopt,
    .destroy = voxels_destroy,
};

struct geometry *voxels_create(const struct raycast_voxels *volumes, const double origin[3],
                               const struct geometry *seen, char *error, size_t error_size)
{
    struct voxels *v = calloc(1, sizeof(*v));
    if (v == NULL) {
        snprintf(error, error_size, "reference: out of memory");
        return NULL;
    }
    v->base.methods = &voxels_methods;
    v->base.radius_m = seen->radius_m;
    v->seen = seen;
    if (!voxel_grid_init(&v->grid, volumes, origin, error, error_size)) {
        voxels_destroy(&v->base);
        return NULL;
    }
    if (!voxel_emitters_build(v)) {
        snprintf(error, error_size, "reference: out of memory for the emissive voxels");
        voxels_destroy(&v->base);
        return NULL;
    }
    return &v->base;
}
