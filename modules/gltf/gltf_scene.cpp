// SPDX-License-Identifier: MIT
//
// The C boundary: runs the import, turns whatever was thrown into one line, and frees scenes.
#include "import.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

namespace gltf
{

void fail(const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    throw bad_file(text);
}

char *text_copy(const std::string &text)
{
    if (text.empty())
        return nullptr;
    char *const copy = array_allocate<char>(text.size() + 1);
    memcpy(copy, text.data(), text.size());
    return copy;
}

// Cut between characters of UTF-8, whose bytes after the first are 10xxxxxx.
char *name_copy(const std::string &name)
{
    if (name.size() <= max_name_size)
        return text_copy(name);
    size_t size = max_name_size;
    while (size > 0 && (static_cast<unsigned char>(name[size]) & 0xc0) == 0x80)
        size--;
    return text_copy(name.substr(0, size));
}

std::string label(const char *array, size_t index)
{
    return std::string(array) + '[' + std::to_string(index) + ']';
}

void primitive_free(gltf_primitive &p)
{
    free(p.positions);
    free(p.normals);
    free(p.tangents);
    free(p.uv0);
    free(p.uv1);
    free(p.colors);
    free(p.indices);
}

// Adds `more` to `sum`, or refuses the file.
void bound_take(const importer &in, uint64_t &sum, uint64_t more, const bound &limits,
                const std::string &what)
{
    const uint64_t limit = std::min(limits.most, std::max(limits.least, limits.per_byte * in.input_bytes));
    if (more > limit || sum > limit - more)
        fail("%s: more than %llu %s, the limit for files of %llu bytes", what.c_str(),
             static_cast<unsigned long long>(limit), limits.noun,
             static_cast<unsigned long long>(in.input_bytes));
    sum += more;
}

namespace
{

// Names in the file can hold anything; messages stay on one line.
std::string one_line(std::string text)
{
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    for (char &c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = ' ';
    return text;
}

void list_append(std::string &list, const std::string &item)
{
    list += (list.empty() ? "" : ", ") + item;
}

char *warning_make(const std::string &path, const omissions &left_out)
{
    std::string list;
    for (const std::string &name : left_out.extensions)
        list_append(list, name);
    if (left_out.high_uv_sets)
        list_append(list, "texture coordinate sets above 1 (set 0 is used)");
    if (left_out.point_and_line_primitives != 0)
        list_append(list,
                    std::to_string(left_out.point_and_line_primitives) + " primitives of points or lines");
    if (left_out.empty_primitives != 0)
        list_append(list, std::to_string(left_out.empty_primitives) + " primitives without a triangle");
    return list.empty() ? nullptr : text_copy(one_line(path + ": not supported and left out: " + list));
}

struct scene_deleter {
    void operator()(gltf_scene *scene) const
    {
        gltf_scene_destroy(scene);
    }
};

gltf_scene *scene_import(const std::string &path, const gltf_pose *pose)
{
    std::unique_ptr<gltf_scene, scene_deleter> scene(array_allocate<gltf_scene>(1));
    importer in;
    in.scene = scene.get();
    in.pose = pose;
    in.folder = path.substr(0, path.find_last_of('/') + 1);
    const container box = container_read(path);
    in.input_bytes = box.file.size();
    document_parse(in, box);
    animations_apply(in);
    materials_import(in);
    meshes_import(in);
    nodes_import(in);
    scene->warning = warning_make(path, in.omitted);
    return scene.release();
}

void error_write(char *error, size_t size, const char *path, const char *text)
{
    if (error == nullptr || size == 0)
        return;
    try {
        snprintf(error, size, "%s", one_line(std::string(path) + ": " + text).c_str());
    } catch (...) {
        snprintf(error, size, "%s: out of memory", path);
    }
}

} // namespace

} // namespace gltf

extern "C" struct gltf_scene *gltf_scene_load(const char *path, char *error, size_t error_size)
{
    return gltf_scene_load_posed(path, nullptr, error, error_size);
}

extern "C" struct gltf_scene *gltf_scene_load_posed(const char *path, const struct gltf_pose *pose,
                                                    char *error, size_t error_size)
{
    if (error != nullptr && error_size != 0)
        error[0] = '\0';
    if (path == nullptr) {
        gltf::error_write(error, error_size, "(no path)", "no file was named");
        return nullptr;
    }
    try {
        return gltf::scene_import(path, pose);
    } catch (const std::bad_alloc &) {
        gltf::error_write(error, error_size, path, "out of memory");
    } catch (const std::exception &problem) {
        gltf::error_write(error, error_size, path, problem.what());
    } catch (...) {
        gltf::error_write(error, error_size, path, "cannot be read");
    }
    return nullptr;
}

// Arrays of a half-built scene are null with any count, or complete.
extern "C" void gltf_scene_destroy(struct gltf_scene *scene)
{
    if (scene == nullptr)
        return;
    for (uint32_t i = 0; scene->images != nullptr && i < scene->image_count; i++)
        free(scene->images[i].texels);
    for (uint32_t i = 0; scene->materials != nullptr && i < scene->material_count; i++)
        free(scene->materials[i].name);
    for (uint32_t i = 0; scene->primitives != nullptr && i < scene->primitive_count; i++)
        gltf::primitive_free(scene->primitives[i]);
    for (uint32_t i = 0; scene->instances != nullptr && i < scene->instance_count; i++)
        free(scene->instances[i].node_name);
    for (uint32_t i = 0; scene->lights != nullptr && i < scene->light_count; i++)
        free(scene->lights[i].name);
    for (uint32_t i = 0; scene->cameras != nullptr && i < scene->camera_count; i++)
        free(scene->cameras[i].name);
    free(scene->images);
    free(scene->textures);
    free(scene->materials);
    free(scene->primitives);
    free(scene->instances);
    free(scene->lights);
    free(scene->cameras);
    free(scene->warning);
    free(scene);
}
