/* SPDX-License-Identifier: MIT
 * The importer: glTF and GLB, which it tells apart by their bytes. */
#include "fuzz.h"

#include "require.h"
#include "scene_files.h"

static bool read_gltf(const char *path, char *error, size_t error_size)
{
    struct gltf_scene *const scene = gltf_scene_load(path, error, error_size);
    if (!scene)
        return false;
    scene_check(scene);
    gltf_scene_destroy(scene);
    return true;
}

static void little_endian_put(uint8_t *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (8 * i));
}

/* A GLB: "glTF", version, length; then length, "JSON", data; then, if any, length, "BIN", data. */
static void mend_gltf(uint8_t *data, size_t size)
{
    static const char head[4] = { 'g', 'l', 'T', 'F' }, binary[4] = { 'B', 'I', 'N', '\0' };
    if (size < 20 || memcmp(data, head, sizeof head) != 0)
        return;
    size_t json_end = size;
    for (size_t at = 24; at + sizeof binary <= size && json_end == size; at++)
        if (memcmp(data + at, binary, sizeof binary) == 0)
            json_end = at - 4;
    little_endian_put(data + 8, (uint32_t)size);
    little_endian_put(data + 12, (uint32_t)(json_end - 20));
    if (json_end < size)
        little_endian_put(data + json_end, (uint32_t)(size - json_end - 8));
}

/* A chunk that has become longer, under its old length, would always be refused. */
static size_t mutate_gltf(uint8_t *data, size_t size, size_t capacity, struct test_random *random)
{
    const size_t changed = fuzz_json_mutate(data, size, capacity, random);
    mend_gltf(data, changed);
    return changed;
}

const struct fuzz_target fuzz_gltf = { ".glb", read_gltf, mutate_gltf, mend_gltf };
