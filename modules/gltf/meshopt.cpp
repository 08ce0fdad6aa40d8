// SPDX-License-Identifier: MIT
//
// EXT_meshopt_compression through meshoptimizer, whose decoders are made for input that is not trusted. Each
// compressed view becomes a view of a buffer of its own.
#include "import.h"

#include <algorithm>
#include <meshoptimizer.h>

namespace gltf
{

namespace
{

// The densest data there is: a byte of the vertex codec says that 64 bytes repeat.
constexpr uint64_t max_expansion = 64;
constexpr size_t max_vertex_size = 256;

struct packed_view {
    byte_range data;
    size_t count, stride;
    std::string mode, filter;
};

// tinygltf keeps integers of extensions in 32 bits.
size_t size_get(const tinygltf::Value &object, const char *name, const std::string &what)
{
    const double size = object.Has(name) ? object.Get(name).GetNumberAsDouble() : 0;
    if (size < 0)
        fail("%s.%s is larger than 2 GiB", what.c_str(), name);
    return static_cast<size_t>(size);
}

packed_view packed_view_read(importer &in, const tinygltf::Value &from, const std::string &what)
{
    const int buffer = from.Get("buffer").GetNumberAsInt();
    packed_view view = { { nullptr, 0 },
                         size_get(from, "count", what),
                         size_get(from, "byteStride", what),
                         from.Get("mode").Get<std::string>(),
                         "NONE" };
    if (from.Has("filter"))
        view.filter = from.Get("filter").Get<std::string>();
    if (static_cast<size_t>(buffer) >= in.model.buffers.size())
        fail("%s: buffer %d is out of range, there are %zu", what.c_str(), buffer, in.model.buffers.size());
    const bytes &data = in.model.buffers[static_cast<size_t>(buffer)].data;
    const size_t offset = size_get(from, "byteOffset", what), size = size_get(from, "byteLength", what);
    if (offset > data.size() || size > data.size() - offset)
        fail("%s: bytes %zu + %zu are outside of the buffer's %zu", what.c_str(), offset, size, data.size());
    view.data = { data.data() + offset, size };
    return view;
}

struct filter_row {
    const char *name;
    void (*run)(void *data, size_t count, size_t stride);
    size_t stride_step, stride_most;
};

const filter_row filters[] = {
    { "NONE", nullptr, 1, max_vertex_size },
    { "OCTAHEDRAL", meshopt_decodeFilterOct, 4, 8 },
    { "QUATERNION", meshopt_decodeFilterQuat, 8, 8 },
    { "EXPONENTIAL", meshopt_decodeFilterExp, 4, max_vertex_size },
};

const filter_row &filter_find(const packed_view &view, const std::string &what)
{
    for (const filter_row &row : filters) {
        if (view.filter != row.name)
            continue;
        if (view.stride % row.stride_step != 0 || view.stride > row.stride_most)
            fail("%s: the filter %s has no stride of %zu bytes", what.c_str(), row.name, view.stride);
        return row;
    }
    fail("%s: the filter '%.40s' is unknown", what.c_str(), view.filter.c_str());
}

int vertices_decode(const packed_view &view, bytes &out, const std::string &what)
{
    if (view.stride == 0 || view.stride % 4 != 0 || view.stride > max_vertex_size)
        fail("%s: a stride of %zu bytes, expected a multiple of 4 up to %zu", what.c_str(), view.stride,
             max_vertex_size);
    const filter_row &filter = filter_find(view, what);
    const int result =
        meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, view.data.data, view.data.size);
    if (result == 0 && filter.run != nullptr)
        filter.run(out.data(), view.count, view.stride);
    return result;
}

int indices_decode(const packed_view &view, bytes &out, const std::string &what)
{
    const bool are_triangles = view.mode == "TRIANGLES";
    if (!are_triangles && view.mode != "INDICES")
        fail("%s: the mode '%.40s' is unknown", what.c_str(), view.mode.c_str());
    if (view.stride != 2 && view.stride != 4)
        fail("%s: a stride of %zu bytes, indices have 2 or 4", what.c_str(), view.stride);
    if (view.filter != "NONE" || (are_triangles && view.count % 3 != 0))
        fail("%s: %zu indices with the filter '%.40s'", what.c_str(), view.count, view.filter.c_str());
    if (are_triangles)
        return meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, view.data.data, view.data.size);
    return meshopt_decodeIndexSequence(out.data(), view.count, view.stride, view.data.data, view.data.size);
}

bytes view_decode(importer &in, const packed_view &view, const std::string &what)
{
    if (view.stride > max_vertex_size || view.count > max_file_size / std::max<size_t>(view.stride, 1) ||
        view.count * view.stride / max_expansion > view.data.size)
        fail("%s: %zu bytes are too few for %zu elements of %zu", what.c_str(), view.data.size, view.count,
             view.stride);
    bound_take(in, in.unpacked_bytes, view.count * view.stride, unpacked_bound, what);
    bytes out(view.count * view.stride);
    const int result =
        view.mode == "ATTRIBUTES" ? vertices_decode(view, out, what) : indices_decode(view, out, what);
    if (result != 0)
        fail("%s: the compressed data is broken", what.c_str());
    return out;
}

} // namespace

void meshopt_unpack(importer &in)
{
    for (size_t i = 0; i < in.model.bufferViews.size(); i++) {
        const auto found = in.model.bufferViews[i].extensions.find(meshopt_extension);
        if (found == in.model.bufferViews[i].extensions.end())
            continue;
        const std::string what = label("bufferViews", i) + "." + meshopt_extension;
        const packed_view packed = packed_view_read(in, found->second, what);
        tinygltf::Buffer buffer;
        buffer.data = view_decode(in, packed, what);
        tinygltf::BufferView &view = in.model.bufferViews[i];
        view.buffer = static_cast<int>(in.model.buffers.size());
        view.byteOffset = 0;
        view.byteLength = buffer.data.size();
        view.byteStride = packed.mode == "ATTRIBUTES" ? packed.stride : 0;
        in.model.buffers.push_back(std::move(buffer));
    }
}

} // namespace gltf
