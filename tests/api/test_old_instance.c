/* SPDX-License-Identifier: MIT
 * Instances that were made for a version of Vulkan below 1.2: nothing is called that they do not have, and
 * sdfgi_create says what is wrong. */
#include "gpu_test.h"
#include "require.h"
#include "test_group.h"

#include <string.h>
#include <vulkan/vulkan.h>

static uint32_t refused, layer_messages;

static void count_refusal(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)level;
    refused += id == SDFGI_MESSAGE_UNSUPPORTED_DEVICE && strstr(text, "VkApplicationInfo::apiVersion");
}

static VKAPI_ATTR VkBool32 VKAPI_CALL count_layer_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                          VkDebugUtilsMessageTypeFlagsEXT types,
                                                          const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                          void *user)
{
    (void)severity;
    (void)types;
    (void)data;
    (void)user;
    layer_messages++;
    return VK_FALSE;
}

static VkInstance make_instance(uint32_t version, bool validated)
{
    const char *const layers[] = { "VK_LAYER_KHRONOS_validation" };
    const char *const extensions[] = { VK_EXT_DEBUG_UTILS_EXTENSION_NAME };
    const VkApplicationInfo app = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = version };
    const VkInstanceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &app,
                                        .enabledLayerCount = validated,
                                        .ppEnabledLayerNames = layers,
                                        .enabledExtensionCount = validated,
                                        .ppEnabledExtensionNames = extensions };
    VkInstance instance = VK_NULL_HANDLE;
    return vkCreateInstance(&info, NULL, &instance) == VK_SUCCESS ? instance : VK_NULL_HANDLE;
}

static VkDebugUtilsMessengerEXT listen(VkInstance instance)
{
    const VkDebugUtilsMessengerCreateInfoEXT info = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = count_layer_message,
    };
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT");
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    REQUIRE_CMP((int)create(instance, &info, NULL, &messenger), ==, (int)VK_SUCCESS);
    return messenger;
}

static void stop_listening(VkInstance instance, VkDebugUtilsMessengerEXT messenger)
{
    ((PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"))(
        instance, messenger, NULL);
}

static VkPhysicalDevice first_device(VkInstance instance)
{
    uint32_t count = 1;
    VkPhysicalDevice device = VK_NULL_HANDLE;
    vkEnumeratePhysicalDevices(instance, &count, &device);
    REQUIRE_TRUE(device != VK_NULL_HANDLE);
    return device;
}

static VkDevice make_device(VkPhysicalDevice physical)
{
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = { .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority };
    const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue };
    VkDevice device = VK_NULL_HANDLE;
    REQUIRE_CMP((int)vkCreateDevice(physical, &info, NULL, &device), ==, (int)VK_SUCCESS);
    return device;
}

/* What sdfgi_create makes of an instance of `version`, of which the host says `said`. */
static enum sdfgi_result create_on(uint32_t version, uint32_t said)
{
    const VkInstance instance = make_instance(version, false);
    REQUIRE_TRUE(instance != VK_NULL_HANDLE);
    const VkPhysicalDevice physical = first_device(instance);
    const VkDevice device = make_device(physical);
    const struct sdfgi_desc desc = { .vulkan = { .instance = instance,
                                                 .physical_device = physical,
                                                 .device = device,
                                                 .get_instance_proc_addr = vkGetInstanceProcAddr,
                                                 .api_version = said },
                                     .log = { count_refusal, NULL } };
    sdfgi *gi = NULL;
    refused = 0;
    const enum sdfgi_result result = sdfgi_create(&desc, &gi);
    sdfgi_destroy(gi);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
    return result;
}

static void requirements_call_nothing_that_vulkan_1_0_lacks(void **state)
{
    (void)state;
    const VkInstance instance = make_instance(VK_API_VERSION_1_0, true);
    if (!instance)
        skip();
    struct sdfgi_requirements needs;
    const VkDebugUtilsMessengerEXT messenger = listen(instance);
    layer_messages = 0;
    REQUIRE_CMP((int)sdfgi_get_requirements(instance, first_device(instance), vkGetInstanceProcAddr, &needs),
                ==, (int)SDFGI_OK);
    REQUIRE_CMP(layer_messages, ==, 0u);
    REQUIRE_CMP(needs.api_version, ==, (uint32_t)VK_API_VERSION_1_2);
    stop_listening(instance, messenger);
    vkDestroyInstance(instance, NULL);
}

static void a_version_that_the_host_says_is_too_low_is_refused(void **state)
{
    (void)state;
    REQUIRE_CMP((int)create_on(VK_API_VERSION_1_2, VK_API_VERSION_1_1), ==, (int)SDFGI_ERROR_UNSUPPORTED);
    REQUIRE_CMP(refused, ==, 1u);
    REQUIRE_CMP((int)create_on(VK_API_VERSION_1_2, VK_API_VERSION_1_2), ==, (int)SDFGI_OK);
    REQUIRE_CMP(refused, ==, 0u);
}

/* Mesa's drivers have no functions of later versions than the instance's. */
static bool driver_shows_versions(void)
{
    const VkInstance instance = make_instance(VK_API_VERSION_1_0, false);
    const VkDevice device = make_device(first_device(instance));
    const bool shows = !vkGetDeviceProcAddr(device, "vkCreateRenderPass2");
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
    return shows;
}

static void a_version_that_the_driver_shows_is_too_low_is_refused(void **state)
{
    (void)state;
    if (!driver_shows_versions())
        skip();
    for (uint32_t minor = 0; minor < 2; minor++) {
        REQUIRE_CMP((int)create_on(VK_MAKE_API_VERSION(0, 1, minor, 0), 0), ==, (int)SDFGI_ERROR_UNSUPPORTED);
        REQUIRE_CMP(refused, ==, 1u);
    }
}

TEST_GROUP(old_instance)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(requirements_call_nothing_that_vulkan_1_0_lacks),
        cmocka_unit_test(a_version_that_the_host_says_is_too_low_is_refused),
        cmocka_unit_test(a_version_that_the_driver_shows_is_too_low_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
