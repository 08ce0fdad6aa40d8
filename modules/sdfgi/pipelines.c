/* SPDX-License-Identifier: MIT
 * Layouts and pipelines, derived from the pass and resource tables. */
#include "internal.h"

#include "voxelize.comp.h"
#include "voxelize_raster.vert.h"
#include "voxelize_raster.frag.h"
#include "voxelize_raster_textured.frag.h"
#include "voxelize_textured.comp.h"
#include "region_clear.comp.h"
#include "voxel_resolve.comp.h"
#include "distance_prepare.comp.h"
#include "distance_plane.comp.h"
#include "distance_exact.comp.h"
#include "flood_seed.comp.h"
#include "flood_step.comp.h"
#include "flood_distance.comp.h"
#include "probe_place.comp.h"
#include "probe_seed.comp.h"
#include "occlusion_trace.comp.h"
#include "light_mark.comp.h"
#include "light_list.comp.h"
#include "cell_mask.comp.h"
#include "light_direct.comp.h"
#include "light_bounce.comp.h"
#include "probe_sum.comp.h"
#include "probe_trace.comp.h"
#include "ray_invalidate.comp.h"
#include "ray_list.comp.h"
#include "probe_blend.comp.h"
#include "gather.comp.h"

/* The raster voxeliser's pipelines need a render pass: resources.c makes them where it is chosen. */
#define voxelize_raster_comp voxelize_comp

