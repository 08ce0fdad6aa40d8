/* SPDX-License-Identifier: MIT */
#include "harmonics.h"

#include "up_axis.h"

#include <math.h>
#include <string.h>

enum { BANDS = 3, FUNCTIONS = 9 };

/* Of the functions, in the order of sdfgi/sky.h. */
static const float constants[FUNCTIONS] = { 0.282095f, 0.488603f, 0.488603f, 0.488603f, 1.092548f,
                                            1.092548f, 0.315392f, 1.092548f, 0.546274f };

bool sdfgi_harmonics_any(const struct sdfgi_sky_harmonics *h)
{
    for (int i = 0; i < FUNCTIONS; i++)
        for (int k = 0; k < 3; k++)
            if (h->coefficients[i][k] != 0)
                return true;
    return false;
}

/* ---- Rotation */

/* The value of a turned sky in direction d is that of the sky in d turned back, (c x - s z, y, s x + c z):
 * put into the functions and sorted by them. */
static void turn(const float f[static FUNCTIONS], float c, float s, float out[static FUNCTIONS])
{
    out[0] = f[0];
    out[1] = f[1];
    out[2] = c * f[2] - s * f[3];
    out[3] = s * f[2] + c * f[3];
    out[4] = c * f[4] + s * f[5];
    out[5] = c * f[5] - s * f[4];
    /* Of x^2 and z^2; y^2 has -f[8], and 1 has -f[6]. */
    const float x2 = c * s * f[7] + 3 * s * s * f[6] + c * c * f[8];
    const float z2 = -c * s * f[7] + 3 * c * c * f[6] + s * s * f[8];
    out[6] = (z2 - f[6]) / 2;
    out[7] = (c * c - s * s) * f[7] + 6 * c * s * f[6] - 2 * c * s * f[8];
    out[8] = (x2 + f[8]) / 2;
}

/* The sky's direction of a direction d in a world where `up` is up is (x, u y + v z, u z - v y), u and v
 * being the components of up along Y and Z: put into the functions and sorted by them. One of u and v is 0.
 */
static void tilt(const float f[static FUNCTIONS], const struct up_vector *up, float out[static FUNCTIONS])
{
    const float u = up->y, v = up->z;
    out[0] = f[0];
    out[1] = u * f[1] - v * f[2];
    out[2] = v * f[1] + u * f[2];
    out[3] = f[3];
    out[4] = u * f[4] - v * f[7];
    out[5] = (u * u - v * v) * f[5];
    /* Of x^2, y^2 and z^2: 1 is their sum. */
    const float x2 = f[8] - f[6], y2 = u * u * (-f[6] - f[8]) + v * v * 2 * f[6],
                z2 = v * v * (-f[6] - f[8]) + u * u * 2 * f[6];
    out[6] = z2 / 2;
    out[7] = v * f[4] + u * f[7];
    out[8] = (x2 - y2) / 2;
}

void sdfgi_harmonics_factors(const struct sdfgi_sky_harmonics *h, enum sdfgi_up_axis up_axis,
                             float factors[static FUNCTIONS][3])
{
    const struct up_vector up = sdfgi_up_vector(up_axis);
    const float c = cosf(h->rotation_rad), s = sinf(h->rotation_rad);
    const float intensity = h->intensity > 0 ? h->intensity : 1;
    for (int k = 0; k < 3; k++) {
        float plain[FUNCTIONS], turned[FUNCTIONS], tilted[FUNCTIONS];
        for (int i = 0; i < FUNCTIONS; i++)
            plain[i] = h->coefficients[i][k] * constants[i] * intensity;
        turn(plain, c, s, turned);
        tilt(turned, &up, tilted);
        for (int i = 0; i < FUNCTIONS; i++)
            factors[i][k] = tilted[i];
    }
}

/* ---- Bounds */

/* Functions of a band have the same sum of squares in every direction: a band is at most as bright as the
 * root of that times its own. */
static float brightest_of_channel(const struct sdfgi_sky_harmonics *h, int channel)
{
    static const int first[BANDS + 1] = { 0, 1, 4, FUNCTIONS };
    static const float most[BANDS] = { 0.282095f, 0.488603f, 0.630783f };
    float sum = 0;
    for (int band = 0; band < BANDS; band++) {
        float squares = 0;
        for (int i = first[band]; i < first[band + 1]; i++)
            squares += h->coefficients[i][channel] * h->coefficients[i][channel];
        sum += most[band] * sqrtf(squares);
    }
    return sum;
}

float sdfgi_harmonics_brightest(const struct sdfgi_sky_harmonics *h)
{
    const float intensity = h->intensity > 0 ? h->intensity : 1;
    float most = 0;
    for (int k = 0; k < 3; k++)
        most = fmaxf(most, brightest_of_channel(h, k));
    return most * intensity;
}

/* ---- Projection */

/* Towards (u, v) of a face, each in [-1, 1]: Vulkan's cube map selection, backwards. */
static void face_direction(uint32_t face, double u, double v, double dir[static 3])
{
    const double table[6][3] = { { 1, -v, -u }, { -1, -v, u }, { u, 1, v },
                                 { u, -1, -v }, { u, -v, 1 },  { -u, -v, -1 } };
    memcpy(dir, table[face], sizeof table[face]);
}

static void functions_at(const double d[static 3], double values[static FUNCTIONS])
{
    const double x = d[0], y = d[1], z = d[2];
    const double plain[FUNCTIONS] = { 1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y };
    for (int i = 0; i < FUNCTIONS; i++)
        values[i] = plain[i] * (double)constants[i];
}

static void add_texel(const float color[static 3], double weight, const double dir[static 3],
                      double sums[static FUNCTIONS][3])
{
    double values[FUNCTIONS];
    functions_at(dir, values);
    for (int i = 0; i < FUNCTIONS; i++)
        for (int k = 0; k < 3; k++)
            sums[i][k] += weight * values[i] * (double)color[k];
}

void sdfgi_sky_harmonics_from_cube(const float *texels, uint32_t side, struct sdfgi_sky_harmonics *harmonics)
{
    double sums[FUNCTIONS][3] = { { 0 } }, sphere = 0;
    for (uint64_t i = 0; i < 6 * (uint64_t)side * side; i++) {
        const uint32_t column = (uint32_t)(i % side), row = (uint32_t)(i / side % side);
        const double u = 2 * (column + 0.5) / side - 1, v = 2 * (row + 0.5) / side - 1;
        const double length = sqrt(1 + u * u + v * v), weight = 1 / (length * length * length);
        double dir[3];
        face_direction((uint32_t)(i / side / side), u, v, dir);
        for (int k = 0; k < 3; k++)
            dir[k] /= length;
        add_texel(texels + 3 * i, weight, dir, sums);
        sphere += weight;
    }
    *harmonics = (struct sdfgi_sky_harmonics){ .intensity = 1 };
    for (int i = 0; i < FUNCTIONS; i++)
        for (int k = 0; k < 3; k++)
            harmonics->coefficients[i][k] = (float)(sums[i][k] * 4 * 3.14159265358979 / sphere);
}
