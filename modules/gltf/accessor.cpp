// SPDX-License-Identifier: MIT
//
// Reading accessors: every range is checked against the view and the view against the buffer, in 64 bits and
// by subtraction, so that no offset, count or stride of a file can wrap around.
#include "import.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gltf
{

namespace
{

// Elements of one accessor, or of its sparse part; `first` is null where the elements are all zero.
struct element_range {
    const unsigned char *first = nullptr;
    size_t stride = 0;
};

size_t component_size(int type, const std::string &user)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    }
    fail("%s: component type %d is not one of glTF's", user.c_str(), type);
}

template <typename T> T load(const unsigned char *p)
{
    T value;
    memcpy(&value, p, sizeof value);
    return value;
}

double component_load(const unsigned char *p, int type)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return load<int8_t>(p);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return *p;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return load<int16_t>(p);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load<uint16_t>(p);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return load<uint32_t>(p);
    default:
        return static_cast<double>(load<float>(p));
    }
}

// What an integer component is divided by to be normalised, or 1.
double component_scale(int type)
{
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 65535;
    default:
        return 1;
    }
}

struct range_request {
    int view;
    size_t offset, count, element_size;
    bool strided; // the view's stride holds for the accessor's own elements, not for its sparse part
};

element_range range_get(const tinygltf::Model &model, const range_request &want, const std::string &user)
{
    const byte_range view = buffer_view_bytes(model, want.view, user);
    const size_t view_stride = model.bufferViews[static_cast<size_t>(want.view)].byteStride;
    element_range range;
    range.first = view.data;
    range.stride = want.strided && view_stride != 0 ? view_stride : want.element_size;
    if (range.stride < want.element_size)
        fail("%s: a stride of %zu bytes is less than an element's %zu", user.c_str(), range.stride,
             want.element_size);
    if (want.count == 0)
        return range;
    if (want.offset > view.size || want.element_size > view.size - want.offset ||
        want.count - 1 > (view.size - want.offset - want.element_size) / range.stride)
        fail("%s: %zu elements from byte %zu on do not fit in the view's %zu bytes", user.c_str(), want.count,
             want.offset, view.size);
    range.first += want.offset;
    return range;
}

// The accessor's elements before sparse replacement, as doubles of the stored numbers.
void dense_read(const tinygltf::Model &model, const tinygltf::Accessor &a, const std::string &user,
                std::vector<double> &out)
{
    const size_t components = static_cast<size_t>(accessor_components(a));
    const size_t size = component_size(a.componentType, user);
    if (a.bufferView < 0) {
        out.assign(a.count * components, 0.0);
        return;
    }
    const element_range range =
        range_get(model, { a.bufferView, a.byteOffset, a.count, components * size, true }, user);
    out.resize(a.count * components);
    for (size_t i = 0; i < a.count; i++)
        for (size_t c = 0; c < components; c++)
            out[i * components + c] =
                component_load(range.first + i * range.stride + c * size, a.componentType);
}

void sparse_apply(const tinygltf::Model &model, const tinygltf::Accessor &a, const std::string &user,
                  std::vector<double> &out)
{
    const size_t components = static_cast<size_t>(accessor_components(a));
    const size_t size = component_size(a.componentType, user);
    const auto &sparse = a.sparse;
    const size_t count = static_cast<size_t>(sparse.count);
    const int index_type = sparse.indices.componentType;
    const size_t index_size = component_size(index_type, user);
    const element_range indices =
        range_get(model,
                  { sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset), count,
                    index_size, false },
                  user + " (sparse indices)");
    const element_range values =
        range_get(model,
                  { sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset), count,
                    components * size, false },
                  user + " (sparse values)");
    for (size_t i = 0; i < count; i++) {
        const double index = component_load(indices.first + i * indices.stride, index_type);
        if (!(index >= 0 && index < static_cast<double>(a.count)))
            fail("%s: sparse index %.0f is out of range, there are %zu elements", user.c_str(), index,
                 a.count);
        for (size_t c = 0; c < components; c++)
            out[static_cast<size_t>(index) * components + c] =
                component_load(values.first + i * values.stride + c * size, a.componentType);
    }
}

std::vector<double> accessor_read(const tinygltf::Model &model, const tinygltf::Accessor &a,
                                  const std::string &user)
{
    std::vector<double> out;
    dense_read(model, a, user, out);
    if (a.sparse.isSparse)
        sparse_apply(model, a, user, out);
    return out;
}

} // namespace

byte_range buffer_view_bytes(const tinygltf::Model &model, int view, const std::string &user)
{
    if (view < 0 || static_cast<size_t>(view) >= model.bufferViews.size())
        fail("%s: buffer view %d is out of range, there are %zu", user.c_str(), view,
             model.bufferViews.size());
    const tinygltf::BufferView &v = model.bufferViews[static_cast<size_t>(view)];
    if (v.buffer < 0 || static_cast<size_t>(v.buffer) >= model.buffers.size())
        fail("bufferViews[%d]: buffer %d is out of range, there are %zu", view, v.buffer,
             model.buffers.size());
    const bytes &data = model.buffers[static_cast<size_t>(v.buffer)].data;
    if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
        fail("bufferViews[%d]: bytes %zu + %zu are outside of the buffer's %zu", view, v.byteOffset,
             v.byteLength, data.size());
    return { data.data() + v.byteOffset, v.byteLength };
}

const tinygltf::Accessor &accessor_get(const tinygltf::Model &model, int index, const std::string &user)
{
    if (index < 0 || static_cast<size_t>(index) >= model.accessors.size())
        fail("%s: accessor %d is out of range, there are %zu", user.c_str(), index, model.accessors.size());
    return model.accessors[static_cast<size_t>(index)];
}

int accessor_components(const tinygltf::Accessor &accessor)
{
    switch (accessor.type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    case TINYGLTF_TYPE_MAT4:
        return 16;
    default:
        return 0; // smaller matrices: nothing has them
    }
}

std::vector<float> accessor_read_floats(const tinygltf::Model &model, int index, const std::string &user,
                                        bool integers_are_normalized)
{
    const tinygltf::Accessor &a = accessor_get(model, index, user);
    if (a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        fail("%s: 32-bit integers are not allowed in attributes", user.c_str());
    const std::vector<double> numbers = accessor_read(model, a, user);
    const bool normalized = a.normalized || integers_are_normalized;
    const double scale = normalized ? component_scale(a.componentType) : 1.0;
    // The most negative integer stands for -1 as well (glTF 2.0, 3.6.2.2); floats pass through, not-a-number
    // included, for the caller to judge.
    const bool is_signed = normalized && scale != 1.0;
    std::vector<float> out(numbers.size());
    std::transform(numbers.begin(), numbers.end(), out.begin(), [scale, is_signed](double number) {
        return static_cast<float>(is_signed ? std::max(number / scale, -1.0) : number);
    });
    return out;
}

std::vector<uint32_t> accessor_read_indices(const tinygltf::Model &model, int index, const std::string &user)
{
    const tinygltf::Accessor &a = accessor_get(model, index, user);
    const bool is_unsigned = a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!is_unsigned || a.type != TINYGLTF_TYPE_SCALAR)
        fail("%s: indices must be unsigned integer scalars", user.c_str());
    const std::vector<double> numbers = accessor_read(model, a, user);
    return std::vector<uint32_t>(numbers.begin(), numbers.end());
}

} // namespace gltf
