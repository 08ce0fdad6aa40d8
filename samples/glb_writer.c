/* SPDX-License-Identifier: MIT */
#include "glb_writer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>
#include <cglm/cglm.h>
#include <stb_image_write.h>

#include "file_write.h"

/* Numbers of the glTF 2.0 specification. */
enum {
    GLTF_FLOAT = 5126,
    GLTF_UNSIGNED_INT = 5125,
    GLTF_UNSIGNED_SHORT = 5123,
    GLTF_ARRAY_BUFFER = 34962,
    GLTF_ELEMENT_ARRAY_BUFFER = 34963,
    GLTF_LINEAR = 9729,
    GLTF_LINEAR_MIPMAP_LINEAR = 9987,
    GLTF_REPEAT = 10497,
};

struct glb_writer {
    cJSON *root, *nodes, *scene_nodes, *meshes, *materials, *textures, *images, *accessors, *views, *lights,
        *cameras;
    uint8_t *bytes;
    size_t byte_count, byte_capacity;
    bool emissive_strength;
    const char *failure;
};

static void fail(struct glb_writer *writer, const char *why)
{
    if (!writer->failure)
        writer->failure = why;
}

/* ---- JSON helpers ----------------------------------------------------------------------------------- */

static cJSON *array_add(struct glb_writer *writer, cJSON *parent, const char *name)
{
    cJSON *array = cJSON_AddArrayToObject(parent, name);
    if (!array)
        fail(writer, "out of memory");
    return array;
}

/* Appends an object to `array` and returns it. */
static cJSON *object_append(struct glb_writer *writer, cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    if (!object || !cJSON_AddItemToArray(array, object))
        fail(writer, "out of memory");
    return object;
}

static cJSON *object_add(struct glb_writer *writer, cJSON *parent, const char *name)
{
    cJSON *object = cJSON_AddObjectToObject(parent, name);
    if (!object)
        fail(writer, "out of memory");
    return object;
}

static void number_add(struct glb_writer *writer, cJSON *parent, const char *name, double value)
{
    if (!cJSON_AddNumberToObject(parent, name, value))
        fail(writer, "out of memory");
}

static void string_add(struct glb_writer *writer, cJSON *parent, const char *name, const char *value)
{
    if (value && !cJSON_AddStringToObject(parent, name, value))
        fail(writer, "out of memory");
}

static void numbers_add(struct glb_writer *writer, cJSON *parent, const char *name, const float *values,
                        int count)
{
    cJSON *array = cJSON_CreateFloatArray(values, count);
    if (!array || !cJSON_AddItemToObject(parent, name, array))
        fail(writer, "out of memory");
}

static glb_handle last_handle(const cJSON *array)
{
    return (glb_handle)cJSON_GetArraySize(array);
}

/* ---- Binary chunk ----------------------------------------------------------------------------------- */

static void *bytes_append(struct glb_writer *writer, size_t size)
{
    const size_t start = (writer->byte_count + 3) & ~(size_t)3;
    if (start + size > writer->byte_capacity) {
        const size_t capacity = (start + size) * 2;
        uint8_t *grown = realloc(writer->bytes, capacity);
        if (!grown) {
            fail(writer, "out of memory");
            return NULL;
        }
        writer->bytes = grown;
        writer->byte_capacity = capacity;
    }
    memset(writer->bytes + writer->byte_count, 0, start - writer->byte_count);
    writer->byte_count = start + size;
    return writer->bytes + start;
}

/* Describes the last `size` bytes as a buffer view and returns its index. */
static int view_add(struct glb_writer *writer, size_t size, int target)
{
    cJSON *view = object_append(writer, writer->views);
    number_add(writer, view, "buffer", 0);
    number_add(writer, view, "byteOffset", (double)(writer->byte_count - size));
    number_add(writer, view, "byteLength", (double)size);
    if (target)
        number_add(writer, view, "target", target);
    return cJSON_GetArraySize(writer->views) - 1;
}

static cJSON *accessor_add(struct glb_writer *writer, size_t size, int target, int component,
                           const char *type, uint32_t count)
{
    const int view = view_add(writer, size, target);
    cJSON *accessor = object_append(writer, writer->accessors);
    number_add(writer, accessor, "bufferView", view);
    number_add(writer, accessor, "componentType", component);
    number_add(writer, accessor, "count", count);
    string_add(writer, accessor, "type", type);
    return accessor;
}

