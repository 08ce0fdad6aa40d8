/* SPDX-License-Identifier: MIT
 * Stage 7: places the probes of a cascade, gives new ones a start, traces this frame's rays, publishes
 * irradiance. */
#include "internal.h"

static void record_probes(struct frame *frame, enum pass pass, uint32_t c, uint64_t work)
{
    const uint32_t probes = (uint32_t)frame->gi->resources->extent.probes;
    pass_begin(frame, pass);
    const struct sdfgi_cascade_args args = { c };
    pass_dispatch(frame, pass, PASS_ARGS(args), probes, 1, 1);
    frame->gi->passes[pass].work += work;
    pass_end(frame);
}

void probe_place_record(struct frame *frame, uint32_t c)
{
    record_probes(frame, PASS_PROBE_PLACE, c, frame->gi->resources->extent.probes);
}

void probe_reset_record(struct frame *frame, uint32_t c)
{
    const struct extent *e = &frame->gi->resources->extent;
    const uint64_t rays = 4 * e->probes * e->ring_samples,
                   sums = (uint64_t)16 * SDFGI_SUMS_STRIDE * e->probes,
                   previous = (uint64_t)8 * SDFGI_IRRADIANCE_COUNT * e->probes;
    pass_clear(frame, RESOURCE_RAYS, c * rays, rays);
    pass_clear(frame, RESOURCE_SUMS, c * sums, sums);
    if (frame->gi->cascades[c].fresh)
        pass_clear(frame, RESOURCE_PREVIOUS, c * previous, previous);
}

void probe_seed_record(struct frame *frame, uint32_t c)
{
    record_probes(frame, PASS_PROBE_SEED, c, frame->gi->resources->extent.probes);
}

void ray_invalidate_record(struct frame *frame, uint32_t cascades)
{
    const struct extent *e = &frame->gi->resources->extent;
    pass_begin(frame, PASS_RAY_INVALIDATE);
    pass_dispatch(frame, PASS_RAY_INVALIDATE, NO_ARGS, (uint32_t)e->probes, cascades, 1);
    frame->gi->passes[PASS_RAY_INVALIDATE].work += e->probes * e->ring_samples * cascades;
    pass_end(frame);
}

/* All cascades at once: rays of one do not wait for the longest of another. */
static void record_cascades(struct frame *frame, enum pass pass, struct pass_args args,
                            uint32_t groups, uint64_t work)
{
    struct sdfgi *gi = frame->gi;
    pass_begin(frame, pass);
    pass_dispatch(frame, pass, args, groups, gi->settings.cascades, 1);
    gi->passes[pass].work += work * gi->settings.cascades;
    pass_end(frame);
}

void ray_list_record(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    const uint32_t rays = (uint32_t)gi->resources->extent.probes * gi->params.rays_per_frame;
    record_cascades(frame, PASS_RAY_LIST, NO_ARGS,
                    (rays + SDFGI_GROUP_RAYS - 1) / SDFGI_GROUP_RAYS, rays);
}

void probe_trace_record(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    pass_begin(frame, PASS_PROBE_TRACE);
    pass_dispatch_indirect(frame, PASS_PROBE_TRACE, NO_ARGS, SDFGI_INDIRECT_RAYS);
    /* Comes back frames later: as many as the newest frame known has traced. */
    gi->passes[PASS_PROBE_TRACE].work += gi->counters[SDFGI_COUNTER_RAYS_TRACED];
    pass_end(frame);
}

void probe_sum_record(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    const uint32_t probes = (uint32_t)gi->resources->extent.probes;
    record_cascades(frame, PASS_PROBE_SUM, NO_ARGS, probes,
                    probes * gi->params.rays_per_frame);
}

void probe_blend_record(struct frame *frame, bool ring_ends)
{
    const struct sdfgi *gi = frame->gi;
    const uint32_t probes = (uint32_t)gi->resources->extent.probes;
    const struct sdfgi_probe_blend_args args = { .cycle_ends = ring_ends,
                                                 .without_history = gi->cascades[0].fresh };
    record_cascades(frame, PASS_PROBE_BLEND, PASS_ARGS(args), probes, probes);
}
