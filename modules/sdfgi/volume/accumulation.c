/* SPDX-License-Identifier: MIT */
#include "accumulation.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

/* Light has converged below a change if so many cycles have passed without one that changed clearly less than
 * all before. Stored light is rounded, and rounding can go round in a circle. What still fills with light
 * changes less from cycle to cycle: by a tenth in 32 cycles, with a loop gain of up to 0.997. */
static const struct {
    float change;
    uint32_t cycles_without_fall;
} ends[] = {
    { ACCUMULATION_CONVERGED_CHANGE, 0 },
    { 1.0f / 256.0f, 8 },
    { 1.0f / 128.0f, 32 },
};
#define CLEARLY_LESS 0.9f

void sdfgi_convergence_reset(struct convergence *c)
{
    *c = (struct convergence){ .change = INFINITY, .least = INFINITY };
}

void sdfgi_convergence_add(struct convergence *c, float change)
{
    c->change = change;
    c->cycles_without_fall++;
    if (change < CLEARLY_LESS * c->least) {
        c->least = change;
        c->cycles_without_fall = 0;
    }
}

bool sdfgi_convergence_done(const struct convergence *c)
{
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        if (c->change < ends[i].change && c->cycles_without_fall >= ends[i].cycles_without_fall)
            return true;
    return false;
}

void sdfgi_accumulation_init(struct accumulation *a)
{
    *a = (struct accumulation){ .phase = LIGHTING_DARK, .cycle = 1 };
    sdfgi_convergence_reset(&a->convergence);
}

/* All changes of phase go through here. */
static void enter(struct accumulation *a, enum lighting_phase phase)
{
    assert(phase == a->phase || phase == LIGHTING_DARK || phase == a->phase + 1 ||
           (phase == LIGHTING_RUNNING && a->phase != LIGHTING_RUNNING));
    a->phase = phase;
}

static void wake(struct accumulation *a)
{
    if (a->phase == LIGHTING_CONVERGED)
        enter(a, LIGHTING_RUNNING);
    a->invalidations++;
    sdfgi_convergence_reset(&a->convergence);
}

void sdfgi_accumulation_invalidate(struct accumulation *a)
{
    a->invalid_cycle = a->cycle;
    wake(a);
}

void sdfgi_accumulation_restart(struct accumulation *a)
{
    a->invalid_cycle = a->cycle;
    a->cycle++;
    a->frame = 0;
    wake(a);
}

void sdfgi_accumulation_go_dark(struct accumulation *a)
{
    enter(a, LIGHTING_DARK);
}

void sdfgi_accumulation_add_known(struct accumulation *a, uint64_t cycle, float change)
{
    assert(cycle <= a->cycle);
    a->known_cycle = cycle;
    a->known_change = change;
    if (cycle > a->invalid_cycle)
        sdfgi_convergence_add(&a->convergence, change);
}

void sdfgi_accumulation_show(struct accumulation *a, bool cycle_ends)
{
    assert(a->phase != LIGHTING_CONVERGED);
    if (a->phase != LIGHTING_RUNNING)
        enter(a, cycle_ends ? LIGHTING_RUNNING : LIGHTING_FIRST_CYCLE);
}

bool sdfgi_accumulation_cycle_ends(const struct accumulation *a, uint32_t cycle_frames)
{
    return a->frame + 1 == cycle_frames;
}

void sdfgi_accumulation_advance(struct accumulation *a, uint32_t cycle_frames, bool rests)
{
    a->rays_missing -= a->rays_missing > 0;
    if (!sdfgi_accumulation_cycle_ends(a, cycle_frames)) {
        a->frame++;
        return;
    }
    if (rests && sdfgi_convergence_done(&a->convergence))
        enter(a, LIGHTING_CONVERGED);
    a->cycle++;
    a->frame = 0;
}
