/* SPDX-License-Identifier: MIT
 * Render passes. Each ends with its attachments ready for shaders, so nothing between passes needs a barrier.
 */
#include "host_internal.h"

static const VkPipelineStageFlags output_stages = VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
                                                  VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
static const VkPipelineStageFlags reader_stages = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                                                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                                  VK_PIPELINE_STAGE_TRANSFER_BIT;

/* Waits for earlier readers and writers of the attachments before, and for these writes afterwards. */
static bool pass_create(struct host_device *device, const VkAttachmentDescription *attachments,
                        uint32_t count, const VkSubpassDescription *subpass, VkRenderPass *out)
{
    const VkAccessFlags writes =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkAccessFlags reads =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    const VkSubpassDependency dependencies[] = {
        { VK_SUBPASS_EXTERNAL, 0, output_stages | reader_stages, output_stages, writes, reads | writes, 0 },
        { 0, VK_SUBPASS_EXTERNAL, output_stages, output_stages | reader_stages, writes,
          reads | writes | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT, 0 },
    };
    const VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = count,
        .pAttachments = attachments,
        .subpassCount = 1,
        .pSubpasses = subpass,
        .dependencyCount = HOST_COUNT(dependencies),
        .pDependencies = dependencies,
    };
    return host_check(device, vkCreateRenderPass(device->device, &info, NULL, out), "creating a render pass");
}

static VkAttachmentDescription attachment(VkFormat format, VkAttachmentLoadOp load, VkImageLayout initial,
                                          VkImageLayout final)
{
    return (VkAttachmentDescription){
        .format = format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = load,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = initial,
        .finalLayout = final,
    };
}

static bool prepass_create(struct host_device *device, VkRenderPass *out)
{
    const VkAttachmentDescription attachments[] = {
        attachment(VK_FORMAT_R16G16B16A16_SFLOAT, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        attachment(VK_FORMAT_D32_SFLOAT, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
    };
    const VkAttachmentReference color = { 0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
    const VkAttachmentReference depth = { 1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL };
    const VkSubpassDescription subpass = { .colorAttachmentCount = 1,
                                           .pColorAttachments = &color,
                                           .pDepthStencilAttachment = &depth };
    return pass_create(device, attachments, HOST_COUNT(attachments), &subpass, out);
}

static bool forward_create(struct host_device *device, VkRenderPass *out)
{
    const VkAttachmentDescription attachments[] = {
        attachment(device->hdr_format, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        attachment(VK_FORMAT_D32_SFLOAT, VK_ATTACHMENT_LOAD_OP_LOAD, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
    };
    const VkAttachmentReference color = { 0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
    const VkAttachmentReference depth = { 1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL };
    const VkSubpassDescription subpass = { .colorAttachmentCount = 1,
                                           .pColorAttachments = &color,
                                           .pDepthStencilAttachment = &depth };
    return pass_create(device, attachments, HOST_COUNT(attachments), &subpass, out);
}

static bool shadow_create(struct host_device *device, VkRenderPass *out)
{
    const VkAttachmentDescription map =
        attachment(VK_FORMAT_D32_SFLOAT, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    const VkAttachmentReference depth = { 0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL };
    const VkSubpassDescription subpass = { .pDepthStencilAttachment = &depth };
    return pass_create(device, &map, 1, &subpass, out);
}

bool host_pass_picture_create(struct host_device *device, VkFormat format, VkImageLayout final_layout,
                              VkRenderPass *out)
{
    const VkAttachmentDescription picture =
        attachment(format, VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_IMAGE_LAYOUT_UNDEFINED, final_layout);
    const VkAttachmentReference color = { 0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
    const VkSubpassDescription subpass = { .colorAttachmentCount = 1, .pColorAttachments = &color };
    return pass_create(device, &picture, 1, &subpass, out);
}

bool host_passes_init(struct host_device *device, struct host_passes *passes)
{
    return prepass_create(device, &passes->prepass) && forward_create(device, &passes->forward) &&
           shadow_create(device, &passes->shadow) &&
           host_pass_picture_create(device, VK_FORMAT_R8G8B8A8_UNORM,
                                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, &passes->picture);
}

void host_passes_finish(struct host_device *device, struct host_passes *passes)
{
    vkDestroyRenderPass(device->device, passes->prepass, NULL);
    vkDestroyRenderPass(device->device, passes->forward, NULL);
    vkDestroyRenderPass(device->device, passes->shadow, NULL);
    vkDestroyRenderPass(device->device, passes->picture, NULL);
}
