/* SPDX-License-Identifier: MIT */
#include "resource_rows.h"

#include "work.h"

#include "shaders/shared/bindings.h"

#include <assert.h>

enum format_texels {
#define TEXELS(id, bytes, texels) FORMAT_TEXELS_##id = VK_FORMAT_##texels,
    RESOURCE_FORMATS(TEXELS)
#undef TEXELS
};

static const struct resource_row rows[RESOURCE_COUNT] = {
#define ROW(id, kind_, format, category_, scope_, set_, extent, keep_)                                       \
    [RESOURCE_##id] = { "sdfgi " #id,                                                                        \
                        RESOURCE_KIND_##kind_,                                                               \
                        SDFGI_MEMORY_##category_,                                                            \
                        RESOURCE_SCOPE_##scope_,                                                             \
                        RESOURCE_SET_##set_,                                                                 \
                        RESOURCE_KEEP_##keep_,                                                               \
                        SDFGI_BINDING_##id,                                                                  \
                        (VkFormat)FORMAT_TEXELS_##format },
    SDFGI_RESOURCES(ROW)
#undef ROW
};

enum format_size {
#define SIZE(id, bytes, texels) FORMAT_SIZE_##id = bytes,
    RESOURCE_FORMATS(SIZE)
#undef SIZE
};

const struct resource_row *sdfgi_resource_row(enum resource resource)
{
    return &rows[resource];
}

uint64_t sdfgi_resource_size(enum resource resource, const struct extent *e)
{
    switch (resource) {
#define SIZE(id, kind, format, category, scope, set, extent, keep)                                           \
    case RESOURCE_##id:                                                                                      \
        return (uint64_t)FORMAT_SIZE_##format * (extent);
        SDFGI_RESOURCES(SIZE)
#undef SIZE
    case RESOURCE_COUNT:
        break;
    }
    assert(false);
    return 0;
}

uint64_t sdfgi_gather_counters_offset(const struct extent *e)
{
    assert(e->gathers);
    return sizeof(uint32_t) * SDFGI_GATHERED_WORDS * ENTRY_COUNT(e);
}

uint32_t sdfgi_low_light_begin(const struct extent *e, uint32_t most_texels)
{
    return e->low_light && SEEN_COUNT(e) <= most_texels
               ? sdfgi_seen_low_light((uint32_t)e->light_cells, (uint32_t)e->cascades)
               : 0;
}

VkDescriptorType sdfgi_resource_descriptor(enum resource resource)
{
    return rows[resource].kind == RESOURCE_KIND_UNIFORM ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                        : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

const char *sdfgi_resource_set_name(enum resource_set set)
{
    static const char *const names[RESOURCE_SET_COUNT] = { "sdfgi LOOKUP", "sdfgi WORK" };
    return names[set];
}

uint32_t sdfgi_resource_set_size(enum resource_set set)
{
    uint32_t count = 0;
    for (int i = 0; i < RESOURCE_COUNT; i++)
        count += rows[i].set == set;
    return count;
}

uint64_t sdfgi_readback_size(uint32_t frames_in_flight)
{
    return (uint64_t)frames_in_flight * SDFGI_READBACK_WORDS * sizeof(uint32_t);
}
