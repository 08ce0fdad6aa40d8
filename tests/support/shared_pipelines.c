/* SPDX-License-Identifier: MIT
 * Layouts of equal definition are compatible, so a pipeline made with those of one context runs with those
 * of the next. Equal definitions have the same immutable samplers, so samplers are shared as well. Pipelines
 * of one shader are told apart by its code alone: the library specialises none. */
#include "shared_pipelines.h"

#include "layered_vulkan.h"
#include "require.h"
#include "test_memory.h"

#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

enum { MOST = 256 };

/* The driver's function: a test may have put its own before the loader's. */
#define DRIVER(device, name) ((PFN_##name)vkGetDeviceProcAddr(device, #name))

struct shader {
    VkDevice device;
    uint32_t *code;
    size_t size;
    VkShaderModule module;
    VkPipeline pipeline;
};

static struct shader shaders[MOST];
static uint32_t shader_count;

/* Pipelines that draw are told apart by their fragment shader and their viewport. */
struct raster {
    VkDevice device;
    VkShaderModule fragment;
    float width;
    VkPipeline pipeline;
};

static struct raster rasters[MOST];
static uint32_t raster_count;

struct sampler {
    VkDevice device;
    VkSamplerCreateInfo info;
    VkSampler sampler;
};

static struct sampler samplers[MOST];
static uint32_t sampler_count;

static struct shader *shader_of_code(VkDevice device, const uint32_t *code, size_t size)
{
    for (uint32_t i = 0; i < shader_count; i++)
        if (shaders[i].device == device && shaders[i].size == size &&
            memcmp(shaders[i].code, code, size) == 0)
            return &shaders[i];
    REQUIRE_CMP(shader_count, <, (uint32_t)MOST);
    struct shader *shader = &shaders[shader_count++];
    *shader = (struct shader){ .device = device, .code = test_array_alloc(size, 1), .size = size };
    memcpy(shader->code, code, size);
    return shader;
}

static struct shader *shader_of_module(VkDevice device, VkShaderModule module)
{
    for (uint32_t i = 0; i < shader_count; i++)
        if (shaders[i].device == device && shaders[i].module == module)
            return &shaders[i];
    require_fail(__FILE__, __LINE__, "a pipeline of a shader that nobody made");
    return NULL;
}

