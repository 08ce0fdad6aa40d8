/* SPDX-License-Identifier: MIT
 * One frame: GI update, shadow maps, prepass, lookup, fog, forward pass. */
#include "host_internal.h"
#include "host_math.h"

#include <string.h>

static uint32_t slot_index(const struct host_renderer *renderer, const struct host_slot *slot)
{
    return (uint32_t)(slot - renderer->slots);
}

static uint64_t span_ns(const struct host_device *device, const uint64_t *stamps, enum host_stamp from,
                        enum host_stamp to)
{
    const uint64_t ticks = (stamps[to] - stamps[from]) & device->timestamp_mask;
    return (uint64_t)((double)ticks * (double)device->limits.timestampPeriod);
}

static uint32_t stamp_count(const struct host_renderer *renderer)
{
    return host_fog_exists(renderer->scene) ? HOST_STAMP_COUNT : HOST_STAMP_PLAIN_COUNT;
}

static bool timestamps_read(struct host_renderer *renderer, const struct host_slot *slot)
{
    struct host_device *device = renderer->device;
    uint64_t stamps[HOST_STAMP_COUNT] = { 0 };
    if (!renderer->queries)
        return true;
    const VkResult result = vkGetQueryPoolResults(
        device->device, renderer->queries, HOST_STAMP_COUNT * slot_index(renderer, slot),
        stamp_count(renderer), sizeof(stamps), stamps, sizeof(stamps[0]), VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS)
        return host_check(device, result, "reading times"); /* not ready is no failure */
    renderer->times = (struct host_times){
        .frame_ns = span_ns(device, stamps, HOST_STAMP_BEGIN, HOST_STAMP_END),
        .update_ns = span_ns(device, stamps, HOST_STAMP_BEGIN, HOST_STAMP_UPDATED),
        .shadow_ns = span_ns(device, stamps, HOST_STAMP_UPDATED, HOST_STAMP_SHADOWED),
        .fog_ns = span_ns(device, stamps, HOST_STAMP_SEEN, HOST_STAMP_FOGGED),
    };
    return true;
}

static void stamp(const struct host_renderer *renderer, const struct host_slot *slot, enum host_stamp which)
{
    if (renderer->queries)
        vkCmdWriteTimestamp(slot->cmd,
                            which == HOST_STAMP_BEGIN ? VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT
                                                      : VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            renderer->queries, HOST_STAMP_COUNT * slot_index(renderer, slot) + which);
}

bool host_slot_wait(struct host_renderer *renderer, struct host_slot *slot)
{
    struct host_device *device = renderer->device;
    if (!slot->in_flight)
        return true;
    if (!host_check(device, vkWaitForFences(device->device, 1, &slot->fence, VK_TRUE, UINT64_MAX),
                    "waiting for a frame") ||
        !host_check(device, vkResetFences(device->device, 1, &slot->fence), "resetting a fence"))
        return false;
    slot->in_flight = false;
    return timestamps_read(renderer, slot);
}

/* Oldest first, so that the newest frame's time is what remains. */
bool host_slots_wait(struct host_renderer *renderer)
{
    for (uint64_t i = 0; i < HOST_SLOTS; i++) {
        if (!host_slot_wait(renderer, &renderer->slots[(renderer->submit_count + i) % HOST_SLOTS]))
            return false;
    }
    return true;
}

struct host_slot *host_slot_begin(struct host_renderer *renderer)
{
    struct host_device *device = renderer->device;
    struct host_slot *slot = &renderer->slots[renderer->submit_count % HOST_SLOTS];
    const VkCommandBufferBeginInfo begin = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT };
    if (!host_slot_wait(renderer, slot) ||
        !host_check(device, vkBeginCommandBuffer(slot->cmd, &begin), "beginning a command buffer"))
        return NULL;
    if (renderer->queries)
        vkCmdResetQueryPool(slot->cmd, renderer->queries, HOST_STAMP_COUNT * slot_index(renderer, slot),
                            HOST_STAMP_COUNT);
    stamp(renderer, slot, HOST_STAMP_BEGIN);
    return slot;
}

