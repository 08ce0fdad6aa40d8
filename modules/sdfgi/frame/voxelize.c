/* SPDX-License-Identifier: MIT
 * Stage 3: draws or dispatches the instances that touch a box of cells into its occupancy bits. */
#include "voxelize.h"

#include "volume/volume.h"

#include <math.h>

/* Each slice culls its triangles again. */
enum { MAX_SLICES = 256 };
/* Columns that one thread walks before another one is worth its share of culling and set-up. On a CPU, where
 * each goes through all code whether it has columns or not, many: 16 instead of 2 take 31 instead of 63 ms
 * for a step of 64^3. */
#define COLUMNS_PER_THREAD     2.0
#define COLUMNS_PER_THREAD_CPU 16.0

static uint32_t packed_corner(const int32_t corner[3])
{
    return (uint32_t)corner[0] | (uint32_t)corner[1] << 10 | (uint32_t)corner[2] << 20;
}

/* Workgroups over the triangles of a batch. */
static uint32_t group_count(const struct draw_batch *batch)
{
    return (batch->mesh->desc.triangle_count * batch->count - 1) / SDFGI_GROUP_TRIANGLE + 1;
}

/* Workgroups that share the columns of SDFGI_GROUP_TRIANGLE triangles, so that each thread has but a few. */
static uint32_t slice_count(const struct draw_batch *batch, double columns_per_thread)
{
    const double threads = (double)group_count(batch) * SDFGI_GROUP_TRIANGLE;
    return (uint32_t)fmin(fmax(ceil(batch->columns * batch->count / (columns_per_thread * threads)), 1),
                          MAX_SLICES);
}

static ivec3 words_of(const int64_t place[3], uint32_t shift)
{
    int32_t words[3];
    for (int i = 0; i < 3; i++)
        words[i] = (int32_t)(uint32_t)((uint64_t)place[i] >> shift & UINT32_MAX);
    return (ivec3){ words[0], words[1], words[2] };
}

static struct sdfgi_voxelize_args voxelize_args(const struct voxelizer *v, const struct work *work,
                                                const struct draw_batch *batch, double columns_per_thread)
{
    const struct sdfgi_mesh_desc *d = &batch->mesh->desc;
    const struct mesh_stream *streams = batch->mesh->streams;
    int64_t corner[3];
    for (int i = 0; i < 3; i++)
        corner[i] = sdfgi_params_corner(v->cascades, work->cascade, i);
    return (struct sdfgi_voxelize_args){
        .bounds_min = { d->bounds_min[0], d->bounds_min[1], d->bounds_min[2] },
        .cascade = work->cascade,
        .bounds_max = { d->bounds_max[0], d->bounds_max[1], d->bounds_max[2] },
        .triangle_count = d->triangle_count,
        .corner_low = words_of(corner, 0),
        .slices = slice_count(batch, columns_per_thread),
        .corner_high = words_of(corner, 32),
        .flags = sdfgi_mesh_index_flags(&streams[SDFGI_BINDING_MESH_INDICES]),
        .position_fetch = sdfgi_mesh_stream_fetch(&streams[SDFGI_BINDING_MESH_POSITIONS]),
        .position_stride = streams[SDFGI_BINDING_MESH_POSITIONS].stride,
        .uv_fetch = sdfgi_mesh_stream_fetch(&streams[SDFGI_BINDING_MESH_UVS]),
        .uv_stride = streams[SDFGI_BINDING_MESH_UVS].stride,
        .color_fetch = sdfgi_mesh_stream_fetch(&streams[SDFGI_BINDING_MESH_COLORS]),
        .color_stride = streams[SDFGI_BINDING_MESH_COLORS].stride,
        .vertex_offset = sdfgi_mesh_first_vertex(d),
        .vertex_count = d->vertex_count,
        .box_low = packed_corner(work->box.low),
        .box_high = packed_corner(work->box.high),
        .first_draw = batch->first,
        .draw_count = batch->count,
    };
}

/* What is bound, so that neighbours in the list that share it bind it once. */
struct binder {
    const struct voxelizer *voxelizer;
    const struct work *work;
    VkPipelineBindPoint point;
    const VkPipeline *pipelines; /* by variant */
    VkPipeline bound;
    VkDescriptorSet mesh, material;
};

static VkPipelineLayout layout_of(const struct binder *b)
{
    return b->voxelizer->rec->backend->pipelines.layouts[PASS_SET_MESH];
}

