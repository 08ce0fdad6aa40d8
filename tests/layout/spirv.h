/* SPDX-License-Identifier: MIT
 * What a SPIR-V module says about its structs and its bindings (SPIR-V specification, sections 2.3 and 3.37).
 */
#ifndef TEST_SPIRV_H
#define TEST_SPIRV_H

#include <stddef.h>
#include <stdint.h>

/* One member of a struct that has a place in memory. */
struct spirv_member {
    const char *type, *name;
    uint32_t offset;
    uint32_t array_stride; /* of an array of structs that this member is; 0: it is something else */
    const char *element;   /* name of those structs; "": none */
};

/* One resource. For buffers `type` is the name of the block. */
struct spirv_binding {
    const char *type, *name;
    uint32_t set, binding;
};

struct spirv_visitor {
    void (*member)(void *user, const struct spirv_member *member);    /* may be NULL */
    void (*binding)(void *user, const struct spirv_binding *binding); /* may be NULL */
    void *user;
};

/* Visits a module of `size` bytes with its names left in. Fails the test if it is not one. */
void spirv_visit(const uint32_t *code, size_t size, const struct spirv_visitor *visitor);

#endif