bool host_slot_submit(struct host_renderer *renderer, struct host_slot *slot, const VkSemaphore semaphores[2])
{
    static const VkPipelineStageFlags wait_stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    struct host_device *device = renderer->device;
    stamp(renderer, slot, HOST_STAMP_END);
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = semaphores ? 1 : 0,
        .pWaitSemaphores = semaphores,
        .pWaitDstStageMask = &wait_stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &slot->cmd,
        .signalSemaphoreCount = semaphores ? 1 : 0,
        .pSignalSemaphores = semaphores ? &semaphores[1] : NULL,
    };
    if (!host_check(device, vkEndCommandBuffer(slot->cmd), "ending a command buffer") ||
        !host_check(device, vkQueueSubmit(device->queue, 1, &submit, slot->fence), "submitting a frame"))
        return false;
    slot->in_flight = true;
    renderer->submit_count++;
    return true;
}

/* ---- What shaders read ------------------------------------------------------------------------------ */

static void frame_fill(const struct host_renderer *renderer, struct host_frame_data *out)
{
    const struct host_camera_frame *camera = &renderer->camera;
    const struct host_sky *sky = &renderer->scene->sky;
    *out = (struct host_frame_data){ .counts = { renderer->scene->sun_count, renderer->scene->light_count,
                                                 (uint32_t)renderer->shown, renderer->supersample } };
    for (int i = 0; i < 3; i++) {
        out->camera_position[i] = (float)(camera->position[i] - camera->origin[i]);
        out->camera_forward[i] = (float)camera->forward[i];
        out->camera_right[i] = (float)(camera->right[i] * camera->half_x);
        out->camera_up[i] = (float)(camera->up[i] * camera->half_y);
        out->sky_zenith[i] = sky->zenith[i];
        out->sky_horizon[i] = sky->horizon[i];
        out->sky_ground[i] = sky->ground[i];
    }
    out->camera_forward[3] = camera->orthographic ? 1.0f : 0.0f;
    out->camera_range[0] = (float)camera->near_m;
    out->camera_range[1] = (float)camera->range_m;
    for (uint32_t i = 0; i < renderer->scene->sun_count; i++)
        host_sun_fill(renderer, i, &out->suns[i]);
    host_fog_fill(renderer, out);
}

static void light_fill(const struct host_renderer *renderer, uint32_t index, struct host_light_data *out)
{
    const struct host_scene_light *light = &renderer->scene->lights[index];
    *out = (struct host_light_data){ .cone = { -2.0f, 1.0f } };
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float)(light->position[i] - renderer->camera.origin[i]);
        out->intensity[i] = light->intensity[i];
        out->direction[i] = (float)light->direction[i];
    }
    out->position[3] = light->range_m > 0.0f ? 1.0f / light->range_m : 0.0f;
    out->intensity[3] = (float)renderer->shadows.light_layer[index];
    out->direction[3] = light->cube ? 1.0f : 0.0f;
    if (light->type == HOST_LIGHT_SPOT) {
        out->cone[0] = cosf(light->outer_rad);
        out->cone[1] = 1.0f / fmaxf(cosf(light->inner_rad) - out->cone[0], 1e-6f);
    }
}

static void eye_fill(struct host_renderer *renderer, const struct host_slot *slot)
{
    struct host_frame_data frame;
    frame_fill(renderer, &frame);
    memcpy(host_slot_here(renderer, slot)->frame.mapped, &frame, sizeof(frame));
}

/* Lights are relative to an origin that both eyes have. */
static void slot_fill(struct host_renderer *renderer, const struct host_slot *slot)
{
    struct host_light_data *lights = slot->lights.mapped;
    for (uint32_t i = 0; i < renderer->scene->light_count; i++)
        light_fill(renderer, i, &lights[i]);
    memcpy(slot->layers.mapped, renderer->shadows.layers,
           renderer->shadows.layer_count * sizeof(struct host_layer_data));
}

/* ---- Recording -------------------------------------------------------------------------------------- */

