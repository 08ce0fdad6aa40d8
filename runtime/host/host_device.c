/* SPDX-License-Identifier: MIT
 * Instance, choice of the physical device, logical device. */
#include "host_internal.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";
static const char no_device[] = "no Vulkan device found: install a driver (Mesa's lavapipe runs on any CPU)";

static const char *result_text(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no compatible driver";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "the window surface was lost";
    default:
        return "Vulkan call failed";
    }
}

bool host_fail(struct host_device *device, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(device->error, sizeof(device->error), format, arguments);
    va_end(arguments);
    return false;
}

bool host_check(struct host_device *device, VkResult result, const char *what)
{
    if (result >= 0)
        return true;
    return host_fail(device, "%s: %s (VkResult %d)", what, result_text(result), (int)result);
}

void *host_device_alloc(struct host_device *device, size_t count, size_t size)
{
    void *memory = calloc(count > 0 ? count : 1, size);
    if (!memory)
        host_fail(device, "out of host memory");
    return memory;
}

const char *host_device_error(const struct host_device *device)
{
    return device->error;
}

uint32_t host_device_validation_count(const struct host_device *device)
{
    return device->validation_count;
}

void host_device_get_info(const struct host_device *device, struct host_device_info *info)
{
    *info = device->info;
}

/* ---- Instance --------------------------------------------------------------------------------------- */

static VKAPI_ATTR VkBool32 VKAPI_CALL message_received(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                       VkDebugUtilsMessageTypeFlagsEXT types,
                                                       const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                       void *user)
{
    struct host_device *device = user;
    (void)severity;
    (void)types;
    device->validation_count++;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

static bool validation_wanted(const struct host_device_desc *desc)
{
    const char *value = getenv("SDFGI_VALIDATION");
    return desc->validation || (value && strcmp(value, "") != 0 && strcmp(value, "0") != 0);
}

static bool validation_check(struct host_device *device)
{
    VkLayerProperties layers[64];
    uint32_t count = HOST_COUNT(layers);
    if (!host_check(device, vkEnumerateInstanceLayerProperties(&count, layers), "listing the layers"))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(layers[i].layerName, validation_layer) == 0)
            return true;
    }
    return host_fail(device, "validation was asked for, but %s is not installed", validation_layer);
}

/* Where there is no driver, the loader makes no instance or an instance without devices. */
static bool driver_check(struct host_device *device, VkResult result, const char *what)
{
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER || result == VK_ERROR_INITIALIZATION_FAILED)
        return host_fail(device, no_device);
    return host_check(device, result, what);
}

static VkDebugUtilsMessengerCreateInfoEXT messenger_info(struct host_device *device)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = message_received,
        .pUserData = device,
    };
}

static bool instance_version(struct host_device *device, uint32_t *version)
{
    if (!host_check(device, vkEnumerateInstanceVersion(version), "reading the version of Vulkan"))
        return false;
    if (*version < VK_API_VERSION_1_2)
        return host_fail(device, "the Vulkan loader is older than 1.2");
    *version = *version >= VK_API_VERSION_1_3 ? VK_API_VERSION_1_3 : VK_API_VERSION_1_2;
    return true;
}

static bool instance_create_plain(struct host_device *device, uint32_t version,
                                  const struct host_device_desc *desc)
{
    const VkApplicationInfo application = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .pApplicationName = "sdfgi",
                                            .apiVersion = version };
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
        .enabledExtensionCount = desc->instance_extension_count,
        .ppEnabledExtensionNames = desc->instance_extensions,
    };
    return driver_check(device, vkCreateInstance(&info, NULL, &device->instance), "creating the instance");
}

static bool instance_create_validated(struct host_device *device, uint32_t version,
                                      const struct host_device_desc *desc)
{
    if (!validation_check(device))
        return false;
    const char *extensions[16];
    uint32_t count = 0;
    for (; count < desc->instance_extension_count && count < HOST_COUNT(extensions) - 1; count++)
        extensions[count] = desc->instance_extensions[count];
    extensions[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;

    const VkApplicationInfo application = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .pApplicationName = "sdfgi",
                                            .apiVersion = version };
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(device);
    const VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
    };
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = HOST_COUNT(enables),
        .pEnabledValidationFeatures = enables,
    };
    const char *layers[] = { validation_layer };
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = &features,
        .pApplicationInfo = &application,
        .enabledLayerCount = 1,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    if (!driver_check(device, vkCreateInstance(&info, NULL, &device->instance), "creating the instance"))
        return false;
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(device->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    return !create || host_check(device, create(device->instance, &messenger, NULL, &device->messenger),
                                 "creating the validation messenger");
}