static int floats_add(struct glb_writer *writer, const float *values, uint32_t count, int components)
{
    const char *const types[] = { "", "SCALAR", "VEC2", "VEC3", "VEC4" };
    const size_t size = sizeof(float) * (size_t)components * count;
    void *target = bytes_append(writer, size);
    if (target)
        memcpy(target, values, size);
    accessor_add(writer, size, GLTF_ARRAY_BUFFER, GLTF_FLOAT, types[components], count);
    return cJSON_GetArraySize(writer->accessors) - 1;
}

static int positions_add(struct glb_writer *writer, const float *positions, uint32_t count)
{
    float low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (uint32_t i = 0; i < 3 * count; i++) {
        low[i % 3] = fminf(low[i % 3], positions[i]);
        high[i % 3] = fmaxf(high[i % 3], positions[i]);
    }
    const int index = floats_add(writer, positions, count, 3);
    cJSON *accessor = cJSON_GetArrayItem(writer->accessors, index);
    numbers_add(writer, accessor, "min", low, 3);
    numbers_add(writer, accessor, "max", high, 3);
    return index;
}

static int colors_add(struct glb_writer *writer, const float *colors, uint32_t count)
{
    const size_t size = sizeof(uint16_t) * 4 * (size_t)count;
    uint16_t *target = bytes_append(writer, size);
    for (size_t i = 0; target && i < 4 * (size_t)count; i++)
        target[i] = (uint16_t)lrintf(65535.0f * fminf(fmaxf(colors[i], 0.0f), 1.0f));
    cJSON *accessor = accessor_add(writer, size, GLTF_ARRAY_BUFFER, GLTF_UNSIGNED_SHORT, "VEC4", count);
    if (!cJSON_AddTrueToObject(accessor, "normalized"))
        fail(writer, "out of memory");
    return cJSON_GetArraySize(writer->accessors) - 1;
}

/* 16-bit indices wherever they fit, which halves them for almost every mesh. */
static int indices_add(struct glb_writer *writer, const struct glb_primitive *primitive)
{
    const bool small = primitive->vertex_count < 65535;
    const size_t size = (small ? sizeof(uint16_t) : sizeof(uint32_t)) * primitive->index_count;
    void *target = bytes_append(writer, size);
    for (uint32_t i = 0; target && i < primitive->index_count; i++) {
        if (primitive->indices[i] >= primitive->vertex_count)
            fail(writer, "a primitive has an index out of range");
        if (small)
            ((uint16_t *)target)[i] = (uint16_t)primitive->indices[i];
        else
            ((uint32_t *)target)[i] = primitive->indices[i];
    }
    accessor_add(writer, size, GLTF_ELEMENT_ARRAY_BUFFER, small ? GLTF_UNSIGNED_SHORT : GLTF_UNSIGNED_INT,
                 "SCALAR", primitive->index_count);
    return cJSON_GetArraySize(writer->accessors) - 1;
}

/* ---- Textures and materials -------------------------------------------------------------------------- */

static void png_append(void *user, void *data, int size)
{
    struct glb_writer *writer = user;
    void *target = bytes_append(writer, (size_t)size);
    if (target)
        memcpy(target, data, (size_t)size);
    view_add(writer, (size_t)size, 0);
}

glb_handle glb_writer_add_texture(struct glb_writer *writer, const char *name, uint32_t width,
                                  uint32_t height, uint32_t channels, const uint8_t *texels)
{
    if (channels < 3 || channels > 4 || !width || !height) {
        fail(writer, "a texture needs 3 or 4 channels and a size");
        return 0;
    }
    /* stb hands over the whole file in one call. */
    if (!stbi_write_png_to_func(png_append, writer, (int)width, (int)height, (int)channels, texels,
                                (int)(width * channels)))
        fail(writer, "a texture could not be encoded");
    cJSON *image = object_append(writer, writer->images);
    string_add(writer, image, "name", name);
    string_add(writer, image, "mimeType", "image/png");
    number_add(writer, image, "bufferView", cJSON_GetArraySize(writer->views) - 1);
    cJSON *texture = object_append(writer, writer->textures);
    number_add(writer, texture, "source", cJSON_GetArraySize(writer->images) - 1);
    number_add(writer, texture, "sampler", 0);
    return last_handle(writer->textures);
}

