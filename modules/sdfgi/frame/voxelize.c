/* SPDX-License-Identifier: MIT
 * Stage 3: draws or dispatches every instance that touches a box of cells into its occupancy bits. */
#include "voxelize.h"

#include <assert.h>
#include <math.h>

/* Each slice culls its triangles again. */
enum { MAX_SLICES = 256 };
/* Columns that one thread walks before another one is worth its share of culling and set-up. On a CPU, where
 * each goes through all code whether it has columns or not, many: 16 instead of 2 take 31 instead of 63 ms
 * for a step of 64^3. */
#define COLUMNS_PER_THREAD     2.0
#define COLUMNS_PER_THREAD_CPU 16.0
/* How often a mesh is taken to cover the largest side of what its bounds and the box share. */
#define COVERINGS 4.0

/* Workgroups that share the columns of SDFGI_GROUP_TRIANGLE triangles, so that each thread has but a few. */
static uint32_t slice_count(const struct cascade *cascade, const struct cell_box *cells,
                            const struct box *bounds, double threads, double columns_per_thread)
{
    const struct box box = sdfgi_cascade_world_box(cascade, cells);
    double room[3];
    for (int i = 0; i < 3; i++)
        room[i] = (fmin(bounds->max[i], box.max[i]) - fmax(bounds->min[i], box.min[i])) *
                  (SDFGI_SUBVOXELS / cascade->cell_size[i]);
    const double columns = COVERINGS * fmax(room[0] * room[1], fmax(room[1] * room[2], room[2] * room[0]));
    return (uint32_t)fmin(fmax(ceil(columns / (columns_per_thread * threads)), 1), MAX_SLICES);
}

static double determinant(const float m[9])
{
    return (double)m[0] * (m[4] * m[8] - m[5] * m[7]) - (double)m[3] * (m[1] * m[8] - m[2] * m[7]) +
           (double)m[6] * (m[1] * m[5] - m[2] * m[4]);
}

/* Whether the cross product of the edges of a triangle, once transformed, points behind its front. */
static bool is_reversed(const struct scene *scene, const struct instance *instance, VkFrontFace front_face)
{
    const bool mirrored = determinant(instance->desc.transform.basis) < 0;
    return (mirrored != scene->left_handed) != (front_face == VK_FRONT_FACE_CLOCKWISE);
}

/* Parts of a sub-voxel to which an instance's place is rounded, so that far from the world's origin, where
 * doubles are coarser, it comes out the same. Well below the margin of edges. */
#define ANCHOR_PARTS 4096.0
/* Sub-voxels from the cascade beyond which nothing of an instance can be in it: fits 32 bits. */
#define FARTHEST_ANCHOR 1e9

/* Object space to sub-voxels from the instance's anchor, the sub-voxel in which its origin lies. All that is
 * rounded is rounded alike wherever the cascade stands; where that is enters as whole numbers. */
static void fill_rows(const struct cascade *cascade, const struct sdfgi_transform *t,
                      struct sdfgi_voxelize_args *args)
{
    int32_t anchor[3];
    for (int i = 0; i < 3; i++) {
        const double scale = SDFGI_SUBVOXELS / cascade->cell_size[i];
        const double place = t->translation[i] * scale, whole = floor(place);
        const double from_cascade = whole - (double)cascade->origin[i] * SDFGI_SUBVOXELS;
        const double part = floor((place - whole) * ANCHOR_PARTS + 0.5) / ANCHOR_PARTS;
        anchor[i] = (int32_t)fmin(fmax(from_cascade, -FARTHEST_ANCHOR), FARTHEST_ANCHOR);
        args->rows[i] = (vec4){ (float)(t->basis[i] * scale), (float)(t->basis[3 + i] * scale),
                                (float)(t->basis[6 + i] * scale), (float)part };
    }
    args->anchor = (ivec3){ anchor[0], anchor[1], anchor[2] };
}

static uint32_t packed_corner(const int32_t corner[3])
{
    return (uint32_t)corner[0] | (uint32_t)corner[1] << 10 | (uint32_t)corner[2] << 20;
}

/* Cells by which a bound is widened that lies so many cells from the anchor. Shaders know vertices as floats
 * in sub-voxels from there: the further away, the coarser. */
static double slack(double distance)
{
    return 1 + ldexp(fabs(distance), -20);
}

/* Bounds of the instance as cells of the cascade, rounded outwards. */
static void fill_bounds(const struct cascade *cascade, const struct instance *instance, uint32_t resolution,
                        struct sdfgi_voxelize_args *args)
{
    struct cell_box cells;
    for (int i = 0; i < 3; i++) {
        const double size = cascade->cell_size[i], origin = (double)cascade->origin[i],
                     anchor = instance->desc.transform.translation[i] / size - origin,
                     low = instance->bounds.min[i] / size - origin,
                     high = instance->bounds.max[i] / size - origin;
        cells.low[i] = (int32_t)fmin(fmax(floor(low - slack(low - anchor)), 0), resolution);
        cells.high[i] = (int32_t)fmin(fmax(ceil(high + slack(high - anchor)), 0), resolution);
    }
    args->bounds_low = packed_corner(cells.low);
    args->bounds_high = packed_corner(cells.high);
}

