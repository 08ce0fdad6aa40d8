/* SPDX-License-Identifier: MIT */
#include "vertex_format.h"

enum number {
    UNSIGNED = 0,
    SIGNED = SDFGI_FETCH_SIGNED,
    UNORM = SDFGI_FETCH_NORMALISED,
    SNORM = SDFGI_FETCH_NORMALISED | SDFGI_FETCH_SIGNED,
    SRGB = SDFGI_FETCH_NORMALISED | SDFGI_FETCH_SRGB,
    FLOAT = SDFGI_FETCH_FLOAT,
};
enum order { RGB = 0, BGR = SDFGI_FETCH_BLUE_FIRST };

#define ROW(name, components, bits, size, alignment, number, order)                                          \
    {                                                                                                        \
        VK_FORMAT_##name, "VK_FORMAT_" #name, components, size, alignment,                                   \
            (uint32_t)number | (uint32_t)order | (bits) << SDFGI_FETCH_BITS_SHIFT |                          \
                (components) << SDFGI_FETCH_COMPONENTS_SHIFT | (size) << SDFGI_FETCH_SIZE_SHIFT              \
    }

/* clang-format off */
const struct vertex_format sdfgi_vertex_formats[] = {
    ROW(R8G8_UNORM, 2, 8, 2, 1, UNORM, RGB),
    ROW(R8G8_SNORM, 2, 8, 2, 1, SNORM, RGB),
    ROW(R8G8_USCALED, 2, 8, 2, 1, UNSIGNED, RGB),
    ROW(R8G8_SSCALED, 2, 8, 2, 1, SIGNED, RGB),
    ROW(R8G8_UINT, 2, 8, 2, 1, UNSIGNED, RGB),
    ROW(R8G8_SINT, 2, 8, 2, 1, SIGNED, RGB),
    ROW(R8G8B8_UNORM, 3, 8, 3, 1, UNORM, RGB),
    ROW(R8G8B8_SNORM, 3, 8, 3, 1, SNORM, RGB),
    ROW(R8G8B8_USCALED, 3, 8, 3, 1, UNSIGNED, RGB),
    ROW(R8G8B8_SSCALED, 3, 8, 3, 1, SIGNED, RGB),
    ROW(R8G8B8_UINT, 3, 8, 3, 1, UNSIGNED, RGB),
    ROW(R8G8B8_SINT, 3, 8, 3, 1, SIGNED, RGB),
    ROW(R8G8B8_SRGB, 3, 8, 3, 1, SRGB, RGB),
    ROW(B8G8R8_UNORM, 3, 8, 3, 1, UNORM, BGR),
    ROW(B8G8R8_SRGB, 3, 8, 3, 1, SRGB, BGR),
    ROW(R8G8B8A8_UNORM, 4, 8, 4, 1, UNORM, RGB),
    ROW(R8G8B8A8_SNORM, 4, 8, 4, 1, SNORM, RGB),
    ROW(R8G8B8A8_USCALED, 4, 8, 4, 1, UNSIGNED, RGB),
    ROW(R8G8B8A8_SSCALED, 4, 8, 4, 1, SIGNED, RGB),
    ROW(R8G8B8A8_UINT, 4, 8, 4, 1, UNSIGNED, RGB),
    ROW(R8G8B8A8_SINT, 4, 8, 4, 1, SIGNED, RGB),
    ROW(R8G8B8A8_SRGB, 4, 8, 4, 1, SRGB, RGB),
    ROW(B8G8R8A8_UNORM, 4, 8, 4, 1, UNORM, BGR),
    ROW(B8G8R8A8_SRGB, 4, 8, 4, 1, SRGB, BGR),
    ROW(A8B8G8R8_UNORM_PACK32, 4, 8, 4, 4, UNORM, RGB),
    ROW(A8B8G8R8_SNORM_PACK32, 4, 8, 4, 4, SNORM, RGB),
    ROW(A8B8G8R8_USCALED_PACK32, 4, 8, 4, 4, UNSIGNED, RGB),
    ROW(A8B8G8R8_SSCALED_PACK32, 4, 8, 4, 4, SIGNED, RGB),
    ROW(A8B8G8R8_UINT_PACK32, 4, 8, 4, 4, UNSIGNED, RGB),
    ROW(A8B8G8R8_SINT_PACK32, 4, 8, 4, 4, SIGNED, RGB),
    ROW(A8B8G8R8_SRGB_PACK32, 4, 8, 4, 4, SRGB, RGB),
    ROW(A2R10G10B10_UNORM_PACK32, 4, 10, 4, 4, UNORM, BGR),
    ROW(A2R10G10B10_SNORM_PACK32, 4, 10, 4, 4, SNORM, BGR),
    ROW(A2R10G10B10_USCALED_PACK32, 4, 10, 4, 4, UNSIGNED, BGR),
    ROW(A2R10G10B10_SSCALED_PACK32, 4, 10, 4, 4, SIGNED, BGR),
    ROW(A2R10G10B10_UINT_PACK32, 4, 10, 4, 4, UNSIGNED, BGR),
    ROW(A2R10G10B10_SINT_PACK32, 4, 10, 4, 4, SIGNED, BGR),
    ROW(A2B10G10R10_UNORM_PACK32, 4, 10, 4, 4, UNORM, RGB),
    ROW(A2B10G10R10_SNORM_PACK32, 4, 10, 4, 4, SNORM, RGB),
    ROW(A2B10G10R10_USCALED_PACK32, 4, 10, 4, 4, UNSIGNED, RGB),
    ROW(A2B10G10R10_SSCALED_PACK32, 4, 10, 4, 4, SIGNED, RGB),
    ROW(A2B10G10R10_UINT_PACK32, 4, 10, 4, 4, UNSIGNED, RGB),
    ROW(A2B10G10R10_SINT_PACK32, 4, 10, 4, 4, SIGNED, RGB),
    ROW(R16G16_UNORM, 2, 16, 4, 2, UNORM, RGB),
    ROW(R16G16_SNORM, 2, 16, 4, 2, SNORM, RGB),
    ROW(R16G16_USCALED, 2, 16, 4, 2, UNSIGNED, RGB),
    ROW(R16G16_SSCALED, 2, 16, 4, 2, SIGNED, RGB),
    ROW(R16G16_UINT, 2, 16, 4, 2, UNSIGNED, RGB),
    ROW(R16G16_SINT, 2, 16, 4, 2, SIGNED, RGB),
    ROW(R16G16_SFLOAT, 2, 16, 4, 2, FLOAT, RGB),
    ROW(R16G16B16_UNORM, 3, 16, 6, 2, UNORM, RGB),
    ROW(R16G16B16_SNORM, 3, 16, 6, 2, SNORM, RGB),
    ROW(R16G16B16_USCALED, 3, 16, 6, 2, UNSIGNED, RGB),
    ROW(R16G16B16_SSCALED, 3, 16, 6, 2, SIGNED, RGB),
    ROW(R16G16B16_UINT, 3, 16, 6, 2, UNSIGNED, RGB),
    ROW(R16G16B16_SINT, 3, 16, 6, 2, SIGNED, RGB),
    ROW(R16G16B16_SFLOAT, 3, 16, 6, 2, FLOAT, RGB),
    ROW(R16G16B16A16_UNORM, 4, 16, 8, 2, UNORM, RGB),
    ROW(R16G16B16A16_SNORM, 4, 16, 8, 2, SNORM, RGB),
    ROW(R16G16B16A16_USCALED, 4, 16, 8, 2, UNSIGNED, RGB),
    ROW(R16G16B16A16_SSCALED, 4, 16, 8, 2, SIGNED, RGB),
    ROW(R16G16B16A16_UINT, 4, 16, 8, 2, UNSIGNED, RGB),
    ROW(R16G16B16A16_SINT, 4, 16, 8, 2, SIGNED, RGB),
    ROW(R16G16B16A16_SFLOAT, 4, 16, 8, 2, FLOAT, RGB),
    ROW(R32G32_SFLOAT, 2, 32, 8, 4, FLOAT, RGB),
    ROW(R32G32B32_SFLOAT, 3, 32, 12, 4, FLOAT, RGB),
    ROW(R32G32B32A32_SFLOAT, 4, 32, 16, 4, FLOAT, RGB),
};
/* clang-format on */
const size_t sdfgi_vertex_format_count = sizeof sdfgi_vertex_formats / sizeof *sdfgi_vertex_formats;

const struct vertex_format *sdfgi_vertex_format(VkFormat format)
{
    for (size_t i = 0; i < sdfgi_vertex_format_count; i++)
        if (sdfgi_vertex_formats[i].format == format)
            return &sdfgi_vertex_formats[i];
    return NULL;
}
