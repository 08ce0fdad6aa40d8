// SPDX-License-Identifier: MIT
//
// KHR_texture_basisu: KTX2 images in Basis Universal's ETC1S or UASTC, through libktx. The largest level is
// kept; mipmaps are made as for other images.
#include "import.h"

#include <cstring>
#include <ktx.h>
#include <memory>

namespace gltf
{

namespace
{

// KTX 2.0, section 3: identifier, and offsets of two words in little-endian order.
constexpr unsigned char identifier[12] = { 0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n' };
constexpr size_t width_at = 20, height_at = 24, header_size = 80;

uint32_t word_at(const byte_range &file, size_t at)
{
    uint32_t word = 0;
    for (size_t i = 0; i < 4; i++)
        word |= static_cast<uint32_t>(file.data[at + i]) << (8 * i);
    return word;
}

struct texture_destroy {
    void operator()(ktxTexture2 *texture) const
    {
        ktxTexture_Destroy(ktxTexture(texture));
    }
};

using texture_owner = std::unique_ptr<ktxTexture2, texture_destroy>;

texture_owner texture_open(const byte_range &file, const std::string &what)
{
    ktxTexture2 *opened = nullptr;
    const auto flags = KTX_TEXTURE_CREATE_LOAD_IMAGE_DATA_BIT | KTX_TEXTURE_CREATE_CHECK_GLTF_BASISU_BIT |
                       KTX_TEXTURE_CREATE_SKIP_KVDATA_BIT;
    const auto result = ktxTexture2_CreateFromMemory(file.data, file.size,
                                                     static_cast<ktxTextureCreateFlags>(flags), &opened);
    if (result != KTX_SUCCESS)
        fail("%s cannot be decoded: the KTX2 is broken, or not one of KHR_texture_basisu: %s", what.c_str(),
             ktxErrorString(result));
    return texture_owner(opened);
}

} // namespace

bool ktx2_size(const byte_range &file, uint32_t *width, uint32_t *height)
{
    if (file.size < header_size || memcmp(file.data, identifier, sizeof identifier) != 0)
        return false;
    *width = word_at(file, width_at);
    *height = word_at(file, height_at);
    return true;
}

void ktx2_decode(gltf_image &image, const byte_range &file, const std::string &what)
{
    const texture_owner texture = texture_open(file, what);
    if (!ktxTexture2_NeedsTranscoding(texture.get()))
        fail("%s cannot be decoded: the KTX2 is not in Basis Universal", what.c_str());
    const auto result = ktxTexture2_TranscodeBasis(texture.get(), KTX_TTF_RGBA32, 0);
    if (result != KTX_SUCCESS)
        fail("%s cannot be decoded: the KTX2 is broken: %s", what.c_str(), ktxErrorString(result));
    const size_t size = size_t{ 4 } * texture->baseWidth * texture->baseHeight;
    ktx_size_t offset = 0;
    if (ktxTexture2_GetImageOffset(texture.get(), 0, 0, 0, &offset) != KTX_SUCCESS ||
        offset > texture->dataSize || size > texture->dataSize - offset)
        fail("%s cannot be decoded: the KTX2 is broken", what.c_str());
    image.texels = array_allocate<uint8_t>(size);
    image.width = texture->baseWidth;
    image.height = texture->baseHeight;
    memcpy(image.texels, texture->pData + offset, size);
}

} // namespace gltf
