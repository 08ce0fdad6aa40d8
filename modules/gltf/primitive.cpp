// SPDX-License-Identifier: MIT
//
// Meshes: attributes and indices out of their accessors, and everything a primitive lacks made up.
#include "import.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gltf
{

namespace
{

using attribute_map = std::map<std::string, int>;

// The accessor of an attribute, or -1.
int attribute_find(const attribute_map &from, const std::string &name)
{
    const auto found = from.find(name);
    return found == from.end() ? -1 : found->second;
}

struct attribute_request {
    std::string name;
    int least_components, most_components;
    bool integers_are_normalized;
};

// Values of one attribute, widened to `most_components` with ones; empty where the primitive has none.
std::vector<float> attribute_read(const importer &in, const attribute_map &from, size_t vertex_count,
                                  const attribute_request &want, const std::string &what)
{
    const int index = attribute_find(from, want.name);
    if (index < 0)
        return {};
    const std::string user = what + "." + want.name;
    const tinygltf::Accessor &a = accessor_get(in.model, index, user);
    const int components = accessor_components(a);
    if (components < want.least_components || components > want.most_components)
        fail("%s: the accessor's type has %d components", user.c_str(), components);
    if (a.count != vertex_count)
        fail("%s: %zu elements, and there are %zu positions", user.c_str(), a.count, vertex_count);
    std::vector<float> values = accessor_read_floats(in.model, index, user, want.integers_are_normalized);
    if (components == want.most_components)
        return values;
    const size_t narrow = static_cast<size_t>(components), wide = static_cast<size_t>(want.most_components);
    std::vector<float> widened(vertex_count * wide, 1.0f);
    for (size_t i = 0; i < vertex_count; i++)
        std::copy_n(&values[i * narrow], narrow, &widened[i * wide]);
    return widened;
}

void zero_where_not_finite(std::vector<float> &values)
{
    for (float &value : values)
        if (!std::isfinite(value))
            value = 0;
}

// A factor of the base colour like the material's own, with the same range.
void colors_clamp(std::vector<float> &colors)
{
    zero_where_not_finite(colors);
    for (float &value : colors)
        value = std::min(std::max(value, 0.0f), 1.0f);
}

void positions_check(const geometry &g, const std::string &what)
{
    for (size_t i = 0; i < g.positions.size(); i++)
        if (!std::isfinite(g.positions[i]))
            fail("%s: the position of vertex %zu is not finite", what.c_str(), i / 3);
}

void attributes_read(const importer &in, const attribute_map &from, geometry &g, const std::string &what)
{
    const size_t n = g.vertex_count;
    g.positions = attribute_read(in, from, n, { "POSITION", 3, 3, false }, what);
    positions_check(g, what);
    g.normals = attribute_read(in, from, n, { "NORMAL", 3, 3, true }, what);
    // Tangents mean nothing without the normals they were made for (glTF 2.0, 3.7.2.1).
    if (!g.normals.empty())
        g.tangents = attribute_read(in, from, n, { "TANGENT", 4, 4, true }, what);
    g.uv0 = attribute_read(in, from, n, { "TEXCOORD_0", 2, 2, false }, what);
    g.uv1 = attribute_read(in, from, n, { "TEXCOORD_1", 2, 2, false }, what);
    g.colors = attribute_read(in, from, n, { "COLOR_0", 3, 4, true }, what);
    zero_where_not_finite(g.uv0);
    zero_where_not_finite(g.uv1);
    colors_clamp(g.colors);
}

// Joints and weights by fours, of all their sets. Weights that are not finite, or negative, count for
// nothing.
void joints_read(const importer &in, const attribute_map &from, geometry &g, const std::string &what)
{
    constexpr int max_sets = 8;
    const size_t n = g.vertex_count;
    for (int set = 0; set < max_sets; set++) {
        const std::string joints_name = "JOINTS_" + std::to_string(set);
        const std::string weights_name = "WEIGHTS_" + std::to_string(set);
        if (attribute_find(from, joints_name) < 0)
            break;
        influence_set s;
        s.joints = attribute_read(in, from, n, { joints_name, 4, 4, false }, what);
        s.weights = attribute_read(in, from, n, { weights_name, 4, 4, true }, what);
        if (s.weights.empty())
            fail("%s has %s and no %s", what.c_str(), joints_name.c_str(), weights_name.c_str());
        for (float &weight : s.weights)
            weight = weight > 0 && std::isfinite(weight) ? weight : 0;
        g.influences.push_back(std::move(s));
    }
}

// Normals that are made flat are made again, so that their differences mean nothing.
void targets_read(const importer &in, const tinygltf::Primitive &from, geometry &g, const std::string &what)
{
    const size_t n = g.vertex_count;
    for (size_t i = 0; i < from.targets.size(); i++) {
        const std::string user = what + "." + label("targets", i);
        morph_target target;
        target.positions = attribute_read(in, from.targets[i], n, { "POSITION", 3, 3, false }, user);
        if (!g.normals.empty())
            target.normals = attribute_read(in, from.targets[i], n, { "NORMAL", 3, 3, true }, user);
        if (!g.tangents.empty())
            target.tangents = attribute_read(in, from.targets[i], n, { "TANGENT", 3, 3, true }, user);
        zero_where_not_finite(target.positions);
        zero_where_not_finite(target.normals);
        zero_where_not_finite(target.tangents);
        g.targets.push_back(std::move(target));
    }
}

// The vertices in drawing order: the indices, or all of them in turn.
std::vector<uint32_t> order_read(const importer &in, const tinygltf::Primitive &from, uint32_t vertex_count,
                                 const std::string &what)
{
    const std::string user = what + ".indices";
    std::vector<uint32_t> order;
    if (from.indices >= 0) {
        order = accessor_read_indices(in.model, from.indices, user);
    } else {
        order.resize(vertex_count);
        for (uint32_t i = 0; i < vertex_count; i++)
            order[i] = i;
    }
    const auto worst = std::max_element(order.begin(), order.end());
    if (worst != order.end() && *worst >= vertex_count)
        fail("%s: index %u is out of range, there are %u vertices", user.c_str(), *worst, vertex_count);
    return order;
}

int32_t material_of(const importer &in, const tinygltf::Primitive &from, const std::string &what)
{
    if (from.material >= 0 && static_cast<size_t>(from.material) >= in.materials_in_file)
        fail("%s: material %d is out of range, there are %zu", what.c_str(), from.material,
             in.materials_in_file);
    const int appended = static_cast<int>(in.scene->material_count) - 1;
    return from.material < 0 ? appended : from.material;
}

bool second_uv_is_used(const gltf_material &m)
{
    const gltf_texture_ref *const refs[] = { &m.base_color_texture, &m.metallic_roughness_texture,
                                             &m.normal_texture, &m.occlusion_texture, &m.emissive_texture };
    return std::any_of(std::begin(refs), std::end(refs),
                       [](const gltf_texture_ref *ref) { return ref->texture >= 0 && ref->uv_set == 1; });
}

void geometry_complete(geometry &g, const gltf_material &material)
{
    if (g.normals.empty()) {
        g.is_flat = true;
        vertices_unshare(g);
        normals_make_flat(g);
    } else {
        normals_repair(g);
    }
    if (g.uv0.empty())
        g.uv0.assign(2 * static_cast<size_t>(g.vertex_count), 0.0f);
    if (g.uv1.empty() && second_uv_is_used(material))
        g.uv1.assign(2 * static_cast<size_t>(g.vertex_count), 0.0f);
    tangents_make(g, material);
}

void bounds_compute(const geometry &g, gltf_primitive &to)
{
    for (size_t axis = 0; axis < 3; axis++) {
        to.bounds_min[axis] = to.bounds_max[axis] = g.positions[axis];
        for (size_t i = axis; i < g.positions.size(); i += 3) {
            to.bounds_min[axis] = std::min(to.bounds_min[axis], g.positions[i]);
            to.bounds_max[axis] = std::max(to.bounds_max[axis], g.positions[i]);
        }
    }
}

uint64_t vertices_of(const importer &in, const tinygltf::Primitive &from, const std::string &what)
{
    const int position = attribute_find(from.attributes, "POSITION");
    return position < 0 ? 0 : accessor_get(in.model, position, what + ".POSITION").count;
}

bool is_packed(const tinygltf::Primitive &from)
{
    return with_draco && from.extensions.count(draco_extension) != 0;
}

void primitive_count(importer &in, const tinygltf::Primitive &from, const std::string &what)
{
    const bool packed = is_packed(from);
    const bound &vertex_limit = packed ? packed_vertex_bound : vertex_bound;
    const bound &index_limit = packed ? packed_index_bound : index_bound;
    const uint64_t vertices = vertices_of(in, from, what);
    const uint64_t corners =
        from.indices < 0 ? vertices : accessor_get(in.model, from.indices, what + ".indices").count;
    // A strip or fan has as many triangles as corners, but for two.
    const uint64_t unpacked = from.mode == TINYGLTF_MODE_TRIANGLES ? corners : 3 * corners;
    bound_take(in, in.vertices, vertices, vertex_limit, what);
    bound_take(in, in.indices, unpacked, index_limit, what);
    // Flat triangles share no vertices.
    const bool is_flat = attribute_find(from.attributes, "NORMAL") < 0;
    if (is_flat)
        bound_take(in, in.vertices, unpacked, vertex_limit, what);
    for (size_t i = 0; i < from.targets.size(); i++)
        bound_take(in, in.vertices, is_flat ? vertices + unpacked : vertices, vertex_limit, what);
}

// Points, lines and primitives without anything to draw are counted and left out.
bool primitive_is_drawn(importer &in, const tinygltf::Primitive &from, const std::string &what)
{
    if (from.mode < TINYGLTF_MODE_POINTS || from.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        fail("%s: mode %d is not one of glTF's", what.c_str(), from.mode);
    if (from.mode < TINYGLTF_MODE_TRIANGLES) {
        in.omitted.point_and_line_primitives++;
        return false;
    }
    return true;
}

bool primitive_import(importer &in, const tinygltf::Primitive &from, gltf_primitive &to,
                      const std::string &what)
{
    to.material = material_of(in, from, what);
    geometry g;
    g.vertex_count = static_cast<uint32_t>(vertices_of(in, from, what));
    if (g.vertex_count != 0) {
        attributes_read(in, from.attributes, g, what);
        targets_read(in, from, g, what);
        if (in.has_skins)
            joints_read(in, from.attributes, g, what);
        g.indices = triangles_from(from.mode, order_read(in, from, g.vertex_count, what));
    }
    if (g.indices.empty()) {
        in.omitted.empty_primitives++;
        return false;
    }
    geometry_complete(g, in.scene->materials[to.material]);
    const uint32_t index = in.scene->primitive_count++; // before its arrays are made: the scene frees them
    primitive_store(g, to);
    if (!g.targets.empty() || !g.influences.empty())
        in.rigs[index].rest = std::move(g);
    return true;
}

// What Draco compressed is there, uncompressed, for as long as it takes to import it.
bool primitive_unpack_and_import(importer &in, const tinygltf::Primitive &from, gltf_primitive &to,
                                 const std::string &what)
{
    if (!primitive_is_drawn(in, from, what))
        return false;
    if (!is_packed(from))
        return primitive_import(in, from, to, what);
    tinygltf::Model &model = in.model;
    const size_t buffers = model.buffers.size(), views = model.bufferViews.size();
    const size_t accessors = model.accessors.size();
    tinygltf::Primitive unpacked = from;
    if constexpr (with_draco)
        draco_unpack(in, unpacked, what);
    primitive_count(in, unpacked, what);
    const bool imported = primitive_import(in, unpacked, to, what);
    model.buffers.resize(buffers);
    model.bufferViews.resize(views);
    model.accessors.resize(accessors);
    return imported;
}

std::string primitive_label(size_t mesh, size_t primitive)
{
    return label("meshes", mesh) + "." + label("primitives", primitive);
}

// All of them, before the first is read, but for what Draco compressed: its streams know better how much they
// hold.
size_t primitives_count(importer &in)
{
    size_t total = 0;
    for (size_t m = 0; m < in.model.meshes.size(); m++) {
        const std::vector<tinygltf::Primitive> &primitives = in.model.meshes[m].primitives;
        for (size_t p = 0; p < primitives.size(); p++)
            if (primitives[p].mode >= TINYGLTF_MODE_TRIANGLES && !is_packed(primitives[p]))
                primitive_count(in, primitives[p], primitive_label(m, p));
        total += primitives.size();
    }
    return total;
}

} // namespace

// Along the coordinates of the normal map.
void tangents_make(geometry &g, const gltf_material &material)
{
    const bool second = material.normal_texture.texture >= 0 && material.normal_texture.uv_set == 1;
    tangents_complete(g, second ? g.uv1 : g.uv0);
}

void primitive_store(const geometry &g, gltf_primitive &to)
{
    to.positions = array_copy(g.positions);
    to.normals = array_copy(g.normals);
    to.tangents = array_copy(g.tangents);
    to.uv0 = array_copy(g.uv0);
    to.uv1 = array_copy(g.uv1);
    to.colors = array_copy(g.colors);
    to.indices = array_copy(g.indices);
    to.vertex_count = g.vertex_count;
    to.index_count = static_cast<uint32_t>(g.indices.size());
    bounds_compute(g, to);
}

void meshes_import(importer &in)
{
    in.primitive_capacity = primitives_count(in);
    in.scene->primitives = array_allocate<gltf_primitive>(in.primitive_capacity);
    for (size_t m = 0; m < in.model.meshes.size(); m++) {
        const tinygltf::Mesh &mesh = in.model.meshes[m];
        in.mesh_primitives.emplace_back();
        for (size_t p = 0; p < mesh.primitives.size(); p++) {
            const uint32_t next = in.scene->primitive_count;
            const std::string what = primitive_label(m, p);
            if (primitive_unpack_and_import(in, mesh.primitives[p], in.scene->primitives[next], what))
                in.mesh_primitives.back().push_back(next);
        }
    }
}

} // namespace gltf
