/* SPDX-License-Identifier: MIT
 * A workgroup shares the rays of a probe, and the boxes of what changed. Included by ray_invalidate. */

layout(local_size_x = SDFGI_GROUP_RAYS) in;

/* Hits that a thread tests together, because their loads overlap. */
const uint HITS = 4u;

/* Those of a cascade, in the order of dirty_bounds.glsl; then one box around those of either kind. */
shared bounds_box boxes[2u * STRIPS + 2u];

/* The cached hits that this thread tests, and whether they are to be invalidated. */
uint hit_codes[HITS];
bool hit_dirty[HITS];

bounds_box loaded_box(uint cascade, uint i)
{
    return boxes[i];
}

/* Fills `boxes`. Called by the whole workgroup. */
void load_boxes(uint cascade)
{
    const uint lane = gl_LocalInvocationIndex;
    barrier();
    if (lane < 2u * STRIPS)
        boxes[lane] = box_of(cascade, lane);
    barrier();
    if (lane < 2u) {
        bounds_box all = boxes[lane * STRIPS];
        for (uint i = lane * STRIPS + 1u; i < (lane + 1u) * STRIPS; i++)
            all = box_around(all, boxes[i]);
        boxes[2u * STRIPS + lane] = all;
    }
    barrier();
}

/* Sample of a thread's k-th hit, of those from `first` on. */
uint hit_sample(uint first, uint k)
{
    return first + k * uint(SDFGI_GROUP_RAYS) + gl_LocalInvocationIndex;
}

void load_hits(changed_probe own, uint first)
{
    for (uint k = 0u; k < HITS; k++) {
        const uint s = hit_sample(first, k);
        hit_codes[k] = s < sdfgi_frame.cycle_samples ? sdfgi_rays_at(own.cache + s) : SDFGI_RAY_UNKNOWN;
        hit_dirty[k] = own.all_dirty;
    }
}

/* Tests the hits against the change of a cascade. Called by the whole workgroup. */
void test_hits(uint cascade, changed_probe own, uint first)
{
    if (bounds_axis(cascade) >= 0)
        load_boxes(cascade);
    const changed_cascade c = changed(cascade, own.start, boxes[2u * STRIPS], boxes[2u * STRIPS + 1u]);
    for (uint k = 0u; k < HITS; k++) {
        if (hit_dirty[k])
            continue;
        float end;
        const uint state = hit_state(c, hit_codes[k], end);
        hit_dirty[k] = state == HIT_IS_DIRTY ||
                       state == HIT_ASKS_RAY && ray_is_dirty(c, own.probe, hit_sample(first, k), end);
    }
}

void store_hits(changed_probe own, uint first)
{
    for (uint k = 0u; k < HITS; k++)
        if (hit_codes[k] != SDFGI_RAY_UNKNOWN && hit_dirty[k])
            sdfgi_rays[own.cache + hit_sample(first, k)] = SDFGI_RAY_UNKNOWN;
}

void main()
{
    changed_probe own;
    if (!find_probe(gl_WorkGroupID.x, own))
        return;
    for (uint first = 0u; first < sdfgi_frame.cycle_samples; first += HITS * uint(SDFGI_GROUP_RAYS)) {
        load_hits(own, first);
        for (uint c = own_cascade(); c < sdfgi_frame.cascade_count; c++)
            if (dirty_count(c) > 0)
                test_hits(c, own, first);
        store_hits(own, first);
    }
    forget_emitters(own.slot, gl_LocalInvocationIndex, uint(SDFGI_GROUP_RAYS));
}