static void texture_refer(struct glb_writer *writer, cJSON *parent, const char *name, glb_handle texture)
{
    if (!texture)
        return;
    if (texture > last_handle(writer->textures))
        fail(writer, "a material refers to a texture that was never added");
    number_add(writer, object_add(writer, parent, name), "index", texture - 1);
}

static void emission_add(struct glb_writer *writer, cJSON *material, const float emission[3])
{
    const float strength = fmaxf(emission[0], fmaxf(emission[1], emission[2]));
    if (!(strength > 0))
        return;
    const float scale = strength > 1 ? 1 / strength : 1;
    const float factor[3] = { emission[0] * scale, emission[1] * scale, emission[2] * scale };
    numbers_add(writer, material, "emissiveFactor", factor, 3);
    if (strength <= 1)
        return;
    writer->emissive_strength = true;
    cJSON *extensions = object_add(writer, material, "extensions");
    cJSON *extension = object_add(writer, extensions, "KHR_materials_emissive_strength");
    number_add(writer, extension, "emissiveStrength", strength);
}

glb_handle glb_writer_add_material(struct glb_writer *writer, const struct glb_material *material)
{
    cJSON *object = object_append(writer, writer->materials);
    string_add(writer, object, "name", material->name);
    cJSON *pbr = object_add(writer, object, "pbrMetallicRoughness");
    numbers_add(writer, pbr, "baseColorFactor", material->base_color, 4);
    number_add(writer, pbr, "metallicFactor", material->metallic);
    number_add(writer, pbr, "roughnessFactor", material->roughness);
    texture_refer(writer, pbr, "baseColorTexture", material->base_color_texture);
    texture_refer(writer, object, "normalTexture", material->normal_texture);
    texture_refer(writer, object, "emissiveTexture", material->emission_texture);
    emission_add(writer, object, material->emission);
    if (material->alpha_cutoff > 0) {
        string_add(writer, object, "alphaMode", "MASK");
        number_add(writer, object, "alphaCutoff", material->alpha_cutoff);
    }
    if (material->double_sided && !cJSON_AddTrueToObject(object, "doubleSided"))
        fail(writer, "out of memory");
    return last_handle(writer->materials);
}

/* ---- Meshes and nodes -------------------------------------------------------------------------------- */

static void primitive_add(struct glb_writer *writer, cJSON *list, const struct glb_primitive *primitive)
{
    if (!primitive->vertex_count || !primitive->index_count || primitive->index_count % 3) {
        fail(writer, "a primitive has no triangles");
        return;
    }
    const uint32_t count = primitive->vertex_count;
    cJSON *object = object_append(writer, list);
    cJSON *attributes = object_add(writer, object, "attributes");
    number_add(writer, attributes, "POSITION", positions_add(writer, primitive->positions, count));
    if (primitive->normals)
        number_add(writer, attributes, "NORMAL", floats_add(writer, primitive->normals, count, 3));
    if (primitive->uvs)
        number_add(writer, attributes, "TEXCOORD_0", floats_add(writer, primitive->uvs, count, 2));
    if (primitive->colors)
        number_add(writer, attributes, "COLOR_0", colors_add(writer, primitive->colors, count));
    number_add(writer, object, "indices", indices_add(writer, primitive));
    if (primitive->material > last_handle(writer->materials))
        fail(writer, "a primitive refers to a material that was never added");
    if (primitive->material)
        number_add(writer, object, "material", primitive->material - 1);
}

glb_handle glb_writer_add_mesh(struct glb_writer *writer, const char *name,
                               const struct glb_primitive *primitives, uint32_t count)
{
    cJSON *mesh = object_append(writer, writer->meshes);
    string_add(writer, mesh, "name", name);
    cJSON *list = array_add(writer, mesh, "primitives");
    for (uint32_t i = 0; i < count; i++)
        primitive_add(writer, list, &primitives[i]);
    return last_handle(writer->meshes);
}

static cJSON *node_add(struct glb_writer *writer, const char *name)
{
    cJSON *index = cJSON_CreateNumber(cJSON_GetArraySize(writer->nodes));
    if (!index || !cJSON_AddItemToArray(writer->scene_nodes, index))
        fail(writer, "out of memory");
    cJSON *node = object_append(writer, writer->nodes);
    string_add(writer, node, "name", name);
    return node;
}

