/* SPDX-License-Identifier: MIT
 * The rows of pass_table.h say of every pass what its shaders do: barriers follow from them. */
#include "access.h"
#include "modules.h"
#include "pass/pass_rows.h"
#include "pass/resource_rows.h"
#include "require.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

#include <stdlib.h>

static bool is_vertex(const struct module *module)
{
    return spvc_compiler_get_execution_model(module->spirv) == SpvExecutionModelVertex;
}

/* ---- Reads and writes */

/* What rows have bits for: resources of volumes, and then what views bind. */
enum { VIEW_BINDINGS = SDFGI_BINDING_VIEW_FILTERED + 1, TOUCH_COUNT = RESOURCE_COUNT + VIEW_BINDINGS };

struct touches {
    uint8_t access[TOUCH_COUNT]; /* ACCESS_* */
};

static const char *touch_name(int touch)
{
    static const char *const views[VIEW_BINDINGS] = { "depth",      "normal", "roughness", "diffuse",
                                                      "reflection", "tiles",  "filtered" };
    return touch < RESOURCE_COUNT ? sdfgi_resource_row((enum resource)touch)->name
                                  : views[touch - RESOURCE_COUNT];
}

/* Pictures that the host has drawn: no pass writes them, so that no row names them. */
static bool is_of_host(int touch)
{
    return touch >= RESOURCE_COUNT && touch - RESOURCE_COUNT < SDFGI_BINDING_VIEW_DIFFUSE;
}

static int touch_at(uint32_t set, uint32_t binding)
{
    if (set == SDFGI_SET_VIEW && binding < VIEW_BINDINGS)
        return RESOURCE_COUNT + (int)binding;
    for (int i = 0; i < RESOURCE_COUNT; i++) {
        const struct resource_row *row = sdfgi_resource_row((enum resource)i);
        if ((uint32_t)row->set == set &&
            (row->binding == binding || row->binding + SDFGI_BINDING_TEXELS == binding))
            return i;
    }
    require_fail(__FILE__, __LINE__, "set %u, binding %u: no resource is bound there", set, binding);
    return TOUCH_COUNT;
}

static void touch(struct touches *touches, const struct module *module,
                  const struct module_resource *resource, uint8_t access)
{
    const int id = touch_at(resource->set, resource->binding);
    /* Only its length is asked for, or access.c lacks an instruction. */
    if (!access)
        require_fail(__FILE__, __LINE__, "%s: %s: named, but neither read nor written", module->name,
                     touch_name(id));
    touches->access[id] |= access;
}

static void add_touches(struct touches *touches, const struct module *module)
{
    struct module_resource resources[MODULE_RESOURCES_MAX];
    const size_t count = module_active_resources(module, resources);
    uint8_t *access = access_by_id(module->code, module->size);
    const bool has_view = sdfgi_pass_row(module->pass)->set == PASS_SET_VIEW;
    for (size_t i = 0; i < count; i++)
        if (resources[i].set == SDFGI_SET_LOOKUP || resources[i].set == SDFGI_SET_WORK ||
            (has_view && resources[i].set == SDFGI_SET_VIEW))
            touch(touches, module, &resources[i], access[resources[i].id]);
    free(access);
}

static uint8_t row_access(enum pass pass, int resource)
{
    return (uint8_t)((sdfgi_pass_row(pass)->reads >> resource & 1 ? ACCESS_READ : 0) |
                     (sdfgi_pass_row(pass)->writes >> resource & 1 ? ACCESS_WRITE : 0));
}

/* A row need not repeat under reads what it writes; all else is exact. */
static bool agree(int touch, uint8_t row, uint8_t shader)
{
    if (is_of_host(touch))
        return !row && !(shader & ACCESS_WRITE);
    if (touch == RESOURCE_FRAME && !shader) /* all may read it, and need not */
        return true;
    return row == shader || (row == ACCESS_WRITE && shader == (ACCESS_READ | ACCESS_WRITE));
}

