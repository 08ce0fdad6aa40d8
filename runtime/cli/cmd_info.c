/* SPDX-License-Identifier: MIT
 * sdfgi info: devices, whether the library runs on them and why not, the memory that settings need, and
 * debug views. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "host/host.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEVICES_MAX = 16 };

static const double bytes_per_mib = 1024.0 * 1024.0;

static void print_device(const struct host_device_info *info)
{
    const struct sdfgi_requirements *requirements = &info->requirements;
    printf("device %u: %s\n", info->index, info->name);
    printf("  type       %s\n  driver     %s\n", info->type, info->driver);
    printf("  Vulkan     %u.%u.%u\n", VK_API_VERSION_MAJOR(info->api_version),
           VK_API_VERSION_MINOR(info->api_version), VK_API_VERSION_PATCH(info->api_version));
    printf("  memory     %" PRIu64 " bytes (%.0f MiB)\n", info->local_bytes,
           (double)info->local_bytes / bytes_per_mib);
    printf("  libsdfgi   %s\n", requirements->supported ? "supported" : "not supported");
    for (uint32_t i = 0; i < requirements->reason_count; i++)
        printf("    %s\n", requirements->reasons[i]);
    for (uint32_t i = 0; i < requirements->extension_count; i++)
        printf("    needs extension %s\n", requirements->extensions[i]);
    printf("  program    %s%s%s\n", info->usable ? "usable" : "not usable", info->reason[0] ? ": " : "",
           info->reason);
}

static int print_memory(const struct sdfgi_settings *settings, uint32_t frames_in_flight)
{
    struct sdfgi_memory memory;
    if (sdfgi_estimate_memory(settings, frames_in_flight, &memory) != SDFGI_OK)
        return cli_error("info: the memory of these settings cannot be estimated");
    char cascades[32], resolution[32];
    sdfgi_settings_format(settings, "sdfgi_cascades", cascades, sizeof cascades);
    sdfgi_settings_format(settings, "sdfgi_resolution", resolution, sizeof resolution);
    printf("memory, %s cascades of %s cells, %u frames in flight\n", cascades, resolution, frames_in_flight);
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        printf("  %-10s %12" PRIu64 " bytes  %8.2f MiB\n",
               sdfgi_memory_category_name((enum sdfgi_memory_category)i), memory.bytes[i],
               (double)memory.bytes[i] / bytes_per_mib);
    printf("  %-10s %12" PRIu64 " bytes  %8.2f MiB\n", "total", memory.total_bytes,
           (double)memory.total_bytes / bytes_per_mib);
    return CLI_EXIT_OK;
}

static void print_debug_views(void)
{
    printf("debug views\n");
    for (int i = 0; i < SDFGI_DEBUG_VIEW_COUNT; i++)
        printf("  %-18s %s\n", sdfgi_debug_view_name((enum sdfgi_debug_view)i),
               sdfgi_debug_view_text((enum sdfgi_debug_view)i));
}

static bool is_selected(const struct host_device_info *info, const char *select)
{
    char index[16];
    snprintf(index, sizeof index, "%u", info->index);
    return !select || strcmp(index, select) == 0;
}

static int print_devices(const char *select)
{
    char error[CLI_ERROR_BYTES];
    struct host_device_info *infos = calloc(DEVICES_MAX, sizeof *infos);
    if (!infos)
        return cli_error("info: out of memory");
    const uint32_t count = host_device_list(infos, DEVICES_MAX, error, sizeof error);
    uint32_t printed = 0;
    for (uint32_t i = 0; i < count && i < DEVICES_MAX; i++)
        if (is_selected(&infos[i], select)) {
            print_device(&infos[i]);
            printed++;
        }
    free(infos);
    if (count == 0)
        return cli_error("%s", error);
    return printed ? CLI_EXIT_OK : cli_error("info: --device is %s, there are %u devices", select, count);
}

int cmd_info(int argc, char **argv)
{
    const char *device = NULL;
    uint32_t frames_in_flight = 2;
    struct cli_list set = { .count = 0 };
    const struct cli_option options[] = {
        { "device", CLI_TEXT, &device, "N", .help = "only the device of this index" },
        { "set", CLI_LIST, &set, "KEY=VALUE", .help = "a setting, for the memory estimate" },
        { "frames-in-flight", CLI_UINT, &frames_in_flight, "N", .help = "1 to 8, for the memory estimate; 2",
          .minimum = 1, .maximum = 8 },
    };
    const struct cli_spec spec = { .name = "info",
                                   .summary =
                                       "Lists devices, requirements and debug views, and estimates memory.",
                                   .options = options,
                                   .option_count = sizeof options / sizeof options[0] };
    const enum cli_outcome outcome = cli_parse(&spec, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    if (!run_apply_settings("info", &set, &settings))
        return CLI_EXIT_USAGE;
    /* These need no device, so they are printed even where there is none. */
    const int estimated = print_memory(&settings, frames_in_flight);
    print_debug_views();
    const int listed = print_devices(device);
    return estimated != CLI_EXIT_OK ? estimated : listed;
}
