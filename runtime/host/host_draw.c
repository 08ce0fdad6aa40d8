/* SPDX-License-Identifier: MIT
 * Draw calls: culling, materials, order. Every transform is taken relative to an origin near the viewer in
 * double precision, so that a scene far from the world's origin is drawn as exactly as one at it. */
#include "host_internal.h"
#include "host_math.h"

#include <stdlib.h>
#include <string.h>

static const VkShaderStageFlags push_stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

void host_viewport_set(VkCommandBuffer cmd, uint32_t x, uint32_t width, uint32_t height)
{
    const VkViewport viewport = { (float)x, 0, (float)width, (float)height, 0, 1 };
    const VkRect2D scissor = { { (int32_t)x, 0 }, { width, height } };
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &scissor);
}

bool host_frustum_sees(const struct host_frustum *frustum, const struct host_instance *instance)
{
    double center[3];
    for (int i = 0; i < 3; i++)
        center[i] = instance->center[i] - frustum->origin[i];
    for (uint32_t i = 0; i < frustum->count; i++) {
        if (host_dot3(frustum->planes[i], center) + frustum->planes[i][3] < -instance->radius)
            return false;
    }
    return true;
}

static void camera_frustum(const struct host_camera_frame *camera, struct host_frustum *out)
{
    const double *const sides[2] = { camera->right, camera->up };
    const double halves[2] = { camera->half_x, camera->half_y };
    *out = (struct host_frustum){ .count = 5 };
    memcpy(out->origin, camera->position, sizeof(out->origin));
    for (int side = 0; side < 4; side++) {
        double *plane = out->planes[side];
        const double half = halves[side / 2], sign = side % 2 == 0 ? 1.0 : -1.0;
        for (int i = 0; i < 3; i++)
            plane[i] = (camera->orthographic ? 0.0 : half * camera->forward[i]) + sign * sides[side / 2][i];
        plane[3] = camera->orthographic ? half : 0.0;
        host_normalize3(plane);
    }
    memcpy(out->planes[4], camera->forward, sizeof(camera->forward));
}

static void push_model(struct host_draw_context *draw, const struct host_instance *instance)
{
    float rows[3][4];
    const float params[4] = { instance->mirrored ? -1.0f : 1.0f, 0, 0, 0 };
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            rows[row][column] = (float)instance->transform[4 * column + row];
        rows[row][3] = (float)(instance->transform[12 + row] - draw->origin[row]);
    }
    vkCmdPushConstants(draw->cmd, draw->layout, push_stages, offsetof(struct host_push, model), sizeof(rows),
                       rows);
    vkCmdPushConstants(draw->cmd, draw->layout, push_stages, offsetof(struct host_push, params),
                       sizeof(params), params);
}

static void push_clip(struct host_draw_context *draw, const float *clip)
{
    vkCmdPushConstants(draw->cmd, draw->layout, push_stages, offsetof(struct host_push, clip),
                       16 * sizeof(float), clip);
}

static void bind_vertices(VkCommandBuffer cmd, VkBuffer buffer, const struct host_primitive *p)
{
    const VkBuffer buffers[] = { buffer, buffer, buffer, buffer, buffer, buffer };
    const VkDeviceSize offsets[] = { p->positions, p->normals, p->tangents, p->uv[0], p->uv[1], p->colors };
    vkCmdBindVertexBuffers(cmd, 0, HOST_COUNT(buffers), buffers, offsets);
    vkCmdBindIndexBuffer(cmd, buffer, p->indices, VK_INDEX_TYPE_UINT32);
}

void host_draw_instance(struct host_renderer *renderer, struct host_draw_context *draw, uint32_t index,
                        VkPipeline pipeline)
{
    const struct host_scene *scene = renderer->scene;
    const struct host_instance *instance = &scene->instances[index];
    const struct host_primitive *primitive = &scene->primitives[instance->primitive];
    if (draw->bound != pipeline)
        vkCmdBindPipeline(draw->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    draw->bound = pipeline;
    if (draw->material != primitive->material)
        vkCmdBindDescriptorSets(draw->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, draw->layout, HOST_SET_MATERIAL,
                                1, &scene->materials[primitive->material].set, 0, NULL);
    draw->material = primitive->material;
    push_model(draw, instance);
    bind_vertices(draw->cmd, scene->geometry.buffer, primitive);
    vkCmdDrawIndexed(draw->cmd, primitive->index_count, 1, 0, 0, 0);
}

static struct host_draw_context draw_begin(struct host_renderer *renderer, VkCommandBuffer cmd,
                                           enum host_forward kind, const double origin[3])
{
    struct host_draw_context draw = { .cmd = cmd,
                                      .layout = renderer->pipelines.layouts[kind],
                                      .material = -1 };
    memcpy(draw.origin, origin, sizeof(draw.origin));
    return draw;
}

void host_draw_shadow(struct host_renderer *renderer, VkCommandBuffer cmd, const struct host_frustum *frustum,
                      const double origin[3], const float *clip)
{
    const struct host_scene *scene = renderer->scene;
    const struct host_pipelines *pipelines = &renderer->pipelines;
    struct host_draw_context draw = draw_begin(renderer, cmd, HOST_FORWARD_PLAIN, origin);
    push_clip(&draw, clip);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct host_material *material = host_instance_material(scene, i);
        if (material->casts_shadow && host_frustum_sees(frustum, &scene->instances[i]))
            host_draw_instance(renderer, &draw, i,
                               material->shadow_test ? pipelines->shadow_tested : pipelines->shadow_solid);
    }
}

