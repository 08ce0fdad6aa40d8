/* SPDX-License-Identifier: MIT */
#include "arena.h"

#include <stdalign.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct base_arena_block {
    struct base_arena_block *next;
    size_t capacity, used;
    alignas(max_align_t) unsigned char bytes[];
};

static void *alloc_default(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void free_default(void *user, void *memory)
{
    (void)user;
    free(memory);
}

void base_arena_init(struct base_arena *arena, const struct base_allocator *allocator, size_t block_bytes)
{
    const struct base_allocator standard = { alloc_default, free_default, NULL };
    *arena =
        (struct base_arena){ .allocator = allocator ? *allocator : standard, .block_bytes = block_bytes };
}

static struct base_arena_block *block_add(struct base_arena *arena, size_t needed)
{
    const size_t capacity = needed > arena->block_bytes ? needed : arena->block_bytes;
    if (capacity > SIZE_MAX - sizeof(struct base_arena_block))
        return NULL;
    struct base_arena_block *block =
        arena->allocator.alloc(arena->allocator.user, sizeof(struct base_arena_block) + capacity);
    if (!block)
        return NULL;
    *block = (struct base_arena_block){ .next = arena->blocks, .capacity = capacity };
    arena->blocks = block;
    return block;
}

void *base_arena_alloc(struct base_arena *arena, size_t count, size_t size)
{
    const size_t alignment = alignof(max_align_t);
    arena->failed |= size != 0 && count > (SIZE_MAX - alignment) / size;
    if (arena->failed)
        return NULL;
    const size_t bytes = (count * size + alignment - 1) / alignment * alignment;
    struct base_arena_block *block = arena->blocks;
    if (!block || block->capacity - block->used < bytes)
        block = block_add(arena, bytes);
    if (!block) {
        arena->failed = true;
        return NULL;
    }
    void *memory = block->bytes + block->used;
    block->used += bytes;
    return memset(memory, 0, bytes);
}

void base_arena_finish(struct base_arena *arena)
{
    while (arena->blocks) {
        struct base_arena_block *next = arena->blocks->next;
        arena->allocator.free(arena->allocator.user, arena->blocks);
        arena->blocks = next;
    }
    arena->failed = false;
}
