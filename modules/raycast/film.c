/* SPDX-License-Identifier: MIT */
#include "film.h"

#include <stdlib.h>

/* Fewer say too little about the variance to stop by. */
#define MIN_SAMPLES_FOR_ERROR 16

static const struct {
    const char *name;
    uint32_t channels, plane_channels;
} aov_infos[RAYCAST_AOV_COUNT] = {
    [RAYCAST_AOV_RADIANCE] = { "radiance", 3, 3 },
    [RAYCAST_AOV_EMISSION] = { "emission", 3, 3 },
    [RAYCAST_AOV_DIRECT] = { "direct", 3, 3 },
    [RAYCAST_AOV_DIFFUSE_INDIRECT] = { "diffuse_indirect", 3, 3 },
    [RAYCAST_AOV_REFLECTION] = { "reflection", 3, 3 },
    [RAYCAST_AOV_IRRADIANCE] = { "irradiance", 3, 3 },
    [RAYCAST_AOV_NORMAL] = { "normal", 3, 3 },
    [RAYCAST_AOV_DEPTH] = { "depth", 1, 2 },
    [RAYCAST_AOV_ALBEDO] = { "albedo", 3, 3 },
    [RAYCAST_AOV_VARIANCE] = { "variance", 3, 3 },
};

uint32_t raycast_aov_channels(enum raycast_aov aov)
{
    return aov_infos[aov].channels;
}

const char *raycast_aov_name(enum raycast_aov aov)
{
    return aov_infos[aov].name;
}

uint32_t film_plane_channels(enum raycast_aov aov)
{
    return aov_infos[aov].plane_channels;
}

bool raycast_film_init(struct film *f, uint32_t width, uint32_t height, uint32_t aovs)
{
    *f = (struct film){ .width = width, .height = height };
    f->tile_samples = calloc(film_tile_count(f), sizeof(*f->tile_samples));
    if (f->tile_samples == NULL)
        return false;
    for (uint32_t aov = 0; aov < RAYCAST_AOV_COUNT; aov++) {
        if (!(aovs & 1u << aov))
            continue;
        f->sums[aov] = calloc(film_pixel_count(f) * film_plane_channels(aov), sizeof(double));
        if (f->sums[aov] == NULL) {
            raycast_film_finish(f);
            return false;
        }
    }
    return true;
}

void raycast_film_finish(struct film *f)
{
    for (uint32_t aov = 0; aov < RAYCAST_AOV_COUNT; aov++) {
        free(f->sums[aov]);
        f->sums[aov] = NULL;
    }
    free(f->tile_samples);
    f->tile_samples = NULL;
}

/* ---- Samples ---------------------------------------------------------------------------------------- */

uint32_t film_tiles_across(const struct film *f)
{
    return (f->width + FILM_TILE - 1) / FILM_TILE;
}

size_t film_tile_count(const struct film *f)
{
    return (size_t)film_tiles_across(f) * ((f->height + FILM_TILE - 1) / FILM_TILE);
}

static uint32_t pixel_samples(const struct film *f, size_t pixel)
{
    const size_t x = pixel % f->width, y = pixel / f->width;
    return f->tile_samples[y / FILM_TILE * film_tiles_across(f) + x / FILM_TILE];
}

uint32_t film_samples(const struct film *f)
{
    uint32_t least = UINT32_MAX;
    for (size_t i = 0; i < film_tile_count(f); i++)
        least = f->tile_samples[i] < least ? f->tile_samples[i] : least;
    return least;
}

/* Pixels of tile `index` along an axis of `pixels`: the last tile may stick out. */
static uint32_t tile_extent(uint32_t index, uint32_t pixels)
{
    const uint32_t left = pixels - index * FILM_TILE;
    return left < FILM_TILE ? left : FILM_TILE;
}

double film_mean_samples(const struct film *f)
{
    const uint32_t across = film_tiles_across(f);
    double sum = 0.0;
    for (uint32_t i = 0; i < film_tile_count(f); i++) {
        const uint32_t size = tile_extent(i % across, f->width) * tile_extent(i / across, f->height);
        sum += (double)f->tile_samples[i] * size;
    }
    return sum / (double)film_pixel_count(f);
}

/* ---- Sums ------------------------------------------------------------------------------------------- */

static void add(struct film *f, enum raycast_aov aov, size_t pixel, struct vec3 v)
{
    if (f->sums[aov] == NULL)
        return;
    double *sum = f->sums[aov] + 3 * pixel;
    sum[0] += v.x;
    sum[1] += v.y;
    sum[2] += v.z;
}

