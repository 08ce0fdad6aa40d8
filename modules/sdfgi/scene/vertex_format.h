/* SPDX-License-Identifier: MIT
 * The formats that attributes of vertices may have, a row each. */
#ifndef SDFGI_VERTEX_FORMAT_H
#define SDFGI_VERTEX_FORMAT_H

#include "shaders/shared/vertex_fetch.h"

#include <stddef.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

struct vertex_format {
    VkFormat format;
    const char *name; /* "VK_FORMAT_..." */
    uint8_t components;
    uint8_t size;      /* bytes of an element */
    uint8_t alignment; /* bytes, of offsets and strides: Vulkan's of vertex input */
    uint32_t fetch;    /* SDFGI_FETCH_*, without an offset */
};

extern const struct vertex_format sdfgi_vertex_formats[];
extern const size_t sdfgi_vertex_format_count;

/* NULL if vertices cannot have it. */
const struct vertex_format *sdfgi_vertex_format(VkFormat format);

#endif
