/* SPDX-License-Identifier: MIT */
#include "accumulation.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

/* Spans are short at first, so that light that converges soon ends soon, and last longer the more cycles
 * there have been. Light that goes round in a wide circle is no further away after many cycles than after
 * few: long spans tell it from light that creeps. */
static uint32_t span_of(uint64_t cycles)
{
    uint32_t span = 4;
    while (cycles > 8 * span && span < 32)
        span *= 2;
    return span;
}

/* Light that goes on at this pace changes by 1 % in 30 further cycles. */
#define SETTLED_PACE (0.01f / 30.0f)

/* Light has converged if a change is below a limit, none was clearly less than all before for so many cycles,
 * and light keeps to the pace. Stored light is rounded, and rounding can go round in a circle. */
static const struct {
    float change, pace;
    uint32_t cycles_without_fall;
} ends[] = {
    { 0.75f * SETTLED_PACE, INFINITY, 0 },
    { ACCUMULATION_CONVERGED_CHANGE, SETTLED_PACE, 0 },
    { 1.0f / 256.0f, SETTLED_PACE, 8 },
    { 1.0f / 128.0f, SETTLED_PACE, 32 },
};
#define CLEARLY_LESS 0.9f

bool sdfgi_cycle_marks(uint64_t cycle, uint64_t invalid_cycle)
{
    return cycle == invalid_cycle + 1 || sdfgi_cycle_span(cycle, invalid_cycle) > 0;
}

uint32_t sdfgi_cycle_span(uint64_t cycle, uint64_t invalid_cycle)
{
    if (cycle <= invalid_cycle + 1)
        return 0;
    const uint64_t since_first = cycle - invalid_cycle - 1;
    const uint32_t span = span_of(since_first);
    return since_first % span == 0 ? span : 0;
}

void sdfgi_convergence_reset(struct convergence *c)
{
    *c = (struct convergence){ .change = INFINITY, .least = INFINITY, .pace = INFINITY };
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

void sdfgi_convergence_add_drift(struct convergence *c, float drift, uint32_t cycles)
{
    if (cycles > 0)
        c->pace = drift / (float)cycles;
}

static bool is_at_end(const struct convergence *c, size_t i)
{
    return c->change < ends[i].change && c->cycles_without_fall >= ends[i].cycles_without_fall &&
           c->pace <= ends[i].pace;
}

bool sdfgi_convergence_done(const struct convergence *c)
{
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        if (is_at_end(c, i))
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

void sdfgi_accumulation_add_known(struct accumulation *a, uint64_t cycle, float change, float drift)
{
    assert(cycle <= a->cycle);
    a->known_cycle = cycle;
    a->known_change = change;
    if (cycle > a->invalid_cycle)
        sdfgi_convergence_add(&a->convergence, change);
    sdfgi_convergence_add_drift(&a->convergence, drift, sdfgi_cycle_span(cycle, a->invalid_cycle));
}

void sdfgi_accumulation_show(struct accumulation *a, bool cycle_ends)
{
    assert(a->phase != LIGHTING_CONVERGED);
    if (a->phase != LIGHTING_RUNNING)
        enter(a, cycle_ends ? LIGHTING_RUNNING : LIGHTING_FIRST_CYCLE);
}

bool sdfgi_accumulation_marks(const struct accumulation *a)
{
    return sdfgi_cycle_marks(a->cycle, a->invalid_cycle);
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
