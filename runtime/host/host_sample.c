/* SPDX-License-Identifier: MIT
 * Light at points of the world that no picture need show. */
#include "host_internal.h"
#include "host_math.h"

#include <string.h>

#include "host_sample_comp.h"
#include "host_sample_software_comp.h"

/* How far off the surface its viewer is assumed: within the first cell of common settings. */
static const float eye_m = 0.2f;

static bool layouts_create(struct host_renderer *renderer)
{
    struct host_device *device = renderer->device;
    struct host_sampler *s = &renderer->sampler;
    const VkDescriptorSetLayoutBinding binding = { .binding = 0,
                                                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                   .descriptorCount = 1,
                                                   .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT };
    const VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding,
    };
    if (!host_check(device, vkCreateDescriptorSetLayout(device->device, &set_info, NULL, &s->set_layout),
                    "creating a descriptor set layout"))
        return false;
    const VkDescriptorSetLayout sets[] = { s->set_layout, host_gi_layout(renderer->gi) };
    const VkPushConstantRange push = { VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct host_sample_push) };
    const VkPipelineLayoutCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = HOST_COUNT(sets),
                                              .pSetLayouts = sets,
                                              .pushConstantRangeCount = 1,
                                              .pPushConstantRanges = &push };
    return host_check(device, vkCreatePipelineLayout(device->device, &info, NULL, &s->layout),
                      "creating a pipeline layout");
}

static bool set_create(struct host_renderer *renderer)
{
    struct host_device *device = renderer->device;
    struct host_sampler *s = &renderer->sampler;
    const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1 };
    const VkDescriptorPoolCreateInfo pool = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                              .maxSets = 1,
                                              .poolSizeCount = 1,
                                              .pPoolSizes = &size };
    if (!host_check(device, vkCreateDescriptorPool(device->device, &pool, NULL, &s->pool),
                    "creating a descriptor pool"))
        return false;
    const VkDescriptorSetAllocateInfo allocate = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                   .descriptorPool = s->pool,
                                                   .descriptorSetCount = 1,
                                                   .pSetLayouts = &s->set_layout };
    if (!host_check(device, vkAllocateDescriptorSets(device->device, &allocate, &s->set),
                    "allocating a descriptor set"))
        return false;
    const VkDescriptorBufferInfo buffer = { s->results.buffer, 0, VK_WHOLE_SIZE };
    const VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = s->set,
                                         .descriptorCount = 1,
                                         .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                         .pBufferInfo = &buffer };
    vkUpdateDescriptorSets(device->device, 1, &write, 0, NULL);
    return true;
}

/* On first use: few programs ask. */
static bool sampler_init(struct host_renderer *renderer)
{
    struct host_sampler *s = &renderer->sampler;
    if (s->ready)
        return true;
    host_sampler_finish(renderer);
    s->ready =
        host_buffer_create(renderer->device, sizeof(float[HOST_MAX_SAMPLES][4]),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true, &s->results) &&
        layouts_create(renderer) && set_create(renderer) &&
        host_pipeline_compute_create(renderer->device, HOST_LOOKUP_CODE(renderer->gi, host_sample, comp),
                                     s->layout, &s->pipeline);
    return s->ready;
}

void host_sampler_finish(struct host_renderer *renderer)
{
    struct host_sampler *s = &renderer->sampler;
    VkDevice device = renderer->device->device;
    vkDestroyPipeline(device, s->pipeline, NULL);
    vkDestroyPipelineLayout(device, s->layout, NULL);
    vkDestroyDescriptorPool(device, s->pool, NULL);
    vkDestroyDescriptorSetLayout(device, s->set_layout, NULL);
    host_buffer_destroy(renderer->device, &s->results);
    *s = (struct host_sampler){ 0 };
}

static struct host_sample_push sample_push(const struct host_renderer *renderer,
                                           const struct host_sample *sample, uint32_t index)
{
    struct host_sample_push push = { .position = { 0, 0, 0, (float)index }, .normal = { 0, 0, 0, eye_m } };
    double normal[3] = { (double)sample->normal[0], (double)sample->normal[1], (double)sample->normal[2] };
    host_normalize3(normal);
    for (int i = 0; i < 3; i++) {
        push.position[i] = (float)(sample->position[i] - renderer->camera.origin[i]);
        push.normal[i] = (float)normal[i];
    }
    return push;
}

static void samples_record(struct host_renderer *renderer, VkCommandBuffer cmd, VkDescriptorSet gi_set,
                           const struct host_sample *samples, uint32_t count)
{
    const struct host_sampler *s = &renderer->sampler;
    const VkDescriptorSet sets[] = { s->set, gi_set };
    const VkMemoryBarrier after = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_HOST_READ_BIT };
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, s->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, s->layout, 0, HOST_COUNT(sets), sets, 0,
                            NULL);
    for (uint32_t i = 0; i < count; i++) {
        const struct host_sample_push push = sample_push(renderer, &samples[i], i);
        vkCmdPushConstants(cmd, s->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
        vkCmdDispatch(cmd, 1, 1, 1);
    }
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &after,
                         0, NULL, 0, NULL);
}

bool host_renderer_sample(struct host_renderer *renderer, const struct host_sample *samples, uint32_t count,
                          float (*irradiance)[3])
{
    const VkDescriptorSet gi_set = host_gi_set(renderer->gi);
    if (count > HOST_MAX_SAMPLES)
        return host_fail(renderer->device, "%u samples: %d at a time are possible", count, HOST_MAX_SAMPLES);
    if (!renderer->has_frame || !gi_set)
        return host_fail(renderer->device, "no light to sample: global illumination is off or has no frame");
    if (!host_slots_wait(renderer) || !sampler_init(renderer))
        return false;
    VkCommandBuffer cmd = host_commands_begin(renderer->device);
    if (!cmd)
        return false;
    samples_record(renderer, cmd, gi_set, samples, count);
    if (!host_commands_finish(renderer->device, cmd))
        return false;
    const float *results = renderer->sampler.results.mapped;
    for (uint32_t i = 0; i < count; i++)
        memcpy(irradiance[i], results + 4 * i, 3 * sizeof(float));
    return true;
}
