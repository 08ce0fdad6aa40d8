/* SPDX-License-Identifier: MIT
 * Pipelines that were kept from an earlier run. The driver is one of the test's: its functions stand before
 * the loader's, and it checks what it is given. */
#include "fuzz.h"

#include "file/cache_file.h"
#include "host_internal.h"
#include "require.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAGIC_BYTES = 8, FILE_HEADER_BYTES = 24 };

static const VkPipelineCacheHeaderVersionOne driver_header = {
    .headerSize = sizeof driver_header,
    .headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
    .vendorID = 0x5df,
    .deviceID = 0x91,
    .pipelineCacheUUID = "fuzzed driver..",
};

static size_t driver_given;

VKAPI_ATTR void VKAPI_CALL vkGetPhysicalDeviceProperties(VkPhysicalDevice physical,
                                                         VkPhysicalDeviceProperties *properties)
{
    (void)physical;
    *properties = (VkPhysicalDeviceProperties){ .vendorID = driver_header.vendorID,
                                                .deviceID = driver_header.deviceID };
    memcpy(properties->pipelineCacheUUID, driver_header.pipelineCacheUUID, VK_UUID_SIZE);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreatePipelineCache(VkDevice device, const VkPipelineCacheCreateInfo *info,
                                                     const VkAllocationCallbacks *callbacks,
                                                     VkPipelineCache *cache)
{
    (void)device;
    (void)callbacks;
    VkPipelineCacheHeaderVersionOne header;
    driver_given = info->initialDataSize;
    if (driver_given > 0) {
        REQUIRE_CMP(driver_given, >=, sizeof header);
        memcpy(&header, info->pInitialData, sizeof header);
        REQUIRE_CMP(header.headerSize, <=, driver_given);
        REQUIRE_CMP(header.headerVersion, ==, driver_header.headerVersion);
        REQUIRE_CMP(header.vendorID, ==, driver_header.vendorID);
        REQUIRE_BYTES(header.pipelineCacheUUID, driver_header.pipelineCacheUUID, VK_UUID_SIZE);
    }
    *cache = (VkPipelineCache)(uintptr_t)1;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL vkGetPipelineCacheData(VkDevice device, VkPipelineCache cache, size_t *size,
                                                      void *data)
{
    (void)device;
    (void)cache;
    (void)data;
    *size = 0; /* nothing to save */
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL vkDestroyPipelineCache(VkDevice device, VkPipelineCache cache,
                                                  const VkAllocationCallbacks *callbacks)
{
    (void)device;
    (void)cache;
    (void)callbacks;
}

static void start(const char *folder, struct host_device *device)
{
    *device = (struct host_device){ 0 };
    driver_given = 0;
    host_cache_init(device, folder);
    host_cache_finish(device);
}

/* True where the driver was given what the file holds. */
static bool read_cache(const char *path, char *error, size_t error_size)
{
    char folder[256];
    struct host_device device;
    size_t size = 0;
    void *const data = cache_file_load(path, &size);
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    start(folder, &device); /* says what name the file must have */
    REQUIRE_CMP(driver_given, ==, 0u);
    REQUIRE_CMP(rename(path, device.cache.path), ==, 0);
    start(folder, &device);
    REQUIRE_TRUE(driver_given == 0 || (data && driver_given == size));
    remove(device.cache.path);
    free(data);
    snprintf(error, error_size, FUZZ_STEM ".cache counts as absent");
    return driver_given > 0;
}

/* The magic, size and checksum of the file, and the header of the driver's data. */
static void mend_cache(uint8_t *data, size_t size)
{
    if (size < FILE_HEADER_BYTES + sizeof driver_header)
        return;
    const uint64_t length = size - FILE_HEADER_BYTES;
    memcpy(data, "sdfgi-1", MAGIC_BYTES);
    memcpy(data + MAGIC_BYTES, &length, sizeof length);
    if (size % 2)
        memcpy(data + FILE_HEADER_BYTES, &driver_header, sizeof driver_header);
    const uint64_t sum = cache_checksum(data + FILE_HEADER_BYTES, size - FILE_HEADER_BYTES);
    memcpy(data + MAGIC_BYTES + sizeof length, &sum, sizeof sum);
}

const struct fuzz_target fuzz_cache = { ".cache", read_cache, NULL, mend_cache };
