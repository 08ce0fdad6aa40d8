/* SPDX-License-Identifier: MIT */
#include "journey.h"

#include "journey_book.h"
#include "require.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

#include <vulkan/vulkan.h>

enum { POINTS = 48, LINE_SIZE = 96 };

/* Passes that ran, and all that there are. */
static struct {
    const char *names[SDFGI_MAX_PASSES];
    bool ran[SDFGI_MAX_PASSES];
    uint32_t count, journeys;
} seen;

void journey_open(struct journey *j, const char *name, const struct sdfgi_settings *settings)
{
    *j = (struct journey){ .name = name };
    gi_test_open(&j->t, settings);
    j->t.frame.seed = 20;
}

void journey_close(struct journey *j)
{
    journey_screen_close(&j->screen, &j->t);
    gi_test_close(&j->t);
    seen.journeys++;
}

uint32_t journey_count(void)
{
    return seen.journeys;
}

/* ---- Memory that is new ---- */

static bool has_buffer(const struct journey_state *state, VkBuffer buffer)
{
    for (uint32_t i = 0; i < state->count; i++)
        if (state->buffers[i].buffer == buffer)
            return true;
    return false;
}

struct fill {
    const struct journey_state *before, *state;
};

static void fill_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct fill *fill = user;
    for (uint32_t i = 0; i < fill->state->count; i++)
        if (!has_buffer(fill->before, fill->state->buffers[i].buffer))
            vkCmdFillBuffer(cmd, fill->state->buffers[i].buffer, 0, VK_WHOLE_SIZE, 0);
}

static void clear_new(struct journey *j)
{
    struct journey_state state;
    journey_state_find(&j->t, &state);
    struct fill fill = { &j->state, &state };
    gpu_test_submit(&j->t.gpu, fill_record, &fill);
    j->state = state;
}

/* Some memory is allocated by the update itself: it is cleared between recording and submission. */
static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    struct journey *j = user;
    REQUIRE_CMP(sdfgi_update(j->t.gi, cmd, &j->t.frame), ==, SDFGI_OK);
    clear_new(j);
}

/* ---- Hashes of a frame ---- */

struct download {
    const struct journey_state *state;
    VkBuffer target;
};

static void download_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct download *download = user;
    uint64_t offset = 0;
    for (uint32_t i = 0; i < download->state->count; i++) {
        const struct journey_buffer *buffer = &download->state->buffers[i];
        const VkBufferCopy region = { 0, offset, buffer->size };
        vkCmdCopyBuffer(cmd, buffer->buffer, download->target, 1, &region);
        offset += buffer->size;
    }
}

/* SCRATCH and the end of SEEN hold lists that threads fill in whatever order they run, and are left out. What
 * the frame makes of them does not depend on their order. */
static uint64_t hashed_bytes(const struct journey *j, const struct journey_buffer *buffer)
{
    if (strcmp(buffer->name, "SCRATCH") == 0)
        return 0;
    return strcmp(buffer->name, "SEEN") == 0 ? gi_test_ordered_bytes(&j->t, RESOURCE_SEEN) : buffer->size;
}

static void add_buffers(struct journey *j, struct journey_row *row)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < j->state.count; i++)
        size += j->state.buffers[i].size;
    struct gpu_test_buffer staging = gpu_test_buffer_host(&j->t.gpu, size, 0, NULL);
    struct download download = { &j->state, staging.buffer };
    gpu_test_submit(&j->t.gpu, download_record, &download);
    const char *data = staging.mapped;
    for (uint32_t i = 0; i < j->state.count; data += j->state.buffers[i++].size) {
        const uint64_t bytes = hashed_bytes(j, &j->state.buffers[i]);
        if (bytes > 0)
            journey_row_add(row, j->state.buffers[i].name, data, bytes);
    }
    gpu_test_buffer_destroy(&j->t.gpu, &staging);
}

/* Around the camera, nearer to it as often as farther away, with normals along axes. */
static void fill_points(const struct journey *j, struct gi_test_point points[static POINTS])
{
    struct test_random random = { 5 };
    for (uint32_t i = 0; i < POINTS; i++) {
        const double reach = i % 2 ? 14 : 3;
        memset(&points[i], 0, sizeof points[i]);
        points[i].normal[i / 2 % 3] = i % 4 < 2 ? 1 : -1;
        for (int k = 0; k < 3; k++) {
            const double place = j->t.frame.camera_position[k] - j->t.frame.origin[k];
            points[i].position[k] = (float)(place + test_random_real(&random, -reach, reach));
        }
    }
}

static void add_light(struct journey *j, struct journey_row *row)
{
    struct gi_test_point points[POINTS];
    float irradiance[POINTS][3];
    fill_points(j, points);
    gi_test_irradiance(&j->t, points, POINTS, irradiance);
    journey_row_add(row, "LOOKUPS", irradiance, sizeof irradiance);
}

