/* SPDX-License-Identifier: MIT
 * Changes to JSON that keep it JSON: numbers, strings and whole elements. In a GLB the JSON chunk changes. */
#include "fuzz.h"

#include <cjson/cJSON.h>

#include <stdlib.h>
#include <string.h>

enum { NODES_MAX = 4096, CHANGES_MAX = 3, GLB_HEAD = 20 };

/* Limits of types and of the formats, and glTF's numbers of component types. */
static const double numbers[] = {
    0,
    1,
    2,
    3,
    4,
    5,
    -1,
    -0.0,
    0.5,
    1.5,
    -2,
    7,
    15,
    16,
    17,
    64,
    127,
    128,
    255,
    256,
    1024,
    1025,
    4096,
    4097,
    5120,
    5121,
    5122,
    5123,
    5125,
    5126,
    65535,
    65536,
    1e6,
    1e9,
    1e12,
    1e15,
    1e19,
    1e38,
    3.5e38,
    1e300,
    -1e300,
    1e-6,
    1e-20,
    1e-38,
    1e-45,
    1e-300,
    90,
    179,
    180,
    3.14159265358979,
    4194304,
    4194305,
    33071,
    33648,
    10497,
    9728,
    9987,
    4294967295.0,
    1.5e11,
    0.70710678118654752,
    2147483647,
    2147483648.0,
    -2147483648.0,
    4294967296.0,
};

static const char *const strings[] = {
    "",
    "SCALAR",
    "VEC2",
    "VEC3",
    "VEC4",
    "MAT4",
    "MASK",
    "BLEND",
    "OPAQUE",
    "point",
    "spot",
    "directional",
    "perspective",
    "orthographic",
    "gltf",
    "lambert",
    "data:;base64,AAAA",
    "data:application/octet-stream;base64,",
    "data:image/png;base64,iVBORw0KGgo=",
    "fuzzed.glb",
    "../fuzzed.glb",
    "%2e%2e/x",
    "%00",
    "%",
    "/",
    "2.0",
    "buffer-0",
    "image/png",
    "image/jpeg",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "\n\x1b\x7f",
    "\xc3\x28",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "POSITION",
    "TEXCOORD_1",
};

struct nodes {
    cJSON *all[NODES_MAX], *parents[NODES_MAX];
    uint32_t count;
};

static void collect(struct nodes *nodes, cJSON *parent)
{
    for (cJSON *child = parent->child; child && nodes->count < NODES_MAX; child = child->next) {
        nodes->all[nodes->count] = child;
        nodes->parents[nodes->count++] = parent;
        collect(nodes, child);
    }
}

static uint32_t below(struct test_random *random, size_t limit)
{
    return test_random_uint(random) % (uint32_t)limit;
}

/* ---- Changes ---------------------------------------------------------------------------------------- */

static void change_number(cJSON *node, struct test_random *random)
{
    const double value = node->valuedouble;
    const double near[] = { value + 1, value - 1, -value, value * 2, value / 2, value * 1e6, value * 1e-6 };
    const size_t near_count = sizeof near / sizeof *near, all = near_count + sizeof numbers / sizeof *numbers;
    const size_t index = below(random, all);
    cJSON_SetNumberHelper(node, index < near_count ? near[index] : numbers[index - near_count]);
}

static void change_string(cJSON *node, const cJSON *other, struct test_random *random)
{
    const char *const text = cJSON_IsString(other) && below(random, 2)
                                 ? other->valuestring
                                 : strings[below(random, sizeof strings / sizeof *strings)];
    cJSON *const changed = cJSON_CreateString(text);
    char *const old = node->valuestring;
    node->valuestring = changed->valuestring;
    changed->valuestring = old;
    cJSON_Delete(changed);
}

static void change_kind(cJSON *node, struct test_random *random)
{
    static const int kinds[] = { cJSON_NULL, cJSON_True, cJSON_False };
    if (!cJSON_IsString(node) && !node->child)
        node->type = kinds[below(random, 3)];
}

static void change_value(cJSON *node, const cJSON *other, struct test_random *random)
{
    if (cJSON_IsNumber(node) && below(random, 16))
        change_number(node, random);
    else if (cJSON_IsString(node))
        change_string(node, other, random);
    else
        change_kind(node, random);
}

/* A copy of `other` goes into `parent`, under its own name or that of `beside`. */
static void add_copy(cJSON *parent, const cJSON *other, const cJSON *beside)
{
    cJSON *const copy = cJSON_Duplicate(other, true);
    const char *const name = other->string ? other->string : beside->string;
    if (cJSON_IsArray(parent))
        cJSON_AddItemToArray(parent, copy);
    else
        cJSON_AddItemToObject(parent, name ? name : "x", copy);
}

static void replace(cJSON *parent, cJSON *node, const cJSON *other)
{
    cJSON *const copy = cJSON_Duplicate(other, true);
    char *const name = copy->string;
    copy->string = node->string;
    node->string = name;
    cJSON_ReplaceItemViaPointer(parent, node, copy);
}

/* Half of the changes are to values: those of the structure are mostly refused at once. */
static void change(cJSON *root, struct test_random *random)
{
    static struct nodes nodes;
    nodes.count = 0;
    collect(&nodes, root);
    if (nodes.count == 0)
        return;
    const uint32_t index = below(random, nodes.count);
    cJSON *const node = nodes.all[index], *const parent = nodes.parents[index],
                 *const other = nodes.all[below(random, nodes.count)];
    switch (below(random, 10)) {
    case 0:
        cJSON_Delete(cJSON_DetachItemViaPointer(parent, node));
        break;
    case 1:
        add_copy(parent, node, node);
        break;
    case 2:
        replace(parent, node, other);
        break;
    case 3:
        add_copy(parent, other, node);
        break;
    case 4:
        if (cJSON_IsArray(node) || cJSON_IsObject(node))
            add_copy(node, other, other);
        break;
    default:
        change_value(node, other, random);
    }
}

/* ---- Files ------------------------------------------------------------------------------------------ */

static bool is_glb(const uint8_t *data, size_t size)
{
    return size >= GLB_HEAD && memcmp(data, "glTF", 4) == 0;
}

/* The bytes of the JSON chunk: little endian, at 12. The target's `mend` writes the new length. */
static size_t chunk_size(const uint8_t *data, size_t size)
{
    const size_t length = data[12] | (size_t)data[13] << 8 | (size_t)data[14] << 16 | (size_t)data[15] << 24;
    return length < size - GLB_HEAD ? length : size - GLB_HEAD;
}

/* Spaces up to a multiple of four: what follows in a GLB stays aligned. */
static size_t put(uint8_t *data, size_t size, size_t capacity, size_t head, size_t old, const char *text)
{
    const size_t length = strlen(text), padded = head ? (length + 3) / 4 * 4 : length;
    const size_t tail = size - head - old;
    if (head + padded + tail > capacity)
        return 0;
    memmove(data + head + padded, data + head + old, tail);
    memset(data + head, ' ', padded);
    memcpy(data + head, text, length);
    return head + padded + tail;
}

size_t fuzz_json_mutate(uint8_t *data, size_t size, size_t capacity, struct test_random *random)
{
    const size_t head = is_glb(data, size) ? GLB_HEAD : 0, old = head ? chunk_size(data, size) : size;
    cJSON *const root = cJSON_ParseWithLength((const char *)data + head, old);
    if (!root)
        return 0;
    for (uint32_t i = below(random, CHANGES_MAX) + 1; i > 0; i--)
        change(root, random);
    char *const text = cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    const size_t changed = text ? put(data, size, capacity, head, old, text) : 0;
    free(text);
    return changed;
}
