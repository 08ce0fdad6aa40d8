/* SPDX-License-Identifier: MIT
 * How shaders read an attribute of a vertex: one word. Scene/vertex_format.h makes it of a VkFormat. */
#ifndef SDFGI_SHARED_VERTEX_FETCH_H
#define SDFGI_SHARED_VERTEX_FETCH_H

/* Low byte: where the first element begins in the range that is bound, in bytes. */
#define SDFGI_FETCH_OFFSET_MASK 255u

#define SDFGI_FETCH_BITS_SHIFT       8u  /* of a component: 8, 10, 16 or 32; a fourth beside 10 has 2 */
#define SDFGI_FETCH_COMPONENTS_SHIFT 14u /* 2 to 4 */
#define SDFGI_FETCH_SIZE_SHIFT       17u /* bytes of an element, up to 16 */
#define SDFGI_FETCH_FLOAT            (1u << 24u)
#define SDFGI_FETCH_SIGNED           (1u << 25u)
#define SDFGI_FETCH_NORMALISED       (1u << 26u)
#define SDFGI_FETCH_SRGB             (1u << 27u)
#define SDFGI_FETCH_BLUE_FIRST       (1u << 28u)

#define SDFGI_FETCH_GET_BITS(fetch)       ((fetch) >> SDFGI_FETCH_BITS_SHIFT & 63u)
#define SDFGI_FETCH_GET_COMPONENTS(fetch) ((fetch) >> SDFGI_FETCH_COMPONENTS_SHIFT & 7u)
#define SDFGI_FETCH_GET_SIZE(fetch)       ((fetch) >> SDFGI_FETCH_SIZE_SHIFT & 31u)

#endif
