/* SPDX-License-Identifier: MIT
 * Pipelines and their layouts. The forward shader exists four times: see enum host_forward, and with lookups
 * for materials that are rough everywhere once more, without reflections. Rays take most of its time. Lookups
 * have shaders of their own for software drivers. */
#include "host_internal.h"

#include "host_exposure_comp.h"
#include "host_forward_frag.h"
#include "host_forward_fog_frag.h"
#include "host_forward_gathered_frag.h"
#include "host_forward_gathered_fog_frag.h"
#include "host_forward_gi_frag.h"
#include "host_forward_gi_fog_frag.h"
#include "host_forward_gi_fog_software_frag.h"
#include "host_forward_gi_rays_frag.h"
#include "host_forward_gi_rays_fog_frag.h"
#include "host_forward_gi_rays_fog_software_frag.h"
#include "host_forward_gi_rays_software_frag.h"
#include "host_forward_gi_software_frag.h"
#include "host_prepass_frag.h"
#include "host_screen_vert.h"
#include "host_shadow_frag.h"
#include "host_shadow_vert.h"
#include "host_sky_environment_frag.h"
#include "host_sky_environment_fog_frag.h"
#include "host_sky_frag.h"
#include "host_sky_fog_frag.h"
#include "host_surface_vert.h"
#include "host_tonemap_frag.h"

#include <math.h>
#include <string.h>

static const VkCullModeFlags cull_modes[HOST_CULL_COUNT] = { [HOST_CULL_NONE] = VK_CULL_MODE_NONE,
                                                             [HOST_CULL_BACK] = VK_CULL_MODE_BACK_BIT,
                                                             [HOST_CULL_FRONT] = VK_CULL_MODE_FRONT_BIT };

/* What tells one graphics pipeline from another. */
struct pipeline_desc {
    struct host_code vertex, fragment; /* no fragment words: depth alone */
    VkPipelineLayout layout;
    VkRenderPass pass;
    bool vertices; /* geometry, as opposed to one triangle over the screen */
    bool has_color, has_depth, depth_write, blend;
    VkCompareOp compare;
    VkCullModeFlags cull;
};

static bool module_create(struct host_device *device, struct host_code code, VkShaderModule *out)
{
    const VkShaderModuleCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = code.bytes,
                                            .pCode = code.words };
    return host_check(device, vkCreateShaderModule(device->device, &info, NULL, out), "creating a shader");
}

static VkPipelineVertexInputStateCreateInfo vertex_input(bool vertices)
{
    static const VkVertexInputBindingDescription bindings[] = {
        { 0, 12, VK_VERTEX_INPUT_RATE_VERTEX }, { 1, 12, VK_VERTEX_INPUT_RATE_VERTEX },
        { 2, 16, VK_VERTEX_INPUT_RATE_VERTEX }, { 3, 8, VK_VERTEX_INPUT_RATE_VERTEX },
        { 4, 8, VK_VERTEX_INPUT_RATE_VERTEX },  { 5, 16, VK_VERTEX_INPUT_RATE_VERTEX },
    };
    static const VkVertexInputAttributeDescription attributes[] = {
        { 0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0 },    { 1, 1, VK_FORMAT_R32G32B32_SFLOAT, 0 },
        { 2, 2, VK_FORMAT_R32G32B32A32_SFLOAT, 0 }, { 3, 3, VK_FORMAT_R32G32_SFLOAT, 0 },
        { 4, 4, VK_FORMAT_R32G32_SFLOAT, 0 },       { 5, 5, VK_FORMAT_R32G32B32A32_SFLOAT, 0 },
    };
    return (VkPipelineVertexInputStateCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = vertices ? HOST_COUNT(bindings) : 0,
        .pVertexBindingDescriptions = bindings,
        .vertexAttributeDescriptionCount = vertices ? HOST_COUNT(attributes) : 0,
        .pVertexAttributeDescriptions = attributes,
    };
}

static VkPipelineColorBlendAttachmentState blend_state(bool blend)
{
    return (VkPipelineColorBlendAttachmentState){
        .blendEnable = blend,
        .srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA,
        .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
        .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
        .colorWriteMask = 0xf,
    };
}

