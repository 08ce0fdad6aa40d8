/* SPDX-License-Identifier: MIT
 * What shaders read of the buffers of a mesh. */
#ifndef SDFGI_MESH_STREAMS_H
#define SDFGI_MESH_STREAMS_H

#include "shaders/shared/bindings.h"
#include "vertex_format.h"

#include <sdfgi/sdfgi.h>

enum { MESH_STREAMS = 4 }; /* by SDFGI_BINDING_MESH_* */

/* Elements in a buffer, all defaults resolved. */
struct mesh_stream {
    const char *name; /* as its fields begin: "position" */
    VkBuffer buffer;  /* null: none, and nothing below counts */
    VkDeviceSize offset, range;
    uint32_t stride;
    VkFormat format;                    /* undefined for indices */
    const struct vertex_format *layout; /* of the format; NULL for indices, and if it has none */
    VkDeviceSize skipped, size; /* bytes from the offset that are not read, and after them, that are */
};

void sdfgi_mesh_streams(const struct sdfgi_mesh_desc *desc, struct mesh_stream streams[static MESH_STREAMS]);

/* 0 for a type that indices cannot have. */
uint32_t sdfgi_index_size(VkIndexType type);

/* Where the range of a descriptor begins, and how long it is: aligned for every device. Shaders count from
 * there, by at most SDFGI_FETCH_OFFSET_MASK bytes to the first element. */
VkDeviceSize sdfgi_mesh_stream_bound_offset(const struct mesh_stream *stream);
VkDeviceSize sdfgi_mesh_stream_bound_size(const struct mesh_stream *stream);

/* SDFGI_FETCH_* of vertices; 0: there is no such buffer. */
uint32_t sdfgi_mesh_stream_fetch(const struct mesh_stream *stream);
/* SDFGI_MESH_* of indices. */
uint32_t sdfgi_mesh_index_flags(const struct mesh_stream *stream);
/* What shaders add to an index, or to the number of a corner where there are none; modulo 2^32. */
uint32_t sdfgi_mesh_first_vertex(const struct sdfgi_mesh_desc *desc);

#endif
