/* SPDX-License-Identifier: MIT
 * Teaches: all that a host has to do. Makes a device, shares it with libsdfgi, describes two meshes, a sun,
 * a sky, switches on, lets the light converge and asks for it in its own shader, minimal_host.comp. Build:
 *   glslangValidator -V --target-env vulkan1.2 -I$(pkg-config --variable=shaderdir sdfgi) --vn shade \
 *       -o minimal_host_spirv.h minimal_host.comp
 *   cc -I. minimal_host.c $(pkg-config --cflags --libs sdfgi vulkan) -o minimal_host */
/* clang-format off */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sdfgi/sdfgi.h>
#include <vulkan/vulkan.h>
#include "minimal_host_spirv.h"

enum { WIDTH = 320, HEIGHT = 180, MAX_FRAMES = 2000, PICTURE_AT = 1024 };
static struct sdfgi_vulkan vk = { .get_instance_proc_addr = vkGetInstanceProcAddr }; /* queue family 0 */
static VkCommandBuffer cmd;
static VkBuffer buffer; /* vertices, then from PICTURE_AT the picture, 4 bytes per pixel */
static char *mapped;
static VkPipelineLayout layout;
static VkPipeline pipeline;

#define INFO(type) .sType = VK_STRUCTURE_TYPE_##type
#define CHECK(call) check((call) >= 0, #call) /* Vulkan and libsdfgi both count errors downwards from 0 */
static void check(bool good, const char *what)
{
    if (!good && fprintf(stderr, "minimal_host: failed: %s\n", what))
        exit(EXIT_FAILURE);
}

static void print_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    fprintf((FILE *)user, "sdfgi: level %d, message %d: %s\n", (int)level, (int)id, text);
}

static void make_device_and_buffer(void)
{
    VkApplicationInfo app = { INFO(APPLICATION_INFO), .apiVersion = VK_API_VERSION_1_2 };
    VkInstanceCreateInfo instance = { INFO(INSTANCE_CREATE_INFO), .pApplicationInfo = &app };
    struct sdfgi_requirements needs;
    CHECK(vkCreateInstance(&instance, NULL, &vk.instance));
    CHECK(vkEnumeratePhysicalDevices(vk.instance, &(uint32_t){ 1 }, &vk.physical_device));
    CHECK(sdfgi_get_requirements(vk.instance, vk.physical_device, vkGetInstanceProcAddr, &needs));
    check(needs.supported, needs.reasons[0]);
    needs.features_12.bufferDeviceAddress = VK_TRUE; /* for our picture: the library does without */
    VkDeviceQueueCreateInfo queue = { INFO(DEVICE_QUEUE_CREATE_INFO), NULL, 0, 0, 1, &(float){ 1 } };
    VkDeviceCreateInfo info = { INFO(DEVICE_CREATE_INFO), &needs.features_12, 0, 1, &queue, 0, NULL,
                                needs.extension_count, needs.extensions, &needs.features };
    CHECK(vkCreateDevice(vk.physical_device, &info, NULL, &vk.device));
    VkCommandPoolCreateInfo pool = { INFO(COMMAND_POOL_CREATE_INFO), NULL, 0, 0 };
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    VkCommandBufferAllocateInfo take = { INFO(COMMAND_BUFFER_ALLOCATE_INFO), .commandBufferCount = 1 };
    CHECK(vkCreateCommandPool(vk.device, &pool, NULL, &take.commandPool));
    CHECK(vkAllocateCommandBuffers(vk.device, &take, &cmd));
    VkBufferCreateInfo data = { INFO(BUFFER_CREATE_INFO), .size = PICTURE_AT + 4 * WIDTH * HEIGHT };
    data.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    CHECK(vkCreateBuffer(vk.device, &data, NULL, &buffer));
    VkMemoryRequirements room;
    VkPhysicalDeviceMemoryProperties all;
    vkGetBufferMemoryRequirements(vk.device, buffer, &room);
    vkGetPhysicalDeviceMemoryProperties(vk.physical_device, &all);
    VkMemoryAllocateFlagsInfo flags = { INFO(MEMORY_ALLOCATE_FLAGS_INFO), NULL,
                                        VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT, 0 };
    VkMemoryAllocateInfo size = { INFO(MEMORY_ALLOCATE_INFO), &flags, room.size, 0 };
    while (~all.memoryTypes[size.memoryTypeIndex].propertyFlags & 6) /* visible and coherent: there is one */
        size.memoryTypeIndex++;
    VkDeviceMemory memory;
    CHECK(vkAllocateMemory(vk.device, &size, NULL, &memory));
    CHECK(vkBindBufferMemory(vk.device, buffer, memory, 0));
    CHECK(vkMapMemory(vk.device, memory, 0, VK_WHOLE_SIZE, 0, (void **)&mapped));
}