/* The same for every graphics pipeline. */
static const VkPipelineInputAssemblyStateCreateInfo triangle_list = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
};
static const VkPipelineViewportStateCreateInfo one_viewport = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1
};
static const VkPipelineMultisampleStateCreateInfo one_sample = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
};
static const VkDynamicState dynamic_states[] = { VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR };
static const VkPipelineDynamicStateCreateInfo dynamic_state = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
    .dynamicStateCount = HOST_COUNT(dynamic_states),
    .pDynamicStates = dynamic_states,
};

static bool pipeline_build(struct host_device *device, const struct pipeline_desc *desc,
                           const VkPipelineShaderStageCreateInfo *stages, uint32_t stage_count,
                           VkPipeline *out)
{
    const VkPipelineVertexInputStateCreateInfo input = vertex_input(desc->vertices);
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = desc->cull,
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1.0f,
    };
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = desc->has_depth,
        .depthWriteEnable = desc->depth_write,
        .depthCompareOp = desc->compare,
    };
    const VkPipelineColorBlendAttachmentState attachment = blend_state(desc->blend);
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = desc->has_color ? 1 : 0,
        .pAttachments = &attachment,
    };
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .stageCount = stage_count,
        .pStages = stages,
        .pVertexInputState = &input,
        .pInputAssemblyState = &triangle_list,
        .pViewportState = &one_viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &one_sample,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic_state,
        .layout = desc->layout,
        .renderPass = desc->pass,
    };
    return host_check(device,
                      vkCreateGraphicsPipelines(device->device, device->cache.handle, 1, &info, NULL, out),
                      "creating a graphics pipeline");
}

/* Rays over the lobe of what is blended, such as glass: few pixels show it. */
enum { BLENDED_LOBE_RAYS = 16 };

/* Constants of shaders: `on_cpu` of lib/on_cpu.glsl, and `lobe_rays` of forward.frag. */
static VkSpecializationInfo constants_of(const uint32_t *values)
{
    static const VkSpecializationMapEntry entries[] = { { 0, 0, sizeof *values },
                                                        { 1, sizeof *values, sizeof *values } };
    return (VkSpecializationInfo){ HOST_COUNT(entries), entries, HOST_COUNT(entries) * sizeof *values,
                                   values };
}

static bool pipeline_create(struct host_device *device, const struct pipeline_desc *desc, VkPipeline *out)
{
    const uint32_t values[] = { device->info.is_cpu, desc->blend ? BLENDED_LOBE_RAYS : 1 };
    const VkSpecializationInfo constants = constants_of(values);
    VkShaderModule vertex = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
    bool ok = module_create(device, desc->vertex, &vertex) &&
              (!desc->fragment.words || module_create(device, desc->fragment, &fragment));
    if (ok) {
        const VkPipelineShaderStageCreateInfo stages[] = {
            { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
              .stage = VK_SHADER_STAGE_VERTEX_BIT,
              .module = vertex,
              .pName = "main",
              .pSpecializationInfo = &constants },
            { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
              .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
              .module = fragment,
              .pName = "main",
              .pSpecializationInfo = &constants },
        };
        ok = pipeline_build(device, desc, stages, fragment ? 2 : 1, out);
    }
    vkDestroyShaderModule(device->device, vertex, NULL);
    vkDestroyShaderModule(device->device, fragment, NULL);
    return ok;
}

/* ---- Layouts ---------------------------------------------------------------------------------------- */

bool host_set_layout_create(struct host_device *device, const VkDescriptorType *types, uint32_t count,
                            VkShaderStageFlags stages, VkDescriptorSetLayout *out)
{
    VkDescriptorSetLayoutBinding bindings[8];
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i, .descriptorType = types[i], .descriptorCount = 1, .stageFlags = stages
        };
    const VkDescriptorSetLayoutCreateInfo info = { .sType =
                                                       VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                   .bindingCount = count,
                                                   .pBindings = bindings };
    return host_check(device, vkCreateDescriptorSetLayout(device->device, &info, NULL, out),
                      "creating a descriptor set layout");
}

bool host_pipeline_layout_create(struct host_device *device, const VkDescriptorSetLayout *sets,
                                 uint32_t set_count, VkPushConstantRange push, VkPipelineLayout *out)
{
    const VkPipelineLayoutCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = set_count,
                                              .pSetLayouts = sets,
                                              .pushConstantRangeCount = push.size > 0 ? 1 : 0,
                                              .pPushConstantRanges = &push };
    return host_check(device, vkCreatePipelineLayout(device->device, &info, NULL, out),
                      "creating a pipeline layout");
}

