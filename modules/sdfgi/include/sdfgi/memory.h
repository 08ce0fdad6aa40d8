/* SPDX-License-Identifier: MIT
 * Device memory: what it is for, and how a host gives it from an allocator of its own. Conventions as in
 * sdfgi.h, which includes this. */
#ifndef SDFGI_MEMORY_H
#define SDFGI_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

enum sdfgi_memory_category {
    SDFGI_MEMORY_VOLUMES,  /* solid bits, distance, albedo, emission, light */
    SDFGI_MEMORY_PROBES,   /* irradiance, occlusion, running sums, ray cache */
    SDFGI_MEMORY_SCRATCH,  /* flood pointers, accumulators, occupancy: shared by all cascades */
    SDFGI_MEMORY_LISTS,    /* light cells, lights, materials, counters, indirect arguments */
    SDFGI_MEMORY_READBACK, /* counters and timestamps, host visible */
    SDFGI_MEMORY_VIEWS,    /* pictures of views: not in the estimate */
    SDFGI_MEMORY_CATEGORY_COUNT,
};

struct sdfgi_memory {
    uint64_t bytes[SDFGI_MEMORY_CATEGORY_COUNT];
    uint64_t total_bytes;
};

/* What the library asks a host's allocator for: memory for one buffer or one image. */
struct sdfgi_memory_request {
    VkMemoryRequirements requirements; /* the memory must meet them. Where it is mapped, size and alignment
                                          are multiples of nonCoherentAtomSize */
    VkMemoryPropertyFlags required;    /* the memory type must have these properties, and should have */
    VkMemoryPropertyFlags preferred;   /* these */
    bool mapped;                       /* the host side of it is asked for, too */
    VkBuffer buffer; /* what is to be bound, by the library: one of these two, the other is VK_NULL_HANDLE. */
    VkImage image;   /* Images are of optimal tiling: see bufferImageGranularity */
    enum sdfgi_memory_category category; /* _COUNT: the buffer of lookups that answer black */
    uint64_t bytes;                      /* by which the category grows in the report; 0 for that buffer */
    const char *name;                    /* static: "sdfgi bits" */
};

/* What the host gives. Zero when the library asks. */
struct sdfgi_memory_block {
    VkDeviceMemory memory;
    VkDeviceSize offset; /* of the first byte: a multiple of requirements.alignment */
    void *mapped;        /* where `mapped` was asked for: the first byte, not that of the memory. It stays
                            mapped until it is freed, and need not be coherent */
    void *allocation;    /* the host's own */
};

/* Memory of the host's. Both functions or neither; neither means that each object gets a VkDeviceMemory of
 * its own. `allocate` fills `block` and returns VK_SUCCESS, or returns why not; then it must have taken
 * everything back, and the call of the library fails: with SDFGI_ERROR_OUT_OF_MEMORY if it says
 * VK_ERROR_OUT_OF_DEVICE_MEMORY or _HOST_MEMORY. `free` gets each block once, when nothing is bound to it any
 * more and no frame in flight can use it; every block comes back by the end of sdfgi_destroy.
 *
 * Threads: the two are called by the threads that call the library, and by no other. Where sdfgi_prepare runs
 * beside other functions they must lock. They may not call functions that take the context. */
struct sdfgi_device_allocator {
    VkResult (*allocate)(void *user, const struct sdfgi_memory_request *request,
                         struct sdfgi_memory_block *block);
    void (*free)(void *user, const struct sdfgi_memory_block *block);
    void *user;
};

#ifdef __cplusplus
}
#endif
#endif
