/* SPDX-License-Identifier: MIT */
#include "gpu_test_compute.h"

#include "gpu_test_check.h"

#include <vulkan/vulkan.h>

enum { GROUP_SIZE = 64 };

struct work {
    const struct gpu_test_pipeline *pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet sets[2];
    uint32_t count;
};

static VkDescriptorSetLayout set_layout_create(struct gpu_test *gpu, uint32_t bindings)
{
    const VkDescriptorSetLayoutBinding binding = { 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                   VK_SHADER_STAGE_COMPUTE_BIT, NULL };
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = bindings,
        .pBindings = &binding,
    };
    VkDescriptorSetLayout layout;
    GPU_CHECK(vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &layout));
    return layout;
}

static void pipeline_create(struct gpu_test *gpu, const struct gpu_test_shader *shader)
{
    struct gpu_test_pipeline *kept = &gpu->kept;
    kept->code = shader->code;
    kept->given = shader->layout != VK_NULL_HANDLE;
    kept->layouts[0] = shader->layout ? shader->layout : set_layout_create(gpu, 0);
    kept->layouts[1] = set_layout_create(gpu, 1);
    const VkPushConstantRange push = { VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(uint32_t) };
    const VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = kept->layouts,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &push,
    };
    GPU_CHECK(vkCreatePipelineLayout(gpu->device, &layout, NULL, &kept->layout));
    const VkShaderModuleCreateInfo code = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = shader->code_size,
        .pCode = shader->code,
    };
    VkShaderModule module;
    GPU_CHECK(vkCreateShaderModule(gpu->device, &code, NULL, &module));
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                   .module = module,
                   .pName = "main" },
        .layout = kept->layout,
    };
    GPU_CHECK(vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &kept->pipeline));
    vkDestroyShaderModule(gpu->device, module, NULL);
}

static void set_create(struct gpu_test *gpu, struct work *work, VkBuffer buffer)
{
    const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1 };
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = 1,
        .pPoolSizes = &size,
    };
    GPU_CHECK(vkCreateDescriptorPool(gpu->device, &pool, NULL, &work->pool));
    const VkDescriptorSetAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = work->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &work->pipeline->layouts[1],
    };
    GPU_CHECK(vkAllocateDescriptorSets(gpu->device, &allocate, &work->sets[1]));
    const VkDescriptorBufferInfo range = { buffer, 0, VK_WHOLE_SIZE };
    const VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = work->sets[1],
        .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        .pBufferInfo = &range,
    };
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
}

static void record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct work *work = user;
    const uint32_t first = work->sets[0] ? 0 : 1;
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, work->pipeline->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, work->pipeline->layout, first, 2 - first,
                            work->sets + first, 0, NULL);
    vkCmdPushConstants(cmd, work->pipeline->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof work->count,
                       &work->count);
    vkCmdDispatch(cmd, (work->count + GROUP_SIZE - 1) / GROUP_SIZE, 1, 1);
}

void gpu_test_compute_forget(struct gpu_test *gpu)
{
    struct gpu_test_pipeline *kept = &gpu->kept;
    vkDestroyPipeline(gpu->device, kept->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, kept->layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, kept->layouts[1], NULL);
    if (!kept->given)
        vkDestroyDescriptorSetLayout(gpu->device, kept->layouts[0], NULL);
    *kept = (struct gpu_test_pipeline){ 0 };
}

void gpu_test_compute(struct gpu_test *gpu, const struct gpu_test_shader *shader, uint32_t count, void *data,
                      size_t size)
{
    if (gpu->kept.code != shader->code || gpu->kept.given != (shader->layout != VK_NULL_HANDLE)) {
        gpu_test_compute_forget(gpu);
        pipeline_create(gpu, shader);
    }
    struct work work = { .pipeline = &gpu->kept, .sets = { shader->set }, .count = count };
    struct gpu_test_buffer buffer = gpu_test_buffer_host(gpu, size, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, data);
    set_create(gpu, &work, buffer.buffer);
    gpu_test_submit(gpu, record, &work);
    memcpy(data, buffer.mapped, size);
    vkDestroyDescriptorPool(gpu->device, work.pool, NULL);
    gpu_test_buffer_destroy(gpu, &buffer);
}

void gpu_test_compute_alone(const uint32_t *code, size_t code_size, uint32_t count, void *data, size_t size)
{
    static struct gpu_test gpu; /* must stay where it is */
    const struct gpu_test_shader shader = { .code = code, .code_size = code_size };
    gpu_test_open(&gpu, NULL);
    gpu_test_compute(&gpu, &shader, count, data, size);
    gpu_test_close(&gpu);
}
