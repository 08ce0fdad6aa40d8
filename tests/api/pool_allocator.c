/* SPDX-License-Identifier: MIT */
#include "pool_allocator.h"

#include "require.h"

#include <vulkan/vulkan.h>

#include <string.h>

enum { BLOCK_BYTES = 32 << 20, BLOCK_BEGIN = 1000, LOCAL = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT };

static VkDeviceSize round_up(VkDeviceSize value, VkDeviceSize unit)
{
    return (value + unit - 1) / unit * unit;
}

static uint32_t choose_type(const struct pool_allocator *pool, const struct sdfgi_memory_request *r)
{
    const VkPhysicalDeviceMemoryProperties *p = &pool->gpu->memory_properties;
    for (int preferred = 1; preferred >= 0; preferred--) {
        const VkMemoryPropertyFlags wanted = r->required | (preferred ? r->preferred : 0);
        for (uint32_t i = 0; i < p->memoryTypeCount; i++)
            if ((r->requirements.memoryTypeBits >> i & 1) &&
                (p->memoryTypes[i].propertyFlags & wanted) == wanted)
                return i;
    }
    require_fail(__FILE__, __LINE__, "no memory type for %s", r->name);
    return 0;
}

static uint32_t add_block(struct pool_allocator *pool, const struct sdfgi_memory_request *r, uint32_t type)
{
    const VkDeviceSize needed = r->requirements.size + r->requirements.alignment + BLOCK_BEGIN;
    const VkMemoryAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = needed > BLOCK_BYTES ? needed : BLOCK_BYTES,
                                        .memoryTypeIndex = type };
    const uint32_t block = pool->block_count++;
    void *mapped = NULL;
    REQUIRE_CMP(block, <, (uint32_t)POOL_MOST_BLOCKS);
    pool->blocks[block].size = info.allocationSize;
    pool->blocks[block].used = BLOCK_BEGIN;
    pool->blocks[block].type = type;
    pool->blocks[block].images = r->image != VK_NULL_HANDLE;
    REQUIRE_CMP((int)vkAllocateMemory(pool->gpu->device, &info, NULL, &pool->blocks[block].memory), ==,
                (int)VK_SUCCESS);
    const VkMemoryPropertyFlags flags = pool->gpu->memory_properties.memoryTypes[type].propertyFlags;
    if (flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
        REQUIRE_CMP(
            (int)vkMapMemory(pool->gpu->device, pool->blocks[block].memory, 0, VK_WHOLE_SIZE, 0, &mapped), ==,
            (int)VK_SUCCESS);
    pool->blocks[block].mapped = mapped;
    return block;
}

/* Images and buffers lie in blocks of their own, whatever the granularity. */
static uint32_t choose_block(struct pool_allocator *pool, const struct sdfgi_memory_request *r)
{
    const uint32_t type = choose_type(pool, r);
    for (uint32_t i = 0; i < pool->block_count; i++)
        if (pool->blocks[i].type == type && pool->blocks[i].images == (r->image != VK_NULL_HANDLE) &&
            (pool->blocks[i].mapped || !r->mapped) &&
            round_up(pool->blocks[i].used, r->requirements.alignment) + r->requirements.size <=
                pool->blocks[i].size)
            return i;
    return add_block(pool, r, type);
}

static void check_request(const struct pool_allocator *pool, const struct sdfgi_memory_request *r)
{
    const VkDeviceSize atom = pool->gpu->properties.limits.nonCoherentAtomSize;
    REQUIRE_TRUE(!r->buffer != !r->image);
    REQUIRE_TRUE(strncmp(r->name, "sdfgi ", 6) == 0);
    REQUIRE_CMP((int)r->category, <=, (int)SDFGI_MEMORY_CATEGORY_COUNT);
    REQUIRE_CMP(r->bytes, <=, r->requirements.size);
    REQUIRE_TRUE((r->bytes == 0) == (r->category == SDFGI_MEMORY_CATEGORY_COUNT));
    if (r->mapped) {
        REQUIRE_TRUE(r->required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT);
        REQUIRE_CMP(r->requirements.size % atom + r->requirements.alignment % atom, ==, 0u);
    } else {
        REQUIRE_TRUE(r->preferred & LOCAL);
    }
}

