/* SPDX-License-Identifier: MIT */
#include "environment.h"

#include <stdlib.h>

/* The solid angle of a texel of a row: rows are evenly spaced in the angle from +Y. */
static double texel_angle(const struct environment *e, uint32_t row)
{
    const double step = (double)VEC3_PI / e->height;
    return 2.0 * (double)VEC3_PI / e->width * (cos(row * step) - cos((row + 1) * step));
}

static struct vec3 texel(const struct environment *e, uint32_t column, uint32_t row)
{
    return vec3_load(e->rgb + 3 * ((size_t)row * e->width + column));
}

/* Fills a row's sums of luminance; returns the last. */
static double row_build(struct environment *e, uint32_t row)
{
    float *const sums = e->columns + (size_t)row * e->width;
    double sum = 0.0;
    for (uint32_t i = 0; i < e->width; i++)
        sums[i] = (float)(sum += (double)vec3_luminance(texel(e, i, row)));
    return sum;
}

bool environment_init(struct environment *e, const struct raycast_environment *from)
{
    double total = 0.0;
    *e = (struct environment){ .rgb = from->rgb, .width = from->width, .height = from->height };
    if (!e->rgb)
        return true;
    e->columns = malloc((size_t)e->width * e->height * sizeof(*e->columns));
    e->rows = malloc((size_t)e->height * sizeof(*e->rows));
    for (uint32_t row = 0; e->columns && e->rows && row < e->height; row++)
        e->rows[row] = total += row_build(e, row) * texel_angle(e, row);
    e->mean_luminance = (float)(total / (4.0 * (double)VEC3_PI));
    return e->columns && e->rows;
}

void environment_finish(struct environment *e)
{
    free(e->columns);
    free(e->rows);
    *e = (struct environment){ .rgb = NULL };
}

static uint32_t index_from(float x, uint32_t count)
{
    const float scaled = x * (float)count;
    return scaled > 0.0f ? (scaled < (float)count ? (uint32_t)scaled : count - 1) : 0;
}

/* Columns start at +Z and go by -X; -Z is in the middle. */
static struct vec3 radiance_at(const struct environment *e, struct vec3 d)
{
    const float around = 0.5f + atan2f(d.x, -d.z) / (2.0f * VEC3_PI);
    const float down = acosf(fminf(fmaxf(d.y, -1.0f), 1.0f)) / VEC3_PI;
    return texel(e, index_from(around, e->width), index_from(down, e->height));
}

struct vec3 environment_radiance(const struct environment *e, struct vec3 direction)
{
    return radiance_at(e, direction);
}

float environment_pdf(const struct environment *e, struct vec3 direction)
{
    return vec3_luminance(radiance_at(e, direction)) / (4.0f * VEC3_PI * e->mean_luminance);
}

/* The first of `count` growing sums that is above `x`. */
static uint32_t row_find(const struct environment *e, double x)
{
    uint32_t low = 0, high = e->height - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (e->rows[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static uint32_t column_find(const float *sums, uint32_t count, float x)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (sums[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void environment_sample(const struct environment *e, struct random *r, struct vec3 *direction)
{
    const uint32_t row = row_find(e, (double)random_float(r) * e->rows[e->height - 1]);
    const float *const sums = e->columns + (size_t)row * e->width;
    const uint32_t column = column_find(sums, e->width, random_float(r) * sums[e->width - 1]);
    const float step = VEC3_PI / (float)e->height;
    const float top = cosf((float)row * step), bottom = cosf((float)(row + 1) * step);
    const float y = top + (bottom - top) * random_float(r), ring = sqrtf(fmaxf(0.0f, 1.0f - y * y));
    const float around = 2.0f * VEC3_PI * (((float)column + random_float(r)) / (float)e->width - 0.5f);
    *direction = vec3_make(ring * sinf(around), y, -ring * cosf(around));
}
