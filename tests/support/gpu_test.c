/* SPDX-License-Identifier: MIT */
#include "gpu_test.h"

#include "gpu_test_check.h"
#include "gpu_test_compute.h"
#include "test_memory.h"
#include "require.h"

#include <vulkan/vulkan.h>

#include <stdio.h>
#include <stdlib.h>

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

/* Messages that are known to be wrong. A row names the message id, or the start of it, and says why. */
static const struct {
    const char *id;
    const char *reason;
} waivers[] = {
    { NULL, NULL },
};

static bool message_is_waived(const char *id)
{
    for (size_t i = 0; id && waivers[i].id; i++)
        if (strncmp(id, waivers[i].id, strlen(waivers[i].id)) == 0)
            return true;
    return false;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL message_receive(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                      VkDebugUtilsMessageTypeFlagsEXT types,
                                                      const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                      void *user)
{
    struct gpu_test_messages *messages = user;
    (void)types;
    const bool error = severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    if (message_is_waived(data->pMessageIdName)) {
        messages->waived++;
        return VK_FALSE;
    }
    messages->errors += error;
    messages->warnings += !error;
    if (!messages->quiet)
        fprintf(stderr, "validation %s: %s\n", error ? "error" : "warning", data->pMessage);
    return VK_FALSE;
}

/* ---- Instance ---- */

static bool validation_is_wanted(void)
{
    const char *wanted = getenv("SDFGI_TEST_VALIDATION");
    return !wanted || strcmp(wanted, "0") != 0;
}

static void require_validation_layer(void)
{
    uint32_t count = 0;
    GPU_CHECK(vkEnumerateInstanceLayerProperties(&count, NULL));
    VkLayerProperties *layers = test_array_alloc(count, sizeof *layers);
    GPU_CHECK(vkEnumerateInstanceLayerProperties(&count, layers));
    bool found = false;
    for (uint32_t i = 0; i < count; i++)
        found = found || strcmp(layers[i].layerName, validation_layer) == 0;
    free(layers);
    if (!found)
        require_fail(__FILE__, __LINE__, "%s is not installed (set SDFGI_TEST_VALIDATION=0 to do without)",
                     validation_layer);
}

static VkInstance instance_create(const void *next, bool validation)
{
    const char *const layers[] = { validation_layer };
    const char *const extensions[] = { VK_EXT_DEBUG_UTILS_EXTENSION_NAME };
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "sdfgi tests",
        .apiVersion = VK_API_VERSION_1_2,
    };
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = next,
        .pApplicationInfo = &application,
        .enabledLayerCount = validation ? 1 : 0,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = validation ? 1 : 0,
        .ppEnabledExtensionNames = extensions,
    };
    VkInstance instance = VK_NULL_HANDLE;
    return vkCreateInstance(&info, NULL, &instance) == VK_SUCCESS ? instance : VK_NULL_HANDLE;
}

static VkDebugUtilsMessengerCreateInfoEXT messenger_info(struct gpu_test_messages *messages)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType =
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = message_receive,
        .pUserData = messages,
    };
}

/* The messenger is chained to the instance too: creating and destroying it is watched as well. */
static void open_validated_instance(struct gpu_test *gpu)
{
    require_validation_layer();
    /* The layer of 1.3.239 has no API for hazards between submissions. A value of the user's is kept. */
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 0);
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
    };
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enabled,
    };
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(gpu->messages);
    messenger.pNext = &features;
    gpu->instance = instance_create(&messenger, true);
    REQUIRE_TRUE(gpu->instance != VK_NULL_HANDLE);
    messenger.pNext = NULL;
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(gpu->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    GPU_CHECK(create(gpu->instance, &messenger, NULL, &gpu->messenger));
}

/* ---- Device ---- */

/* All devices; the caller frees the array. */
static VkPhysicalDevice *devices_list(VkInstance instance, uint32_t *count)
{
    *count = 0;
    if (vkEnumeratePhysicalDevices(instance, count, NULL) != VK_SUCCESS)
        *count = 0;
    VkPhysicalDevice *devices = test_array_alloc(*count, sizeof *devices);
    if (*count && vkEnumeratePhysicalDevices(instance, count, devices) != VK_SUCCESS)
        *count = 0;
    return devices;
}

