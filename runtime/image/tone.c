/* SPDX-License-Identifier: MIT */
#include "tone.h"

#include <math.h>

const char tone_description[] = "x = exposure * radiance, x / (1 + x) per channel, sRGB; exposure brings the "
                                "log-average luminance of the "
                                "reference to 0.18";

static const float middle_grey = 0.18f;
static const double dark_share = 1.0 / 20;

float tone_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

float tone_srgb_encode(float linear)
{
    const float x = linear > 0 ? fminf(linear, 1) : 0;
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
}

float tone_srgb_decode(float encoded)
{
    const float x = encoded > 0 ? fminf(encoded, 1) : 0;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

static double luminance_at_least_0(const float rgb[3])
{
    return fmax(0, (double)tone_luminance(rgb));
}

float tone_exposure(const float *rgba, size_t count)
{
    double mean = 0, log_mean = 0;
    for (size_t i = 0; i < count; i++)
        mean += luminance_at_least_0(rgba + 4 * i) / (double)count;
    if (!(mean > 0))
        return 1;
    for (size_t i = 0; i < count; i++)
        log_mean += log(fmax(luminance_at_least_0(rgba + 4 * i), dark_share * mean)) / (double)count;
    return middle_grey / (float)exp(log_mean);
}

void tone_map(const float rgb[3], float exposure, float encoded[3])
{
    for (int c = 0; c < 3; c++) {
        const float x = fmaxf(0, exposure * rgb[c]);
        encoded[c] = tone_srgb_encode(isinf(x) ? 1 : x / (1 + x));
    }
}