void glb_writer_add_node(struct glb_writer *writer, const char *name, glb_handle mesh, const float *transform)
{
    if (!mesh || mesh > last_handle(writer->meshes)) {
        fail(writer, "a node refers to a mesh that was never added");
        return;
    }
    cJSON *node = node_add(writer, name);
    number_add(writer, node, "mesh", mesh - 1);
    if (transform)
        numbers_add(writer, node, "matrix", transform, 16);
}

/* ---- Lights and cameras ------------------------------------------------------------------------------ */

/* Lights and cameras of glTF look along -Z of their node. */
static void node_aim(struct glb_writer *writer, cJSON *node, const float position[3],
                     const float direction[3])
{
    vec3 eye = { position[0], position[1], position[2] };
    vec3 look = { direction[0], direction[1], direction[2] };
    glm_vec3_normalize(look);
    vec3 up = { 0, fabsf(look[1]) < 0.999f, fabsf(look[1]) >= 0.999f };
    mat4 matrix;
    glm_look(eye, look, up, matrix);
    glm_mat4_inv(matrix, matrix);
    numbers_add(writer, node, "matrix", (const float *)matrix, 16);
}

void glb_writer_add_light(struct glb_writer *writer, const struct glb_light *light)
{
    const char *const types[] = { "directional", "point", "spot" };
    const float down[3] = { 0, -1, 0 };
    cJSON *object = object_append(writer, writer->lights);
    string_add(writer, object, "name", light->name);
    string_add(writer, object, "type", types[light->type]);
    numbers_add(writer, object, "color", light->color, 3);
    number_add(writer, object, "intensity", light->intensity);
    if (light->range_m > 0 && light->type != GLB_LIGHT_DIRECTIONAL)
        number_add(writer, object, "range", light->range_m);
    if (light->type == GLB_LIGHT_SPOT) {
        cJSON *spot = object_add(writer, object, "spot");
        number_add(writer, spot, "innerConeAngle", light->inner_rad);
        number_add(writer, spot, "outerConeAngle", light->outer_rad);
    }
    cJSON *node = node_add(writer, light->name);
    node_aim(writer, node, light->position, light->type == GLB_LIGHT_POINT ? down : light->direction);
    cJSON *extension = object_add(writer, object_add(writer, node, "extensions"), "KHR_lights_punctual");
    number_add(writer, extension, "light", last_handle(writer->lights) - 1);
}

void glb_writer_add_camera(struct glb_writer *writer, const struct glb_camera *camera)
{
    cJSON *object = object_append(writer, writer->cameras);
    string_add(writer, object, "name", camera->name);
    string_add(writer, object, "type", "perspective");
    cJSON *perspective = object_add(writer, object, "perspective");
    number_add(writer, perspective, "yfov", camera->yfov_rad);
    number_add(writer, perspective, "znear", 0.05);
    cJSON *node = node_add(writer, camera->name);
    const float direction[3] = { camera->look_at[0] - camera->position[0],
                                 camera->look_at[1] - camera->position[1],
                                 camera->look_at[2] - camera->position[2] };
    node_aim(writer, node, camera->position, direction);
    number_add(writer, node, "camera", last_handle(writer->cameras) - 1);
}

/* ---- The file ---------------------------------------------------------------------------------------- */

struct glb_writer *glb_writer_create(const char *generator)
{
    struct glb_writer *writer = calloc(1, sizeof(*writer));
    if (!writer)
        return NULL;
    writer->root = cJSON_CreateObject();
    cJSON *asset = object_add(writer, writer->root, "asset");
    string_add(writer, asset, "version", "2.0");
    string_add(writer, asset, "generator", generator);
    number_add(writer, writer->root, "scene", 0);
    writer->scene_nodes =
        array_add(writer, object_append(writer, array_add(writer, writer->root, "scenes")), "nodes");
    writer->nodes = array_add(writer, writer->root, "nodes");
    writer->meshes = array_add(writer, writer->root, "meshes");
    writer->accessors = array_add(writer, writer->root, "accessors");
    writer->views = array_add(writer, writer->root, "bufferViews");
    /* glTF forbids empty arrays, so these join the root only when something is in them. */
    writer->materials = cJSON_CreateArray();
    writer->textures = cJSON_CreateArray();
    writer->images = cJSON_CreateArray();
    writer->lights = cJSON_CreateArray();
    writer->cameras = cJSON_CreateArray();
    return writer;
}

