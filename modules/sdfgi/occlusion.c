/* SPDX-License-Identifier: MIT
 * Stage 5: 16x16 depths around each probe of a cascade, where lookups are weighed by them. */
#include "internal.h"

void occlusion_record(struct frame *frame, uint32_t c)
{
    if (!frame->gi->plan[PASS_OCCLUSION_TRACE].run)
        return;
    const uint32_t probes = (uint32_t)frame->gi->resources->extent.probes;
    const struct sdfgi_cascade_args args = { .cascade = c };
    pass_begin(frame, PASS_OCCLUSION_TRACE);
    pass_dispatch(frame, PASS_OCCLUSION_TRACE, PASS_ARGS(args), probes, 1, 1);
    frame->gi->passes[PASS_OCCLUSION_TRACE].work +=
        (uint64_t)probes * SDFGI_OCCLUSION_TEXELS * SDFGI_OCCLUSION_TEXELS;
    pass_end(frame);
}
