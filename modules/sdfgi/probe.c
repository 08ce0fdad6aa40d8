/* SPDX-License-Identifier: MIT
 * Stage 7: places the probes of a cascade, gives new ones a start, traces this frame's rays, publishes
 * irradiance. */
#include "internal.h"

static void record_probes(struct frame *frame, enum pass pass, uint32_t c, uint64_t work)
{
    const uint32_t probes = (uint32_t)frame->gi->resources->extent.probes;
    pass_begin(frame, pass);
    pass_dispatch(frame, pass, &(struct sdfgi_pass_args){ .cascade = c }, probes, 1, 1);
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
                   sums = (uint64_t)16 * SDFGI_IRRADIANCE_COUNT * e->probes;
    pass_clear(frame, RESOURCE_RAYS, c * rays, rays);
    pass_clear(frame, RESOURCE_SUMS, c * sums, sums);
    if (frame->gi->cascades[c].fresh)
        pass_clear(frame, RESOURCE_PREVIOUS, c * sums / 2, sums / 2);
}

void probe_seed_record(struct frame *frame, uint32_t c)
{
    record_probes(frame, PASS_PROBE_SEED, c, frame->gi->resources->extent.probes);
}

void ray_forget_record(struct frame *frame, uint32_t cascades)
{
    const struct extent *e = &frame->gi->resources->extent;
    pass_begin(frame, PASS_RAY_FORGET);
    pass_dispatch(frame, PASS_RAY_FORGET, &(struct sdfgi_pass_args){ 0 }, (uint32_t)e->probes, cascades, 1);
    frame->gi->passes[PASS_RAY_FORGET].work += e->probes * e->ring_samples * cascades;
    pass_end(frame);
}

void probe_trace_record(struct frame *frame, uint32_t c)
{
    struct sdfgi *gi = frame->gi;
    const struct sdfgi_pass_args args = { .cascade = c, .fresh = gi->cascades[c].fresh };
    pass_begin(frame, PASS_PROBE_TRACE);
    pass_dispatch(frame, PASS_PROBE_TRACE, &args, (uint32_t)gi->resources->extent.probes, 1, 1);
    gi->passes[PASS_PROBE_TRACE].work += gi->resources->extent.probes * gi->params.ring.x;
    pass_end(frame);
}

void probe_blend_record(struct frame *frame, uint32_t c, bool ring_ends)
{
    struct sdfgi *gi = frame->gi;
    const struct sdfgi_pass_args args = { .cascade = c, .step = ring_ends, .fresh = gi->cascades[c].fresh };
    pass_begin(frame, PASS_PROBE_BLEND);
    pass_dispatch(frame, PASS_PROBE_BLEND, &args, (uint32_t)gi->resources->extent.probes, 1, 1);
    gi->passes[PASS_PROBE_BLEND].work += gi->resources->extent.probes;
    pass_end(frame);
}
