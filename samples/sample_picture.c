/* SPDX-License-Identifier: MIT
 * Pictures of half floats in files. */
#include "sample_gpu.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static float float_from_half(uint16_t half)
{
    const int exponent = half >> 10 & 31;
    const float fraction = (float)(half & 1023) / 1024;
    const float size = exponent ? ldexpf(1 + fraction, exponent - 15) : ldexpf(fraction, -14);
    return half >> 15 ? -size : size;
}

/* An exponential curve, and sRGB's gamma. */
static unsigned char display_from_radiance(float radiance)
{
    const float shown = 1 - expf(-radiance);
    return (unsigned char)(255 * powf(fmaxf(shown, 0), 1 / 2.2f) + 0.5f);
}

static bool write_row(FILE *file, const uint16_t *texels, uint32_t width, bool is_pfm)
{
    bool good = true;
    for (uint32_t i = 0; i < 4 * width && good; i++) {
        const float value = float_from_half(texels[i]);
        const unsigned char shown = display_from_radiance(value);
        if (i % 4 < 3)
            good = is_pfm ? fwrite(&value, sizeof value, 1, file) == 1 : fwrite(&shown, 1, 1, file) == 1;
    }
    return good;
}

/* Rows of PFM go from the bottom upwards. */
static void write_file(const char *path, const uint16_t *texels, uint32_t width, uint32_t height)
{
    const char *end = strrchr(path, '.');
    const bool is_pfm = end && strcmp(end, ".pfm") == 0;
    FILE *file = fopen(path, "wb");
    sample_require(file != NULL, "opening the picture's file");
    fprintf(file, is_pfm ? "PF\n%u %u\n-1.0\n" : "P6\n%u %u\n255\n", width, height);
    bool good = true;
    for (uint32_t y = 0; y < height && good; y++)
        good = write_row(file, texels + (size_t)4 * width * (is_pfm ? height - 1 - y : y), width, is_pfm);
    sample_require(fclose(file) == 0 && good, "writing the picture's file");
}

void sample_picture_write(struct sample_gpu *gpu, const struct sample_image *image, const char *path)
{
    const struct sample_buffer copy = sample_buffer_make(gpu, (VkDeviceSize)8 * image->width * image->height,
                                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const VkBufferImageCopy region = { .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
                                       .imageExtent = { image->width, image->height, 1 } };
    const VkMemoryBarrier done = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_HOST_READ_BIT };
    const VkCommandBuffer cmd = sample_frame_begin(gpu);
    vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy.buffer, 1, &region);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &done, 0,
                         NULL, 0, NULL);
    sample_frame_submit(gpu, VK_NULL_HANDLE, VK_NULL_HANDLE);
    SAMPLE_CHECK(vkDeviceWaitIdle(gpu->device));
    write_file(path, (const uint16_t *)copy.mapped, image->width, image->height);
}
