/* SPDX-License-Identifier: MIT
 * An arena: many allocations, one release. A failed allocation is remembered, so that a function may make all
 * of its allocations first and check once. */
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stdbool.h>
#include <stddef.h>

/* Names for the linker, since this lies in the static library, too: see gpu/gpu_names.h. */
#define base_arena_init   sdfgi_base_arena_init
#define base_arena_alloc  sdfgi_base_arena_alloc
#define base_arena_finish sdfgi_base_arena_finish

#ifdef __cplusplus
extern "C" {
#endif

struct base_allocator {
    void *(*alloc)(void *user, size_t size); /* may return NULL */
    void (*free)(void *user, void *memory);
    void *user;
};

struct base_arena {
    struct base_allocator allocator;
    struct base_arena_block *blocks; /* newest first */
    size_t block_bytes;              /* least size of a new block */
    bool failed;                     /* an allocation has returned NULL */
};

/* `allocator` may be NULL: malloc and free. Allocates nothing yet. */
void base_arena_init(struct base_arena *arena, const struct base_allocator *allocator, size_t block_bytes);

/* Zeroed memory for `count` elements of `size` bytes, aligned for any type; lives until base_arena_finish.
 * NULL when memory runs out or count * size overflows; `failed` is then set and stays set. */
void *base_arena_alloc(struct base_arena *arena, size_t count, size_t size);

/* Releases everything. The arena is empty afterwards and may be used again. */
void base_arena_finish(struct base_arena *arena);

#ifdef __cplusplus
}
#endif
#endif
