/* SPDX-License-Identifier: MIT
 * Materials: what the shaders read, and what the library is told.
 *
 * The library bounces light diffusely, and what metal and gloss reflect is not lost to the room. A map tells
 * where a material is metal, and how rough. It is not read here: all of such a material then bounces its base
 * colour. A blended material blocks and bounces light where its alpha is at least one half, and one whose
 * factor is below that does nothing to light at all. */
#include "host_albedo.h"
#include "host_internal.h"
#include "host_texture.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool has_image(const struct gltf_scene *gltf, const struct gltf_texture_ref *ref)
{
    return ref->texture >= 0 && gltf->textures[ref->texture].image >= 0;
}

/* The importer appends a material for primitives that name none: the last, nameless, all of glTF's defaults.
 */
static bool is_default(const struct gltf_scene *gltf, uint32_t index)
{
    const struct gltf_material *m = &gltf->materials[index];
    const bool white = m->base_color[0] == 1.0f && m->base_color[1] == 1.0f && m->base_color[2] == 1.0f;
    const bool dark = m->emissive[0] == 0.0f && m->emissive[1] == 0.0f && m->emissive[2] == 0.0f;
    return index + 1 == gltf->material_count && (!m->name || !m->name[0]) && white && dark &&
           m->metallic == 1.0f && m->roughness == 1.0f && m->alpha_mode == GLTF_ALPHA_OPAQUE &&
           !has_image(gltf, &m->base_color_texture) && !has_image(gltf, &m->metallic_roughness_texture);
}

/* An albedo means diffuse reflection, so the default material is no metal. */
static void default_fill(const struct host_view *view, struct gltf_material *m)
{
    memcpy(m->base_color, view->default_albedo, sizeof(view->default_albedo));
    m->metallic = 0.0f;
}

static uint32_t material_flags(const struct gltf_scene *gltf, const struct gltf_material *m, bool lambert)
{
    uint32_t flags = lambert ? HOST_MATERIAL_LAMBERT : 0;
    flags |= m->alpha_mode == GLTF_ALPHA_MASK ? HOST_MATERIAL_MASK : 0;
    flags |= m->alpha_mode == GLTF_ALPHA_BLEND ? HOST_MATERIAL_BLEND : 0;
    flags |= m->unlit ? HOST_MATERIAL_UNLIT : 0;
    flags |= has_image(gltf, &m->base_color_texture) ? HOST_MATERIAL_BASE_MAP : 0;
    flags |= has_image(gltf, &m->metallic_roughness_texture) ? HOST_MATERIAL_SURFACE_MAP : 0;
    flags |= has_image(gltf, &m->normal_texture) ? HOST_MATERIAL_NORMAL_MAP : 0;
    flags |= has_image(gltf, &m->emissive_texture) ? HOST_MATERIAL_EMISSIVE_MAP : 0;
    return flags;
}

static void uv_fill(const struct gltf_texture_ref *ref, float (*rows)[4])
{
    for (int i = 0; i < 2; i++) {
        memcpy(rows[i], &ref->uv_transform[3 * i], 3 * sizeof(float));
        rows[i][3] = 0.0f;
    }
    rows[0][3] = ref->uv_set == 1 ? 1.0f : 0.0f;
}

static void data_fill(const struct gltf_material *m, uint32_t flags, float emissive_scale,
                      struct host_material_data *out)
{
    *out = (struct host_material_data){
        .surface = { m->metallic, m->roughness, m->normal_scale, m->alpha_cutoff }, .flags = { flags }
    };
    memcpy(out->base_color, m->base_color, sizeof(m->base_color));
    for (int i = 0; i < 3; i++)
        out->emissive[i] = m->emissive[i] * emissive_scale;
    out->emissive[3] = m->double_sided ? 1.0f : 0.0f;
    uv_fill(&m->base_color_texture, out->uv + 0);
    uv_fill(&m->metallic_roughness_texture, out->uv + 2);
    uv_fill(&m->normal_texture, out->uv + 4);
    uv_fill(&m->emissive_texture, out->uv + 6);
}

