/* SPDX-License-Identifier: MIT
 * Debug views: sdfgi_debug_draw. */
#include "context.h"

#include "view/picture.h"

#include "shaders/shared/debug.h"

#include <math.h>
#include <sdfgi/debug.h>
#include <string.h>

#define SAME_NUMBER(id, name, text)                                                                          \
    _Static_assert((int)SDFGI_DEBUG_##id == SDFGI_SHADER_DEBUG_##id, "shaders number " name " alike");
SDFGI_DEBUG_VIEWS(SAME_NUMBER)
#undef SAME_NUMBER

/* Domains of pictures look at the arguments of a gather. */
_Static_assert(offsetof(struct sdfgi_debug_view_args, width) == offsetof(struct sdfgi_gather_args, width) &&
                   offsetof(struct sdfgi_debug_view_args, height) ==
                       offsetof(struct sdfgi_gather_args, height),
               "both begin alike");

static const struct {
    const char *name, *text;
} views[SDFGI_DEBUG_VIEW_COUNT] = {
#define ROW(id, name, text) [SDFGI_DEBUG_##id] = { name, text },
    SDFGI_DEBUG_VIEWS(ROW)
#undef ROW
};

static bool is_view(enum sdfgi_debug_view view)
{
    return (unsigned)view < SDFGI_DEBUG_VIEW_COUNT;
}

const char *sdfgi_debug_view_name(enum sdfgi_debug_view view)
{
    return is_view(view) ? views[view].name : NULL;
}

const char *sdfgi_debug_view_text(enum sdfgi_debug_view view)
{
    return is_view(view) ? views[view].text : NULL;
}

enum sdfgi_debug_view sdfgi_debug_view_find(const char *name)
{
    unsigned i = 0;
    while (i < SDFGI_DEBUG_VIEW_COUNT && strcmp(views[i].name, name) != 0)
        i++;
    return (enum sdfgi_debug_view)i;
}

static struct problem debug_problem(const struct sdfgi_debug_desc *d)
{
    struct problem p = { "" };
    if (!d->output)
        sdfgi_problem_add(&p, "output is null");
    if (d->width == 0 || d->height == 0)
        sdfgi_problem_add(&p, "%s is 0", d->width == 0 ? "width" : "height");
    sdfgi_problem_floats(&p, "inverse_view_projection", d->inverse_view_projection, 16, -INFINITY, INFINITY);
    static const float zero[16];
    if (memcmp(zero, d->inverse_view_projection, sizeof zero) == 0)
        sdfgi_problem_add(&p, "inverse_view_projection is 0");
    if (!(d->background_depth == 0 || d->background_depth == 1))
        sdfgi_problem_add(&p, "background_depth is %g, must be 0 or 1", (double)d->background_depth);
    if (!is_view(d->view))
        sdfgi_problem_add(&p, "view is %d, must be one of enum sdfgi_debug_view", (int)d->view);
    sdfgi_problem_floats(&p, "exposure", &d->exposure, 1, 0, INFINITY);
    sdfgi_problem_floats(&p, "slice_m", &d->slice_m, 1, 0, INFINITY);
    return p;
}

/* True if the picture that the host has drawn answers, not the volumes. */
static bool shows_drawn(const struct sdfgi_debug_desc *d)
{
    return d->view == SDFGI_DEBUG_REFLECTION_TIER && d->depth && d->normal && d->roughness;
}

static struct work tier_work(const struct sdfgi_debug_desc *d)
{
    struct work work = {
        .pass = PASS_DEBUG_TIER,
        .indirect = WORK_DIRECT,
        .units = (uint64_t)d->width * d->height,
        .args.gather = { .width = d->width, .height = d->height, .background_depth = d->background_depth },
    };
    memcpy(work.args.gather.inverse_view_projection, d->inverse_view_projection,
           sizeof work.args.gather.inverse_view_projection);
    return work;
}

static struct work debug_work(const struct sdfgi *gi, const struct sdfgi_debug_desc *d)
{
    struct work work = {
        .pass = PASS_DEBUG_VIEW,
        .indirect = WORK_DIRECT,
        .units = (uint64_t)d->width * d->height,
        .args.debug_view = { .width = d->width,
                             .height = d->height,
                             .background_depth = d->background_depth,
                             .view = (uint32_t)d->view,
                             .exposure = d->exposure > 0 ? d->exposure : gi->exposure_hint,
                             .slice_m = d->slice_m },
    };
    memcpy(work.args.debug_view.inverse_view_projection, d->inverse_view_projection,
           sizeof work.args.debug_view.inverse_view_projection);
    return work;
}

enum sdfgi_result sdfgi_debug_draw(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_debug_desc *desc)
{
    if (!sdfgi_is_active(gi))
        return SDFGI_OK;
    struct problem problem = debug_problem(desc);
    if (!cmd)
        sdfgi_problem_add(&problem, "cmd is null");
    if (!problem.text[0])
        sdfgi_picture_check_size(&problem, &gi->backend.device.limits, desc->width, desc->height);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_debug_draw");
    const bool drawn = shows_drawn(desc);
    const struct work work = drawn ? tier_work(desc) : debug_work(gi, desc);
    VkResult result = sdfgi_pipelines_require(&gi->backend, work.pass, 0);
    struct sdfgi_view *view =
        result == VK_SUCCESS ? sdfgi_views_next(&gi->backend, drawn ? &gi->views : &gi->debug_views, &result)
                             : NULL;
    if (!view)
        return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_debug_draw");
    struct view_pictures pictures = { .diffuse = desc->output };
    if (drawn)
        pictures = (struct view_pictures){ desc->depth, desc->normal, desc->roughness, desc->input_layout,
                                           desc->output };
    sdfgi_view_write_set(&gi->backend, view, view, &pictures);
    sdfgi_picture_record(gi, cmd, view, &work);
    return SDFGI_OK;
}