static const struct {
    struct gpu_shader shader;
    const char *name, *unit;
    uint64_t reads, writes;
} passes[PASS_COUNT] = {
#define R(id) RESOURCE_BIT(id)
#define ROW(id, file, unit_, reads_, writes_, need)                                                          \
    [PASS_##id] = { { file##_comp, sizeof file##_comp }, #file, unit_, (reads_) | R(FRAME), (writes_) },
    SDFGI_PASSES(ROW)
#undef ROW
#undef R
};

uint64_t pass_reads(enum pass pass)
{
    return passes[pass].reads;
}

uint64_t pass_writes(enum pass pass)
{
    return passes[pass].writes;
}

const char *pass_name(enum pass pass)
{
    return passes[pass].name;
}

const char *pass_unit(enum pass pass)
{
    return passes[pass].unit;
}

struct gpu_shader shader_voxelize_raster_vert(void)
{
    return (struct gpu_shader){ voxelize_raster_vert, sizeof voxelize_raster_vert };
}

struct gpu_shader shader_voxelize_raster_frag(bool textured)
{
    return textured
               ? (struct gpu_shader){ voxelize_raster_textured_frag, sizeof voxelize_raster_textured_frag }
               : (struct gpu_shader){ voxelize_raster_frag, sizeof voxelize_raster_frag };
}

static VkResult set_layout(const struct gpu_device *device, const VkDescriptorSetLayoutBinding *bindings,
                           uint32_t count, VkDescriptorSetLayout *layout)
{
    return device->fn.CreateDescriptorSetLayout(
        device->handle,
        &(VkDescriptorSetLayoutCreateInfo){
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
            .bindingCount = count,
            .pBindings = bindings,
        },
        device->callbacks, layout);
}

static VkDescriptorSetLayoutBinding binding(uint32_t index, VkDescriptorType type, const VkSampler *sampler)
{
    return (VkDescriptorSetLayoutBinding){ index, type, 1, VK_SHADER_STAGE_ALL, sampler };
}

static VkResult main_set_layout(struct sdfgi *gi)
{
    struct pipelines *p = &gi->pipelines;
    VkDescriptorSetLayoutBinding bindings[RESOURCE_COUNT];
    for (uint32_t i = 0; i < RESOURCE_COUNT; i++)
        bindings[i] = binding(i, resource_descriptor((enum resource)i), NULL);
    return set_layout(&gi->device, bindings, RESOURCE_COUNT, &p->set_layout);
}

static VkResult other_set_layouts(struct sdfgi *gi)
{
    struct pipelines *p = &gi->pipelines;
    VkDescriptorSetLayoutBinding mesh[4];
    for (uint32_t i = 0; i < 4; i++)
        mesh[i] = binding(i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, NULL);
    const VkDescriptorSetLayoutBinding material[2] = {
        binding(SDFGI_BINDING_MATERIAL_ALBEDO, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, NULL),
        binding(SDFGI_BINDING_MATERIAL_EMISSION, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, NULL),
    };
    const VkDescriptorSetLayoutBinding gather[3] = {
        binding(SDFGI_BINDING_GATHER_DEPTH, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, &p->nearest),
        binding(SDFGI_BINDING_GATHER_NORMAL, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, &p->nearest),
        binding(SDFGI_BINDING_GATHER_OUTPUT, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, NULL),
    };
    VkResult result = set_layout(&gi->device, mesh, 4, &p->mesh_layout);
    if (result == VK_SUCCESS)
        result = set_layout(&gi->device, material, 2, &p->material_layout);
    if (result == VK_SUCCESS)
        result = set_layout(&gi->device, gather, 3, &p->gather_layout);
    return result;
}

static VkResult pipeline_layout(const struct gpu_device *device, const VkDescriptorSetLayout *sets,
                                uint32_t count, uint32_t push_size, VkPipelineLayout *layout)
{
    const VkPushConstantRange range = { VK_SHADER_STAGE_ALL, 0, push_size };
    return device->fn.CreatePipelineLayout(device->handle,
                                           &(VkPipelineLayoutCreateInfo){
                                               .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = count,
                                               .pSetLayouts = sets,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range,
                                           },
                                           device->callbacks, layout);
}

static VkResult pipeline_layouts(struct sdfgi *gi)
{
    struct pipelines *p = &gi->pipelines;
    const VkDescriptorSetLayout voxelize[3] = { p->set_layout, p->mesh_layout, p->material_layout };
    const VkDescriptorSetLayout gather[2] = { p->set_layout, p->gather_layout };
    VkResult result =
        pipeline_layout(&gi->device, &p->set_layout, 1, sizeof(struct sdfgi_distance_prepare_args), &p->layout);
    if (result == VK_SUCCESS)
        result = pipeline_layout(&gi->device, voxelize, 3, sizeof(struct sdfgi_voxelize_args),
                                 &p->voxelize_layout);
    if (result == VK_SUCCESS)
        result = pipeline_layout(&gi->device, gather, 2, sizeof(struct sdfgi_gather_args),
                                 &p->gather_layout_pipeline);
    return result;
}

static VkPipelineLayout layout_of(const struct pipelines *p, enum pass pass)
{
    return pass == PASS_VOXELIZE ? p->voxelize_layout
           : pass == PASS_GATHER ? p->gather_layout_pipeline
                                 : p->layout;
}

static VkResult make_pass(struct sdfgi *gi, enum pass pass)
{
    struct pipelines *p = &gi->pipelines;
    return gpu_compute_pipeline_create(&gi->device, passes[pass].shader, layout_of(p, pass),
                                       passes[pass].name, &p->passes[pass]);
}

VkResult pipelines_make_gather(struct sdfgi *gi)
{
    return gi->pipelines.passes[PASS_GATHER] ? VK_SUCCESS : make_pass(gi, PASS_GATHER);
}

VkResult pipelines_make_textured(struct sdfgi *gi)
{
    struct pipelines *p = &gi->pipelines;
    const struct gpu_shader shader = { voxelize_textured_comp, sizeof voxelize_textured_comp };
    return p->voxelize_textured ? VK_SUCCESS
                                : gpu_compute_pipeline_create(&gi->device, shader, p->voxelize_layout,
                                                              "voxelize textured", &p->voxelize_textured);
}

static VkResult compute_pipelines(struct sdfgi *gi)
{
    VkResult result = VK_SUCCESS;
    for (int i = 0; i < PASS_COUNT && result == VK_SUCCESS; i++)
        if (i != PASS_VOXELIZE_RASTER && i != PASS_GATHER)
            result = make_pass(gi, (enum pass)i);
    return result;
}

static VkResult sampler(const struct gpu_device *device, VkFilter filter, VkSampler *out)
{
    return device->fn.CreateSampler(device->handle,
                                    &(VkSamplerCreateInfo){
                                        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                        .magFilter = filter,
                                        .minFilter = filter,
                                        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                    },
                                    device->callbacks, out);
}

VkResult pipelines_init(struct sdfgi *gi)
{
    VkResult result = sampler(&gi->device, VK_FILTER_NEAREST, &gi->pipelines.nearest);
    if (result == VK_SUCCESS)
        result = main_set_layout(gi);
    if (result == VK_SUCCESS)
        result = other_set_layouts(gi);
    if (result == VK_SUCCESS)
        result = pipeline_layouts(gi);
    if (result == VK_SUCCESS)
        result = compute_pipelines(gi);
    return result;
}

void pipelines_finish(struct sdfgi *gi)
{
    const struct gpu_device *d = &gi->device;
    struct pipelines *p = &gi->pipelines;
    for (int i = 0; i < PASS_COUNT; i++)
        d->fn.DestroyPipeline(d->handle, p->passes[i], d->callbacks);
    d->fn.DestroyPipeline(d->handle, p->voxelize_textured, d->callbacks);
    d->fn.DestroyPipelineLayout(d->handle, p->layout, d->callbacks);
    d->fn.DestroyPipelineLayout(d->handle, p->voxelize_layout, d->callbacks);
    d->fn.DestroyPipelineLayout(d->handle, p->gather_layout_pipeline, d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->set_layout, d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->mesh_layout, d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->material_layout, d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->gather_layout, d->callbacks);
    d->fn.DestroySampler(d->handle, p->nearest, d->callbacks);
}
