/* SPDX-License-Identifier: MIT
 * The instances that touch a box of cells, in batches that one dispatch voxelises: the same mesh, the same
 * textures, and about as many columns. They come in chunks, because a list holds but so many. */
#ifndef SDFGI_DRAW_LIST_H
#define SDFGI_DRAW_LIST_H

#include "pass/work.h"
#include "scene/scene.h"
#include "volume/cascade.h"

/* Where instances are looked for. */
struct draw_query {
    const struct scene *scene;
    const struct cascade *cascade;
    const struct work *work;
    uint64_t room;             /* slots beyond have not been uploaded */
    double columns_per_thread; /* worth a thread */
};

struct draw_list {
    uint64_t order[SDFGI_MAX_DRAWS],
        spare[SDFGI_MAX_DRAWS];      /* what tells batches apart, and the number below */
    uint32_t found[SDFGI_MAX_DRAWS]; /* elements of the list, as they were found */
    float columns[SDFGI_MAX_DRAWS];  /* of sub-voxels that each is taken to touch */
    uint32_t draws[SDFGI_MAX_DRAWS]; /* elements of the list, batch after batch */
    uint32_t count;
    struct box box, made; /* world: of the part, and of what has been checked */
    bool is_made;
    struct tree_search search;
};

struct draw_batch {
    const struct mesh *mesh;
    const struct material *material; /* any of them: they have the same textures */
    uint32_t first, count;           /* in the list */
    double columns;                  /* of the instance that has most */
};

/* Begins to look for what touches the box of an item of work. */
void sdfgi_draws_begin(struct draw_list *list, const struct draw_query *query);
/* Fills the list with the next chunk. False if nothing is left. */
bool sdfgi_draws_next(struct draw_list *list, const struct draw_query *query);
/* The batch of the list that begins where `after` ends, or the first one if that is NULL. */
bool sdfgi_draws_batch(const struct draw_list *list, const struct draw_query *query,
                       const struct draw_batch *after, struct draw_batch *batch);

#endif
