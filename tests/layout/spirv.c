/* SPDX-License-Identifier: MIT */
#include "spirv.h"

#include "require.h"
#include "test_memory.h"

#include <stdlib.h>

enum {
    MAGIC = 0x07230203,
    HEADER_WORDS = 5,
    OP_NAME = 5,
    OP_MEMBER_NAME = 6,
    OP_TYPE_ARRAY = 28,
    OP_TYPE_RUNTIME_ARRAY = 29,
    OP_TYPE_STRUCT = 30,
    OP_TYPE_POINTER = 32,
    OP_VARIABLE = 59,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    DECORATION_ARRAY_STRIDE = 6,
    DECORATION_BINDING = 33,
    DECORATION_DESCRIPTOR_SET = 34,
    DECORATION_OFFSET = 35,
    MAX_MEMBERS = 64,
    NONE = 0x7fffffff,
};

/* What is known about an id. */
struct id {
    const char *name;
    const char *member_names[MAX_MEMBERS];
    uint32_t offsets[MAX_MEMBERS];
    const uint32_t *member_types; /* words of OpTypeStruct */
    uint32_t member_count;
    uint32_t element; /* arrays and pointers: the type they hold */
    uint32_t array_stride, set, binding;
    uint32_t variable_type; /* variables: a pointer type */
};

static const char *text_of(const uint32_t *words)
{
    return (const char *)words;
}

static void read_decoration(struct id *id, const uint32_t *words)
{
    if (words[0] == DECORATION_ARRAY_STRIDE)
        id->array_stride = words[1];
    if (words[0] == DECORATION_BINDING)
        id->binding = words[1];
    if (words[0] == DECORATION_DESCRIPTOR_SET)
        id->set = words[1];
}

static void read_instruction(struct id *ids, uint32_t op, const uint32_t *words, uint32_t count)
{
    switch (op) {
    case OP_NAME:
        ids[words[0]].name = text_of(words + 1);
        break;
    case OP_MEMBER_NAME:
        REQUIRE_CMP(words[1], <, (uint32_t)MAX_MEMBERS);
        ids[words[0]].member_names[words[1]] = text_of(words + 2);
        break;
    case OP_MEMBER_DECORATE:
        if (words[2] == DECORATION_OFFSET)
            ids[words[0]].offsets[words[1]] = words[3];
        break;
    case OP_DECORATE:
        read_decoration(&ids[words[0]], words + 1);
        break;
    case OP_TYPE_STRUCT:
        ids[words[0]].member_types = words + 1;
        ids[words[0]].member_count = count - 1;
        break;
    case OP_TYPE_ARRAY:
    case OP_TYPE_RUNTIME_ARRAY:
        ids[words[0]].element = words[1];
        break;
    case OP_TYPE_POINTER:
        ids[words[0]].element = words[2];
        break;
    case OP_VARIABLE:
        ids[words[1]].variable_type = words[0];
        break;
    default:
        break;
    }
}

static void visit_struct(const struct id *ids, const struct id *type, const struct spirv_visitor *visitor)
{
    for (uint32_t i = 0; i < type->member_count; i++) {
        const struct id *member = &ids[type->member_types[i]];
        const struct id *element = &ids[member->element];
        const bool is_array = member->array_stride != 0 && element->member_count != 0;
        if (type->offsets[i] == NONE || !type->member_names[i])
            continue;
        const struct spirv_member m = { type->name, type->member_names[i], type->offsets[i],
                                        is_array ? member->array_stride : 0, is_array ? element->name : "" };
        visitor->member(visitor->user, &m);
    }
}

static void visit_ids(const struct id *ids, uint32_t bound, const struct spirv_visitor *visitor)
{
    for (uint32_t i = 0; i < bound; i++) {
        if (ids[i].member_count && visitor->member)
            visit_struct(ids, &ids[i], visitor);
        if (ids[i].binding == NONE || !ids[i].variable_type || !visitor->binding)
            continue;
        const struct id *type = &ids[ids[ids[i].variable_type].element];
        const struct spirv_binding b = { type->name, ids[i].name, ids[i].set, ids[i].binding };
        visitor->binding(visitor->user, &b);
    }
}

void spirv_visit(const uint32_t *code, size_t size, const struct spirv_visitor *visitor)
{
    const size_t words = size / 4;
    REQUIRE_CMP(words, >, (size_t)HEADER_WORDS);
    REQUIRE_CMP(code[0], ==, (uint32_t)MAGIC);
    const uint32_t bound = code[3];
    struct id *ids = test_array_alloc(bound, sizeof *ids);
    for (uint32_t i = 0; i < bound; i++) {
        ids[i].name = "";
        ids[i].binding = NONE;
        for (int k = 0; k < MAX_MEMBERS; k++)
            ids[i].offsets[k] = NONE;
    }
    for (size_t at = HEADER_WORDS; at < words; at += code[at] >> 16) {
        REQUIRE_CMP(code[at] >> 16, >, 0u);
        read_instruction(ids, code[at] & 0xffff, code + at + 1, (code[at] >> 16) - 1);
    }
    visit_ids(ids, bound, visitor);
    free(ids);
}
