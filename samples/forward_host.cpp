/* SPDX-License-Identifier: MIT
 * Teaches: how a forward renderer gets global illumination. It has meshes, materials, a lamp with a shadow
 * map and a camera of its own. What libsdfgi asks of it stands between the lines `GI begins` and `GI ends`,
 * here and in forward_host.frag, and a test counts them. Everything else it would have anyway. */
/* GI begins */
#include <sdfgi/sdfgi.h>
/* GI ends */
#include "sample_options.h"
#include "sample_scene.h"
#include "sample_window.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "forward_host_spirv.h"
#include "sample_mesh_spirv.h"

/* GI begins */
static void print_message(void *, sdfgi_log_level, sdfgi_message, const char *text)
{
    std::fprintf(stderr, "%s\n", text);
}

/* Before the device exists: what it must have. A renderer adds features of its own. */
static VkPhysicalDeviceFeatures ask_for_features(const sample_gpu &gpu)
{
    sdfgi_requirements needs;
    SAMPLE_CHECK(sdfgi_get_requirements(gpu.instance, gpu.physical_device, vkGetInstanceProcAddr, &needs));
    sample_require(needs.supported, needs.reasons[0]);
    return needs.features;
}

static sdfgi *make_gi(const sample_gpu &gpu, const sample_options &options, sdfgi_settings &settings)
{
    sdfgi_settings_default(&settings);
    for (uint32_t i = 0; i < options.setting_count; i++)
        sample_require(sdfgi_settings_set(&settings, options.names[i], options.values[i], nullptr, 0),
                       options.names[i]);
    sdfgi_desc desc = {};
    desc.vulkan = { gpu.instance, gpu.physical_device, gpu.device, gpu.queue_family, vkGetInstanceProcAddr,
                    nullptr,      VK_API_VERSION_1_2 };
    desc.frames_in_flight = SAMPLE_FRAMES;
    desc.settings = &settings;
    desc.log.fn = print_message;
    desc.up_axis = options.down ? SDFGI_UP_MINUS_Y : SDFGI_UP_Y;
    sdfgi *gi;
    SAMPLE_CHECK(sdfgi_create(&desc, &gi));
    return gi;
}

static void add_lights(sdfgi *gi, const sample_view &view)
{
    sdfgi_light light;
    sdfgi_light_desc lamp = {};
    lamp.type = SDFGI_LIGHT_SPOT;
    std::copy_n(view.lamp_position, 3, lamp.position);
    std::copy_n(view.lamp_direction, 3, lamp.direction);
    std::copy_n(view.lamp_intensity, 3, lamp.intensity);
    lamp.inner_angle_rad = std::acos(view.lamp_position[3]);
    lamp.outer_angle_rad = std::acos(view.lamp_direction[3]);
    lamp.casts_shadow = true;
    SAMPLE_CHECK(sdfgi_light_create(gi, &lamp, &light));
    sdfgi_sky sky;
    for (float *color : { sky.zenith, sky.horizon, sky.ground })
        std::copy_n(view.sky, 3, color);
    SAMPLE_CHECK(sdfgi_set_sky(gi, &sky));
}

static void add_objects(sdfgi *gi, const sample_scene &scene, const sample_drawing &drawing, bool down)
{
    for (const sample_object &object : scene.objects) {
        const sample_mesh &own = scene.meshes[object.mesh];
        sdfgi_mesh_desc mesh = {};
        mesh.position_buffer = drawing.vertices.buffer;
        mesh.position_offset = own.first_vertex * sizeof(sample_vertex) + offsetof(sample_vertex, position);
        mesh.position_stride = sizeof(sample_vertex);
        mesh.index_buffer = drawing.indices.buffer;
        mesh.index_offset = own.first_index * sizeof(uint16_t);
        mesh.vertex_count = own.vertex_count;
        mesh.triangle_count = own.index_count / 3;
        mesh.front_face = down ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
        std::copy_n(own.low, 3, mesh.bounds_min);
        std::copy_n(own.high, 3, mesh.bounds_max);
        sdfgi_material_desc material = {};
        const sample_material &matter = scene.materials[object.material];
        std::copy_n(matter.base_color, 3, material.albedo); /* of metal, too: it sends light back */
        std::copy_n(matter.glow, 3, material.emission);
        material.smoothness = 1 - matter.glow[3];
        sdfgi_instance_desc placed = {};
        for (int column = 0; column < 3; column++)
            std::copy_n(object.matrix + 4 * column, 3, placed.transform.basis + 3 * column);
        std::copy_n(object.matrix + 12, 3, placed.transform.translation);
        sdfgi_instance instance;
        SAMPLE_CHECK(sdfgi_mesh_create(gi, &mesh, &placed.mesh));
        SAMPLE_CHECK(sdfgi_material_create(gi, &material, &placed.material));
        SAMPLE_CHECK(sdfgi_instance_create(gi, &placed, &instance));
    }
}
/* GI ends */