void host_draw_prepass(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    const struct host_scene *scene = renderer->scene;
    struct host_draw_context draw = draw_begin(renderer, cmd, HOST_FORWARD_PLAIN, renderer->camera.origin);
    struct host_frustum frustum;
    camera_frustum(&renderer->camera, &frustum);
    push_clip(&draw, &renderer->camera.clip[0][0]);
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        if (!(host_instance_material(scene, i)->flags & HOST_MATERIAL_BLEND) &&
            host_frustum_sees(&frustum, &scene->instances[i]))
            host_draw_instance(renderer, &draw, i, renderer->pipelines.prepass[host_instance_cull(scene, i)]);
    }
}

/* Grows with how far a thing is behind others: from the camera's point, or from its plane. */
static double depth_order(const struct host_camera_frame *camera, const struct host_instance *instance)
{
    double to_center[3];
    for (int k = 0; k < 3; k++)
        to_center[k] = instance->center[k] - camera->position[k];
    return host_dot3(to_center, camera->orthographic ? camera->forward : to_center);
}

/* Insertion sort, far to near: the order changes little from frame to frame, and few things are blended. */
static uint32_t sort_blended(struct host_renderer *renderer, const struct host_frustum *frustum)
{
    const struct host_scene *scene = renderer->scene;
    uint32_t *order = renderer->blend_order, count = 0;
    double *distance = renderer->blend_distance;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        if (!(host_instance_material(scene, i)->flags & HOST_MATERIAL_BLEND) ||
            !host_frustum_sees(frustum, &scene->instances[i]))
            continue;
        const double here = depth_order(&renderer->camera, &scene->instances[i]);
        uint32_t at = count++;
        for (; at > 0 && distance[at - 1] < here; at--) {
            order[at] = order[at - 1];
            distance[at] = distance[at - 1];
        }
        order[at] = i;
        distance[at] = here;
    }
    return count;
}

static void draw_sky(struct host_renderer *renderer, const struct host_slot *slot)
{
    const VkPipelineLayout layout = renderer->pipelines.layouts[host_sky_kind(renderer->scene)];
    vkCmdBindDescriptorSets(slot->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, HOST_SET_FRAME, 1,
                            &host_slot_here(renderer, slot)->set, 0, NULL);
    if (renderer->scene->environment.exists)
        vkCmdBindDescriptorSets(slot->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, HOST_SET_GI, 1,
                                &renderer->environment_set, 0, NULL);
    vkCmdBindPipeline(slot->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer->pipelines.sky);
    vkCmdDraw(slot->cmd, 3, 1, 0, 0);
}

/* What all draws of a kind share. */
static void bind_forward(const struct host_renderer *renderer, struct host_draw_context *draw,
                         enum host_forward kind, const struct host_slot *slot)
{
    const VkDescriptorSet gi_sets[HOST_FORWARD_COUNT] = {
        [HOST_FORWARD_GI] = host_gi_set(renderer->gi),
        [HOST_FORWARD_GATHERED] = host_slot_here(renderer, slot)->light_set,
    };
    vkCmdBindDescriptorSets(draw->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, draw->layout, HOST_SET_FRAME, 1,
                            &host_slot_here(renderer, slot)->set, 0, NULL);
    if (kind != HOST_FORWARD_PLAIN)
        vkCmdBindDescriptorSets(draw->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, draw->layout, HOST_SET_GI, 1,
                                &gi_sets[kind], 0, NULL);
    push_clip(draw, &renderer->camera.clip[0][0]);
}

void host_draw_forward(struct host_renderer *renderer, const struct host_slot *slot)
{
    const struct host_scene *scene = renderer->scene;
    const enum host_forward kind = host_forward_kind(renderer, false);
    struct host_draw_context draw = draw_begin(renderer, slot->cmd, kind, renderer->camera.origin);
    struct host_frustum frustum;
    camera_frustum(&renderer->camera, &frustum);

    /* The sky first: its pipeline's layout disturbs the GI set. */
    if (renderer->shown == HOST_AOV_COLOR)
        draw_sky(renderer, slot);
    bind_forward(renderer, &draw, kind, slot);

    for (uint32_t i = 0; i < scene->instance_count; i++) {
        if (!(host_instance_material(scene, i)->flags & HOST_MATERIAL_BLEND) &&
            host_frustum_sees(&frustum, &scene->instances[i]))
            host_draw_instance(renderer, &draw, i, host_forward_pipeline(renderer, kind, i));
    }

    /* Depth, normals and albedo of what is behind glass say more than those of the glass. */
    const uint32_t blended =
        renderer->shown <= HOST_AOV_DIFFUSE_INDIRECT ? sort_blended(renderer, &frustum) : 0;
    const enum host_forward blended_kind = host_forward_kind(renderer, true);
    if (blended > 0 && blended_kind != kind) {
        draw = draw_begin(renderer, slot->cmd, blended_kind, renderer->camera.origin);
        bind_forward(renderer, &draw, blended_kind, slot);
    }
    for (uint32_t i = 0; i < blended; i++) {
        const uint32_t instance = renderer->blend_order[i];
        host_draw_instance(renderer, &draw, instance,
                           host_forward_pipeline(renderer, blended_kind, instance));
    }
}