static void pass_begin(struct host_renderer *renderer, VkCommandBuffer cmd, VkRenderPass pass,
                       VkFramebuffer framebuffer, const struct host_image *size)
{
    const VkClearValue clears[2] = { { .color = { .float32 = { 0, 0, 0, 0 } } },
                                     { .depthStencil = { 0.0f, 0 } } };
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = pass,
        .framebuffer = framebuffer,
        .renderArea = { { 0, 0 }, { size->width, size->height } },
        .clearValueCount = pass == renderer->passes.prepass ? 2 : 1,
        .pClearValues = clears,
    };
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    host_viewport_set(cmd, 0, size->width, size->height);
}

static bool gi_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    struct sdfgi_frame_desc desc = { .seed = renderer->seed, .exposure = renderer->gi_exposure };
    host_camera_center(&renderer->camera, renderer->scene->center, desc.camera_position);
    memcpy(desc.origin, renderer->camera.origin, sizeof(desc.origin));
    return host_gi_update(renderer->gi, cmd, renderer->scene, &desc);
}

void host_prepass_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    pass_begin(renderer, cmd, renderer->passes.prepass, renderer->targets.prepass, &renderer->targets.depth);
    host_draw_prepass(renderer, cmd);
    vkCmdEndRenderPass(cmd);
}

/* The picture of the eye that has begun. Times of fog are those of the first one. */
static bool eye_record(struct host_renderer *renderer, struct host_slot *slot)
{
    const struct host_eye *eye = host_eye_here(renderer);
    const bool is_timed = renderer->eye == 0;
    VkCommandBuffer cmd = slot->cmd;

    /* Find what is visible. */
    host_prepass_record(renderer, cmd);

    /* Look up its light. */
    if (!host_lookup_record(renderer, slot))
        return false;

    /* Light the fog in front of it. */
    if (host_fog_exists(renderer->scene)) {
        if (is_timed)
            stamp(renderer, slot, HOST_STAMP_SEEN);
        host_fog_record(renderer, cmd, host_slot_here(renderer, slot)->set);
        if (is_timed)
            stamp(renderer, slot, HOST_STAMP_FOGGED);
    }

    /* Shade it, and nothing else. */
    pass_begin(renderer, cmd, renderer->passes.forward, eye->forward, &eye->hdr);
    host_draw_forward(renderer, slot);
    vkCmdEndRenderPass(cmd);
    return true;
}

bool host_frame_record(struct host_renderer *renderer, struct host_slot *slot, bool update_gi)
{
    VkCommandBuffer cmd = slot->cmd;
    renderer->camera = renderer->head;

    /* Let the library do its share. GI may have been switched since the last frame. */
    if ((update_gi && !gi_record(renderer, cmd)) || !host_forward_prepare(renderer) ||
        !host_fog_prepare(renderer)) {
        vkEndCommandBuffer(cmd);
        return false;
    }

    stamp(renderer, slot, HOST_STAMP_UPDATED);

    /* Draw the shadow maps that are missing; what they hold decides what shaders are told. */
    host_shadows_record(renderer, cmd);
    slot_fill(renderer, slot);
    stamp(renderer, slot, HOST_STAMP_SHADOWED);

    /* Draw what each eye sees. */
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        host_eye_begin(renderer, eye);
        eye_fill(renderer, slot);
        if (!eye_record(renderer, slot)) {
            vkEndCommandBuffer(cmd);
            return false;
        }
    }
    return true;
}

static void post_bind(struct host_renderer *renderer, VkCommandBuffer cmd, VkPipelineBindPoint point,
                      VkDescriptorSet set, float exposure, uint32_t first_column)
{
    const struct host_tone_push push = { exposure, (int32_t)renderer->supersample, (int32_t)first_column };
    vkCmdBindDescriptorSets(cmd, point, renderer->pipelines.post_pipeline_layout, 0, 1, &set, 0, NULL);
    vkCmdPushConstants(cmd, renderer->pipelines.post_pipeline_layout,
                       VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(push), &push);
}

