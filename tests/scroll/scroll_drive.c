/* SPDX-License-Identifier: MIT */
#include "scroll_drive.h"

#include "require.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

struct scroll_drive scroll_drive_begin(uint32_t resolution, uint64_t max_cells)
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.resolution = resolution;
    struct scroll_drive drive = { .limits = { .max_cells = max_cells } };
    sdfgi_scroll_init(&drive.scroll);
    sdfgi_cascades_init(&drive.cascades, &settings);
    return drive;
}

static uint64_t piece_cells(const struct scroll_drive *drive)
{
    const uint64_t n = drive->cascades.resolution;
    uint64_t cells = 0;
    for (uint32_t i = 0; i < drive->plan.piece_count; i++) {
        const struct scroll_piece *piece = &drive->plan.pieces[i];
        cells += piece->kind == PIECE_VOXELS ? sdfgi_cell_box_cells(&piece->box) : piece->count * n * n * 4;
    }
    return cells;
}

uint64_t scroll_drive_frame(struct scroll_drive *drive, const double camera[static 3])
{
    sdfgi_scroll_plan(&drive->scroll, &drive->cascades, &drive->limits, camera, false, &drive->plan);
    const uint64_t cells = piece_cells(drive);
    REQUIRE_CMP(cells, ==, drive->plan.cells);
    drive->completed = sdfgi_cascades_complete(&drive->cascades);
    sdfgi_scroll_finish(&drive->scroll, &drive->cascades);
    return cells;
}

bool scroll_drive_covers(const struct cascade *cascade, const double camera[static 3], double cells)
{
    for (int i = 0; i < 3; i++) {
        const double at = camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        if (at - cells < cascade->valid.low[i] || at + cells > cascade->valid.high[i])
            return false;
    }
    return true;
}

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

static void print(const char *what, const struct trip *trip)
{
    printf(
        "%s: cells a frame: median %llu, p99 %llu, most %llu; of %u frames with 40 cells around the camera: "
        "%u %u %u %u\n",
        what, (unsigned long long)trip->median, (unsigned long long)trip->p99, (unsigned long long)trip->most,
        trip->frames, trip->covered[0], trip->covered[1], trip->covered[2], trip->covered[3]);
}

struct trip scroll_drive_trip(struct scroll_drive *drive, const char *what, uint32_t skip, uint32_t frames,
                              void (*where)(const void *user, uint32_t i, double camera[static 3]),
                              const void *user)
{
    uint64_t *work = test_array_alloc(frames, sizeof *work);
    struct trip trip = { .frames = frames, .apart = UINT32_MAX };
    uint32_t since = frames;
    double camera[3];
    for (uint32_t i = 0; i < skip + frames; i++) {
        where(user, i, camera);
        const uint64_t cells = scroll_drive_frame(drive, camera);
        if (i < skip)
            continue;
        work[i - skip] = cells;
        since++;
        if (drive->completed) {
            trip.apart = since < trip.apart ? since : trip.apart;
            since = 0;
        }
        for (uint32_t c = 0; c < drive->cascades.count; c++)
            trip.covered[c] += scroll_drive_covers(&drive->cascades.at[c], camera, 40);
    }
    qsort(work, frames, sizeof *work, compare);
    trip.median = work[frames / 2];
    trip.p99 = work[frames * 99 / 100];
    trip.most = work[frames - 1];
    free(work);
    print(what, &trip);
    return trip;
}
