/* SPDX-License-Identifier: MIT
 *
 * Passes over the picture until the budget is spent.
 */
#include <stdatomic.h>
#include <time.h>

#include "internal.h"
#include "parallel.h"
#include "random.h"

#define TILE_PIXELS  16  /* a side: small enough to even out the threads, large enough to keep their caches */
#define PASS_SECONDS 1.0 /* how often progress is told and limits are looked at */

static double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct pass {
    struct raycast *rc;
    uint32_t first_sample, sample_count;
    atomic_uint_fast64_t rays, not_finite;
};

static uint32_t tiles_across(uint32_t pixels)
{
    return (pixels + TILE_PIXELS - 1) / TILE_PIXELS;
}

static void render_sample(struct raycast *rc, uint32_t x, uint32_t y, uint32_t sample, uint64_t *rays,
                          uint64_t *not_finite)
{
    const size_t pixel = (size_t)y * rc->film.width + x;
    struct random r = random_begin(rc->settings.seed, pixel, sample);
    const float px = ((float)x + random_float(&r)) / (float)rc->film.width;
    const float py = ((float)y + random_float(&r)) / (float)rc->film.height;
    struct path_sample s;
    integrator_path(&rc->integrator, rc->camera.position, camera_direction(&rc->camera, px, py), &r, rays,
                    &s);
    if (!film_add(&rc->film, pixel, &s, s.hit ? camera_depth(&rc->camera, s.position) : 0.0f))
        ++*not_finite;
}

static void render_tile(void *context, uint32_t tile)
{
    struct pass *pass = context;
    struct raycast *rc = pass->rc;
    const uint32_t across = tiles_across(rc->film.width);
    const uint32_t x0 = tile % across * TILE_PIXELS, y0 = tile / across * TILE_PIXELS;
    uint64_t rays = 0, not_finite = 0;
    for (uint32_t y = y0; y < y0 + TILE_PIXELS && y < rc->film.height; y++) {
        for (uint32_t x = x0; x < x0 + TILE_PIXELS && x < rc->film.width; x++) {
            for (uint32_t i = 0; i < pass->sample_count; i++)
                render_sample(rc, x, y, pass->first_sample + i, &rays, &not_finite);
        }
    }
    atomic_fetch_add(&pass->rays, rays);
    atomic_fetch_add(&pass->not_finite, not_finite);
}

static void render_pass(struct raycast *rc, uint32_t sample_count)
{
    struct pass pass = { .rc = rc, .first_sample = rc->film.samples, .sample_count = sample_count };
    const uint32_t tiles = tiles_across(rc->film.width) * tiles_across(rc->film.height);
    raycast_parallel_for(rc->settings.threads, tiles, render_tile, &pass);
    rc->film.samples += sample_count;
    rc->rays += atomic_load(&pass.rays);
    rc->not_finite += atomic_load(&pass.not_finite);
}

/* A run of passes: where it began, and what has come of it. */
struct run {
    const struct raycast_budget *budget;
    double start_seconds, pass_seconds;
    uint32_t start_samples, pass_samples;
    uint64_t start_rays, start_not_finite;
    struct raycast_progress progress;
};

/* Seconds until the nearest limit; infinite where none can be foreseen. */
static double estimate_seconds_left(const struct run *run)
{
    const struct raycast_budget *b = run->budget;
    const struct raycast_progress *p = &run->progress;
    const uint32_t done = p->samples - run->start_samples;
    const double per_sample = done > 0 ? p->seconds / done : INFINITY;
    double left = INFINITY;
    if (b->samples > 0)
        left = p->samples < b->samples ? per_sample * (b->samples - p->samples) : 0.0;
    if (b->seconds > 0.0)
        left = fmin(left, fmax(0.0, b->seconds - p->seconds));
    if (b->error > 0.0 && isfinite(p->error)) {
        const double ratio = p->error / b->error; /* the error falls with the root of the samples */
        left = fmin(left, ratio > 1.0 ? per_sample * p->samples * (ratio * ratio - 1.0) : 0.0);
    }
    return left;
}

static void progress_update(struct run *run, const struct raycast *rc)
{
    struct raycast_progress *p = &run->progress;
    *p = (struct raycast_progress){
        .samples = rc->film.samples,
        .seconds = clock_seconds() - run->start_seconds,
        .error = film_error(&rc->film),
        .rays = rc->rays - run->start_rays,
        .not_finite = rc->not_finite - run->start_not_finite,
    };
    p->seconds_left = estimate_seconds_left(run);
    p->fraction = p->seconds_left > 0.0 ? p->seconds / (p->seconds + p->seconds_left) : 1.0;
}

static bool is_spent(const struct run *run)
{
    return run->progress.seconds_left <= 0.0;
}

/* Samples of the next pass: as many as fit PASS_SECONDS and the limits, at most twice the last pass. */
static uint32_t next_pass(const struct run *run)
{
    const struct raycast_progress *p = &run->progress;
    double n = 1.0;
    if (run->pass_samples > 0) {
        const double per_sample = fmax(run->pass_seconds / run->pass_samples, 1e-9);
        double seconds = PASS_SECONDS;
        if (run->budget->seconds > 0.0)
            seconds = fmin(seconds, run->budget->seconds - p->seconds);
        n = fmax(1.0, fmin(floor(seconds / per_sample), 2.0 * run->pass_samples));
    }
    if (run->budget->samples > 0)
        n = fmin(n, (double)run->budget->samples - p->samples);
    return (uint32_t)n;
}

bool raycast_render(struct raycast *rc, const struct raycast_budget *budget, raycast_progress_fn *progress,
                    void *user, struct raycast_progress *last)
{
    struct run run = {
        .budget = budget,
        .start_seconds = clock_seconds(),
        .start_samples = rc->film.samples,
        .start_rays = rc->rays,
        .start_not_finite = rc->not_finite,
    };
    bool go_on = true;
    progress_update(&run, rc);
    while (go_on && !is_spent(&run)) {
        const double before = clock_seconds();
        const uint32_t samples = next_pass(&run);
        render_pass(rc, samples);
        run.pass_samples = samples;
        run.pass_seconds = clock_seconds() - before;
        progress_update(&run, rc);
        go_on = progress == NULL || progress(&run.progress, user);
    }
    if (last != NULL)
        *last = run.progress;
    return go_on || is_spent(&run);
}
