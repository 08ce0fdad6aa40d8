// SPDX-License-Identifier: MIT
//
// The types that the JSON of a glTF file must have wherever this importer, or tinygltf on its behalf, reads
// it. tinygltf ignores a member of the wrong type, cuts numbers to 32 bits and drops a primitive that it
// cannot read; each of those would draw something else than the file says, so they are refused first.
#ifndef GLTF_SCHEMA_H
#define GLTF_SCHEMA_H

#include <cjson/cJSON.h>

namespace gltf
{

// Throws bad_file that names the first member of the wrong type, or that is there twice.
void schema_check(const cJSON *document);

} // namespace gltf

#endif
