// SPDX-License-Identifier: MIT
//
// KHR_draco_mesh_compression through Google's library. A stream says how many faces, vertices and attributes
// it holds before it holds them, and the library believes it: a few bytes could ask for gigabytes. The two
// decoders below stop it where those numbers are known and nothing has been allocated for them yet.
#include "import.h"

#include <algorithm>
#include <cstring>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#pragma GCC diagnostic pop

namespace gltf
{

namespace
{

// glTF's extension is defined for this version of the stream.
constexpr int stream_major = 2, stream_minor = 2;
// glTF names no attribute of more components, and the encoders that are about write up to ten attributes.
constexpr int max_components = 4, max_attributes = 32;

struct mesh_size {
    uint32_t faces = 0, vertices = 0, attributes = 0;
};

// What is still allowed, and what was wrong: nothing is thrown through the library.
struct watch {
    importer &in;
    const std::string &what;
    std::string error;
};

void size_check(watch &w, const mesh_size &size)
{
    uint64_t vertices = w.in.vertices, indices = w.in.indices;
    bound_take(w.in, vertices, size.vertices, packed_vertex_bound, w.what);
    bound_take(w.in, indices, UINT64_C(3) * size.faces, packed_index_bound, w.what);
    if (size.attributes > max_attributes)
        fail("%s: %u attributes in the Draco data, the limit is %d", w.what.c_str(), size.attributes,
             max_attributes);
}

template <typename check> bool watched(watch &w, check &&run)
{
    try {
        run();
    } catch (const bad_file &problem) {
        w.error = problem.what();
    }
    return w.error.empty();
}

bool sequential_size(draco::DecoderBuffer in, mesh_size &size)
{
    return draco::DecodeVarint(&size.faces, &in) && draco::DecodeVarint(&size.vertices, &in);
}

bool edgebreaker_size(draco::DecoderBuffer in, mesh_size &size)
{
    uint8_t attributes = 0;
    uint32_t symbols = 0, splits = 0;
    if (!draco::DecodeVarint(&size.vertices, &in) || !draco::DecodeVarint(&size.faces, &in) ||
        !in.Decode(&attributes) || !draco::DecodeVarint(&symbols, &in) || !draco::DecodeVarint(&splits, &in))
        return false;
    size.attributes = attributes;
    // Each split makes one vertex more for a while, and takes a symbol.
    if (splits > symbols || symbols > size.faces)
        return false;
    size.vertices += std::min(splits, UINT32_MAX - size.vertices);
    return size.vertices <= UINT64_C(3) * size.faces + splits;
}

// The points that the connectivity has, times what each of them holds.
void attributes_check(watch &w, const draco::PointCloud &cloud)
{
    mesh_size size;
    uint64_t components = 0;
    size.vertices = cloud.num_points();
    size.attributes = static_cast<uint32_t>(cloud.num_attributes());
    size_check(w, size);
    for (int i = 0; i < cloud.num_attributes(); i++) {
        if (cloud.attribute(i)->num_components() > max_components)
            fail("%s: an attribute of the Draco data has %d components", w.what.c_str(),
                 cloud.attribute(i)->num_components());
        components += cloud.attribute(i)->num_components();
    }
    bound_take(w.in, w.in.packed_values, components * size.vertices, packed_value_bound, w.what);
}

template <typename base, bool (*size_read)(draco::DecoderBuffer, mesh_size &)>
class bounded_decoder : public base
{
  public:
    explicit bounded_decoder(watch &watched_by) : guard(watched_by)
    {
    }

