/* SPDX-License-Identifier: MIT */
#include "picture.h"

#include <math.h>
#include <string.h>

struct problem sdfgi_picture_problem(const struct sdfgi_gather_desc *d)
{
    struct problem p = { "" };
    if (!d->depth || !d->normal || !d->output)
        sdfgi_problem_add(&p, "%s is null", !d->depth ? "depth" : !d->normal ? "normal" : "output");
    if (d->width == 0 || d->height == 0)
        sdfgi_problem_add(&p, "%s is 0", d->width == 0 ? "width" : "height");
    if ((unsigned)d->resolution > SDFGI_GATHER_QUARTER)
        sdfgi_problem_add(&p, "resolution is %d, must be one of enum sdfgi_gather_resolution",
                          (int)d->resolution);
    sdfgi_problem_floats(&p, "inverse_view_projection", d->inverse_view_projection, 16, -INFINITY, INFINITY);
    sdfgi_problem_floats(&p, "scale", &d->scale, 1, 0, INFINITY);
    static const float zero[16];
    if (memcmp(zero, d->inverse_view_projection, sizeof zero) == 0)
        sdfgi_problem_add(&p, "inverse_view_projection is 0");
    return p;
}

void sdfgi_picture_check_size(struct problem *p, const VkPhysicalDeviceLimits *limits, uint32_t width,
                              uint32_t height)
{
    const unsigned most = limits->maxImageDimension2D;
    if (width > most || height > most)
        sdfgi_problem_add(p, "%s is %u, must be at most maxImageDimension2D = %u",
                          width > most ? "width" : "height", width > most ? width : height, most);
    const uint32_t x = (width + SDFGI_GROUP_PIXELS - 1) / SDFGI_GROUP_PIXELS,
                   y = (height + SDFGI_GROUP_PIXELS - 1) / SDFGI_GROUP_PIXELS;
    if (x > limits->maxComputeWorkGroupCount[0] || y > limits->maxComputeWorkGroupCount[1])
        sdfgi_problem_add(p, "%u x %u pixels take more workgroups than maxComputeWorkGroupCount",
                          (unsigned)width, (unsigned)height);
}

uint32_t sdfgi_picture_step(enum sdfgi_gather_resolution resolution)
{
    static const uint32_t steps[] = {
        [SDFGI_GATHER_FULL] = 1, [SDFGI_GATHER_HALF] = 2, [SDFGI_GATHER_QUARTER] = SDFGI_SAMPLE_STEP_MAX
    };
    return steps[resolution];
}

struct work sdfgi_picture_work(const struct sdfgi_gather_desc *d)
{
    struct work work = {
        .pass = d->resolution == SDFGI_GATHER_FULL ? PASS_GATHER : PASS_GATHER_SPARSE,
        .indirect = WORK_DIRECT,
        .units = (uint64_t)d->width * d->height,
        .args.gather = { .width = d->width,
                         .height = d->height,
                         .background_depth = d->background_depth,
                         .step = sdfgi_picture_step(d->resolution),
                         .scale = d->scale > 0 ? d->scale : 1 },
    };
    memcpy(work.args.gather.inverse_view_projection, d->inverse_view_projection,
           sizeof work.args.gather.inverse_view_projection);
    return work;
}
