/* SPDX-License-Identifier: MIT */
#include "pool.h"

#include "hooks.h"

#include <string.h>

enum { FIRST_CAPACITY = 64, HANDLE_BITS = 32 };

void sdfgi_pool_init(struct pool *pool, size_t item_size, uint32_t limit)
{
    *pool = (struct pool){ .item_size = item_size, .limit = limit, .slot_bits = 1 };
    while (limit >> pool->slot_bits != 0)
        pool->slot_bits++;
}

void sdfgi_pool_finish(struct pool *pool, const struct hooks *hooks)
{
    sdfgi_hooks_free(hooks, pool->items);
    sdfgi_hooks_free(hooks, pool->generations);
    sdfgi_hooks_free(hooks, pool->live);
    sdfgi_pool_init(pool, pool->item_size, pool->limit);
}

static bool grow(struct pool *pool, const struct hooks *hooks)
{
    uint32_t capacity = pool->capacity ? pool->capacity * 2 : FIRST_CAPACITY;
    capacity = capacity < pool->limit ? capacity : pool->limit;
    if (capacity <= pool->capacity)
        return false;
    struct pool bigger = *pool;
    bigger.capacity = capacity;
    bigger.items = sdfgi_hooks_alloc(hooks, capacity * pool->item_size);
    bigger.generations = sdfgi_hooks_alloc(hooks, capacity * sizeof *bigger.generations);
    bigger.live = sdfgi_hooks_alloc(hooks, capacity * sizeof *bigger.live);
    if (!bigger.items || !bigger.generations || !bigger.live) {
        sdfgi_pool_finish(&bigger, hooks);
        return false;
    }
    memset(bigger.generations, 0, capacity * sizeof *bigger.generations);
    memset(bigger.live, 0, capacity * sizeof *bigger.live);
    if (pool->end > 0) {
        memcpy(bigger.items, pool->items, pool->end * pool->item_size);
        memcpy(bigger.generations, pool->generations, pool->end * sizeof *bigger.generations);
        memcpy(bigger.live, pool->live, pool->end * sizeof *bigger.live);
    }
    sdfgi_pool_finish(pool, hooks);
    *pool = bigger;
    return true;
}

static bool is_used_up(const struct pool *pool, uint32_t slot)
{
    return pool->generations[slot] >> (HANDLE_BITS - pool->slot_bits) != 0;
}

static uint32_t free_slot(const struct pool *pool)
{
    uint32_t slot = pool->first_free;
    while (slot < pool->end && (pool->live[slot] || is_used_up(pool, slot)))
        slot++;
    return slot;
}

/* Slots that can be taken without growing, as far as `enough` of them. */
static uint32_t slots_left(const struct pool *pool, uint32_t enough)
{
    uint32_t left = pool->capacity - pool->end;
    for (uint32_t slot = pool->first_free; slot < pool->end && left < enough; slot++)
        left += !pool->live[slot] && !is_used_up(pool, slot);
    return left;
}

bool sdfgi_pool_reserve(struct pool *pool, const struct hooks *hooks, uint32_t count)
{
    while (slots_left(pool, count) < count)
        if (!grow(pool, hooks))
            return false;
    return true;
}

uint32_t sdfgi_pool_id(const struct pool *pool, uint32_t index)
{
    return (index + 1) | pool->generations[index] << pool->slot_bits;
}

uint32_t sdfgi_pool_index(const struct pool *pool, uint32_t id)
{
    return (id & ((1u << pool->slot_bits) - 1)) - 1;
}

void *sdfgi_pool_add(struct pool *pool, const struct hooks *hooks, uint32_t *id)
{
    const uint32_t slot = free_slot(pool);
    if (slot >= pool->capacity && !grow(pool, hooks))
        return NULL;
    pool->live[slot] = true;
    pool->count++;
    pool->first_free = slot + 1;
    pool->end = slot + 1 > pool->end ? slot + 1 : pool->end;
    *id = sdfgi_pool_id(pool, slot);
    return memset(pool->items + slot * pool->item_size, 0, pool->item_size);
}

void *sdfgi_pool_at(const struct pool *pool, uint32_t index)
{
    return index < pool->end && pool->live[index] ? pool->items + index * pool->item_size : NULL;
}

void *sdfgi_pool_get(const struct pool *pool, uint32_t id)
{
    const uint32_t slot = sdfgi_pool_index(pool, id);
    if (slot >= pool->end || sdfgi_pool_id(pool, slot) != id)
        return NULL;
    return sdfgi_pool_at(pool, slot);
}

void sdfgi_pool_remove(struct pool *pool, uint32_t id)
{
    const uint32_t slot = sdfgi_pool_index(pool, id);
    if (!sdfgi_pool_get(pool, id))
        return;
    pool->live[slot] = false;
    pool->generations[slot]++;
    pool->first_free = slot < pool->first_free ? slot : pool->first_free;
    pool->count--;
}
