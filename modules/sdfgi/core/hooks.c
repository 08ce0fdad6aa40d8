/* SPDX-License-Identifier: MIT */
#include "hooks.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    enum sdfgi_log_level level;
    const char *hint;
} rows[SDFGI_MESSAGE_COUNT] = {
#define ROW(id, level, hint) [SDFGI_MESSAGE_##id] = { SDFGI_LOG_##level, hint },
    SDFGI_MESSAGES(ROW)
#undef ROW
};

const char *sdfgi_message_hint(enum sdfgi_message id)
{
    return rows[id].hint;
}

static void send(const struct hooks *hooks, enum sdfgi_message id, const char *format, va_list arguments)
{
    if (!hooks->log.fn || (rows[id].level == SDFGI_LOG_INFO && !hooks->log_info))
        return;
    char text[256];
    vsnprintf(text, sizeof text, format, arguments);
    hooks->log.fn(hooks->log.user, rows[id].level, id, text);
}

void sdfgi_message_log(const struct hooks *hooks, enum sdfgi_message id, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(hooks, id, format, arguments);
    va_end(arguments);
}

enum sdfgi_result sdfgi_message_invalid(const struct hooks *hooks, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(hooks, SDFGI_MESSAGE_INVALID_ARGUMENT, format, arguments);
    va_end(arguments);
    return SDFGI_ERROR_INVALID_ARGUMENT;
}

enum sdfgi_result sdfgi_message_vulkan(struct hooks *hooks, VkResult result, const char *what)
{
    switch (result) {
    case VK_SUCCESS:
        return SDFGI_OK;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        sdfgi_message_log(hooks, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "%s: out of host memory", what);
        return SDFGI_ERROR_OUT_OF_MEMORY;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
        sdfgi_message_log(hooks, SDFGI_MESSAGE_OUT_OF_DEVICE_MEMORY, "%s: out of device memory", what);
        return SDFGI_ERROR_OUT_OF_MEMORY;
    case VK_ERROR_DEVICE_LOST:
        hooks->device_lost = true;
        sdfgi_message_log(hooks, SDFGI_MESSAGE_DEVICE_LOST, "%s: the device was lost", what);
        return SDFGI_ERROR_DEVICE_LOST;
    case VK_ERROR_VALIDATION_FAILED_EXT: /* of the host's allocator: what is wrong has been said */
        return SDFGI_ERROR_INVALID_ARGUMENT;
    default:
        sdfgi_message_log(hooks, SDFGI_MESSAGE_VULKAN_FAILURE, "%s: VkResult %d", what, (int)result);
        return SDFGI_ERROR_UNSUPPORTED;
    }
}

void *sdfgi_hooks_alloc(const struct hooks *hooks, size_t size)
{
    const struct sdfgi_allocator *a = &hooks->allocator;
    return a->alloc ? a->alloc(a->user, size) : malloc(size);
}

void *sdfgi_hooks_alloc_zeroed(const struct hooks *hooks, size_t size)
{
    void *memory = sdfgi_hooks_alloc(hooks, size);
    return memory ? memset(memory, 0, size) : NULL;
}

void sdfgi_hooks_free(const struct hooks *hooks, void *memory)
{
    const struct sdfgi_allocator *a = &hooks->allocator;
    if (!memory)
        return;
    if (a->free)
        a->free(a->user, memory);
    else
        free(memory);
}
