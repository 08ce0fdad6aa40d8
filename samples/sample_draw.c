/* SPDX-License-Identifier: MIT */
#include "sample_draw.h"

#include "sample_scene.h"

/* ---- Passes */

static VkAttachmentDescription attachment(VkFormat format, VkImageLayout after)
{
    return (VkAttachmentDescription){ .format = format,
                                      .samples = VK_SAMPLE_COUNT_1_BIT,
                                      .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                      .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                      .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                      .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                      .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                      .finalLayout = after };
}

static VkRenderPass render_pass(struct sample_gpu *gpu, const VkAttachmentDescription *attachments,
                                uint32_t color_count)
{
    VkAttachmentReference colors[SAMPLE_MAX_COLORS];
    for (uint32_t i = 0; i < color_count; i++)
        colors[i] = (VkAttachmentReference){ i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
    const VkAttachmentReference depth = { color_count, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL };
    const VkSubpassDescription subpass = { .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                           .colorAttachmentCount = color_count,
                                           .pColorAttachments = colors,
                                           .pDepthStencilAttachment = &depth };
    /* Whatever came before, and whatever comes after: a renderer that counts microseconds says less. */
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                               own = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    const VkAccessFlags writes = VK_ACCESS_MEMORY_WRITE_BIT, any = writes | VK_ACCESS_MEMORY_READ_BIT;
    const VkSubpassDependency around[] = { { VK_SUBPASS_EXTERNAL, 0, all, own, writes, any, 0 },
                                           { 0, VK_SUBPASS_EXTERNAL, own, all, writes, any, 0 } };
    const VkRenderPassCreateInfo info = { .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                          .attachmentCount = color_count + 1,
                                          .pAttachments = attachments,
                                          .subpassCount = 1,
                                          .pSubpasses = &subpass,
                                          .dependencyCount = 2,
                                          .pDependencies = around };
    VkRenderPass made;
    SAMPLE_CHECK(vkCreateRenderPass(gpu->device, &info, NULL, &made));
    SAMPLE_KEEP(gpu, RENDER_PASS, made);
    return made;
}

struct sample_pass sample_pass_make(struct sample_gpu *gpu, const struct sample_image *colors,
                                    uint32_t color_count, VkImageLayout colors_after,
                                    const struct sample_image *depth)
{
    struct sample_pass made = { .width = depth->width, .height = depth->height, .color_count = color_count };
    VkAttachmentDescription attachments[SAMPLE_MAX_COLORS + 1];
    VkImageView views[SAMPLE_MAX_COLORS + 1];
    for (uint32_t i = 0; i < color_count; i++) {
        attachments[i] = attachment(colors[i].format, colors_after);
        views[i] = colors[i].view;
    }
    attachments[color_count] = attachment(depth->format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    views[color_count] = depth->view;
    made.clear[color_count].depthStencil.depth = 1;
    made.pass = render_pass(gpu, attachments, color_count);
    const VkFramebufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = made.pass,
                                           .attachmentCount = color_count + 1,
                                           .pAttachments = views,
                                           .width = made.width,
                                           .height = made.height,
                                           .layers = 1 };
    SAMPLE_CHECK(vkCreateFramebuffer(gpu->device, &info, NULL, &made.framebuffer));
    SAMPLE_KEEP(gpu, FRAMEBUFFER, made.framebuffer);
    return made;
}

void sample_pass_begin(VkCommandBuffer cmd, const struct sample_pass *pass)
{
    const VkRenderPassBeginInfo info = { .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = pass->pass,
                                         .framebuffer = pass->framebuffer,
                                         .renderArea.extent = { pass->width, pass->height },
                                         .clearValueCount = pass->color_count + 1,
                                         .pClearValues = pass->clear };
    vkCmdBeginRenderPass(cmd, &info, VK_SUBPASS_CONTENTS_INLINE);
}

/* ---- Descriptors */

static VkSampler sampler_make(struct sample_gpu *gpu)
{
    const VkSamplerCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                       .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                       .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                       .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                       .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE };
    VkSampler made;
    SAMPLE_CHECK(vkCreateSampler(gpu->device, &info, NULL, &made));
    SAMPLE_KEEP(gpu, SAMPLER, made);
    return made;
}

static VkDescriptorSetLayout set_layout_make(struct sample_gpu *gpu, const struct sample_binding *bindings,
                                             uint32_t count)
{
    VkDescriptorSetLayoutBinding rows[SAMPLE_MAX_BINDINGS];
    for (uint32_t i = 0; i < count; i++)
        rows[i] = (VkDescriptorSetLayoutBinding){ i, bindings[i].type, 1, VK_SHADER_STAGE_ALL, NULL };
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = count, .pBindings = rows
    };
    VkDescriptorSetLayout made;
    SAMPLE_CHECK(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &made));
    SAMPLE_KEEP(gpu, DESCRIPTOR_SET_LAYOUT, made);
    return made;
}

void sample_set_replace(struct sample_gpu *gpu, const struct sample_set *set, uint32_t binding,
                        const struct sample_binding *by)
{
    const VkDescriptorBufferInfo buffer = { by->buffer, 0, VK_WHOLE_SIZE };
    const VkDescriptorImageInfo image = { set->sampler, by->view, by->layout };
    const VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = set->set,
                                         .dstBinding = binding,
                                         .descriptorCount = 1,
                                         .descriptorType = by->type,
                                         .pBufferInfo = &buffer,
                                         .pImageInfo = &image };
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

