/* SPDX-License-Identifier: MIT
 * For the parts of gpu_test alone: a Vulkan call that must succeed. */
#ifndef TEST_GPU_TEST_CHECK_H
#define TEST_GPU_TEST_CHECK_H

#include "require.h"

#define GPU_CHECK(call)                                                                                      \
    do {                                                                                                     \
        const VkResult gpu_check_result = (call);                                                            \
        if (gpu_check_result != VK_SUCCESS)                                                                  \
            require_fail(__FILE__, __LINE__, "%s: VkResult %d", #call, (int)gpu_check_result);               \
    } while (0)

#endif