/* The last binding is that of froxels, which compute shaders fill. */
static bool frame_layout_create(struct host_device *device, bool fog, VkDescriptorSetLayout *out)
{
    static const VkDescriptorType types[] = {
        VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,         VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,         VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    };
    const VkShaderStageFlags stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    return host_set_layout_create(device, types, fog ? HOST_FOG_BINDING + 1 : HOST_FOG_BINDING,
                                  fog ? stages | VK_SHADER_STAGE_COMPUTE_BIT : stages, out);
}

static bool layouts_create(struct host_device *device, VkDescriptorSetLayout material_layout,
                           VkDescriptorSetLayout gi_layout, bool fog, struct host_pipelines *p)
{
    static const VkDescriptorType light_types[] = { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER };
    static const VkDescriptorType post_types[] = { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                   VK_DESCRIPTOR_TYPE_STORAGE_BUFFER };
    const VkPushConstantRange draw = { VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                       sizeof(struct host_push) };
    const VkPushConstantRange tone = { VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                       sizeof(struct host_tone_push) };
    if (!frame_layout_create(device, fog, &p->frame_layout) ||
        !host_set_layout_create(device, post_types, HOST_COUNT(post_types),
                                VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                                &p->post_layout) ||
        !host_set_layout_create(device, light_types, HOST_COUNT(light_types), VK_SHADER_STAGE_FRAGMENT_BIT,
                                &p->light_layout))
        return false;
    const VkDescriptorSetLayout sets[] = { p->frame_layout, material_layout, gi_layout },
                                gathered[] = { p->frame_layout, material_layout, p->light_layout };
    return host_pipeline_layout_create(device, sets, 2, draw, &p->layouts[HOST_FORWARD_PLAIN]) &&
           host_pipeline_layout_create(device, sets, 3, draw, &p->layouts[HOST_FORWARD_GI]) &&
           host_pipeline_layout_create(device, gathered, 3, draw, &p->layouts[HOST_FORWARD_GATHERED]) &&
           host_pipeline_layout_create(device, &p->post_layout, 1, tone, &p->post_pipeline_layout);
}

/* ---- The pipelines ---------------------------------------------------------------------------------- */

static bool prepass_create(struct host_device *device, const struct host_passes *passes,
                           struct host_pipelines *p)
{
    for (int cull = 0; cull < HOST_CULL_COUNT; cull++) {
        const struct pipeline_desc desc = { .vertex = HOST_CODE(host_surface_vert),
                                            .fragment = HOST_CODE(host_prepass_frag),
                                            .layout = p->layouts[HOST_FORWARD_PLAIN],
                                            .pass = passes->prepass,
                                            .vertices = true,
                                            .has_color = true,
                                            .has_depth = true,
                                            .depth_write = true,
                                            .compare = VK_COMPARE_OP_GREATER,
                                            .cull = cull_modes[cull] };
        if (!pipeline_create(device, &desc, &p->prepass[cull]))
            return false;
    }
    return true;
}

/* Of the shader with lookups. */
static struct host_code lookup_code(const struct host_gi *gi, bool rays, bool fog)
{
    const struct host_code codes[2][2] = {
        { HOST_LOOKUP_CODE(gi, host_forward_gi, frag), HOST_LOOKUP_CODE(gi, host_forward_gi_fog, frag) },
        { HOST_LOOKUP_CODE(gi, host_forward_gi_rays, frag),
          HOST_LOOKUP_CODE(gi, host_forward_gi_rays_fog, frag) },
    };
    return codes[rays][fog];
}

static struct host_code forward_code(const struct host_renderer *renderer, enum host_forward kind, bool rays)
{
    const bool fog = host_fog_exists(renderer->scene);
    switch (kind) {
    case HOST_FORWARD_GI:
        return lookup_code(renderer->gi, rays, fog);
    case HOST_FORWARD_GATHERED:
        return fog ? HOST_CODE(host_forward_gathered_fog_frag) : HOST_CODE(host_forward_gathered_frag);
    default:
        return fog ? HOST_CODE(host_forward_fog_frag) : HOST_CODE(host_forward_frag);
    }
}