struct sample_set sample_set_make(struct sample_gpu *gpu, const struct sample_binding *bindings,
                                  uint32_t count)
{
    sample_require(count <= SAMPLE_MAX_BINDINGS, "SAMPLE_MAX_BINDINGS are too few");
    struct sample_set made = { .layout = set_layout_make(gpu, bindings, count) };
    const VkDescriptorSetAllocateInfo take = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = gpu->sets,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &made.layout };
    SAMPLE_CHECK(vkAllocateDescriptorSets(gpu->device, &take, &made.set));
    made.sampler = sampler_make(gpu);
    for (uint32_t i = 0; i < count; i++)
        sample_set_replace(gpu, &made, i, &bindings[i]);
    return made;
}

/* ---- Pipelines */

VkPipelineLayout sample_layout_make(struct sample_gpu *gpu, const VkDescriptorSetLayout *sets, uint32_t count)
{
    const VkPushConstantRange push = { VK_SHADER_STAGE_ALL, 0, SAMPLE_PUSH_BYTES };
    const VkPipelineLayoutCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = count,
                                              .pSetLayouts = sets,
                                              .pushConstantRangeCount = 1,
                                              .pPushConstantRanges = &push };
    VkPipelineLayout made;
    SAMPLE_CHECK(vkCreatePipelineLayout(gpu->device, &info, NULL, &made));
    SAMPLE_KEEP(gpu, PIPELINE_LAYOUT, made);
    return made;
}

static VkPipelineShaderStageCreateInfo stage_make(struct sample_gpu *gpu, VkShaderStageFlagBits stage,
                                                  struct sample_code code)
{
    VkPipelineShaderStageCreateInfo made = { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                             .stage = stage,
                                             .pName = "main" };
    const VkShaderModuleCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = code.bytes,
                                            .pCode = code.words };
    SAMPLE_CHECK(vkCreateShaderModule(gpu->device, &info, NULL, &made.module));
    return made;
}

/* ---- What all pipelines of meshes have */

static const VkVertexInputBindingDescription vertex_buffer = { 0, sizeof(struct sample_vertex),
                                                               VK_VERTEX_INPUT_RATE_VERTEX };
static const VkVertexInputAttributeDescription vertex_attributes[] = {
    { 0, 0, VK_FORMAT_R8G8B8A8_SNORM, offsetof(struct sample_vertex, normal) },
    { 1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(struct sample_vertex, position) }
};
static const VkPipelineVertexInputStateCreateInfo vertices = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
    .vertexBindingDescriptionCount = 1,
    .pVertexBindingDescriptions = &vertex_buffer,
    .vertexAttributeDescriptionCount = 2,
    .pVertexAttributeDescriptions = vertex_attributes
};
static const VkPipelineInputAssemblyStateCreateInfo triangles = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
};
static const VkPipelineMultisampleStateCreateInfo one_sample = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT
};
static const VkPipelineDepthStencilStateCreateInfo depth_test = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
    .depthTestEnable = VK_TRUE,
    .depthWriteEnable = VK_TRUE,
    .depthCompareOp = VK_COMPARE_OP_LESS
};
static const VkPipelineColorBlendAttachmentState plain[SAMPLE_MAX_COLORS] = {
    { .colorWriteMask = 15 }, { .colorWriteMask = 15 }, { .colorWriteMask = 15 }, { .colorWriteMask = 15 }
};

VkPipeline sample_mesh_pipeline_make(struct sample_gpu *gpu, const struct sample_pass *pass,
                                     VkPipelineLayout layout, struct sample_code vertex,
                                     struct sample_code fragment)
{
    const bool depth_alone = fragment.bytes == 0;
    VkPipelineShaderStageCreateInfo stages[2] = { stage_make(gpu, VK_SHADER_STAGE_VERTEX_BIT, vertex) };
    if (!depth_alone)
        stages[1] = stage_make(gpu, VK_SHADER_STAGE_FRAGMENT_BIT, fragment);
    const VkViewport viewport = { 0, 0, (float)pass->width, (float)pass->height, 0, 1 };
    const VkRect2D scissor = { { 0, 0 }, { pass->width, pass->height } };
    const VkPipelineViewportStateCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor
    };
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .depthBiasEnable = depth_alone,
        .depthBiasConstantFactor = 2,
        .depthBiasSlopeFactor = 2,
        .lineWidth = 1
    };
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = pass->color_count,
        .pAttachments = plain
    };
    const VkGraphicsPipelineCreateInfo info = { .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                                .stageCount = depth_alone ? 1 : 2,
                                                .pStages = stages,
                                                .pVertexInputState = &vertices,
                                                .pInputAssemblyState = &triangles,
                                                .pViewportState = &view,
                                                .pRasterizationState = &raster,
                                                .pMultisampleState = &one_sample,
                                                .pDepthStencilState = &depth_test,
                                                .pColorBlendState = &blend,
                                                .layout = layout,
                                                .renderPass = pass->pass };
    VkPipeline made;
    SAMPLE_CHECK(vkCreateGraphicsPipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &made));
    SAMPLE_KEEP(gpu, PIPELINE, made);
    for (uint32_t i = 0; i < info.stageCount; i++)
        vkDestroyShaderModule(gpu->device, stages[i].module, NULL);
    return made;
}

VkPipeline sample_compute_pipeline_make(struct sample_gpu *gpu, VkPipelineLayout layout,
                                        struct sample_code code)
{
    const VkComputePipelineCreateInfo info = { .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                               .stage = stage_make(gpu, VK_SHADER_STAGE_COMPUTE_BIT, code),
                                               .layout = layout };
    VkPipeline made;
    SAMPLE_CHECK(vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &made));
    SAMPLE_KEEP(gpu, PIPELINE, made);
    vkDestroyShaderModule(gpu->device, info.stage.module, NULL);
    return made;
}