void glb_writer_destroy(struct glb_writer *writer)
{
    if (!writer)
        return;
    cJSON_Delete(writer->root);
    cJSON_Delete(writer->materials);
    cJSON_Delete(writer->textures);
    cJSON_Delete(writer->images);
    cJSON_Delete(writer->lights);
    cJSON_Delete(writer->cameras);
    free(writer->bytes);
    free(writer);
}

static void sampler_add(struct glb_writer *writer, cJSON *root)
{
    cJSON *sampler = object_append(writer, array_add(writer, root, "samplers"));
    number_add(writer, sampler, "magFilter", GLTF_LINEAR);
    number_add(writer, sampler, "minFilter", GLTF_LINEAR_MIPMAP_LINEAR);
    number_add(writer, sampler, "wrapS", GLTF_REPEAT);
    number_add(writer, sampler, "wrapT", GLTF_REPEAT);
}

/* Moves `array` into the root unless it is empty, which glTF forbids. */
static void array_attach(struct glb_writer *writer, cJSON *root, const char *name, const cJSON *array)
{
    if (cJSON_GetArraySize(array) && !cJSON_AddItemToObject(root, name, cJSON_Duplicate(array, true)))
        fail(writer, "out of memory");
}

static void extensions_attach(struct glb_writer *writer, cJSON *root)
{
    const bool lights = cJSON_GetArraySize(writer->lights) > 0;
    if (!lights && !writer->emissive_strength)
        return;
    cJSON *used = array_add(writer, root, "extensionsUsed");
    if (lights)
        cJSON_AddItemToArray(used, cJSON_CreateString("KHR_lights_punctual"));
    if (writer->emissive_strength)
        cJSON_AddItemToArray(used, cJSON_CreateString("KHR_materials_emissive_strength"));
    if (!lights)
        return;
    cJSON *extension = object_add(writer, object_add(writer, root, "extensions"), "KHR_lights_punctual");
    array_attach(writer, extension, "lights", writer->lights);
}

/* The whole JSON chunk as text; the caller frees it with cJSON_free. NULL on failure. */
static char *json_print(struct glb_writer *writer)
{
    cJSON *root = cJSON_Duplicate(writer->root, true);
    array_attach(writer, root, "materials", writer->materials);
    array_attach(writer, root, "textures", writer->textures);
    array_attach(writer, root, "images", writer->images);
    array_attach(writer, root, "cameras", writer->cameras);
    extensions_attach(writer, root);
    if (cJSON_GetArraySize(writer->textures))
        sampler_add(writer, root);
    cJSON *buffer = object_append(writer, array_add(writer, root, "buffers"));
    number_add(writer, buffer, "byteLength", (double)writer->byte_count);
    char *text = writer->failure ? NULL : cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    return text;
}

bool glb_writer_save(struct glb_writer *writer, const char *path, char *error, size_t error_size)
{
    char *json = json_print(writer);
    if (!json) {
        snprintf(error, error_size, "%s: %s", path, writer->failure ? writer->failure : "out of memory");
        return false;
    }
    const size_t json_size = strlen(json), json_padded = (json_size + 3) & ~(size_t)3;
    const size_t bin_padded = (writer->byte_count + 3) & ~(size_t)3;
    /* "glTF", version 2, total size; then size and tag of each chunk: the glb layout of the specification. */
    const uint32_t header[5] = { 0x46546C67, 2, (uint32_t)(28 + json_padded + bin_padded),
                                 (uint32_t)json_padded, 0x4E4F534A };
    const uint32_t bin_header[2] = { (uint32_t)bin_padded, 0x004E4942 };
    const struct file_part parts[] = {
        { header, sizeof(header) },
        { json, json_size },
        { "   ", json_padded - json_size },
        { bin_header, sizeof(bin_header) },
        { writer->bytes, writer->byte_count },
        { "\0\0\0", bin_padded - writer->byte_count },
    };
    const bool ok = file_write_parts(path, parts, sizeof(parts) / sizeof(parts[0]), error, error_size);
    cJSON_free(json);
    return ok;
}