static bool forward_create(struct host_renderer *renderer, enum host_forward kind, enum host_cull cull,
                           bool blend, bool rays, VkPipeline *out)
{
    const struct pipeline_desc desc = {
        .vertex = HOST_CODE(host_surface_vert),
        .fragment = forward_code(renderer, kind, rays),
        .layout = renderer->pipelines.layouts[kind],
        .pass = renderer->passes.forward,
        .vertices = true,
        .has_color = true,
        .has_depth = true,
        .blend = blend,
        .compare = blend ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_EQUAL,
        .cull = cull_modes[cull],
    };
    return pipeline_create(renderer->device, &desc, out);
}

enum host_forward host_forward_kind(const struct host_renderer *renderer, bool blended)
{
    if (renderer->without_gi || !host_gi_set(renderer->gi))
        return HOST_FORWARD_PLAIN;
    return blended || renderer->lookups.diffuse == HOST_LOOKUP_FORWARD ? HOST_FORWARD_GI
                                                                       : HOST_FORWARD_GATHERED;
}

/* Whether a material reflects with sdfgi_lighting where its pixels look light up. */
static bool reflects(const struct host_pipelines *pipelines, enum host_forward kind,
                     const struct host_material *material)
{
    const float end = material->flags & HOST_MATERIAL_BLEND ? pipelines->blended_end : pipelines->rays_end;
    return kind == HOST_FORWARD_GI && 1 - material->gi.smoothness < end;
}

VkPipeline host_forward_pipeline(const struct host_renderer *renderer, enum host_forward kind,
                                 uint32_t instance)
{
    const struct host_material *material = host_instance_material(renderer->scene, instance);
    const bool blend = material->flags & HOST_MATERIAL_BLEND;
    return renderer->pipelines.forward[kind][host_instance_cull(renderer->scene, instance)][blend]
                                      [reflects(&renderer->pipelines, kind, material)];
}

/* What is blended reflects as opaque surfaces do, which have lobes where anything in the scene is smooth and
 * their light comes from a view. */
static float blended_end(const struct host_renderer *renderer, const struct sdfgi_settings *settings)
{
    const struct host_scene *scene = renderer->scene;
    if (settings->rough_lobes && renderer->lookups.diffuse != HOST_LOOKUP_FORWARD)
        for (uint32_t i = 0; i < scene->material_count; i++)
            if (1 - scene->materials[i].gi.smoothness < settings->reflection_end)
                return INFINITY;
    return settings->reflection_end;
}

/* Which materials reflect is a setting, which may change from frame to frame. */
static void follow_settings(struct host_renderer *renderer)
{
    struct host_pipelines *p = &renderer->pipelines;
    struct sdfgi_settings settings;
    host_gi_get_settings(renderer->gi, &settings);
    const float end = blended_end(renderer, &settings);
    if (settings.reflection_end != p->rays_end || end != p->blended_end)
        memset(p->forward_made, 0, sizeof p->forward_made);
    p->rays_end = settings.reflection_end;
    p->blended_end = end;
}

bool host_forward_prepare(struct host_renderer *renderer)
{
    struct host_pipelines *p = &renderer->pipelines;
    const struct host_scene *scene = renderer->scene;
    bool *made = &p->forward_made[host_forward_kind(renderer, false)];
    follow_settings(renderer);
    if (*made)
        return true;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct host_material *material = host_instance_material(scene, i);
        const enum host_cull cull = host_instance_cull(scene, i);
        const bool blend = material->flags & HOST_MATERIAL_BLEND;
        const enum host_forward kind = host_forward_kind(renderer, blend);
        const bool rays = reflects(p, kind, material);
        VkPipeline *pipeline = &p->forward[kind][cull][blend][rays];
        if (!*pipeline && !forward_create(renderer, kind, cull, blend, rays, pipeline))
            return false;
    }
    *made = true;
    return true;
}

/* Nothing is culled: every face blocks light from both sides. */
static bool shadow_create(struct host_device *device, const struct host_passes *passes,
                          struct host_pipelines *p)
{
    struct pipeline_desc desc = { .vertex = HOST_CODE(host_shadow_vert),
                                  .layout = p->layouts[HOST_FORWARD_PLAIN],
                                  .pass = passes->shadow,
                                  .vertices = true,
                                  .has_depth = true,
                                  .depth_write = true,
                                  .compare = VK_COMPARE_OP_GREATER };
    if (!pipeline_create(device, &desc, &p->shadow_solid))
        return false;
    desc.fragment = HOST_CODE(host_shadow_frag);
    return pipeline_create(device, &desc, &p->shadow_tested);
}