static void add_square(struct film *f, size_t pixel, struct vec3 v)
{
    double *sum = f->sums[RAYCAST_AOV_VARIANCE] + 3 * pixel;
    sum[0] += (double)v.x * v.x;
    sum[1] += (double)v.y * v.y;
    sum[2] += (double)v.z * v.z;
}

bool film_add(struct film *f, size_t pixel, const struct path_sample *s, float depth_m)
{
    const struct vec3 reflected = vec3_add(vec3_add(s->light.direct, s->light.diffuse), s->light.reflection);
    const struct vec3 radiance = vec3_add(s->emission, reflected);
    if (!vec3_is_finite(radiance) || !vec3_is_finite(s->light.irradiance))
        return false;
    add(f, RAYCAST_AOV_RADIANCE, pixel, radiance);
    add_square(f, pixel, radiance);
    add(f, RAYCAST_AOV_EMISSION, pixel, s->emission);
    add(f, RAYCAST_AOV_DIRECT, pixel, s->light.direct);
    add(f, RAYCAST_AOV_DIFFUSE_INDIRECT, pixel, s->light.diffuse);
    add(f, RAYCAST_AOV_REFLECTION, pixel, s->light.reflection);
    add(f, RAYCAST_AOV_IRRADIANCE, pixel, s->light.irradiance);
    add(f, RAYCAST_AOV_NORMAL, pixel, s->normal);
    add(f, RAYCAST_AOV_ALBEDO, pixel, s->albedo);
    if (s->hit && f->sums[RAYCAST_AOV_DEPTH] != NULL) {
        f->sums[RAYCAST_AOV_DEPTH][2 * pixel] += depth_m;
        f->sums[RAYCAST_AOV_DEPTH][2 * pixel + 1] += 1.0;
    }
    return true;
}

/* Variance of the mean of n samples, from their sum and the sum of their squares. */
static double mean_variance(double sum, double squares, double n)
{
    if (n < 2.0)
        return 0.0;
    const double spread = squares - sum * sum / n;
    return spread > 0.0 ? spread / (n - 1.0) / n : 0.0;
}

static double pixel_luminance(const double *sum, double n)
{
    return (0.2126 * sum[0] + 0.7152 * sum[1] + 0.0722 * sum[2]) / n;
}

/* Of a pixel's luminance; its channels vary together, so their deviations add. */
static double pixel_error(const double *sum, const double *squares, double n)
{
    return 0.2126 * sqrt(mean_variance(sum[0], squares[0], n)) +
           0.7152 * sqrt(mean_variance(sum[1], squares[1], n)) +
           0.0722 * sqrt(mean_variance(sum[2], squares[2], n));
}

double film_error(const struct film *f)
{
    if (film_samples(f) < MIN_SAMPLES_FOR_ERROR)
        return INFINITY;
    const double *sums = f->sums[RAYCAST_AOV_RADIANCE], *squares = f->sums[RAYCAST_AOV_VARIANCE];
    const size_t count = film_pixel_count(f);
    double mean = 0.0, error = 0.0;
    for (size_t i = 0; i < count; i++)
        mean += pixel_luminance(sums + 3 * i, pixel_samples(f, i)) / (double)count;
    if (!(mean > 0.0))
        return 0.0;
    for (size_t i = 0; i < count; i++) {
        const double n = pixel_samples(f, i);
        const double luminance = fmax(pixel_luminance(sums + 3 * i, n), 0.01 * mean);
        error += pixel_error(sums + 3 * i, squares + 3 * i, n) / luminance / (double)count;
    }
    return error;
}

static void variance_image(const struct film *f, float *out)
{
    const double *sums = f->sums[RAYCAST_AOV_RADIANCE], *squares = f->sums[RAYCAST_AOV_VARIANCE];
    for (size_t i = 0; i < 3 * film_pixel_count(f); i++)
        out[i] = (float)mean_variance(sums[i], squares[i], pixel_samples(f, i / 3));
}

static void depth_image(const struct film *f, float *out)
{
    const double *pairs = f->sums[RAYCAST_AOV_DEPTH];
    for (size_t i = 0; i < film_pixel_count(f); i++)
        out[i] = pairs[2 * i + 1] > 0.0 ? (float)(pairs[2 * i] / pairs[2 * i + 1]) : 0.0f;
}

bool film_image(const struct film *f, enum raycast_aov aov, float *out)
{
    if (f->sums[aov] == NULL || film_samples(f) == 0)
        return false;
    if (aov == RAYCAST_AOV_VARIANCE) {
        variance_image(f, out);
    } else if (aov == RAYCAST_AOV_DEPTH) {
        depth_image(f, out);
    } else {
        for (size_t i = 0; i < 3 * film_pixel_count(f); i++)
            out[i] = (float)(f->sums[aov][i] / pixel_samples(f, i / 3));
    }
    return true;
}
