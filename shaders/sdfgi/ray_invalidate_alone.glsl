/* SPDX-License-Identifier: MIT
 * A thread tests rays of a probe alone, for software drivers: where threads wait for one another, these
 * drivers keep all variables in memory, and they run what is under a condition in any case. Few hits ask
 * where their ray went: a thread goes on to the next one that does. A workgroup has as many probes as it has
 * threads for, since threads without rays take as long. Included by ray_invalidate. */
#include "../shared/threads.h"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

bounds_box loaded_box(uint cascade, uint i)
{
    return box_of(cascade, i);
}

bounds_box box_around_kind(uint cascade, uint first)
{
    bounds_box all = box_of(cascade, first);
    for (uint i = SDFGI_ZERO + 1u; i < STRIPS; i++)
        all = box_around(all, box_of(cascade, first + i));
    return all;
}

void forget_hit(changed_probe own, uint s)
{
    sdfgi_rays[own.cache + s] = SDFGI_RAY_UNKNOWN;
}

/* Goes on to the next hit before `last` whose ray decides. False if there is none. */
bool next_ray(changed_cascade c, changed_probe own, uint last, inout uint s, out float end)
{
    uint state = HIT_IS_KEPT;
    for (; state != HIT_ASKS_RAY && s < last; s++) {
        const uint code = sdfgi_rays[own.cache + s];
        state = hit_state(c, code, end);
        if (state == HIT_IS_DIRTY || (own.all_dirty && code != SDFGI_RAY_UNKNOWN)) {
            forget_hit(own, s);
            state = HIT_IS_DIRTY;
        }
    }
    return state == HIT_ASKS_RAY;
}

void test_hits(uint cascade, changed_probe own, uint first, uint last)
{
    const changed_cascade c = changed(cascade, own.start, box_around_kind(cascade, BOUNDS_REMOVED),
                                      box_around_kind(cascade, BOUNDS_ADDED));
    uint s = first;
    float end;
    while (next_ray(c, own, last, s, end))
        if (ray_is_dirty(c, own.probe, s - 1u, end))
            forget_hit(own, s - 1u);
}

/* The next cascade with a change, from one on. */
uint next_changed(uint cascade)
{
    while (cascade < sdfgi_frame.cascade_count && dirty_count(cascade) == 0)
        cascade++;
    return cascade;
}

void main()
{
    const uint samples = sdfgi_frame.cycle_samples, threads = sdfgi_invalidate_threads(samples),
               probes = uint(SDFGI_GROUP_LINEAR) / threads, rays = sdfgi_invalidate_rays(samples);
    const uint in_group = gl_LocalInvocationIndex / threads, lane = gl_LocalInvocationIndex % threads,
               linear = gl_WorkGroupID.x * probes + in_group, side = sdfgi_frame.probes_per_side;
    const uint first = lane * rays, last = min(first + rays, samples);
    changed_probe own;
    if (in_group >= probes || linear >= side * side * side || !find_probe(linear, own))
        return;
    for (uint c = next_changed(own_cascade()); c < sdfgi_frame.cascade_count; c = next_changed(c + 1u))
        test_hits(c, own, first, last);
    forget_emitters(own.slot, lane, threads);
}
