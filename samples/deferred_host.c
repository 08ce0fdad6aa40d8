/* SPDX-License-Identifier: MIT
 * Teaches: how a deferred renderer gets global illumination. It draws depths, normals and materials, and a
 * compute pass lights them. libsdfgi makes pictures of light in between: no shader of the renderer includes
 * anything. There are two ways. A view has indirect light and reflections; `--gather` shows the other, one
 * call and no reflections. What libsdfgi asks for stands between the lines `GI begins` and `GI ends`,
 * here and in deferred_shade.comp, what one way alone needs between `GI with ...`, and a test counts them. */
/* GI begins */
#include <sdfgi/sdfgi.h>
/* GI ends */
#include "sample_options.h"
#include "sample_scene.h"
#include "sample_window.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deferred_gbuffer_spirv.h"
#include "deferred_shade_spirv.h"
#include "sample_mesh_spirv.h"

enum { BINDINGS = 6, GROUP = 8 };

struct renderer {
    struct sample_gpu *gpu;
    struct sample_scene scene;
    struct sample_drawing drawing;
    struct sample_image colors[4], depth;  /* base colour and metal, normal, roughness, radiance */
    struct sample_image black, irradiance; /* where there is no light, and what is gathered */
    struct sample_pass pass;
    struct sample_set set, light[SAMPLE_FRAMES]; /* those of a frame change while another is in flight */
    struct sample_pipeline gbuffer, shade;
};

/* In each frame, because GI may be switched: black stands for what is not there of the two pictures. */
static void show_light(const struct renderer *r, bool lit, VkImageView irradiance, VkImageView reflection)
{
    const VkImageView views[] = { irradiance, reflection };
    for (uint32_t i = 0; i < 2; i++) {
        const struct sample_binding picture = { .type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                .view = lit && views[i] ? views[i] : r->black.view,
                                                .layout = VK_IMAGE_LAYOUT_GENERAL };
        sample_set_replace(r->gpu, &r->light[r->gpu->frame % SAMPLE_FRAMES], i, &picture);
    }
}

/* GI begins */
static void print_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    fprintf((FILE *)user, "sdfgi: level %d, message %d: %s\n", (int)level, (int)id, text);
}

/* Before the device exists: what it must have. A renderer adds features of its own. */
static VkPhysicalDeviceFeatures ask_for_features(const struct sample_gpu *gpu)
{
    struct sdfgi_requirements needs;
    SAMPLE_CHECK(sdfgi_get_requirements(gpu->instance, gpu->physical_device, vkGetInstanceProcAddr, &needs));
    sample_require(needs.supported, needs.reasons[0]);
    return needs.features;
}

static sdfgi *make_gi(const struct sample_gpu *gpu, const struct sample_options *options,
                      struct sdfgi_settings *settings)
{
    sdfgi_settings_default(settings);
    for (uint32_t i = 0; i < options->setting_count; i++)
        sample_require(sdfgi_settings_set(settings, options->names[i], options->values[i], NULL, 0),
                       options->names[i]);
    struct sdfgi_desc desc = { .settings = settings, .log = { print_message, stderr } };
    desc.frames_in_flight = SAMPLE_FRAMES;
    desc.vulkan = (struct sdfgi_vulkan){ gpu->instance,     gpu->physical_device,  gpu->device,
                                         gpu->queue_family, vkGetInstanceProcAddr, NULL,
                                         VK_API_VERSION_1_2 };
    sdfgi *gi;
    SAMPLE_CHECK(sdfgi_create(&desc, &gi));
    return gi;
}

