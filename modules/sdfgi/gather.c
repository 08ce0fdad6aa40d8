/* SPDX-License-Identifier: MIT
 * sdfgi_gather. */
#include "context.h"

#include "shaders/shared/bindings.h"

/* Sizes that no image has, or that take more workgroups than a dispatch may. */
static struct problem size_problem(const struct sdfgi *gi, const struct work *work)
{
    struct problem p = { "" };
    const VkPhysicalDeviceLimits *limits = &gi->backend.device.limits;
    const unsigned most = limits->maxImageDimension2D, width = work->args.gather.width,
                   height = work->args.gather.height;
    if (width > most || height > most)
        sdfgi_problem_add(&p, "%s is %u, must be at most maxImageDimension2D = %u",
                          width > most ? "width" : "height", width > most ? width : height, most);
    const struct work_groups groups = sdfgi_work_groups(work, &gi->volume.resources->extent, 1);
    if (groups.x > limits->maxComputeWorkGroupCount[0] || groups.y > limits->maxComputeWorkGroupCount[1])
        sdfgi_problem_add(&p, "%u x %u pixels take more workgroups than maxComputeWorkGroupCount", width,
                          height);
    return p;
}

static void record(struct sdfgi *gi, VkCommandBuffer cmd, const struct view *view, const struct work *work)
{
    struct pass_recorder *rec = &gi->recorder;
    sdfgi_pass_recorder_begin(rec, &gi->backend, gi->volume.resources, cmd);
    sdfgi_pass_bind_resources(rec, VK_PIPELINE_BIND_POINT_COMPUTE);
    gpu_bind_set(&rec->gpu, VK_PIPELINE_BIND_POINT_COMPUTE, gi->backend.pipelines.layouts[PASS_SET_VIEW],
                 SDFGI_SET_VIEW, view->sets[sdfgi_backend_slot(&gi->backend)]);
    sdfgi_pass_record(rec, work);
    sdfgi_pass_recorder_end(rec);
}

static void report(struct sdfgi *gi, enum pass pass)
{
    struct pass_report *line = &gi->passes[pass];
    line->reason = sdfgi_need_reason(sdfgi_pass_row(pass)->need);
    line->tally.dispatches += gi->recorder.tally[pass].dispatches;
    line->tally.units += gi->recorder.tally[pass].units;
}

enum sdfgi_result sdfgi_gather(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_gather_desc *desc)
{
    if (!sdfgi_is_active(gi))
        return SDFGI_OK;
    struct problem problem = sdfgi_view_gather_problem(desc);
    if (!cmd)
        sdfgi_problem_add(&problem, "cmd is null");
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_gather");
    const struct work work = sdfgi_view_gather_work(desc);
    problem = size_problem(gi, &work);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_gather");
    VkResult result = sdfgi_pipelines_require(&gi->backend, work.pass, 0);
    struct view *view = result == VK_SUCCESS ? sdfgi_views_next(&gi->backend, &gi->views, &result) : NULL;
    if (!view)
        return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_gather");
    sdfgi_view_write_set(&gi->backend, view, desc);
    record(gi, cmd, view, &work);
    report(gi, work.pass);
    return SDFGI_OK;
}