bool gpu_test_available(void)
{
    VkInstance instance = instance_create(NULL, false);
    uint32_t count = 0;
    if (instance) {
        free(devices_list(instance, &count));
        vkDestroyInstance(instance, NULL);
    }
    if (!count)
        fprintf(stderr, "skipped: no Vulkan device\n");
    return count > 0;
}

/* Index of the device that `wanted` names by number or by part of its name; `count` if there is none. */
static uint32_t device_find(const VkPhysicalDevice *devices, uint32_t count, const char *wanted)
{
    char *end;
    const unsigned long index = strtoul(wanted, &end, 10);
    if (*wanted && !*end)
        return index < count ? (uint32_t)index : count;
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (strstr(properties.deviceName, wanted))
            return i;
    }
    return count;
}

static uint32_t device_default(const VkPhysicalDevice *devices, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU)
            return i;
    }
    return 0;
}

static void choose_device(struct gpu_test *gpu)
{
    uint32_t count;
    VkPhysicalDevice *devices = devices_list(gpu->instance, &count);
    const char *wanted = getenv("SDFGI_TEST_DEVICE");
    const uint32_t index = wanted ? device_find(devices, count, wanted) : device_default(devices, count);
    if (index < count)
        gpu->physical_device = devices[index];
    free(devices);
    if (index >= count)
        require_fail(__FILE__, __LINE__, "no device '%s' among %u (SDFGI_TEST_DEVICE)", wanted ? wanted : "",
                     count);
    vkGetPhysicalDeviceProperties(gpu->physical_device, &gpu->properties);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical_device, &gpu->memory_properties);
}

static uint32_t queue_family_find(VkPhysicalDevice physical_device)
{
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[32];
    uint32_t count = sizeof families / sizeof *families;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & wanted) == wanted)
            return i;
    require_fail(__FILE__, __LINE__, "no queue family with graphics and compute");
    return 0;
}

static struct sdfgi_requirements requirements_get(const struct gpu_test *gpu, gpu_test_requirements_fn fn)
{
    struct sdfgi_requirements requirements = {
        .supported = true,
        .features_12 = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES },
    };
    if (!fn)
        return requirements;
    REQUIRE_CMP(fn(gpu->instance, gpu->physical_device, vkGetInstanceProcAddr, &requirements), ==, SDFGI_OK);
    if (!requirements.supported)
        require_fail(__FILE__, __LINE__, "%s is not supported: %s", gpu->properties.deviceName,
                     requirements.reason_count ? requirements.reasons[0] : "no reason given");
    return requirements;
}

static void open_device(struct gpu_test *gpu, gpu_test_requirements_fn requirements_fn)
{
    struct sdfgi_requirements requirements = requirements_get(gpu, requirements_fn);
    gpu->queue_family_index = queue_family_find(gpu->physical_device);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = gpu->queue_family_index,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &requirements.features_12,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = requirements.extension_count,
        .ppEnabledExtensionNames = requirements.extensions,
        .pEnabledFeatures = &requirements.features,
    };
    GPU_CHECK(vkCreateDevice(gpu->physical_device, &info, NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->queue_family_index, 0, &gpu->queue);
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT | VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = gpu->queue_family_index,
    };
    GPU_CHECK(vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->command_pool));
}

void gpu_test_open(struct gpu_test *gpu, gpu_test_requirements_fn requirements)
{
    *gpu = (struct gpu_test){ .messages = test_array_alloc(1, sizeof *gpu->messages) };
    *gpu->messages = (struct gpu_test_messages){ 0 };
    if (validation_is_wanted())
        open_validated_instance(gpu);
    else
        gpu->instance = instance_create(NULL, false);
    REQUIRE_TRUE(gpu->instance != VK_NULL_HANDLE);
    choose_device(gpu);
    open_device(gpu, requirements);
}

