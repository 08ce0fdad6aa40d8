// SPDX-License-Identifier: MIT
//
// Textures and materials. Factors outside of their range are clamped, as glTF's own ranges say; what refers
// to something that is not there is refused.
#include "import.h"

#include <algorithm>
#include <cmath>

namespace gltf
{

namespace
{

// Far above any light on Earth, and far enough below the largest float that sums stay finite.
constexpr double max_emission = 1e30;

float clamp_to(double value, double least, double most)
{
    return static_cast<float>(std::min(std::max(value, least), most));
}

gltf_wrap wrap_from(int code)
{
    switch (code) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return GLTF_WRAP_CLAMP;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return GLTF_WRAP_MIRROR;
    default:
        return GLTF_WRAP_REPEAT;
    }
}

gltf_filter filter_from(int code)
{
    switch (code) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        return GLTF_FILTER_NEAREST;
    default:
        return GLTF_FILTER_LINEAR;
    }
}

void textures_import(importer &in, const std::vector<int32_t> &image_slots)
{
    const tinygltf::Model &model = in.model;
    in.scene->textures = array_allocate<gltf_texture>(model.textures.size());
    in.scene->texture_count = static_cast<uint32_t>(model.textures.size());
    for (size_t i = 0; i < model.textures.size(); i++) {
        const tinygltf::Texture &from = model.textures[i];
        gltf_texture &to = in.scene->textures[i];
        if (from.sampler >= 0 && static_cast<size_t>(from.sampler) >= model.samplers.size())
            fail("%s: sampler %d is out of range, there are %zu", label("textures", i).c_str(), from.sampler,
                 model.samplers.size());
        const tinygltf::Sampler sampler =
            from.sampler < 0 ? tinygltf::Sampler() : model.samplers[static_cast<size_t>(from.sampler)];
        const int source = texture_source(from);
        to.image = source < 0 ? -1 : image_slots[static_cast<size_t>(source)];
        to.wrap_u = wrap_from(sampler.wrapS);
        to.wrap_v = wrap_from(sampler.wrapT);
        to.min_filter = filter_from(sampler.minFilter);
        to.mag_filter = filter_from(sampler.magFilter);
    }
}

double number_get(const tinygltf::Value &object, const char *name, double otherwise)
{
    const bool there = object.IsObject() && object.Has(name) && object.Get(name).IsNumber();
    return there ? object.Get(name).GetNumberAsDouble() : otherwise;
}

double number_at(const tinygltf::Value &object, const char *name, int index, double otherwise)
{
    if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsArray())
        return otherwise;
    const tinygltf::Value &number = object.Get(name).Get(index);
    return number.IsNumber() ? number.GetNumberAsDouble() : otherwise;
}

struct uv_transform {
    double offset[2], scale[2], rotation;
};

// Scale, then rotate counter-clockwise as seen on the image, then offset. V runs downwards, so the signs of
// the sines are those of the extension's worked example (lower left quadrant, turned), which its GLSL once
// had the other way round.
void uv_transform_compose(const uv_transform &t, float matrix[6])
{
    const double c = std::cos(t.rotation), s = std::sin(t.rotation);
    const double rows[6] = { c * t.scale[0],  s * t.scale[1], t.offset[0],
                             -s * t.scale[0], c * t.scale[1], t.offset[1] };
    for (int i = 0; i < 6; i++)
        matrix[i] = clamp_to(rows[i], -max_emission, max_emission);
}

// The three kinds of tinygltf's texture references have these in common.
struct texture_use {
    int index, uv_set;
    const tinygltf::ExtensionMap &extensions;
};

gltf_texture_ref texture_ref_make(importer &in, const texture_use &use, const std::string &what)
{
    gltf_texture_ref ref = { -1, 0, { 1, 0, 0, 0, 1, 0 } };
    if (use.index < 0)
        return ref;
    if (static_cast<size_t>(use.index) >= in.model.textures.size())
        fail("%s: texture %d is out of range, there are %zu", what.c_str(), use.index,
             in.model.textures.size());
    // A texture whose only image needs an extension: the warning names that extension.
    ref.texture = in.scene->textures[use.index].image < 0 ? -1 : use.index;
    ref.uv_set = use.uv_set;
    const auto found = use.extensions.find("KHR_texture_transform");
    if (found != use.extensions.end()) {
        const tinygltf::Value &x = found->second;
        uv_transform_compose({ { number_at(x, "offset", 0, 0), number_at(x, "offset", 1, 0) },
                               { number_at(x, "scale", 0, 1), number_at(x, "scale", 1, 1) },
                               number_get(x, "rotation", 0) },
                             ref.uv_transform);
        ref.uv_set = static_cast<int32_t>(number_get(x, "texCoord", ref.uv_set));
    }
    if (ref.uv_set > 1) {
        in.omitted.high_uv_sets = true;
        ref.uv_set = 0;
    }
    return ref;
}