/* Prints each difference; returns how many. */
static int compare(const struct module *module, const struct touches *touches)
{
    static const char *const verbs[] = { "does not touch it", "reads it", "writes it",
                                         "reads and writes it" };
    int wrong = 0;
    for (int i = 0; i < TOUCH_COUNT; i++) {
        const uint8_t row = row_access(module->pass, i), shader = touches->access[i];
        if (agree(i, row, shader))
            continue;
        print_error("%s (%s): %s: by the table the pass %s, the shader %s\n",
                    sdfgi_pass_row(module->pass)->name, module->name, touch_name(i), verbs[row],
                    verbs[shader]);
        wrong++;
    }
    return wrong;
}

/* A compute shader is a pipeline, and so is a fragment shader with its pass's vertex shader. A row names what
 * its shaders for rough lobes and for metal touch, too. */
static int compare_pipeline(const struct module *module)
{
    const enum pass_kind kind = sdfgi_pass_row(module->pass)->kind;
    const bool is_union = kind == PASS_KIND_COMPUTE_LOBES || kind == PASS_KIND_COMPUTE_METAL;
    struct touches touches = { { 0 } };
    add_touches(&touches, module);
    for (size_t i = 0; i < module_count; i++)
        if (modules[i].pass == module->pass && (is_union || is_vertex(&modules[i])))
            add_touches(&touches, &modules[i]);
    return compare(module, &touches);
}

static void every_row_names_what_its_shaders_read_and_write(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < module_count; i++)
        if (!is_vertex(&modules[i]))
            wrong += compare_pipeline(&modules[i]);
    REQUIRE_CMP(wrong, ==, 0);
}

/* ---- Texels */

/* What a shader reads as texels and writes as a buffer, too: a bit per resource. */
static uint64_t read_back_as_texels(const struct module *module)
{
    struct module_resource resources[MODULE_RESOURCES_MAX];
    const size_t count = module_active_resources(module, resources);
    uint8_t *access = access_by_id(module->code, module->size);
    uint64_t as_texels = 0, written = 0;
    for (size_t i = 0; i < count; i++)
        if (resources[i].set <= SDFGI_SET_WORK) {
            const int id = touch_at(resources[i].set, resources[i].binding);
            as_texels |= (uint64_t)(resources[i].binding >= SDFGI_BINDING_TEXELS) << id;
            written |= (uint64_t)((access[resources[i].id] & ACCESS_WRITE) != 0) << id;
        }
    free(access);
    return as_texels & written;
}

/* Drivers may take texels for constant while a shader runs. Of what is left out, no thread reads a word that
 * has been written in the same dispatch. */
static void no_shader_reads_texels_of_what_it_writes(void **state)
{
    (void)state;
    const uint64_t left_out =
        RESOURCE_BIT(GATHERED) | RESOURCE_BIT(RAYS) | RESOURCE_BIT(SUMS) | RESOURCE_BIT(PREVIOUS);
    for (size_t i = 0; i < module_count; i++)
        if (read_back_as_texels(&modules[i]) & ~left_out)
            require_fail(__FILE__, __LINE__, "%s: reads texels of a buffer that it writes", modules[i].name);
}

/* ---- The rest of a row */

static bool has_shader(enum pass pass)
{
    for (size_t i = 0; i < module_count; i++)
        if (modules[i].pass == pass && !is_vertex(&modules[i]))
            return true;
    return false;
}

static void every_pass_has_a_shader_of_its_name(void **state)
{
    (void)state;
    for (int i = 0; i < PASS_COUNT; i++)
        if (!has_shader((enum pass)i))
            require_fail(__FILE__, __LINE__, "%s: no shader", sdfgi_pass_row((enum pass)i)->name);
    for (size_t i = 0; i < module_count; i++) {
        const char *pass = sdfgi_pass_row(modules[i].pass)->name;
        if (strncmp(modules[i].name, pass, strlen(pass)) != 0)
            require_fail(__FILE__, __LINE__, "%s: is no shader of %s", modules[i].name, pass);
    }
}

enum { ON_CPU_LAST_CONSTANT = 0 };

