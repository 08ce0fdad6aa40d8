/* SPDX-License-Identifier: MIT */
#include "scene_files.h"

#include <string.h>

static void u32_put(uint8_t *p, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(value >> (8 * i));
}

/* Chunks are padded to four bytes: JSON with spaces, binary with zeros. */
size_t glb_assemble(uint8_t *out, size_t capacity, const char *json, const void *binary, size_t binary_size)
{
    const size_t json_size = strlen(json), json_chunk = (json_size + 3) / 4 * 4;
    const size_t binary_chunk = (binary_size + 3) / 4 * 4;
    const size_t total = 20 + json_chunk + (binary_size == 0 ? 0 : 8 + binary_chunk);
    assert_true(total <= capacity);
    memset(out, 0, total);
    memcpy(out, "glTF", 4);
    u32_put(out + 4, 2);
    u32_put(out + 8, (uint32_t)total);
    u32_put(out + 12, (uint32_t)json_chunk);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', json_chunk);
    memcpy(out + 20, json, json_size);
    if (binary_size != 0) {
        u32_put(out + 20 + json_chunk, (uint32_t)binary_chunk);
        memcpy(out + 24 + json_chunk, "BIN", 4);
        memcpy(out + 28 + json_chunk, binary, binary_size);
    }
    return total;
}

static void text_append(char *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void text_append(char *text, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text + used, DRAFT_TEXT_SIZE - used, format, arguments);
    va_end(arguments);
    assert_true(length >= 0 && used + (size_t)length < DRAFT_TEXT_SIZE);
}

int draft_view(struct draft *d, const void *data, size_t size)
{
    assert_true(d->binary_size + size + 4 <= DRAFT_BINARY_SIZE);
    memcpy(d->binary + d->binary_size, data, size);
    text_append(d->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                d->view_count == 0 ? "" : ",", d->binary_size, size);
    d->binary_size = (d->binary_size + size + 3) / 4 * 4;
    return d->view_count++;
}

int draft_accessor(struct draft *d, const struct elements *e)
{
    text_append(d->accessors, "%s{\"componentType\":%d,\"type\":\"%s\",\"count\":%d%s",
                d->accessor_count == 0 ? "" : ",", (int)e->component, e->type, e->count,
                e->more == NULL ? "" : e->more);
    if (e->data != NULL)
        text_append(d->accessors, ",\"bufferView\":%d", draft_view(d, e->data, e->size));
    text_append(d->accessors, "}");
    return d->accessor_count++;
}

int draft_floats(struct draft *d, const char *type, int count, const float *values)
{
    const size_t components = type[0] == 'V' ? (size_t)(type[3] - '0') : 1;
    return draft_accessor(d, &(struct elements){ values, (size_t)count * components * sizeof *values,
                                                 COMPONENT_FLOAT, type, count, NULL });
}

void draft_json(const struct draft *d, const char *rest, char *out, size_t size)
{
    int length = snprintf(out, size, "{\"asset\":{\"version\":\"2.0\"}%s", rest);
    if (d->accessor_count != 0)
        length += snprintf(out + length, size - (size_t)length, ",\"accessors\":[%s]", d->accessors);
    if (d->view_count != 0)
        length +=
            snprintf(out + length, size - (size_t)length,
                     ",\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}]", d->views, d->binary_size);
    length += snprintf(out + length, size - (size_t)length, "}");
    assert_true((size_t)length < size);
}

void draft_write(const struct draft *d, const char *rest, const char *name)
{
    char json[3 * DRAFT_TEXT_SIZE];
    uint8_t file[sizeof json + DRAFT_BINARY_SIZE];
    draft_json(d, rest, json, sizeof json);
    files_write(name, file, glb_assemble(file, sizeof file, json, d->binary, d->binary_size));
}

struct gltf_scene *file_load(const char *name)
{
    char error[512];
    struct gltf_scene *const scene = gltf_scene_load(files_path(name), error, sizeof error);
    if (scene == NULL)
        fail_msg("%s", error);
    scene_check(scene);
    return scene;
}

struct gltf_scene *draft_load(const struct draft *d, const char *rest)
{
    draft_write(d, rest, "draft.glb");
    return file_load("draft.glb");
}

static struct gltf_scene *load(const char *name, char *error, size_t size)
{
    struct gltf_scene *const scene = gltf_scene_load(files_path(name), error, size);
    if (scene != NULL)
        scene_check(scene);
    return scene;
}

void packed_write(const void *data, size_t size, const char *rest)
{
    struct draft d = { 0 };
    draft_view(&d, data, size);
    draft_write(&d, rest, "packed.glb");
}

void refused_with(const char *wrong)
{
    char error[512];
    struct gltf_scene *const scene = load("packed.glb", error, sizeof error);
    gltf_scene_destroy(scene);
    if (scene != NULL || strstr(error, wrong) == NULL || strchr(error, '\n') != NULL)
        fail_msg("the message is '%s'; it should hold '%s'", scene == NULL ? error : "(loaded)", wrong);
}