static void add_lights(sdfgi *gi, const struct sample_view *v)
{
    const float *at = v->lamp_position, *to = v->lamp_direction, *power = v->lamp_intensity, *s = v->sky;
    struct sdfgi_light_desc lamp = { .type = SDFGI_LIGHT_SPOT, .casts_shadow = true };
    for (int i = 0; i < 3; i++)
        lamp.position[i] = at[i], lamp.direction[i] = to[i], lamp.intensity[i] = power[i];
    lamp.inner_angle_rad = acosf(at[3]), lamp.outer_angle_rad = acosf(to[3]);
    const struct sdfgi_sky sky = { { s[0], s[1], s[2] }, { s[0], s[1], s[2] }, { s[0], s[1], s[2] } };
    SAMPLE_CHECK(sdfgi_light_create(gi, &lamp, &(sdfgi_light){ 0 }));
    SAMPLE_CHECK(sdfgi_set_sky(gi, &sky));
}

static void add_object(sdfgi *gi, const struct renderer *r, const struct sample_object *object)
{
    const struct sample_mesh *own = &r->scene.meshes[object->mesh];
    const struct sample_material *matter = &r->scene.materials[object->material];
    struct sdfgi_mesh_desc mesh = { .position_buffer = r->drawing.vertices.buffer,
                                    .position_offset = own->first_vertex * sizeof(struct sample_vertex) +
                                                       offsetof(struct sample_vertex, position),
                                    .position_stride = sizeof(struct sample_vertex),
                                    .index_buffer = r->drawing.indices.buffer,
                                    .index_offset = own->first_index * sizeof(uint16_t) };
    struct sdfgi_material_desc material = { .smoothness = 1 - matter->glow[3] };
    struct sdfgi_instance_desc placed = { 0 };
    mesh.vertex_count = own->vertex_count, mesh.triangle_count = own->index_count / 3;
    for (int i = 0; i < 3; i++) {
        mesh.bounds_min[i] = own->low[i], mesh.bounds_max[i] = own->high[i];
        material.albedo[i] = matter->base_color[i]; /* of metal, too: it sends light back */
        material.emission[i] = matter->glow[i];
        memcpy(placed.transform.basis + 3 * i, object->matrix + 4 * i, 3 * sizeof(float));
        placed.transform.translation[i] = object->matrix[12 + i];
    }
    SAMPLE_CHECK(sdfgi_mesh_create(gi, &mesh, &placed.mesh));
    SAMPLE_CHECK(sdfgi_material_create(gi, &material, &placed.material));
    SAMPLE_CHECK(sdfgi_instance_create(gi, &placed, &(sdfgi_instance){ 0 }));
}

/* GI with views begins */
/* Between G-buffer and lighting. Each resolve tells which pictures light is in. */
static void resolve(sdfgi *gi, sdfgi_view *view, VkCommandBuffer cmd, const struct renderer *r)
{
    struct sdfgi_resolve_desc desc = { r->depth.view, r->colors[1].view, r->colors[2].view,
                                       .background_depth = 1 };
    struct sdfgi_view_images images;
    memcpy(desc.inverse_view_projection, r->scene.view.world_from_clip, sizeof desc.inverse_view_projection);
    SAMPLE_CHECK(sdfgi_view_resolve(gi, view, cmd, &desc));
    sdfgi_view_get_images(view, &images);
    show_light(r, sdfgi_is_active(gi), images.diffuse, images.reflection);
}
/* GI with views ends */
/* GI with gather begins */
/* Between G-buffer and lighting, into a picture of the renderer's. While GI is off it is left as it is. */
static void gather(sdfgi *gi, VkCommandBuffer cmd, const struct renderer *r)
{
    const struct sample_image *out = &r->irradiance;
    struct sdfgi_gather_desc desc = { r->depth.view, r->colors[1].view, out->view, .background_depth = 1 };
    desc.width = out->width, desc.height = out->height;
    memcpy(desc.inverse_view_projection, r->scene.view.world_from_clip, sizeof desc.inverse_view_projection);
    SAMPLE_CHECK(sdfgi_gather(gi, cmd, &desc));
    show_light(r, sdfgi_is_active(gi), out->view, VK_NULL_HANDLE);
}
/* GI with gather ends */
/* GI ends */

