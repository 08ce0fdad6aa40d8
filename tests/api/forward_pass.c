/* SPDX-License-Identifier: MIT */
#include "forward_pass.h"

#include "require.h"

#include <vulkan/vulkan.h>

#include "forward_pass.frag.h"
#include "forward_pass.vert.h"
#include "forward_pass_software.frag.h"

static void create_render_pass(struct forward_pass *forward, struct gpu_test *gpu)
{
    const VkAttachmentDescription attachment = { .format = forward->image.format,
                                                 .samples = VK_SAMPLE_COUNT_1_BIT,
                                                 .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                 .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                 .initialLayout = forward->image.layout,
                                                 .finalLayout = forward->image.layout };
    const VkAttachmentReference color = { 0, forward->image.layout };
    const VkSubpassDescription subpass = { .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                           .colorAttachmentCount = 1,
                                           .pColorAttachments = &color };
    const VkAccessFlags all = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    const VkPipelineStageFlags any = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                               drawing = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    const VkSubpassDependency around[2] = { { VK_SUBPASS_EXTERNAL, 0, any, drawing, all, all, 0 },
                                            { 0, VK_SUBPASS_EXTERNAL, drawing, any, all, all, 0 } };
    const VkRenderPassCreateInfo info = { .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                          .attachmentCount = 1,
                                          .pAttachments = &attachment,
                                          .subpassCount = 1,
                                          .pSubpasses = &subpass,
                                          .dependencyCount = 2,
                                          .pDependencies = around };
    REQUIRE_CMP((int)vkCreateRenderPass(gpu->device, &info, NULL, &forward->pass), ==, (int)VK_SUCCESS);
    const VkFramebufferCreateInfo framebuffer = { .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                  .renderPass = forward->pass,
                                                  .attachmentCount = 1,
                                                  .pAttachments = &forward->image.view,
                                                  .width = FORWARD_SIDE,
                                                  .height = FORWARD_SIDE,
                                                  .layers = 1 };
    REQUIRE_CMP((int)vkCreateFramebuffer(gpu->device, &framebuffer, NULL, &forward->framebuffer), ==,
                (int)VK_SUCCESS);
}

static VkPipelineShaderStageCreateInfo create_stage(struct gpu_test *gpu, VkShaderStageFlagBits stage,
                                                    const uint32_t *code, size_t size)
{
    const VkShaderModuleCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = size,
                                            .pCode = code };
    VkPipelineShaderStageCreateInfo out = { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                            .stage = stage,
                                            .pName = "main" };
    REQUIRE_CMP((int)vkCreateShaderModule(gpu->device, &info, NULL, &out.module), ==, (int)VK_SUCCESS);
    return out;
}

static VkPipelineShaderStageCreateInfo create_lookup_stage(struct gpu_test *gpu, bool software)
{
    return create_stage(gpu, VK_SHADER_STAGE_FRAGMENT_BIT,
                        software ? forward_pass_software_frag : forward_pass_frag,
                        software ? sizeof forward_pass_software_frag : sizeof forward_pass_frag);
}

static void create_pipeline(struct forward_pass *forward, struct gpu_test *gpu, bool software)
{
    const VkPipelineShaderStageCreateInfo stages[2] = {
        create_stage(gpu, VK_SHADER_STAGE_VERTEX_BIT, forward_pass_vert, sizeof forward_pass_vert),
        create_lookup_stage(gpu, software),
    };
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO
    };
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
    };
    const VkViewport viewport = { 0, 0, FORWARD_SIDE, FORWARD_SIDE, 0, 1 };
    const VkRect2D scissor = { { 0, 0 }, { FORWARD_SIDE, FORWARD_SIDE } };
    const VkPipelineViewportStateCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor
    };
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1
    };
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT
    };
    const VkPipelineColorBlendAttachmentState write = { .colorWriteMask = 15 };
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &write
    };
    const VkGraphicsPipelineCreateInfo info = { .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                                .stageCount = 2,
                                                .pStages = stages,
                                                .pVertexInputState = &input,
                                                .pInputAssemblyState = &assembly,
                                                .pViewportState = &view,
                                                .pRasterizationState = &raster,
                                                .pMultisampleState = &samples,
                                                .pColorBlendState = &blend,
                                                .layout = forward->layout,
                                                .renderPass = forward->pass };
    REQUIRE_CMP(
        (int)vkCreateGraphicsPipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &forward->pipeline), ==,
        (int)VK_SUCCESS);
    vkDestroyShaderModule(gpu->device, stages[0].module, NULL);
    vkDestroyShaderModule(gpu->device, stages[1].module, NULL);
}

void forward_pass_open(struct forward_pass *forward, struct gpu_test *gpu, const sdfgi *gi)
{
    const VkDescriptorSetLayout lookup = sdfgi_get_descriptor_set_layout(gi);
    forward->image = gpu_test_image_create(
        gpu, &(struct gpu_test_image_desc){ .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                            .extent = { FORWARD_SIDE, FORWARD_SIDE, 1 },
                                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                            .layout = VK_IMAGE_LAYOUT_GENERAL,
                                            .texel_size = 16 });
    create_render_pass(forward, gpu);
    const VkPipelineLayoutCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = 1,
                                              .pSetLayouts = &lookup };
    REQUIRE_CMP((int)vkCreatePipelineLayout(gpu->device, &info, NULL, &forward->layout), ==, (int)VK_SUCCESS);
    create_pipeline(forward, gpu, sdfgi_is_software(gi));
}

void forward_pass_close(struct forward_pass *forward, struct gpu_test *gpu)
{
    vkDestroyPipeline(gpu->device, forward->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, forward->layout, NULL);
    vkDestroyFramebuffer(gpu->device, forward->framebuffer, NULL);
    vkDestroyRenderPass(gpu->device, forward->pass, NULL);
    gpu_test_image_destroy(gpu, &forward->image);
}

struct drawing {
    const struct forward_pass *forward;
    VkDescriptorSet lookup;
};

static void record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct drawing *d = user;
    const VkClearValue clear = { .color = { { 7, 7, 7, 7 } } };
    const VkRenderPassBeginInfo begin = { .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                          .renderPass = d->forward->pass,
                                          .framebuffer = d->forward->framebuffer,
                                          .renderArea = { { 0, 0 }, { FORWARD_SIDE, FORWARD_SIDE } },
                                          .clearValueCount = 1,
                                          .pClearValues = &clear };
    (void)index;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, d->forward->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, d->forward->layout, 0, 1, &d->lookup, 0,
                            NULL);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
}

void forward_pass_draw(struct forward_pass *forward, struct gpu_test *gpu, VkDescriptorSet lookup,
                       float texels[FORWARD_SIDE * FORWARD_SIDE][4])
{
    struct drawing drawing = { forward, lookup };
    gpu_test_submit(gpu, record, &drawing);
    gpu_test_image_read(gpu, forward->image.image, forward->image.layout, VK_IMAGE_ASPECT_COLOR_BIT,
                        forward->image.extent, 16, texels);
}
