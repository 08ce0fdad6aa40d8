/* SPDX-License-Identifier: MIT
 * Pictures and AOVs brought back to the CPU. */
#include "host_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static float float_from_half(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const float sign = half >> 15 ? -1.0f : 1.0f;
    if (exponent == 0)
        return sign * ldexpf((float)mantissa, -24);
    if (exponent == 31)
        return mantissa ? NAN : sign * INFINITY;
    return sign * ldexpf((float)(mantissa + 1024), exponent - 25);
}

/* Draws the last frame again, showing something else; the light stays as it is. */
static bool draw_again(struct host_renderer *renderer, enum host_aov shown)
{
    renderer->shown = shown;
    struct host_slot *slot = host_slot_begin(renderer);
    return slot && host_frame_record(renderer, slot, false) && host_slot_submit(renderer, slot, NULL) &&
           host_slots_wait(renderer);
}

static bool ensure_shown(struct host_renderer *renderer, enum host_aov shown)
{
    if (!renderer->has_frame)
        return host_fail(renderer->device, "nothing has been rendered yet");
    return renderer->shown == shown ? host_slots_wait(renderer) : draw_again(renderer, shown);
}

/* All samples of an image as floats; NULL on failure. */
static float *samples_read(struct host_renderer *renderer, const struct host_image *image)
{
    const size_t count = (size_t)4 * image->width * image->height;
    float *samples = host_device_alloc(renderer->device, count, sizeof(float));
    const bool half = image->format == VK_FORMAT_R16G16B16A16_SFLOAT;
    if (!samples || !host_image_download(renderer->device, image, half ? 8 : 16, samples)) {
        free(samples);
        return NULL;
    }
    /* Backwards, since the floats grow over the halves they come from. */
    for (size_t i = count; half && i-- > 0;) {
        uint16_t bits;
        memcpy(&bits, (const uint8_t *)samples + 2 * i, sizeof(bits));
        samples[i] = float_from_half(bits);
    }
    return samples;
}

/* Into an eye's part of a picture. */
static void box_filter(const struct host_renderer *renderer, const float *samples, uint32_t eye, float *rgba)
{
    float *part = rgba + 4 * host_eye_column(renderer, eye);
    const uint32_t s = renderer->supersample, stride = renderer->width * s;
    const float weight = 1.0f / (float)(s * s);
    for (uint32_t y = 0; y < renderer->height; y++) {
        for (uint32_t x = 0; x < 4 * renderer->width; x++) {
            float sum = 0.0f;
            for (uint32_t i = 0; i < s * s; i++) {
                const size_t row = (size_t)y * s + i / s, column = (size_t)(x / 4) * s + i % s;
                sum += samples[4 * (row * stride + column) + x % 4];
            }
            part[(size_t)4 * y * renderer->picture_width + x] = sum * weight;
        }
    }
}

/* What all eyes saw, or debug views of it. */
static bool eyes_read(struct host_renderer *renderer, bool debug, float *rgba)
{
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        const struct host_eye *from = &renderer->targets.eyes[eye];
        float *samples = samples_read(renderer, debug ? &from->debug : &from->hdr);
        if (!samples)
            return false;
        box_filter(renderer, samples, eye, rgba);
        free(samples);
    }
    return true;
}

bool host_renderer_read_aov(struct host_renderer *renderer, enum host_aov aov, float *rgba)
{
    return ensure_shown(renderer, aov) && eyes_read(renderer, false, rgba);
}

/* Fills the picture: with the debug view that has been drawn, or with the colour of the last frame. */
static bool picture_draw(struct host_renderer *renderer, bool debug, float exposure)
{
    const struct host_targets *targets = &renderer->targets;
    VkCommandBuffer cmd = host_commands_begin(renderer->device);
    if (!cmd)
        return false;
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = renderer->passes.picture,
        .framebuffer = targets->picture_framebuffer,
        .renderArea = { { 0, 0 }, { renderer->picture_width, renderer->height } },
    };
    host_exposure_record(renderer, cmd);
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    if (debug)
        host_debug_show(renderer, cmd, renderer->pipelines.tonemap);
    else
        host_tonemap_record(renderer, cmd, renderer->pipelines.tonemap, exposure);
    vkCmdEndRenderPass(cmd);
    return host_commands_finish(renderer->device, cmd);
}

static bool debug_draw(struct host_renderer *renderer, enum sdfgi_debug_view view, float exposure)
{
    const struct host_debug_desc desc = { view, exposure };
    if (!host_gi_set(renderer->gi))
        return host_fail(renderer->device, "global illumination is off: there is nothing to show");
    VkCommandBuffer cmd = host_commands_begin(renderer->device);
    if (!cmd)
        return false;
    const bool recorded = host_debug_record(renderer, cmd, &desc);
    return host_commands_finish(renderer->device, cmd) && recorded;
}

/* Draws the last frame as it would be without GI. */
static bool draw_without_gi(struct host_renderer *renderer)
{
    if (!renderer->has_frame)
        return host_fail(renderer->device, "nothing has been rendered yet");
    renderer->without_gi = true;
    const bool drawn = draw_again(renderer, HOST_AOV_COLOR);
    renderer->without_gi = false;
    renderer->shown = HOST_AOV_COUNT;
    return drawn;
}

/* Draws the picture to find its exposure, unless one is given. */
static bool expose(struct host_renderer *renderer, bool without_gi, float given, float *exposure)
{
    const bool drawn = without_gi ? draw_without_gi(renderer) : ensure_shown(renderer, HOST_AOV_COLOR);
    if (!drawn || !picture_draw(renderer, false, given))
        return false;
    *exposure = given;
    if (!(given > 0.0f))
        memcpy(exposure, renderer->exposure.mapped, sizeof(float));
    return true;
}

bool host_renderer_read_picture(struct host_renderer *renderer, const struct host_picture_desc *desc,
                                uint8_t *rgba)
{
    const bool debug = desc->debug && *desc->debug < SDFGI_DEBUG_VIEW_COUNT;
    float exposure;
    if (!expose(renderer, desc->without_gi, desc->exposure, &exposure) ||
        (debug && (!debug_draw(renderer, *desc->debug, exposure) || !picture_draw(renderer, true, 0.0f))) ||
        !host_image_download(renderer->device, &renderer->targets.picture, 4, rgba))
        return false;
    if (desc->exposure_out)
        *desc->exposure_out = exposure;
    return true;
}

bool host_renderer_read_debug(struct host_renderer *renderer, enum sdfgi_debug_view view, float exposure,
                              float *rgba)
{
    return expose(renderer, false, exposure, &exposure) && debug_draw(renderer, view, exposure) &&
           eyes_read(renderer, true, rgba);
}
