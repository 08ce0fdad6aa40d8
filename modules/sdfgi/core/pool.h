/* SPDX-License-Identifier: MIT
 * Slots of equal size behind 32-bit handles: slot + 1 in as many bits as the limit takes, and a generation in
 * the others. A slot that has had all of its generations is not used again: no handle is ever valid twice.
 * The lowest free slot is taken first, so that slots stay together. */
#ifndef SDFGI_POOL_H
#define SDFGI_POOL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct hooks;

struct pool {
    size_t item_size;
    uint32_t limit;           /* most slots */
    uint32_t slot_bits;       /* of a handle, low; the others are the generation */
    uint32_t capacity, count; /* slots allocated and in use */
    uint32_t end;             /* slots ever used: all live ones are below */
    uint32_t first_free;      /* no slot below can be taken */
    uint8_t *items;
    uint32_t *generations; /* of the next handle, or of the live one */
    bool *live;
};

void sdfgi_pool_init(struct pool *pool, size_t item_size, uint32_t limit);
void sdfgi_pool_finish(struct pool *pool, const struct hooks *hooks);

/* Makes room for `count` items more: so many calls of sdfgi_pool_add will succeed. False, and the items stay
 * as they are, if memory, slots or handles do not suffice. */
bool sdfgi_pool_reserve(struct pool *pool, const struct hooks *hooks, uint32_t count);
/* Takes a zeroed slot. Returns NULL if memory, slots or handles have run out. */
void *sdfgi_pool_add(struct pool *pool, const struct hooks *hooks, uint32_t *id);
/* NULL if `id` is not a live handle. */
void *sdfgi_pool_get(const struct pool *pool, uint32_t id);
void sdfgi_pool_remove(struct pool *pool, uint32_t id);
/* The item in slot `index` < end, or NULL if it is not live. */
void *sdfgi_pool_at(const struct pool *pool, uint32_t index);
uint32_t sdfgi_pool_index(const struct pool *pool, uint32_t id);
uint32_t sdfgi_pool_id(const struct pool *pool, uint32_t index);

#endif