static void make_images(struct renderer *r, struct sample_gpu *gpu, uint32_t width, uint32_t height)
{
    const VkFormat formats[] = { VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
                                 VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT };
    for (int i = 0; i < 4; i++)
        r->colors[i] = sample_image_make(gpu, width, height, formats[i],
                                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                             (i == 3 ? VK_IMAGE_USAGE_STORAGE_BIT : 0) |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    r->depth = sample_image_make(gpu, width, height, VK_FORMAT_D32_SFLOAT,
                                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    r->black = sample_image_make(gpu, width, height, VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    /* GI begins */
    /* GI with gather begins */
    r->irradiance = sample_image_make(gpu, width, height, VK_FORMAT_R16G16B16A16_SFLOAT,
                                      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    /* GI with gather ends */
    /* GI ends */
}

static struct sample_binding sampled(const struct sample_image *image, VkImageLayout layout)
{
    return (struct sample_binding){ .type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                    .view = image->view,
                                    .layout = layout };
}

static void make_sets(struct renderer *r, struct sample_gpu *gpu)
{
    const VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const struct sample_binding bindings[BINDINGS] = {
        { .type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, .buffer = r->drawing.view.buffer },
        sampled(&r->drawing.shadow, read),
        sampled(&r->colors[0], read),
        sampled(&r->colors[1], read),
        sampled(&r->depth, read),
        { .type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
          .view = r->colors[3].view,
          .layout = VK_IMAGE_LAYOUT_GENERAL },
    };
    const struct sample_binding black = sampled(&r->black, VK_IMAGE_LAYOUT_GENERAL);
    r->set = sample_set_make(gpu, bindings, BINDINGS);
    for (int i = 0; i < SAMPLE_FRAMES; i++)
        r->light[i] = sample_set_make(gpu, (const struct sample_binding[]){ black, black }, 2);
}

static void make_renderer(struct renderer *r, struct sample_gpu *gpu, const struct sample_options *options)
{
    r->gpu = gpu;
    sample_scene_make(&r->scene, (float)options->width / (float)options->height);
    VkBufferUsageFlags usage = 0;
    /* GI begins */
    usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    /* GI ends */
    r->drawing = sample_drawing_make(gpu, &r->scene, usage);
    make_images(r, gpu, options->width, options->height);
    r->pass = sample_pass_make(gpu, r->colors, 4, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, &r->depth);
    memcpy(r->pass.clear[3].color.float32, r->scene.view.sky, sizeof r->scene.view.sky);
    make_sets(r, gpu);
    const VkDescriptorSetLayout layouts[] = { r->set.layout, r->light[0].layout };
    r->gbuffer.layout = sample_layout_make(gpu, layouts, 1);
    r->shade.layout = sample_layout_make(gpu, layouts, 2);
    const struct sample_code vertex = SAMPLE_CODE(sample_mesh_vert),
                             fragment = SAMPLE_CODE(deferred_gbuffer_frag),
                             shade = SAMPLE_CODE(deferred_shade_comp);
    r->gbuffer.pipeline = sample_mesh_pipeline_make(gpu, &r->pass, r->gbuffer.layout, vertex, fragment);
    r->shade.pipeline = sample_compute_pipeline_make(gpu, r->shade.layout, shade);
}

static void draw_gbuffer(const struct renderer *r, VkCommandBuffer cmd)
{
    sample_drawing_draw_shadow(&r->drawing, &r->scene, cmd);
    sample_pass_begin(cmd, &r->pass);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->gbuffer.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->gbuffer.layout, 0, 1, &r->set.set, 0,
                            NULL);
    sample_drawing_draw(&r->drawing, &r->scene, r->gbuffer.layout, cmd);
    vkCmdEndRenderPass(cmd);
}

static void shade(const struct renderer *r, VkCommandBuffer cmd)
{
    const struct sample_image *radiance = &r->colors[3];
    const VkDescriptorSet sets[] = { r->set.set, r->light[r->gpu->frame % SAMPLE_FRAMES].set };
    sample_image_barrier(cmd, radiance, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, r->shade.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, r->shade.layout, 0, 2, sets, 0, NULL);
    vkCmdDispatch(cmd, (radiance->width + GROUP - 1) / GROUP, (radiance->height + GROUP - 1) / GROUP, 1);
    sample_image_barrier(cmd, radiance, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

/* In the layouts that pictures of light keep. */
static void begin_light(const struct renderer *r, VkCommandBuffer cmd)
{
    const VkClearColorValue black = { .float32 = { 0 } };
    const VkImageSubresourceRange all = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
    const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
    sample_image_barrier(cmd, &r->black, VK_IMAGE_LAYOUT_UNDEFINED, general);
    vkCmdClearColorImage(cmd, r->black.image, general, &black, 1, &all);
    sample_image_barrier(cmd, &r->black, general, general);
    sample_image_barrier(cmd, &r->irradiance, VK_IMAGE_LAYOUT_UNDEFINED, general);
}

int main(int argc, char **argv)
{
    struct sample_options options;
    struct sample_gpu gpu;
    struct renderer r;
    uint32_t count;
    sample_options_read(&options, argc, argv);
    struct sample_window *window = sample_window_open(options.window, options.width, options.height);
    const char *const *extensions = sample_window_instance_extensions(window, &count);
    sample_gpu_find(&gpu, VK_API_VERSION_1_2, extensions, count);
    VkPhysicalDeviceFeatures features = { 0 };
    /* GI begins */
    features = ask_for_features(&gpu);
    /* GI ends */
    extensions = sample_window_device_extensions(window, &count);
    sample_gpu_open(&gpu, &features, extensions, count);
    make_renderer(&r, &gpu, &options);
    /* GI begins */
    struct sdfgi_settings settings;
    sdfgi *gi = make_gi(&gpu, &options, &settings);
    for (int i = 0; i < SAMPLE_OBJECTS; i++)
        add_object(gi, &r, &r.scene.objects[i]);
    add_lights(gi, &r.scene.view);
    /* GI with views begins */
    const struct sdfgi_view_desc picture = { .width = options.width, .height = options.height };
    sdfgi_view *view;
    SAMPLE_CHECK(sdfgi_view_create(gi, &picture, &view));
    /* GI with views ends */
    /* GI ends */
    bool settled = false;
    while (sample_options_go_on(&options, gpu.frame, settled) && sample_window_acquire(window, &gpu)) {
        const VkCommandBuffer cmd = sample_frame_begin(&gpu);
        if (gpu.frame == 0)
            begin_light(&r, cmd);
        draw_gbuffer(&r, cmd);
        /* GI begins */
        const float *eye = r.scene.view.eye;
        const struct sdfgi_frame_desc frame = { .camera_position = { eye[0], eye[1], eye[2] } };
        struct sdfgi_report report;
        settings.enabled = sample_options_gi(&options, gpu.frame);
        SAMPLE_CHECK(sdfgi_set_settings(gi, &settings));
        SAMPLE_CHECK(sdfgi_update(gi, cmd, &frame));
        /* GI with views begins */
        if (!options.gather)
            resolve(gi, view, cmd, &r);
        /* GI with views ends */
        /* GI with gather begins */
        if (options.gather)
            gather(gi, cmd, &r);
        /* GI with gather ends */
        sdfgi_get_report(gi, &report);
        settled = !report.active || report.converged;
        /* GI ends */
        shade(&r, cmd);
        sample_window_show(window, &gpu, &r.colors[3]);
    }
    SAMPLE_CHECK(vkDeviceWaitIdle(gpu.device));
    printf("%s after %llu frames\n", settled ? "settled" : "stopped", (unsigned long long)gpu.frame);
    if (options.out)
        sample_picture_write(&gpu, &r.colors[3], options.out);
    /* GI begins */
    sdfgi_destroy(gi);
    /* GI ends */
    sample_window_close(window, &gpu);
    sample_gpu_close(&gpu);
    return 0;
}
