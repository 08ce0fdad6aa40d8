/* SPDX-License-Identifier: MIT */
#include "flip.h"

#include "tone.h"

#include <base/arena.h>
#include <base/vec.h>
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Section 4.1.3: exponent of the colour difference, and the point where its upper range is squeezed. */
static const float colour_exponent = 0.7f, squeeze_from = 0.4f, squeeze_to = 0.95f;
/* Section 4.2: exponent of the feature difference, and the width of the detector in degrees. */
static const float feature_exponent = 0.5f;
static const double feature_width_deg = 0.082;

enum { RADIUS_MAX = 16, TAPS_MAX = 2 * RADIUS_MAX + 1 };

/* A filter along one axis; all kernels of the metric are sums of products of two such filters. */
struct taps {
    double weight[TAPS_MAX];
    int radius;
};

/* One picture: three channels of the opponent colour space, planar. */
struct planes {
    float *channel[3];
};

struct size {
    uint32_t width, height;
};

/* ---- Colour spaces ---------------------------------------------------------------------------------- */

/* Linear sRGB to XYZ, from the chromaticities of Rec. 709 and D65, and back. */
static const float xyz_from_rgb[9] = { 0.41238656f, 0.35759149f, 0.18045049f, 0.21263682f, 0.71518298f,
                                       0.0721802f,  0.01933062f, 0.11919716f, 0.95037259f };
static const float rgb_from_xyz[9] = { 3.24100323f, -1.53739897f, -0.49861588f, -0.96922425f, 1.87592998f,
                                       0.04155423f, 0.05563942f,  -0.2040112f,  1.05714898f };
static const float white_xyz[3] = { 0.95042854f, 1, 1.08890037f };

/* Section 4.1.1: a linear version of L*a*b*, in which blur does not shift colours. */
static void opponent_from_linear(const float rgb[3], float out[3])
{
    float xyz[3];
    base_mat3f_mul_vec3f(xyz_from_rgb, rgb, xyz);
    const float x = xyz[0] / white_xyz[0], y = xyz[1] / white_xyz[1], z = xyz[2] / white_xyz[2];
    out[0] = 116 * y - 16;
    out[1] = 500 * (x - y);
    out[2] = 200 * (y - z);
}

static void linear_from_opponent(const float in[3], float rgb[3])
{
    const float y = (in[0] + 16) / 116;
    const float xyz[3] = { (y + in[1] / 500) * white_xyz[0], y * white_xyz[1],
                           (y - in[2] / 200) * white_xyz[2] };
    base_mat3f_mul_vec3f(rgb_from_xyz, xyz, rgb);
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29;
    return t > delta * delta * delta ? cbrtf(t) : t / (3 * delta * delta) + 4.0f / 29;
}

/* L*a*b* with chroma scaled by lightness, since dark colours look less colourful (Hunt). */
static void hunt_lab_from_linear(const float rgb[3], float lab[3])
{
    float xyz[3];
    base_mat3f_mul_vec3f(xyz_from_rgb, rgb, xyz);
    const float x = lab_curve(xyz[0] / white_xyz[0]);
    const float y = lab_curve(xyz[1] / white_xyz[1]);
    const float z = lab_curve(xyz[2] / white_xyz[2]);
    lab[0] = 116 * y - 16;
    lab[1] = 0.01f * lab[0] * 500 * (x - y);
    lab[2] = 0.01f * lab[0] * 200 * (y - z);
}

static float hyab_distance(const float a[3], const float b[3])
{
    return fabsf(a[0] - b[0]) + hypotf(a[1] - b[1], a[2] - b[2]);
}

/* ---- Filters ---------------------------------------------------------------------------------------- */

static uint32_t clamp_index(int64_t i, uint32_t count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : (uint32_t)i;
}

static void filter_rows(const float *in, struct size size, const struct taps *taps, float *out)
{
    for (uint32_t y = 0; y < size.height; y++) {
        const float *row = in + (size_t)y * size.width;
        for (uint32_t x = 0; x < size.width; x++) {
            double sum = 0;
            for (int k = -taps->radius; k <= taps->radius; k++)
                sum += taps->weight[k + taps->radius] * (double)row[clamp_index((int64_t)x + k, size.width)];
            out[(size_t)y * size.width + x] = (float)sum;
        }
    }
}

static void filter_columns(const float *in, struct size size, const struct taps *taps, float *out)
{
    for (uint32_t y = 0; y < size.height; y++)
        for (uint32_t x = 0; x < size.width; x++) {
            double sum = 0;
            for (int k = -taps->radius; k <= taps->radius; k++)
                sum += taps->weight[k + taps->radius] *
                       (double)in[(size_t)clamp_index((int64_t)y + k, size.height) * size.width + x];
            out[(size_t)y * size.width + x] = (float)sum;
        }
}

