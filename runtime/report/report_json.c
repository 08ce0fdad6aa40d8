/* SPDX-License-Identifier: MIT
 * The report as JSON. Each function adds everything and answers once, see json_write.h. */
#include "report.h"

#include "file/json_write.h"

#include <math.h>
#include <stdlib.h>

static bool add_setting(cJSON *object, const struct sdfgi_settings *settings,
                        const struct sdfgi_property_info *info)
{
    char text[32];
    sdfgi_settings_format(settings, info->name, text, sizeof text);
    if (info->type == SDFGI_PROPERTY_BOOL)
        return cJSON_AddBoolToObject(object, info->name, sdfgi_settings_get(settings, info->name) != 0) !=
               NULL;
    if (info->type == SDFGI_PROPERTY_ENUM)
        return json_add_text(object, info->name, text);
    /* Through the text, so that 0.2f is written as 0.2. */
    return json_add_number(object, info->name, strtod(text, NULL));
}

cJSON *report_settings_to_json(const struct sdfgi_settings *settings)
{
    cJSON *object = cJSON_CreateObject();
    bool complete = object != NULL;
    const struct sdfgi_property_info *info;
    for (uint32_t i = 0; complete && (info = sdfgi_property_get_info(i)); i++)
        complete = add_setting(object, settings, info);
    if (complete)
        return object;
    cJSON_Delete(object);
    return NULL;
}

static bool add_gi(cJSON *json, const struct report *report, const struct report_summary *summary)
{
    cJSON *gi = json_add_object(json, "gi");
    cJSON *settings = report_settings_to_json(&summary->settings);
    if (!json_add_item(gi, "settings", settings))
        return false;
    return cJSON_AddBoolToObject(gi, "enabled", summary->settings.enabled) &&
           cJSON_AddBoolToObject(gi, "converged", report->last.converged) &&
           json_add_number(gi, "converged_fraction", (double)report->last.converged_fraction);
}

static bool add_times(cJSON *parent, const char *name, struct report_samples *samples, const char *tail_name,
                      double tail)
{
    cJSON *times = json_add_object(parent, name);
    return json_add_number(times, "median", (double)report_quantile(samples, 0.5)) &&
           json_add_number(times, tail_name, (double)report_quantile(samples, tail)) &&
           json_add_number(times, "max", (double)report_quantile(samples, 1)) &&
           json_add_number(times, "samples", (double)samples->count);
}

static bool add_passes(cJSON *json, struct report *report)
{
    cJSON *list = cJSON_AddArrayToObject(json, "passes");
    bool complete = list != NULL;
    for (uint32_t i = 0; complete && i < report->pass_count; i++) {
        struct report_pass *pass = &report->passes[i];
        cJSON *item = json_add_element(list);
        complete = json_add_text(item, "name", pass->name) &&
                   json_add_number(item, "ran", (double)pass->ran) &&
                   json_add_text(item, "reason", pass->reason) &&
                   json_add_text(item, "skipped_because", pass->skipped_because) &&
                   json_add_number(item, "dispatches", pass->dispatches) &&
                   json_add_number(item, "work", (double)pass->work) &&
                   json_add_text(item, "work_unit", pass->work_unit) &&
                   add_times(item, "gpu_ns", &pass->gpu_ns, "p95", 0.95);
    }
    return complete;
}

static bool add_memory(cJSON *json, const struct sdfgi_memory *memory, uint64_t estimated_bytes)
{
    cJSON *object = json_add_object(json, "memory");
    bool complete = json_add_number(object, "total_bytes", (double)memory->total_bytes) &&
                    json_add_number(object, "estimated_bytes", (double)estimated_bytes);
    cJSON *categories = json_add_object(object, "by_category");
    for (int i = 0; complete && i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        complete = json_add_number(categories, sdfgi_memory_category_name((enum sdfgi_memory_category)i),
                                   (double)memory->bytes[i]);
    return complete;
}

const char *report_message_name(enum sdfgi_message message)
{
    static const char *const names[] = {
#define MESSAGE_NAME(id, level, hint) #id,
        SDFGI_MESSAGES(MESSAGE_NAME)
#undef MESSAGE_NAME
    };
    return (unsigned)message < SDFGI_MESSAGE_COUNT ? names[message] : "UNKNOWN";
}

static bool add_health(cJSON *json, const struct sdfgi_report *last)
{
    cJSON *list = cJSON_AddArrayToObject(json, "health");
    bool complete = list != NULL;
    for (uint32_t i = 0; complete && i < last->health_count; i++) {
        cJSON *item = json_add_element(list);
        complete = json_add_text(item, "code", report_message_name(last->health[i].code)) &&
                   json_add_number(item, "count", (double)last->health[i].count) &&
                   json_add_text(item, "hint", last->health[i].hint);
    }
    return complete;
}

static bool add_run(cJSON *json, const struct report *report, const struct report_summary *summary)
{
    cJSON *device = json_add_object(json, "device");
    const int size[2] = { (int)summary->width, (int)summary->height };
    cJSON *size_json = cJSON_CreateIntArray(size, 2);
    if (!json_add_item(json, "size", size_json))
        return false;
    return json_add_text(device, "name", summary->device_name) &&
           json_add_text(device, "driver", summary->device_driver) &&
           json_add_text(device, "type", summary->device_type) &&
           json_add_number(json, "frames", (double)report->frames) &&
           json_add_number(json, "seconds", summary->seconds) &&
           json_add_number(json, "exposure", summary->exposure) &&
           json_add_number(json, "validation_messages", summary->validation_messages);
}

cJSON *report_to_json(struct report *report, const struct report_summary *summary)
{
    cJSON *json = cJSON_CreateObject();
    if (!report->out_of_memory && json && add_run(json, report, summary) && add_gi(json, report, summary) &&
        add_passes(json, report) && add_times(json, "frame_gpu_ns", &report->frame_gpu_ns, "p99", 0.99) &&
        (report->fog_gpu_ns.count == 0 || add_times(json, "fog_gpu_ns", &report->fog_gpu_ns, "p99", 0.99)) &&
        report_cost_to_json(json, &summary->cost) &&
        json_add_number(json, "library_commands", report->last.command_count) &&
        add_memory(json, &report->last.memory, summary->estimated_bytes) && add_health(json, &report->last))
        return json;
    cJSON_Delete(json);
    return NULL;
}

bool report_write(struct report *report, const struct report_summary *summary, const char *path, char *error,
                  size_t error_size)
{
    return json_write_file(report_to_json(report, summary), path, error, error_size);
}
