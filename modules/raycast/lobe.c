/* SPDX-License-Identifier: MIT */
#include "lobe.h"

#include <math.h>

#include "ggx.h"

/* Points along a side of the square over which shares are integrated: with 48 they change by 0.05 % at most.
 */
enum { POINTS = 32 };

/* A smooth lobe loses light where the cosine is about alpha, and hardly elsewhere, so the table's columns are
 * spread evenly over w = (c (1 + alpha) / (c + alpha))^(2/3) with c for the cosine. */
static float column_of_cosine(float cosine, float alpha)
{
    const float u = cosine * (1.0f + alpha) / (cosine + alpha);
    return cbrtf(u * u);
}

static float cosine_of_column(float column, float alpha)
{
    const float u = column * sqrtf(column);
    return fminf(u * alpha / (1.0f + alpha - u), 1.0f);
}

static float row_of_alpha(float alpha)
{
    const float first = sqrtf(GGX_MIN_ALPHA);
    return (sqrtf(alpha) - first) / (1.0f - first);
}

static float alpha_of_row(float row)
{
    const float first = sqrtf(GGX_MIN_ALPHA), roughness = first + (1.0f - first) * row;
    return roughness * roughness;
}

/* What a facet mirrors upwards and no other facet stops, over what it mirrors. */
static float facet_share(struct vec3 out, float alpha, float u, float v)
{
    const struct vec3 in = ggx_mirrored(out, ggx_visible_normal(out, alpha, u, v));
    if (!(in.z > 0.0f))
        return 0.0f;
    const float seen = 1.0f + ggx_lambda(out, alpha);
    return seen / (seen + ggx_lambda(in, alpha));
}

/* Mean over the visible facets. One half of them mirrors the other. The steepest facets, towards v = 1, get
 * more of the points, as the share falls to nothing there. */
static float integrated_share(float cosine, float alpha)
{
    const struct vec3 out = { sqrtf(fmaxf(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine };
    float sum = 0.0f;
    for (int i = 0; i < POINTS; i++) {
        for (int j = 0; j < POINTS; j++) {
            const float u = 0.5f * ((float)i + 0.5f) / POINTS, s = ((float)j + 0.5f) / POINTS;
            sum += facet_share(out, alpha, u, 1.0f - s * s) * 2.0f * s;
        }
    }
    return sum / (POINTS * POINTS);
}

void lobe_init(struct lobe *lobe)
{
    for (int j = 0; j <= LOBE_STEPS; j++) {
        const float alpha = alpha_of_row((float)j / LOBE_STEPS);
        lobe->shares[j][0] = 1.0f; /* where the cosine goes to 0 */
        for (int i = 1; i <= LOBE_STEPS; i++)
            lobe->shares[j][i] = integrated_share(cosine_of_column((float)i / LOBE_STEPS, alpha), alpha);
    }
}

/* The step below x of [0, 1], and how far x is on the way to the next. */
static int step_below(float x, float *fraction)
{
    const float steps = clamp01(x) * LOBE_STEPS;
    const int step = steps < LOBE_STEPS ? (int)steps : LOBE_STEPS - 1;
    *fraction = steps - (float)step;
    return step;
}

float lobe_share(const struct lobe *lobe, float cosine, float alpha)
{
    float x, y;
    const int i = step_below(column_of_cosine(cosine, alpha), &x), j = step_below(row_of_alpha(alpha), &y);
    const float *const low = lobe->shares[j] + i, *const high = lobe->shares[j + 1] + i;
    const float at_low = low[0] + (low[1] - low[0]) * x, at_high = high[0] + (high[1] - high[0]) * x;
    return at_low + (at_high - at_low) * y;
}