/* Weights of exp(-x^2 / (2 sigma^2)), x in pixels. */
static void gaussian_taps(struct taps *taps, double sigma, int radius)
{
    taps->radius = radius;
    for (int k = -radius; k <= radius; k++)
        taps->weight[k + radius] = exp(-k * k / (2 * sigma * sigma));
}

static double taps_sum(const struct taps *taps)
{
    double sum = 0;
    for (int k = 0; k <= 2 * taps->radius; k++)
        sum += taps->weight[k];
    return sum;
}

static void taps_scale(struct taps *taps, double factor)
{
    for (int k = 0; k <= 2 * taps->radius; k++)
        taps->weight[k] *= factor;
}

/* ---- Colour: what the eye resolves (section 4.1) ------------------------------------------------------ */

/* Contrast sensitivity of a channel in space: two Gaussians a * sqrt(pi / b) * exp(-pi^2 d^2 / b), d in
 * degrees (table 1 of the paper). The second has no weight for lightness and red-green. */
static const double sensitivity[3][2][2] = {
    { { 1, 0.0047 }, { 0, 1e-5 } },
    { { 1, 0.0053 }, { 0, 1e-5 } },
    { { 34.1, 0.04 }, { 13.5, 0.025 } },
};

/* Memory that every step shares: planes of the size of the picture. */
enum { SCRATCH_ROWS, SCRATCH_COLUMNS, SCRATCH_SUM, SCRATCH_COUNT };

/* Blurs a channel with both Gaussians, normalised together. */
static void blur_channel(float *plane, struct size size, const double terms[2][2],
                         float *const scratch[SCRATCH_COUNT])
{
    const double widest = 0.04;
    const int radius = (int)ceil(3 * sqrt(widest / (2 * pi * pi)) * FLIP_PIXELS_PER_DEGREE);
    const size_t count = (size_t)size.width * size.height;
    struct taps taps[2];
    double volumes[2];
    for (int t = 0; t < 2; t++) {
        gaussian_taps(&taps[t], sqrt(terms[t][1] / (2 * pi * pi)) * FLIP_PIXELS_PER_DEGREE, radius);
        const double sum = taps_sum(&taps[t]);
        volumes[t] = terms[t][0] * sqrt(pi / terms[t][1]) * sum * sum;
        taps_scale(&taps[t], 1 / sum);
    }
    memset(scratch[SCRATCH_SUM], 0, count * sizeof(float));
    for (int t = 0; t < 2; t++) {
        const float share = (float)(volumes[t] / (volumes[0] + volumes[1]));
        if (share == 0)
            continue;
        filter_rows(plane, size, &taps[t], scratch[SCRATCH_ROWS]);
        filter_columns(scratch[SCRATCH_ROWS], size, &taps[t], scratch[SCRATCH_COLUMNS]);
        for (size_t i = 0; i < count; i++)
            scratch[SCRATCH_SUM][i] += share * scratch[SCRATCH_COLUMNS][i];
    }
    memcpy(plane, scratch[SCRATCH_SUM], count * sizeof(float));
}

