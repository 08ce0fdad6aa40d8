/* SPDX-License-Identifier: MIT
 * Stage 3: draws or dispatches every instance that touches a box of cells into its solid bits, and resolves
 * albedo, emission and normals. */
#include "internal.h"

#include <math.h>

/* Workgroups along x, of 65535 that Vulkan guarantees: few, so that meshes in use have some along z too.
 * MAX_SLICES: each slice culls its triangles again. */
enum { GROUP_WIDTH = 1024, MAX_SLICES = 256 };
/* Columns that one thread walks before another one is worth its share of culling and set-up. On a CPU, where
 * each goes through all code whether it has columns or not, many: 16 instead of 2 take 31 instead of 63 ms
 * for a step of 64^3. */
#define COLUMNS_PER_THREAD     2.0
#define COLUMNS_PER_THREAD_CPU 16.0
/* How often a mesh is taken to cover the largest side of what its bounds and the box share. */
#define COVERINGS 4.0

/* The box in the world, and a sub-voxel more: triangles set sub-voxels that they touch. */
static struct box world_box(const struct cascade *cascade, const struct cell_box *cells)
{
    struct box box;
    for (int i = 0; i < 3; i++) {
        const double margin = 1.0 / SDFGI_SUBVOXELS, size = cascade->cell_size[i];
        box.min[i] = ((double)(cascade->origin[i] + cells->low[i]) - margin) * size;
        box.max[i] = ((double)(cascade->origin[i] + cells->high[i]) + margin) * size;
    }
    return box;
}

