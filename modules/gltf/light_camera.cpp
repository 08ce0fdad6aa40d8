// SPDX-License-Identifier: MIT
//
// Lights (KHR_lights_punctual) and cameras. Both look along their node's -Z, and neither is scaled by it.
#include "import.h"

#include <algorithm>
#include <cmath>

namespace gltf
{

namespace
{

constexpr double pi = 3.14159265358979323846;

// As for emission: above any light, far from the largest float.
constexpr double max_intensity = 1e30;

// Metres, of orthographic cameras.
constexpr double least_size = 1e-6, most_size = 1e9;

float clamp_to(double value, double least, double most)
{
    return static_cast<float>(std::min(std::max(value, least), most));
}

struct axis {
    double v[3];
};

axis column(const matrix4 &world, size_t c)
{
    return { { world.m[4 * c], world.m[4 * c + 1], world.m[4 * c + 2] } };
}

double dot(const axis &a, const axis &b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

// Scaled by its largest part first: the squares of a huge or tiny scale would leave the range of double.
bool normalize(axis &a)
{
    const double largest = std::max({ std::fabs(a.v[0]), std::fabs(a.v[1]), std::fabs(a.v[2]) });
    if (!(largest > 0))
        return false;
    for (double &v : a.v)
        v /= largest;
    const double length = std::sqrt(dot(a, a));
    for (double &v : a.v)
        v /= length;
    return true;
}

axis cross(const axis &a, const axis &b)
{
    return { { a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
               a.v[0] * b.v[1] - a.v[1] * b.v[0] } };
}

gltf_light_type light_type_from(const std::string &name, const std::string &what)
{
    if (name == "directional")
        return GLTF_LIGHT_DIRECTIONAL;
    if (name == "point")
        return GLTF_LIGHT_POINT;
    if (name != "spot")
        fail("%s: the type '%.40s' is unknown", what.c_str(), name.c_str());
    return GLTF_LIGHT_SPOT;
}

// Exporters write equal angles for a hard edge; the inner one gives way so that the two always differ.
void cone_import(const tinygltf::SpotLight &from, gltf_light &to)
{
    constexpr double least_angle = 1e-3; // 0.06 degrees
    const float half_pi = std::nextafter(static_cast<float>(pi / 2), 0.0f);
    to.outer_rad = std::min(clamp_to(from.outerConeAngle, least_angle, pi / 2), half_pi);
    to.inner_rad = clamp_to(from.innerConeAngle, 0, static_cast<double>(to.outer_rad) * 0.999);
}

// Magnifications may be negative, to mirror a picture: cameras here do not mirror.
void orthographic_import(const tinygltf::OrthographicCamera &from, gltf_camera &to, const std::string &what)
{
    to.ymag = clamp_to(std::fabs(from.ymag), least_size, most_size);
    to.znear = clamp_to(from.znear, 0, most_size);
    to.zfar = clamp_to(from.zfar, 0, most_size);
    if (!(to.zfar > to.znear))
        fail("%s: zfar must be greater than znear", what.c_str());
}

// The node's axes without scale and shear, right-handed; the identity where the node has collapsed.
void camera_frame(const matrix4 &world, double out[16])
{
    axis x = column(world, 0), z = column(world, 2);
    bool whole = normalize(z) && normalize(x);
    const double along = dot(x, z);
    for (size_t i = 0; i < 3; i++)
        x.v[i] -= along * z.v[i];
    whole = whole && std::fabs(along) < 1 - 1e-9 && normalize(x);
    if (!whole) {
        x = { { 1, 0, 0 } };
        z = { { 0, 0, 1 } };
    }
    const axis y = cross(z, x);
    for (size_t i = 0; i < 3; i++) {
        out[i] = x.v[i];
        out[4 + i] = y.v[i];
        out[8 + i] = z.v[i];
        out[12 + i] = world.m[12 + i];
    }
    out[15] = 1;
}

} // namespace

void light_import(importer &in, std::vector<gltf_light> &lights, int index, const matrix4 &world)
{
    const std::string what = label("lights", static_cast<size_t>(index));
    if (index < 0 || static_cast<size_t>(index) >= in.model.lights.size())
        fail("light %d is out of range, there are %zu", index, in.model.lights.size());
    const tinygltf::Light &from = in.model.lights[static_cast<size_t>(index)];
    gltf_light to = {};
    axis back = column(world, 2);
    if (!normalize(back))
        back = { { 0, 0, 1 } };
    to.type = light_type_from(from.type, what);
    for (size_t i = 0; i < 3; i++) {
        const double color = from.color.size() == 3 ? from.color[i] : 1.0;
        to.position[i] = world.m[12 + i];
        to.direction[i] = static_cast<float>(-back.v[i]);
        to.intensity[i] = clamp_to(std::max(color, 0.0) * std::max(from.intensity, 0.0), 0, max_intensity);
    }
    to.range = clamp_to(from.range, 0, max_intensity);
    if (to.type == GLTF_LIGHT_SPOT)
        cone_import(from.spot, to);
    lights.push_back(to);
    lights.back().name = name_copy(from.name);
}

void camera_import(importer &in, std::vector<gltf_camera> &cameras, int index, const matrix4 &world)
{
    if (index < 0 || static_cast<size_t>(index) >= in.model.cameras.size())
        fail("camera %d is out of range, there are %zu", index, in.model.cameras.size());
    const tinygltf::Camera &from = in.model.cameras[static_cast<size_t>(index)];
    gltf_camera to = {};
    camera_frame(world, to.transform);
    if (from.type == "perspective")
        to.yfov_rad = clamp_to(from.perspective.yfov, 1e-3, pi - 1e-3);
    else
        orthographic_import(from.orthographic, to, label("cameras", static_cast<size_t>(index)));
    cameras.push_back(to);
    cameras.back().name = name_copy(from.name);
}

} // namespace gltf
