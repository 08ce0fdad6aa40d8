/* SPDX-License-Identifier: MIT
 *
 * Sums over the samples of every pixel. A pixel's samples are added in their order by one thread at a time,
 * in double precision, so that the sums do not depend on how the work was cut up. The pixels of a tile have
 * the same number of samples; a run that is stopped leaves some tiles behind others.
 */
#ifndef RAYCAST_FILM_H
#define RAYCAST_FILM_H

#include "integrator.h"
#include "raycast.h"

/* Pixels along a side: small enough to even out the threads, large enough to keep their caches. */
enum { FILM_TILE = 16 };

struct film {
    uint32_t width, height;
    uint32_t *tile_samples;          /* samples of each pixel of a tile; tiles in rows */
    double *sums[RAYCAST_AOV_COUNT]; /* NULL: not kept; variance: squares; depth: pairs of sum and hits */
};

bool raycast_film_init(struct film *f, uint32_t width, uint32_t height, uint32_t aovs);
void raycast_film_finish(struct film *f);

/* Doubles per pixel of a plane. */
uint32_t film_plane_channels(enum raycast_aov aov);

static inline size_t film_pixel_count(const struct film *f)
{
    return (size_t)f->width * f->height;
}

uint32_t film_tiles_across(const struct film *f);
size_t film_tile_count(const struct film *f);

/* Samples of the pixels that have the fewest, and of all pixels in the mean. */
uint32_t film_samples(const struct film *f);
double film_mean_samples(const struct film *f);

/* False: the sample is not finite, and was left out. */
bool film_add(struct film *f, size_t pixel, const struct path_sample *s, float depth_m);

/* Mean over the pixels of standard error over luminance; infinite before all have 16 samples. */
double film_error(const struct film *f);

/* False: the plane is not kept, or there is a pixel without a sample. */
bool film_image(const struct film *f, enum raycast_aov aov, float *out);

#endif
