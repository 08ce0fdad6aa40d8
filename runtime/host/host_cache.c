/* SPDX-License-Identifier: MIT
 * Compiled pipelines, kept on disk from one run to the next. Nothing here can fail: without a file the driver
 * compiles everything again. */
#include "host_internal.h"

#include "file/cache_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One file for each driver, device and version of the program. */
static bool set_path(struct host_cache *cache, const char *folder, const VkPhysicalDeviceProperties *p)
{
    char uuid[2 * VK_UUID_SIZE + 1];
    for (size_t i = 0; i < VK_UUID_SIZE; i++)
        snprintf(uuid + 2 * i, 3, "%02x", p->pipelineCacheUUID[i]);
    const int length = snprintf(cache->path, sizeof cache->path, "%s/pipelines-%x-%x-%x-%s-" HOST_VERSION,
                                folder, p->vendorID, p->deviceID, p->driverVersion, uuid);
    return length > 0 && (size_t)length < sizeof cache->path;
}

/* Drivers should refuse data of another driver; some trust it. */
static bool data_fits(const void *data, size_t size, const VkPhysicalDeviceProperties *properties)
{
    VkPipelineCacheHeaderVersionOne header;
    if (size < sizeof header)
        return false;
    memcpy(&header, data, sizeof header);
    return header.headerSize >= sizeof header && header.headerSize <= size &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == properties->vendorID && header.deviceID == properties->deviceID &&
           memcmp(header.pipelineCacheUUID, properties->pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

static bool create(struct host_device *device, const void *data, size_t size)
{
    const VkPipelineCacheCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                             .initialDataSize = size,
                                             .pInitialData = data };
    if (vkCreatePipelineCache(device->device, &info, NULL, &device->cache.handle) == VK_SUCCESS)
        return true;
    device->cache.handle = VK_NULL_HANDLE;
    return false;
}

void host_cache_init(struct host_device *device, const char *folder)
{
    VkPhysicalDeviceProperties properties;
    size_t size = 0;
    vkGetPhysicalDeviceProperties(device->physical, &properties);
    if (!folder || !set_path(&device->cache, folder, &properties))
        return;
    void *data = cache_file_load(device->cache.path, &size);
    if (data && data_fits(data, size, &properties) && create(device, data, size)) {
        device->cache.saved_size = size;
        device->cache.saved_checksum = cache_checksum(data, size);
    } else {
        create(device, NULL, 0);
    }
    free(data);
}

static void save(struct host_device *device)
{
    const struct host_cache *cache = &device->cache;
    size_t size = 0;
    if (vkGetPipelineCacheData(device->device, cache->handle, &size, NULL) != VK_SUCCESS || size == 0)
        return;
    void *data = malloc(size);
    if (data && vkGetPipelineCacheData(device->device, cache->handle, &size, data) == VK_SUCCESS &&
        (size != cache->saved_size || cache_checksum(data, size) != cache->saved_checksum))
        cache_file_save(cache->path, data, size);
    free(data);
}

void host_cache_finish(struct host_device *device)
{
    if (!device->cache.handle)
        return;
    save(device);
    vkDestroyPipelineCache(device->device, device->cache.handle, NULL);
}
