/* SPDX-License-Identifier: MIT
 * What the host owns, and contexts whose memory is counted. */
#include "api_world.h"

#include "layered_vulkan.h"
#include "require.h"

#include <vulkan/vulkan.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COPY_BYTES = 32 * 32 * 32 * 8, TEXELS = 8 };

/* ---- Memory ----------------------------------------------------------------------------------------- */

/* Of all contexts of this program. */
static int64_t live_host, live_device;

static void *count_alloc(void *user, size_t size)
{
    (void)user;
    void *const memory = malloc(size);
    live_host += memory != NULL;
    return memory;
}

static void count_free(void *user, void *memory)
{
    (void)user;
    live_host -= memory != NULL;
    free(memory);
}

static VKAPI_ATTR VkResult VKAPI_CALL count_allocate(VkDevice device, const VkMemoryAllocateInfo *info,
                                                     const VkAllocationCallbacks *callbacks,
                                                     VkDeviceMemory *memory)
{
    const VkResult result = vkAllocateMemory(device, info, callbacks, memory);
    live_device += result == VK_SUCCESS;
    return result;
}

static VKAPI_ATTR void VKAPI_CALL count_release(VkDevice device, VkDeviceMemory memory,
                                                const VkAllocationCallbacks *callbacks)
{
    live_device -= memory != VK_NULL_HANDLE;
    vkFreeMemory(device, memory, callbacks);
}

static const struct layered_function counted[] = {
    LAYERED("vkAllocateMemory", count_allocate),
    LAYERED("vkFreeMemory", count_release),
    { NULL, NULL },
};

/* ---- Contexts --------------------------------------------------------------------------------------- */

static void count_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    struct gi_test *const t = user;
    (void)level;
    REQUIRE_TRUE(text[0] != '\0' && strchr(text, '\n') == NULL);
    t->messages[id]++;
    snprintf(t->last_message, sizeof t->last_message, "%s", text);
}

void api_context_open(struct gi_test *t, const struct sdfgi_settings *settings)
{
    const struct sdfgi_desc desc = {
        .vulkan = { t->gpu.instance, t->gpu.physical_device, t->gpu.device, t->gpu.queue_family_index,
                    layered_vulkan_loader(counted), NULL, VK_API_VERSION_1_2 },
        .frames_in_flight = 2,
        .settings = settings,
        .log = { count_message, t },
        .allocator = { count_alloc, count_free, NULL },
    };
    memset(&t->frame, 0, sizeof t->frame);
    memset(t->messages, 0, sizeof t->messages);
    REQUIRE_CMP((int)sdfgi_create(&desc, &t->gi), ==, (int)SDFGI_OK);
}

void api_context_close(struct gi_test *t)
{
    const int64_t host = live_host, device = live_device;
    sdfgi_destroy(t->gi);
    t->gi = NULL;
    REQUIRE_CMP(live_host, <, host);
    REQUIRE_CMP(live_device, <, device);
    static bool another; /* contexts are opened and closed in pairs */
    if (another) {
        REQUIRE_CMP(live_host, ==, 0);
        REQUIRE_CMP(live_device, ==, 0);
    }
    another = !another;
}

/* ---- Buffers and pictures --------------------------------------------------------------------------- */

static void make_shape(struct api_device *device, struct gi_test *t, uint32_t index, struct test_mesh mesh)
{
    device->positions[index] = gpu_test_buffer_device(&t->gpu, 12 * (VkDeviceSize)mesh.vertex_count,
                                                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, mesh.positions);
    device->indices[index] = gpu_test_buffer_device(&t->gpu, 12 * (VkDeviceSize)mesh.triangle_count,
                                                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, mesh.indices);
    struct sdfgi_mesh_desc *const desc = &device->shapes[index];
    *desc = (struct sdfgi_mesh_desc){ .position_buffer = device->positions[index].buffer,
                                      .index_buffer = device->indices[index].buffer,
                                      .index_type = VK_INDEX_TYPE_UINT32,
                                      .uv_buffer = device->positions[index].buffer,
                                      .uv_stride = 12,
                                      .vertex_count = mesh.vertex_count,
                                      .triangle_count = mesh.triangle_count };
    test_mesh_bounds(&mesh, desc->bounds_min, desc->bounds_max);
    test_mesh_destroy(&mesh);
}

void api_device_open(struct api_device *device, struct gi_test *t)
{
    static const double center[3], half[3] = { 0.9, 0.35, 0.6 }, u[3] = { 0, 0, 1.5 }, v[3] = { 1.5, 0, 0 };
    static float halves[4 * API_PICTURE * API_PICTURE];
    static uint8_t texels[4 * TEXELS * TEXELS];
    static float roughness[API_PICTURE * API_PICTURE];
    make_shape(device, t, 0, test_mesh_box(center, half, test_rotation_none));
    make_shape(device, t, 1, test_mesh_sphere(center, 0.8, 1));
    make_shape(device, t, 2, test_mesh_torus(center, 0.9, 0.3, test_rotation_none, 8, 4));
    make_shape(device, t, 3, test_mesh_plane(center, u, v, 2));
    device->copy = gpu_test_buffer_host(&t->gpu, COPY_BYTES, 0, NULL);
    for (int i = 0; i < 4 * API_PICTURE * API_PICTURE; i++)
        halves[i] = 0.5f;
    /* Metal is below 0; some of it is no roughness. */
    for (int i = 0; i < API_PICTURE * API_PICTURE; i++)
        roughness[i] = i % 97 == 0 ? NAN : (float)(i % 25) / 10 - 1.2f;
    for (int i = 0; i < 4 * TEXELS * TEXELS; i++)
        texels[i] = (uint8_t)(37 * i);
    device->depth = gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, API_PICTURE, API_PICTURE, halves);
    device->normal =
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, API_PICTURE, API_PICTURE, halves);
    device->roughness = gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, API_PICTURE, API_PICTURE, roughness);
    device->output =
        gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, API_PICTURE, API_PICTURE, NULL);
    device->texture = gi_test_gather_image(t, VK_FORMAT_R8G8B8A8_UNORM, 4, TEXELS, TEXELS, texels);
}

void api_device_close(struct api_device *device, struct gi_test *t)
{
    for (int i = 0; i < API_SHAPES; i++) {
        gpu_test_buffer_destroy(&t->gpu, &device->positions[i]);
        gpu_test_buffer_destroy(&t->gpu, &device->indices[i]);
    }
    gpu_test_buffer_destroy(&t->gpu, &device->copy);
    gpu_test_image_destroy(&t->gpu, &device->depth);
    gpu_test_image_destroy(&t->gpu, &device->normal);
    gpu_test_image_destroy(&t->gpu, &device->roughness);
    gpu_test_image_destroy(&t->gpu, &device->output);
    gpu_test_image_destroy(&t->gpu, &device->texture);
}