void host_exposure_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    const VkPipelineStageFlags readers = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_HOST_BIT;
    const VkMemoryBarrier before = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_SHADER_READ_BIT,
                                     .dstAccessMask = VK_ACCESS_SHADER_WRITE_BIT };
    const VkMemoryBarrier after = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_HOST_READ_BIT };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &before, 0, NULL, 0, NULL);
    post_bind(renderer, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, renderer->post_sets[0], 0.0f, 0);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, renderer->pipelines.exposure);
    vkCmdDispatch(cmd, 1, 1, 1);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, readers, 0, 1, &after, 0, NULL, 0, NULL);
}

/* Each eye's into its part of the picture. */
static void tonemap(struct host_renderer *renderer, VkCommandBuffer cmd, VkPipeline pipeline,
                    const VkDescriptorSet *sets, float exposure)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        const uint32_t first = host_eye_column(renderer, eye);
        post_bind(renderer, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, sets[eye], exposure, first);
        host_viewport_set(cmd, first, renderer->width, renderer->height);
        vkCmdDraw(cmd, 3, 1, 0, 0);
    }
}

void host_tonemap_record(struct host_renderer *renderer, VkCommandBuffer cmd, VkPipeline pipeline,
                         float exposure)
{
    tonemap(renderer, cmd, pipeline, renderer->post_sets, exposure);
}

void host_debug_show(struct host_renderer *renderer, VkCommandBuffer cmd, VkPipeline pipeline)
{
    tonemap(renderer, cmd, pipeline, renderer->debug_sets, HOST_TONE_NONE);
}

struct host_slot *host_renderer_frame_begin(struct host_renderer *renderer, const struct host_camera *camera,
                                            enum host_aov shown)
{
    host_eye_look(renderer, camera);
    renderer->shown = shown;
    struct host_slot *slot = host_slot_begin(renderer);
    if (!slot || !host_frame_record(renderer, slot, true))
        return NULL;
    return slot;
}

bool host_renderer_frame(struct host_renderer *renderer, const struct host_camera *camera)
{
    struct host_slot *slot = host_renderer_frame_begin(renderer, camera, HOST_AOV_COLOR);
    if (!slot || !host_slot_submit(renderer, slot, NULL))
        return false;
    renderer->has_frame = true;
    return true;
}

/* No view of the last frame is left then: whoever asks for one draws it again. */
bool host_renderer_frame_without_gi(struct host_renderer *renderer, const struct host_camera *camera)
{
    host_eye_look(renderer, camera);
    renderer->shown = HOST_AOV_COLOR;
    renderer->without_gi = true;
    struct host_slot *slot = host_slot_begin(renderer);
    const bool drawn =
        slot && host_frame_record(renderer, slot, false) && host_slot_submit(renderer, slot, NULL);
    renderer->without_gi = false;
    renderer->shown = HOST_AOV_COUNT;
    return drawn && host_slots_wait(renderer);
}

/* ---- The loop --------------------------------------------------------------------------------------- */

enum { DEFAULT_MAX_FRAMES = 8000 };

static bool loop_done(const struct host_until_desc *desc, const struct sdfgi_report *report, uint32_t frames)
{
    const uint32_t limit = desc->max_frames > 0 ? desc->max_frames : DEFAULT_MAX_FRAMES;
    if (desc->frames > 0)
        return frames >= desc->frames;
    return frames >= limit || !report->active || report->converged;
}

bool host_render_until(struct host_renderer *renderer, const struct host_camera *camera,
                       const struct host_until_desc *desc, uint32_t *frames)
{
    struct sdfgi_report report;
    uint32_t count = 0;
    bool go_on = true;
    do {
        if (!host_renderer_frame(renderer, camera))
            return false;
        host_gi_get_report(renderer->gi, &report);
        const struct host_frame frame = { .index = count,
                                          .gpu_ns = renderer->times.frame_ns,
                                          .report = &report };
        count++;
        go_on = !desc->progress || desc->progress(desc->user, &frame);
    } while (go_on && !loop_done(desc, &report, count));
    if (frames)
        *frames = count;
    return host_slots_wait(renderer);
}