gltf_alpha_mode alpha_mode_from(const std::string &name, const std::string &what)
{
    if (name == "MASK")
        return GLTF_ALPHA_MASK;
    if (name == "BLEND")
        return GLTF_ALPHA_BLEND;
    if (name != "OPAQUE")
        fail("%s: alphaMode '%.40s' is unknown", what.c_str(), name.c_str());
    return GLTF_ALPHA_OPAQUE;
}

void factors_import(const tinygltf::Material &from, gltf_material &to)
{
    const tinygltf::PbrMetallicRoughness &pbr = from.pbrMetallicRoughness;
    const auto strength = from.extensions.find("KHR_materials_emissive_strength");
    const double emission =
        strength == from.extensions.end() ? 1.0 : number_get(strength->second, "emissiveStrength", 1.0);
    for (size_t i = 0; i < 4; i++)
        to.base_color[i] = clamp_to(pbr.baseColorFactor[i], 0, 1);
    for (size_t i = 0; i < 3; i++)
        to.emissive[i] =
            clamp_to(clamp_to(from.emissiveFactor[i], 0, max_emission) * emission, 0, max_emission);
    to.metallic = clamp_to(pbr.metallicFactor, 0, 1);
    to.roughness = clamp_to(pbr.roughnessFactor, 0, 1);
    to.normal_scale = clamp_to(from.normalTexture.scale, -max_emission, max_emission);
    to.occlusion_strength = clamp_to(from.occlusionTexture.strength, 0, 1);
    to.alpha_cutoff = clamp_to(from.alphaCutoff, 0, 1);
}

template <typename T> texture_use use_of(const T &info)
{
    return { info.index, info.texCoord, info.extensions };
}

void material_import(importer &in, const tinygltf::Material &from, gltf_material &to, const std::string &what)
{
    const tinygltf::PbrMetallicRoughness &pbr = from.pbrMetallicRoughness;
    factors_import(from, to);
    to.alpha_mode = alpha_mode_from(from.alphaMode, what);
    to.double_sided = from.doubleSided;
    to.unlit = from.extensions.count("KHR_materials_unlit") != 0;
    to.base_color_texture = texture_ref_make(in, use_of(pbr.baseColorTexture), what + ".baseColorTexture");
    to.metallic_roughness_texture =
        texture_ref_make(in, use_of(pbr.metallicRoughnessTexture), what + ".metallicRoughnessTexture");
    to.normal_texture = texture_ref_make(in, use_of(from.normalTexture), what + ".normalTexture");
    to.occlusion_texture = texture_ref_make(in, use_of(from.occlusionTexture), what + ".occlusionTexture");
    to.emissive_texture = texture_ref_make(in, use_of(from.emissiveTexture), what + ".emissiveTexture");
    to.name = name_copy(from.name);
}

// glTF's default material, appended where a primitive has none.
tinygltf::Material default_material()
{
    tinygltf::Material material;
    material.emissiveFactor = { 0, 0, 0 };
    return material;
}

bool default_is_needed(const tinygltf::Model &model)
{
    for (const tinygltf::Mesh &mesh : model.meshes)
        for (const tinygltf::Primitive &primitive : mesh.primitives)
            if (primitive.material < 0)
                return true;
    return false;
}

} // namespace

void materials_import(importer &in)
{
    textures_import(in, images_import(in));
    std::vector<tinygltf::Material> &materials = in.model.materials;
    in.materials_in_file = materials.size();
    if (default_is_needed(in.model))
        materials.push_back(default_material());
    in.scene->materials = array_allocate<gltf_material>(materials.size());
    in.scene->material_count = static_cast<uint32_t>(materials.size());
    for (size_t i = 0; i < materials.size(); i++)
        material_import(in, materials[i], in.scene->materials[i], label("materials", i));
}

} // namespace gltf
