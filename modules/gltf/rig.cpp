// SPDX-License-Identifier: MIT
//
// Vertices that morph targets and joints move: targets first, then joints (glTF 2.0, 3.7.2.2 and 3.7.3.3).
#include "import.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gltf
{

namespace
{

void differences_add(std::vector<float> &values, size_t stride, const std::vector<float> &differences,
                     double weight)
{
    for (size_t i = 0; i < differences.size() / 3; i++)
        for (size_t k = 0; k < 3; k++)
            values[stride * i + k] +=
                static_cast<float>(weight * static_cast<double>(differences[3 * i + k]));
}

void morph(geometry &g, const std::vector<morph_target> &targets, const std::vector<double> &weights)
{
    for (size_t i = 0; i < std::min(targets.size(), weights.size()); i++) {
        const double weight = weights[i];
        if (weight == 0)
            continue;
        differences_add(g.positions, 3, targets[i].positions, weight);
        differences_add(g.normals, 3, targets[i].normals, weight);
        differences_add(g.tangents, 4, targets[i].tangents, weight);
    }
}

// The upper three rows of a matrix, and what turns normals with it.
struct blend {
    double m[12]; // by columns, of three
    double normal[9];
    double sign; // of the determinant
};

double cofactor(const double *m, size_t row, size_t column)
{
    const size_t r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return m[3 * c1 + r1] * m[3 * c2 + r2] - m[3 * c2 + r1] * m[3 * c1 + r2];
}

// Normals turn by the inverse transpose, which is the cofactors but for a positive factor.
void normal_complete(blend &b)
{
    const double determinant =
        b.m[0] * cofactor(b.m, 0, 0) + b.m[3] * cofactor(b.m, 0, 1) + b.m[6] * cofactor(b.m, 0, 2);
    b.sign = determinant < 0 ? -1 : 1;
    for (size_t column = 0; column < 3; column++)
        for (size_t row = 0; row < 3; row++)
            b.normal[3 * column + row] = b.sign * cofactor(b.m, row, column);
}

void joint_add(blend &b, const std::vector<matrix4> &joints, float joint, double weight, size_t vertex,
               const std::string &what)
{
    if (!(joint >= 0 && joint < static_cast<float>(joints.size())))
        fail("%s: vertex %zu has joint %.0f, and the skin has %zu", what.c_str(), vertex,
             static_cast<double>(joint), joints.size());
    const matrix4 &from = joints[static_cast<size_t>(joint)];
    for (size_t column = 0; column < 4; column++)
        for (size_t row = 0; row < 3; row++)
            b.m[3 * column + row] += weight * from.m[4 * column + row];
}

// A vertex without a weight follows its first joint.
blend blend_make(const geometry &g, const std::vector<matrix4> &joints, size_t vertex,
                 const std::string &what)
{
    blend b = {};
    double sum = 0;
    for (const influence_set &set : g.influences)
        for (size_t k = 0; k < 4; k++)
            sum += static_cast<double>(set.weights[4 * vertex + k]);
    for (const influence_set &set : g.influences)
        for (size_t k = 0; k < 4 && sum > 0; k++) {
            const double weight = static_cast<double>(set.weights[4 * vertex + k]);
            if (weight > 0)
                joint_add(b, joints, set.joints[4 * vertex + k], weight / sum, vertex, what);
        }
    if (!(sum > 0))
        joint_add(b, joints, g.influences[0].joints[4 * vertex], 1, vertex, what);
    normal_complete(b);
    return b;
}

void turn(const double *m, const float *from, float *to)
{
    double out[3];
    for (size_t row = 0; row < 3; row++)
        out[row] = m[row] * static_cast<double>(from[0]) + m[3 + row] * static_cast<double>(from[1]) +
                   m[6 + row] * static_cast<double>(from[2]);
    const double largest = std::max({ std::fabs(out[0]), std::fabs(out[1]), std::fabs(out[2]) });
    for (size_t row = 0; row < 3; row++)
        to[row] = static_cast<float>(largest > 0 ? out[row] / largest : 0);
}

void vertex_skin(geometry &g, const blend &b, size_t i)
{
    const float p[3] = { g.positions[3 * i], g.positions[3 * i + 1], g.positions[3 * i + 2] };
    for (size_t row = 0; row < 3; row++)
        g.positions[3 * i + row] = static_cast<float>(
            b.m[row] * static_cast<double>(p[0]) + b.m[3 + row] * static_cast<double>(p[1]) +
            b.m[6 + row] * static_cast<double>(p[2]) + b.m[9 + row]);
    turn(b.normal, &g.normals[3 * i], &g.normals[3 * i]);
    turn(b.m, &g.tangents[4 * i], &g.tangents[4 * i]);
    g.tangents[4 * i + 3] *= static_cast<float>(b.sign);
}

// Joints that mirror turn the triangles' backs to the front.
void winding_reverse(geometry &g)
{
    for (size_t i = 0; i + 2 < g.indices.size(); i += 3)
        std::swap(g.indices[i + 1], g.indices[i + 2]);
}

void geometry_skin(geometry &g, const std::vector<matrix4> &joints, const std::string &what)
{
    size_t mirrored = 0;
    for (size_t i = 0; i < g.vertex_count; i++) {
        const blend b = blend_make(g, joints, i, what);
        vertex_skin(g, b, i);
        mirrored += b.sign < 0;
    }
    if (2 * mirrored > g.vertex_count)
        winding_reverse(g);
}

// Without the tables that moved it.
geometry shape_copy(const geometry &rest)
{
    geometry g;
    g.vertex_count = rest.vertex_count;
    g.positions = rest.positions;
    g.normals = rest.normals;
    g.tangents = rest.tangents;
    g.uv0 = rest.uv0;
    g.uv1 = rest.uv1;
    g.colors = rest.colors;
    g.indices = rest.indices;
    g.is_flat = rest.is_flat;
    return g;
}

void shape_check(const geometry &g, const std::string &what)
{
    for (size_t i = 0; i < g.positions.size(); i++)
        if (!std::isfinite(g.positions[i]))
            fail("%s: the posed position of vertex %zu is not finite", what.c_str(), i / 3);
}

// The place of the primitive itself, or a new one at the end.
uint32_t place_take(importer &in, uint32_t primitive, rig &from, const std::string &what)
{
    gltf_scene &scene = *in.scene;
    if (!from.is_placed) {
        from.is_placed = true;
        gltf_primitive &old = scene.primitives[primitive];
        const int32_t material = old.material;
        primitive_free(old);
        old = {};
        old.material = material;
        return primitive;
    }
    bound_take(in, in.vertices, from.rest.vertex_count, vertex_bound, what);
    bound_take(in, in.indices, from.rest.indices.size(), index_bound, what);
    if (scene.primitive_count == in.primitive_capacity) {
        const size_t capacity = 2 * in.primitive_capacity;
        void *const grown = realloc(scene.primitives, capacity * sizeof *scene.primitives);
        if (grown == nullptr)
            throw std::bad_alloc();
        scene.primitives = static_cast<gltf_primitive *>(grown);
        in.primitive_capacity = capacity;
    }
    gltf_primitive &added = scene.primitives[scene.primitive_count];
    added = {};
    added.material = scene.primitives[primitive].material;
    return scene.primitive_count++;
}

} // namespace

uint32_t rig_pose(importer &in, uint32_t primitive, const std::vector<double> &weights,
                  const std::vector<matrix4> &joints, const std::string &what)
{
    rig &from = in.rigs.at(primitive);
    geometry g = shape_copy(from.rest);
    morph(g, from.rest.targets, weights);
    if (!joints.empty() && !from.rest.influences.empty()) {
        g.influences = from.rest.influences;
        geometry_skin(g, joints, what);
    }
    shape_check(g, what);
    if (g.is_flat)
        normals_make_flat(g);
    else
        normals_repair(g);
    tangents_make(g, in.scene->materials[in.scene->primitives[primitive].material]);
    const uint32_t place = place_take(in, primitive, from, what);
    primitive_store(g, in.scene->primitives[place]);
    return place;
}

} // namespace gltf
