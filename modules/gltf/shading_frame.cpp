// SPDX-License-Identifier: MIT
//
// Normals and tangents that the file leaves out or has broken. Sums are in double, so that neither tiny nor
// huge meshes lose their cross products.
#include "import.h"

#include <cmath>

namespace gltf
{

namespace
{

struct vec3 {
    double x, y, z;
};

vec3 operator+(vec3 a, vec3 b)
{
    return { a.x + b.x, a.y + b.y, a.z + b.z };
}

vec3 operator-(vec3 a, vec3 b)
{
    return { a.x - b.x, a.y - b.y, a.z - b.z };
}

vec3 operator*(vec3 a, double s)
{
    return { a.x * s, a.y * s, a.z * s };
}

double dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

vec3 cross(vec3 a, vec3 b)
{
    return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

vec3 vec3_at(const std::vector<float> &values, size_t offset)
{
    return { static_cast<double>(values[offset]), static_cast<double>(values[offset + 1]),
             static_cast<double>(values[offset + 2]) };
}

void vec3_put(std::vector<float> &values, size_t offset, vec3 v)
{
    values[offset] = static_cast<float>(v.x);
    values[offset + 1] = static_cast<float>(v.y);
    values[offset + 2] = static_cast<float>(v.z);
}

// False, and `v` unchanged, for zero and for anything not finite.
bool normalize(vec3 &v)
{
    const double length = std::sqrt(dot(v, v));
    if (!(length > 0) || !std::isfinite(length))
        return false;
    v = v * (1 / length);
    return true;
}

vec3 face_cross(const geometry &g, size_t first_index)
{
    const vec3 a = vec3_at(g.positions, 3 * static_cast<size_t>(g.indices[first_index]));
    const vec3 b = vec3_at(g.positions, 3 * static_cast<size_t>(g.indices[first_index + 1]));
    const vec3 c = vec3_at(g.positions, 3 * static_cast<size_t>(g.indices[first_index + 2]));
    return cross(b - a, c - a);
}

// Any unit vector at right angles to a unit `n`: crossed with the axis that it is farthest from.
vec3 perpendicular(vec3 n)
{
    vec3 t = std::fabs(n.x) < 0.6 ? cross(vec3{ 1, 0, 0 }, n) : cross(vec3{ 0, 1, 0 }, n);
    return normalize(t) ? t : vec3{ 1, 0, 0 };
}

// How position changes with u and v over each vertex's triangles, weighted by area.
struct uv_axes {
    std::vector<vec3> along_u, along_v;
};

void uv_axes_add(uv_axes &axes, const geometry &g, const std::vector<float> &uv, size_t first_index)
{
    const size_t i[3] = { g.indices[first_index], g.indices[first_index + 1], g.indices[first_index + 2] };
    const vec3 origin = vec3_at(g.positions, 3 * i[0]);
    const vec3 e1 = vec3_at(g.positions, 3 * i[1]) - origin, e2 = vec3_at(g.positions, 3 * i[2]) - origin;
    const double u0 = static_cast<double>(uv[2 * i[0]]), v0 = static_cast<double>(uv[2 * i[0] + 1]);
    const double u1 = static_cast<double>(uv[2 * i[1]]) - u0, v1 = static_cast<double>(uv[2 * i[1] + 1]) - v0;
    const double u2 = static_cast<double>(uv[2 * i[2]]) - u0, v2 = static_cast<double>(uv[2 * i[2] + 1]) - v0;
    const double determinant = u1 * v2 - u2 * v1;
    if (determinant == 0 || !std::isfinite(determinant))
        return;
    vec3 u = (e1 * v2 - e2 * v1) * (determinant < 0 ? -1.0 : 1.0);
    vec3 v = (e2 * u1 - e1 * u2) * (determinant < 0 ? -1.0 : 1.0);
    const vec3 face = cross(e1, e2);
    const double area = std::sqrt(dot(face, face));
    if (!normalize(u) || !normalize(v))
        return;
    for (const size_t vertex : i) {
        axes.along_u[vertex] = axes.along_u[vertex] + u * area;
        axes.along_v[vertex] = axes.along_v[vertex] + v * area;
    }
}

uv_axes uv_axes_sum(const geometry &g, const std::vector<float> &uv)
{
    uv_axes axes;
    axes.along_u.assign(g.vertex_count, vec3{ 0, 0, 0 });
    axes.along_v.assign(g.vertex_count, vec3{ 0, 0, 0 });
    for (size_t i = 0; i + 2 < g.indices.size(); i += 3)
        uv_axes_add(axes, g, uv, i);
    return axes;
}

// glTF's normal maps have +Y up on the image, where V falls: the bitangent is against V.
void tangent_make(geometry &g, const uv_axes &axes, size_t vertex)
{
    const vec3 n = vec3_at(g.normals, 3 * vertex);
    const vec3 u = axes.along_u[vertex];
    vec3 t = u - n * dot(n, u);
    float handedness = 1;
    // What is left of an axis along the normal is rounding: no direction is in it.
    const bool is_defined = dot(t, t) > 1e-12 * dot(u, u) && normalize(t);
    if (is_defined)
        handedness = dot(cross(n, t), axes.along_v[vertex]) > 0 ? -1.0f : 1.0f;
    vec3_put(g.tangents, 4 * vertex, is_defined ? t : perpendicular(n));
    g.tangents[4 * vertex + 3] = handedness;
}

// Unit length and a sign, or false.
bool tangent_clean(geometry &g, size_t vertex)
{
    vec3 t = vec3_at(g.tangents, 4 * vertex);
    const float sign = g.tangents[4 * vertex + 3];
    if (!normalize(t) || !std::isfinite(sign))
        return false;
    vec3_put(g.tangents, 4 * vertex, t);
    g.tangents[4 * vertex + 3] = sign < 0 ? -1.0f : 1.0f;
    return true;
}

} // namespace

// Of vertices that no two triangles share.
void normals_make_flat(geometry &g)
{
    g.normals.assign(3 * static_cast<size_t>(g.vertex_count), 0.0f);
    for (size_t i = 0; i + 2 < g.indices.size(); i += 3) {
        vec3 n = face_cross(g, i);
        if (!normalize(n))
            n = { 0, 1, 0 };
        for (size_t k = 0; k < 3; k++)
            vec3_put(g.normals, 3 * static_cast<size_t>(g.indices[i + k]), n);
    }
}

// Unit length for all; zero and not-a-number ones become the mean of their triangles'.
void normals_repair(geometry &g)
{
    std::vector<size_t> broken;
    for (size_t i = 0; i < g.vertex_count; i++) {
        vec3 n = vec3_at(g.normals, 3 * i);
        if (normalize(n))
            vec3_put(g.normals, 3 * i, n);
        else
            broken.push_back(i);
    }
    if (broken.empty())
        return;
    std::vector<vec3> sums(g.vertex_count, vec3{ 0, 0, 0 });
    for (size_t i = 0; i + 2 < g.indices.size(); i += 3)
        for (size_t k = 0; k < 3; k++)
            sums[g.indices[i + k]] = sums[g.indices[i + k]] + face_cross(g, i);
    for (const size_t i : broken)
        vec3_put(g.normals, 3 * i, normalize(sums[i]) ? sums[i] : vec3{ 0, 1, 0 });
}

void tangents_complete(geometry &g, const std::vector<float> &uv)
{
    std::vector<size_t> broken;
    g.tangents.resize(4 * static_cast<size_t>(g.vertex_count), 0.0f);
    for (size_t i = 0; i < g.vertex_count; i++)
        if (!tangent_clean(g, i))
            broken.push_back(i);
    if (broken.empty())
        return;
    const uv_axes axes = uv_axes_sum(g, uv);
    for (const size_t i : broken)
        tangent_make(g, axes, i);
}

} // namespace gltf
