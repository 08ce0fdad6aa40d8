/* SPDX-License-Identifier: MIT
 * Checks of meshes: whether shaders can read what hosts describe. */
#include "mesh_streams.h"
#include "scene_check.h"

#include <math.h>

static void check_counts(struct problem *p, const struct sdfgi_mesh_desc *d)
{
    if (!d->position_buffer)
        sdfgi_problem_add(p, "position_buffer is null");
    if (d->vertex_count == 0)
        sdfgi_problem_add(p, "vertex_count is 0");
    if (d->triangle_count == 0)
        sdfgi_problem_add(p, "triangle_count is 0");
    if (d->index_buffer && sdfgi_index_size(d->index_type) == 0)
        sdfgi_problem_add(p,
                          "index_type is %d, must be VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32 or "
                          "VK_INDEX_TYPE_UINT8_EXT",
                          (int)d->index_type);
    if (d->front_face != VK_FRONT_FACE_COUNTER_CLOCKWISE && d->front_face != VK_FRONT_FACE_CLOCKWISE)
        sdfgi_problem_add(p, "front_face is %d, must be one of VkFrontFace", (int)d->front_face);
}

/* Without indices, what they would be is known. */
static void check_plain_vertices(struct problem *p, const struct sdfgi_mesh_desc *d)
{
    const int64_t first = (int64_t)d->first_index + d->vertex_offset, left = d->vertex_count - first;
    if (d->index_buffer)
        return;
    if (first < 0)
        sdfgi_problem_add(p, "first_index + vertex_offset is %lld, must be at least 0 without indices",
                          (long long)first);
    if (d->triangle_count > left / 3)
        sdfgi_problem_add(p,
                          "triangle_count is %u, must be at most %lld without indices: vertex_count is %u, "
                          "the first vertex is %lld",
                          (unsigned)d->triangle_count, (long long)(left > 0 ? left / 3 : 0),
                          (unsigned)d->vertex_count, (long long)first);
}

static void check_format(struct problem *p, const struct mesh_stream *stream, uint32_t least_components)
{
    const uint32_t components = stream->layout ? stream->layout->components : 0;
    if (components >= least_components)
        return;
    if (!stream->layout)
        sdfgi_problem_add(p, "%s_format is %d, a VkFormat that vertices cannot have", stream->name,
                          (int)stream->format);
    else
        sdfgi_problem_add(p, "%s_format is %s, must have at least %u components", stream->name,
                          stream->layout->name, (unsigned)least_components);
}

static void check_layout(struct problem *p, const struct mesh_stream *stream)
{
    const struct vertex_format *layout = stream->layout;
    if (!layout)
        return;
    if (stream->offset % layout->alignment)
        sdfgi_problem_add(p, "%s_offset is %llu, must be a multiple of %u for %s", stream->name,
                          (unsigned long long)stream->offset, (unsigned)layout->alignment, layout->name);
    if (stream->stride % layout->alignment || stream->stride < layout->size)
        sdfgi_problem_add(p, "%s_stride is %u, must be 0 or a multiple of %u that is at least %u for %s",
                          stream->name, (unsigned)stream->stride, (unsigned)layout->alignment,
                          (unsigned)layout->size, layout->name);
}

/* The bytes that hold the buffer are at least as many as it has. */
static VkDeviceSize most_bytes(const struct gpu_device *device, VkBuffer buffer)
{
    VkMemoryRequirements needs;
    device->fn.GetBufferMemoryRequirements(device->handle, buffer, &needs);
    return needs.size;
}

static void check_range(struct problem *p, const struct mesh_stream *stream, const struct gpu_device *device)
{
    const VkDeviceSize needed = stream->skipped + stream->size, most = most_bytes(device, stream->buffer);
    const uint32_t limit = device->limits.maxStorageBufferRange;
    if (stream->range && stream->range < needed)
        sdfgi_problem_add(p, "%s_range is %llu, must be at least %llu bytes for what the mesh reads",
                          stream->name, (unsigned long long)stream->range, (unsigned long long)needed);
    if (stream->offset > most || needed > most - stream->offset)
        sdfgi_problem_add(p,
                          "%s_buffer has at most %llu bytes, the mesh reads %llu bytes from %s_offset = %llu",
                          stream->name, (unsigned long long)most, (unsigned long long)needed, stream->name,
                          (unsigned long long)stream->offset);
    if (stream->size > limit || sdfgi_mesh_stream_bound_size(stream) > limit)
        sdfgi_problem_add(p, "%s_buffer: the mesh reads %llu bytes, maxStorageBufferRange is %u",
                          stream->name, (unsigned long long)stream->size, (unsigned)limit);
}

static void check_streams(struct problem *p, const struct sdfgi_mesh_desc *d, const struct gpu_device *device)
{
    static const uint32_t least_components[MESH_STREAMS] = {
        [SDFGI_BINDING_MESH_POSITIONS] = 2, [SDFGI_BINDING_MESH_UVS] = 2, [SDFGI_BINDING_MESH_COLORS] = 3
    };
    struct mesh_stream streams[MESH_STREAMS];
    sdfgi_mesh_streams(d, streams);
    for (uint32_t i = 0; i < MESH_STREAMS; i++) {
        if (!streams[i].buffer)
            continue;
        check_format(p, &streams[i], least_components[i]);
        check_layout(p, &streams[i]);
        check_range(p, &streams[i], device);
    }
}

static void check_bounds(struct problem *p, const struct sdfgi_mesh_desc *d)
{
    bool all_zero = true;
    sdfgi_problem_floats(p, "bounds_min", d->bounds_min, 3, -INFINITY, INFINITY);
    sdfgi_problem_floats(p, "bounds_max", d->bounds_max, 3, -INFINITY, INFINITY);
    for (int i = 0; i < 3; i++) {
        all_zero = all_zero && d->bounds_min[i] == 0 && d->bounds_max[i] == 0;
        if (d->bounds_min[i] > d->bounds_max[i])
            sdfgi_problem_add(p, "bounds_min[%d] is %g, must be at most bounds_max[%d] = %g", i,
                              (double)d->bounds_min[i], i, (double)d->bounds_max[i]);
    }
    if (all_zero)
        sdfgi_problem_add(p, "bounds_min and bounds_max are 0: state the box around all vertices");
}

struct problem sdfgi_check_mesh(const struct sdfgi_mesh_desc *d, const struct gpu_device *device)
{
    struct problem p = { "" };
    check_counts(&p, d);
    check_plain_vertices(&p, d);
    check_streams(&p, d, device);
    check_bounds(&p, d);
    return p;
}
