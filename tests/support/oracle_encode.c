/* SPDX-License-Identifier: MIT */
#include "oracle_encode.h"

#include <math.h>

static double sign_not_zero(double value)
{
    return value < 0 ? -1 : 1;
}

void oracle_octahedral_encode(const double direction[static 3], double square[static 2])
{
    const double norm = fabs(direction[0]) + fabs(direction[1]) + fabs(direction[2]);
    const double x = direction[0] / norm, y = direction[1] / norm;
    square[0] = direction[2] < 0 ? (1 - fabs(y)) * sign_not_zero(x) : x;
    square[1] = direction[2] < 0 ? (1 - fabs(x)) * sign_not_zero(y) : y;
}

/* The point of the octahedron |x| + |y| + |z| = 1 over a point of the square. */
static void octahedron_point(const double square[static 2], double point[static 3])
{
    const double x = square[0], y = square[1];
    point[2] = 1 - fabs(x) - fabs(y);
    point[0] = point[2] < 0 ? (1 - fabs(y)) * sign_not_zero(x) : x;
    point[1] = point[2] < 0 ? (1 - fabs(x)) * sign_not_zero(y) : y;
}

static double length(const double v[static 3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void oracle_octahedral_decode(const double square[static 2], double direction[static 3])
{
    double point[3];
    octahedron_point(square, point);
    for (int k = 0; k < 3; k++)
        direction[k] = point[k] / length(point);
}

/* A face lies 1/sqrt(3) from the centre and is sqrt(3) times as large as its image in the square: seen at
 * distance r under cos = 1 / (sqrt(3) r), an area of 1 covers 1 / r^3. */
double oracle_octahedral_density(const double square[static 2])
{
    double point[3];
    octahedron_point(square, point);
    return pow(length(point), -3);
}

/* Solid angle of the triangle between three points seen from the origin (Van Oosterom and Strackee 1983). */
static double triangle_sr(const double a[static 3], const double b[static 3], const double c[static 3])
{
    const double determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                               a[2] * (b[0] * c[1] - b[1] * c[0]);
    const double la = length(a), lb = length(b), lc = length(c);
    const double ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double bc = b[0] * c[0] + b[1] * c[1] + b[2] * c[2];
    const double ca = c[0] * a[0] + c[1] * a[1] + c[2] * a[2];
    return 2 * atan2(fabs(determinant), la * lb * lc + ab * lc + bc * la + ca * lb);
}

/* Part of a square cell of the map, cut so finely that no fold crosses it: the folds run along the axes and
 * the diagonals |x| + |y| = 1, which are edges or diagonals of cells as soon as the cells divide the unit. */
static double cell_sr(double x0, double y0, double x1, double y1)
{
    double corner[4][3];
    octahedron_point((double[]){ x0, y0 }, corner[0]);
    octahedron_point((double[]){ x1, y0 }, corner[1]);
    octahedron_point((double[]){ x1, y1 }, corner[2]);
    octahedron_point((double[]){ x0, y1 }, corner[3]);
    /* Split along the diagonal that runs with the fold of this quadrant: x + y = 1 where x and y have one
     * sign. */
    const int d = (x0 + x1) * (y0 + y1) > 0 ? 1 : 0;
    return triangle_sr(corner[d], corner[d + 1], corner[d + 2]) +
           triangle_sr(corner[d], corner[d + 2], corner[(d + 3) % 4]);
}

double oracle_octahedral_texel_sr(uint32_t size, uint32_t x, uint32_t y)
{
    /* Cells of 1 / size: both the axes and |x| + |y| = 1 then pass through cell corners, for odd sizes too.
     */
    const double step = 1.0 / size;
    double sum = 0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const double x0 = -1 + (2.0 * x + i) * step, y0 = -1 + (2.0 * y + j) * step;
            sum += cell_sr(x0, y0, x0 + step, y0 + step);
        }
    return sum;
}

void oracle_octahedral_border(uint32_t size, uint32_t x, uint32_t y, uint32_t source[static 2])
{
    const uint32_t mirror_x = size + 1 - x, mirror_y = size + 1 - y;
    const int outside_x = x == 0 || x == size + 1, outside_y = y == 0 || y == size + 1;
    source[0] = x;
    source[1] = y;
    if (outside_x) { /* crossing a side leads back in through the same side, mirrored along it */
        source[0] = x == 0 ? 1 : size;
        source[1] = mirror_y;
    }
    if (outside_y) {
        source[1] = y == 0 ? 1 : size;
        source[0] = mirror_x;
    }
    if (outside_x &&
        outside_y) { /* all four corners of the square are the same direction: the opposite one */
        source[0] = x == 0 ? size : 1;
        source[1] = y == 0 ? size : 1;
    }
}

enum { RGBE_MANTISSA_BITS = 9, RGBE_BIAS = 15, RGBE_MANTISSA_END = 1 << RGBE_MANTISSA_BITS };

static double rgbe_clamp(double value)
{
    return value > 0 ? fmin(value, ORACLE_RGBE_MAX) : 0; /* also catches NaN */
}

uint32_t oracle_rgbe_encode(const double rgb[static 3])
{
    const double c[3] = { rgbe_clamp(rgb[0]), rgbe_clamp(rgb[1]), rgbe_clamp(rgb[2]) };
    const double max = fmax(c[0], fmax(c[1], c[2]));
    int exponent = -RGBE_BIAS - 1;
    if (max > 0) {
        int above; /* max = m * 2^above with m in [0.5, 1): floor(log2(max)) without rounding */
        frexp(max, &above);
        exponent = above - 1 > exponent ? above - 1 : exponent;
    }
    exponent += 1 + RGBE_BIAS;
    if (floor(ldexp(max, RGBE_BIAS + RGBE_MANTISSA_BITS - exponent) + 0.5) == RGBE_MANTISSA_END)
        exponent++;
    uint32_t packed = (uint32_t)exponent << 27;
    for (int k = 0; k < 3; k++)
        packed |= (uint32_t)floor(ldexp(c[k], RGBE_BIAS + RGBE_MANTISSA_BITS - exponent) + 0.5) << (9 * k);
    return packed;
}

void oracle_rgbe_decode(uint32_t packed, double rgb[static 3])
{
    const int exponent = (int)(packed >> 27) - RGBE_BIAS - RGBE_MANTISSA_BITS;
    for (int k = 0; k < 3; k++)
        rgb[k] = ldexp((double)(packed >> (9 * k) & (RGBE_MANTISSA_END - 1)), exponent);
}
