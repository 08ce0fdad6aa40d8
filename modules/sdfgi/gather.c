/* SPDX-License-Identifier: MIT
 * sdfgi_gather, and the functions of view.h: light of pictures. */
#include "context.h"

#include "view/picture.h"

#include "shaders/shared/bindings.h"

/* Timestamps: before each pass, and after the last one. Those that run side by side share theirs, and so do
 * the two runs of the filter. */
enum { STAMPS_ALONE = 2, STAMPS_REFLECTIONS = 4 };

static void begin(struct sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_view *view, uint32_t stamps)
{
    struct pass_recorder *rec = &gi->recorder;
    sdfgi_pass_recorder_begin(rec, &gi->backend, gi->volume.resources, cmd, stamps);
    sdfgi_pass_bind_resources(rec, VK_PIPELINE_BIND_POINT_COMPUTE);
    gpu_bind_set(&rec->gpu, VK_PIPELINE_BIND_POINT_COMPUTE, gi->backend.pipelines.layouts[PASS_SET_VIEW],
                 SDFGI_SET_VIEW, view->sets[sdfgi_backend_slot(&gi->backend)]);
}

static void report(struct sdfgi *gi, enum pass pass)
{
    struct pass_report *line = &gi->passes[pass];
    const struct pass_tally *tally = &gi->recorder.tally[pass];
    if (tally->dispatches == 0)
        return;
    line->reason = sdfgi_need_reason(sdfgi_pass_row(pass)->need);
    line->tally.dispatches += tally->dispatches;
    line->tally.units += tally->units;
}

void sdfgi_picture_record(struct sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_view *view,
                          const struct work *work)
{
    begin(gi, cmd, view, STAMPS_ALONE);
    sdfgi_pass_record(&gi->recorder, work);
    sdfgi_pass_recorder_end(&gi->recorder);
    report(gi, work->pass);
}

enum sdfgi_result sdfgi_gather(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_gather_desc *desc)
{
    if (!sdfgi_is_active(gi))
        return SDFGI_OK;
    struct problem problem = sdfgi_picture_problem(desc);
    if (!cmd)
        sdfgi_problem_add(&problem, "cmd is null");
    if (!problem.text[0])
        sdfgi_picture_check_size(&problem, &gi->backend.device.limits, desc->width, desc->height);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_gather");
    const struct work work = sdfgi_picture_work(desc);
    VkResult result = sdfgi_pipelines_require(&gi->backend, work.pass, PASS_PLAIN);
    struct sdfgi_view *view =
        result == VK_SUCCESS ? sdfgi_views_next(&gi->backend, &gi->views, &result) : NULL;
    if (!view)
        return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_gather");
    const struct view_pictures pictures = { .depth = desc->depth,
                                            .normal = desc->normal,
                                            .input_layout = desc->input_layout,
                                            .diffuse = desc->output };
    sdfgi_view_write_set(&gi->backend, view, view, &pictures);
    sdfgi_picture_record(gi, cmd, view, &work);
    return SDFGI_OK;
}

/* ---- Views of the host's */

static void check_resolution(struct problem *p, const char *field, enum sdfgi_gather_resolution resolution)
{
    if ((unsigned)resolution > SDFGI_GATHER_QUARTER)
        sdfgi_problem_add(p, "%s is %d, must be one of enum sdfgi_gather_resolution", field, (int)resolution);
}

enum sdfgi_result sdfgi_view_create(sdfgi *gi, const struct sdfgi_view_desc *desc, sdfgi_view **out)
{
    struct problem problem = { "" };
    if (desc->width == 0 || desc->height == 0)
        sdfgi_problem_add(&problem, "%s is 0", desc->width == 0 ? "width" : "height");
    check_resolution(&problem, "diffuse", desc->diffuse);
    check_resolution(&problem, "reflection", desc->reflection);
    sdfgi_picture_check_size(&problem, &gi->backend.device.limits, desc->width, desc->height);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_view_create");
    if (gi->backend.hooks.device_lost)
        return SDFGI_ERROR_DEVICE_LOST;
    VkResult result;
    struct sdfgi_view *view = sdfgi_view_make(&gi->backend, desc, &result);
    if (!view)
        return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_view_create");
    view->next = gi->views.of_host;
    gi->views.of_host = view;
    *out = view;
    return SDFGI_OK;
}

void sdfgi_view_destroy(sdfgi *gi, sdfgi_view *view)
{
    if (view)
        sdfgi_views_retire(&gi->backend, &gi->views, view);
}

void sdfgi_view_get_images(const sdfgi_view *view, struct sdfgi_view_images *images)
{
    *images = (struct sdfgi_view_images){ view->diffuse.view,
                                          view->reflects ? view->reflection.view : VK_NULL_HANDLE };
}

/* The resolve's diffuse light as a gather into the view's own picture. */
static struct sdfgi_gather_desc gather_of(const struct sdfgi_view *view, const struct sdfgi_resolve_desc *d)
{
    struct sdfgi_gather_desc gather = { .depth = d->depth,
                                        .normal = d->normal,
                                        .output = view->diffuse.view,
                                        .input_layout = d->input_layout,
                                        .width = view->desc.width,
                                        .height = view->desc.height,
                                        .background_depth = d->background_depth,
                                        .resolution = view->desc.diffuse,
                                        .scale = d->scale };
    for (int i = 0; i < 16; i++)
        gather.inverse_view_projection[i] = d->inverse_view_projection[i];
    return gather;
}

/* True if the scene and the host call for reflections. */
static bool wants_reflections(const struct sdfgi *gi, const struct sdfgi_resolve_desc *desc)
{
    return desc->roughness && 1 - gi->scene.smoothest < gi->volume.state.params.rays_end;
}

