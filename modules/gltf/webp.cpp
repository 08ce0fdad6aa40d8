// SPDX-License-Identifier: MIT
//
// EXT_texture_webp through libwebp. It needs some ten bytes per texel while it decodes.
#include "import.h"

#include <cstring>
#include <webp/decode.h>

namespace gltf
{

bool webp_size(const byte_range &file, uint32_t *width, uint32_t *height)
{
    int w = 0, h = 0;
    if (file.size < 12 || memcmp(file.data, "RIFF", 4) != 0 || memcmp(file.data + 8, "WEBP", 4) != 0 ||
        WebPGetInfo(file.data, file.size, &w, &h) == 0)
        return false;
    *width = static_cast<uint32_t>(w);
    *height = static_cast<uint32_t>(h);
    return true;
}

void webp_decode(gltf_image &image, const byte_range &file, const std::string &what)
{
    WebPBitstreamFeatures features;
    uint32_t width = 0, height = 0;
    if (!webp_size(file, &width, &height) ||
        WebPGetFeatures(file.data, file.size, &features) != VP8_STATUS_OK)
        fail("%s cannot be decoded: the WebP is broken", what.c_str());
    if (features.has_animation != 0)
        fail("%s cannot be decoded: the WebP is animated", what.c_str());
    const size_t row = size_t{ 4 } * width;
    image.texels = array_allocate<uint8_t>(row * height);
    image.width = width;
    image.height = height;
    if (WebPDecodeRGBAInto(file.data, file.size, image.texels, row * height, static_cast<int>(row)) ==
        nullptr)
        fail("%s cannot be decoded: the WebP is broken", what.c_str());
}

} // namespace gltf
