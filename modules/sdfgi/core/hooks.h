/* SPDX-License-Identifier: MIT
 * What the host hands over for messages and memory. */
#ifndef SDFGI_HOOKS_H
#define SDFGI_HOOKS_H

#include <sdfgi/sdfgi.h>

#include <stdatomic.h>

struct hooks {
    struct sdfgi_log log;
    bool log_info;
    struct sdfgi_allocator allocator;
    atomic_bool device_lost;
};

void sdfgi_message_log(const struct hooks *hooks, enum sdfgi_message id, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
const char *sdfgi_message_hint(enum sdfgi_message id);
/* Reports a failed Vulkan call and turns it into a result. Notes that the device was lost. */
enum sdfgi_result sdfgi_message_vulkan(struct hooks *hooks, VkResult result, const char *what);
/* Reports that a call broke a documented rule. */
enum sdfgi_result sdfgi_message_invalid(const struct hooks *hooks, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* NULL if memory is short. */
void *sdfgi_hooks_alloc(const struct hooks *hooks, size_t size);
/* The same, filled with zeros. */
void *sdfgi_hooks_alloc_zeroed(const struct hooks *hooks, size_t size);
/* NULL is accepted. */
void sdfgi_hooks_free(const struct hooks *hooks, void *memory);

#endif
