/* SPDX-License-Identifier: MIT
 * How far a picture is from its reference, in measures that do not flatter each other. */
#ifndef RUNTIME_COMPARE_H
#define RUNTIME_COMPARE_H

#include "image/image.h"

/* relMSE divides by reference^2 + this (Rousselle et al. 2011), so that black pixels do not decide. */
#define COMPARE_RELMSE_EPSILON 0.01
/* Relative errors divide by at least this share of the reference's mean luminance. */
#define COMPARE_RELATIVE_FLOOR 0.01

struct compare_result {
    uint64_t pixels;             /* compared: all, or those in the mask */
    double mean, reference_mean; /* luminance */
    double mean_ratio;           /* mean / reference_mean; NaN for a black reference */
    double max;                  /* largest luminance of the picture */
    double relmse;               /* mean over pixels and channels of (a - b)^2 / (b^2 + epsilon) */
    double psnr_db;              /* after the tone curve of tone.h; infinite for equal pictures */
    double flip;                 /* mean LDR-FLIP after the same curve */
    double flip_max;
    double p99_relative_error; /* of luminance, |a - b| / max(b, floor) */
    double exposure;           /* of the tone curve; 1 for display-referred pictures */
};

struct compare_input {
    const struct image *image;
    const char *name; /* for messages */
};

/* Compares `picture` with `reference`. PNGs are taken as they are, and undone to linear light for the
 * measures of luminance; the others go through the tone curve for PSNR and FLIP. `mask` may be NULL; else
 * pixels count whose red is above 0.5 (FLIP still sees the whole pictures, as an eye would). `flip_map` may
 * be NULL; else it receives an error per pixel. On failure returns false and one line in `error` that names
 * the pictures by the given names. */
bool compare_images(const struct compare_input *picture, const struct compare_input *reference,
                    const struct compare_input *mask, struct compare_result *result, float *flip_map,
                    char *error, size_t error_size);

enum { COMPARE_STRIP_PANELS = 3 };

/* Paints the picture, the reference and the map of errors side by side, as RGBA bytes, three times as wide as
 * each of them. Radiance goes through the tone curve with `exposure`, that of the comparison's result. */
void compare_paint_strip(const struct image *picture, const struct image *reference, const float *flip_map,
                         double exposure, uint8_t *rgba);

/* Colours errors from black (0) over violet and orange to pale yellow (1), RGBA bytes. */
void compare_paint_map(const float *errors, size_t count, uint8_t *rgba);

#endif
