// SPDX-License-Identifier: MIT
//
// What the files of the importer share. An import runs in this order: file.cpp splits the container,
// document.cpp checks the JSON and loads the buffers, tinygltf turns it into a model, and image.cpp,
// material.cpp, primitive.cpp and node.cpp flatten the model. Whatever is wrong is thrown as bad_file; the C
// boundary in gltf_scene.cpp is the only place that catches.
#ifndef GLTF_IMPORT_H
#define GLTF_IMPORT_H

#include "gltf_scene.h"

#include <tiny_gltf.h>

#include <cstdlib>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace gltf
{

struct bad_file : std::runtime_error {
    using std::runtime_error::runtime_error;
};

[[noreturn]] void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

// Bounds on what one file may unpack to, so that a small file cannot claim all memory by naming one accessor
// or image many times. 2^26 vertices are 4 GiB here; 2^31 texels are 8 GiB.
constexpr uint64_t max_vertices = UINT64_C(1) << 26;
constexpr uint64_t max_indices = UINT64_C(1) << 28;
constexpr uint64_t max_instances = UINT64_C(1) << 22;
constexpr uint64_t max_texels = UINT64_C(1) << 31;
constexpr uint32_t max_image_size = 16384;
// Of one file, since tinygltf measures in 32 bits, and of all buffers: naming one file many times costs
// nothing.
constexpr uint64_t max_file_size = UINT32_MAX;
// Bytes of a name that are kept. A mesh may have very many primitives, and each carries its node's name.
constexpr size_t max_name_size = 255;
// Elements of an accessor that has no data of its own (all zeros): nothing in the file backs their number.
constexpr uint64_t max_zero_elements = UINT64_C(1) << 22;

using bytes = std::vector<unsigned char>;

// The container, split: for .gltf files `binary` is empty.
struct container {
    bytes file;
    const char *json = nullptr;
    size_t json_size = 0;
    const unsigned char *binary = nullptr;
    size_t binary_size = 0;
};

struct image_source {
    std::string uri;
    int buffer_view = -1;
};

// What the file uses and this importer leaves out; becomes the warning.
struct omissions {
    std::set<std::string> extensions;
    uint64_t point_and_line_primitives = 0;
    uint64_t empty_primitives = 0;
    bool skins = false;
    bool morph_targets = false;
    bool animations = false;
    bool high_uv_sets = false;
};

struct importer {
    std::string folder; // of the file, with its slash, or empty
    tinygltf::Model model;
    std::vector<image_source> images;
    omissions omitted;
    std::vector<std::vector<uint32_t>> mesh_primitives; // per mesh of the file: primitives of the scene
    size_t materials_in_file = 0;
    uint64_t vertices = 0, indices = 0; // unpacked so far
    uint64_t buffer_bytes = 0;          // loaded so far
    gltf_scene *scene = nullptr;
};

// file.cpp
bytes file_read(const std::string &path, uint64_t limit);
container container_read(const std::string &path);
bytes resource_read(const importer &in, const std::string &uri, const std::string &what, uint64_t limit);

// document.cpp
void document_parse(importer &in, const container &box);

// accessor.cpp
struct byte_range {
    const unsigned char *data;
    size_t size;
};
byte_range buffer_view_bytes(const tinygltf::Model &model, int view, const std::string &user);
const tinygltf::Accessor &accessor_get(const tinygltf::Model &model, int index, const std::string &user);
int accessor_components(const tinygltf::Accessor &accessor);
std::vector<float> accessor_read_floats(const tinygltf::Model &model, int index, const std::string &user,
                                        bool integers_are_normalized);
std::vector<uint32_t> accessor_read_indices(const tinygltf::Model &model, int index, const std::string &user);

// jpeg.cpp
void jpeg_check(const byte_range &file, const std::string &what);

// image.cpp
std::vector<int32_t> images_import(importer &in);

// material.cpp
void materials_import(importer &in);

// primitive.cpp
struct geometry {
    uint32_t vertex_count = 0;
    std::vector<float> positions, normals, tangents, uv0, uv1, colors;
    std::vector<uint32_t> indices;
};
void meshes_import(importer &in);

// triangulate.cpp
std::vector<uint32_t> triangles_from(int mode, const std::vector<uint32_t> &order);
void vertices_unshare(geometry &g);

// shading_frame.cpp
void normals_make_flat(geometry &g);
void normals_repair(geometry &g);
void tangents_complete(geometry &g, const std::vector<float> &uv);

// node.cpp
void nodes_import(importer &in);

// light_camera.cpp
struct matrix4 {
    double m[16]; // column-major
};
void light_import(importer &in, std::vector<gltf_light> &lights, int index, const matrix4 &world);
void camera_import(importer &in, std::vector<gltf_camera> &cameras, int index, const matrix4 &world);

// gltf_scene.cpp
char *text_copy(const std::string &text);
char *name_copy(const std::string &name);
std::string label(const char *array, size_t index);

// Zeroed, to be freed by gltf_scene_destroy.
template <typename T> T *array_allocate(size_t count)
{
    if (count == 0)
        return nullptr;
    void *const memory = calloc(count, sizeof(T));
    if (memory == nullptr)
        throw std::bad_alloc();
    return static_cast<T *>(memory);
}

template <typename T> T *array_copy(const std::vector<T> &from)
{
    T *const to = array_allocate<T>(from.size());
    std::copy(from.begin(), from.end(), to);
    return to;
}

} // namespace gltf

#endif
