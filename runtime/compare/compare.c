/* SPDX-License-Identifier: MIT */
#include "compare.h"

#include "image/flip.h"
#include "image/tone.h"

#include <base/arena.h>
#include <base/text.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Both pictures in both forms, and which pixels count. */
struct pair {
    float *linear[2], *display[2]; /* RGBA; 0: the picture, 1: the reference */
    float *errors, *sorted;
    const float *mask; /* RGBA or NULL */
    size_t count;
};

/* ---- Checks ----------------------------------------------------------------------------------------- */

static bool check_finite(const struct compare_input *input, char *error, size_t error_size)
{
    const struct image *image = input->image;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        for (size_t c = 0; c < 3; c++)
            if (!isfinite(image->rgba[4 * i + c]))
                return base_text_error(error, error_size, "%s: pixel %zu, %zu is not finite", input->name,
                                       i % image->width, i / image->width);
    return true;
}

static bool check_same_size(const struct compare_input *a, const struct compare_input *b, char *error,
                            size_t error_size)
{
    if (a->image->width == b->image->width && a->image->height == b->image->height)
        return true;
    return base_text_error(error, error_size, "%s is %u x %u, %s is %u x %u: expected equal sizes", a->name,
                           a->image->width, a->image->height, b->name, b->image->width, b->image->height);
}

static bool check_inputs(const struct compare_input *picture, const struct compare_input *reference,
                         const struct compare_input *mask, char *error, size_t error_size)
{
    if (!check_same_size(picture, reference, error, error_size) ||
        (mask && !check_same_size(mask, reference, error, error_size)))
        return false;
    if (picture->image->display_referred != reference->image->display_referred)
        return base_text_error(error, error_size, "%s and %s: one is a PNG, the other holds radiance",
                               picture->name, reference->name);
    return check_finite(picture, error, error_size) && check_finite(reference, error, error_size);
}

/* ---- Measures --------------------------------------------------------------------------------------- */

static bool counts(const struct pair *pair, size_t pixel)
{
    return !pair->mask || pair->mask[4 * pixel] > 0.5f;
}

static void fill_forms(const struct image *image, float exposure, float *linear, float *display)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        const float *rgb = image->rgba + 4 * i;
        for (size_t c = 0; c < 3; c++)
            linear[4 * i + c] = image->display_referred ? tone_srgb_decode(rgb[c]) : rgb[c];
        if (image->display_referred)
            memcpy(display + 4 * i, rgb, 3 * sizeof(float));
        else
            tone_map(rgb, exposure, display + 4 * i);
    }
}

static void measure_means(const struct pair *pair, struct compare_result *result)
{
    for (size_t i = 0; i < pair->count; i++) {
        if (!counts(pair, i))
            continue;
        const double luminance = (double)tone_luminance(pair->linear[0] + 4 * i);
        result->pixels++;
        result->mean += luminance;
        result->reference_mean += (double)tone_luminance(pair->linear[1] + 4 * i);
        result->max = fmax(result->max, luminance);
    }
    result->mean /= (double)result->pixels;
    result->reference_mean /= (double)result->pixels;
    result->mean_ratio = result->reference_mean > 0 ? result->mean / result->reference_mean : (double)NAN;
}

static void measure_squares(const struct pair *pair, struct compare_result *result)
{
    double relative = 0, squares = 0;
    for (size_t i = 0; i < pair->count; i++)
        for (size_t c = 0; c < 3 && counts(pair, i); c++) {
            const double a = (double)pair->linear[0][4 * i + c], b = (double)pair->linear[1][4 * i + c];
            const double shown = (double)pair->display[0][4 * i + c] - (double)pair->display[1][4 * i + c];
            relative += (a - b) * (a - b) / (b * b + COMPARE_RELMSE_EPSILON);
            squares += shown * shown;
        }
    const double terms = 3 * (double)result->pixels;
    result->relmse = relative / terms;
    result->psnr_db = squares > 0 ? -10 * log10(squares / terms) : HUGE_VAL;
}

static void measure_flip(const struct pair *pair, struct compare_result *result)
{
    for (size_t i = 0; i < pair->count; i++)
        if (counts(pair, i)) {
            result->flip += (double)pair->errors[i];
            result->flip_max = fmax(result->flip_max, (double)pair->errors[i]);
        }
    result->flip /= (double)result->pixels;
}

