/* SPDX-License-Identifier: MIT
 * From scene-referred radiance to display-referred numbers, the same way for every comparison. */
#ifndef RUNTIME_TONE_H
#define RUNTIME_TONE_H

#include <stddef.h>

/* Luminance of linear RGB with the weights of Rec. 709. */
float tone_luminance(const float rgb[3]);

/* The sRGB curve and its inverse on [0, 1]; values outside are clamped. */
float tone_srgb_encode(float linear);
float tone_srgb_decode(float encoded);

/* The factor that brings the log-average luminance of `count` RGBA pixels to 0.18 (middle grey; Reinhard et
 * al. 2002). Luminances below a twentieth of the mean count as that much: a picture that is mostly black,
 * such as direct light alone, would otherwise be exposed until its lit parts are white. 1 for a black
 * picture. */
float tone_exposure(const float *rgba, size_t count);

/* x = exposure * value, x / (1 + x), sRGB, for each of the three channels: never clips, so that differences
 * in bright places count too. Negative values become 0. */
void tone_map(const float rgb[3], float exposure, float encoded[3]);

/* In words, for reports. */
extern const char tone_description[];

#endif