static struct sdfgi_texture gi_texture(const VkDescriptorImageInfo *info, const struct gltf_scene *gltf,
                                       const struct gltf_texture_ref *ref)
{
    const struct gltf_texture *from = &gltf->textures[ref->texture];
    struct sdfgi_texture texture = { .view = info->imageView,
                                     .layout = info->imageLayout,
                                     .address_u = host_address_mode(from->wrap_u),
                                     .address_v = host_address_mode(from->wrap_v) };
    memcpy(texture.uv_transform, ref->uv_transform, sizeof(texture.uv_transform));
    return texture;
}

static void gi_albedo_fill(const struct gltf_material *m, uint32_t flags, struct sdfgi_material_desc *out)
{
    if (m->unlit)
        return;
    for (int i = 0; i < 3; i++)
        out->albedo[i] = fminf(fmaxf(m->base_color[i], 0), 1);
    if (flags & (HOST_MATERIAL_LAMBERT | HOST_MATERIAL_SURFACE_MAP))
        return;
    const struct host_albedo albedo = host_albedo_of(out->albedo, m->metallic, m->roughness);
    memcpy(out->albedo, albedo.color, sizeof out->albedo);
    out->specular_albedo = albedo.specular;
    out->metallic = m->metallic;
}

static void gi_fill(const struct gltf_scene *gltf, const struct gltf_material *m,
                    const struct host_material_data *data,
                    const VkDescriptorImageInfo images[HOST_TEXTURE_COUNT], struct host_material *out)
{
    gi_albedo_fill(m, out->flags, &out->gi);
    memcpy(out->gi.emission, data->emissive, sizeof out->gi.emission);
    /* To the library an alpha of 0 means 1, and there is no cutoff beyond 1. */
    out->gi.alpha = m->alpha_cutoff > 1.0f ? FLT_MIN : fminf(fmaxf(m->base_color[3], FLT_MIN), 1.0f);
    out->gi.double_sided_emission = m->double_sided;
    if (!(out->flags & HOST_MATERIAL_LAMBERT))
        out->gi.smoothness = out->flags & HOST_MATERIAL_SURFACE_MAP ? 1.0f : 1.0f - m->roughness;
    if (out->shadow_test)
        out->gi.alpha_cutoff = m->alpha_mode == GLTF_ALPHA_BLEND ? 0.5f : fminf(m->alpha_cutoff, 1.0f);
    if (out->flags & HOST_MATERIAL_BASE_MAP)
        out->gi.albedo_texture = gi_texture(&images[0], gltf, &m->base_color_texture);
    if (out->flags & HOST_MATERIAL_EMISSIVE_MAP)
        out->gi.emission_texture = gi_texture(&images[3], gltf, &m->emissive_texture);
    /* The library reads one UV set per mesh; a second set for emission alone is honoured when it is the only
     * one. */
    const bool base = out->flags & HOST_MATERIAL_BASE_MAP;
    out->gi_uv_set = base ? m->base_color_texture.uv_set : m->emissive_texture.uv_set;
}

static bool layout_create(struct host_scene *scene)
{
    VkDescriptorSetLayoutBinding bindings[1 + HOST_TEXTURE_COUNT] = {
        { .binding = 0,
          .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
          .descriptorCount = 1,
          .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT },
    };
    for (uint32_t i = 1; i <= HOST_TEXTURE_COUNT; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){ .binding = i,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            .descriptorCount = 1,
                                            .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT };
    const VkDescriptorSetLayoutCreateInfo info = { .sType =
                                                       VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                   .bindingCount = HOST_COUNT(bindings),
                                                   .pBindings = bindings };
    return host_check(
        scene->device,
        vkCreateDescriptorSetLayout(scene->device->device, &info, NULL, &scene->material_layout),
        "creating the material layout");
}

static bool pool_create(struct host_scene *scene)
{
    const uint32_t count = scene->material_count > 0 ? scene->material_count : 1;
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count },
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count * HOST_TEXTURE_COUNT },
    };
    const VkDescriptorPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                              .maxSets = count,
                                              .poolSizeCount = HOST_COUNT(sizes),
                                              .pPoolSizes = sizes };
    return host_check(scene->device,
                      vkCreateDescriptorPool(scene->device->device, &info, NULL, &scene->material_pool),
                      "creating the material pool");
}