struct gpu_test_messages gpu_test_take_messages(struct gpu_test *gpu)
{
    const struct gpu_test_messages taken = *gpu->messages;
    *gpu->messages = (struct gpu_test_messages){ .quiet = taken.quiet };
    return taken;
}

struct gpu_test_messages gpu_test_destroy(struct gpu_test *gpu)
{
    if (gpu->device) {
        gpu_test_compute_forget(gpu);
        vkDestroyCommandPool(gpu->device, gpu->command_pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->messenger) {
        const PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(gpu->instance,
                                                                       "vkDestroyDebugUtilsMessengerEXT");
        destroy(gpu->instance, gpu->messenger, NULL);
    }
    if (gpu->instance)
        vkDestroyInstance(gpu->instance, NULL);
    const struct gpu_test_messages messages = gpu_test_take_messages(gpu);
    free(gpu->messages);
    *gpu = (struct gpu_test){ 0 };
    return messages;
}

static void require_silence(struct gpu_test_messages messages)
{
    REQUIRE_CMP(messages.errors, ==, 0);
    REQUIRE_CMP(messages.warnings, ==, 0);
}

void gpu_test_require_silence(struct gpu_test *gpu)
{
    require_silence(gpu_test_take_messages(gpu));
}

bool gpu_test_is_software(const struct gpu_test *gpu)
{
    return gpu->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

uint32_t gpu_test_repeats(const struct gpu_test *gpu, uint32_t count)
{
    return gpu_test_is_software(gpu) ? (count + 15) / 16 : count;
}

void gpu_test_close(struct gpu_test *gpu)
{
    require_silence(gpu_test_destroy(gpu));
}

/* ---- Work ---- */

static VkCommandBuffer command_allocate(struct gpu_test *gpu)
{
    const VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = gpu->command_pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    VkCommandBuffer cmd;
    GPU_CHECK(vkAllocateCommandBuffers(gpu->device, &allocate, &cmd));
    return cmd;
}

/* Begins a command buffer, an idle one if there is any: the validation layers keep 13 KB of each one that was
 * freed, until the device goes. */
static VkCommandBuffer command_begin(struct gpu_test *gpu)
{
    const VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    VkCommandBuffer cmd = gpu->idle_count > 0 ? gpu->idle[--gpu->idle_count] : command_allocate(gpu);
    GPU_CHECK(vkBeginCommandBuffer(cmd, &begin));
    return cmd;
}

static void command_release(struct gpu_test *gpu, VkCommandBuffer cmd)
{
    if (gpu->idle_count < GPU_TEST_IDLE_MOST)
        gpu->idle[gpu->idle_count++] = cmd;
    else
        vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &cmd);
}

/* Makes all writes visible to the host, and to nothing else: barriers between device work stay the business
 * of whoever records it. */
static void command_end(VkCommandBuffer cmd)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier,
                         0, NULL, 0, NULL);
    GPU_CHECK(vkEndCommandBuffer(cmd));
}

void gpu_test_submit_many(struct gpu_test *gpu, uint32_t count, gpu_test_record_fn record, void *user)
{
    VkCommandBuffer *commands = test_array_alloc(count, sizeof(VkCommandBuffer));
    for (uint32_t i = 0; i < count; i++) {
        commands[i] = command_begin(gpu);
        record(commands[i], i, user);
        command_end(commands[i]);
        const VkSubmitInfo submit = {
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
            .commandBufferCount = 1,
            .pCommandBuffers = &commands[i],
        };
        GPU_CHECK(vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE));
    }
    GPU_CHECK(vkQueueWaitIdle(gpu->queue));
    for (uint32_t i = 0; i < count; i++)
        command_release(gpu, commands[i]);
    free(commands);
}

void gpu_test_record_and_drop(struct gpu_test *gpu, gpu_test_record_fn record, void *user)
{
    VkCommandBuffer cmd = command_begin(gpu);
    record(cmd, 0, user);
    command_end(cmd);
    command_release(gpu, cmd);
}

void gpu_test_submit(struct gpu_test *gpu, gpu_test_record_fn record, void *user)
{
    gpu_test_submit_many(gpu, 1, record, user);
}