/* Workgroups that share the columns of SDFGI_GROUP_TRIANGLE triangles, so that each thread has but a few. */
static uint32_t slice_count(const struct cascade *cascade, const struct cell_box *cells,
                            const struct box *bounds, double threads, double columns_per_thread)
{
    const struct box box = world_box(cascade, cells);
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

static uint32_t mesh_flags(const struct sdfgi_mesh_desc *d)
{
    uint32_t flags = !d->index_buffer                        ? SDFGI_MESH_INDEX_NONE
                     : d->index_type == VK_INDEX_TYPE_UINT32 ? SDFGI_MESH_INDEX_32
                                                             : SDFGI_MESH_INDEX_16;
    flags |= d->uv_buffer ? SDFGI_MESH_HAS_UV : 0;
    flags |= d->color_buffer ? SDFGI_MESH_HAS_COLOR : 0;
    return flags;
}

static struct sdfgi_voxelize_args voxelize_args(const struct sdfgi *gi, uint32_t c,
                                                const struct cell_box *box, const struct instance *instance,
                                                const struct mesh *mesh)
{
    const struct sdfgi_mesh_desc *d = &mesh->desc;
    const uint32_t groups = (d->triangle_count - 1) / SDFGI_GROUP_TRIANGLE + 1;
    const double columns = gi->device.is_cpu ? COLUMNS_PER_THREAD_CPU : COLUMNS_PER_THREAD;
    struct sdfgi_voxelize_args args = {
        .cascade = c,
        .triangle_count = d->triangle_count,
        .groups = groups,
        .slices = slice_count(&gi->cascades[c], box, &instance->bounds, (double)groups * SDFGI_GROUP_TRIANGLE,
                              columns),
        .material = pool_index(instance->desc.material.id),
        .flags = mesh_flags(d),
        .position_offset = (uint32_t)(d->position_offset / 4),
        .position_stride = d->position_stride / 4,
        .uv_offset = (uint32_t)(d->uv_offset / 4),
        .uv_stride = d->uv_stride / 4,
        .color_offset = (uint32_t)(d->color_offset / 4),
        .color_stride = d->color_stride / 4,
        .index_offset = (uint32_t)(d->index_offset / 4),
        .vertex_count = d->vertex_count,
        .group_width = GROUP_WIDTH,
        .box_low = packed_corner(box->low),
        .box_high = packed_corner(box->high),
    };
    fill_rows(&gi->cascades[c], &instance->desc.transform, &args);
    if (determinant(instance->desc.transform.basis) < 0)
        args.flags |= SDFGI_MESH_MIRRORED;
    return args;
}

/* What is bound, so that neighbours in the list that share it bind it once. */
struct binder {
    struct frame *frame;
    VkPipelineBindPoint point;
    VkPipeline plain, textured, bound;
    VkDescriptorSet mesh, material;
    const struct cell_box *box;
};

static void bind_set(struct binder *b, uint32_t index, VkDescriptorSet set, VkDescriptorSet *bound)
{
    if (!set || *bound == set)
        return;
    gpu_bind_set(&b->frame->rec, b->point, b->frame->gi->pipelines.voxelize_layout, index, set);
    *bound = set;
}

static void draw_instance(struct binder *b, uint32_t cascade, const struct instance *instance)
{
    struct sdfgi *gi = b->frame->gi;
    const struct mesh *mesh = pool_get(&gi->scene.meshes, instance->desc.mesh.id);
    const struct material *material = pool_get(&gi->scene.materials, instance->desc.material.id);
    const VkPipeline pipeline = material->set ? b->textured : b->plain;
    if (pipeline != b->bound)
        gpu_bind_pipeline(&b->frame->rec, b->point, pipeline);
    b->bound = pipeline;
    bind_set(b, 1, mesh->set, &b->mesh);
    bind_set(b, 2, material->set, &b->material);
    const struct sdfgi_voxelize_args args = voxelize_args(gi, cascade, b->box, instance, mesh);
    gpu_push(&b->frame->rec, gi->pipelines.voxelize_layout, sizeof args, &args);
    const uint32_t triangles = args.triangle_count;
    enum pass pass = PASS_VOXELIZE;
    if (b->point == VK_PIPELINE_BIND_POINT_GRAPHICS) {
        gpu_draw(&b->frame->rec, 3 * triangles);
        pass = PASS_VOXELIZE_RASTER;
    } else {
        const uint32_t width = args.groups < GROUP_WIDTH ? args.groups : GROUP_WIDTH;
        gpu_dispatch(&b->frame->rec, width, args.slices, (args.groups - 1) / GROUP_WIDTH + 1);
    }
    gi->passes[pass].dispatches++;
    gi->passes[pass].work += triangles;
}

static void draw_instances(struct binder *b, uint32_t c)
{
    struct sdfgi *gi = b->frame->gi;
    const struct box box = world_box(&gi->cascades[c], b->box);
    const struct pool *instances = &gi->scene.instances;
    gpu_bind_set(&b->frame->rec, b->point, gi->pipelines.voxelize_layout, 0, gi->resources->set);
    for (uint32_t i = 0; i < instances->end; i++) {
        const struct instance *instance = pool_at(instances, i);
        if (instance && instance->desc.mobility == SDFGI_STATIC && box_overlaps(&instance->bounds, &box))
            draw_instance(b, c, instance);
    }
}

static void record_compute(struct frame *frame, uint32_t c, const struct cell_box *box)
{
    struct pipelines *p = &frame->gi->pipelines;
    struct binder b = { .frame = frame,
                        .box = box,
                        .point = VK_PIPELINE_BIND_POINT_COMPUTE,
                        .plain = p->passes[PASS_VOXELIZE],
                        .textured = p->voxelize_textured };
    pass_begin(frame, PASS_VOXELIZE);
    gpu_use(&frame->rec, GPU_USAGE_COMPUTE, pass_reads(PASS_VOXELIZE), pass_writes(PASS_VOXELIZE));
    draw_instances(&b, c);
    pass_end(frame);
}

static void record_raster(struct frame *frame, uint32_t c, const struct cell_box *box)
{
    struct sdfgi *gi = frame->gi;
    struct resources *r = gi->resources;
    struct binder b = { .frame = frame,
                        .box = box,
                        .point = VK_PIPELINE_BIND_POINT_GRAPHICS,
                        .plain = r->raster_pipelines[0],
                        .textured = r->raster_pipelines[1] };
    const uint32_t extent = gi->settings.resolution * SDFGI_SUBVOXELS;
    pass_begin(frame, PASS_VOXELIZE_RASTER);
    gpu_use(&frame->rec, GPU_USAGE_GRAPHICS, pass_reads(PASS_VOXELIZE_RASTER),
            pass_writes(PASS_VOXELIZE_RASTER));
    gi->device.fn.CmdBeginRenderPass(
        frame->rec.cmd,
        &(VkRenderPassBeginInfo){ .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = r->raster_pass,
                                  .framebuffer = r->raster_target,
                                  .renderArea = { { 0, 0 }, { extent, extent } } },
        VK_SUBPASS_CONTENTS_INLINE);
    draw_instances(&b, c);
    gi->device.fn.CmdEndRenderPass(frame->rec.cmd);
    frame->rec.command_count += 2;
    pass_end(frame);
}

static void record_box(struct frame *frame, enum pass pass, const struct sdfgi_region_args *args,
                       const struct cell_box *box, uint32_t per_thread)
{
    pass_begin(frame, pass);
    pass_dispatch_box(frame, pass, PASS_ARGS(*args), box, per_thread);
    pass_end(frame);
}

/* Boxes around what goes and comes lie in strips along z, or where cells moved along z alone, along x: slabs
 * are cut across. Where nothing is kept, nobody asks. */
int32_t change_bounds_axis(const struct change *change)
{
    if (cell_box_empty(&change->kept))
        return -1;
    return change->before[2] != 0 && change->before[0] == 0 && change->before[1] == 0 ? 0 : 2;
}

/* Before the first box of a change. */
static void clear_bounds(struct frame *frame, uint32_t c)
{
    struct change *change = &frame->gi->cascades[c].change;
    if (!change->begun && change_bounds_axis(change) >= 0)
        pass_clear(frame, RESOURCE_BOUNDS, (uint64_t)c * SDFGI_BOUNDS_BYTES, SDFGI_BOUNDS_BYTES);
    change->begun = true;
}

void voxelize_record(struct frame *frame, uint32_t c, const struct cell_box *box)
{
    struct sdfgi *gi = frame->gi;
    const struct change *change = &gi->cascades[c].change;
    const struct sdfgi_region_args args = {
        .low = { box->low[0], box->low[1], box->low[2] },
        .cascade = c,
        .high = { box->high[0], box->high[1], box->high[2] },
        .bounds_axis = change_bounds_axis(change),
        .before = { change->before[0], change->before[1], change->before[2] },
    };
    clear_bounds(frame, c);
    record_box(frame, PASS_REGION_CLEAR, &args, box, 4);
    if (gi->plan[PASS_VOXELIZE].run)
        record_compute(frame, c, box);
    if (gi->plan[PASS_VOXELIZE_RASTER].run)
        record_raster(frame, c, box);
    record_box(frame, PASS_VOXEL_RESOLVE, &args, box, 8);
}
