/* SPDX-License-Identifier: MIT
 * sdfgi_estimate_memory. Needs no device. */
#include "pass/resource_rows.h"
#include "pass/work.h"

#include <string.h>

const char *sdfgi_memory_category_name(enum sdfgi_memory_category category)
{
    static const char *const names[SDFGI_MEMORY_CATEGORY_COUNT] = {
        [SDFGI_MEMORY_VOLUMES] = "volumes",   [SDFGI_MEMORY_PROBES] = "probes",
        [SDFGI_MEMORY_SCRATCH] = "scratch",   [SDFGI_MEMORY_LISTS] = "lists",
        [SDFGI_MEMORY_READBACK] = "readback", [SDFGI_MEMORY_VIEWS] = "views",
    };
    return (unsigned)category < SDFGI_MEMORY_CATEGORY_COUNT ? names[category] : "";
}

enum sdfgi_result sdfgi_estimate_memory(const struct sdfgi_settings *settings, uint32_t frames_in_flight,
                                        struct sdfgi_memory *memory)
{
    struct sdfgi_settings resolved;
    sdfgi_settings_default(&resolved);
    if (settings)
        resolved = *settings;
    if (!sdfgi_settings_validate(&resolved, NULL, 0) || frames_in_flight > SDFGI_MAX_FRAMES_IN_FLIGHT)
        return SDFGI_ERROR_INVALID_ARGUMENT;
    const struct extent extent = sdfgi_extent_from_settings(&resolved);
    memset(memory, 0, sizeof *memory);
    for (int i = 0; i < RESOURCE_COUNT; i++)
        memory->bytes[sdfgi_resource_row((enum resource)i)->category] +=
            sdfgi_resource_size((enum resource)i, &extent);
    memory->bytes[SDFGI_MEMORY_READBACK] = sdfgi_readback_size(frames_in_flight ? frames_in_flight : 2);
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        memory->total_bytes += memory->bytes[i];
    return SDFGI_OK;
}
