/* SPDX-License-Identifier: MIT
 * The report of a walk. Each function adds everything and answers once, see json_write.h. */
#include "walk_report.h"

#include "file/json_write.h"

#include <stdlib.h>

static bool add_vector(cJSON *object, const char *name, const double values[3])
{
    return json_add_item(object, name, cJSON_CreateDoubleArray(values, 3));
}

static bool add_float_vector(cJSON *object, const char *name, const float values[3])
{
    const double copy[3] = { (double)values[0], (double)values[1], (double)values[2] };
    return add_vector(object, name, copy);
}

/* ---- The run ---------------------------------------------------------------------------------------- */

static bool add_run(cJSON *json, const struct walk_record *record, const struct walk_summary *summary)
{
    const struct report_summary *run = &summary->run;
    const int size[2] = { (int)run->width, (int)run->height };
    cJSON *device = json_add_object(json, "device");
    cJSON *settings = report_settings_to_json(&run->settings);
    if (!json_add_item(json, "settings", settings))
        return false;
    return json_add_text(device, "name", run->device_name) &&
           json_add_text(device, "driver", run->device_driver) &&
           json_add_text(device, "type", run->device_type) &&
           json_add_item(json, "size", cJSON_CreateIntArray(size, 2)) &&
           json_add_number(json, "seconds", run->seconds) &&
           json_add_number(json, "estimated_bytes", (double)run->estimated_bytes) &&
           json_add_number(json, "validation_messages", run->validation_messages) &&
           json_add_number(json, "frames_rendered", record->frame_count);
}

static bool add_path(cJSON *json, const struct walk_summary *summary)
{
    cJSON *path = json_add_object(json, "path");
    return json_add_text(path, "scene", summary->scene) && json_add_text(path, "file", summary->path) &&
           json_add_number(path, "length_m", summary->length_m) &&
           json_add_number(path, "start_m", summary->start_m) &&
           json_add_number(path, "speed_m_s", summary->speed_m_s) &&
           json_add_number(path, "fps", summary->fps) &&
           json_add_number(path, "frames_asked", summary->frames_asked) &&
           json_add_number(path, "hold_frames", summary->hold_frames);
}

/* ---- The journey ------------------------------------------------------------------------------------ */

static bool add_statistics(cJSON *parent, const char *name, const char *unit,
                           const struct walk_record *record, walk_series_fn series, uint32_t index)
{
    struct walk_statistics s;
    if (!walk_record_statistics(record, series, index, &s))
        return false;
    cJSON *object = json_add_object(parent, name);
    const bool complete =
        (!unit || json_add_text(object, "unit", unit)) && json_add_number(object, "median", s.median) &&
        json_add_number(object, "p99", s.p99) && json_add_number(object, "worst", s.worst) &&
        json_add_number(object, "worst_frame", s.worst_frame) && json_add_number(object, "total", s.total) &&
        json_add_number(object, "samples", s.samples);
    /* Nothing can be said of the ratio where most frames have no such work. */
    if (s.median > 0)
        return complete && json_add_number(object, "p99_over_median", s.p99 / s.median) &&
               json_add_number(object, "worst_over_median", s.worst / s.median);
    return complete;
}

static uint32_t frames_ran(const struct walk_record *record, uint32_t pass)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < record->frame_count; i++)
        count += record->frames[i].passes[pass].ran;
    return count;
}

static const char *last_skip(const struct walk_record *record, uint32_t pass)
{
    for (uint32_t i = record->frame_count; i-- > 0;)
        if (!record->frames[i].passes[pass].ran)
            return record->frames[i].passes[pass].reason;
    return NULL;
}

static bool add_passes(cJSON *journey, const struct walk_record *record)
{
    cJSON *list = cJSON_AddArrayToObject(journey, "passes");
    bool complete = list != NULL;
    for (uint32_t i = 0; complete && i < record->pass_count; i++) {
        cJSON *item = json_add_element(list);
        const uint32_t ran = frames_ran(record, i);
        const char *skipped = last_skip(record, i);
        complete = json_add_text(item, "name", record->pass_names[i]) && json_add_number(item, "ran", ran) &&
                   (!skipped || json_add_text(item, "skipped_because", skipped)) &&
                   (ran == 0 ||
                    (add_statistics(item, "work", record->pass_units[i], record, walk_series_pass_work, i) &&
                     add_statistics(item, "gpu_ns", NULL, record, walk_series_pass_gpu_ns, i)));
    }
    return complete;
}

