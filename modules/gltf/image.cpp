// SPDX-License-Identifier: MIT
//
// Images: PNG through libpng, JPEG through stb_image, WebP through libwebp and KTX2 through libktx, to 8-bit
// RGBA (16-bit files keep their upper byte).
// stb_image's other formats are not compiled in: glTF does not have them, and they are where its known
// defects are.
#include "import.h"

#include <cstdlib>
#include <cstring>
#include <map>
#include <picture/picture_png.h>
#include <string_view>
#include <utility>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
// stb_image 2.27 decodes with whatever its memory held where a JPEG leaves out a table (2.28 sets it to
// zero).
#define STBI_MALLOC(size)          calloc(1, size)
#define STBI_REALLOC(memory, size) realloc(memory, size)
#define STBI_FREE(memory)          free(memory)
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace gltf
{

static_assert(max_image_size == STBI_MAX_DIMENSIONS, "the decoder's limit is ours");

namespace
{

// The shortest code of a JPEG is one bit, and stands for a block of 8 x 8 texels.
constexpr uint64_t max_jpeg_texels_per_byte = 8 * 64;

enum class codec { png, jpeg, webp, ktx2 };

struct dimensions {
    codec type = codec::jpeg;
    uint32_t width = 0, height = 0;
};

dimensions dimensions_read(const byte_range &file, const std::string &what)
{
    dimensions size;
    if (picture_png_size(file.data, file.size, &size.width, &size.height)) {
        size.type = codec::png;
        return size;
    }
    if constexpr (with_webp)
        if (webp_size(file, &size.width, &size.height)) {
            size.type = codec::webp;
            return size;
        }
    if constexpr (with_ktx2)
        if (ktx2_size(file, &size.width, &size.height)) {
            size.type = codec::ktx2;
            return size;
        }
    int width = 0, height = 0, channels = 0;
    if (file.size > INT32_MAX)
        fail("%s is larger than 2 GiB", what.c_str());
    jpeg_check(file, what);
    if (stbi_info_from_memory(file.data, static_cast<int>(file.size), &width, &height, &channels) == 0)
        fail("%s is not a PNG or JPEG image%s: %s", what.c_str(), with_webp ? ", nor WebP" : "",
             stbi_failure_reason());
    size.width = static_cast<uint32_t>(width);
    size.height = static_cast<uint32_t>(height);
    return size;
}

void dimensions_check(importer &in, const dimensions &size, const byte_range &file, const std::string &what)
{
    if (size.width < 1 || size.height < 1 || size.width > max_image_size || size.height > max_image_size)
        fail("%s: %u x %u texels, the limits are 1 and %u", what.c_str(), size.width, size.height,
             max_image_size);
    const uint64_t count = static_cast<uint64_t>(size.width) * size.height;
    if (size.type == codec::jpeg && count > max_jpeg_texels_per_byte * file.size)
        fail("%s: the JPEG is too short for %u x %u texels", what.c_str(), size.width, size.height);
    bound_take(in, in.texels, count, texel_bound, what);
}

void png_decode(gltf_image &image, const byte_range &file, const std::string &what)
{
    char error[128];
    picture_png png;
    if (!picture_png_read(&png, file.data, file.size, false, error, sizeof error))
        fail("%s cannot be decoded: %s", what.c_str(), error);
    image.texels = static_cast<uint8_t *>(png.texels);
    image.width = png.width;
    image.height = png.height;
}

// The decoder allocates with malloc, as the scene's arrays are.
void jpeg_decode(gltf_image &image, const byte_range &file, const std::string &what)
{
    int width = 0, height = 0, channels = 0;
    image.texels =
        stbi_load_from_memory(file.data, static_cast<int>(file.size), &width, &height, &channels, 4);
    if (image.texels == nullptr)
        fail("%s cannot be decoded: %s", what.c_str(), stbi_failure_reason());
    image.width = static_cast<uint32_t>(width);
    image.height = static_cast<uint32_t>(height);
}

void image_decode(importer &in, gltf_image &image, const byte_range &file, const std::string &what)
{
    const dimensions size = dimensions_read(file, what);
    dimensions_check(in, size, file, what);
    if (size.type == codec::png)
        png_decode(image, file, what);
    else if (size.type == codec::jpeg)
        jpeg_decode(image, file, what);
    if constexpr (with_webp)
        if (size.type == codec::webp)
            webp_decode(image, file, what);
    if constexpr (with_ktx2)
        if (size.type == codec::ktx2)
            ktx2_decode(image, file, what);
}

void image_import(importer &in, size_t index, gltf_image &image)
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
    image_decode(in, image, range, what);
}

} // namespace

int texture_source(const tinygltf::Texture &texture)
{
    constexpr std::pair<const char *, bool> ways[] = { { webp_extension, with_webp },
                                                       { ktx2_extension, with_ktx2 } };
    for (const auto &[name, is_built] : ways) {
        const auto found = texture.extensions.find(name);
        if (is_built && found != texture.extensions.end())
            return found->second.Get("source").GetNumberAsInt();
    }
    return texture.source;
}

// Only images that a texture uses are read: a file may carry others in formats that an extension is needed
// for. Those that name the same bytes are read once.
std::vector<int32_t> images_import(importer &in)
{
    std::vector<int32_t> slots(in.images.size(), -1);
    std::vector<size_t> used;
    std::map<std::pair<int, std::string_view>, int32_t> known;
    for (size_t t = 0; t < in.model.textures.size(); t++) {
        const int source = texture_source(in.model.textures[t]);
        if (source < 0)
            continue;
        if (static_cast<size_t>(source) >= in.images.size())
            fail("%s: image %d is out of range, there are %zu", label("textures", t).c_str(), source,
                 in.images.size());
        if (slots[static_cast<size_t>(source)] >= 0)
            continue;
        const image_source &image = in.images[static_cast<size_t>(source)];
        const auto place = known.emplace(std::make_pair(image.buffer_view, std::string_view(image.uri)),
                                         static_cast<int32_t>(used.size()));
        slots[static_cast<size_t>(source)] = place.first->second;
        if (place.second)
            used.push_back(static_cast<size_t>(source));
    }
    in.scene->images = array_allocate<gltf_image>(used.size());
    in.scene->image_count = static_cast<uint32_t>(used.size());
    for (size_t i = 0; i < used.size(); i++)
        image_import(in, used[i], in.scene->images[i]);
    return slots;
}

} // namespace gltf
