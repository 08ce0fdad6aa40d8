/* SPDX-License-Identifier: MIT
 *
 * Passes over the picture until the budget is spent.
 */
#include <stdatomic.h>
#include <time.h>

#include "internal.h"
#include "parallel.h"
#include "random.h"

/* Of work between two looks at the limits; a pass that takes twice as long is parted. */
#define PASS_SECONDS 1.0

static double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Brings all tiles to the same number of samples, unless it is over before. */
struct pass {
    struct raycast *rc;
    raycast_stop_fn *stop;
    void *user;
    uint32_t samples;        /* that each pixel is to have */
    double deadline_seconds; /* of clock_seconds */
    atomic_bool over;
    atomic_uint_fast64_t rays, not_finite;
};

static bool pass_is_over(struct pass *pass)
{
    if (!atomic_load(&pass->over) &&
        ((pass->stop != NULL && pass->stop(pass->user)) || clock_seconds() >= pass->deadline_seconds))
        atomic_store(&pass->over, true);
    return atomic_load(&pass->over);
}

static void render_sample(struct raycast *rc, uint32_t x, uint32_t y, uint32_t sample, uint64_t *rays,
                          uint64_t *not_finite)
{
    const size_t pixel = (size_t)y * rc->film.width + x;
    struct random r = random_begin(rc->settings.seed, pixel, sample);
    const float px = ((float)x + random_float(&r)) / (float)rc->film.width;
    const float py = ((float)y + random_float(&r)) / (float)rc->film.height;
    struct path_sample s;
    const struct camera_ray ray = camera_ray(&rc->camera, px, py);
    integrator_path(&rc->integrator, &ray, &r, rays, &s);
    if (!film_add(&rc->film, pixel, &s, s.hit ? camera_depth(&rc->camera, s.position) : 0.0f))
        ++*not_finite;
}

static void render_tile_sample(struct raycast *rc, uint32_t tile, uint32_t sample, uint64_t *rays,
                               uint64_t *not_finite)
{
    const uint32_t across = film_tiles_across(&rc->film);
    const uint32_t x0 = tile % across * FILM_TILE, y0 = tile / across * FILM_TILE;
    for (uint32_t y = y0; y < y0 + FILM_TILE && y < rc->film.height; y++)
        for (uint32_t x = x0; x < x0 + FILM_TILE && x < rc->film.width; x++)
            render_sample(rc, x, y, sample, rays, not_finite);
}

static void render_tile(void *context, uint32_t tile)
{
    struct pass *pass = context;
    uint32_t *samples = &pass->rc->film.tile_samples[tile];
    uint64_t rays = 0, not_finite = 0;
    for (; *samples < pass->samples && !pass_is_over(pass); ++*samples)
        render_tile_sample(pass->rc, tile, *samples, &rays, &not_finite);
    atomic_fetch_add(&pass->rays, rays);
    atomic_fetch_add(&pass->not_finite, not_finite);
}

/* A run of passes: where it began, and what has come of it. */
struct run {
    const struct raycast_budget *budget;
    void *user;
    double start_seconds, start_samples; /* mean samples */
    uint64_t start_rays, start_not_finite;
    uint32_t pass_start, pass_end; /* samples before and after the pass */
    double pass_seconds;
    struct raycast_progress progress;
};

static bool is_spent(const struct run *run)
{
    const struct raycast_budget *b = run->budget;
    const struct raycast_progress *p = &run->progress;
    return (b->samples > 0 && p->samples >= b->samples) || (b->seconds > 0.0 && p->seconds >= b->seconds) ||
           (b->error > 0.0 && p->error <= b->error);
}