static void bind_set(struct binder *b, uint32_t index, const struct object_set *set, VkDescriptorSet *bound)
{
    if (!set || *bound == set->set)
        return;
    gpu_bind_set(&b->voxelizer->rec->gpu, b->point, layout_of(b), index, set->set);
    *bound = set->set;
}

static void bind(struct binder *b, const struct mesh *mesh, const struct material *material)
{
    const VkPipeline pipeline = b->pipelines[material->set ? 1 : 0];
    if (pipeline != b->bound)
        gpu_bind_pipeline(&b->voxelizer->rec->gpu, b->point, pipeline);
    b->bound = pipeline;
    bind_set(b, SDFGI_SET_MESH, mesh->set, &b->mesh);
    bind_set(b, SDFGI_SET_MATERIAL, material->set, &b->material);
}

static void draw_batch(struct binder *b, const struct draw_batch *batch, double columns_per_thread)
{
    struct pass_recorder *rec = b->voxelizer->rec;
    bind(b, batch->mesh, batch->material);
    const struct sdfgi_voxelize_args args = voxelize_args(b->voxelizer, b->work, batch, columns_per_thread);
    gpu_push(&rec->gpu, layout_of(b), sizeof args, &args);
    if (b->point == VK_PIPELINE_BIND_POINT_GRAPHICS) {
        gpu_draw(&rec->gpu, 3 * args.triangle_count, args.draw_count);
    } else {
        const uint32_t groups = group_count(batch),
                       width = groups < SDFGI_VOXELIZE_WIDTH ? groups : SDFGI_VOXELIZE_WIDTH;
        gpu_dispatch(&rec->gpu, width, args.slices, (groups - 1) / SDFGI_VOXELIZE_WIDTH + 1);
    }
    rec->tally[b->work->pass].dispatches++;
    rec->tally[b->work->pass].units += (uint64_t)args.triangle_count * args.draw_count;
}

static void upload_list(struct pass_recorder *rec, const struct draw_list *list)
{
    gpu_use(&rec->gpu, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(INSTANCES));
    gpu_update(&rec->gpu, &rec->resources->buffers[RESOURCE_INSTANCES], 0, list->count * sizeof *list->draws,
               list->draws);
}

static void draw_list(struct binder *b, const struct draw_query *query)
{
    const struct pass_row *row = sdfgi_pass_row(b->work->pass);
    struct pass_recorder *rec = b->voxelizer->rec;
    const struct raster_target *target = &rec->resources->raster;
    const bool raster = b->point == VK_PIPELINE_BIND_POINT_GRAPHICS;
    const struct draw_list *list = b->voxelizer->draws;
    upload_list(rec, list);
    gpu_use(&rec->gpu, raster ? GPU_USAGE_GRAPHICS : GPU_USAGE_COMPUTE, row->reads, row->writes);
    if (raster)
        gpu_render_pass_begin(&rec->gpu, target->pass, target->framebuffer, target->extent);
    struct draw_batch batch, *after = NULL;
    while (sdfgi_draws_batch(list, query, after, &batch)) {
        draw_batch(b, &batch, query->columns_per_thread);
        after = &batch;
    }
    if (raster)
        gpu_render_pass_end(&rec->gpu);
}

void sdfgi_voxelize_record(const struct voxelizer *v, const struct work *work)
{
    const struct backend *backend = v->rec->backend;
    const bool raster = sdfgi_pass_row(work->pass)->kind == PASS_KIND_RASTER_TEXTURED;
    const struct draw_query query = {
        .scene = v->scene,
        .cascade = &v->cascades->at[work->cascade],
        .work = work,
        .room = v->rec->resources->extent.instances,
        .columns_per_thread = backend->device.is_cpu ? COLUMNS_PER_THREAD_CPU : COLUMNS_PER_THREAD,
    };
    struct binder b = {
        .voxelizer = v,
        .work = work,
        .point = raster ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE,
        .pipelines = raster ? v->rec->resources->raster.pipelines : backend->pipelines.passes[work->pass],
    };
    sdfgi_pass_open(v->rec, work);
    sdfgi_pass_bind_resources(v->rec, b.point);
    sdfgi_draws_begin(v->draws, &query);
    while (sdfgi_draws_next(v->draws, &query))
        draw_list(&b, &query);
}
