/* SPDX-License-Identifier: MIT
 * sdfgi info: devices, whether the library runs on them and why not, the memory that settings need, and
 * debug views. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "file/json_write.h"
#include "host/host.h"
#include "report/report.h"

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

static void print_memory(const struct sdfgi_settings *settings, const struct sdfgi_memory *memory,
                         uint32_t frames_in_flight)
{
    char cascades[32], resolution[32];
    sdfgi_settings_format(settings, "sdfgi_cascades", cascades, sizeof cascades);
    sdfgi_settings_format(settings, "sdfgi_resolution", resolution, sizeof resolution);
    printf("memory, %s cascades of %s cells, %u frames in flight\n", cascades, resolution, frames_in_flight);
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        printf("  %-10s %12" PRIu64 " bytes  %8.2f MiB\n",
               sdfgi_memory_category_name((enum sdfgi_memory_category)i), memory->bytes[i],
               (double)memory->bytes[i] / bytes_per_mib);
    printf("  %-10s %12" PRIu64 " bytes  %8.2f MiB\n", "total", memory->total_bytes,
           (double)memory->total_bytes / bytes_per_mib);
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

/* All that is known without rendering. */
struct inventory {
    const struct sdfgi_settings *settings;
    const struct sdfgi_memory *memory;
    uint32_t frames_in_flight;
    struct host_device_info *infos;
};

static bool add_device(cJSON *list, const struct host_device_info *info)
{
    cJSON *device = json_add_element(list);
    return json_add_number(device, "index", info->index) && json_add_text(device, "name", info->name) &&
           json_add_text(device, "driver", info->driver) && json_add_text(device, "type", info->type) &&
           json_add_number(device, "local_bytes", (double)info->local_bytes) &&
           cJSON_AddBoolToObject(device, "supported", info->requirements.supported) &&
           cJSON_AddBoolToObject(device, "usable", info->usable) &&
           json_add_text(device, "reason", info->reason[0] ? info->reason : NULL);
}

static cJSON *inventory_to_json(const struct inventory *inventory, const char *select, uint32_t count)
{
    cJSON *json = cJSON_CreateObject(), *memory = json_add_object(json, "memory");
    bool complete = json_add_number(memory, "total_bytes", (double)inventory->memory->total_bytes) &&
                    json_add_item(json, "settings", report_settings_to_json(inventory->settings));
    cJSON *bytes = json_add_object(memory, "by_category"), *list = cJSON_AddArrayToObject(json, "devices");
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        complete =
            complete && json_add_number(bytes, sdfgi_memory_category_name((enum sdfgi_memory_category)i),
                                        (double)inventory->memory->bytes[i]);
    for (uint32_t i = 0; i < count; i++)
        if (is_selected(&inventory->infos[i], select))
            complete = complete && add_device(list, &inventory->infos[i]);
    if (complete)
        return json;
    cJSON_Delete(json);
    return NULL;
}

static int show(const struct inventory *inventory, const struct run_common *common)
{
    char error[CLI_ERROR_BYTES], list_error[CLI_ERROR_BYTES];
    uint32_t found = 0;
    if (!common->quiet) {
        print_memory(inventory->settings, inventory->memory, inventory->frames_in_flight);
        print_debug_views();
    }
    const uint32_t all = host_device_list(inventory->infos, DEVICES_MAX, list_error, sizeof list_error);
    const uint32_t count = all < DEVICES_MAX ? all : DEVICES_MAX;
    for (uint32_t i = 0; i < count; i++)
        if (is_selected(&inventory->infos[i], common->device)) {
            found++;
            if (!common->quiet)
                print_device(&inventory->infos[i]);
        }
    if (common->report && !json_write_file(inventory_to_json(inventory, common->device, count),
                                           common->report, error, sizeof error))
        return cli_error("%s", error);
    if (all == 0)
        return cli_error("%s", list_error);
    return found ? CLI_EXIT_OK : cli_error("info: --device is %s, there are %u devices", common->device, all);
}

int cmd_info(int argc, char **argv)
{
    struct run_common common = { .quiet = false };
    uint32_t frames_in_flight = 2;
    struct cli_list set = { .count = 0 };
    const struct cli_option options[] = {
        RUN_COMMON_OPTIONS(&common, "only the device of this index", "devices and memory, as JSON"),
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
    /* Memory and views need no device: they are printed even where there is none. */
    struct host_device_info *infos = calloc(DEVICES_MAX, sizeof *infos);
    struct sdfgi_memory memory;
    const bool estimated = sdfgi_estimate_memory(&settings, frames_in_flight, &memory) == SDFGI_OK;
    if (!infos || !estimated) {
        free(infos);
        return cli_error("info: %s",
                         infos ? "the memory of these settings cannot be estimated" : "out of memory");
    }
    const struct inventory inventory = { &settings, &memory, frames_in_flight, infos };
    const int code = show(&inventory, &common);
    free(infos);
    return code;
}