/* Seconds until the nearest limit; infinite where none can be foreseen. */
static double estimate_seconds_left(const struct run *run)
{
    const struct raycast_budget *b = run->budget;
    const struct raycast_progress *p = &run->progress;
    const double done = p->mean_samples - run->start_samples;
    const double per_sample = done > 0.0 ? p->seconds / done : INFINITY;
    double left = INFINITY;
    if (b->samples > 0 && done > 0.0)
        left = per_sample * fmax(0.0, b->samples - p->mean_samples);
    if (b->seconds > 0.0)
        left = fmin(left, b->seconds - p->seconds);
    if (b->error > 0.0 && isfinite(p->error) && done > 0.0) {
        const double ratio = p->error / b->error; /* the error falls with the root of the samples */
        left = fmin(left, per_sample * p->mean_samples * (ratio * ratio - 1.0));
    }
    return left;
}

static void progress_update(struct run *run, const struct raycast *rc)
{
    struct raycast_progress *p = &run->progress;
    *p = (struct raycast_progress){
        .samples = film_samples(&rc->film),
        .mean_samples = film_mean_samples(&rc->film),
        .seconds = clock_seconds() - run->start_seconds,
        .error = film_error(&rc->film),
        .rays = rc->rays - run->start_rays,
        .not_finite = rc->not_finite - run->start_not_finite,
        .fraction = 1.0,
    };
    if (is_spent(run))
        return;
    p->seconds_left = estimate_seconds_left(run);
    p->fraction = p->seconds / (p->seconds + p->seconds_left);
}

/* Samples of the next pass: as many as fit PASS_SECONDS and the limits, at most twice the last pass. */
static uint32_t next_pass(const struct run *run)
{
    const struct raycast_progress *p = &run->progress;
    const uint32_t last = run->pass_end - run->pass_start;
    double n = 1.0;
    if (last > 0) {
        const double per_sample = fmax(run->pass_seconds / last, 1e-9);
        double seconds = PASS_SECONDS;
        if (run->budget->seconds > 0.0)
            seconds = fmin(seconds, run->budget->seconds - p->seconds);
        n = fmax(1.0, fmin(floor(seconds / per_sample), 2.0 * last));
    }
    if (run->budget->samples > 0)
        n = fmin(n, (double)run->budget->samples - p->samples);
    return (uint32_t)n;
}

/* Works at the pass, or at the next one, until it is done or a part of it. */
static void work(struct run *run, struct raycast *rc)
{
    const double now = clock_seconds();
    if (run->progress.samples >= run->pass_end) {
        const uint32_t samples = next_pass(run);
        run->pass_start = run->progress.samples;
        run->pass_end = run->pass_start + samples;
        run->pass_seconds = 0.0;
    }
    struct pass pass = { .rc = rc,
                         .stop = run->budget->stop,
                         .user = run->user,
                         .samples = run->pass_end,
                         .deadline_seconds = now + 2.0 * PASS_SECONDS };
    if (run->budget->seconds > 0.0)
        pass.deadline_seconds = fmin(pass.deadline_seconds, run->start_seconds + run->budget->seconds);
    raycast_parallel_for(rc->settings.threads, (uint32_t)film_tile_count(&rc->film), render_tile, &pass);
    rc->rays += atomic_load(&pass.rays);
    rc->not_finite += atomic_load(&pass.not_finite);
    run->pass_seconds += clock_seconds() - now;
}

static bool is_stopped(const struct run *run)
{
    return run->budget->stop != NULL && run->budget->stop(run->user);
}

bool raycast_render(struct raycast *rc, const struct raycast_budget *budget, raycast_progress_fn *progress,
                    void *user, struct raycast_progress *last)
{
    struct run run = {
        .budget = budget,
        .user = user,
        .start_seconds = clock_seconds(),
        .start_samples = film_mean_samples(&rc->film),
        .start_rays = rc->rays,
        .start_not_finite = rc->not_finite,
    };
    bool go_on = true;
    progress_update(&run, rc);
    while (go_on && !is_spent(&run) && !is_stopped(&run)) {
        work(&run, rc);
        progress_update(&run, rc);
        go_on = progress == NULL || progress(&run.progress, user);
    }
    if (last != NULL)
        *last = run.progress;
    return is_spent(&run);
}
