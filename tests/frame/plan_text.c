/* SPDX-License-Identifier: MIT */
#include "plan_text.h"

#include "pass/resource_rows.h"
#include "test_memory.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_append(struct text *text, const char *part, size_t length)
{
    if (text->size + length + 1 > text->room) {
        text->room = 2 * (text->size + length + 1);
        text->at = test_array_resize(text->at, text->room, 1);
    }
    memcpy(text->at + text->size, part, length);
    text->size += length;
    text->at[text->size] = 0;
}

void text_add(struct text *text, const char *format, ...)
{
    char part[512];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    assert(length >= 0 && (size_t)length < sizeof part);
    text_append(text, part, (size_t)length);
}

void text_free(struct text *text)
{
    free(text->at);
    *text = (struct text){ 0 };
}

/* ---- Where */

static void add_box(struct text *text, const struct cell_box *box)
{
    text_add(text, " [%d %d %d..%d %d %d]", box->low[0], box->low[1], box->low[2], box->high[0], box->high[1],
             box->high[2]);
}

static void add_record(struct text *text, const struct work *work)
{
    static const char *const names[] = { "CELLS", "MASKS", "DIRECT", "RAYS" };
    const uint32_t record = work->indirect;
    if (work->records == RESOURCE_SEEN)
        text_add(text, " indirect VISITS+%u", record);
    else
        text_add(text, " indirect %s+%u", names[record / SDFGI_MAX_CASCADES], record % SDFGI_MAX_CASCADES);
}

static void add_where(struct text *text, const struct work *work)
{
    if (work->indirect != WORK_DIRECT)
        add_record(text, work);
    else if (!sdfgi_cell_box_empty(&work->box))
        add_box(text, &work->box);
    else if (work->count > 0)
        text_add(text, " %u+%u", work->first, work->count);
    else
        text_add(text, " all");
}

/* ---- Arguments, as far as they are decisions */

static void add_region(struct text *text, const struct sdfgi_region_args *args)
{
    static const char *const axes[] = { "no strips", "strips across x", "strips across y",
                                        "strips across z" };
    text_add(text, " %s", axes[args->bounds_axis + 1]);
    if (args->before.x != 0 || args->before.y != 0 || args->before.z != 0)
        text_add(text, " before %d %d %d", args->before.x, args->before.y, args->before.z);
}

static void add_light_direct(struct text *text, const struct sdfgi_light_direct_args *args)
{
    if (args->only_dirty)
        text_add(text, " dirty");
    if (args->moved != SDFGI_LIGHT_ALL)
        text_add(text, " lights %x, moved %x", args->changed, args->moved);
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        if (args->end[c] > 0)
            text_add(text, " c%u entries %u..%u", c, args->first[c], args->end[c]);
}

static void add_light_bounce(struct text *text, const struct sdfgi_light_bounce_args *args)
{
    text_add(text, "%s%s%s", args->only_dirty ? " dirty" : "", args->lit ? " lit" : "",
             args->without_probes ? " without probes" : "");
}

static void add_visit_list(struct text *text, const struct sdfgi_visit_list_args *args)
{
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        if (args->end[c] > 0)
            text_add(text, " c%u entries %u..%u", c, args->first[c], args->end[c]);
}