static int compare_floats(const void *a, const void *b)
{
    const float left = *(const float *)a, right = *(const float *)b;
    return (left > right) - (left < right);
}

static void measure_tail(const struct pair *pair, struct compare_result *result)
{
    const double floor_luminance = fmax(COMPARE_RELATIVE_FLOOR * result->reference_mean, 1e-30);
    size_t found = 0;
    for (size_t i = 0; i < pair->count; i++) {
        const double a = (double)tone_luminance(pair->linear[0] + 4 * i);
        const double b = (double)tone_luminance(pair->linear[1] + 4 * i);
        if (counts(pair, i))
            pair->sorted[found++] = (float)(fabs(a - b) / fmax(b, floor_luminance));
    }
    qsort(pair->sorted, found, sizeof(float), compare_floats);
    result->p99_relative_error = (double)pair->sorted[(size_t)ceil(0.99 * (double)found) - 1];
}

/* ---- Public ----------------------------------------------------------------------------------------- */

static bool pair_alloc(struct pair *pair, struct base_arena *arena)
{
    for (int p = 0; p < 2; p++) {
        pair->linear[p] = base_arena_alloc(arena, pair->count, 4 * sizeof(float));
        pair->display[p] = base_arena_alloc(arena, pair->count, 4 * sizeof(float));
    }
    pair->errors = base_arena_alloc(arena, pair->count, sizeof(float));
    pair->sorted = base_arena_alloc(arena, pair->count, sizeof(float));
    return !arena->failed;
}

static bool measure(struct pair *pair, const struct image *reference, struct compare_result *result,
                    char *error, size_t error_size)
{
    measure_means(pair, result);
    if (result->pixels == 0)
        return base_text_error(error, error_size, "the mask leaves no pixel to compare");
    if (!flip_ldr(pair->display[1], pair->display[0], reference->width, reference->height, pair->errors))
        return base_text_error(error, error_size, "out of memory");
    measure_squares(pair, result);
    measure_flip(pair, result);
    measure_tail(pair, result);
    return true;
}

bool compare_images(const struct compare_input *picture, const struct compare_input *reference,
                    const struct compare_input *mask, struct compare_result *result, float *flip_map,
                    char *error, size_t error_size)
{
    *result = (struct compare_result){ .exposure = 1 };
    if (!check_inputs(picture, reference, mask, error, error_size))
        return false;
    struct base_arena arena;
    struct pair pair = { .mask = mask ? mask->image->rgba : NULL,
                         .count = (size_t)reference->image->width * reference->image->height };
    base_arena_init(&arena, NULL, 0);
    bool measured = pair_alloc(&pair, &arena) || base_text_error(error, error_size, "out of memory");
    if (measured) {
        if (!reference->image->display_referred)
            result->exposure = (double)tone_exposure(reference->image->rgba, pair.count);
        fill_forms(picture->image, (float)result->exposure, pair.linear[0], pair.display[0]);
        fill_forms(reference->image, (float)result->exposure, pair.linear[1], pair.display[1]);
        measured = measure(&pair, reference->image, result, error, error_size);
    }
    if (measured && flip_map)
        memcpy(flip_map, pair.errors, pair.count * sizeof(float));
    base_arena_finish(&arena);
    return measured;
}

void compare_paint_map(const float *errors, size_t count, uint8_t *rgba)
{
    enum { STOPS = 5 };
    static const float stops[STOPS][3] = { { 0, 0, 0 },
                                           { 0.30f, 0.07f, 0.48f },
                                           { 0.78f, 0.22f, 0.40f },
                                           { 0.98f, 0.60f, 0.25f },
                                           { 1, 1, 0.78f } };
    for (size_t i = 0; i < count; i++) {
        const float at = fminf(fmaxf(errors[i], 0), 1) * (STOPS - 1);
        const int stop = at < STOPS - 1 ? (int)at : STOPS - 2;
        const float share = at - (float)stop;
        for (int c = 0; c < 3; c++)
            rgba[4 * i + (size_t)c] =
                (uint8_t)(255 * (stops[stop][c] * (1 - share) + stops[stop + 1][c] * share) + 0.5f);
        rgba[4 * i + 3] = 255;
    }
}