static bool set_create(struct host_scene *scene, VkDeviceSize offset,
                       const VkDescriptorImageInfo images[HOST_TEXTURE_COUNT], VkDescriptorSet *out)
{
    const VkDescriptorSetAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = scene->material_pool,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &scene->material_layout };
    if (!host_check(scene->device, vkAllocateDescriptorSets(scene->device->device, &info, out),
                    "allocating a material's set"))
        return false;
    const VkDescriptorBufferInfo buffer = { scene->material_data.buffer, offset,
                                            sizeof(struct host_material_data) };
    const VkWriteDescriptorSet writes[] = {
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = *out,
          .dstBinding = 0,
          .descriptorCount = 1,
          .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
          .pBufferInfo = &buffer },
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = *out,
          .dstBinding = 1,
          .descriptorCount = HOST_TEXTURE_COUNT,
          .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
          .pImageInfo = images },
    };
    vkUpdateDescriptorSets(scene->device->device, HOST_COUNT(writes), writes, 0, NULL);
    return true;
}

static bool material_init(struct host_scene *scene, const struct gltf_scene *gltf,
                          const struct host_view *view, uint32_t index, VkDeviceSize stride)
{
    struct gltf_material m = gltf->materials[index];
    struct host_material *out = &scene->materials[index];
    struct host_material_data data;
    VkDescriptorImageInfo images[HOST_TEXTURE_COUNT];
    if (is_default(gltf, index))
        default_fill(view, &m);
    const bool blend = m.alpha_mode == GLTF_ALPHA_BLEND;
    out->flags = material_flags(gltf, &m, view->materials == HOST_MATERIALS_LAMBERT);
    out->double_sided = m.double_sided;
    out->casts_shadow = !blend || m.base_color[3] >= 0.5f;
    out->shadow_test = out->casts_shadow && (blend || m.alpha_mode == GLTF_ALPHA_MASK);
    data_fill(&m, out->flags, view->emissive_scale, &data);
    struct host_textures *textures = &scene->textures;
    if (!host_textures_get(scene->device, textures, gltf, &m.base_color_texture, true, &images[0]) ||
        !host_textures_get(scene->device, textures, gltf, &m.metallic_roughness_texture, false, &images[1]) ||
        !host_textures_get(scene->device, textures, gltf, &m.normal_texture, false, &images[2]) ||
        !host_textures_get(scene->device, textures, gltf, &m.emissive_texture, true, &images[3]))
        return false;
    gi_fill(gltf, &m, &data, images, out);
    return host_buffer_upload(scene->device, &scene->material_data, index * stride, &data, sizeof(data)) &&
           set_create(scene, index * stride, images, &out->set);
}

bool host_materials_init(struct host_scene *scene, const struct gltf_scene *gltf,
                         const struct host_view *view)
{
    struct host_device *device = scene->device;
    const VkDeviceSize align = device->limits.minUniformBufferOffsetAlignment;
    const VkDeviceSize stride = (sizeof(struct host_material_data) + align - 1) / align * align;
    scene->material_count = gltf->material_count;
    scene->materials = host_device_alloc(device, gltf->material_count, sizeof(*scene->materials));
    if (!scene->materials || !host_textures_init(device, &scene->textures, gltf) || !layout_create(scene) ||
        !pool_create(scene) ||
        !host_buffer_create(device, stride * gltf->material_count,
                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, false,
                            &scene->material_data))
        return false;
    for (uint32_t i = 0; i < gltf->material_count; i++) {
        if (!material_init(scene, gltf, view, i, stride))
            return false;
    }
    return true;
}

void host_materials_finish(struct host_scene *scene)
{
    VkDevice device = scene->device->device;
    vkDestroyDescriptorPool(device, scene->material_pool, NULL);
    vkDestroyDescriptorSetLayout(device, scene->material_layout, NULL);
    host_buffer_destroy(scene->device, &scene->material_data);
    host_textures_finish(scene->device, &scene->textures);
    free(scene->materials);
}
