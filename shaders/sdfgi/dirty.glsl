/* SPDX-License-Identifier: MIT
 * The dirty boxes of a cascade: boxes of cells that a change completes in this frame. After a scroll they
 * include the slabs that left the cascade, which lie outside it. */
#ifndef SDFGI_DIRTY_GLSL
#define SDFGI_DIRTY_GLSL

#include "pass.glsl"

int dirty_count(uint cascade)
{
    return sdfgi_frame.cascades[cascade].dirty_count;
}

/* True if the box [low, high] comes within `margin` cells of a dirty box. */
bool dirty_near(uint cascade, ivec3 low, ivec3 high, int margin)
{
    for (int i = 0; i < dirty_count(cascade); i++)
        if (all(lessThanEqual(sdfgi_frame.cascades[cascade].dirty[i].low - margin, high)) &&
            all(greaterThanEqual(sdfgi_frame.cascades[cascade].dirty[i].high + margin, low)))
            return true;
    return false;
}

/* True if a dirty box contains the cell. */
bool dirty_contains(uint cascade, ivec3 cell)
{
    for (int i = 0; i < dirty_count(cascade); i++)
        if (all(greaterThanEqual(cell, sdfgi_frame.cascades[cascade].dirty[i].low)) &&
            all(lessThan(cell, sdfgi_frame.cascades[cascade].dirty[i].high)))
            return true;
    return false;
}

/* Distance from `pos` in cell space to the nearest dirty box, widened by `margin` cells, in cell widths; 1e10
 * if there is no dirty box. */
float dirty_distance(uint cascade, vec3 pos, float margin)
{
    float nearest = 1e10;
    for (int i = 0; i < dirty_count(cascade); i++) {
        const vec3 low = vec3(sdfgi_frame.cascades[cascade].dirty[i].low) - margin;
        const vec3 high = vec3(sdfgi_frame.cascades[cascade].dirty[i].high) + margin;
        nearest = min(nearest, length(sdfgi_metric_from_cells(pos - clamp(pos, low, high))));
    }
    return nearest;
}

/* True if a ray from `pos` along `dir` (both in cell space) crosses a dirty box, widened by `margin` cells,
 * before parameter `end`. */
bool dirty_crosses(uint cascade, vec3 pos, vec3 dir, float end, float margin)
{
    const vec3 inv_dir = 1.0 / sdfgi_nonzero(dir);
    for (int i = 0; i < dirty_count(cascade); i++) {
        const vec3 a = (vec3(sdfgi_frame.cascades[cascade].dirty[i].low) - margin - pos) * inv_dir;
        const vec3 b = (vec3(sdfgi_frame.cascades[cascade].dirty[i].high) + margin - pos) * inv_dir;
        const vec3 first = min(a, b), last = max(a, b);
        const float enters = max(max(first.x, first.y), max(first.z, 0.0));
        if (enters <= min(min(last.x, last.y), min(last.z, end)))
            return true;
    }
    return false;
}

#endif
