/* SPDX-License-Identifier: MIT */
#include "mesh_streams.h"

#include "shaders/shared/args.h"

/* The most that minStorageBufferOffsetAlignment may be. */
enum { ALIGNMENT = 256 };
_Static_assert(SDFGI_FETCH_OFFSET_MASK == ALIGNMENT - 1, "the offset of the first element fits");

uint32_t sdfgi_index_size(VkIndexType type)
{
    static const struct {
        VkIndexType type;
        uint32_t size;
    } sizes[] = { { VK_INDEX_TYPE_UINT8_EXT, 1 }, { VK_INDEX_TYPE_UINT16, 2 }, { VK_INDEX_TYPE_UINT32, 4 } };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (sizes[i].type == type)
            return sizes[i].size;
    return 0;
}

static void resolve(struct mesh_stream *stream, VkFormat usual, uint32_t count)
{
    stream->format = stream->format ? stream->format : usual;
    stream->layout = sdfgi_vertex_format(stream->format);
    const uint32_t element = stream->layout ? stream->layout->size : 0;
    stream->stride = stream->stride ? stream->stride : element;
    stream->size = count ? (VkDeviceSize)(count - 1) * stream->stride + element : 0;
}

void sdfgi_mesh_streams(const struct sdfgi_mesh_desc *d, struct mesh_stream streams[static MESH_STREAMS])
{
    const uint32_t index_size = sdfgi_index_size(d->index_type);
    streams[SDFGI_BINDING_MESH_POSITIONS] = (struct mesh_stream){ .name = "position",
                                                                  .buffer = d->position_buffer,
                                                                  .offset = d->position_offset,
                                                                  .range = d->position_range,
                                                                  .stride = d->position_stride,
                                                                  .format = d->position_format };
    streams[SDFGI_BINDING_MESH_UVS] = (struct mesh_stream){ .name = "uv",
                                                            .buffer = d->uv_buffer,
                                                            .offset = d->uv_offset,
                                                            .range = d->uv_range,
                                                            .stride = d->uv_stride,
                                                            .format = d->uv_format };
    streams[SDFGI_BINDING_MESH_COLORS] = (struct mesh_stream){ .name = "color",
                                                               .buffer = d->color_buffer,
                                                               .offset = d->color_offset,
                                                               .range = d->color_range,
                                                               .stride = d->color_stride,
                                                               .format = d->color_format };
    streams[SDFGI_BINDING_MESH_INDICES] =
        (struct mesh_stream){ .name = "index",
                              .buffer = d->index_buffer,
                              .offset = d->index_offset,
                              .range = d->index_range,
                              .stride = index_size,
                              .skipped = (VkDeviceSize)d->first_index * index_size,
                              .size = 3 * (VkDeviceSize)d->triangle_count * index_size };
    resolve(&streams[SDFGI_BINDING_MESH_POSITIONS], VK_FORMAT_R32G32B32_SFLOAT, d->vertex_count);
    resolve(&streams[SDFGI_BINDING_MESH_UVS], VK_FORMAT_R32G32_SFLOAT, d->vertex_count);
    resolve(&streams[SDFGI_BINDING_MESH_COLORS], VK_FORMAT_R32G32B32A32_SFLOAT, d->vertex_count);
}

static VkDeviceSize first_byte(const struct mesh_stream *stream)
{
    return stream->offset + stream->skipped;
}

VkDeviceSize sdfgi_mesh_stream_bound_offset(const struct mesh_stream *stream)
{
    return first_byte(stream) / ALIGNMENT * ALIGNMENT;
}

VkDeviceSize sdfgi_mesh_stream_bound_size(const struct mesh_stream *stream)
{
    return (first_byte(stream) % ALIGNMENT + stream->size + 3) / 4 * 4;
}

uint32_t sdfgi_mesh_stream_fetch(const struct mesh_stream *stream)
{
    return stream->buffer ? stream->layout->fetch | (uint32_t)(first_byte(stream) % ALIGNMENT) : 0;
}

uint32_t sdfgi_mesh_index_flags(const struct mesh_stream *stream)
{
    if (!stream->buffer)
        return 0;
    return 8 * stream->stride | (uint32_t)(first_byte(stream) % ALIGNMENT) << SDFGI_MESH_INDEX_OFFSET_SHIFT;
}

uint32_t sdfgi_mesh_first_vertex(const struct sdfgi_mesh_desc *desc)
{
    return (uint32_t)desc->vertex_offset + (desc->index_buffer ? 0 : desc->first_index);
}
