/* SPDX-License-Identifier: MIT
 * Which call fails, and the report. SDFGI_FAULT is "KIND K FILE": the K-th call of that kind fails, none if K
 * is 0, and FILE gets the report:
 *   calls N           of that kind in all
 *   call I NAME       each of them, if K is 0
 *   failed NAME       the one that failed
 *   misuse TEXT       a rule of Vulkan was broken
 *   leak TEXT         something lived when the program ended */
#define _GNU_SOURCE
#include "fault.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_SECONDS = 120 }; /* no failure may make a program hang */

static struct {
    enum fault_kind kind;
    uint32_t at, calls;
    bool lost;
    FILE *report;
} plan;

static const struct {
    const char *name;
    enum fallible_error error;
    VkResult result;
} kinds[] = {
    [FAULT_NONE] = { "none", 0, VK_SUCCESS },
    [FAULT_HOST] = { "host", FALLIBLE_HOST, VK_ERROR_OUT_OF_HOST_MEMORY },
    [FAULT_DEVICE] = { "device", FALLIBLE_DEVICE, VK_ERROR_OUT_OF_DEVICE_MEMORY },
    [FAULT_LOST] = { "lost", FALLIBLE_LOST, VK_ERROR_DEVICE_LOST },
    [FAULT_ALLOCATION] = { "allocation", 0, VK_SUCCESS },
};

/* Programs that the program starts are left alone. */
__attribute__((constructor)) static void fault_plan_read(void)
{
    const char *const text = getenv("SDFGI_FAULT");
    static char buffer[1 << 16];
    char name[16], path[4096];
    if (!text || sscanf(text, "%15s %u %4095s", name, &plan.at, path) != 3)
        return;
    unsetenv("LD_PRELOAD");
    if (plan.at > 0)
        alarm(MOST_SECONDS);
    plan.report = fopen(path, "w");
    if (plan.report) /* memory of its own: writing must not allocate */
        setvbuf(plan.report, buffer, _IOFBF, sizeof buffer);
    for (size_t i = 0; plan.report && i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(kinds[i].name, name) == 0)
            plan.kind = (enum fault_kind)i;
}

__attribute__((destructor)) static void fault_plan_report(void)
{
    if (!plan.report)
        return;
    fprintf(plan.report, "calls %u\n", plan.calls);
    fault_memory_report(plan.report);
    null_vulkan_report(plan.report);
    fclose(plan.report);
}

static bool count(const char *name)
{
    const uint32_t call = __atomic_add_fetch(&plan.calls, 1, __ATOMIC_RELAXED);
    if (plan.at == 0)
        fprintf(plan.report, "call %u %s\n", call, name);
    else if (call == plan.at)
        fprintf(plan.report, "failed %s\n", name);
    if (call == plan.at) /* a crash must not lose it */
        fflush(plan.report);
    return call == plan.at;
}

VkResult fault_vulkan(const char *name, enum fallible_error errors)
{
    if (!(errors & kinds[plan.kind].error))
        return VK_SUCCESS;
    if (!count(name) && !plan.lost)
        return VK_SUCCESS;
    plan.lost = plan.kind == FAULT_LOST;
    return kinds[plan.kind].result;
}

bool fault_allocation(uint64_t site, size_t size)
{
    char name[64];
    if (plan.kind != FAULT_ALLOCATION)
        return false;
    snprintf(name, sizeof name, "%llx %zu", (unsigned long long)site, size);
    return count(name);
}

void fault_misuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    FILE *const out = plan.report ? plan.report : stderr;
    fputs("misuse ", out);
    vfprintf(out, format, arguments);
    fputc('\n', out);
    fflush(out);
    va_end(arguments);
}