/* The colour of a blurred pixel as the distance sees it. */
static void perceived_colour(const struct planes *planes, size_t i, float lab[3])
{
    const float opponent[3] = { planes->channel[0][i], planes->channel[1][i], planes->channel[2][i] };
    float rgb[3];
    linear_from_opponent(opponent, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = fminf(fmaxf(rgb[c], 0), 1);
    hunt_lab_from_linear(rgb, lab);
}

/* The largest distance there is: green against blue. */
static float largest_colour_distance(void)
{
    static const float green[3] = { 0, 1, 0 }, blue[3] = { 0, 0, 1 };
    float green_lab[3], blue_lab[3];
    hunt_lab_from_linear(green, green_lab);
    hunt_lab_from_linear(blue, blue_lab);
    return powf(hyab_distance(green_lab, blue_lab), colour_exponent);
}

/* Small distances use most of [0, 1]; the few large ones are squeezed into the rest. */
static float squeeze(float distance, float largest)
{
    const float knee = squeeze_from * largest;
    if (distance < knee)
        return squeeze_to / knee * distance;
    return squeeze_to + (distance - knee) / (largest - knee) * (1 - squeeze_to);
}

static void colour_errors(const struct planes pictures[2], size_t count, float *errors)
{
    const float largest = largest_colour_distance();
    for (size_t i = 0; i < count; i++) {
        float lab[2][3];
        for (int p = 0; p < 2; p++)
            perceived_colour(&pictures[p], i, lab[p]);
        errors[i] = squeeze(powf(hyab_distance(lab[0], lab[1]), colour_exponent), largest);
    }
}

/* ---- Features: edges and points (section 4.2) --------------------------------------------------------- */

/* First (edges) or second (points) derivative of a Gaussian, its positive and its negative weights scaled to
 * a sum of 1 each; `across` is the Gaussian along the other axis, with a sum of 1. */
static void feature_taps(bool points, struct taps *along, struct taps *across)
{
    const double sigma = 0.5 * feature_width_deg * FLIP_PIXELS_PER_DEGREE;
    const int radius = (int)ceil(3 * sigma);
    double positive = 0, negative = 0;
    gaussian_taps(across, sigma, radius);
    *along = *across;
    for (int k = -radius; k <= radius; k++) {
        double *weight = &along->weight[k + radius];
        *weight *= points ? k * k / (sigma * sigma) - 1 : -k;
        *(*weight > 0 ? &positive : &negative) += fabs(*weight);
    }
    for (int k = 0; k <= 2 * radius; k++)
        along->weight[k] /= along->weight[k] > 0 ? positive : negative;
    taps_scale(across, 1 / taps_sum(across));
}

/* Length of the vector of the horizontal and the vertical filter's answers. */
static void feature_strength(const float *lightness, struct size size, bool points,
                             float *const scratch[SCRATCH_COUNT], float *strength)
{
    struct taps along, across;
    feature_taps(points, &along, &across);
    filter_rows(lightness, size, &along, scratch[SCRATCH_ROWS]);
    filter_columns(scratch[SCRATCH_ROWS], size, &across, strength);
    filter_rows(lightness, size, &across, scratch[SCRATCH_ROWS]);
    filter_columns(scratch[SCRATCH_ROWS], size, &along, scratch[SCRATCH_COLUMNS]);
    for (size_t i = 0; i < (size_t)size.width * size.height; i++)
        strength[i] = hypotf(strength[i], scratch[SCRATCH_COLUMNS][i]);
}

/* The larger of the differences in edges and in points, for each pixel. */
static void feature_differences(float *const lightness[2], struct size size,
                                float *const scratch[SCRATCH_COUNT], float *const strength[2],
                                float *differences)
{
    const size_t count = (size_t)size.width * size.height;
    for (int points = 0; points < 2; points++) {
        for (int p = 0; p < 2; p++)
            feature_strength(lightness[p], size, points != 0, scratch, strength[p]);
        for (size_t i = 0; i < count; i++)
            differences[i] = fmaxf(points ? differences[i] : 0, fabsf(strength[0][i] - strength[1][i]));
    }
}

/* ---- The metric ------------------------------------------------------------------------------------- */

struct work {
    struct planes pictures[2];
    float *lightness[2]; /* of the opponent space, before any blur, [0, 1] */
    float *strength[2], *scratch[SCRATCH_COUNT], *differences;
};

static bool work_alloc(struct work *work, struct base_arena *arena, size_t count)
{
    float **const planes[] = {
        &work->pictures[0].channel[0],
        &work->pictures[0].channel[1],
        &work->pictures[0].channel[2],
        &work->pictures[1].channel[0],
        &work->pictures[1].channel[1],
        &work->pictures[1].channel[2],
        &work->lightness[0],
        &work->lightness[1],
        &work->strength[0],
        &work->strength[1],
        &work->scratch[0],
        &work->scratch[1],
        &work->scratch[2],
        &work->differences,
    };
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++)
        *planes[i] = base_arena_alloc(arena, count, sizeof(float));
    return !arena->failed;
}

static void load_picture(const float *rgba, size_t count, struct planes *picture, float *lightness)
{
    for (size_t i = 0; i < count; i++) {
        float rgb[3], opponent[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = tone_srgb_decode(rgba[4 * i + (size_t)c]);
        opponent_from_linear(rgb, opponent);
        for (int c = 0; c < 3; c++)
            picture->channel[c][i] = opponent[c];
        lightness[i] = (opponent[0] + 16) / 116;
    }
}

bool flip_ldr(const float *reference, const float *test, uint32_t width, uint32_t height, float *errors)
{
    const struct size size = { width, height };
    const size_t count = (size_t)width * height;
    const float *const inputs[2] = { reference, test };
    struct base_arena arena;
    struct work work;
    base_arena_init(&arena, NULL, 0);
    const bool allocated = work_alloc(&work, &arena, count);
    for (int p = 0; allocated && p < 2; p++) {
        load_picture(inputs[p], count, &work.pictures[p], work.lightness[p]);
        for (int c = 0; c < 3; c++)
            blur_channel(work.pictures[p].channel[c], size, sensitivity[c], work.scratch);
    }
    if (allocated) {
        colour_errors(work.pictures, count, errors);
        feature_differences(work.lightness, size, work.scratch, work.strength, work.differences);
        for (size_t i = 0; i < count; i++) {
            const float feature = powf(work.differences[i] / sqrtf(2), feature_exponent);
            errors[i] = powf(errors[i], 1 - feature);
        }
    }
    base_arena_finish(&arena);
    return allocated;
}