/* Specialization constants are those of lib/on_cpu.glsl, of passes alone. */
static void constants_are_known(void **state)
{
    (void)state;
    for (size_t i = 0; i < module_count; i++) {
        const spvc_compiler spirv = modules[i].spirv;
        const spvc_specialization_constant *constants;
        size_t count;
        REQUIRE_CMP(spvc_compiler_get_specialization_constants(spirv, &constants, &count), ==, SPVC_SUCCESS);
        const bool is_compute = spvc_compiler_get_execution_model(spirv) == SpvExecutionModelGLCompute;
        for (size_t k = 0; k < count; k++)
            if (!is_compute || constants[k].constant_id > ON_CPU_LAST_CONSTANT)
                require_fail(__FILE__, __LINE__, "%s: specialization constant %u", modules[i].name,
                             constants[k].constant_id);
    }
}

static void workgroups_have_no_more_threads_than_devices_are_asked_for(void **state)
{
    (void)state;
    unsigned most = 0;
    for (size_t i = 0; i < module_count; i++) {
        const spvc_compiler spirv = modules[i].spirv;
        unsigned threads = 1;
        if (spvc_compiler_get_execution_model(spirv) != SpvExecutionModelGLCompute)
            continue;
        for (unsigned axis = 0; axis < 3; axis++)
            threads *=
                spvc_compiler_get_execution_mode_argument_by_index(spirv, SpvExecutionModeLocalSize, axis);
        if (threads < 1 || threads > SDFGI_MOST_THREADS)
            require_fail(__FILE__, __LINE__, "%s: %u threads", modules[i].name, threads);
        most = threads > most ? threads : most;
    }
    REQUIRE_CMP(most, ==, (unsigned)SDFGI_MOST_THREADS);
}

/* Bytes of the arguments, which are the only member of the block or an element of it; 0: there are none. */
static size_t argument_bytes(const struct module *module)
{
    const spvc_type_id block = module_push_type(module);
    size_t size = 0;
    if (!block)
        return 0;
    const spvc_type arguments = spvc_compiler_get_type_handle(
        module->spirv, spvc_type_get_member_type(spvc_compiler_get_type_handle(module->spirv, block), 0));
    const spvc_type element =
        spvc_compiler_get_type_handle(module->spirv, spvc_type_get_base_type_id(arguments));
    REQUIRE_CMP(spvc_compiler_get_declared_struct_size(module->spirv, element, &size), ==, SPVC_SUCCESS);
    return size;
}

/* Vulkan promises 128 bytes. */
static void push_constants_are_the_arguments_of_the_row_and_fit_everywhere(void **state)
{
    (void)state;
    for (size_t i = 0; i < module_count; i++) {
        const size_t size = argument_bytes(&modules[i]);
        const uint32_t in_table = sdfgi_pass_row(modules[i].pass)->args_size;
        if (size > 128 || size != in_table)
            require_fail(__FILE__, __LINE__, "%s: %zu bytes of push constants, in the table %u",
                         modules[i].name, size, in_table);
    }
}

/* Beside LOOKUP and WORK: MESH with or without MATERIAL, or VIEW, or nothing. */
static void shaders_bind_the_set_of_the_row(void **state)
{
    (void)state;
    for (size_t i = 0; i < module_count; i++) {
        const enum pass_set set = sdfgi_pass_row(modules[i].pass)->set;
        const uint32_t last = set == PASS_SET_MESH   ? SDFGI_SET_MATERIAL
                              : set == PASS_SET_VIEW ? SDFGI_SET_VIEW
                                                     : SDFGI_SET_WORK;
        struct module_resource resources[MODULE_RESOURCES_MAX];
        const size_t count = module_resources(&modules[i], resources);
        for (size_t k = 0; k < count; k++)
            if (resources[k].set > last)
                require_fail(__FILE__, __LINE__, "%s: %s is in set %u, by the table the last is %u",
                             modules[i].name, resources[k].block, resources[k].set, last);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_names_what_its_shaders_read_and_write),
        cmocka_unit_test(no_shader_reads_texels_of_what_it_writes),
        cmocka_unit_test(every_pass_has_a_shader_of_its_name),
        cmocka_unit_test(constants_are_known),
        cmocka_unit_test(workgroups_have_no_more_threads_than_devices_are_asked_for),
        cmocka_unit_test(push_constants_are_the_arguments_of_the_row_and_fit_everywhere),
        cmocka_unit_test(shaders_bind_the_set_of_the_row),
    };
    return cmocka_run_group_tests_name("pass_table", tests, modules_open, modules_close);
}