/* What a careless host gives. */
static void spoil(const struct pool_allocator *pool, const struct sdfgi_memory_request *r,
                  struct sdfgi_memory_block *out)
{
    if (pool->fault == POOL_NULL)
        out->memory = VK_NULL_HANDLE;
    if (pool->fault == POOL_MISPLACED)
        out->offset += r->requirements.alignment / 2;
    if (pool->fault == POOL_UNMAPPED)
        out->mapped = NULL;
}

/* What somebody else has left there. */
static void fill(const struct pool_allocator *pool, uint32_t block, VkDeviceSize offset, VkDeviceSize size)
{
    char *mapped = pool->blocks[block].mapped;
    for (VkDeviceSize at = offset; mapped && at + 4 <= offset + size; at += 4)
        memcpy(mapped + at, &pool->stale, 4);
}

static VkResult allocate(void *user, const struct sdfgi_memory_request *r, struct sdfgi_memory_block *out)
{
    struct pool_allocator *pool = user;
    check_request(pool, r);
    if (++pool->calls == pool->fail_at)
        return pool->failure;
    const uint32_t block = choose_block(pool, r);
    const VkDeviceSize offset = round_up(pool->blocks[block].used, r->requirements.alignment);
    REQUIRE_CMP(offset, >, 0u);
    pool->blocks[block].used = offset + r->requirements.size;
    uint32_t p = 0;
    while (p < pool->part_count && pool->parts[p].live)
        p++;
    REQUIRE_CMP(p, <, (uint32_t)POOL_MOST_PARTS);
    pool->part_count = p < pool->part_count ? pool->part_count : p + 1;
    pool->parts[p] =
        (struct pool_part){ block, offset, r->requirements.size, r->category, r->bytes, .live = true };
    out->memory = pool->blocks[block].memory;
    out->offset = offset;
    out->mapped = r->mapped ? pool->blocks[block].mapped + offset : NULL;
    out->allocation = &pool->parts[p];
    fill(pool, block, offset, r->requirements.size);
    spoil(pool, r, out);
    return VK_SUCCESS;
}

/* A block without parts is empty again. */
static void rewind_block(struct pool_allocator *pool, uint32_t block)
{
    for (uint32_t i = 0; i < pool->part_count; i++)
        if (pool->parts[i].live && pool->parts[i].block == block)
            return;
    pool->blocks[block].used = BLOCK_BEGIN;
}

static void release(void *user, const struct sdfgi_memory_block *block)
{
    struct pool_allocator *pool = user;
    struct pool_part *part = block->allocation;
    REQUIRE_TRUE(part >= pool->parts && part < pool->parts + pool->part_count && part->live);
    if (pool->fault == POOL_SOUND) {
        REQUIRE_TRUE(block->memory == pool->blocks[part->block].memory && block->offset == part->offset);
    }
    part->live = false;
    rewind_block(pool, part->block);
}

void pool_allocator_open(struct pool_allocator *pool, struct gpu_test *gpu)
{
    memset(pool, 0, sizeof *pool);
    pool->gpu = gpu;
    pool->failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

void pool_allocator_close(struct pool_allocator *pool)
{
    REQUIRE_CMP(pool_allocator_live(pool), ==, 0u);
    for (uint32_t i = 0; i < pool->block_count; i++)
        vkFreeMemory(pool->gpu->device, pool->blocks[i].memory, NULL);
    pool->block_count = 0;
}

struct sdfgi_device_allocator pool_allocator_functions(struct pool_allocator *pool)
{
    return (struct sdfgi_device_allocator){ allocate, release, pool };
}

uint64_t pool_allocator_bytes(const struct pool_allocator *pool, enum sdfgi_memory_category category)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < pool->part_count; i++)
        if (pool->parts[i].live && pool->parts[i].category == category)
            bytes += pool->parts[i].bytes;
    return bytes;
}

uint32_t pool_allocator_live(const struct pool_allocator *pool)
{
    uint32_t live = 0;
    for (uint32_t i = 0; i < pool->part_count; i++)
        live += pool->parts[i].live;
    return live;
}