/* The validation layer looks through a shader's code for milliseconds: once will do. */
static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device, const VkShaderModuleCreateInfo *info,
                                                    const VkAllocationCallbacks *callbacks,
                                                    VkShaderModule *out)
{
    struct shader *shader = shader_of_code(device, info->pCode, info->codeSize);
    VkResult result = VK_SUCCESS;
    if (!shader->module)
        result = DRIVER(device, vkCreateShaderModule)(device, info, callbacks, &shader->module);
    *out = shader->module;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                     const VkComputePipelineCreateInfo *infos,
                                                     const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    REQUIRE_CMP(count, ==, 1u);
    struct shader *shader = shader_of_module(device, infos->stage.module);
    VkResult result = VK_SUCCESS;
    if (!shader->pipeline)
        result =
            DRIVER(device, vkCreateComputePipelines)(device, cache, 1, infos, callbacks, &shader->pipeline);
    *out = shader->pipeline;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkGraphicsPipelineCreateInfo *infos,
                                                      const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    REQUIRE_CMP(count, ==, 1u);
    REQUIRE_CMP(infos->stageCount, ==, 2u);
    const VkShaderModule fragment = infos->pStages[1].module;
    const float width = infos->pViewportState->pViewports->width;
    for (uint32_t i = 0; i < raster_count; i++)
        if (rasters[i].device == device && rasters[i].fragment == fragment && rasters[i].width == width) {
            *out = rasters[i].pipeline;
            return VK_SUCCESS;
        }
    const VkResult result =
        DRIVER(device, vkCreateGraphicsPipelines)(device, cache, 1, infos, callbacks, out);
    REQUIRE_CMP(raster_count, <, (uint32_t)MOST);
    if (result == VK_SUCCESS)
        rasters[raster_count++] = (struct raster){ device, fragment, width, *out };
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_sampler(VkDevice device, const VkSamplerCreateInfo *info,
                                                     const VkAllocationCallbacks *callbacks, VkSampler *out)
{
    REQUIRE_TRUE(info->pNext == NULL);
    for (uint32_t i = 0; i < sampler_count; i++)
        if (samplers[i].device == device && memcmp(&samplers[i].info, info, sizeof *info) == 0) {
            *out = samplers[i].sampler;
            return VK_SUCCESS;
        }
    const VkResult result = DRIVER(device, vkCreateSampler)(device, info, callbacks, out);
    REQUIRE_CMP(sampler_count, <, (uint32_t)MOST);
    if (result == VK_SUCCESS)
        samplers[sampler_count++] = (struct sampler){ device, *info, *out };
    return result;
}

/* ---- What is shared stays */

#define HOLD(kind, rows, count, member)                                                                      \
    static bool rows##_hold_##member(VkDevice device, Vk##kind object)                                       \
    {                                                                                                        \
        for (uint32_t i = 0; i < count; i++)                                                                 \
            if (rows[i].device == device && rows[i].member == object)                                        \
                return true;                                                                                 \
        return false;                                                                                        \
    }
HOLD(ShaderModule, shaders, shader_count, module)
HOLD(Pipeline, shaders, shader_count, pipeline)
HOLD(Pipeline, rasters, raster_count, pipeline)
HOLD(Sampler, samplers, sampler_count, sampler)

#define DESTROY(kind, name, is_shared)                                                                       \
    static VKAPI_ATTR void VKAPI_CALL destroy_##name(VkDevice device, Vk##kind object,                       \
                                                     const VkAllocationCallbacks *callbacks)                 \
    {                                                                                                        \
        if (!(is_shared))                                                                                    \
            DRIVER(device, vkDestroy##kind)(device, object, callbacks);                                      \
    }
DESTROY(ShaderModule, module, shaders_hold_module(device, object))
DESTROY(Pipeline, pipeline, shaders_hold_pipeline(device, object) || rasters_hold_pipeline(device, object))
DESTROY(Sampler, sampler, samplers_hold_sampler(device, object))

/* clang-format off */
static const struct layered_function shared[] = {
    LAYERED("vkCreateShaderModule", create_module),
    LAYERED("vkDestroyShaderModule", destroy_module),
    LAYERED("vkCreateComputePipelines", create_compute),
    LAYERED("vkCreateGraphicsPipelines", create_graphics),
    LAYERED("vkDestroyPipeline", destroy_pipeline),
    LAYERED("vkCreateSampler", create_sampler),
    LAYERED("vkDestroySampler", destroy_sampler),
    { NULL, NULL },
};
/* clang-format on */

PFN_vkVoidFunction shared_pipelines_function(VkDevice device, const char *name)
{
    for (const struct layered_function *f = shared; f->name; f++)
        if (strcmp(f->name, name) == 0)
            return f->function;
    return vkGetDeviceProcAddr(device, name);
}

PFN_vkGetInstanceProcAddr shared_pipelines_loader(void)
{
    return layered_vulkan_loader(shared);
}

#define DESTROY_ALL(kind, rows, count, member)                                                               \
    static void destroy_##rows(VkDevice device)                                                              \
    {                                                                                                        \
        uint32_t kept = 0;                                                                                   \
        for (uint32_t i = 0; i < count; i++)                                                                 \
            if (rows[i].device != device)                                                                    \
                rows[kept++] = rows[i];                                                                      \
            else                                                                                             \
                DRIVER(device, vkDestroy##kind)(device, rows[i].member, NULL);                               \
        count = kept;                                                                                        \
    }
DESTROY_ALL(Sampler, samplers, sampler_count, sampler)
DESTROY_ALL(Pipeline, rasters, raster_count, pipeline)

void shared_pipelines_destroy(VkDevice device)
{
    destroy_samplers(device);
    destroy_rasters(device);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < shader_count; i++) {
        if (shaders[i].device != device) {
            shaders[kept++] = shaders[i];
            continue;
        }
        DRIVER(device, vkDestroyPipeline)(device, shaders[i].pipeline, NULL);
        DRIVER(device, vkDestroyShaderModule)(device, shaders[i].module, NULL);
        free(shaders[i].code);
    }
    shader_count = kept;
}