static bool instance_create(struct host_device *device, const struct host_device_desc *desc)
{
    uint32_t version = 0;
    if (!instance_version(device, &version))
        return false;
    return validation_wanted(desc) ? instance_create_validated(device, version, desc)
                                   : instance_create_plain(device, version, desc);
}

static void instance_destroy(struct host_device *device)
{
    if (device->messenger) {
        const PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(device->instance,
                                                                       "vkDestroyDebugUtilsMessengerEXT");
        destroy(device->instance, device->messenger, NULL);
    }
    if (device->instance)
        vkDestroyInstance(device->instance, NULL);
}

/* ---- Physical devices ------------------------------------------------------------------------------- */

static const char *type_name(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

/* Higher is better. */
static int type_rank(const char *type)
{
    static const char *const order[] = { "other", "cpu", "virtual", "integrated", "discrete" };
    for (int i = 0; i < (int)HOST_COUNT(order); i++) {
        if (strcmp(type, order[i]) == 0)
            return i;
    }
    return 0;
}

static uint32_t find_queue_family(VkPhysicalDevice physical, uint64_t *timestamp_mask)
{
    VkQueueFamilyProperties families[32];
    uint32_t count = HOST_COUNT(families);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; i++) {
        if ((families[i].queueFlags & wanted) != wanted)
            continue;
        const uint32_t bits = families[i].timestampValidBits;
        *timestamp_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
        return i;
    }
    return UINT32_MAX;
}

static void describe_usability(VkInstance instance, VkPhysicalDevice physical, struct host_device_info *info)
{
    uint64_t mask = 0;
    const enum sdfgi_result result =
        info->api_version >= VK_API_VERSION_1_2
            ? sdfgi_get_requirements(instance, physical, vkGetInstanceProcAddr, &info->requirements)
            : SDFGI_ERROR_UNSUPPORTED;
    if (info->api_version < VK_API_VERSION_1_2)
        snprintf(info->reason, sizeof(info->reason), "supports only Vulkan %u.%u, 1.2 is needed",
                 VK_API_VERSION_MAJOR(info->api_version), VK_API_VERSION_MINOR(info->api_version));
    else if (find_queue_family(physical, &mask) == UINT32_MAX)
        snprintf(info->reason, sizeof(info->reason), "has no queue for both graphics and compute");
    else if (result != SDFGI_OK)
        snprintf(info->reason, sizeof(info->reason), "its requirements could not be read");
    else if (!info->requirements.supported)
        snprintf(info->reason, sizeof(info->reason), "%.96s",
                 info->requirements.reason_count > 0 ? info->requirements.reasons[0] : "not supported");
    info->usable = info->reason[0] == '\0';
}

static void describe(VkInstance instance, VkPhysicalDevice physical, uint32_t index,
                     struct host_device_info *info)
{
    VkPhysicalDeviceDriverProperties driver = { .sType =
                                                    VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES };
    VkPhysicalDeviceProperties2 properties = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2 };
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceProperties(physical, &properties.properties);
    if (properties.properties.apiVersion >= VK_API_VERSION_1_2) {
        properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(physical, &properties);
    }
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    *info = (struct host_device_info){ .index = index, .api_version = properties.properties.apiVersion };
    snprintf(info->name, sizeof(info->name), "%s", properties.properties.deviceName);
    snprintf(info->driver, sizeof(info->driver), "%s %s", driver.driverName, driver.driverInfo);
    info->type = type_name(properties.properties.deviceType);
    info->is_cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++) {
        const VkMemoryHeap heap = memory.memoryHeaps[i];
        if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && heap.size > info->local_bytes)
            info->local_bytes = heap.size;
    }
    describe_usability(instance, physical, info);
}

enum { MAX_DEVICES = 32 };

/* Returns the number of devices, 0 with the error set if there is none. */
static uint32_t enumerate(struct host_device *device, VkPhysicalDevice physical[MAX_DEVICES])
{
    uint32_t count = MAX_DEVICES;
    if (!driver_check(device, vkEnumeratePhysicalDevices(device->instance, &count, physical),
                      "listing the devices"))
        return 0;
    if (count == 0)
        host_fail(device, no_device);
    return count;
}

static bool contains_ignoring_case(const char *text, const char *part)
{
    for (; *text; text++) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (!part[i])
            return true;
    }
    return false;
}

static bool selected(const char *select, const struct host_device_info *info)
{
    char *end = NULL;
    const unsigned long index = strtoul(select, &end, 10);
    return isdigit((unsigned char)select[0]) && *end == '\0' ? index == info->index
                                                             : contains_ignoring_case(info->name, select);
}

