/* SPDX-License-Identifier: MIT */
#include "gpu.h"

static VkResult shader_module(const struct gpu_device *device, struct gpu_shader shader, const char *name,
                              VkShaderModule *module)
{
    const VkResult result =
        device->fn.CreateShaderModule(device->handle,
                                      &(VkShaderModuleCreateInfo){
                                          .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                          .codeSize = shader.size,
                                          .pCode = shader.code,
                                      },
                                      device->callbacks, module);
    return gpu_named(device, result, VK_OBJECT_TYPE_SHADER_MODULE, module, name);
}

static VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule module)
{
    return (VkPipelineShaderStageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = stage,
        .module = module,
        .pName = "main",
    };
}

VkResult gpu_compute_pipeline_create(const struct gpu_device *device, struct gpu_shader shader,
                                     VkPipelineLayout layout, const char *name, VkPipeline *pipeline)
{
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult result = shader_module(device, shader, name, &module);
    if (result != VK_SUCCESS)
        return result;
    result = device->fn.CreateComputePipelines(device->handle, device->pipeline_cache, 1,
                                               &(VkComputePipelineCreateInfo){
                                                   .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                                   .stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, module),
                                                   .layout = layout,
                                               },
                                               device->callbacks, pipeline);
    device->fn.DestroyShaderModule(device->handle, module, device->callbacks);
    return gpu_named(device, result, VK_OBJECT_TYPE_PIPELINE, pipeline, name);
}

static VkResult raster_pipeline(const struct gpu_device *device,
                                const VkPipelineShaderStageCreateInfo stages[2], VkPipelineLayout layout,
                                VkRenderPass render_pass, uint32_t extent, VkPipeline *pipeline)
{
    const VkViewport viewport = { 0, 0, (float)extent, (float)extent, 0, 1 };
    const VkRect2D scissor = { { 0, 0 }, { extent, extent } };
    return device->fn.CreateGraphicsPipelines(
        device->handle, device->pipeline_cache, 1,
        &(VkGraphicsPipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
            .stageCount = 2,
            .pStages = stages,
            .pVertexInputState =
                &(VkPipelineVertexInputStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO },
            .pInputAssemblyState =
                &(VkPipelineInputAssemblyStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
                    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST },
            .pViewportState =
                &(VkPipelineViewportStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                    .viewportCount = 1,
                    .pViewports = &viewport,
                    .scissorCount = 1,
                    .pScissors = &scissor },
            .pRasterizationState =
                &(VkPipelineRasterizationStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
                    .cullMode = VK_CULL_MODE_NONE,
                    .lineWidth = 1.0f },
            .pMultisampleState =
                &(VkPipelineMultisampleStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT },
            .layout = layout,
            .renderPass = render_pass,
        },
        device->callbacks, pipeline);
}

VkResult gpu_raster_pipeline_create(const struct gpu_device *device, struct gpu_shader vertex,
                                    struct gpu_shader fragment, VkPipelineLayout layout,
                                    VkRenderPass render_pass, uint32_t extent, const char *name,
                                    VkPipeline *pipeline)
{
    VkShaderModule modules[2] = { VK_NULL_HANDLE, VK_NULL_HANDLE };
    VkResult result = shader_module(device, vertex, name, &modules[0]);
    if (result == VK_SUCCESS)
        result = shader_module(device, fragment, name, &modules[1]);
    if (result == VK_SUCCESS) {
        const VkPipelineShaderStageCreateInfo stages[2] = {
            stage_info(VK_SHADER_STAGE_VERTEX_BIT, modules[0]),
            stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, modules[1]),
        };
        result = raster_pipeline(device, stages, layout, render_pass, extent, pipeline);
    }
    for (int i = 0; i < 2; i++)
        device->fn.DestroyShaderModule(device->handle, modules[i], device->callbacks);
    return gpu_named(device, result, VK_OBJECT_TYPE_PIPELINE, pipeline, name);
}
