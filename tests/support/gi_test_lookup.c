/* SPDX-License-Identifier: MIT
 * Runs gi_lookup.comp, a host's shader, over a list of points. */
#include "gi_test.h"

#include "gpu_test_check.h"

#include "gi_lookup.comp.h"

#include <vulkan/vulkan.h>

#include <stdlib.h>

enum { POINTS_PER_GROUP = 64, FLOATS_PER_POINT = 12 };

struct lookup {
    struct gi_test *t;
    struct gpu_test_buffer points;
    uint32_t count;
    VkDescriptorSetLayout points_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
};

static void lookup_create_layouts(struct lookup *l)
{
    const VkDescriptorSetLayoutBinding binding = { 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                   VK_SHADER_STAGE_COMPUTE_BIT, NULL };
    const VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 1, .pBindings = &binding
    };
    GPU_CHECK(vkCreateDescriptorSetLayout(l->t->gpu.device, &set_info, NULL, &l->points_layout));
    const VkDescriptorSetLayout sets[2] = { sdfgi_get_descriptor_set_layout(l->t->gi), l->points_layout };
    const VkPushConstantRange range = { VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof l->count };
    const VkPipelineLayoutCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = 2,
                                              .pSetLayouts = sets,
                                              .pushConstantRangeCount = 1,
                                              .pPushConstantRanges = &range };
    GPU_CHECK(vkCreatePipelineLayout(l->t->gpu.device, &info, NULL, &l->layout));
}

static void lookup_create_pipeline(struct lookup *l)
{
    const VkShaderModuleCreateInfo code = { .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = sizeof gi_lookup_comp,
                                            .pCode = gi_lookup_comp };
    VkComputePipelineCreateInfo info = { .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = { .sType =
                                                        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                    .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                    .pName = "main" },
                                         .layout = l->layout };
    const VkDevice device = l->t->gpu.device;
    GPU_CHECK(vkCreateShaderModule(device, &code, NULL, &info.stage.module));
    GPU_CHECK(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &l->pipeline));
    vkDestroyShaderModule(device, info.stage.module, NULL);
}

static void lookup_create_set(struct lookup *l)
{
    const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1 };
    const VkDescriptorPoolCreateInfo pool_info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                   .maxSets = 1,
                                                   .poolSizeCount = 1,
                                                   .pPoolSizes = &size };
    const VkDevice device = l->t->gpu.device;
    GPU_CHECK(vkCreateDescriptorPool(device, &pool_info, NULL, &l->pool));
    const VkDescriptorSetAllocateInfo set_info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                   .descriptorPool = l->pool,
                                                   .descriptorSetCount = 1,
                                                   .pSetLayouts = &l->points_layout };
    GPU_CHECK(vkAllocateDescriptorSets(device, &set_info, &l->set));
    const VkDescriptorBufferInfo buffer = { l->points.buffer, 0, VK_WHOLE_SIZE };
    const VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = l->set,
                                         .descriptorCount = 1,
                                         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                         .pBufferInfo = &buffer };
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
}

static void lookup_destroy(struct lookup *l)
{
    const VkDevice device = l->t->gpu.device;
    vkDestroyDescriptorPool(device, l->pool, NULL);
    vkDestroyPipeline(device, l->pipeline, NULL);
    vkDestroyPipelineLayout(device, l->layout, NULL);
    vkDestroyDescriptorSetLayout(device, l->points_layout, NULL);
    gpu_test_buffer_destroy(&l->t->gpu, &l->points);
}

static void lookup_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct lookup *l = user;
    const VkDescriptorSet sets[2] = { sdfgi_get_descriptor_set(l->t->gi), l->set };
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, l->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, l->layout, 0, 2, sets, 0, NULL);
    vkCmdPushConstants(cmd, l->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof l->count, &l->count);
    vkCmdDispatch(cmd, (l->count + POINTS_PER_GROUP - 1) / POINTS_PER_GROUP, 1, 1);
    const VkMemoryBarrier to_host = { VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, VK_ACCESS_SHADER_WRITE_BIT,
                                      VK_ACCESS_HOST_READ_BIT };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &to_host, 0, NULL, 0, NULL);
}

void gi_test_irradiance_from(struct gi_test *t, const float *viewer, const struct gi_test_point *points,
                             uint32_t count, float (*irradiance)[3])
{
    REQUIRE_TRUE(sdfgi_is_active(t->gi));
    struct lookup l = { .t = t, .count = count };
    l.points = gpu_test_buffer_host(&t->gpu, (VkDeviceSize)count * FLOATS_PER_POINT * sizeof(float),
                                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, NULL);
    float(*rows)[FLOATS_PER_POINT] = l.points.mapped;
    for (uint32_t i = 0; i < count; i++) {
        memset(rows[i], 0, sizeof rows[i]);
        memcpy(&rows[i][0], points[i].position, sizeof points[i].position);
        memcpy(&rows[i][4], points[i].normal, sizeof points[i].normal);
        for (int k = 0; k < 3; k++)
            rows[i][3 + 4 * k] = viewer ? viewer[k] - points[i].position[k] : 0.1f * points[i].normal[k];
        /* What a shader that does not write would leave behind must not look like light. */
        rows[i][8] = rows[i][9] = rows[i][10] = NAN;
    }
    lookup_create_layouts(&l);
    lookup_create_pipeline(&l);
    lookup_create_set(&l);
    gpu_test_submit(&t->gpu, lookup_record, &l);
    for (uint32_t i = 0; i < count; i++)
        memcpy(irradiance[i], &rows[i][8], sizeof irradiance[i]);
    lookup_destroy(&l);
}

void gi_test_irradiance(struct gi_test *t, const struct gi_test_point *points, uint32_t count,
                        float (*irradiance)[3])
{
    gi_test_irradiance_from(t, NULL, points, count, irradiance);
}
