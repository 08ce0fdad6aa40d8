/* SPDX-License-Identifier: MIT
 * A picture of all directions: the background, and for GI its second-order harmonics. */
#include "host_internal.h"
#include "host_texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pictures with a longer side lose texels: every Vulkan device has images of this size. */
enum { SIDE_MAX = 4096 };

static const double pi = 3.14159265358979323846;

/* The basis of sdfgi/sky.h, which is that of Ramamoorthi and Hanrahan 2001, "An Efficient Representation for
 * Irradiance Environment Maps". */
static void basis_at(const double d[3], double out[9])
{
    out[0] = 0.282095;
    out[1] = 0.488603 * d[1];
    out[2] = 0.488603 * d[2];
    out[3] = 0.488603 * d[0];
    out[4] = 1.092548 * d[0] * d[1];
    out[5] = 1.092548 * d[1] * d[2];
    out[6] = 0.315392 * (3 * d[2] * d[2] - 1);
    out[7] = 1.092548 * d[0] * d[2];
    out[8] = 0.546274 * (d[0] * d[0] - d[1] * d[1]);
}

static void row_project(const struct host_environment *from, uint32_t row, double sums[9][3])
{
    const double top = cos(pi * row / from->height), bottom = cos(pi * (row + 1) / from->height);
    const double angle = 2 * pi / from->width * (top - bottom), down = pi * (row + 0.5) / from->height;
    for (uint32_t column = 0; column < from->width; column++) {
        const double around = 2 * pi * ((column + 0.5) / from->width - 0.5);
        const double d[3] = { sin(down) * sin(around), cos(down), -sin(down) * cos(around) };
        const float *const texel = from->rgb + 3 * ((size_t)row * from->width + column);
        double basis[9];
        basis_at(d, basis);
        for (int i = 0; i < 9; i++)
            for (int c = 0; c < 3; c++)
                sums[i][c] += angle * basis[i] * (double)texel[c];
    }
}

static void project(const struct host_environment *from, struct sdfgi_sky_harmonics *out)
{
    double sums[9][3] = { { 0 } };
    for (uint32_t row = 0; row < from->height; row++)
        row_project(from, row, sums);
    *out = (struct sdfgi_sky_harmonics){ .intensity = 1 };
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            out->coefficients[i][c] = (float)sums[i][c];
}

/* VK_FORMAT_E5B9G9R9_UFLOAT_PACK32: three mantissas of nine bits, rounded, and the exponent of the largest.
 */
static uint32_t texel_pack(const double rgb[3])
{
    const double largest = fmin(fmax(fmax(rgb[0], rgb[1]), rgb[2]), 65408);
    int exponent = -15;
    if (largest > 0)
        frexp(largest, &exponent);
    exponent = exponent < -15 ? -15 : exponent;
    if (floor(ldexp(largest, 9 - exponent) + 0.5) > 511)
        exponent++;
    uint32_t packed = (uint32_t)(exponent + 15) << 27;
    for (int c = 0; c < 3; c++)
        packed |= (uint32_t)floor(ldexp(fmin(rgb[c], largest), 9 - exponent) + 0.5) << (9 * c);
    return packed;
}

/* The mean of a square of texels. */
static uint32_t square_pack(const struct host_environment *from, uint32_t step, uint32_t x, uint32_t y)
{
    double sum[3] = { 0 }, count = 0;
    for (uint32_t row = step * y; row < step * (y + 1) && row < from->height; row++)
        for (uint32_t column = step * x; column < step * (x + 1) && column < from->width; column++) {
            const float *const texel = from->rgb + 3 * ((size_t)row * from->width + column);
            for (int c = 0; c < 3; c++)
                sum[c] += (double)texel[c];
            count++;
        }
    for (int c = 0; c < 3; c++)
        sum[c] /= count;
    return texel_pack(sum);
}

static bool image_init(struct host_device *device, const struct host_environment *from,
                       struct host_image *out)
{
    const uint32_t longer = from->width > from->height ? from->width : from->height;
    const uint32_t step = (longer + SIDE_MAX - 1) / SIDE_MAX;
    const uint32_t width = (from->width + step - 1) / step, height = (from->height + step - 1) / step;
    uint32_t *const texels = host_device_alloc(device, (size_t)width * height, sizeof(*texels));
    for (uint32_t y = 0; texels && y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            texels[(size_t)y * width + x] = square_pack(from, step, x, y);
    const bool ok = texels && host_texture_create(device, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, width, height, 1,
                                                  texels, out);
    free(texels);
    return ok;
}

bool host_environment_init(struct host_scene *scene, const struct host_environment *from)
{
    struct host_environment_map *const map = &scene->environment;
    const VkSamplerCreateInfo sampler = { .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                          .magFilter = VK_FILTER_LINEAR,
                                          .minFilter = VK_FILTER_LINEAR,
                                          .addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                          .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE };
    if (!from->rgb)
        return true;
    project(from, &map->harmonics);
    map->exists = true;
    return host_check(scene->device, vkCreateSampler(scene->device->device, &sampler, NULL, &map->sampler),
                      "creating a sampler") &&
           image_init(scene->device, from, &map->image);
}

void host_environment_finish(struct host_scene *scene)
{
    vkDestroySampler(scene->device->device, scene->environment.sampler, NULL);
    host_image_destroy(scene->device, &scene->environment.image);
}

void host_environment_set_write(const struct host_scene *scene, VkDescriptorSet set)
{
    const VkDescriptorImageInfo info = { scene->environment.sampler, scene->environment.image.view,
                                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL };
    VkWriteDescriptorSet writes[2];
    for (uint32_t i = 0; i < 2; i++)
        writes[i] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            .pImageInfo = &info };
    vkUpdateDescriptorSets(scene->device->device, 2, writes, 0, NULL);
}