/* Rays go on from metal where the scene has some. */
static enum pass_variant rays_variant(const struct sdfgi *gi)
{
    return gi->scene.metals > 0 ? PASS_METAL : PASS_PLAIN;
}

/* Pipelines and memory. */
static VkResult prepare(struct sdfgi *gi, struct sdfgi_view *view, const struct sdfgi_resolve_desc *desc,
                        enum pass gather)
{
    const bool reflects = wants_reflections(gi, desc), lobes = reflects && gi->volume.state.low_light;
    VkResult result = sdfgi_pipelines_require(&gi->backend, gather, lobes ? PASS_LOBES : PASS_PLAIN);
    if (result != VK_SUCCESS || !reflects)
        return result;
    for (int i = lobes ? PASS_REFLECT_LOBES : PASS_REFLECT_TILES; i <= PASS_REFLECT_FILTER; i++)
        if (result == VK_SUCCESS)
            result = sdfgi_pipelines_require(&gi->backend, (enum pass)i,
                                             i == PASS_REFLECT_RAYS ? rays_variant(gi) : PASS_PLAIN);
    return result == VK_SUCCESS ? sdfgi_view_add_reflection(&gi->backend, view) : result;
}

/* Each resolve makes all of its pictures anew, and brings them into their layout itself: nothing tells
 * whether command buffers with resolves before it have run. */
static void begin_pictures(struct sdfgi *gi, const struct sdfgi_view *view)
{
    const struct gpu_image *const images[] = { &view->diffuse, &view->reflection, &view->filtered };
    gpu_images_to_general(&gi->recorder.gpu, images, view->reflects ? 3 : 1);
}

static void clear_tiles(struct sdfgi *gi, const struct sdfgi_view *view)
{
    struct gpu_recorder *rec = &gi->recorder.gpu;
    gpu_use(rec, GPU_USAGE_TRANSFER, 0, VIEW_BIT(TILES));
    gpu_fill(rec, &view->tiles, 0, sizeof(uint32_t) * SDFGI_TILES_HEADER, 0);
}

/* Answers of rough lobes and lists are made side by side. So are the gather and the rays, each of which makes
 * the reflections of other pixels. Rays come first, as some of them take longest. */
static void record_with_reflections(struct sdfgi *gi, struct sdfgi_view *view, struct work gather)
{
    struct pass_recorder *rec = &gi->recorder;
    gather.args.gather.ray_step = sdfgi_picture_step(view->desc.reflection);
    struct work first[2] = { gather, gather }, beside[2] = { gather, gather }, filter[2] = { gather, gather };
    const bool lobes = gi->volume.state.low_light;
    first[0].pass = lobes ? PASS_REFLECT_LOBES : PASS_REFLECT_TILES;
    first[1].pass = PASS_REFLECT_TILES;
    first[0].group = first[1].group = 2;
    beside[0].pass = PASS_REFLECT_RAYS;
    beside[0].variant = rays_variant(gi);
    beside[0].group = beside[1].group = 1;
    beside[1].variant = lobes ? PASS_LOBES : PASS_PLAIN;
    filter[0].pass = filter[1].pass = PASS_REFLECT_FILTER;
    filter[0].args.gather.filter_step = 1;
    filter[1].args.gather.filter_step = SDFGI_RAYS_SIDE;
    clear_tiles(gi, view);
    sdfgi_pass_begin_beside(rec, first, lobes ? 2 : 1);
    for (int i = 0; i < (lobes ? 2 : 1); i++)
        sdfgi_pass_record(rec, &first[i]);
    sdfgi_pass_begin_beside(rec, beside, 2);
    sdfgi_pass_record_indirect(rec, &beside[0], &view->tiles, sizeof(uint32_t) * SDFGI_TILES_RAYS);
    sdfgi_pass_record(rec, &beside[1]);
    for (int run = 0; run < 2; run++)
        sdfgi_pass_record_indirect(rec, &filter[run], &view->tiles, sizeof(uint32_t) * SDFGI_TILES_TILES);
    sdfgi_pass_close(rec);
}

enum sdfgi_result sdfgi_view_resolve(sdfgi *gi, sdfgi_view *view, VkCommandBuffer cmd,
                                     const struct sdfgi_resolve_desc *desc)
{
    if (!sdfgi_is_active(gi))
        return SDFGI_OK;
    const struct sdfgi_gather_desc gather = gather_of(view, desc);
    struct problem problem = sdfgi_picture_problem(&gather);
    if (!cmd)
        sdfgi_problem_add(&problem, "cmd is null");
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_view_resolve");
    const struct work work = sdfgi_picture_work(&gather);
    VkResult result = prepare(gi, view, desc, work.pass);
    const struct sdfgi_view *holder =
        result == VK_SUCCESS ? sdfgi_view_next_resolve(&gi->backend, view, &result) : NULL;
    if (!holder)
        return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_view_resolve");
    const struct view_pictures pictures = { desc->depth, desc->normal, desc->roughness, desc->input_layout,
                                            view->diffuse.view };
    view->reflects = wants_reflections(gi, desc);
    sdfgi_view_write_set(&gi->backend, holder, view, &pictures);
    begin(gi, cmd, holder, STAMPS_REFLECTIONS);
    begin_pictures(gi, view);
    if (view->reflects)
        record_with_reflections(gi, view, work);
    else
        sdfgi_pass_record(&gi->recorder, &work);
    sdfgi_pass_recorder_end(&gi->recorder);
    for (int pass = work.pass; pass < PASS_COUNT; pass++)
        report(gi, (enum pass)pass);
    return SDFGI_OK;
}
