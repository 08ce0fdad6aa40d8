// SPDX-License-Identifier: MIT
#include "schema.h"

#include "import.h"

#include <cmath>
#include <cstring>

namespace gltf
{

namespace
{

enum class kind {
    boolean,
    text,
    texts,
    number,
    numbers,   // as many as `count` says; 0: any number of them
    integer,   // 32 bits, signed
    index,     // 0 to 2^31 - 1
    indices,   // an array of them
    index_map, // an object of them
    size,      // 0 to below 10^15
    object,
    objects, // an array of them
};

struct member {
    const char *name;
    kind type;
    bool required = false;
    int count = 0;
    const member *inner = nullptr; // of object and objects, ended by a row without a name
};

// clang-format off
const member end_row = { nullptr, kind::object };

const member asset_members[] = {
    { "version", kind::text, true }, { "minVersion", kind::text }, { "generator", kind::text },
    { "copyright", kind::text }, end_row };

const member scene_members[] = {
    { "nodes", kind::indices }, { "name", kind::text }, end_row };

const member node_light_members[] = {
    { "light", kind::index, true }, end_row };

const member node_extensions[] = {
    { "KHR_lights_punctual", kind::object, false, 0, node_light_members }, end_row };

const member node_members[] = {
    { "name", kind::text }, { "camera", kind::index }, { "mesh", kind::index }, { "skin", kind::index },
    { "children", kind::indices }, { "matrix", kind::numbers, false, 16 },
    { "rotation", kind::numbers, false, 4 }, { "scale", kind::numbers, false, 3 },
    { "translation", kind::numbers, false, 3 }, { "weights", kind::numbers },
    { "extensions", kind::object, false, 0, node_extensions }, end_row };

const member draco_members[] = {
    { "bufferView", kind::index, true }, { "attributes", kind::index_map, true }, end_row };

const member primitive_extensions[] = {
    { "KHR_draco_mesh_compression", kind::object, false, 0, draco_members }, end_row };

const member primitive_members[] = {
    { "attributes", kind::index_map, true }, { "indices", kind::index }, { "material", kind::index },
    { "mode", kind::integer }, { "extensions", kind::object, false, 0, primitive_extensions }, end_row };

const member mesh_members[] = {
    { "name", kind::text }, { "weights", kind::numbers },
    { "primitives", kind::objects, true, 0, primitive_members }, end_row };

const member sparse_indices_members[] = {
    { "bufferView", kind::index, true }, { "byteOffset", kind::index },
    { "componentType", kind::integer, true }, end_row };

const member sparse_values_members[] = {
    { "bufferView", kind::index, true }, { "byteOffset", kind::index }, end_row };

const member sparse_members[] = {
    { "count", kind::index, true },
    { "indices", kind::object, true, 0, sparse_indices_members },
    { "values", kind::object, true, 0, sparse_values_members }, end_row };

const member accessor_members[] = {
    { "name", kind::text }, { "bufferView", kind::index }, { "byteOffset", kind::size },
    { "componentType", kind::integer, true }, { "normalized", kind::boolean }, { "count", kind::size, true },
    { "type", kind::text, true }, { "min", kind::numbers }, { "max", kind::numbers },
    { "sparse", kind::object, false, 0, sparse_members }, end_row };

const member packed_view_members[] = {
    { "buffer", kind::index, true }, { "byteOffset", kind::size }, { "byteLength", kind::size, true },
    { "byteStride", kind::size, true }, { "count", kind::size, true }, { "mode", kind::text, true },
    { "filter", kind::text }, end_row };

const member view_extensions[] = {
    { "EXT_meshopt_compression", kind::object, false, 0, packed_view_members }, end_row };

const member view_members[] = {
    { "name", kind::text }, { "buffer", kind::index, true }, { "byteOffset", kind::size },
    { "byteLength", kind::size, true }, { "byteStride", kind::size }, { "target", kind::integer },
    { "extensions", kind::object, false, 0, view_extensions }, end_row };

const member fallback_members[] = {
    { "fallback", kind::boolean }, end_row };

const member buffer_extensions[] = {
    { "EXT_meshopt_compression", kind::object, false, 0, fallback_members }, end_row };

const member buffer_members[] = {
    { "name", kind::text }, { "uri", kind::text }, { "byteLength", kind::size, true },
    { "extensions", kind::object, false, 0, buffer_extensions }, end_row };

const member image_members[] = {
    { "name", kind::text }, { "uri", kind::text }, { "mimeType", kind::text },
    { "bufferView", kind::index }, end_row };

const member texture_source_members[] = {
    { "source", kind::index, true }, end_row };

const member texture_extensions[] = {
    { "EXT_texture_webp", kind::object, false, 0, texture_source_members },
    { "KHR_texture_basisu", kind::object, false, 0, texture_source_members }, end_row };

const member texture_members[] = {
    { "name", kind::text }, { "sampler", kind::index }, { "source", kind::index },
    { "extensions", kind::object, false, 0, texture_extensions }, end_row };

const member sampler_members[] = {
    { "name", kind::text }, { "minFilter", kind::integer }, { "magFilter", kind::integer },
    { "wrapS", kind::integer }, { "wrapT", kind::integer }, end_row };

const member uv_transform_members[] = {
    { "offset", kind::numbers, false, 2 }, { "rotation", kind::number }, { "scale", kind::numbers, false, 2 },
    { "texCoord", kind::index }, end_row };

const member texture_ref_extensions[] = {
    { "KHR_texture_transform", kind::object, false, 0, uv_transform_members }, end_row };

const member texture_ref_members[] = {
    { "index", kind::index, true }, { "texCoord", kind::index }, { "scale", kind::number },
    { "strength", kind::number },
    { "extensions", kind::object, false, 0, texture_ref_extensions }, end_row };

const member roughness_members[] = {
    { "baseColorFactor", kind::numbers, false, 4 }, { "metallicFactor", kind::number },
    { "roughnessFactor", kind::number }, { "baseColorTexture", kind::object, false, 0, texture_ref_members },
    { "metallicRoughnessTexture", kind::object, false, 0, texture_ref_members }, end_row };

const member emissive_strength_members[] = {
    { "emissiveStrength", kind::number }, end_row };

const member material_extensions[] = {
    { "KHR_materials_emissive_strength", kind::object, false, 0, emissive_strength_members },
    { "KHR_materials_unlit", kind::object }, end_row };

const member material_members[] = {
    { "name", kind::text }, { "emissiveFactor", kind::numbers, false, 3 }, { "alphaMode", kind::text },
    { "alphaCutoff", kind::number }, { "doubleSided", kind::boolean },
    { "pbrMetallicRoughness", kind::object, false, 0, roughness_members },
    { "normalTexture", kind::object, false, 0, texture_ref_members },
    { "occlusionTexture", kind::object, false, 0, texture_ref_members },
    { "emissiveTexture", kind::object, false, 0, texture_ref_members },
    { "extensions", kind::object, false, 0, material_extensions }, end_row };

const member perspective_members[] = {
    { "yfov", kind::number, true }, { "znear", kind::number, true }, { "zfar", kind::number },
    { "aspectRatio", kind::number }, end_row };

const member orthographic_members[] = {
    { "xmag", kind::number, true }, { "ymag", kind::number, true }, { "znear", kind::number, true },
    { "zfar", kind::number, true }, end_row };

const member camera_members[] = {
    { "name", kind::text }, { "type", kind::text, true },
    { "perspective", kind::object, false, 0, perspective_members },
    { "orthographic", kind::object, false, 0, orthographic_members }, end_row };

const member spot_members[] = {
    { "innerConeAngle", kind::number }, { "outerConeAngle", kind::number }, end_row };

const member light_members[] = {
    { "name", kind::text }, { "type", kind::text, true }, { "color", kind::numbers, false, 3 },
    { "intensity", kind::number }, { "range", kind::number },
    { "spot", kind::object, false, 0, spot_members }, end_row };

const member lights_members[] = {
    { "lights", kind::objects, true, 0, light_members }, end_row };

const member channel_target_members[] = {
    { "node", kind::index }, { "path", kind::text, true }, end_row };

const member channel_members[] = {
    { "sampler", kind::index, true }, { "target", kind::object, true, 0, channel_target_members }, end_row };

const member animation_sampler_members[] = {
    { "input", kind::index, true }, { "output", kind::index, true }, { "interpolation", kind::text },
    end_row };

const member animation_members[] = {
    { "name", kind::text }, { "channels", kind::objects, true, 0, channel_members },
    { "samplers", kind::objects, true, 0, animation_sampler_members }, end_row };

const member skin_members[] = {
    { "name", kind::text }, { "joints", kind::indices, true }, { "inverseBindMatrices", kind::index },
    { "skeleton", kind::index }, end_row };

const member document_extensions[] = {
    { "KHR_lights_punctual", kind::object, false, 0, lights_members }, end_row };

const member document_members[] = {
    { "asset", kind::object, true, 0, asset_members },
    { "extensionsUsed", kind::texts }, { "extensionsRequired", kind::texts },
    { "scene", kind::index }, { "scenes", kind::objects, false, 0, scene_members },
    { "nodes", kind::objects, false, 0, node_members }, { "meshes", kind::objects, false, 0, mesh_members },
    { "accessors", kind::objects, false, 0, accessor_members },
    { "bufferViews", kind::objects, false, 0, view_members },
    { "buffers", kind::objects, false, 0, buffer_members },
    { "images", kind::objects, false, 0, image_members },
    { "textures", kind::objects, false, 0, texture_members },
    { "samplers", kind::objects, false, 0, sampler_members },
    { "materials", kind::objects, false, 0, material_members },
    { "cameras", kind::objects, false, 0, camera_members },
    { "animations", kind::objects, false, 0, animation_members },
    { "skins", kind::objects, false, 0, skin_members },
    { "extensions", kind::object, false, 0, document_extensions }, end_row };
// clang-format on

struct number_range {
    double least, most;
};

bool is_integer_in(const cJSON *value, number_range range)
{
    return cJSON_IsNumber(value) && value->valuedouble == std::floor(value->valuedouble) &&
           value->valuedouble >= range.least && value->valuedouble <= range.most;
}

bool is_index(const cJSON *value)
{
    return is_integer_in(value, { 0, INT32_MAX });
}

bool is_number(const cJSON *value)
{
    return cJSON_IsNumber(value) && std::isfinite(value->valuedouble);
}

bool is_list_of(const cJSON *value, bool (*accepts)(const cJSON *), int count)
{
    int found = 0;
    for (const cJSON *item = value->child; item != nullptr; item = item->next, found++)
        if (!accepts(item))
            return false;
    return count == 0 || found == count;
}

bool is_text(const cJSON *value)
{
    return cJSON_IsString(value);
}

bool is_object(const cJSON *value)
{
    return cJSON_IsObject(value);
}

// cJSON writes larger ones with an exponent, which the parser takes for a fraction and ignores. No file is a
// petabyte.
constexpr double max_size = 999999999999999.0;

bool value_fits(const cJSON *value, const member &row)
{
    switch (row.type) {
    case kind::boolean:
        return cJSON_IsBool(value);
    case kind::text:
        return is_text(value);
    case kind::texts:
        return cJSON_IsArray(value) && is_list_of(value, is_text, 0);
    case kind::number:
        return is_number(value);
    case kind::numbers:
        return cJSON_IsArray(value) && is_list_of(value, is_number, row.count);
    case kind::integer:
        return is_integer_in(value, { INT32_MIN, INT32_MAX });
    case kind::index:
        return is_index(value);
    case kind::indices:
        return cJSON_IsArray(value) && is_list_of(value, is_index, 0);
    case kind::index_map:
        return is_object(value) && is_list_of(value, is_index, 0);
    case kind::size:
        return is_integer_in(value, { 0, max_size });
    case kind::object:
        return is_object(value);
    case kind::objects:
        return cJSON_IsArray(value) && is_list_of(value, is_object, 0);
    }
    return false;
}

std::string kind_describe(const member &row)
{
    const std::string count = row.count != 0 ? std::to_string(row.count) + " " : "";
    switch (row.type) {
    case kind::boolean:
        return "true or false";
    case kind::text:
        return "a string";
    case kind::texts:
        return "an array of strings";
    case kind::number:
        return "a finite number";
    case kind::numbers:
        return "an array of " + count + "finite numbers";
    case kind::integer:
        return "a 32-bit integer";
    case kind::index:
        return "an index";
    case kind::indices:
        return "an array of indices";
    case kind::index_map:
        return "an object of indices";
    case kind::size:
        return "an integer from 0 to below 10^15";
    case kind::object:
        return "an object";
    case kind::objects:
        return "an array of objects";
    }
    return "valid";
}

// The recursion is as deep as the tables are.
void members_check(const cJSON *object, const member *rows, const std::string &path);

void inner_check(const cJSON *value, const member &row, const std::string &path)
{
    if (row.type == kind::object)
        members_check(value, row.inner, path + ".");
    size_t index = 0;
    for (const cJSON *item = value->child; row.type == kind::objects && item != nullptr; item = item->next)
        members_check(item, row.inner, label(path.c_str(), index++) + ".");
}

// A name that is there twice would mean one thing here and another to the parser.
const cJSON *member_find(const cJSON *object, const char *name, const std::string &path)
{
    const cJSON *found = nullptr;
    for (const cJSON *value = object->child; value != nullptr; value = value->next) {
        if (value->string == nullptr || strcmp(value->string, name) != 0)
            continue;
        if (found != nullptr)
            fail("%s%s is given twice", path.c_str(), name);
        found = value;
    }
    return found;
}

void members_check(const cJSON *object, const member *rows, const std::string &path)
{
    for (const member *row = rows; row->name != nullptr; row++) {
        const cJSON *const value = member_find(object, row->name, path);
        if (value == nullptr && row->required)
            fail("%s%s is missing", path.c_str(), row->name);
        if (value == nullptr)
            continue;
        if (!value_fits(value, *row))
            fail("%s%s is not %s", path.c_str(), row->name, kind_describe(*row).c_str());
        if (row->inner != nullptr)
            inner_check(value, *row, path + row->name);
    }
}

} // namespace

void schema_check(const cJSON *document)
{
    if (!cJSON_IsObject(document))
        fail("the JSON is not an object");
    members_check(document, document_members, "");
}

} // namespace gltf
