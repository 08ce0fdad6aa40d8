/* SPDX-License-Identifier: MIT
 *
 * Whatever bytes a file holds, loading it ends, soon, with a scene that keeps its promises or with a message.
 */
#include "scene_files.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 3000, FILE_SIZE = 16384 };

/* Small numbers, enough of them, and the same everywhere: Steele, Lea & Flood 2014, "SplitMix". */
static uint64_t random_next(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static size_t random_below(uint64_t *state, size_t limit)
{
    return (size_t)(random_next(state) % limit);
}

/* A little of everything that the importer reads. */
static size_t valid_file(uint8_t *out)
{
    static const uint8_t texels[16] = { 255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 10, 20, 30, 40 };
    static const uint16_t strip[4] = { 0, 1, 3, 2 };
    static const uint8_t sparse_index[1] = { 2 };
    static const float square[12] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 };
    struct draft d = { 0 };
    char sparse[256], rest[4096], json[8192];
    uint8_t png[1024];
    draft_floats(&d, "VEC3", 4, square);
    draft_accessor(&d, &(struct elements){ strip, sizeof strip, COMPONENT_USHORT, "SCALAR", 4, NULL });
    draft_floats(&d, "VEC2", 4, square);
    draft_accessor(
        &d, &(struct elements){ texels, sizeof texels, COMPONENT_UBYTE, "VEC4", 4, ",\"normalized\":true" });
    const int index_view = draft_view(&d, sparse_index, sizeof sparse_index);
    const int value_view = draft_view(&d, square, 3 * sizeof *square);
    snprintf(sparse, sizeof sparse,
             ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":%d,\"componentType\":5121},\"values\":"
             "{\"bufferView\":%d}}",
             index_view, value_view);
    draft_accessor(&d, &(struct elements){ square, sizeof square, COMPONENT_FLOAT, "VEC3", 4, sparse });
    const int image = draft_view(&d, png, png_encode(&(struct png){ 2, 2, 8, texels }, png, sizeof png));
    snprintf(
        rest, sizeof rest,
        ",\"meshes\":[{\"primitives\":[{\"mode\":5,\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2,\"COLOR_"
        "0\":3,"
        "\"NORMAL\":4},\"indices\":1,\"material\":0},{\"attributes\":{\"POSITION\":4}}]}],\"images\":"
        "[{\"bufferView\":%d}],\"samplers\":[{\"wrapS\":33071}],\"textures\":[{\"source\":0,\"sampler\":0}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"extensions\":"
        "{\"KHR_texture_transform\":{\"offset\":[0,1],\"rotation\":1,\"scale\":[2,2]}}}},\"emissiveFactor\":"
        "[1,1,1],\"alphaMode\":\"MASK\"}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,"
        "\"znear\":0.1}}],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{}"
        "}]}},"
        "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1,2],\"scale\":[2,2,2]},{"
        "\"mesh\":0,"
        "\"rotation\":[0,0,1,0]},{\"camera\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]",
        image);
    draft_json(&d, rest, json, sizeof json);
    return glb_assemble(out, FILE_SIZE, json, d.binary, d.binary_size);
}

/* Digits become other digits more often than chance would have it: they reach beyond the JSON parser. */
static void byte_mutate(uint8_t *byte, uint64_t *state)
{
    if (*byte >= '0' && *byte <= '9' && random_below(state, 4) != 0)
        *byte = (uint8_t)('0' + random_below(state, 10));
    else if (random_below(state, 2) == 0)
        *byte ^= (uint8_t)(1u << random_below(state, 8));
    else
        *byte = (uint8_t)random_next(state);
}

static size_t digit_find(const uint8_t *file, size_t size, size_t from)
{
    for (size_t i = 0; i < size; i++)
        if (file[(from + i) % size] >= '0' && file[(from + i) % size] <= '9')
            return (from + i) % size;
    return from;
}