  protected:
    bool DecodeConnectivity() override
    {
        mesh_size size;
        return size_read(*this->buffer(), size) && watched(guard, [&] { size_check(guard, size); }) &&
               base::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override
    {
        return watched(guard, [&] { attributes_check(guard, *this->point_cloud()); }) &&
               base::DecodeAllAttributes();
    }

  private:
    watch &guard;
};

using sequential = bounded_decoder<draco::MeshSequentialDecoder, sequential_size>;
using edgebreaker = bounded_decoder<draco::MeshEdgebreakerDecoder, edgebreaker_size>;

std::unique_ptr<draco::MeshDecoder> decoder_make(watch &w, draco::DecoderBuffer start)
{
    draco::DracoHeader header;
    const char *const what = w.what.c_str();
    if (!draco::PointCloudDecoder::DecodeHeader(&start, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH)
        fail("%s: the data is not a mesh compressed by Draco", what);
    if (header.version_major != stream_major || header.version_minor != stream_minor)
        fail("%s: the Draco data has version %d.%d, expected %d.%d", what, header.version_major,
             header.version_minor, stream_major, stream_minor);
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
        return std::make_unique<edgebreaker>(w);
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
        return std::make_unique<sequential>(w);
    fail("%s: the Draco data is encoded by a method %d that is unknown", what, header.encoder_method);
}

void mesh_decode(importer &in, const byte_range &data, const std::string &what, draco::Mesh &mesh)
{
    watch w = { in, what, "" };
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(data.data), data.size);
    const std::unique_ptr<draco::MeshDecoder> decoder = decoder_make(w, buffer);
    const draco::DecoderOptions options;
    const draco::Status status = decoder->Decode(options, &buffer, &mesh);
    if (!w.error.empty())
        throw bad_file(w.error);
    if (!status.ok())
        fail("%s: the Draco data is broken%s%.200s", what.c_str(),
             status.error_msg_string().empty() ? "" : ": ", status.error_msg());
}

template <typename T>
void values_copy(const draco::Mesh &mesh, const draco::PointAttribute &from, int components, bytes &out,
                 const std::string &what)
{
    const size_t size = static_cast<size_t>(components) * sizeof(T);
    out.resize(mesh.num_points() * size);
    T values[max_components];
    for (uint32_t i = 0; i < mesh.num_points(); i++) {
        const draco::AttributeValueIndex index = from.mapped_index(draco::PointIndex(i));
        if (index.value() >= from.size() ||
            !from.ConvertValue<T>(index, static_cast<int8_t>(components), values))
            fail("%s: the Draco data of point %u does not fit the accessor", what.c_str(), i);
        memcpy(&out[i * size], values, size);
    }
}

void attribute_copy(const draco::Mesh &mesh, const draco::PointAttribute &from, const tinygltf::Accessor &to,
                    bytes &out, const std::string &what)
{
    const int components = accessor_components(to);
    if (components < 1 || components > max_components)
        fail("%s: the accessor is a matrix", what.c_str());
    switch (to.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return values_copy<int8_t>(mesh, from, components, out, what);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return values_copy<uint8_t>(mesh, from, components, out, what);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return values_copy<int16_t>(mesh, from, components, out, what);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return values_copy<uint16_t>(mesh, from, components, out, what);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return values_copy<uint32_t>(mesh, from, components, out, what);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return values_copy<float>(mesh, from, components, out, what);
    }
    fail("%s: component type %d is not one of glTF's", what.c_str(), to.componentType);
}

// A new accessor like `from` whose elements are `data`; its number.
int accessor_append(tinygltf::Model &model, tinygltf::Accessor from, bytes &data, size_t count)
{
    tinygltf::Buffer buffer;
    tinygltf::BufferView view;
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteLength = data.size();
    from.bufferView = static_cast<int>(model.bufferViews.size());
    from.byteOffset = 0;
    from.count = count;
    buffer.data.swap(data);
    model.buffers.push_back(std::move(buffer));
    model.bufferViews.push_back(view);
    model.accessors.push_back(from);
    return static_cast<int>(model.accessors.size()) - 1;
}

void indices_append(importer &in, const draco::Mesh &mesh, tinygltf::Primitive &to)
{
    bytes data(mesh.num_faces() * sizeof(draco::Mesh::Face));
    static_assert(sizeof(draco::Mesh::Face) == 3 * sizeof(uint32_t), "three indices of 32 bits");
    for (uint32_t i = 0; i < mesh.num_faces(); i++)
        memcpy(&data[i * sizeof(draco::Mesh::Face)], mesh.face(draco::FaceIndex(i)).data(),
               sizeof(draco::Mesh::Face));
    tinygltf::Accessor indices;
    indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    indices.type = TINYGLTF_TYPE_SCALAR;
    to.indices = accessor_append(in.model, indices, data, size_t{ 3 } * mesh.num_faces());
    to.mode = TINYGLTF_MODE_TRIANGLES;
}

void attribute_append(importer &in, const draco::Mesh &mesh, int unique_id, int &accessor,
                      const std::string &what)
{
    const draco::PointAttribute *const from = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(unique_id));
    if (from == nullptr)
        fail("%s: the Draco data has no attribute %d", what.c_str(), unique_id);
    const tinygltf::Accessor to = accessor_get(in.model, accessor, what);
    bytes data;
    attribute_copy(mesh, *from, to, data, what);
    accessor = accessor_append(in.model, to, data, mesh.num_points());
}

} // namespace

void draco_unpack(importer &in, tinygltf::Primitive &primitive, const std::string &what)
{
    const tinygltf::Value &packed = primitive.extensions.at(draco_extension);
    const tinygltf::Value &attributes = packed.Get("attributes");
    draco::Mesh mesh;
    mesh_decode(in, buffer_view_bytes(in.model, packed.Get("bufferView").GetNumberAsInt(), what), what, mesh);
    for (const std::string &name : attributes.Keys()) {
        const auto known = primitive.attributes.find(name);
        if (known == primitive.attributes.end())
            fail("%s: the Draco data has %.40s, and the primitive has not", what.c_str(), name.c_str());
        attribute_append(in, mesh, attributes.Get(name).GetNumberAsInt(), known->second, what + "." + name);
    }
    indices_append(in, mesh, primitive);
}

} // namespace gltf
