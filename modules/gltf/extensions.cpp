// SPDX-License-Identifier: MIT
//
// The extensions that the importer knows, as rows. Some are built only where their library is there.
#include "import.h"

#include <algorithm>

namespace gltf
{

namespace
{

struct extension {
    const char *name;
    bool is_built;
    const char *remedy; // where it is not built
};

const extension extensions[] = {
    { "KHR_lights_punctual", true, nullptr },
    { "KHR_materials_emissive_strength", true, nullptr },
    { "KHR_materials_unlit", true, nullptr },
    { "KHR_mesh_quantization", true, nullptr },
    { "KHR_texture_transform", true, nullptr },
    { draco_extension, with_draco, "build it with -Ddraco=enabled (libdraco-dev)" },
    { meshopt_extension, with_meshopt, "build it with -Dmeshopt=enabled (libmeshoptimizer-dev)" },
    { webp_extension, with_webp, "build it with -Dwebp=enabled (libwebp-dev)" },
    { ktx2_extension, with_ktx2,
      "build it with -Dktx2=enabled (libktx, which Debian 12 has not), or give the textures as PNG, JPEG or "
      "WebP" },
};

const extension *extension_find(const std::string &name)
{
    const auto found = std::find_if(std::begin(extensions), std::end(extensions),
                                    [&name](const extension &row) { return name == row.name; });
    return found == std::end(extensions) ? nullptr : found;
}

} // namespace

bool extension_is_built(const std::string &name)
{
    const extension *const row = extension_find(name);
    return row != nullptr && row->is_built;
}

void extension_refuse(const std::string &name)
{
    const extension *const row = extension_find(name);
    if (row == nullptr)
        fail("the file requires %s, which is not supported", name.c_str());
    fail("the file requires %s, which this build does not have: %s", name.c_str(), row->remedy);
}

} // namespace gltf
