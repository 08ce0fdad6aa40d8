/* SPDX-License-Identifier: MIT */
#include "access.h"

#include "require.h"
#include "test_memory.h"

#include <spirv.h>
#include <stdlib.h>

enum { HEADER_WORDS = 5, BOUND_WORD = 3 };

/* Instructions that touch memory, `first` to `last`. Word 0 is the opcode, `word` the pointer or the image.
 */
static const struct {
    SpvOp first, last;
    uint32_t word;
    uint8_t access;
} accesses[] = {
    { SpvOpLoad, SpvOpLoad, 3, ACCESS_READ },
    { SpvOpStore, SpvOpStore, 1, ACCESS_WRITE },
    { SpvOpCopyMemory, SpvOpCopyMemorySized, 1, ACCESS_WRITE },
    { SpvOpCopyMemory, SpvOpCopyMemorySized, 2, ACCESS_READ },
    { SpvOpImageSampleImplicitLod, SpvOpImageRead, 3, ACCESS_READ },
    { SpvOpImageSparseSampleImplicitLod, SpvOpImageSparseDrefGather, 3, ACCESS_READ },
    { SpvOpImageSparseRead, SpvOpImageSparseRead, 3, ACCESS_READ },
    { SpvOpImageWrite, SpvOpImageWrite, 1, ACCESS_WRITE },
    { SpvOpAtomicLoad, SpvOpAtomicLoad, 3, ACCESS_READ },
    { SpvOpAtomicStore, SpvOpAtomicStore, 1, ACCESS_WRITE },
    { SpvOpAtomicExchange, SpvOpAtomicXor, 3, ACCESS_READ | ACCESS_WRITE },
    { SpvOpAtomicFMinEXT, SpvOpAtomicFMaxEXT, 3, ACCESS_READ | ACCESS_WRITE },
    { SpvOpAtomicFAddEXT, SpvOpAtomicFAddEXT, 3, ACCESS_READ | ACCESS_WRITE },
};

struct walk {
    uint32_t *root;  /* of a pointer or a loaded image: the variable it came from; 0: none */
    bool *is_handle; /* types whose values stand for an image: to load one reads none of it */
    uint8_t *access; /* of variables; [0] gathers what is none */
};

static void note_access(const struct walk *walk, SpvOp op, const uint32_t *words)
{
    for (size_t i = 0; i < sizeof accesses / sizeof *accesses; i++)
        if (op >= accesses[i].first && op <= accesses[i].last)
            walk->access[walk->root[words[accesses[i].word]]] |= accesses[i].access;
}

static void require_no_resource(const struct walk *walk, const uint32_t *words, uint32_t count)
{
    for (uint32_t i = 3; i < count; i++)
        if (walk->root[words[i]])
            require_fail(__FILE__, __LINE__, "%%%u: a resource is passed on, which is not followed",
                         walk->root[words[i]]);
}

/* With logical addressing nothing else makes pointers: SPIR-V specification, section 2.16.1. */
static void read_instruction(const struct walk *walk, SpvOp op, const uint32_t *words, uint32_t count)
{
    switch (op) {
    case SpvOpTypeImage:
    case SpvOpTypeSampler:
    case SpvOpTypeSampledImage:
        walk->is_handle[words[1]] = true;
        break;
    case SpvOpVariable:
        walk->root[words[2]] = words[3] == SpvStorageClassFunction ? 0 : words[2];
        break;
    case SpvOpAccessChain:
    case SpvOpInBoundsAccessChain:
    case SpvOpCopyObject:
    case SpvOpImageTexelPointer:
    case SpvOpSampledImage:
    case SpvOpImage:
        walk->root[words[2]] = walk->root[words[3]];
        break;
    case SpvOpFunctionCall:
    case SpvOpSelect:
    case SpvOpPhi:
        require_no_resource(walk, words, count);
        break;
    case SpvOpLoad:
        if (walk->is_handle[words[1]])
            walk->root[words[2]] = walk->root[words[3]];
        else
            note_access(walk, op, words);
        break;
    default:
        note_access(walk, op, words);
    }
}

uint8_t *access_by_id(const uint32_t *code, size_t size)
{
    REQUIRE_CMP(size / sizeof *code, >, (size_t)HEADER_WORDS);
    REQUIRE_CMP(code[0], ==, (uint32_t)SpvMagicNumber);
    const uint32_t bound = code[BOUND_WORD];
    const struct walk walk = {
        .root = test_array_alloc(bound, sizeof *walk.root),
        .is_handle = test_array_alloc(bound, sizeof *walk.is_handle),
        .access = test_array_alloc(bound, sizeof *walk.access),
    };
    for (size_t at = HEADER_WORDS; at < size / sizeof *code; at += code[at] >> SpvWordCountShift) {
        REQUIRE_CMP(code[at] >> SpvWordCountShift, >, 0u);
        read_instruction(&walk, code[at] & SpvOpCodeMask, code + at, code[at] >> SpvWordCountShift);
    }
    free(walk.root);
    free(walk.is_handle);
    return walk.access;
}
