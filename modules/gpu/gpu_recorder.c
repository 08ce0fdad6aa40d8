/* SPDX-License-Identifier: MIT */
#include "gpu.h"

#include <assert.h>

#define SHADER_ACCESS   (VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT)
#define TRANSFER_ACCESS (VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT)
#define GRAPHICS_STAGES (VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT)

static const struct {
    VkPipelineStageFlags stages;
    VkAccessFlags access;
} usages[GPU_USAGE_COUNT] = {
    [GPU_USAGE_COMPUTE] = { VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, SHADER_ACCESS },
    [GPU_USAGE_GRAPHICS] = { GRAPHICS_STAGES, SHADER_ACCESS },
    [GPU_USAGE_TRANSFER] = { VK_PIPELINE_STAGE_TRANSFER_BIT, TRANSFER_ACCESS },
    [GPU_USAGE_INDIRECT] = { VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                             SHADER_ACCESS | VK_ACCESS_INDIRECT_COMMAND_READ_BIT },
};

#define WRITE_ACCESS (VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT)

static void memory_barrier(struct gpu_recorder *rec, VkPipelineStageFlags from, VkAccessFlags from_access,
                           VkPipelineStageFlags to, VkAccessFlags to_access)
{
    const VkMemoryBarrier barrier = { VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL, from_access, to_access };
    rec->device->fn.CmdPipelineBarrier(rec->cmd, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
    rec->command_count++;
}

void gpu_recorder_begin(struct gpu_recorder *rec, const struct gpu_device *device, VkCommandBuffer cmd)
{
    *rec = (struct gpu_recorder){ .device = device, .cmd = cmd };
}

void gpu_recorder_end(struct gpu_recorder *rec)
{
    if (rec->begun)
        memory_barrier(rec, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                       VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                       VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_HOST_READ_BIT);
    rec->begun = false;
}

/* Orders everything recorded since the last barrier, and on first use everything before, against `usage`. */
static void order(struct gpu_recorder *rec, enum gpu_usage usage)
{
    if (!rec->begun)
        memory_barrier(rec, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                       VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                       VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
    else
        /* Reads of other stages than `usage` that come later were not ordered by this barrier; so that they
         * need none, it covers all stages the library uses. */
        memory_barrier(rec, rec->stages, rec->write_access,
                       usages[usage].stages | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                           VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                       usages[usage].access | SHADER_ACCESS | TRANSFER_ACCESS |
                           VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    rec->begun = true;
    rec->reads = rec->writes = 0;
    rec->stages = 0;
    rec->write_access = 0;
}

void gpu_order(struct gpu_recorder *rec, enum gpu_usage usage, uint64_t reads, uint64_t writes)
{
    const bool hazard = ((reads | writes) & rec->writes) || (writes & rec->reads);
    /* Graphics stages are not covered by barriers placed for others. */
    const bool new_graphics =
        usage == GPU_USAGE_GRAPHICS && !(rec->stages & VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
    if (!rec->begun || hazard || new_graphics)
        order(rec, usage);
}

void gpu_touch(struct gpu_recorder *rec, enum gpu_usage usage, uint64_t reads, uint64_t writes)
{
    rec->reads |= reads;
    rec->writes |= writes;
    rec->stages |= usages[usage].stages;
    if (writes)
        rec->write_access |= usages[usage].access & WRITE_ACCESS;
}

void gpu_use(struct gpu_recorder *rec, enum gpu_usage usage, uint64_t reads, uint64_t writes)
{
    gpu_order(rec, usage, reads, writes);
    gpu_touch(rec, usage, reads, writes);
}

void gpu_label_begin(struct gpu_recorder *rec, const char *name)
{
    if (!rec->device->fn.CmdBeginDebugUtilsLabelEXT)
        return;
    rec->device->fn.CmdBeginDebugUtilsLabelEXT(
        rec->cmd,
        &(VkDebugUtilsLabelEXT){ .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name });
}

void gpu_label_end(struct gpu_recorder *rec)
{
    if (rec->device->fn.CmdEndDebugUtilsLabelEXT)
        rec->device->fn.CmdEndDebugUtilsLabelEXT(rec->cmd);
}

void gpu_fill(struct gpu_recorder *rec, const struct gpu_buffer *buffer, uint64_t offset, uint64_t size,
              uint32_t value)
{
    rec->device->fn.CmdFillBuffer(rec->cmd, buffer->handle, offset, size, value);
    rec->command_count++;
}

void gpu_update(struct gpu_recorder *rec, const struct gpu_buffer *buffer, uint64_t offset, uint64_t size,
                const void *data)
{
    const uint64_t most = 65536; /* Vulkan's limit per command */
    for (uint64_t done = 0; done < size; done += most) {
        const uint64_t part = size - done < most ? size - done : most;
        rec->device->fn.CmdUpdateBuffer(rec->cmd, buffer->handle, offset + done, part,
                                        (const char *)data + done);
        rec->command_count++;
    }
}

void gpu_copy(struct gpu_recorder *rec, const struct gpu_buffer *from, uint64_t from_offset,
              const struct gpu_buffer *to, uint64_t to_offset, uint64_t size)
{
    const VkBufferCopy region = { from_offset, to_offset, size };
    rec->device->fn.CmdCopyBuffer(rec->cmd, from->handle, to->handle, 1, &region);
    rec->command_count++;
}

void gpu_images_to_general(struct gpu_recorder *rec, const struct gpu_image *const images[], uint32_t count)
{
    VkImageMemoryBarrier barriers[GPU_MOST_IMAGES];
    assert(count <= GPU_MOST_IMAGES);
    for (uint32_t i = 0; i < count; i++)
        barriers[i] = (VkImageMemoryBarrier){
            .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
            .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
            .dstAccessMask = SHADER_ACCESS,
            .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
            .newLayout = VK_IMAGE_LAYOUT_GENERAL,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = images[i]->handle,
            .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 },
        };
    rec->device->fn.CmdPipelineBarrier(rec->cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0, NULL, 0, NULL, count,
                                       barriers);
    rec->command_count++;
}

void gpu_bind_pipeline(struct gpu_recorder *rec, VkPipelineBindPoint point, VkPipeline pipeline)
{
    rec->device->fn.CmdBindPipeline(rec->cmd, point, pipeline);
    rec->command_count++;
}

void gpu_bind_set(struct gpu_recorder *rec, VkPipelineBindPoint point, VkPipelineLayout layout,
                  uint32_t index, VkDescriptorSet set)
{
    rec->device->fn.CmdBindDescriptorSets(rec->cmd, point, layout, index, 1, &set, 0, NULL);
    rec->command_count++;
}

void gpu_push(struct gpu_recorder *rec, VkPipelineLayout layout, uint32_t size, const void *data)
{
    rec->device->fn.CmdPushConstants(rec->cmd, layout, VK_SHADER_STAGE_ALL, 0, size, data);
    rec->command_count++;
}

void gpu_dispatch(struct gpu_recorder *rec, uint32_t x, uint32_t y, uint32_t z)
{
    rec->device->fn.CmdDispatch(rec->cmd, x, y, z);
    rec->command_count++;
}

void gpu_dispatch_indirect(struct gpu_recorder *rec, const struct gpu_buffer *arguments, uint64_t offset)
{
    rec->device->fn.CmdDispatchIndirect(rec->cmd, arguments->handle, offset);
    rec->command_count++;
}

void gpu_draw(struct gpu_recorder *rec, uint32_t vertices, uint32_t instances)
{
    rec->device->fn.CmdDraw(rec->cmd, vertices, instances, 0, 0);
    rec->command_count++;
}

void gpu_render_pass_begin(struct gpu_recorder *rec, VkRenderPass pass, VkFramebuffer framebuffer,
                           uint32_t extent)
{
    rec->device->fn.CmdBeginRenderPass(
        rec->cmd,
        &(VkRenderPassBeginInfo){ .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = pass,
                                  .framebuffer = framebuffer,
                                  .renderArea = { { 0, 0 }, { extent, extent } } },
        VK_SUBPASS_CONTENTS_INLINE);
    rec->command_count++;
}

void gpu_render_pass_end(struct gpu_recorder *rec)
{
    rec->device->fn.CmdEndRenderPass(rec->cmd);
    rec->command_count++;
}
