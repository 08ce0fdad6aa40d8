// SPDX-License-Identifier: MIT
//
// From the JSON text to tinygltf's model. The JSON is read with cJSON first: its nesting is bounded (the
// parser behind tinygltf recurses over extensions), its types are checked, and what tinygltf would load or
// decode itself, with looser checks, is taken out: buffers are handed over through its file callbacks, images
// and animations are removed. The model then holds nothing that has not been looked at here. Writing the JSON
// anew also makes integers of numbers such as 2.0, which tinygltf ignores; doubles keep all but their last
// bit.
#include "import.h"

#include "schema.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

namespace gltf
{

namespace
{

struct json_deleter {
    void operator()(cJSON *json) const
    {
        cJSON_Delete(json);
    }
};
using json_ptr = std::unique_ptr<cJSON, json_deleter>;

json_ptr json_parse(const container &box)
{
    const char *end = nullptr;
    errno = 0; // all that tells text that is broken from a tree that finds no memory
    json_ptr json(cJSON_ParseWithLengthOpts(box.json, box.json_size, &end, false));
    const char *const limit = box.json + box.json_size;
    if (!json && errno == ENOMEM)
        throw std::bad_alloc();
    if (!json)
        fail("the JSON is broken near byte %zu", end == nullptr ? 0 : static_cast<size_t>(end - box.json));
    while (end < limit && (*end == '\0' || strchr(" \t\r\n", *end) != nullptr))
        end++;
    if (end < limit)
        fail("the JSON goes on after its end, at byte %zu", static_cast<size_t>(end - box.json));
    return json;
}

cJSON *member_get(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

std::string text_get(const cJSON *object, const char *name)
{
    const char *const text = cJSON_GetStringValue(member_get(object, name));
    return text == nullptr ? "" : text;
}

void version_check(const cJSON *document)
{
    const cJSON *const asset = member_get(document, "asset");
    const std::string version = text_get(asset, "version");
    const std::string least = text_get(asset, "minVersion");
    if (version.compare(0, 2, "2.") != 0)
        fail("glTF version '%s' is not supported, only 2.0", version.c_str());
    if (!least.empty() && least != "2.0")
        fail("glTF version '%s' is required, and only 2.0 is supported", least.c_str());
}

void extensions_check(importer &in, const cJSON *document)
{
    const cJSON *item = nullptr;
    cJSON_ArrayForEach(item, member_get(document, "extensionsRequired"))
    {
        if (!extension_is_built(item->valuestring))
            extension_refuse(item->valuestring);
    }
    cJSON_ArrayForEach(item, member_get(document, "extensionsUsed"))
    {
        if (!extension_is_built(item->valuestring))
            in.omitted.extensions.insert(item->valuestring);
    }
}

// What each buffer's uri is replaced with; the file callbacks read the number back.
constexpr const char *buffer_prefix = "buffer-";

std::string buffer_name(size_t index)
{
    return buffer_prefix + std::to_string(index);
}

// A buffer without data, which stands where decoders know nothing of meshoptimizer's compression.
bool is_fallback(const cJSON *buffer)
{
    const cJSON *const compression = member_get(member_get(buffer, "extensions"), meshopt_extension);
    return member_get(buffer, "uri") == nullptr && cJSON_IsTrue(member_get(compression, "fallback"));
}

// Whoever refers to it after its views were unpacked is refused: one byte is too short for anything.
bytes fallback_replace(cJSON *buffer)
{
    if (!with_meshopt)
        extension_refuse(meshopt_extension);
    cJSON_SetNumberValue(member_get(buffer, "byteLength"), 1);
    return bytes(1);
}

bytes buffer_read(importer &in, const container &box, const cJSON *buffer, size_t index)
{
    const std::string what = label("buffers", index);
    const double length = member_get(buffer, "byteLength")->valuedouble;
    const std::string uri = text_get(buffer, "uri");
    bytes data;
    if (!uri.empty())
        data = resource_read(in, uri, what, max_file_size - in.buffer_bytes);
    else if (index == 0 && box.binary != nullptr)
        data.assign(box.binary, box.binary + box.binary_size);
    else
        fail("%s has neither a uri nor a binary chunk", what.c_str());
    if (length < 1)
        fail("%s.byteLength is zero", what.c_str());
    if (length > static_cast<double>(data.size()))
        fail("%s.byteLength is %.0f, and there are %zu bytes", what.c_str(), length, data.size());
    data.resize(static_cast<size_t>(length));
    in.buffer_bytes += std::min<uint64_t>(data.size(), max_file_size - in.buffer_bytes);
    return data;
}

std::vector<bytes> buffers_take(importer &in, const container &box, cJSON *document)
{
    std::vector<bytes> buffers;
    cJSON *item = nullptr;
    cJSON_ArrayForEach(item, member_get(document, "buffers"))
    {
        buffers.push_back(is_fallback(item) ? fallback_replace(item)
                                            : buffer_read(in, box, item, buffers.size()));
        cJSON_DeleteItemFromObjectCaseSensitive(item, "uri");
        if (cJSON_AddStringToObject(item, "uri", buffer_name(buffers.size() - 1).c_str()) == nullptr)
            throw std::bad_alloc();
    }
    return buffers;
}

void images_take(importer &in, cJSON *document)
{
    const json_ptr images(cJSON_DetachItemFromObjectCaseSensitive(document, "images"));
    const cJSON *item = nullptr;
    cJSON_ArrayForEach(item, images.get())
    {
        image_source source;
        source.uri = text_get(item, "uri");
        const cJSON *const view = member_get(item, "bufferView");
        if ((view == nullptr) == source.uri.empty())
            fail("%s needs either a uri or a bufferView", label("images", in.images.size()).c_str());
        source.buffer_view = view == nullptr ? -1 : static_cast<int>(view->valuedouble);
        in.images.push_back(source);
    }
}

// Without the decoder, a file may bring the same vertices uncompressed.
void fallback_expect(const cJSON *primitive, const std::vector<bool> &has_data)
{
    const cJSON *attribute = nullptr;
    cJSON_ArrayForEach(attribute, member_get(primitive, "attributes"))
    {
        const size_t accessor = static_cast<size_t>(attribute->valuedouble);
        if (accessor < has_data.size() && !has_data[accessor])
            extension_refuse(draco_extension);
    }
}

std::vector<bool> accessors_with_data(const cJSON *document)
{
    std::vector<bool> out;
    const cJSON *accessor = nullptr;
    cJSON_ArrayForEach(accessor, member_get(document, "accessors"))
        out.push_back(member_get(accessor, "bufferView") != nullptr);
    return out;
}

// Draco's data has its own indices, and tinygltf would refuse the accessor that stands for them without data.
void draco_prepare(cJSON *document)
{
    const std::vector<bool> has_data = accessors_with_data(document);
    cJSON *mesh = nullptr, *primitive = nullptr;
    cJSON_ArrayForEach(mesh, member_get(document, "meshes"))
        cJSON_ArrayForEach(primitive, member_get(mesh, "primitives"))
    {
        if (member_get(member_get(primitive, "extensions"), draco_extension) == nullptr)
            continue;
        if (with_draco)
            cJSON_DeleteItemFromObjectCaseSensitive(primitive, "indices");
        else
            fallback_expect(primitive, has_data);
    }
}

// What moves is read here, since tinygltf refuses channels that aim at no node.
void motion_take(importer &in, cJSON *document)
{
    animations_take(in, document);
    skins_take(in, document);
    for (const char *name : { "animations", "skins" })
        cJSON_DeleteItemFromObjectCaseSensitive(document, name);
}

// tinygltf's file callbacks: the only files there are, are the buffers loaded above.
bytes *buffer_find(const std::string &name, void *buffers_data)
{
    std::vector<bytes> &buffers = *static_cast<std::vector<bytes> *>(buffers_data);
    if (name.compare(0, strlen(buffer_prefix), buffer_prefix) != 0)
        return nullptr;
    const size_t index = strtoull(name.c_str() + strlen(buffer_prefix), nullptr, 10);
    return index < buffers.size() ? &buffers[index] : nullptr;
}

bool buffer_exists(const std::string &name, void *buffers)
{
    return buffer_find(name, buffers) != nullptr;
}

std::string name_keep(const std::string &name, void *)
{
    return name;
}

bool buffer_hand_over(bytes *out, std::string *, const std::string &name, void *buffers)
{
    bytes *const buffer = buffer_find(name, buffers);
    if (buffer == nullptr)
        return false;
    out->swap(*buffer);
    return true;
}

void model_parse(importer &in, std::vector<bytes> &buffers, const cJSON *document)
{
    const std::unique_ptr<char, void (*)(void *)> text(cJSON_PrintUnformatted(document), cJSON_free);
    if (!text)
        throw std::bad_alloc();
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({ buffer_exists, name_keep, buffer_hand_over, nullptr, &buffers });
    std::string error, warning;
    const size_t size = strlen(text.get());
    if (size > UINT32_MAX)
        fail("the JSON is larger than 4 GiB");
    const bool parsed = parser.LoadASCIIFromString(&in.model, &error, &warning, text.get(),
                                                   static_cast<unsigned>(size), "", tinygltf::NO_REQUIRE);
    // It catches what has no memory, and gives only the name of it.
    if (error.find(std::bad_alloc().what()) != std::string::npos)
        throw std::bad_alloc();
    if (!parsed || !error.empty())
        fail("%s", error.empty() ? "the parser gave up without a reason" : error.c_str());
}

} // namespace

void document_parse(importer &in, const container &box)
{
    const json_ptr document = json_parse(box);
    schema_check(document.get());
    version_check(document.get());
    extensions_check(in, document.get());
    std::vector<bytes> buffers = buffers_take(in, box, document.get());
    images_take(in, document.get());
    motion_take(in, document.get());
    draco_prepare(document.get());
    model_parse(in, buffers, document.get());
    if constexpr (with_meshopt)
        meshopt_unpack(in);
}

} // namespace gltf