static bool add_samples(cJSON *journey, const struct walk_record *record, const struct walk_summary *summary)
{
    cJSON *list = cJSON_AddArrayToObject(journey, "samples");
    bool complete = list != NULL;
    for (uint32_t i = 0; complete && i < summary->sample_count; i++) {
        cJSON *item = json_add_element(list);
        uint32_t frame;
        const double change = walk_record_change(record, i, &frame);
        complete = add_vector(item, "position", summary->sample_positions[i]) &&
                   add_float_vector(item, "normal", summary->sample_normals[i]) &&
                   json_add_number(item, "worst_change_per_frame", change) &&
                   json_add_number(item, "worst_change_frame", frame);
    }
    return complete;
}

static bool add_health(cJSON *journey, const struct walk_record *record)
{
    cJSON *health = json_add_object(journey, "health");
    bool complete = health != NULL;
    for (int i = 0; complete && i < SDFGI_MESSAGE_COUNT; i++)
        if (record->health[i] > 0)
            complete = json_add_number(health, report_message_name((enum sdfgi_message)i),
                                       (double)record->health[i]);
    return complete;
}

static bool add_journey(cJSON *json, const struct walk_record *record, const struct walk_summary *summary)
{
    cJSON *journey = json_add_object(json, "journey");
    bool complete = add_statistics(journey, "gi_gpu_ns", NULL, record, walk_series_gi_gpu_ns, 0) &&
                    add_statistics(journey, "frame_gpu_ns", NULL, record, walk_series_gpu_ns, 0) &&
                    report_cost_to_json(journey, &summary->run.cost);
    for (uint32_t i = 0; complete && i < WALK_COUNT_COUNT; i++)
        complete = add_statistics(journey, walk_count_name((enum walk_count)i),
                                  walk_count_unit((enum walk_count)i), record, walk_series_count, i);
    return complete && add_passes(journey, record) && add_samples(journey, record, summary) &&
           add_health(journey, record);
}

/* ---- The frames ------------------------------------------------------------------------------------- */

/* Those that ran; the others are `journey.passes`' business. */
static bool add_frame_passes(cJSON *item, const struct walk_record *record, const struct walk_frame *frame)
{
    cJSON *passes = json_add_object(item, "passes");
    bool complete = passes != NULL;
    for (uint32_t i = 0; complete && i < record->pass_count; i++) {
        const struct walk_pass *pass = &frame->passes[i];
        if (!pass->ran)
            continue;
        cJSON *object = json_add_object(passes, record->pass_names[i]);
        complete = json_add_text(object, "reason", pass->reason) &&
                   json_add_number(object, "dispatches", pass->dispatches) &&
                   json_add_number(object, "work", (double)pass->work) &&
                   (!pass->timed || json_add_number(object, "gpu_ns", (double)pass->gpu_ns));
    }
    return complete;
}

static bool add_frame(cJSON *list, const struct walk_record *record, uint32_t index,
                      const struct walk_summary *summary)
{
    const struct walk_frame *frame = &record->frames[index];
    cJSON *item = json_add_element(list);
    bool complete = json_add_number(item, "frame", index) &&
                    json_add_number(item, "time_s", (double)index / summary->fps) &&
                    json_add_number(item, "distance_m", frame->distance_m) &&
                    add_vector(item, "position", frame->position) &&
                    json_add_number(item, "frame_gpu_ns", (double)frame->gpu_ns) &&
                    json_add_number(item, "gi_gpu_ns", (double)frame->gi_gpu_ns) &&
                    cJSON_AddBoolToObject(item, "converged", frame->converged) &&
                    json_add_number(item, "converged_fraction", (double)frame->converged_fraction);
    for (int i = 0; complete && i < WALK_COUNT_COUNT; i++)
        complete = json_add_number(item, walk_count_name((enum walk_count)i), (double)frame->counts[i]);
    cJSON *irradiance = complete ? cJSON_AddArrayToObject(item, "irradiance") : NULL;
    complete = irradiance != NULL;
    for (uint32_t i = 0; complete && i < summary->sample_count; i++)
        complete = cJSON_AddItemToArray(irradiance, cJSON_CreateFloatArray(frame->irradiance[i], 3));
    return complete && add_frame_passes(item, record, frame);
}

static bool add_frames(cJSON *json, const struct walk_record *record, const struct walk_summary *summary)
{
    cJSON *list = cJSON_AddArrayToObject(json, "frames");
    bool complete = list != NULL;
    for (uint32_t i = 0; complete && i < record->frame_count; i++)
        complete = add_frame(list, record, i, summary);
    return complete;
}

cJSON *walk_report_to_json(const struct walk_record *record, const struct walk_summary *summary)
{
    cJSON *json = cJSON_CreateObject();
    if (json && add_run(json, record, summary) && add_path(json, summary) &&
        add_journey(json, record, summary) && add_frames(json, record, summary))
        return json;
    cJSON_Delete(json);
    return NULL;
}

bool walk_report_write(const struct walk_record *record, const struct walk_summary *summary, const char *path,
                       char *error, size_t error_size)
{
    return json_write_file(walk_report_to_json(record, summary), path, error, error_size);
}
