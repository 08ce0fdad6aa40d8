// SPDX-License-Identifier: MIT
//
// Matrices of nodes, in double.
#include "import.h"

#include <algorithm>
#include <cmath>

namespace gltf
{

extern const matrix4 identity = { { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 } };

matrix4 multiply(const matrix4 &a, const matrix4 &b)
{
    matrix4 out;
    for (size_t column = 0; column < 4; column++)
        for (size_t row = 0; row < 4; row++) {
            double sum = 0;
            for (size_t k = 0; k < 4; k++)
                sum += a.m[4 * k + row] * b.m[4 * column + k];
            out.m[4 * column + row] = sum;
        }
    return out;
}

// Rotation of a quaternion (x, y, z, w) of any length but zero; files store them rounded.
matrix4 rotation_matrix(const std::vector<double> &q)
{
    const double largest = std::max({ std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2]), std::fabs(q[3]) });
    if (!(largest > 0))
        return identity;
    double x = q[0] / largest, y = q[1] / largest, z = q[2] / largest, w = q[3] / largest;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    x /= length;
    y /= length;
    z /= length;
    w /= length;
    return { { 1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0, 2 * (x * y - z * w),
               1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0, 2 * (x * z + y * w), 2 * (y * z - x * w),
               1 - 2 * (x * x + y * y), 0, 0, 0, 0, 1 } };
}

matrix4 matrix_from_list(const std::vector<double> &list, const std::string &what)
{
    matrix4 out;
    std::copy_n(list.begin(), 16, out.m);
    // Exporters leave rounding in the last row; anything more would not be affine.
    constexpr double rounding = 1e-5;
    for (size_t column = 0; column < 4; column++) {
        double &bottom = out.m[4 * column + 3];
        const double exact = column == 3 ? 1 : 0;
        if (std::fabs(bottom - exact) > rounding)
            fail("%s.matrix is not affine", what.c_str());
        bottom = exact;
    }
    return out;
}

} // namespace gltf
