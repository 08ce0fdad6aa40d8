/* SPDX-License-Identifier: MIT
 * Stage 8, diffuse, as a screen pass. */
#include "internal.h"

#include <math.h>
#include <string.h>

static const char *gather_problem(const struct sdfgi *gi, const struct sdfgi_gather_desc *d)
{
    if (!d->depth || !d->normal || !d->output)
        return "depth, normal or output is null";
    if (d->width == 0 || d->height == 0)
        return "width or height is 0";
    for (int i = 0; i < 16; i++)
        if (!isfinite(d->inverse_view_projection[i]))
            return "inverse_view_projection is not finite";
    return gi->gathers >= SDFGI_MAX_GATHERS ? "more than 8 gathers since the last sdfgi_update" : NULL;
}

static void write_set(struct sdfgi *gi, VkDescriptorSet set, const struct sdfgi_gather_desc *d)
{
    const VkImageLayout layout = d->input_layout ? d->input_layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkDescriptorImageInfo images[3] = {
        { VK_NULL_HANDLE, d->depth, layout },
        { VK_NULL_HANDLE, d->normal, layout },
        { VK_NULL_HANDLE, d->output, VK_IMAGE_LAYOUT_GENERAL },
    };
    VkWriteDescriptorSet writes[3];
    for (uint32_t i = 0; i < 3; i++)
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = i == SDFGI_BINDING_GATHER_OUTPUT ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                               : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .pImageInfo = &images[i],
        };
    gi->device.fn.UpdateDescriptorSets(gi->device.handle, 3, writes, 0, NULL);
}

static void record(struct frame *frame, VkDescriptorSet set, const struct sdfgi_gather_desc *d)
{
    struct sdfgi *gi = frame->gi;
    struct sdfgi_gather_args args = { .width = d->width,
                                      .height = d->height,
                                      .background_depth = d->background_depth };
    memcpy(args.inverse_view_projection, d->inverse_view_projection, sizeof args.inverse_view_projection);
    const VkPipelineLayout layout = gi->pipelines.gather_layout_pipeline;
    pass_begin(frame, PASS_GATHER);
    gpu_bind_pipeline(&frame->rec, VK_PIPELINE_BIND_POINT_COMPUTE, gi->pipelines.passes[PASS_GATHER]);
    gpu_bind_set(&frame->rec, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, gi->resources->set);
    gpu_bind_set(&frame->rec, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 1, set);
    gpu_push(&frame->rec, layout, sizeof args, &args);
    gpu_use(&frame->rec, GPU_USAGE_COMPUTE, pass_reads(PASS_GATHER), pass_writes(PASS_GATHER));
    gpu_dispatch(&frame->rec, (d->width + SDFGI_GROUP_PIXELS - 1) / SDFGI_GROUP_PIXELS,
                 (d->height + SDFGI_GROUP_PIXELS - 1) / SDFGI_GROUP_PIXELS, 1);
    pass_end(frame);
    gi->passes[PASS_GATHER].dispatches++;
    gi->passes[PASS_GATHER].work += (uint64_t)d->width * d->height;
}

enum sdfgi_result sdfgi_gather(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_gather_desc *desc)
{
    if (!gi->active)
        return SDFGI_OK;
    const char *problem = gather_problem(gi, desc);
    if (problem)
        return invalid(gi, "sdfgi_gather: %s", problem);
    const VkResult made = pipelines_make_gather(gi);
    if (made != VK_SUCCESS)
        return message_vulkan(gi, made, "sdfgi_gather");
    struct frame frame = { .gi = gi, .slot = (uint32_t)(gi->frame % gi->frames_in_flight) };
    const VkDescriptorSet set = gi->resources->gather_sets[frame.slot][gi->gathers++];
    write_set(gi, set, desc);
    gpu_recorder_begin(&frame.rec, &gi->device, cmd);
    record(&frame, set, desc);
    gpu_recorder_end(&frame.rec);
    gi->plan[PASS_GATHER] = (struct decision){ true, "the host called sdfgi_gather" };
    return SDFGI_OK;
}
