/* SPDX-License-Identifier: MIT
 *
 * A sky that is a picture: its texels are sampled by luminance times solid angle.
 */
#ifndef RAYCAST_ENVIRONMENT_H
#define RAYCAST_ENVIRONMENT_H

#include "random.h"
#include "raycast.h"
#include "vec3.h"

struct environment {
    const float *rgb; /* NULL: there is none */
    uint32_t width, height;
    double *rows;   /* sums of luminance times solid angle, up to and with each row */
    float *columns; /* sums of luminance within a row */
    float mean_luminance;
};

/* False if there is no memory; to be finished either way. */
bool environment_init(struct environment *e, const struct raycast_environment *from);
void environment_finish(struct environment *e);

/* Of one that is there, and not black. */
struct vec3 environment_radiance(const struct environment *e, struct vec3 direction);
float environment_pdf(const struct environment *e, struct vec3 direction);
void environment_sample(const struct environment *e, struct random *r, struct vec3 *direction);

#endif
