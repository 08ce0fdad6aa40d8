/* SPDX-License-Identifier: MIT
 * What a cell holds in the place of its bits: shared/boxes.h. */
#ifndef SDFGI_BOXES_GLSL
#define SDFGI_BOXES_GLSL

#include "../shared/boxes.h"

bool sdfgi_has_boxes(uvec2 bits)
{
    return (bits.y & SDFGI_BOXES_MASK) == SDFGI_BOXES_MARK;
}

/* The boxes of a cell that has none, for itself alone: sides of one cell. */
const uvec2 SDFGI_BOXES_OF_CELL = uvec2(0x11111111u, 0u);

/* Cells along the sides of the box that leads the way of a ray. */
ivec3 sdfgi_box_sides(uvec2 boxes, bvec3 forward)
{
    const uint octant = (forward.x ? 0u : 1u) | (forward.y ? 0u : 2u) | (forward.z ? 0u : 4u),
               sizes = boxes.x >> 4u * octant, wide = boxes.y >> 2u * octant;
    return ivec3(sizes & 7u) << ivec3(sizes >> 3u & 1u, wide & 1u, wide >> 1u & 1u);
}

#endif