static uint32_t group_count(uint32_t triangles)
{
    return (triangles - 1) / SDFGI_GROUP_TRIANGLE + 1;
}

/* True if an earlier part of the piece drew the instance, and counted the faults of its triangles. */
static bool is_checked(const struct cascade *cascade, const struct work *work,
                       const struct instance *instance)
{
    if (sdfgi_cell_box_empty(&work->made))
        return false;
    const struct box made = sdfgi_cascade_world_box(cascade, &work->made);
    return sdfgi_instance_touches(instance, &made);
}

static struct sdfgi_voxelize_args voxelize_args(const struct voxelizer *v, const struct work *work,
                                                const struct instance *instance, const struct mesh *mesh)
{
    const struct sdfgi_mesh_desc *d = &mesh->desc;
    const struct mesh_stream *streams = mesh->streams;
    const struct cascade *cascade = &v->cascades->at[work->cascade];
    const uint32_t groups = group_count(d->triangle_count);
    const double columns = v->rec->backend->device.is_cpu ? COLUMNS_PER_THREAD_CPU : COLUMNS_PER_THREAD;
    struct sdfgi_voxelize_args args = {
        .cascade = work->cascade,
        .triangle_count = d->triangle_count,
        .slices = slice_count(cascade, &work->box, &instance->bounds, (double)groups * SDFGI_GROUP_TRIANGLE,
                              columns),
        .material = sdfgi_pool_index(&v->scene->materials, instance->desc.material.id),
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
    };
    fill_rows(cascade, &instance->desc.transform, &args);
    fill_bounds(cascade, instance, v->cascades->resolution, &args);
    if (is_reversed(v->scene, instance, d->front_face))
        args.flags |= SDFGI_MESH_REVERSED;
    if (is_checked(cascade, work, instance))
        args.flags |= SDFGI_MESH_CHECKED;
    return args;
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

static void draw_instance(struct binder *b, const struct instance *instance)
{
    const struct scene *scene = b->voxelizer->scene;
    struct pass_recorder *rec = b->voxelizer->rec;
    const struct mesh *mesh = sdfgi_pool_get(&scene->meshes, instance->desc.mesh.id);
    const struct material *material = sdfgi_pool_get(&scene->materials, instance->desc.material.id);
    assert(mesh && material);
    bind(b, mesh, material);
    const struct sdfgi_voxelize_args args = voxelize_args(b->voxelizer, b->work, instance, mesh);
    gpu_push(&rec->gpu, layout_of(b), sizeof args, &args);
    if (b->point == VK_PIPELINE_BIND_POINT_GRAPHICS) {
        gpu_draw(&rec->gpu, 3 * args.triangle_count);
    } else {
        const uint32_t groups = group_count(args.triangle_count),
                       width = groups < SDFGI_VOXELIZE_WIDTH ? groups : SDFGI_VOXELIZE_WIDTH;
        gpu_dispatch(&rec->gpu, width, args.slices, (groups - 1) / SDFGI_VOXELIZE_WIDTH + 1);
    }
    rec->tally[b->work->pass].dispatches++;
    rec->tally[b->work->pass].units += args.triangle_count;
}

static void draw_instances(struct binder *b)
{
    const struct voxelizer *v = b->voxelizer;
    const struct box box = sdfgi_cascade_world_box(&v->cascades->at[b->work->cascade], &b->work->box);
    const struct pool *instances = &v->scene->instances;
    for (uint32_t i = 0; i < instances->end; i++) {
        const struct instance *instance = sdfgi_pool_at(instances, i);
        if (instance && sdfgi_instance_touches(instance, &box))
            draw_instance(b, instance);
    }
}

static void record_compute(const struct voxelizer *v, const struct work *work)
{
    struct pass_recorder *rec = v->rec;
    struct binder b = { .voxelizer = v,
                        .work = work,
                        .point = VK_PIPELINE_BIND_POINT_COMPUTE,
                        .pipelines = rec->backend->pipelines.passes[work->pass] };
    gpu_use(&rec->gpu, GPU_USAGE_COMPUTE, sdfgi_pass_row(work->pass)->reads,
            sdfgi_pass_row(work->pass)->writes);
    draw_instances(&b);
}

static void record_raster(const struct voxelizer *v, const struct work *work)
{
    struct pass_recorder *rec = v->rec;
    const struct raster_target *target = &rec->resources->raster;
    struct binder b = {
        .voxelizer = v, .work = work, .point = VK_PIPELINE_BIND_POINT_GRAPHICS, .pipelines = target->pipelines
    };
    gpu_use(&rec->gpu, GPU_USAGE_GRAPHICS, sdfgi_pass_row(work->pass)->reads,
            sdfgi_pass_row(work->pass)->writes);
    gpu_render_pass_begin(&rec->gpu, target->pass, target->framebuffer, target->extent);
    draw_instances(&b);
    gpu_render_pass_end(&rec->gpu);
}

void sdfgi_voxelize_record(const struct voxelizer *v, const struct work *work)
{
    const bool raster = sdfgi_pass_row(work->pass)->kind == PASS_KIND_RASTER_TEXTURED;
    sdfgi_pass_open(v->rec, work);
    sdfgi_pass_bind_resources(v->rec,
                              raster ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE);
    if (raster)
        record_raster(v, work);
    else
        record_compute(v, work);
}
