/* SPDX-License-Identifier: MIT
 * The library's compiled shaders, opened with SPIRV-Cross.
 */
#ifndef TEST_MODULES_H
#define TEST_MODULES_H

#include "pass_table.h"

#include <spirv_cross_c.h>

#include <stddef.h>
#include <stdint.h>

enum { MODULE_RESOURCES_MAX = 64 };

struct module {
    enum pass pass;
    const char *name; /* pass, variant, stage */
    const uint32_t *code;
    size_t size;         /* bytes */
    spvc_compiler spirv; /* from modules_open() to modules_close() */
};

/* A buffer or an image. */
struct module_resource {
    spvc_variable_id id;
    spvc_type_id type;
    spvc_resource_type kind;
    const char *block; /* of buffers; of images their own name */
    uint32_t set, binding;
};

extern struct module modules[];
extern const size_t module_count;

/* Fixtures of a group of tests. */
int modules_open(void **state);
int modules_close(void **state);

/* The resources that a module declares, or only those that its instructions name; returns how many. */
size_t module_resources(const struct module *module,
                        struct module_resource list[static MODULE_RESOURCES_MAX]);
size_t module_active_resources(const struct module *module,
                               struct module_resource list[static MODULE_RESOURCES_MAX]);

/* The type of the push constants; 0: none. */
spvc_type_id module_push_type(const struct module *module);

#endif
