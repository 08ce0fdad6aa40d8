// SPDX-License-Identifier: MIT
//
// Images: PNG and JPEG through stb_image, to 8-bit RGBA (16-bit files keep their upper byte). stb_image's
// other formats are not compiled in: glTF does not have them, and they are where its known defects are.
#include "import.h"

#include <algorithm>
#include <cstring>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace gltf
{

static_assert(max_image_size == STBI_MAX_DIMENSIONS, "the decoder's limit is ours");

namespace
{

struct stb_deleter {
    void operator()(stbi_uc *texels) const
    {
        stbi_image_free(texels);
    }
};

void dimensions_check(const byte_range &file, uint64_t &texels, const std::string &what)
{
    int width = 0, height = 0, channels = 0;
    if (file.size > INT32_MAX)
        fail("%s is larger than 2 GiB", what.c_str());
    if (stbi_info_from_memory(file.data, static_cast<int>(file.size), &width, &height, &channels) == 0)
        fail("%s is not a PNG or JPEG image: %s", what.c_str(), stbi_failure_reason());
    if (width < 1 || height < 1 || width > max_image_size || height > max_image_size)
        fail("%s: %d x %d texels, the limits are 1 and %d", what.c_str(), width, height, max_image_size);
    texels += static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
    if (texels > max_texels)
        fail("%s: more than %llu texels in all images", what.c_str(),
             static_cast<unsigned long long>(max_texels));
}

// Where a JPEG's first segment is that is neither an application's nor a comment: those hold other data,
// often a whole small JPEG, and the decoder skips them by their length as is done here.
size_t jpeg_tables_start(const byte_range &file)
{
    size_t at = 0;
    while (at < file.size && file.data[at] == 0xff)
        at++;
    at = std::min(at + 1, file.size); // past the marker that starts the image, which fill bytes may precede
    while (file.size - at >= 4 && file.data[at] == 0xff) {
        const unsigned char marker = file.data[at + 1];
        const size_t length = static_cast<size_t>(file.data[at + 2]) << 8 | file.data[at + 3];
        const bool is_skipped = (marker >= 0xe0 && marker <= 0xef) || marker == 0xfe;
        if (!is_skipped || length < 2 || length > file.size - at - 2)
            break;
        at += 2 + length;
    }
    return at;
}

// Bytes past the end of the file count as zero, as they do in the decoder.
size_t byte_at(const byte_range &file, size_t index)
{
    return index < file.size ? file.data[index] : 0;
}

// Each table: an id, 16 numbers of codes, one byte per code. The decoder starts on a table while any of the
// segment's length is left, and then reads it whole.
void huffman_tables_check(const byte_range &file, size_t segment, const std::string &what)
{
    const size_t length = byte_at(file, segment) << 8 | byte_at(file, segment + 1);
    for (size_t used = 2; used < length;) {
        size_t codes = 0;
        for (size_t i = 1; i <= 16; i++)
            codes += byte_at(file, segment + used + i);
        if (codes > 256)
            fail("%s: a Huffman table of the JPEG has %zu codes", what.c_str(), codes);
        used += 17 + codes;
    }
}

// stb_image 2.27, which Debian 12 has, writes past its arrays where a Huffman table declares more than 256
// codes (2.28 checks). In image data a 0xff byte is never followed by 0xc4, so every such pair is a marker.
void jpeg_tables_check(const byte_range &file, const std::string &what)
{
    if (byte_at(file, 0) != 0xff)
        return; // not a JPEG
    for (size_t i = jpeg_tables_start(file); i + 1 < file.size; i++) {
        if (file.data[i] != 0xff || file.data[i + 1] != 0xc4)
            continue;
        huffman_tables_check(file, i + 2, what);
    }
}

void image_decode(gltf_image &image, const byte_range &file, const std::string &what)
{
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, stb_deleter> texels(
        stbi_load_from_memory(file.data, static_cast<int>(file.size), &width, &height, &channels, 4));
    if (!texels)
        fail("%s cannot be decoded: %s", what.c_str(), stbi_failure_reason());
    const size_t size = 4 * static_cast<size_t>(width) * static_cast<size_t>(height);
    image.texels = array_allocate<uint8_t>(size);
    memcpy(image.texels, texels.get(), size);
    image.width = static_cast<uint32_t>(width);
    image.height = static_cast<uint32_t>(height);
}

void image_import(const importer &in, size_t index, gltf_image &image, uint64_t &texels)
{
    const image_source &source = in.images[index];
    const std::string what = label("images", index);
    bytes file;
    byte_range range;
    if (source.buffer_view >= 0) {
        range = buffer_view_bytes(in.model, source.buffer_view, what);
    } else {
        file = resource_read(in, source.uri, what, max_file_size);
        range = { file.data(), file.size() };
    }
    jpeg_tables_check(range, what);
    dimensions_check(range, texels, what);
    image_decode(image, range, what);
}

} // namespace

// Only images that a texture uses are read: a file may carry others in formats that an extension is needed
// for.
std::vector<int32_t> images_import(importer &in)
{
    std::vector<int32_t> slots(in.images.size(), -1);
    std::vector<size_t> used;
    for (size_t t = 0; t < in.model.textures.size(); t++) {
        const int source = in.model.textures[t].source;
        if (source < 0)
            continue;
        if (static_cast<size_t>(source) >= in.images.size())
            fail("%s: image %d is out of range, there are %zu", label("textures", t).c_str(), source,
                 in.images.size());
        if (slots[static_cast<size_t>(source)] >= 0)
            continue;
        slots[static_cast<size_t>(source)] = static_cast<int32_t>(used.size());
        used.push_back(static_cast<size_t>(source));
    }
    in.scene->images = array_allocate<gltf_image>(used.size());
    in.scene->image_count = static_cast<uint32_t>(used.size());
    uint64_t texels = 0;
    for (size_t i = 0; i < used.size(); i++)
        image_import(in, used[i], in.scene->images[i], texels);
    return slots;
}

} // namespace gltf