static size_t mutate(uint8_t *file, size_t size, uint64_t *state)
{
    if (random_below(state, 16) == 0)
        return random_below(state, size);
    const size_t changes = 1 + random_below(state, 3);
    for (size_t i = 0; i < changes; i++) {
        const size_t anywhere = random_below(state, size);
        const bool in_number = random_below(state, 2) == 0;
        byte_mutate(&file[in_number ? digit_find(file, size, anywhere) : anywhere], state);
    }
    return size;
}

/* True where it loaded. */
static bool load_either_way(const char *name)
{
    char error[512];
    struct gltf_scene *const scene = gltf_scene_load(files_path(name), error, sizeof error);
    if (scene != NULL)
        scene_check(scene);
    else
        assert_non_null(strstr(error, name));
    gltf_scene_destroy(scene);
    return scene != NULL;
}

static void mutated_files_load_or_are_refused(void **state)
{
    (void)state;
    static uint8_t valid[FILE_SIZE], mutated[FILE_SIZE];
    const size_t size = valid_file(valid);
    files_write("valid.glb", valid, size);
    assert_true(load_either_way("valid.glb"));
    uint64_t seed = 20240229;
    unsigned loaded = 0;
    double slowest_s = 0;
    for (int round = 0; round < ROUNDS; round++) {
        memcpy(mutated, valid, size);
        files_write("mutated.glb", mutated, mutate(mutated, size, &seed));
        const clock_t start = clock();
        loaded += load_either_way("mutated.glb");
        const double took_s = (double)(clock() - start) / CLOCKS_PER_SEC;
        slowest_s = took_s > slowest_s ? took_s : slowest_s;
    }
    print_message("%d files, %u loaded, slowest %.4f s\n", ROUNDS, loaded, slowest_s);
    /* Both ways out must have been taken, or the mutations do not reach what they are for. */
    assert_in_range(loaded, ROUNDS / 20, ROUNDS - ROUNDS / 20);
    /* Of processor time, with room for sanitizers; nothing so small may claim to be so large. */
    assert_true(slowest_s < 1);
}

static unsigned folder_load(const char *folder)
{
    char path[1400], error[2048];
    unsigned count = 0;
    DIR *const dir = opendir(folder);
    for (struct dirent *entry = dir == NULL ? NULL : readdir(dir); entry != NULL; entry = readdir(dir)) {
        const char *const dot = strrchr(entry->d_name, '.');
        if (dot == NULL || strcmp(dot, ".glb") != 0)
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        struct gltf_scene *const s = gltf_scene_load(path, error, sizeof error);
        if (s == NULL)
            fail_msg("%s", error);
        scene_check(s);
        assert_true(s->instance_count > 0 && s->bounds_max[0] > s->bounds_min[0]);
        print_message("%s: %u primitives, %u instances, %u materials, %u lights\n", entry->d_name,
                      s->primitive_count, s->instance_count, s->material_count, s->light_count);
        gltf_scene_destroy(s);
        count++;
    }
    if (dir != NULL)
        closedir(dir);
    return count;
}

static void shared_scenes_load(void **state)
{
    (void)state;
    char shared[512], folder[1024];
    const char *const from_environment = getenv("SDFGI_SHARED_DIR"), *const source =
                                                                         getenv("SDFGI_SOURCE_DIR");
    if (from_environment != NULL)
        snprintf(shared, sizeof shared, "%s", from_environment);
    else
        snprintf(shared, sizeof shared, "%s/../shared", source == NULL ? "." : source);
    snprintf(folder, sizeof folder, "%s/scenes", shared);
    DIR *const scenes = opendir(folder);
    if (scenes == NULL) {
        print_message("%s is not there: nothing to load\n", folder);
        skip();
    }
    unsigned count = 0;
    for (const struct dirent *entry = readdir(scenes); entry != NULL; entry = readdir(scenes)) {
        if (entry->d_name[0] == '.')
            continue;
        snprintf(folder, sizeof folder, "%s/scenes/%s", shared, entry->d_name);
        count += folder_load(folder);
    }
    closedir(scenes);
    assert_true(count > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mutated_files_load_or_are_refused),
        cmocka_unit_test(shared_scenes_load),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
