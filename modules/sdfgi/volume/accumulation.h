/* SPDX-License-Identifier: MIT
 * Sample cycles, what has been shown of their light, and when it has converged. Plain data: the only place
 * that changes these states. */
#ifndef SDFGI_ACCUMULATION_H
#define SDFGI_ACCUMULATION_H

#include <stdbool.h>
#include <stdint.h>

/* Light may have converged if no probe texel changes by more than this over a cycle, relative to its light.
 * It is a little more than 1/1024, because stored light is rounded by that much. */
#define ACCUMULATION_CONVERGED_CHANGE (1.01f / 1024.0f)

enum lighting_phase {
    LIGHTING_DARK,        /* no probe holds light */
    LIGHTING_FIRST_CYCLE, /* probes hold light of a part of a cycle */
    LIGHTING_RUNNING,     /* a cycle has been completed since there was nothing */
    LIGHTING_CONVERGED,   /* nothing changes any more: no work */
};

/* Since light was last invalidated. Light that fills or fades slowly drifts to one side, and light that goes
 * round in circles of its rounding does not. So how far it has come is measured over spans of cycles, too:
 * from one that marks how much light there is to the next. */
struct convergence {
    float change, least; /* of the newest cycle, and of all */
    uint32_t cycles_without_fall;
    float pace; /* change over the newest span, for each of its cycles */
};

/* True if light is marked at the end of a cycle. `invalid_cycle` is the last one with light from before it
 * was invalidated. */
bool sdfgi_cycle_marks(uint64_t cycle, uint64_t invalid_cycle);
/* Cycles of the span that ends with a cycle; 0: none does. */
uint32_t sdfgi_cycle_span(uint64_t cycle, uint64_t invalid_cycle);

void sdfgi_convergence_reset(struct convergence *convergence);
/* Takes in the largest relative change over a cycle: of a probe texel, or of a light cell along an axis. */
void sdfgi_convergence_add(struct convergence *convergence, float change);
/* Takes in the largest relative change over a span of so many cycles: of a probe, or of a light cell. Without
 * a cycle there is none. */
void sdfgi_convergence_add_drift(struct convergence *convergence, float drift, uint32_t cycles);
bool sdfgi_convergence_done(const struct convergence *convergence);

struct accumulation {
    enum lighting_phase phase;
    uint64_t cycle;         /* cycles are numbered from 1 */
    uint32_t frame;         /* of the cycle */
    uint64_t invalid_cycle; /* the last one with light from before it was invalidated */
    uint64_t invalidations; /* so far */
    uint32_t rays_missing;  /* frames of rays until all rays of a cycle are cached */
    struct convergence convergence;
    /* Of the newest cycle that came back from the GPU; 0: none has. */
    uint64_t known_cycle;
    float known_change;
};

void sdfgi_accumulation_init(struct accumulation *a);
/* The light is no longer what it was: go on until it has converged again. */
void sdfgi_accumulation_invalidate(struct accumulation *a);
/* Begins a cycle anew: what this one has gathered does not count. */
void sdfgi_accumulation_restart(struct accumulation *a);
/* Nothing is stored any more: no probe holds light. */
void sdfgi_accumulation_go_dark(struct accumulation *a);
/* A cycle that ended came back from the GPU. */
void sdfgi_accumulation_add_known(struct accumulation *a, uint64_t cycle, float change, float drift);
/* Probes were given the light of this frame. */
void sdfgi_accumulation_show(struct accumulation *a, bool cycle_ends);
/* Goes on to the next frame of the cycle. `rests`: no other work is left, so that light may count as
 * converged. */
void sdfgi_accumulation_advance(struct accumulation *a, uint32_t cycle_frames, bool rests);

bool sdfgi_accumulation_cycle_ends(const struct accumulation *a, uint32_t cycle_frames);
/* True if probes mark how much light they have at the end of this cycle. */
bool sdfgi_accumulation_marks(const struct accumulation *a);

#endif
