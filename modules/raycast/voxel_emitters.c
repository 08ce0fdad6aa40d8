/* SPDX-License-Identifier: MIT
 *
 * Emissive faces of voxels, chosen in proportion to their power: first all faces of a block along an axis,
 * which emit the same, then one of them.
 */
#include <stdlib.h>

#include "voxels_internal.h"

enum { BLOCK_CELLS = 8 };

/* Sub-voxels with coordinate 0 along an axis; times 2^(3 stride) those with coordinate 3. */
static const uint64_t first_layer[3] = { 0x1111111111111111u, 0x000f000f000f000fu, 0x000000000000ffffu };

static struct voxel_place block_cell(const struct voxel_place *first, int index)
{
    struct voxel_place at = *first;
    for (int k = 0; k < 3; k++)
        at.cell[k] += index >> k & 1;
    return at;
}

/* The set sub-voxels of a cell with nothing set before their face along an axis. */
static uint64_t exposed(const struct voxels *v, const struct voxel_place *at, int axis)
{
    const int k = axis >> 1, stride = 1 << (2 * k);
    const uint64_t first = first_layer[k], last = first << (3 * stride);
    const uint64_t bits = voxel_grid_bits(&v->grid, at);
    struct voxel_place beside = *at;
    beside.cell[k] += axis & 1 ? -1 : 1;
    const uint64_t next = voxel_grid_bits(&v->grid, &beside);
    const uint64_t before = axis & 1 ? ((bits << stride) & ~first) | (next >> (3 * stride) & first)
                                     : (bits >> stride & ~last) | (next << (3 * stride) & last);
    return bits & ~before;
}

static uint32_t count_bits(uint64_t bits)
{
    uint32_t count = 0;
    for (; bits != 0; bits &= bits - 1)
        count++;
    return count;
}

static double face_area(const struct voxels *v, uint32_t cascade, int axis)
{
    const int k = axis >> 1;
    return voxel_grid_sub_m(&v->grid, cascade, (k + 1) % 3) *
           voxel_grid_sub_m(&v->grid, cascade, (k + 2) % 3);
}

/* Room for one more; doubles when full. */
static bool reserve(struct voxels *v)
{
    if (v->emitter_count != 0 && (v->emitter_count & (v->emitter_count - 1)) != 0)
        return true;
    const size_t capacity = v->emitter_count != 0 ? (size_t)2 * v->emitter_count : 1;
    struct voxel_emitter *emitters = realloc(v->emitters, capacity * sizeof(*emitters));
    if (emitters != NULL)
        v->emitters = emitters;
    double *cdf = realloc(v->emitter_cdf, capacity * sizeof(*cdf));
    if (cdf != NULL)
        v->emitter_cdf = cdf;
    return emitters != NULL && cdf != NULL;
}

static bool add(struct voxels *v, const struct voxel_place *first, int axis, float luminance)
{
    uint32_t faces = 0;
    for (int i = 0; i < BLOCK_CELLS; i++) {
        const struct voxel_place at = block_cell(first, i);
        faces += count_bits(exposed(v, &at, axis));
    }
    if (faces == 0)
        return true;
    if (!reserve(v))
        return false;
    v->emitters[v->emitter_count] = (struct voxel_emitter){ *first, axis, faces };
    v->emitter_cdf[v->emitter_count++] = (double)luminance * faces * face_area(v, first->cascade, axis);
    return true;
}

static bool add_block(struct voxels *v, const struct voxel_place *first)
{
    const struct raycast_block *b = voxel_grid_block(&v->grid, first);
    for (int axis = 0; axis < 6; axis++) {
        const float luminance = vec3_luminance(voxel_emission(b, axis));
        if (luminance > 0.0f && !add(v, first, axis, luminance))
            return false;
    }
    return true;
}

static bool add_cascade(struct voxels *v, uint32_t cascade)
{
    const int32_t n = v->grid.cascades[cascade].resolution;
    for (int32_t z = 0; z < n; z += 2)
        for (int32_t y = 0; y < n; y += 2)
            for (int32_t x = 0; x < n; x += 2)
                if (!add_block(v, &(struct voxel_place){ cascade, { x, y, z } }))
                    return false;
    return true;
}

bool voxel_emitters_build(struct voxels *v)
{
    for (uint32_t i = 0; i < v->grid.count; i++)
        if (!add_cascade(v, i))
            return false;
    for (uint32_t i = 0; i < v->emitter_count; i++)
        v->emitter_total += v->emitter_cdf[i];
    double sum = 0.0;
    for (uint32_t i = 0; i < v->emitter_count; i++) {
        sum += v->emitter_cdf[i];
        v->emitter_cdf[i] = sum / v->emitter_total;
    }
    v->base.emitter_power = (float)(v->emitter_total * (double)VEC3_PI);
    return true;
}

/* First entry of the cdf above x. */
static const struct voxel_emitter *find(const struct voxels *v, double x)
{
    uint32_t low = 0, high = v->emitter_count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (v->emitter_cdf[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return &v->emitters[low];
}

/* Sub-voxel of face `index` of an emitter. */
static int face_find(const struct voxels *v, const struct voxel_emitter *e, uint32_t index,
                     struct voxel_place *at)
{
    for (int i = 0; i < BLOCK_CELLS; i++) {
        *at = block_cell(&e->first, i);
        uint64_t bits = exposed(v, at, e->axis);
        const uint32_t count = count_bits(bits);
        if (index >= count) {
            index -= count;
            continue;
        }
        for (; index > 0; index--)
            bits &= bits - 1;
        return (int)count_bits((bits & (~bits + 1)) - 1);
    }
    return 0;
}

void voxel_emitters_sample(const struct geometry *g, struct random *r, struct emitter_sample *out)
{
    const struct voxels *v = (const struct voxels *)g;
    const double x = ((double)random_bits(r) + 0.5) * 0x1p-32;
    const struct voxel_emitter *e = find(v, x);
    struct voxel_place at;
    const int bit = face_find(v, e, (uint32_t)((double)random_float(r) * e->faces), &at);
    const int sub[3] = { bit & 3, bit >> 2 & 3, bit >> 4 };
    float p[3];
    for (int k = 0; k < 3; k++) {
        const double share = k != e->axis >> 1 ? (double)random_float(r) : e->axis & 1 ? 0.0 : 1.0;
        p[k] = (float)(voxel_grid_sub_low(&v->grid, &at, sub[k], k) +
                       share * voxel_grid_sub_m(&v->grid, at.cascade, k));
    }
    out->position = vec3_load(p);
    out->normal = voxel_axis(e->axis);
    out->front = voxel_emission(voxel_grid_block(&v->grid, &at), e->axis);
    out->back = vec3_splat(0.0f);
    out->pdf = (float)((double)vec3_luminance(out->front) / v->emitter_total);
}
