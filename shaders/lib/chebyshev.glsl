/* SPDX-License-Identifier: MIT
 * How far a receiver is visible, from moments of depth. */
#ifndef SDFGI_CHEBYSHEV_GLSL
#define SDFGI_CHEBYSHEV_GLSL

/* An upper bound of the fraction of depths beyond a receiver that lies `gap` behind their mean: Chebyshev's
 * inequality on mean and mean of squares, in x and y (Donnelly and Lauritzen 2006, "Variance shadow maps"),
 * cubed for contrast as in DDGI. */
float sdfgi_chebyshev(vec2 moments, float gap)
{
    if (gap <= 0.0)
        return 1.0;
    /* unorm16 of the range resolves variances of 0.02 cells^2 (HARD_CASES row 43). */
    const float variance = max(moments.y - moments.x * moments.x, 0.02);
    const float p = variance / (variance + gap * gap);
    return p * p * p;
}

#endif