/* A grey floor and a red wall under sun and sky: minimal_host.comp knows the same scene. */
static sdfgi *make_gi(void)
{
    sdfgi *gi;
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.enabled = true, settings.frames_to_converge = 4; /* the first is the one switch */
    settings.cascades = 2, settings.ray_count = 125, settings.cell_rays = 64; /* few long frames */
    CHECK(sdfgi_create(&(struct sdfgi_desc){ vk, 1, &settings, .log = { print_message, stderr } }, &gi));
    static const float vertices[2][6][3] = {
        { { -6, 0, 6 }, { 6, 0, 6 }, { 6, 0, -6 }, { -6, 0, 6 }, { 6, 0, -6 }, { -6, 0, -6 } },
        { { -3, 0, -2 }, { 3, 0, -2 }, { 3, 3, -2 }, { -3, 0, -2 }, { 3, 3, -2 }, { -3, 3, -2 } } };
    memcpy(mapped, vertices, sizeof(vertices));
    for (uint32_t i = 0; i < 2; i++) {
        struct sdfgi_material_desc matter = { .albedo = { 0.7f, i ? 0.1f : 0.7f, i ? 0.08f : 0.7f } };
        struct sdfgi_mesh_desc mesh = { .position_buffer = buffer, .position_offset = i * sizeof(vertices[0]),
            .vertex_count = 6, .triangle_count = 2, .bounds_min = { -6, 0, -6 }, .bounds_max = { 6, 3, 6 } };
        struct sdfgi_instance_desc placed = { .transform.basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
        CHECK(sdfgi_mesh_create(gi, &mesh, &placed.mesh));
        CHECK(sdfgi_material_create(gi, &matter, &placed.material));
        CHECK(sdfgi_instance_create(gi, &placed, &(sdfgi_instance){ 0 }));
    }
    struct sdfgi_light_desc sun = { .direction = { -0.5f, -0.7f, -0.4f }, .intensity = { 10, 9.4f, 8.5f },
                                    .indirect_energy = 1, .casts_shadow = true };
    CHECK(sdfgi_light_create(gi, &sun, &(sdfgi_light){ 0 }));
    CHECK(sdfgi_set_sky(gi, &(struct sdfgi_sky){ { 0.3f, 0.6f, 1 }, { 1, 1, 1 }, { 0.3f, 0.3f, 0.3f } }));
    return gi;
}

static void make_pipeline(const sdfgi *gi)
{
    VkDescriptorSetLayout set = sdfgi_get_descriptor_set_layout(gi);
    VkPushConstantRange address = { VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(VkDeviceAddress) };
    VkPipelineLayoutCreateInfo sets = { INFO(PIPELINE_LAYOUT_CREATE_INFO), NULL, 0, 1, &set, 1, &address };
    VkShaderModuleCreateInfo code = { INFO(SHADER_MODULE_CREATE_INFO), NULL, 0, sizeof(shade), shade };
    VkPipelineShaderStageCreateInfo stage = { INFO(PIPELINE_SHADER_STAGE_CREATE_INFO), .pName = "main" };
    CHECK(vkCreatePipelineLayout(vk.device, &sets, NULL, &layout));
    CHECK(vkCreateShaderModule(vk.device, &code, NULL, &stage.module));
    stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    VkComputePipelineCreateInfo job = { INFO(COMPUTE_PIPELINE_CREATE_INFO), NULL, 0, stage, layout, NULL, 0 };
    CHECK(vkCreateComputePipelines(vk.device, VK_NULL_HANDLE, 1, &job, NULL, &pipeline));
}

int main(int argc, char **argv)
{
    make_device_and_buffer();
    sdfgi *gi = make_gi();
    make_pipeline(gi);
    VkQueue queue;
    vkGetDeviceQueue(vk.device, 0, 0, &queue);
    VkBufferDeviceAddressInfo info = { INFO(BUFFER_DEVICE_ADDRESS_INFO), NULL, buffer };
    const VkDeviceAddress picture = vkGetBufferDeviceAddress(vk.device, &info) + PICTURE_AT;
    VkMemoryBarrier done = { INFO(MEMORY_BARRIER), 0, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT };
    struct sdfgi_report report = { .converged = false };
    for (uint64_t frame = 0; !report.converged; frame++) {
        check(frame < MAX_FRAMES, "converging"); /* a real host shows each frame, and never waits */
        CHECK(vkBeginCommandBuffer(cmd, &(VkCommandBufferBeginInfo){ INFO(COMMAND_BUFFER_BEGIN_INFO) }));
        CHECK(sdfgi_update(gi, cmd, &(struct sdfgi_frame_desc){ 0 }));
        VkDescriptorSet set = sdfgi_get_descriptor_set(gi);
        vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, NULL);
        vkCmdPushConstants(cmd, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(picture), &picture);
        vkCmdDispatch(cmd, WIDTH / 8, (HEIGHT + 7) / 8, 1);
        vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &done,
                             0, NULL, 0, NULL);
        CHECK(vkEndCommandBuffer(cmd));
        VkSubmitInfo submit = { INFO(SUBMIT_INFO), .commandBufferCount = 1, .pCommandBuffers = &cmd };
        CHECK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
        CHECK(vkQueueWaitIdle(queue));
        sdfgi_get_report(gi, &report);
    }
    FILE *file = fopen(argc > 1 ? argv[1] : "out.ppm", "wb");
    check(file && fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT) > 0, "opening the picture");
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        check(fwrite(mapped + PICTURE_AT + 4 * i, 1, 3, file) == 3, "writing the picture");
    check(fclose(file) == 0, "closing the picture");
    sdfgi_destroy(gi);
}
