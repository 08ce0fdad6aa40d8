/* SPDX-License-Identifier: MIT
 * The importer: glTF and GLB, which it tells apart by their bytes, posed at a time. */
#include "fuzz.h"

#include "require.h"
#include "scene_files.h"

static bool read_gltf(const char *path, char *error, size_t error_size)
{
    struct gltf_scene *const scene =
        gltf_scene_load_posed(path, &(struct gltf_pose){ 0.7 }, error, error_size);
    if (!scene)
        return false;
    scene_check(scene);
    gltf_scene_destroy(scene);
    return true;
}

const struct fuzz_target fuzz_gltf = { ".glb", read_gltf, fuzz_glb_mutate, fuzz_glb_mend };