/* The forward pass: a picture of radiance. */
struct renderer {
    sample_scene scene;
    sample_drawing drawing;
    sample_image color, depth;
    sample_pass pass;
    sample_set set;
    sample_pipeline pipeline;
};

static void make_renderer(renderer &r, sample_gpu &gpu, const sample_options &options,
                          VkDescriptorSetLayout gi_layout)
{
    sample_scene_make(&r.scene, (float)options.width / (float)options.height);
    if (options.down)
        sample_scene_flip(&r.scene);
    VkBufferUsageFlags usage = 0;
    /* GI begins */
    usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    /* GI ends */
    r.drawing = sample_drawing_make(&gpu, &r.scene, usage);
    r.color = sample_image_make(&gpu, options.width, options.height, VK_FORMAT_R16G16B16A16_SFLOAT,
                                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    r.depth = sample_image_make(&gpu, options.width, options.height, VK_FORMAT_D32_SFLOAT,
                                VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    r.pass = sample_pass_make(&gpu, &r.color, 1, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, &r.depth);
    std::copy_n(r.scene.view.sky, 4, r.pass.clear[0].color.float32);
    const sample_binding bindings[] = { { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, r.drawing.view.buffer,
                                          VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED },
                                        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_NULL_HANDLE,
                                          r.drawing.shadow.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL } };
    r.set = sample_set_make(&gpu, bindings, 2);
    const VkDescriptorSetLayout layouts[] = { r.set.layout, gi_layout };
    r.pipeline.layout = sample_layout_make(&gpu, layouts, 2);
    r.pipeline.pipeline = sample_mesh_pipeline_make(
        &gpu, &r.pass, r.pipeline.layout, SAMPLE_CODE(sample_mesh_vert), SAMPLE_CODE(forward_host_frag));
}

static void draw(const renderer &r, VkCommandBuffer cmd, VkDescriptorSet gi_set)
{
    const VkDescriptorSet sets[] = { r.set.set, gi_set };
    sample_drawing_draw_shadow(&r.drawing, &r.scene, cmd);
    sample_pass_begin(cmd, &r.pass);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r.pipeline.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r.pipeline.layout, 0, 2, sets, 0, nullptr);
    sample_drawing_draw(&r.drawing, &r.scene, r.pipeline.layout, cmd);
    vkCmdEndRenderPass(cmd);
}

int main(int argc, char **argv)
{
    sample_options options;
    sample_gpu gpu;
    renderer r;
    uint32_t count;
    sample_options_read(&options, argc, argv);
    sample_window *window = sample_window_open(options.window, options.width, options.height);
    const char *const *extensions = sample_window_instance_extensions(window, &count);
    sample_gpu_find(&gpu, VK_API_VERSION_1_2, extensions, count);
    VkPhysicalDeviceFeatures features = {};
    /* GI begins */
    features = ask_for_features(gpu);
    /* GI ends */
    extensions = sample_window_device_extensions(window, &count);
    sample_gpu_open(&gpu, &features, extensions, count);
    /* GI begins */
    sdfgi_settings settings;
    sdfgi *gi = make_gi(gpu, options, settings);
    make_renderer(r, gpu, options, sdfgi_get_descriptor_set_layout(gi));
    add_objects(gi, r.scene, r.drawing, options.down);
    add_lights(gi, r.scene.view);
    /* GI ends */
    bool settled = false;
    while (sample_options_go_on(&options, gpu.frame, settled) && sample_window_acquire(window, &gpu)) {
        const VkCommandBuffer cmd = sample_frame_begin(&gpu);
        /* GI begins */
        sdfgi_frame_desc frame = {};
        std::copy_n(r.scene.view.eye, 3, frame.camera_position);
        settings.enabled = sample_options_gi(&options, gpu.frame);
        SAMPLE_CHECK(sdfgi_set_settings(gi, &settings));
        SAMPLE_CHECK(sdfgi_update(gi, cmd, &frame));
        draw(r, cmd, sdfgi_get_descriptor_set(gi));
        sdfgi_report report;
        sdfgi_get_report(gi, &report);
        settled = !report.active || report.converged;
        /* GI ends */
        sample_window_show(window, &gpu, &r.color);
    }
    SAMPLE_CHECK(vkDeviceWaitIdle(gpu.device));
    std::printf("%s after %llu frames\n", settled ? "settled" : "stopped", (unsigned long long)gpu.frame);
    if (options.out)
        sample_picture_write(&gpu, &r.color, options.out);
    /* GI begins */
    sdfgi_destroy(gi);
    /* GI ends */
    sample_window_close(window, &gpu);
    sample_gpu_close(&gpu);
    return 0;
}
