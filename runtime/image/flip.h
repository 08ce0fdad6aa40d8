/* SPDX-License-Identifier: MIT
 * LDR-FLIP: the difference that a viewer notices when two pictures alternate in the same place.
 * P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. Fairchild, "FLIP: A Difference
 * Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. */
#ifndef RUNTIME_FLIP_H
#define RUNTIME_FLIP_H

#include <stdbool.h>
#include <stdint.h>

/* A display 3840 pixels and 0.7 m wide, 0.7 m away: the paper's standard viewer, called 67 pixels per degree.
 */
#define FLIP_PIXELS_PER_DEGREE 67.02064327658226

/* Writes the error of each pixel, [0, 1], to `errors`. Both pictures are RGBA, sRGB-encoded, [0, 1]. False
 * when memory runs out. */
bool flip_ldr(const float *reference, const float *test, uint32_t width, uint32_t height, float *errors);

#endif
