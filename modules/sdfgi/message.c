/* SPDX-License-Identifier: MIT */
#include "internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const struct {
    enum sdfgi_log_level level;
    const char *hint;
} rows[SDFGI_MESSAGE_COUNT] = {
#define ROW(id, level, hint) [SDFGI_MESSAGE_##id] = { SDFGI_LOG_##level, hint },
    SDFGI_MESSAGES(ROW)
#undef ROW
};

const char *message_hint(enum sdfgi_message id)
{
    return rows[id].hint;
}

static void send(const struct sdfgi *gi, enum sdfgi_message id, const char *format, va_list arguments)
{
    if (!gi->log.fn)
        return;
    char text[256];
    vsnprintf(text, sizeof text, format, arguments);
    gi->log.fn(gi->log.user, rows[id].level, id, text);
}

void message(const struct sdfgi *gi, enum sdfgi_message id, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(gi, id, format, arguments);
    va_end(arguments);
}

enum sdfgi_result invalid(const struct sdfgi *gi, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    send(gi, SDFGI_MESSAGE_INVALID_ARGUMENT, format, arguments);
    va_end(arguments);
    return SDFGI_ERROR_INVALID_ARGUMENT;
}

enum sdfgi_result message_vulkan(struct sdfgi *gi, VkResult result, const char *what)
{
    switch (result) {
    case VK_SUCCESS:
        return SDFGI_OK;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        message(gi, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "%s: out of host memory", what);
        return SDFGI_ERROR_OUT_OF_MEMORY;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
        message(gi, SDFGI_MESSAGE_OUT_OF_DEVICE_MEMORY, "%s: out of device memory", what);
        return SDFGI_ERROR_OUT_OF_MEMORY;
    case VK_ERROR_DEVICE_LOST:
        gi->device_lost = true;
        message(gi, SDFGI_MESSAGE_DEVICE_LOST, "%s: the device was lost", what);
        return SDFGI_ERROR_DEVICE_LOST;
    default:
        message(gi, SDFGI_MESSAGE_VULKAN_FAILURE, "%s: VkResult %d", what, (int)result);
        return SDFGI_ERROR_UNSUPPORTED;
    }
}

void *host_alloc(const struct sdfgi_allocator *allocator, size_t size)
{
    return allocator->alloc ? allocator->alloc(allocator->user, size) : malloc(size);
}

void host_free(const struct sdfgi_allocator *allocator, void *memory)
{
    if (!memory)
        return;
    if (allocator->alloc)
        allocator->free(allocator->user, memory);
    else
        free(memory);
}
