// SPDX-License-Identifier: MIT
//
// Strips and fans to triangle lists, and vertices that belong to one triangle each.
#include "import.h"

#include <algorithm>

namespace gltf
{

namespace
{

// Degenerate triangles, which join strips, are left out.
void triangle_add(std::vector<uint32_t> &out, uint32_t a, uint32_t b, uint32_t c)
{
    if (a == b || b == c || c == a)
        return;
    out.insert(out.end(), { a, b, c });
}

void gather(std::vector<float> &values, size_t components, const std::vector<uint32_t> &order)
{
    if (values.empty())
        return;
    std::vector<float> out(order.size() * components);
    for (size_t i = 0; i < order.size(); i++)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(order[i] * components), components,
                    out.begin() + static_cast<std::ptrdiff_t>(i * components));
    values.swap(out);
}

} // namespace

// Corner order keeps the front face in front (glTF 2.0, 3.7.2.1): every other triangle of a strip turns.
std::vector<uint32_t> triangles_from(int mode, const std::vector<uint32_t> &order)
{
    std::vector<uint32_t> out;
    const size_t n = order.size();
    if (mode == TINYGLTF_MODE_TRIANGLES)
        for (size_t i = 0; i + 2 < n; i += 3)
            triangle_add(out, order[i], order[i + 1], order[i + 2]);
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        for (size_t i = 0; i + 2 < n; i++)
            triangle_add(out, order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]);
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        for (size_t i = 1; i + 1 < n; i++)
            triangle_add(out, order[0], order[i], order[i + 1]);
    return out;
}

void vertices_unshare(geometry &g)
{
    gather(g.positions, 3, g.indices);
    gather(g.normals, 3, g.indices);
    gather(g.tangents, 4, g.indices);
    gather(g.uv0, 2, g.indices);
    gather(g.uv1, 2, g.indices);
    gather(g.colors, 4, g.indices);
    for (influence_set &set : g.influences) {
        gather(set.joints, 4, g.indices);
        gather(set.weights, 4, g.indices);
    }
    for (morph_target &target : g.targets)
        gather(target.positions, 3, g.indices);
    g.vertex_count = static_cast<uint32_t>(g.indices.size());
    for (uint32_t i = 0; i < g.vertex_count; i++)
        g.indices[i] = i;
}

} // namespace gltf