static void note_passes(const struct sdfgi_report *report)
{
    seen.count = report->pass_count;
    for (uint32_t i = 0; i < report->pass_count; i++) {
        seen.names[i] = report->passes[i].name;
        seen.ran[i] = seen.ran[i] || report->passes[i].ran;
    }
}

static size_t print_state(const struct sdfgi_report *r, char *text, size_t size)
{
    size_t length = (size_t)snprintf(
        text, size, "%d %d %llu %llu %llu %u %u\n", r->active, r->converged,
        (unsigned long long)r->scroll.steps_begun, (unsigned long long)r->scroll.cells,
        (unsigned long long)r->scroll.pending_cells, r->scroll.cascades_changing, r->scroll.cascades_waiting);
    for (uint32_t i = 0; i < r->health_count; i++)
        length += (size_t)snprintf(text + length, size - length, "%d %llu\n", (int)r->health[i].code,
                                   (unsigned long long)r->health[i].count);
    return length;
}

static int compare_lines(const void *a, const void *b)
{
    return strcmp(a, b);
}

/* A line for each pass that did something, without times; sorted, as the order of passes in the report is
 * none of a host's business. */
static uint32_t print_passes(const struct sdfgi_report *report, char (*lines)[LINE_SIZE])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < report->pass_count; i++) {
        const struct sdfgi_pass_report *pass = &report->passes[i];
        if (pass->ran || pass->work > 0)
            snprintf(lines[count++], LINE_SIZE, "%s %d %u %llu", pass->name, pass->ran, pass->dispatches,
                     (unsigned long long)pass->work);
    }
    qsort(lines, count, LINE_SIZE, compare_lines);
    return count;
}

static void add_report(const struct journey *j, struct journey_row *row)
{
    static struct sdfgi_report report;
    char state[1024], lines[SDFGI_MAX_PASSES][LINE_SIZE] = { 0 };
    sdfgi_get_report(j->t.gi, &report);
    journey_row_add(row, "STATE", state, print_state(&report, state, sizeof state));
    const uint32_t count = print_passes(&report, lines);
    journey_row_add(row, "REPORT", lines, count * sizeof lines[0]);
    if (getenv("SDFGI_TEST_SHOW_REPORT")) {
        printf("# %s %u: %s", j->name, j->frame - 1, state);
        for (uint32_t i = 0; i < count; i++)
            printf("#   %s\n", lines[i]);
    }
    note_passes(&report);
    journey_state_require_reasons(&report);
}

/* Another view of volumes in every frame, and that of the picture. */
static void add_debug(struct journey *j, struct journey_row *row)
{
    const enum sdfgi_debug_view view = (enum sdfgi_debug_view)(row->frame % SDFGI_DEBUG_REFLECTION_TIER);
    journey_row_add(row, "DEBUG", journey_screen_debug(&j->screen, &j->t, view), sizeof j->screen.pixels);
    journey_row_add(row, "TIER", journey_screen_debug(&j->screen, &j->t, SDFGI_DEBUG_REFLECTION_TIER),
                    sizeof j->screen.pixels);
}

void journey_frame(struct journey *j, const double camera[static 3])
{
    static const char *const columns[] = { "GATHER", "GATHER_HALF", "GATHER_QUARTER" };
    struct journey_row row = { .journey = j->name, .frame = j->frame++ };
    memcpy(j->t.frame.camera_position, camera, sizeof j->t.frame.camera_position);
    gpu_test_submit(&j->t.gpu, record_update, j);
    if (j->state.count > 0) {
        add_buffers(j, &row);
        add_light(j, &row);
    }
    for (int i = 0; i <= SDFGI_GATHER_QUARTER && j->screen.made; i++)
        journey_row_add(&row, columns[i],
                        journey_screen_gather(&j->screen, &j->t, (enum sdfgi_gather_resolution)i),
                        sizeof j->screen.pixels);
    if (j->screen.made)
        journey_row_add(&row, "REFLECT", journey_screen_reflect(&j->screen, &j->t), sizeof j->screen.pixels);
    if (j->screen.made)
        add_debug(j, &row);
    add_report(j, &row);
    journey_book_take(&row);
}

void journey_walk(struct journey *j, double camera[static 3], const double step[static 3], uint32_t frames)
{
    for (uint32_t i = 0; i < frames; i++) {
        journey_frame(j, camera);
        for (int k = 0; k < 3; k++)
            camera[k] += step[k];
    }
}

void journey_stay(struct journey *j, const double camera[static 3], uint32_t frames)
{
    for (uint32_t i = 0; i < frames; i++)
        journey_frame(j, camera);
}

uint64_t journey_buffer_size(const struct journey *j, const char *name)
{
    for (uint32_t i = 0; i < j->state.count; i++)
        if (strcmp(j->state.buffers[i].name, name) == 0)
            return j->state.buffers[i].size;
    return 0;
}

const char *journey_passes_missing(void)
{
    static char text[1024];
    text[0] = 0;
    for (uint32_t i = 0; i < seen.count; i++)
        if (!seen.ran[i])
            snprintf(text + strlen(text), sizeof text - strlen(text), " %s", seen.names[i]);
    return text;
}
