/* SPDX-License-Identifier: MIT
 * Pipelines kept from one start of the renderer to the next. Three functions of Vulkan's are defined here and
 * stand before the loader's: a driver whose cache holds what the test says, and which notes what it is given.
 */
#include "files.h"
#include "unit.h"

#include "file/cache_file.h"
#include "host.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

enum { SKIP = 77, DATA_BYTES = 64 };

static struct {
    uint8_t holds[DATA_BYTES]; /* what the driver's cache holds at the end */
    uint8_t given[DATA_BYTES];
    size_t given_size;
    int created, destroyed;
} driver;

VKAPI_ATTR VkResult VKAPI_CALL vkCreatePipelineCache(VkDevice device, const VkPipelineCacheCreateInfo *info,
                                                     const VkAllocationCallbacks *callbacks,
                                                     VkPipelineCache *cache)
{
    (void)device;
    (void)callbacks;
    driver.created++;
    driver.given_size = info->initialDataSize;
    assert_true(driver.given_size <= DATA_BYTES);
    if (driver.given_size > 0)
        memcpy(driver.given, info->pInitialData, driver.given_size);
    *cache = (VkPipelineCache)(uintptr_t)1;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL vkGetPipelineCacheData(VkDevice device, VkPipelineCache cache, size_t *size,
                                                      void *data)
{
    (void)device;
    (void)cache;
    *size = DATA_BYTES;
    if (data)
        memcpy(data, driver.holds, DATA_BYTES);
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL vkDestroyPipelineCache(VkDevice device, VkPipelineCache cache,
                                                  const VkAllocationCallbacks *callbacks)
{
    (void)device;
    (void)cache;
    (void)callbacks;
    driver.destroyed++;
}

/* ---- The header that Vulkan puts before a driver's data ---------------------------------------------- */

static VkPipelineCacheHeaderVersionOne header;

/* Vulkan 1.0 states what the header of this machine's device looks like. */
static bool find_header(void)
{
    VkInstance instance;
    VkPhysicalDevice physical;
    VkPhysicalDeviceProperties properties;
    uint32_t count = 1;
    if (vkCreateInstance(&(VkInstanceCreateInfo){ .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO }, NULL,
                         &instance) != VK_SUCCESS)
        return false;
    vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (count > 0) {
        vkGetPhysicalDeviceProperties(physical, &properties);
        header = (VkPipelineCacheHeaderVersionOne){ .headerSize = sizeof header,
                                                    .headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
                                                    .vendorID = properties.vendorID,
                                                    .deviceID = properties.deviceID };
        memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE);
    }
    vkDestroyInstance(instance, NULL);
    return count > 0;
}

static void driver_holds(uint8_t content)
{
    memset(&driver, 0, sizeof driver);
    memset(driver.holds, content, sizeof driver.holds);
    memcpy(driver.holds, &header, sizeof header);
}

/* ---- Starts ----------------------------------------------------------------------------------------- */

/* Starts and ends a renderer's device. The driver's cache holds `content` in the end. */
static void start(const char *folder, uint8_t content)
{
    char error[256] = "";
    driver_holds(content);
    struct host_device *const device = host_device_create(
        &(struct host_device_desc){ .select = "0", .cache_folder = folder }, error, sizeof error);
    if (!device)
        fail_msg("%s", error);
    host_device_destroy(device);
    assert_int_equal(driver.created, driver.destroyed);
}

static void assert_given(uint8_t content)
{
    uint8_t expected[DATA_BYTES];
    memset(expected, content, sizeof expected);
    memcpy(expected, &header, sizeof header);
    assert_int_equal(driver.given_size, DATA_BYTES);
    assert_memory_equal(driver.given, expected, DATA_BYTES);
}

/* The one file in the folder. */
static const char *file_name(void)
{
    static char name[256];
    DIR *const folder = opendir(files_path(""));
    name[0] = '\0';
    for (const struct dirent *entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.')
            snprintf(name, sizeof name, "%s", entry->d_name);
    closedir(folder);
    assert_int_equal(files_count(), 1);
    return name;
}

static ino_t file_identity(void)
{
    struct stat status;
    assert_int_equal(stat(files_path(file_name()), &status), 0);
    return status.st_ino;
}

static int forget(void **state)
{
    (void)state;
    if (files_count() > 0)
        unlink(files_path(file_name()));
    return 0;
}

static void a_second_start_gives_the_driver_what_the_first_saved(void **state)
{
    (void)state;
    start(files_path(""), 1);
    assert_int_equal(driver.given_size, 0);
    start(files_path(""), 2);
    assert_given(1);
    start(files_path(""), 2);
    assert_given(2);
    file_name();
}

static void nothing_is_written_when_nothing_has_changed(void **state)
{
    (void)state;
    start(files_path(""), 1);
    const ino_t before = file_identity();
    start(files_path(""), 1);
    assert_true(file_identity() == before);
    start(files_path(""), 2);
    assert_true(file_identity() != before);
}

static void a_damaged_file_never_reaches_the_driver_and_is_replaced(void **state)
{
    (void)state;
    start(files_path(""), 1);
    files_write_text(file_name(), "neither a cache nor anything else");
    start(files_path(""), 1);
    assert_int_equal(driver.created, 1);
    assert_int_equal(driver.given_size, 0);
    start(files_path(""), 1);
    assert_given(1);
}

/* The checksum is right, but the data is another driver's or shorter than a header. */
static void data_of_another_driver_never_reaches_this_one(void **state)
{
    (void)state;
    start(files_path(""), 1);
    for (size_t i = 0; i < sizeof header; i++) {
        uint8_t data[DATA_BYTES];
        memcpy(data, driver.holds, sizeof data);
        data[i] ^= 0x80;
        assert_true(cache_file_save(files_path(file_name()), data, sizeof data));
        start(files_path(""), 1);
        assert_int_equal(driver.given_size, 0);
    }
    assert_true(cache_file_save(files_path(file_name()), &header, sizeof header - 1));
    start(files_path(""), 1);
    assert_int_equal(driver.given_size, 0);
}

static void without_a_folder_nothing_is_kept(void **state)
{
    (void)state;
    start(NULL, 1);
    assert_int_equal(driver.created, 0);
    assert_int_equal(files_count(), 0);
}

static void a_folder_that_cannot_be_made_is_no_harm(void **state)
{
    (void)state;
    char folder[512];
    files_write_text("file", "a file where a folder should be");
    snprintf(folder, sizeof folder, "%s/file/sdfgi", files_path(""));
    start(folder, 1);
    assert_string_equal(file_name(), "file");
}

int main(void)
{
    if (!find_header())
        return SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(a_second_start_gives_the_driver_what_the_first_saved, forget),
        cmocka_unit_test_teardown(nothing_is_written_when_nothing_has_changed, forget),
        cmocka_unit_test_teardown(a_damaged_file_never_reaches_the_driver_and_is_replaced, forget),
        cmocka_unit_test_teardown(data_of_another_driver_never_reaches_this_one, forget),
        cmocka_unit_test_teardown(without_a_folder_nothing_is_kept, forget),
        cmocka_unit_test_teardown(a_folder_that_cannot_be_made_is_no_harm, forget),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
