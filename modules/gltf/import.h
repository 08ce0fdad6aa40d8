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

struct cJSON;

#include <cstdlib>
#include <map>
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
// What is compressed: Draco writes flat grids at a bit for each triangle, and its vertices at half a byte.
constexpr bound packed_vertex_bound = { "vertices", 64, 1 << 16, UINT64_C(1) << 26 };
constexpr bound packed_index_bound = { "indices", 128, 1 << 18, UINT64_C(1) << 28 };
constexpr bound packed_value_bound = { "compressed values", 512, 1 << 20, UINT64_C(1) << 30 };
constexpr bound unpacked_bound = { "unpacked bytes", 128, 1 << 20, UINT64_C(1) << 32 };
constexpr uint32_t max_image_size = 16384;
// Of one file, since tinygltf measures in 32 bits, and of all buffers: naming one file many times costs
// nothing.
constexpr uint64_t max_file_size = UINT32_MAX;
// Bytes of a name that are kept. A mesh may have very many primitives, and each carries its node's name.
constexpr size_t max_name_size = 255;

constexpr bound keyframe_bound = { "keyframe values", 32, 1 << 16, UINT64_C(1) << 28 };
constexpr bound joint_bound = { "joints of drawn skins", 16, 1 << 16, UINT64_C(1) << 24 };

// Extensions whose decoders are options of the build.
constexpr const char *draco_extension = "KHR_draco_mesh_compression";
constexpr const char *meshopt_extension = "EXT_meshopt_compression";
constexpr const char *webp_extension = "EXT_texture_webp";
constexpr const char *ktx2_extension = "KHR_texture_basisu";
#ifdef GLTF_WITH_DRACO
constexpr bool with_draco = true;
#else
constexpr bool with_draco = false;
#endif
#ifdef GLTF_WITH_MESHOPT
constexpr bool with_meshopt = true;
#else
constexpr bool with_meshopt = false;
#endif
#ifdef GLTF_WITH_WEBP
constexpr bool with_webp = true;
#else
constexpr bool with_webp = false;
#endif
#ifdef GLTF_WITH_KTX2
constexpr bool with_ktx2 = true;
#else
constexpr bool with_ktx2 = false;
#endif

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
    bool high_uv_sets = false;
};

enum class animated { translation, rotation, scale, weights };

struct animation_channel {
    std::string label; // as messages name it
    size_t animation;
    int node;
    animated path;
    int input, output; // accessors
    std::string interpolation;
};

struct skin {
    std::vector<int> joints; // nodes
    int inverse_bind_matrices = -1;
};

struct influence_set {
    std::vector<float> joints, weights; // 4 per vertex
};

// Differences to the vertices at rest, 3 per vertex, or none.
struct morph_target {
    std::vector<float> positions, normals, tangents;
};

struct geometry {
    uint32_t vertex_count = 0;
    std::vector<float> positions, normals, tangents, uv0, uv1, colors;
    std::vector<uint32_t> indices;
    std::vector<influence_set> influences;
    std::vector<morph_target> targets;
    bool is_flat = false; // the normals are those of the triangles
};

// A primitive of the scene whose vertices nodes move. The first node that shows it takes its place.
struct rig {
    geometry rest;
    bool is_placed = false;
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
    uint64_t packed_values = 0, unpacked_bytes = 0; // of Draco and of meshoptimizer
    uint64_t keyframe_values = 0, joints = 0;       // of animations and skins, as often as they are used
    const gltf_pose *pose = nullptr;                // null: at rest
    std::vector<animation_channel> channels;
    std::vector<skin> skins;
    bool has_skins = false;
    std::map<uint32_t, rig> rigs; // by primitive of the scene
    size_t primitive_capacity = 0;
    gltf_scene *scene = nullptr;
};

// file.cpp
bytes file_read(const std::string &path, uint64_t limit);
container container_read(const std::string &path);
bytes resource_read(importer &in, const std::string &uri, const std::string &what, uint64_t limit);

// extensions.cpp
bool extension_is_built(const std::string &name);
[[noreturn]] void extension_refuse(const std::string &name);

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

// The image of a texture, or -1: that of an extension whose decoder is built, or the plain one.
int texture_source(const tinygltf::Texture &texture);

// draco.cpp: replaces the accessors of a primitive with new ones at the end of the model's.
void draco_unpack(importer &in, tinygltf::Primitive &primitive, const std::string &what);

// meshopt.cpp: gives all compressed views buffers of their own.
void meshopt_unpack(importer &in);

// webp.cpp: false where the file is not a WebP image.
bool webp_size(const byte_range &file, uint32_t *width, uint32_t *height);
void webp_decode(gltf_image &image, const byte_range &file, const std::string &what);

// ktx2.cpp: false where the file is not a KTX2 image.
bool ktx2_size(const byte_range &file, uint32_t *width, uint32_t *height);
void ktx2_decode(gltf_image &image, const byte_range &file, const std::string &what);

// material.cpp
void materials_import(importer &in);

// primitive.cpp
void meshes_import(importer &in);
void tangents_make(geometry &g, const gltf_material &material);
void primitive_store(const geometry &g, gltf_primitive &to);
void primitive_free(gltf_primitive &p);

// triangulate.cpp
std::vector<uint32_t> triangles_from(int mode, const std::vector<uint32_t> &order);
void vertices_unshare(geometry &g);

// shading_frame.cpp
void normals_make_flat(geometry &g);
void normals_repair(geometry &g);
void tangents_complete(geometry &g, const std::vector<float> &uv);

// node.cpp
void nodes_import(importer &in);

// matrix.cpp
struct matrix4 {
    double m[16]; // column-major
};
extern const matrix4 identity;
matrix4 multiply(const matrix4 &a, const matrix4 &b);
matrix4 rotation_matrix(const std::vector<double> &quaternion);
matrix4 matrix_from_list(const std::vector<double> &list, const std::string &what);

// animation.cpp: what moves which node; then the nodes of the model as they are at the time of the pose.
void animations_take(importer &in, const cJSON *document);
void animations_apply(importer &in);

// skin.cpp: `worlds` has a matrix for each node; the joints' are returned relative to `origin`.
void skins_take(importer &in, const cJSON *document);
std::vector<matrix4> joint_matrices(importer &in, int skin, const std::vector<matrix4> &worlds,
                                    double origin[3], const std::string &what);

// rig.cpp: the primitive to draw where `primitive` is shown with these weights and joints, which may be none.
uint32_t rig_pose(importer &in, uint32_t primitive, const std::vector<double> &weights,
                  const std::vector<matrix4> &joints, const std::string &what);

// light_camera.cpp
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
