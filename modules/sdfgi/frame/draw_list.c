/* SPDX-License-Identifier: MIT */
#include "draw_list.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* An element of `order`: what tells batches apart, above the number of the instance in the chunk. */
enum { NUMBER_BITS = 14, SIZE_BITS = 5, MATERIAL_BITS = 13, MESH_BITS = 20, ORDER_BITS = 52 };

_Static_assert(SDFGI_MAX_DRAWS == 1 << NUMBER_BITS && SDFGI_MAX_MATERIALS < 1 << MATERIAL_BITS &&
                   NUMBER_BITS + SIZE_BITS + MATERIAL_BITS + MESH_BITS == ORDER_BITS,
               "slots and numbers fit their bits");

/* How often a mesh is taken to cover the largest side of what its bounds and the box share. */
#define COVERINGS 4.0

static double columns_of(const struct draw_list *list, const struct cascade *cascade,
                         const struct box *bounds)
{
    double room[3];
    for (int i = 0; i < 3; i++)
        room[i] = (fmin(bounds->max[i], list->box.max[i]) - fmax(bounds->min[i], list->box.min[i])) *
                  (SDFGI_SUBVOXELS / cascade->cell_size[i]);
    return COVERINGS * fmax(room[0] * room[1], fmax(room[1] * room[2], room[2] * room[0]));
}

/* Power of two of the columns for each thread, where triangles have one each; 0: no more than are worth it.
 * The threads of a workgroup wait for the one with most. */
static uint64_t size_class(double columns, double worth)
{
    const int power = columns > worth ? 1 + ilogb(columns / worth) : 0;
    return power < (1 << SIZE_BITS) ? (uint64_t)power : (1 << SIZE_BITS) - 1;
}

static void append(struct draw_list *list, const struct draw_query *query, uint32_t slot,
                   const struct instance *instance)
{
    const struct scene *scene = query->scene;
    const struct mesh *mesh = sdfgi_pool_get(&scene->meshes, instance->desc.mesh.id);
    const struct material *material = sdfgi_pool_get(&scene->materials, instance->desc.material.id);
    assert(mesh && material);
    const uint64_t mesh_slot = sdfgi_pool_index(&scene->meshes, instance->desc.mesh.id),
                   textures = material->set
                                  ? sdfgi_pool_index(&scene->materials, instance->desc.material.id) + 1
                                  : 0;
    const double columns = columns_of(list, query->cascade, &instance->bounds);
    const uint64_t size = size_class(columns, query->columns_per_thread * mesh->desc.triangle_count);
    const bool checked = list->is_made && sdfgi_box_overlaps(&instance->bounds, &list->made);
    const uint32_t number = list->count++;
    list->found[number] = slot | (checked ? SDFGI_DRAW_CHECKED : 0);
    list->columns[number] = (float)columns;
    list->order[number] =
        ((mesh_slot << MATERIAL_BITS | textures) << SIZE_BITS | size) << NUMBER_BITS | number;
}

/* ---- Order */

/* One pass of a radix sort, from `order` to `spare` and back by exchange of contents. */
static void sort_digit(struct draw_list *list, uint32_t shift)
{
    uint32_t begins[256] = { 0 };
    for (uint32_t i = 0; i < list->count; i++)
        begins[list->order[i] >> shift & 255]++;
    for (uint32_t digit = 0, sum = 0; digit < 256; digit++) {
        const uint32_t count = begins[digit];
        begins[digit] = sum;
        sum += count;
    }
    for (uint32_t i = 0; i < list->count; i++)
        list->spare[begins[list->order[i] >> shift & 255]++] = list->order[i];
    memcpy(list->order, list->spare, list->count * sizeof *list->order);
}

/* By batches. Digits in which all agree are left out: most scenes have few meshes in a box. */
static void sort(struct draw_list *list)
{
    uint64_t differ = 0;
    for (uint32_t i = 1; i < list->count; i++)
        differ |= list->order[i] ^ list->order[0];
    for (uint32_t shift = NUMBER_BITS; shift < ORDER_BITS; shift += 8)
        if (differ >> shift & 255)
            sort_digit(list, shift);
}

static uint32_t number_of(uint64_t order)
{
    return (uint32_t)order & (SDFGI_MAX_DRAWS - 1);
}

/* ---- Chunks */

void sdfgi_draws_begin(struct draw_list *list, const struct draw_query *query)
{
    list->box = sdfgi_cascade_world_box(query->cascade, &query->work->box);
    list->is_made = !sdfgi_cell_box_empty(&query->work->made);
    if (list->is_made)
        list->made = sdfgi_cascade_world_box(query->cascade, &query->work->made);
    sdfgi_tree_search(&list->search, &query->scene->tree, &list->box);
}

/* Adds the slot at `index` of those that the tree named, if it touches the box indeed. */
static void take(struct draw_list *list, const struct draw_query *query, uint32_t index)
{
    const uint32_t slot = list->draws[index];
    const struct instance *instance = sdfgi_pool_at(&query->scene->instances, slot);
    if (slot < query->room && sdfgi_box_overlaps(&instance->bounds, &list->box))
        append(list, query, slot, instance);
}

/* Instances lie anywhere in memory, and waiting for one after the other would take most of the time. */
static void fetch_ahead(const struct draw_list *list, const struct draw_query *query, uint32_t index)
{
    const struct instance *instance = sdfgi_pool_at(&query->scene->instances, list->draws[index]);
    __builtin_prefetch(&instance->bounds);
    __builtin_prefetch(&instance->desc.material);
}

bool sdfgi_draws_next(struct draw_list *list, const struct draw_query *query)
{
    enum { AHEAD = 16 };
    uint32_t named = 0;
    while (named < SDFGI_MAX_DRAWS && sdfgi_tree_next(&list->search, &list->draws[named]))
        named++;
    list->count = 0;
    for (uint32_t i = 0; i < named + AHEAD; i++) {
        if (i < named)
            fetch_ahead(list, query, i);
        if (i >= AHEAD)
            take(list, query, i - AHEAD);
    }
    sort(list);
    for (uint32_t i = 0; i < list->count; i++)
        list->draws[i] = list->found[number_of(list->order[i])];
    return named > 0;
}

/* ---- Batches */

/* Triangles of a batch are numbered with 32 bits. */
static uint32_t most_of(const struct mesh *mesh)
{
    const uint32_t most = UINT32_C(0x80000000) / mesh->desc.triangle_count;
    return most > 0 ? most : 1;
}

bool sdfgi_draws_batch(const struct draw_list *list, const struct draw_query *query,
                       const struct draw_batch *after, struct draw_batch *batch)
{
    const uint32_t first = after ? after->first + after->count : 0;
    if (first == list->count)
        return false;
    const struct instance *instance =
        sdfgi_pool_at(&query->scene->instances, list->draws[first] & ~SDFGI_DRAW_CHECKED);
    *batch =
        (struct draw_batch){ .mesh = sdfgi_pool_get(&query->scene->meshes, instance->desc.mesh.id),
                             .material = sdfgi_pool_get(&query->scene->materials, instance->desc.material.id),
                             .first = first };
    const uint64_t key = list->order[first] >> NUMBER_BITS;
    const uint32_t left = list->count - first, most = most_of(batch->mesh);
    while (batch->count < left && batch->count < most &&
           list->order[first + batch->count] >> NUMBER_BITS == key) {
        batch->columns = fmax(batch->columns, list->columns[number_of(list->order[first + batch->count])]);
        batch->count++;
    }
    return true;
}
