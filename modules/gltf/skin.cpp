// SPDX-License-Identifier: MIT
//
// Skins: where the joints of a skin take what is bound to them (glTF 2.0, 3.7.3).
#include "import.h"

#include <algorithm>
#include <cjson/cJSON.h>
#include <cmath>

namespace gltf
{

namespace
{

skin skin_read(const cJSON *from, size_t index)
{
    skin to;
    const cJSON *joint = nullptr;
    cJSON_ArrayForEach(joint, cJSON_GetObjectItemCaseSensitive(from, "joints"))
        to.joints.push_back(static_cast<int>(joint->valuedouble));
    const cJSON *const matrices = cJSON_GetObjectItemCaseSensitive(from, "inverseBindMatrices");
    to.inverse_bind_matrices = matrices == nullptr ? -1 : static_cast<int>(matrices->valuedouble);
    if (to.joints.empty())
        fail("%s has no joints", label("skins", index).c_str());
    return to;
}

// 16 numbers per joint; the identity where the file has none.
std::vector<float> bind_matrices_read(const importer &in, const skin &from, const std::string &what)
{
    const size_t count = from.joints.size();
    if (from.inverse_bind_matrices < 0) {
        std::vector<float> out(16 * count);
        for (size_t i = 0; i < count; i++)
            std::copy_n(identity.m, 16, out.begin() + static_cast<std::ptrdiff_t>(16 * i));
        return out;
    }
    const std::string user = what + ".inverseBindMatrices";
    const tinygltf::Accessor &a = accessor_get(in.model, from.inverse_bind_matrices, user);
    if (a.type != TINYGLTF_TYPE_MAT4 || a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        fail("%s: the accessor does not hold 4 x 4 matrices of floats", user.c_str());
    if (a.count < count)
        fail("%s: %zu matrices for %zu joints", user.c_str(), a.count, count);
    return accessor_read_floats(in.model, from.inverse_bind_matrices, user, false);
}

matrix4 bind_matrix(const std::vector<float> &numbers, size_t joint, const std::string &what)
{
    std::vector<double> list(numbers.begin() + static_cast<std::ptrdiff_t>(16 * joint),
                             numbers.begin() + static_cast<std::ptrdiff_t>(16 * joint + 16));
    for (const double number : list)
        if (!std::isfinite(number))
            fail("%s: inverse bind matrix %zu is not finite", what.c_str(), joint);
    return matrix_from_list(list, what + ".inverse bind");
}

void finite_check(const matrix4 &m, size_t joint, const std::string &what)
{
    for (const double number : m.m)
        if (!std::isfinite(number))
            fail("%s: the transform of joint %zu is not finite", what.c_str(), joint);
}

} // namespace

void skins_take(importer &in, const cJSON *document)
{
    const cJSON *item = nullptr;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(document, "skins"))
        in.skins.push_back(skin_read(item, in.skins.size()));
    in.has_skins = !in.skins.empty();
}

std::vector<matrix4> joint_matrices(importer &in, int index, const std::vector<matrix4> &worlds,
                                    double origin[3], const std::string &user)
{
    if (static_cast<size_t>(index) >= in.skins.size())
        fail("%s: skin %d is out of range, there are %zu", user.c_str(), index, in.skins.size());
    const skin &from = in.skins[static_cast<size_t>(index)];
    const std::string what = label("skins", static_cast<size_t>(index));
    // An accessor may have more matrices than there are joints.
    const uint64_t matrices =
        from.inverse_bind_matrices < 0 ? 0 : accessor_get(in.model, from.inverse_bind_matrices, what).count;
    bound_take(in, in.joints, std::max<uint64_t>(matrices, from.joints.size()), joint_bound, what);
    const std::vector<float> bind = bind_matrices_read(in, from, what);
    std::vector<matrix4> out;
    for (size_t i = 0; i < from.joints.size(); i++) {
        const int node = from.joints[i];
        if (static_cast<size_t>(node) >= worlds.size())
            fail("%s: joint %d is out of range, there are %zu nodes", what.c_str(), node, worlds.size());
        matrix4 world = worlds[static_cast<size_t>(node)];
        finite_check(world, i, what);
        for (size_t k = 0; k < 3; k++) {
            if (i == 0)
                origin[k] = world.m[12 + k];
            world.m[12 + k] -= origin[k];
        }
        out.push_back(multiply(world, bind_matrix(bind, i, what)));
        finite_check(out.back(), i, what);
    }
    return out;
}

} // namespace gltf