static void add_args(struct text *text, const struct work *work)
{
    const union work_args *args = &work->args;
    switch (work->pass) {
    case PASS_REGION_CLEAR:
    case PASS_VOXEL_RESOLVE:
        add_region(text, &args->region);
        break;
    case PASS_DISTANCE_PREPARE:
        text_add(text, "%s dirty boxes %u", args->distance_prepare.row_groups ? "" : " known bits",
                 args->distance_prepare.box_count);
        break;
    case PASS_FLOOD_STEP:
        text_add(text, " jump %u", args->flood.jump);
        break;
    case PASS_LIGHT_MARK:
        text_add(text, "%s", args->light_mark.rebuild ? " rebuild" : " dirty");
        break;
    case PASS_LIGHT_DIRECT:
        add_light_direct(text, &args->light_direct);
        break;
    case PASS_LIGHT_BOUNCE:
        add_light_bounce(text, &args->light_bounce);
        break;
    case PASS_CELL_GATHER:
        text_add(text, " new cells x %u", args->cell_gather.new_rays);
        break;
    case PASS_VISIT_LIST:
        add_visit_list(text, &args->visit_list);
        break;
    case PASS_PROBE_BLEND:
        text_add(text, "%s%s", args->probe_blend.cycle_ends ? " cycle ends" : "",
                 args->probe_blend.without_history ? " without history" : "");
        break;
    default:
        break;
    }
}

/* ---- Lines */

static void add_clear(struct text *text, const struct work *work)
{
    const char *name = sdfgi_resource_row(work->resource)->name + strlen("sdfgi ");
    text_add(text, "  CLEAR %s %llu %llu\n", name, (unsigned long long)work->offset,
             (unsigned long long)work->bytes);
}

static void add_pass(struct text *text, const struct work *work)
{
    text_add(text, "  %s c%u", sdfgi_pass_row(work->pass)->name, work->cascade);
    add_where(text, work);
    if (work->group > 0)
        text_add(text, " group %u", work->group);
    add_args(text, work);
    text_add(text, "; %s\n", work->reason);
}

static void add_uploads(struct text *text, uint32_t uploads)
{
    static const char *const names[] = {
        "params", "lights", "materials", "ray queue", "instances", "visits"
    };
    const char *between = "  UPLOAD ";
    for (uint32_t i = 0; i < sizeof names / sizeof *names; i++)
        if (uploads >> i & 1) {
            text_add(text, "%s%s", between, names[i]);
            between = ", ";
        }
    text_add(text, "%s", uploads ? "\n" : "");
}

static void add_cascade(struct text *text, const struct cascade *cascade, uint32_t c)
{
    static const char *const causes[] = { "none", "rebuild", "scroll", "edit" };
    static const char *const stages[] = { "idle", "begun", "voxels", "distances", "ready", "completes" };
    static const char *const following_names[] = { "keeps up", "waits", "is left behind" };
    const struct change *change = &cascade->change;
    if (change->cause != CHANGE_NONE)
        text_add(text, "; c%u %s %s", c, causes[change->cause], stages[change->stage]);
    if (cascade->following != CASCADE_KEEPS_UP)
        text_add(text, "; c%u %s", c, following_names[cascade->following]);
}

void plan_text_add(struct text *text, const struct frame *frame, uint32_t cycle_frames)
{
    static const char *const phases[] = { "dark", "first cycle", "running", "converged" };
    const struct accumulation *a = &frame->next.accumulation;
    text_add(text, "frame %llu: %s, %u of %u", (unsigned long long)frame->next.updates, phases[a->phase],
             a->frame + 1, cycle_frames);
    for (uint32_t c = 0; c < frame->next.cascades.count; c++)
        add_cascade(text, &frame->next.cascades.at[c], c);
    if (frame->scroll.cells > 0)
        text_add(text, "; %llu cells", (unsigned long long)frame->scroll.cells);
    text_add(text, "%s\n", frame->work.count == 0 ? "; no work" : "");
    add_uploads(text, frame->uploads);
    for (uint32_t i = 0; i < frame->work.count; i++)
        if (frame->work.items[i].kind == WORK_CLEAR)
            add_clear(text, &frame->work.items[i]);
        else
            add_pass(text, &frame->work.items[i]);
}

void plan_text_add_idle(struct text *text, const struct frame *frame)
{
    for (int i = 0; i < PASS_COUNT; i++)
        if (!sdfgi_work_has(&frame->work, (enum pass)i))
            text_add(text, "  no %s; %s\n", sdfgi_pass_row((enum pass)i)->name, frame->reasons[i]);
}
