/* SPDX-License-Identifier: MIT
 * What a device must have, as tables. */
#include "gpu.h"
#include "pass/work.h"

#include <sdfgi/sdfgi.h>

#include <stdio.h>
#include <string.h>

static void refuse(struct sdfgi_requirements *r, const char *format, const char *what, uint64_t have,
                   uint64_t need)
{
    if (r->reason_count < SDFGI_MAX_REASONS)
        snprintf(r->reasons[r->reason_count++], sizeof r->reasons[0], format, what, (unsigned long long)have,
                 (unsigned long long)need);
}

static void check_limits(const VkPhysicalDeviceLimits *limits, struct sdfgi_requirements *r)
{
    const struct {
        const char *name;
        uint64_t have, need;
    } rows[] = {
        { "maxPerStageDescriptorStorageBuffers", limits->maxPerStageDescriptorStorageBuffers,
          RESOURCE_COUNT - 1 + 4 },
        { "maxStorageBufferRange", limits->maxStorageBufferRange, UINT64_C(64) << 20 },
        { "maxPushConstantsSize", limits->maxPushConstantsSize, 128 },
        { "maxComputeWorkGroupInvocations", limits->maxComputeWorkGroupInvocations, SDFGI_MOST_THREADS },
        { "maxComputeSharedMemorySize", limits->maxComputeSharedMemorySize, 16384 },
        { "maxBoundDescriptorSets", limits->maxBoundDescriptorSets, 4 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].have < rows[i].need)
            refuse(r, "%s is %llu, needed are %llu", rows[i].name, rows[i].have, rows[i].need);
}

enum sdfgi_result sdfgi_get_requirements(VkInstance instance, VkPhysicalDevice physical,
                                         PFN_vkGetInstanceProcAddr get, struct sdfgi_requirements *r)
{
    struct gpu_functions fn;
    memset(&fn, 0, sizeof fn);
    memset(r, 0, sizeof *r);
    r->api_version = GPU_API_VERSION;
    r->features_12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    if (!gpu_functions_load_instance(&fn, instance, get))
        return SDFGI_ERROR_INVALID_ARGUMENT;
    VkPhysicalDeviceProperties properties;
    fn.GetPhysicalDeviceProperties(physical, &properties);
    if (properties.apiVersion < GPU_API_VERSION)
        refuse(r, "%s 1.%llu, needed is 1.%llu", "Vulkan", VK_API_VERSION_MINOR(properties.apiVersion),
               VK_API_VERSION_MINOR(GPU_API_VERSION));
    /* Not vkGetPhysicalDeviceFeatures2, which an instance made for Vulkan 1.0 may not use. */
    VkPhysicalDeviceFeatures features;
    fn.GetPhysicalDeviceFeatures(physical, &features);
    /* Only the raster voxeliser stores from these shaders: sdfgi_set_settings refuses it without them. */
    r->features.fragmentStoresAndAtomics = features.fragmentStoresAndAtomics;
    r->features.vertexPipelineStoresAndAtomics = features.vertexPipelineStoresAndAtomics;
    check_limits(&properties.limits, r);
    r->supported = r->reason_count == 0;
    return SDFGI_OK;
}
