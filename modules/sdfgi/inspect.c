/* SPDX-License-Identifier: MIT
 * Copies of the volumes for those who want to look inside. */
#include "context.h"

#include <math.h>
#include <sdfgi/inspect.h>
#include <string.h>

static const enum resource volume_resources[SDFGI_VOLUME_COUNT] = {
    [SDFGI_VOLUME_BITS] = RESOURCE_BITS,
    [SDFGI_VOLUME_ALBEDO] = RESOURCE_ALBEDO,
    [SDFGI_VOLUME_EMISSION] = RESOURCE_EMISSION,
    [SDFGI_VOLUME_NORMALS] = RESOURCE_NORMALS,
};

static bool volume_is_known(enum sdfgi_volume volume)
{
    return (unsigned)volume < SDFGI_VOLUME_COUNT;
}

enum sdfgi_result sdfgi_inspect_get_cascade(const sdfgi *gi, uint32_t cascade,
                                            struct sdfgi_inspect_cascade *out)
{
    if (!sdfgi_is_active(gi))
        return sdfgi_message_invalid(&gi->backend.hooks,
                                     "sdfgi_inspect_get_cascade: nothing has been voxelised yet");
    if (cascade >= gi->settings.cascades)
        return sdfgi_message_invalid(&gi->backend.hooks, "sdfgi_inspect_get_cascade: cascade %u of %u",
                                     cascade, gi->settings.cascades);
    const struct cascade *from = &gi->volume.state.cascades.at[cascade];
    for (int i = 0; i < 3; i++) {
        out->origin_cells[i] = from->origin[i];
        out->origin_m[i] = (double)from->origin[i] * from->cell_size[i];
        out->cell_m[i] = from->cell_size[i];
    }
    out->resolution = gi->settings.resolution;
    out->emission_unit = gi->scene.emission_unit;
    return SDFGI_OK;
}

uint64_t sdfgi_inspect_volume_size(const sdfgi *gi, enum sdfgi_volume volume)
{
    if (!gi->settings.enabled || !volume_is_known(volume))
        return 0;
    const struct extent *extent = &gi->volume.resources->extent;
    return sdfgi_resource_size(volume_resources[volume], extent) / extent->cascades;
}

static struct problem copy_problem(const struct sdfgi *gi, uint32_t cascade, enum sdfgi_volume volume,
                                   VkBuffer buffer, VkDeviceSize offset)
{
    struct problem p = { "" };
    if (!sdfgi_is_active(gi))
        sdfgi_problem_add(&p, "nothing has been voxelised yet");
    if (cascade >= gi->settings.cascades)
        sdfgi_problem_add(&p, "cascade is %u, must be below %u", (unsigned)cascade,
                          (unsigned)gi->settings.cascades);
    if (!volume_is_known(volume))
        sdfgi_problem_add(&p, "volume is %d, must be one of enum sdfgi_volume", (int)volume);
    if (!buffer)
        sdfgi_problem_add(&p, "buffer is null");
    if (offset % 4 != 0)
        sdfgi_problem_add(&p, "offset is %llu, must be a multiple of 4", (unsigned long long)offset);
    return p;
}

enum sdfgi_result sdfgi_inspect_copy(sdfgi *gi, VkCommandBuffer cmd, uint32_t cascade,
                                     enum sdfgi_volume volume, VkBuffer buffer, VkDeviceSize offset)
{
    struct problem problem = copy_problem(gi, cascade, volume, buffer, offset);
    if (!cmd)
        sdfgi_problem_add(&problem, "cmd is null");
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_inspect_copy");
    const enum resource resource = volume_resources[volume];
    const struct gpu_buffer to = { .handle = buffer };
    const uint64_t bytes = sdfgi_inspect_volume_size(gi, volume);
    struct gpu_recorder rec;
    gpu_recorder_begin(&rec, &gi->backend.device, cmd);
    gpu_use(&rec, GPU_USAGE_TRANSFER, UINT64_C(1) << resource, 0);
    gpu_copy(&rec, &gi->volume.resources->buffers[resource], cascade * bytes, &to, offset, bytes);
    gpu_recorder_end(&rec);
    return SDFGI_OK;
}

/* As in shaders/sdfgi/surface.glsl. */
static void decode_albedo(const uint32_t *words, uint16_t albedo[6][3])
{
    const uint32_t sides = words[0] >> 30 | words[1] >> 28 << 2;
    const uint16_t colors[2][3] = {
        { words[0] & 1023, words[0] >> 10 & 1023, words[0] >> 20 & 1023 },
        { (uint16_t)(((words[1] & 511) * 1023 + 255) / 511), words[1] >> 9 & 1023,
          (uint16_t)(((words[1] >> 19 & 511) * 1023 + 255) / 511) },
    };
    for (int axis = 0; axis < 6; axis++)
        memcpy(albedo[axis], colors[sides >> axis & 1], sizeof albedo[axis]);
}

void sdfgi_inspect_decode_block(const uint32_t *albedo, const uint32_t *emission, uint32_t normals,
                                float emission_unit, struct sdfgi_inspect_surface *out)
{
    enum { NO_NORMAL = 31, ZERO_SLOPE = 15 };
    memset(out, 0, sizeof *out);
    if (albedo)
        decode_albedo(albedo, out->albedo);
    for (int i = 0; i < 3; i++) {
        const uint32_t slopes = normals >> (10 * i);
        /* RGB9E5 as in shaders/lib/rgbe.glsl, in one of two units as in shaders/sdfgi/surface.glsl. */
        out->emission[i] = ldexpf((float)(emission[0] >> (9 * i) & 511),
                                  (int)(emission[0] >> 27) - 24 + (emission[1] >> 30 & 1 ? 11 : -16)) *
                           emission_unit;
        out->has_normal[i] = (slopes & 31) != NO_NORMAL;
        for (int k = 0; k < 2 && out->has_normal[i]; k++)
            out->slopes[i][k] = (int8_t)((int)(slopes >> (5 * k) & 31) - ZERO_SLOPE);
    }
    for (int axis = 0; axis < 6; axis++)
        out->emitting[axis] = (uint8_t)(emission[1] >> (5 * axis) & 31);
}
