/* SPDX-License-Identifier: MIT
 * Progress on the terminal. */
#include "cli.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { BAR_WIDTH = 30 };

/* Redrawing more often than this only slows a terminal down. */
static const double redraw_interval_s = 0.1;

double cli_time_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void cli_progress_begin(struct cli_progress *progress, const char *label, uint64_t total)
{
    *progress = (struct cli_progress){
        .label = label, .start_s = cli_time_s(), .total = total, .visible = isatty(STDERR_FILENO) == 1
    };
    cli_progress_update(progress, 0);
}

static void draw_bar(const struct cli_progress *progress, uint64_t done, double elapsed_s)
{
    const double share = done < progress->total ? (double)done / (double)progress->total : 1;
    const int filled = (int)(share * BAR_WIDTH);
    fprintf(stderr, "\r%s [", progress->label);
    for (int i = 0; i < BAR_WIDTH; i++)
        fputc(i < filled ? '#' : '.', stderr);
    fprintf(stderr, "] %3.0f %%", 100 * share);
    if (share > 0)
        fprintf(stderr, ", %.0f s left ", elapsed_s * (1 - share) / share);
    fputs("\033[K", stderr);
}

void cli_progress_update(struct cli_progress *progress, uint64_t done)
{
    const double now_s = cli_time_s();
    if (!progress->visible || (done > 0 && now_s - progress->drawn_s < redraw_interval_s))
        return;
    progress->drawn_s = now_s;
    if (progress->total)
        draw_bar(progress, done, now_s - progress->start_s);
    else
        fprintf(stderr, "\r%s %llu, %.0f s\033[K", progress->label, (unsigned long long)done,
                now_s - progress->start_s);
    fflush(stderr);
}

void cli_progress_end(struct cli_progress *progress)
{
    if (progress->visible)
        fputs("\r\033[K", stderr);
    progress->visible = false;
}
