/* SPDX-License-Identifier: MIT
 * The library's volumes brought back to the CPU. */
#include "host_internal.h"

#include <stdlib.h>
#include <string.h>

static bool voxelize(struct host_renderer *renderer, const struct host_camera *camera)
{
    host_eye_look(renderer, camera);
    struct sdfgi_frame_desc desc = { .seed = renderer->seed, .exposure = renderer->gi_exposure };
    host_camera_center(&renderer->camera, renderer->scene->center, desc.camera_position);
    memcpy(desc.origin, renderer->camera.origin, sizeof(desc.origin));
    VkCommandBuffer cmd = host_commands_begin(renderer->device);
    if (!cmd)
        return false;
    const bool recorded = host_gi_update(renderer->gi, cmd, renderer->scene, &desc);
    return host_commands_finish(renderer->device, cmd) && recorded;
}

/* The words of one volume; the caller frees them. */
static uint32_t *words_read(struct host_renderer *renderer, uint32_t cascade, enum sdfgi_volume volume)
{
    struct host_device *device = renderer->device;
    sdfgi *gi = host_gi_context(renderer->gi);
    const VkDeviceSize bytes = sdfgi_inspect_volume_size(gi, volume);
    struct host_buffer staging;
    if (!host_buffer_create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, &staging))
        return NULL;
    uint32_t *words = host_device_alloc(device, bytes, 1);
    VkCommandBuffer cmd = words ? host_commands_begin(device) : VK_NULL_HANDLE;
    bool ok = cmd && sdfgi_inspect_copy(gi, cmd, cascade, volume, staging.buffer, 0) == SDFGI_OK;
    ok = cmd && host_commands_finish(device, cmd) && ok;
    if (ok)
        memcpy(words, staging.mapped, bytes);
    host_buffer_destroy(device, &staging);
    if (ok)
        return words;
    free(words);
    return NULL;
}

static void bits_sort(const uint32_t *words, struct host_volume *out)
{
    const uint32_t n = out->where.resolution;
    for (uint32_t z = 0; z < n; z++)
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++) {
                const uint64_t cell = sdfgi_inspect_cell(&out->where, x, y, z);
                out->bits[x + (size_t)n * (y + (size_t)n * z)] = sdfgi_inspect_bits(&words[2 * cell]);
            }
}

static void blocks_sort(const uint32_t *albedo, const uint32_t *emission, const uint32_t *normals,
                        struct host_volume *out)
{
    const uint32_t n = out->where.resolution / 2;
    for (uint32_t z = 0; z < n; z++)
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++) {
                const uint64_t i = sdfgi_inspect_block(&out->where, 2 * x, 2 * y, 2 * z);
                sdfgi_inspect_decode_block(albedo + 2 * i, emission + 2 * i, normals[i],
                                           out->where.emission_unit,
                                           &out->blocks[x + (size_t)n * (y + (size_t)n * z)]);
            }
}

static bool cascade_read(struct host_renderer *renderer, uint32_t cascade, struct host_volume *out)
{
    if (sdfgi_inspect_get_cascade(host_gi_context(renderer->gi), cascade, &out->where) != SDFGI_OK)
        return host_fail(renderer->device, "the library has no cascade %u", cascade);
    const size_t n = out->where.resolution;
    uint32_t *words[SDFGI_VOLUME_COUNT] = { 0 };
    out->bits = host_device_alloc(renderer->device, n * n * n, sizeof(*out->bits));
    out->blocks = host_device_alloc(renderer->device, n * n * n / 8, sizeof(*out->blocks));
    bool ok = out->bits && out->blocks;
    for (int i = 0; i < SDFGI_VOLUME_COUNT && ok; i++) {
        words[i] = words_read(renderer, cascade, (enum sdfgi_volume)i);
        ok = words[i] != NULL;
    }
    if (ok) {
        bits_sort(words[SDFGI_VOLUME_BITS], out);
        blocks_sort(words[SDFGI_VOLUME_ALBEDO], words[SDFGI_VOLUME_EMISSION], words[SDFGI_VOLUME_NORMALS],
                    out);
    }
    for (int i = 0; i < SDFGI_VOLUME_COUNT; i++)
        free(words[i]);
    return ok;
}

bool host_renderer_read_volumes(struct host_renderer *renderer, const struct host_camera *camera,
                                struct host_volumes *out)
{
    struct sdfgi_settings settings;
    *out = (struct host_volumes){ 0 };
    host_renderer_get_settings(renderer, &settings);
    if (!settings.enabled)
        return host_fail(renderer->device, "global illumination is off: there are no volumes");
    if (!voxelize(renderer, camera))
        return false;
    for (; out->count < settings.cascades; out->count++) {
        if (!cascade_read(renderer, out->count, &out->cascades[out->count])) {
            host_volumes_finish(out);
            return false;
        }
    }
    return true;
}

void host_volumes_finish(struct host_volumes *volumes)
{
    for (size_t i = 0; i < sizeof(volumes->cascades) / sizeof(volumes->cascades[0]); i++) {
        free(volumes->cascades[i].bits);
        free(volumes->cascades[i].blocks);
    }
    *volumes = (struct host_volumes){ 0 };
}
