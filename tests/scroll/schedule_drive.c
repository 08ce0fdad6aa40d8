/* SPDX-License-Identifier: MIT */
#include "schedule_drive.h"

#include "require.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct sdfgi context;

struct sdfgi *schedule_drive_begin(uint32_t budget)
{
    struct sdfgi *gi = &context;
    memset(gi, 0, sizeof *gi);
    sdfgi_settings_default(&gi->settings);
    gi->settings.enabled = true;
    gi->settings.max_scroll_cells = budget;
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++) {
        gi->volume.state.cascades.at[c].rebuild = true;
        for (int i = 0; i < 3; i++)
            gi->volume.state.cascades.at[c].cell_size[i] = ldexp(gi->settings.min_cell_size_m, (int)c);
    }
    return gi;
}

static uint64_t step_cells(const struct sdfgi *gi)
{
    const uint64_t n = gi->settings.resolution;
    uint64_t cells = 0;
    for (uint32_t i = 0; i < gi->schedule.step_count; i++) {
        const struct step *step = &gi->schedule.steps[i];
        cells += step->kind == STEP_VOXELS ? sdfgi_cell_box_cells(&step->box) : 0;
        cells += step->kind == STEP_DISTANCE ? step->count * n * n * 4 : 0;
    }
    return cells;
}

uint64_t schedule_drive_frame(struct sdfgi *gi, const double camera[static 3])
{
    schedule_frame(gi, camera);
    const uint64_t cells = step_cells(gi);
    REQUIRE_CMP(cells, ==, gi->frame.scroll.cells);
    schedule_finish(gi);
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        gi->volume.state.cascades.at[c].fresh = false;
    return cells;
}

bool schedule_drive_covers(const struct cascade *cascade, const double camera[static 3], double cells)
{
    for (int i = 0; i < 3; i++) {
        const double at = camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        if (at - cells < cascade->window.low[i] || at + cells > cascade->window.high[i])
            return false;
    }
    return true;
}

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

struct journey schedule_drive_journey(struct sdfgi *gi, const char *what, uint32_t skip, uint32_t frames,
                                      void (*where)(const void *user, uint32_t i, double camera[static 3]),
                                      const void *user)
{
    uint64_t *work = test_array_alloc(frames, sizeof *work);
    struct journey j = { .frames = frames, .apart = UINT32_MAX };
    uint32_t since = frames;
    double camera[3];
    for (uint32_t i = 0; i < skip + frames; i++) {
        where(user, i, camera);
        const uint64_t cells = schedule_drive_frame(gi, camera);
        if (i < skip)
            continue;
        work[i - skip] = cells;
        since++;
        if (schedule_has(gi, STEP_COMPLETE)) {
            j.apart = since < j.apart ? since : j.apart;
            since = 0;
        }
        for (uint32_t c = 0; c < gi->settings.cascades; c++)
            j.covered[c] += schedule_drive_covers(&gi->volume.state.cascades.at[c], camera, 40);
    }
    qsort(work, frames, sizeof *work, compare);
    j.median = work[frames / 2];
    j.p99 = work[frames * 99 / 100];
    j.most = work[frames - 1];
    free(work);
    printf(
        "%s: cells a frame: median %llu, p99 %llu, most %llu; of %u frames with 40 cells around the camera: "
        "%u %u %u %u\n",
        what, (unsigned long long)j.median, (unsigned long long)j.p99, (unsigned long long)j.most, j.frames,
        j.covered[0], j.covered[1], j.covered[2], j.covered[3]);
    return j;
}
