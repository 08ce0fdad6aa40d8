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

// A bound on what an import unpacks: `per_byte` for each byte of its files, but no less than `least` and no
// more than `most`. Many primitives may name one accessor, nodes one mesh, images one view, and buffers one
// file: without bounds, work would grow with the square of the size of a file.
struct bound {
    const char *noun;
    uint64_t per_byte, least, most;
};

// 1000 primitives that share vertices of 32 bytes have 31 vertices a byte. 2^26 vertices are 4 GiB here.
constexpr bound vertex_bound = { "vertices", 32, 0, UINT64_C(1) << 26 };
constexpr bound index_bound = { "indices", 32, 0, UINT64_C(1) << 28 };
constexpr bound instance_bound = { "instances", 16, 0, UINT64_C(1) << 22 };
// A byte of deflated data stands for 1032 at most. Four images of 4096 x 4096 in one colour need far less.
constexpr bound texel_bound = { "texels", 1032, UINT64_C(1) << 26, UINT64_C(1) << 31 };
constexpr bound read_bound = { "bytes to read", 16, 0, UINT64_MAX };
constexpr uint32_t max_image_size = 16384;
// Of one file, since tinygltf measures in 32 bits, and of all buffers: naming one file many times costs
// nothing.
constexpr uint64_t max_file_size = UINT32_MAX;
// Bytes of a name that are kept. A mesh may have very many primitives, and each carries its node's name.
constexpr size_t max_name_size = 255;

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
    std::set<std::string> files_read; // real paths of what the file names
    uint64_t input_bytes = 0;         // of the file, and of those that it names, each counted once
    uint64_t read_bytes = 0;          // of those that it names, as often as they are read
    uint64_t buffer_bytes = 0;        // loaded so far
    uint64_t vertices = 0, indices = 0, texels = 0; // unpacked so far
    gltf_scene *scene = nullptr;
};

// file.cpp
bytes file_read(const std::string &path, uint64_t limit);
container container_read(const std::string &path);
bytes resource_read(importer &in, const std::string &uri, const std::string &what, uint64_t limit);

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
void bound_take(const importer &in, uint64_t &sum, uint64_t more, const bound &limits,
                const std::string &what);

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
