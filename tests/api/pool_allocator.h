/* SPDX-License-Identifier: MIT
 * A host's allocator: parts of large blocks, none of which begins at offset 0. It checks what it is asked
 * for, and what comes back. */
#ifndef TEST_POOL_ALLOCATOR_H
#define TEST_POOL_ALLOCATOR_H

#include "gpu_test.h"

enum { POOL_MOST_BLOCKS = 64, POOL_MOST_PARTS = 256 };

struct pool_part {
    uint32_t block;
    VkDeviceSize offset, size;
    enum sdfgi_memory_category category;
    uint64_t bytes;
    bool live;
};

struct pool_allocator {
    struct gpu_test *gpu;
    struct {
        VkDeviceMemory memory;
        VkDeviceSize size, used;
        uint32_t type;
        bool images;
        char *mapped;
    } blocks[POOL_MOST_BLOCKS];
    uint32_t block_count;
    struct pool_part parts[POOL_MOST_PARTS]; /* all that were given; live ones may not move */
    uint32_t part_count;
    uint32_t calls, fail_at; /* the call that fails; 0: none */
    VkResult failure;
    uint32_t stale; /* in each word of what is given, where memory can be mapped */
    enum { POOL_SOUND, POOL_NULL, POOL_MISPLACED, POOL_UNMAPPED } fault; /* of what is given */
};

/* Must stay where it is. Fails the test where the library breaks a rule. */
void pool_allocator_open(struct pool_allocator *pool, struct gpu_test *gpu);
/* Nothing may be live any more. */
void pool_allocator_close(struct pool_allocator *pool);

struct sdfgi_device_allocator pool_allocator_functions(struct pool_allocator *pool);

/* As the library counts them: live bytes of a category, and how many parts are live. */
uint64_t pool_allocator_bytes(const struct pool_allocator *pool, enum sdfgi_memory_category category);
uint32_t pool_allocator_live(const struct pool_allocator *pool);

#endif
