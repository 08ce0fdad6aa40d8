/* SPDX-License-Identifier: MIT
 * A thread tests rays of a probe alone, for software drivers: where threads wait for one another, these
 * drivers keep all variables in memory, and they run what is under a condition in any case. Few hits ask
 * where their ray went: a thread goes on to the next one that does. Included by ray_invalidate. */

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

/* Rays for a thread, at least: it looks at all boxes first. If there are very many, all threads have some,
 * because these drivers end a shader whose loops go round too often. */
const uint LEAST_RAYS = 32u;

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

void main()
{
    const uint lane = gl_LocalInvocationIndex, threads = uint(SDFGI_GROUP_LINEAR);
    const uint rays = max((sdfgi_frame.cycle_samples + threads - 1u) / threads, LEAST_RAYS);
    const uint last = min((lane + 1u) * rays, sdfgi_frame.cycle_samples);
    changed_probe own;
    if (lane * rays >= last || !find_probe(gl_WorkGroupID.x, own))
        return;
    for (uint c = own_cascade(); c < sdfgi_frame.cascade_count; c++)
        if (dirty_count(c) > 0)
            test_hits(c, own, lane * rays, last);
    forget_emitters(own.slot, lane, (sdfgi_frame.cycle_samples + rays - 1u) / rays);
}
