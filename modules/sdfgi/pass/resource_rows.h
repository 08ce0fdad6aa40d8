/* SPDX-License-Identifier: MIT
 * The rows of resource_table.h as data. Needs no device. */
#ifndef SDFGI_RESOURCE_ROWS_H
#define SDFGI_RESOURCE_ROWS_H

#include "core/extent.h"
#include "resource_table.h"

#include <sdfgi/sdfgi.h>

enum resource_kind { RESOURCE_KIND_UNIFORM, RESOURCE_KIND_STORAGE };
enum resource_scope { RESOURCE_SCOPE_VOLUME, RESOURCE_SCOPE_VIEW };
enum resource_set { RESOURCE_SET_LOOKUP, RESOURCE_SET_WORK, RESOURCE_SET_COUNT };
enum resource_keep { RESOURCE_KEEP_SAVED, RESOURCE_KEEP_DERIVED, RESOURCE_KEEP_SCRATCH };

struct resource_row {
    const char *name; /* "sdfgi BITS" */
    enum resource_kind kind;
    enum sdfgi_memory_category category;
    enum resource_scope scope;
    enum resource_set set;
    enum resource_keep keep;
    uint32_t binding; /* in its set */
    VkFormat texels;  /* VK_FORMAT_UNDEFINED: shaders never read texels of it */
};

const struct resource_row *sdfgi_resource_row(enum resource resource);
/* Bytes. */
uint64_t sdfgi_resource_size(enum resource resource, const struct extent *extent);
/* Bytes of GATHERED before the counters from SDFGI_COUNTER_GATHER on. Only where light cells gather. */
uint64_t sdfgi_gather_counters_offset(const struct extent *extent);
/* The word of SEEN at which it begins from where surfaces get their light. 0: it is not kept, or a texel
 * buffer of `most_texels` does not reach its end. */
uint32_t sdfgi_low_light_begin(const struct extent *extent, uint32_t most_texels);
VkDescriptorType sdfgi_resource_descriptor(enum resource resource);
/* "sdfgi LOOKUP" */
const char *sdfgi_resource_set_name(enum resource_set set);
/* How many resources of a set are bound. */
uint32_t sdfgi_resource_set_size(enum resource_set set);
/* Bytes that come back to the host. */
uint64_t sdfgi_readback_size(uint32_t frames_in_flight);

#endif
