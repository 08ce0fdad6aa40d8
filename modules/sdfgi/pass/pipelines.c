/* SPDX-License-Identifier: MIT
 * Layouts and pipelines, derived from the pass and resource tables. */
#include "backend.h"
#include "resource_rows.h"

#include "shaders/shared/bindings.h"

#include "sdfgi_shaders.h"

/* Every pipeline layout has the same push constants, so that LOOKUP and WORK stay bound from pass to pass.
 * Vulkan promises 128 bytes. */
#define PUSH_BYTES 128

_Static_assert(sizeof(union work_args) <= PUSH_BYTES, "arguments fit the push constants");
_Static_assert(sizeof(struct sdfgi_voxelize_args) <= PUSH_BYTES, "arguments fit the push constants");

/* Of a pass: a compute shader, and the same for software drivers; or a vertex and a fragment shader, by
 * variant. */
struct pass_shaders {
    struct gpu_shader compute[PASS_VARIANTS], software[PASS_VARIANTS], vertex, fragment[PASS_VARIANTS];
};

#define SHADER(name)                                                                                         \
    {                                                                                                        \
        name, sizeof name                                                                                    \
    }
#define SHADERS_COMPUTE(file)                                                                                \
    {                                                                                                        \
        .compute = { SHADER(sdfgi_##file##_comp) }, .software = { SHADER(sdfgi_##file##_software_comp) }     \
    }
#define SHADERS_WITH(file, variant)                                                                          \
    {                                                                                                        \
        .compute = { SHADER(sdfgi_##file##_comp), SHADER(sdfgi_##file##_##variant##_comp) }, .software = {   \
            SHADER(sdfgi_##file##_software_comp),                                                            \
            SHADER(sdfgi_##file##_##variant##_software_comp)                                                 \
        }                                                                                                    \
    }
#define SHADERS_COMPUTE_TEXTURED(file) SHADERS_WITH(file, textured)
#define SHADERS_COMPUTE_LOBES(file)    SHADERS_WITH(file, lobes)
#define SHADERS_COMPUTE_METAL(file)    SHADERS_WITH(file, metal)
#define SHADERS_RASTER_TEXTURED(file)                                                                        \
    {                                                                                                        \
        .vertex = SHADER(sdfgi_##file##_vert), .fragment = {                                                 \
            SHADER(sdfgi_##file##_frag),                                                                     \
            SHADER(sdfgi_##file##_textured_frag)                                                             \
        }                                                                                                    \
    }

static const struct pass_shaders shaders[PASS_COUNT] = {
#define ROW(id, kind, shader, unit, need, phase, made, domain, args, group, set, reads, writes)              \
    [PASS_##id] = SHADERS_##kind(shader),
    SDFGI_PASSES(ROW)
#undef ROW
};

static VkResult set_layout(const struct gpu_device *device, const char *name,
                           const VkDescriptorSetLayoutBinding *bindings, uint32_t count,
                           VkDescriptorSetLayout *layout)
{
    const VkResult result = device->fn.CreateDescriptorSetLayout(
        device->handle,
        &(VkDescriptorSetLayoutCreateInfo){ .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = count,
                                            .pBindings = bindings },
        device->callbacks, layout);
    return gpu_named(device, result, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, name);
}

static VkDescriptorSetLayoutBinding binding(uint32_t index, VkDescriptorType type, const VkSampler *sampler)
{
    return (VkDescriptorSetLayoutBinding){ index, type, 1, VK_SHADER_STAGE_ALL, sampler };
}

bool sdfgi_pipelines_read_texels(const struct backend *backend, enum resource resource)
{
    return backend->software && sdfgi_resource_row(resource)->texels != VK_FORMAT_UNDEFINED;
}

static VkResult resource_set_layout(struct backend *backend, enum resource_set set)
{
    VkDescriptorSetLayoutBinding bindings[2 * RESOURCE_COUNT + 1];
    uint32_t count = 0;
    if (set == RESOURCE_SET_LOOKUP)
        bindings[count++] = binding(SDFGI_BINDING_LOW_LIGHT, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, NULL);
    for (int i = 0; i < RESOURCE_COUNT; i++) {
        const struct resource_row *row = sdfgi_resource_row((enum resource)i);
        if (row->set != set)
            continue;
        bindings[count++] = binding(row->binding, sdfgi_resource_descriptor((enum resource)i), NULL);
        if (sdfgi_pipelines_read_texels(backend, (enum resource)i))
            bindings[count++] =
                binding(SDFGI_BINDING_TEXELS + row->binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, NULL);
    }
    return set_layout(&backend->device, sdfgi_resource_set_name(set), bindings, count,
                      &backend->pipelines.sets[set]);
}

static VkResult mesh_layout(struct backend *backend)
{
    VkDescriptorSetLayoutBinding bindings[4];
    for (uint32_t i = 0; i < 4; i++)
        bindings[i] = binding(i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, NULL);
    return set_layout(&backend->device, "sdfgi mesh", bindings, 4, &backend->pipelines.mesh);
}

static VkResult material_layout(struct backend *backend)
{
    const VkDescriptorSetLayoutBinding bindings[2] = {
        binding(SDFGI_BINDING_MATERIAL_ALBEDO, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, NULL),
        binding(SDFGI_BINDING_MATERIAL_EMISSION, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, NULL),
    };
    return set_layout(&backend->device, "sdfgi material", bindings, 2, &backend->pipelines.material);
}

static VkResult view_layout(struct backend *backend)
{
    const VkSampler *nearest = &backend->pipelines.nearest;
    const VkDescriptorSetLayoutBinding bindings[] = {
        binding(SDFGI_BINDING_VIEW_DEPTH, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nearest),
        binding(SDFGI_BINDING_VIEW_NORMAL, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nearest),
        binding(SDFGI_BINDING_VIEW_ROUGHNESS, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nearest),
        binding(SDFGI_BINDING_VIEW_DIFFUSE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, NULL),
        binding(SDFGI_BINDING_VIEW_REFLECTION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, NULL),
        binding(SDFGI_BINDING_VIEW_TILES, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, NULL),
        binding(SDFGI_BINDING_VIEW_FILTERED, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, NULL),
    };
    return set_layout(&backend->device, "sdfgi view", bindings, sizeof bindings / sizeof *bindings,
                      &backend->pipelines.view);
}

/* Named by the set beside LOOKUP and WORK. */
static const char *const layout_names[PASS_SET_COUNT] = {
    [PASS_SET_NONE] = "sdfgi passes",
    [PASS_SET_MESH] = "sdfgi mesh passes",
    [PASS_SET_VIEW] = "sdfgi view passes",
};

static VkResult pipeline_layout(struct backend *backend, enum pass_set beside)
{
    struct pipelines *p = &backend->pipelines;
    const VkDescriptorSetLayout extra[PASS_SET_COUNT][2] = {
        [PASS_SET_MESH] = { p->mesh, p->material },
        [PASS_SET_VIEW] = { p->view },
    };
    const VkDescriptorSetLayout sets[4] = { p->sets[RESOURCE_SET_LOOKUP], p->sets[RESOURCE_SET_WORK],
                                            extra[beside][0], extra[beside][1] };
    const uint32_t count = 2 + (extra[beside][0] != VK_NULL_HANDLE) + (extra[beside][1] != VK_NULL_HANDLE);
    const VkPushConstantRange range = { VK_SHADER_STAGE_ALL, 0, PUSH_BYTES };
    const VkResult result = backend->device.fn.CreatePipelineLayout(
        backend->device.handle,
        &(VkPipelineLayoutCreateInfo){ .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                       .setLayoutCount = count,
                                       .pSetLayouts = sets,
                                       .pushConstantRangeCount = 1,
                                       .pPushConstantRanges = &range },
        backend->device.callbacks, &p->layouts[beside]);
    return gpu_named(&backend->device, result, VK_OBJECT_TYPE_PIPELINE_LAYOUT, &p->layouts[beside],
                     layout_names[beside]);
}

static VkResult make_layouts(struct backend *backend)
{
    VkResult result = VK_SUCCESS;
    for (int i = 0; i < RESOURCE_SET_COUNT && result == VK_SUCCESS; i++)
        result = resource_set_layout(backend, (enum resource_set)i);
    if (result == VK_SUCCESS)
        result = mesh_layout(backend);
    if (result == VK_SUCCESS)
        result = material_layout(backend);
    if (result == VK_SUCCESS)
        result = view_layout(backend);
    for (int i = 0; i < PASS_SET_COUNT && result == VK_SUCCESS; i++)
        result = pipeline_layout(backend, (enum pass_set)i);
    return result;
}

bool sdfgi_pipelines_has(struct backend *backend, enum pass pass, uint32_t variant)
{
    pthread_mutex_lock(&backend->lock);
    const bool has = backend->pipelines.passes[pass][variant] != VK_NULL_HANDLE;
    pthread_mutex_unlock(&backend->lock);
    return has;
}

/* Where another thread was faster, its pipeline stays. */
static void keep_first(struct backend *backend, enum pass pass, uint32_t variant, VkPipeline made)
{
    VkPipeline *slot = &backend->pipelines.passes[pass][variant], unused = made;
    pthread_mutex_lock(&backend->lock);
    if (!*slot) {
        *slot = made;
        unused = VK_NULL_HANDLE;
    }
    pthread_mutex_unlock(&backend->lock);
    backend->device.fn.DestroyPipeline(backend->device.handle, unused, backend->device.callbacks);
}

VkResult sdfgi_pipelines_require(struct backend *backend, enum pass pass, uint32_t variant)
{
    if (sdfgi_pipelines_has(backend, pass, variant))
        return VK_SUCCESS;
    VkPipeline made = VK_NULL_HANDLE;
    const struct gpu_shader *variants = backend->software ? shaders[pass].software : shaders[pass].compute;
    const VkResult result = gpu_compute_pipeline_create(&backend->device, variants[variant],
                                                        backend->pipelines.layouts[sdfgi_pass_row(pass)->set],
                                                        sdfgi_pass_row(pass)->object_name, &made);
    if (result == VK_SUCCESS)
        keep_first(backend, pass, variant, made);
    return result;
}

VkResult sdfgi_pipelines_require_all(struct backend *backend, const struct sdfgi_settings *settings)
{
    VkResult result = VK_SUCCESS;
    for (int i = 0; i < PASS_COUNT && result == VK_SUCCESS; i++)
        if (sdfgi_pass_row((enum pass)i)->made == PASS_MADE_CREATED &&
            sdfgi_pass_fits((enum pass)i, settings))
            result = sdfgi_pipelines_require(backend, (enum pass)i, 0);
    return result;
}

VkResult sdfgi_pipelines_raster(struct backend *backend, enum pass pass, uint32_t variant,
                                VkRenderPass render_pass, uint32_t extent, VkPipeline *pipeline)
{
    return gpu_raster_pipeline_create(&backend->device, shaders[pass].vertex, shaders[pass].fragment[variant],
                                      backend->pipelines.layouts[sdfgi_pass_row(pass)->set], render_pass,
                                      extent, sdfgi_pass_row(pass)->object_name, pipeline);
}

static VkResult make_sampler(struct backend *backend)
{
    const VkResult result = backend->device.fn.CreateSampler(
        backend->device.handle,
        &(VkSamplerCreateInfo){ .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_NEAREST,
                                .minFilter = VK_FILTER_NEAREST,
                                .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE },
        backend->device.callbacks, &backend->pipelines.nearest);
    return gpu_named(&backend->device, result, VK_OBJECT_TYPE_SAMPLER, &backend->pipelines.nearest,
                     "sdfgi nearest");
}

/* Software drivers read a texel buffer for all threads of a group at once, and a storage buffer for one after
 * another. Their limits have to leave room: for all that is bound, and for buffers of any size. */
static bool is_software(const struct gpu_device *device)
{
    return device->is_cpu && device->limits.maxPerStageDescriptorSampledImages >= 2 * RESOURCE_COUNT &&
           device->limits.maxTexelBufferElements >= device->limits.maxStorageBufferRange / sizeof(uint32_t);
}

VkResult sdfgi_pipelines_init(struct backend *backend)
{
    backend->software = is_software(&backend->device);
    VkResult result = make_sampler(backend);
    if (result == VK_SUCCESS)
        result = make_layouts(backend);
    return result;
}

void sdfgi_pipelines_finish(struct backend *backend)
{
    const struct gpu_device *d = &backend->device;
    struct pipelines *p = &backend->pipelines;
    for (int i = 0; i < PASS_COUNT; i++)
        for (int v = 0; v < PASS_VARIANTS; v++)
            d->fn.DestroyPipeline(d->handle, p->passes[i][v], d->callbacks);
    for (int i = 0; i < PASS_SET_COUNT; i++)
        d->fn.DestroyPipelineLayout(d->handle, p->layouts[i], d->callbacks);
    for (int i = 0; i < RESOURCE_SET_COUNT; i++)
        d->fn.DestroyDescriptorSetLayout(d->handle, p->sets[i], d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->mesh, d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->material, d->callbacks);
    d->fn.DestroyDescriptorSetLayout(d->handle, p->view, d->callbacks);
    d->fn.DestroySampler(d->handle, p->nearest, d->callbacks);
}
