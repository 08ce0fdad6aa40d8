/* SPDX-License-Identifier: MIT
 * What is preloaded into a program to make its k-th call fail, and to see what it leaves behind. The
 * environment says which, see fault_plan_read; what happened is written to a file when the program ends. */
#ifndef FAULT_H
#define FAULT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "fallible_vulkan.h"

enum fault_kind { FAULT_NONE, FAULT_HOST, FAULT_DEVICE, FAULT_LOST, FAULT_ALLOCATION };

/* Counts a Vulkan call that can return `errors`: VK_SUCCESS, or what it has to return. A lost device stays
 * lost. */
VkResult fault_vulkan(const char *name, enum fallible_error errors);

/* Counts an allocation of the program's from `site`; whether it has to fail. */
bool fault_allocation(uint64_t site, size_t size);

/* A line of the report about a call that breaks a rule of Vulkan. */
void fault_misuse(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Lines of the report about what lives still. */
void fault_memory_report(FILE *out);
void null_vulkan_report(FILE *out);

#endif