enum host_forward host_sky_kind(const struct host_scene *scene)
{
    return scene->environment.exists ? HOST_FORWARD_GATHERED : HOST_FORWARD_PLAIN;
}

static bool sky_create(const struct host_scene *scene, const struct host_passes *passes, bool fog,
                       struct host_pipelines *p)
{
    const struct host_code codes[2][2] = {
        { HOST_CODE(host_sky_frag), HOST_CODE(host_sky_fog_frag) },
        { HOST_CODE(host_sky_environment_frag), HOST_CODE(host_sky_environment_fog_frag) },
    };
    const struct pipeline_desc desc = { .vertex = HOST_CODE(host_screen_vert),
                                        .fragment = codes[scene->environment.exists][fog],
                                        .layout = p->layouts[host_sky_kind(scene)],
                                        .pass = passes->forward,
                                        .has_color = true,
                                        .has_depth = true,
                                        .compare = VK_COMPARE_OP_EQUAL };
    return pipeline_create(scene->device, &desc, &p->sky);
}

bool host_pipeline_tonemap_create(struct host_device *device, const struct host_pipelines *pipelines,
                                  VkRenderPass pass, VkPipeline *out)
{
    const struct pipeline_desc desc = { .vertex = HOST_CODE(host_screen_vert),
                                        .fragment = HOST_CODE(host_tonemap_frag),
                                        .layout = pipelines->post_pipeline_layout,
                                        .pass = pass,
                                        .has_color = true };
    return pipeline_create(device, &desc, out);
}

bool host_pipeline_compute_create(struct host_device *device, struct host_code code, VkPipelineLayout layout,
                                  VkPipeline *out)
{
    const uint32_t values[] = { device->info.is_cpu, 1 };
    const VkSpecializationInfo constants = constants_of(values);
    VkShaderModule module = VK_NULL_HANDLE;
    if (!module_create(device, code, &module))
        return false;
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = { .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                   .module = module,
                   .pName = "main",
                   .pSpecializationInfo = &constants },
        .layout = layout,
    };
    const bool ok = host_check(
        device, vkCreateComputePipelines(device->device, device->cache.handle, 1, &info, NULL, out),
        "creating a compute pipeline");
    vkDestroyShaderModule(device->device, module, NULL);
    return ok;
}

bool host_pipelines_init(const struct host_scene *scene, const struct host_passes *passes,
                         VkDescriptorSetLayout gi_layout, bool fog, struct host_pipelines *pipelines)
{
    struct host_device *const device = scene->device;
    return layouts_create(device, scene->material_layout, gi_layout, fog, pipelines) &&
           prepass_create(device, passes, pipelines) && shadow_create(device, passes, pipelines) &&
           sky_create(scene, passes, fog, pipelines) &&
           host_pipeline_compute_create(device, HOST_CODE(host_exposure_comp),
                                        pipelines->post_pipeline_layout, &pipelines->exposure) &&
           host_pipeline_tonemap_create(device, pipelines, passes->picture, &pipelines->tonemap);
}

void host_pipelines_finish(struct host_device *device, struct host_pipelines *p)
{
    VkDevice vk = device->device;
    for (int cull = 0; cull < HOST_CULL_COUNT; cull++) {
        vkDestroyPipeline(vk, p->prepass[cull], NULL);
        for (int kind = 0; kind < HOST_FORWARD_COUNT; kind++)
            for (int i = 0; i < 4; i++)
                vkDestroyPipeline(vk, p->forward[kind][cull][i / 2][i % 2], NULL);
    }
    const VkPipeline rest[] = { p->shadow_solid, p->shadow_tested, p->sky, p->exposure, p->tonemap };
    for (size_t i = 0; i < HOST_COUNT(rest); i++)
        vkDestroyPipeline(vk, rest[i], NULL);
    for (int kind = 0; kind < HOST_FORWARD_COUNT; kind++)
        vkDestroyPipelineLayout(vk, p->layouts[kind], NULL);
    vkDestroyPipelineLayout(vk, p->post_pipeline_layout, NULL);
    vkDestroyDescriptorSetLayout(vk, p->frame_layout, NULL);
    vkDestroyDescriptorSetLayout(vk, p->post_layout, NULL);
    vkDestroyDescriptorSetLayout(vk, p->light_layout, NULL);
}
