/* SPDX-License-Identifier: MIT */
#include "modules.h"

#include "require.h"

#include "sdfgi_shaders.h"

/* All shaders of a row of the pass table. */
#define MODULE(id, words)         { PASS_##id, #words, sdfgi_##words, sizeof sdfgi_##words, NULL },
#define MODULES_COMPUTE(id, file) MODULE(id, file##_comp) MODULE(id, file##_software_comp)
#define MODULES_WITH(id, file, variant)                                                                      \
    MODULES_COMPUTE(id, file) MODULE(id, file##_##variant##_comp) MODULE(id, file##_##variant##_software_comp)
#define MODULES_COMPUTE_TEXTURED(id, file) MODULES_WITH(id, file, textured)
#define MODULES_COMPUTE_LOBES(id, file)    MODULES_WITH(id, file, lobes)
#define MODULES_COMPUTE_METAL(id, file)    MODULES_WITH(id, file, metal)
#define MODULES_RASTER_TEXTURED(id, file)                                                                    \
    MODULE(id, file##_vert) MODULE(id, file##_frag) MODULE(id, file##_textured_frag)

struct module modules[] = {
#define ROW(id, kind, shader, unit, need, phase, made, domain, args, group, set, reads, writes)              \
    MODULES_##kind(id, shader)
    SDFGI_PASSES(ROW)
#undef ROW
};
const size_t module_count = sizeof modules / sizeof *modules;

static spvc_context context;

static void module_open(struct module *module)
{
    spvc_parsed_ir parsed;
    const size_t words = module->size / sizeof *module->code;
    if (spvc_context_parse_spirv(context, module->code, words, &parsed) != SPVC_SUCCESS ||
        spvc_context_create_compiler(context, SPVC_BACKEND_NONE, parsed, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                     &module->spirv) != SPVC_SUCCESS)
        require_fail(__FILE__, __LINE__, "%s: %s", module->name, spvc_context_get_last_error_string(context));
}

int modules_open(void **state)
{
    (void)state;
    REQUIRE_CMP(spvc_context_create(&context), ==, SPVC_SUCCESS);
    for (size_t i = 0; i < module_count; i++)
        module_open(&modules[i]);
    return 0;
}

int modules_close(void **state)
{
    (void)state;
    spvc_context_destroy(context);
    return 0;
}

static size_t append(const struct module *module, spvc_resources resources, spvc_resource_type kind,
                     struct module_resource *list, size_t count)
{
    const spvc_reflected_resource *found;
    size_t found_count;
    REQUIRE_CMP(spvc_resources_get_resource_list_for_type(resources, kind, &found, &found_count), ==,
                SPVC_SUCCESS);
    REQUIRE_CMP(count + found_count, <=, (size_t)MODULE_RESOURCES_MAX);
    for (size_t i = 0; i < found_count; i++)
        list[count + i] = (struct module_resource){
            .id = found[i].id,
            .type = found[i].base_type_id,
            .kind = kind,
            .block = found[i].name,
            .set = spvc_compiler_get_decoration(module->spirv, found[i].id, SpvDecorationDescriptorSet),
            .binding = spvc_compiler_get_decoration(module->spirv, found[i].id, SpvDecorationBinding),
        };
    return count + found_count;
}

static size_t append_all(const struct module *module, spvc_resources resources, struct module_resource *list)
{
    /* All kinds that have a set and a binding and that a descriptor of Vulkan 1.2 can be. */
    static const spvc_resource_type kinds[] = {
        SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, SPVC_RESOURCE_TYPE_STORAGE_BUFFER,
        SPVC_RESOURCE_TYPE_STORAGE_IMAGE,  SPVC_RESOURCE_TYPE_SAMPLED_IMAGE,
        SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS,
        SPVC_RESOURCE_TYPE_SUBPASS_INPUT,
    };
    size_t count = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        count = append(module, resources, kinds[i], list, count);
    return count;
}

size_t module_resources(const struct module *module, struct module_resource list[static MODULE_RESOURCES_MAX])
{
    spvc_resources resources;
    REQUIRE_CMP(spvc_compiler_create_shader_resources(module->spirv, &resources), ==, SPVC_SUCCESS);
    return append_all(module, resources, list);
}

size_t module_active_resources(const struct module *module,
                               struct module_resource list[static MODULE_RESOURCES_MAX])
{
    spvc_set active;
    spvc_resources resources;
    REQUIRE_CMP(spvc_compiler_get_active_interface_variables(module->spirv, &active), ==, SPVC_SUCCESS);
    REQUIRE_CMP(spvc_compiler_create_shader_resources_for_active_variables(module->spirv, &resources, active),
                ==, SPVC_SUCCESS);
    return append_all(module, resources, list);
}

spvc_type_id module_push_type(const struct module *module)
{
    struct module_resource push[MODULE_RESOURCES_MAX];
    spvc_resources resources;
    REQUIRE_CMP(spvc_compiler_create_shader_resources(module->spirv, &resources), ==, SPVC_SUCCESS);
    return append(module, resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, push, 0) ? push[0].type : 0;
}
