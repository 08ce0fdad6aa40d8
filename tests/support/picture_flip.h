/* SPDX-License-Identifier: MIT */
#ifndef TEST_PICTURE_FLIP_H
#define TEST_PICTURE_FLIP_H

#include <image/tone.h>

#include <stdint.h>

/* Mean FLIP of two pictures of radiance, RGBA, after the tone curve of tone.h. Fails the test without memory.
 */
double picture_flip(const float *a, const float *b, uint32_t width, uint32_t height, float exposure);

#endif