static bool choose(struct host_device *device, const char *select)
{
    VkPhysicalDevice physical[MAX_DEVICES];
    const uint32_t count = enumerate(device, physical);
    int best = -1;
    bool matched = false;
    char reason[sizeof(device->error)] = "";
    for (uint32_t i = 0; i < count; i++) {
        struct host_device_info info;
        describe(device->instance, physical[i], i, &info);
        if (select && !selected(select, &info))
            continue;
        matched = true;
        if (!info.usable)
            snprintf(reason, sizeof(reason), "device %u (%.100s) cannot be used: %.100s", i, info.name,
                     info.reason);
        else if (type_rank(info.type) > best) {
            best = type_rank(info.type);
            device->physical = physical[i];
            device->info = info;
        }
    }
    if (best >= 0)
        return true;
    if (count > 0 && !matched)
        return host_fail(device, "no Vulkan device matches '%.100s'; `sdfgi info` lists them", select);
    return count > 0 ? host_fail(device, "%s", reason) : false;
}

uint32_t host_device_list(struct host_device_info *infos, uint32_t capacity, char *error, size_t error_size)
{
    struct host_device device = { 0 };
    VkPhysicalDevice physical[MAX_DEVICES];
    uint32_t count = 0;
    if (instance_create(&device, &(struct host_device_desc){ 0 }))
        count = enumerate(&device, physical);
    for (uint32_t i = 0; i < count && i < capacity; i++)
        describe(device.instance, physical[i], i, &infos[i]);
    if (count == 0)
        snprintf(error, error_size, "%s", device.error);
    instance_destroy(&device);
    return count;
}

/* ---- Logical device --------------------------------------------------------------------------------- */

static void choose_hdr_format(struct host_device *device)
{
    const VkFormatFeatureFlags wanted = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT |
                                        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                        VK_FORMAT_FEATURE_TRANSFER_SRC_BIT;
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device->physical, VK_FORMAT_R32G32B32A32_SFLOAT, &properties);
    device->hdr_format = (properties.optimalTilingFeatures & wanted) == wanted
                             ? VK_FORMAT_R32G32B32A32_SFLOAT
                             : VK_FORMAT_R16G16B16A16_SFLOAT;
}

static void query_device(struct host_device *device)
{
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceProperties(device->physical, &properties);
    vkGetPhysicalDeviceFeatures(device->physical, &features);
    vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    device->limits = properties.limits;
    device->anisotropy = features.samplerAnisotropy;
    device->queue_family = find_queue_family(device->physical, &device->timestamp_mask);
    choose_hdr_format(device);
}

static bool create_logical(struct host_device *device, const struct host_device_desc *desc)
{
    const struct sdfgi_requirements *need = &device->info.requirements;
    VkPhysicalDeviceVulkan12Features features_12 = need->features_12;
    VkPhysicalDeviceFeatures features = need->features;
    features.samplerAnisotropy = device->anisotropy;
    features_12.pNext = NULL;

    const char *extensions[SDFGI_MAX_EXTENSIONS + 1];
    uint32_t count = 0;
    for (; count < need->extension_count; count++)
        extensions[count] = need->extensions[count];
    if (desc->instance_extension_count > 0)
        extensions[count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;

    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = device->queue_family,
        .queueCount = 1,
        .pQueuePriorities = (const float[]){ 1.0f },
    };
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features_12,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
        .pEnabledFeatures = &features,
    };
    if (!host_check(device, vkCreateDevice(device->physical, &info, NULL, &device->device),
                    "creating the device"))
        return false;
    vkGetDeviceQueue(device->device, device->queue_family, 0, &device->queue);
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = device->queue_family,
    };
    return host_check(device, vkCreateCommandPool(device->device, &pool, NULL, &device->pool),
                      "creating a command pool");
}

static bool device_init(struct host_device *device, const struct host_device_desc *desc)
{
    if (!instance_create(device, desc) || !choose(device, desc->select))
        return false;
    query_device(device);
    if (!create_logical(device, desc))
        return false;
    host_cache_init(device, desc->cache_folder);
    return true;
}

struct host_device *host_device_create(const struct host_device_desc *desc, char *error, size_t error_size)
{
    struct host_device *device = calloc(1, sizeof(*device));
    if (!device) {
        snprintf(error, error_size, "out of host memory");
        return NULL;
    }
    if (!device_init(device, desc)) {
        snprintf(error, error_size, "%s", device->error);
        host_device_destroy(device);
        return NULL;
    }
    return device;
}

void host_device_destroy(struct host_device *device)
{
    if (!device)
        return;
    if (device->device) {
        host_cache_finish(device);
        vkDestroyCommandPool(device->device, device->pool, NULL);
        vkDestroyDevice(device->device, NULL);
    }
    instance_destroy(device);
    free(device);
}
