/* SPDX-License-Identifier: MIT
 * How long the gather cycle of a light cell is, and what its mean is then (gathered.glsl). Cycles of all
 * cells are rough at first. Cells that are seen, where they are visited more often than others, need only one
 * rough cycle, and go on to long ones when light has nearly settled. */
#ifndef SDFGI_GATHER_CYCLE_GLSL
#define SDFGI_GATHER_CYCLE_GLSL

#include "gathered.glsl"
#include "seen.glsl"

struct gather_cycle {
    bool ends;  /* with this visit */
    bool ahead; /* the cell is seen, and visited more often than others */
    uint mean;  /* what it makes: GATHERED_FIRST, _ROUGH, _COMPLETE or _LONG */
};

/* Visits in a cycle of a cell whose light drifts: more than an epoch has, so that none ends meanwhile. */
uint gather_cycle_drifting_visits()
{
    return sdfgi_frame.cycle_visits * (uint(SDFGI_EPOCH_FRAMES) / sdfgi_frame.cycle_visits + 1u);
}

/* `state` is that before the visit; `others_visits`, how many visits cells have in a cycle that are not seen.
 */
gather_cycle gather_cycle_of(uint cascade, uint entry, gathered_state state, uint others_visits)
{
    gather_cycle cycle;
    cycle.ahead = sdfgi_frame.cascades[cascade].watched_first < sdfgi_frame.cascades[cascade].watched_end &&
                  seen_holds(cascade, entry);
    const bool drifts = state.mean == GATHERED_DRIFTS, is_first = state.mean < GATHERED_FIRST,
               is_long = state.mean >= GATHERED_GOES_ON || drifts && cycle.ahead,
               is_complete = state.mean == GATHERED_COMPLETE || cycle.ahead && !is_first;
    const uint visits = is_long       ? gathered_long_visits()
                        : drifts      ? gather_cycle_drifting_visits()
                        : is_complete ? sdfgi_frame.cycle_visits
                                      : others_visits;
    cycle.ends = state.visits + 1u >= visits;
    cycle.mean = is_long                              ? GATHERED_LONG
                 : visits >= sdfgi_frame.cycle_visits ? GATHERED_COMPLETE
                 : is_first                           ? GATHERED_FIRST
                                                      : GATHERED_ROUGH;
    return cycle;
}

/* Visits before this one in the sequence of rays: the first long cycle begins where the complete one ended,
 * and while light drifts each epoch goes on where the one before ended. */
uint gather_cycle_visits_before(gathered_state state)
{
    if (state.mean == GATHERED_DRIFTS)
        return (state.visits + uint(SDFGI_EPOCH_FRAMES) * sdfgi_frame.epoch) % gathered_long_visits();
    return state.mean >= GATHERED_GOES_ON ? (state.visits + sdfgi_frame.cycle_visits) % gathered_long_visits()
                                          : state.visits;
}

/* Difference of two colours over the brighter one, at most 1. */
float gather_cycle_difference(vec3 a, vec3 b)
{
    const vec3 difference = abs(a - b), larger = max(a, b);
    const float most = max(difference.r, max(difference.g, difference.b));
    return min(most / (max(larger.r, max(larger.g, larger.b)) + sdfgi_frame.dark), 1.0);
}

/* How far the mean of a cycle that ends differs from that of as many visits before; 1 if there is none. A
 * first long cycle tells no change: light was steady when it began, and its rays are others. */
float gather_cycle_change(gather_cycle cycle, gathered_state state, vec3 mean, vec3 last)
{
    if (state.mean == GATHERED_GOES_ON)
        return 0.0;
    const bool alike = cycle.mean >= GATHERED_COMPLETE
                           ? state.mean == cycle.mean
                           : state.mean == GATHERED_FIRST || state.mean == GATHERED_ROUGH;
    return alike ? gather_cycle_difference(mean, last) : 1.0;
}

/* What a cell's mean is after a cycle that has ended, over which its light has changed so far. Light makes
 * one bounce in a cycle: where it still changes, cycles stay short. A cycle repeats its rays, so that a
 * change is no noise. */
uint gather_cycle_mean(gather_cycle cycle, gathered_state state, float change)
{
    const bool goes_on = state.mean == GATHERED_COMPLETE && cycle.ahead && change < SDFGI_SMALL_CHANGE &&
                         gathered_long_visits() > sdfgi_frame.cycle_visits;
    return goes_on ? GATHERED_GOES_ON : cycle.mean;
}

#endif
