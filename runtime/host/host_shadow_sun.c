/* SPDX-License-Identifier: MIT
 * Cascaded shadow maps of directional lights. A cascade is a square around the sphere that holds its slice of
 * the view, moved in whole texels, so that shadows stand still under a moving camera; one that has not moved
 * is kept. Texels are counted from the scene's centre, not the world's: a scene far out has the same shadows.
 */
#include "host_internal.h"
#include "host_math.h"

#include <string.h>

/* Share of logarithmic against even slices: 8, 32 and 164 m in a view of 1 km. More even ones leave stairs at
 * the edges of sunlit patches indoors. */
static const double split_blend = 0.98;
static const double split_near_m = 0.5;
/* Texels at the border that the filter may read beyond what it looks up. */
static const double border_texels = 8.0;

/* Distance to the far end of the scene, in powers of two so that it seldom changes. */
static double view_range_m(const struct host_scene *scene, const struct host_camera_frame *camera)
{
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = scene->center[i] - camera->position[i];
    const double farthest = sqrt(host_dot3(d, d)) + scene->radius;
    return exp2(ceil(log2(fmax(farthest, 1.0))));
}

static double split_m(int cascade, double range_m)
{
    if (cascade == 0)
        return 0.0;
    const double share = (double)cascade / HOST_CASCADES;
    const double even = share * range_m;
    return split_blend * split_near_m * pow(range_m / split_near_m, share) + (1.0 - split_blend) * even;
}

/* Smallest sphere around the part of the view between two distances; its centre relative to `origin`. */
static double slice_sphere(const struct host_camera_frame *camera, double from_m, double to_m,
                           const double origin[3], double center[3])
{
    /* Squared half diagonal of what is seen, 1 m away or anywhere. */
    const double k = camera->half_x * camera->half_x + camera->half_y * camera->half_y;
    const double middle = 0.5 * (from_m + to_m);
    const double along = camera->orthographic ? middle : fmin(to_m, middle * (1.0 + k));
    for (int i = 0; i < 3; i++)
        center[i] = (camera->position[i] - origin[i]) + along * camera->forward[i];
    return sqrt((to_m - along) * (to_m - along) + k * (camera->orthographic ? 1.0 : to_m * to_m));
}

static void cascade_place(const struct host_renderer *renderer, const struct host_scene_light *sun,
                          int cascade, struct host_sun_cascade *out)
{
    const struct host_scene *scene = renderer->scene;
    const double range_m = view_range_m(scene, &renderer->camera);
    double center[3], right[3], up[3];
    double radius = slice_sphere(&renderer->camera, split_m(cascade, range_m), split_m(cascade + 1, range_m),
                                 scene->center, center);
    if (radius >= scene->radius) {
        radius = scene->radius;
        memset(center, 0, sizeof(center));
    }
    host_frame3(sun->direction, right, up);
    *out = (struct host_sun_cascade){ 0 };
    memcpy(out->direction, sun->direction, sizeof(out->direction));
    out->half_m = fmax(radius, 0.01) * HOST_SUN_MAP_SIZE / (HOST_SUN_MAP_SIZE - 2.0 * border_texels);
    const double texel_m = 2.0 * out->half_m / HOST_SUN_MAP_SIZE;
    out->center[0] = floor(host_dot3(center, right) / texel_m + 0.5) * texel_m;
    out->center[1] = floor(host_dot3(center, up) / texel_m + 0.5) * texel_m;
    out->near_m = -scene->radius - 0.01;
    out->far_m = scene->radius + 0.01;
}

/* Rows that take a position relative to `origin`, itself relative to the scene's centre, to the map: see
 * struct host_sun_data. */
static void cascade_rows(const struct host_sun_cascade *cascade, const struct host_scene_light *sun,
                         const double origin[3], float (*rows)[4])
{
    double right[3], up[3];
    host_frame3(sun->direction, right, up);
    const double range = cascade->far_m - cascade->near_m;
    for (int i = 0; i < 3; i++) {
        rows[0][i] = (float)(right[i] / cascade->half_m);
        rows[1][i] = (float)(up[i] / cascade->half_m);
        rows[2][i] = (float)(-sun->direction[i] / range);
    }
    rows[0][3] = (float)((host_dot3(right, origin) - cascade->center[0]) / cascade->half_m);
    rows[1][3] = (float)((host_dot3(up, origin) - cascade->center[1]) / cascade->half_m);
    rows[2][3] = (float)((cascade->far_m - host_dot3(sun->direction, origin)) / range);
}

static void cascade_frustum(const struct host_sun_cascade *cascade, const struct host_scene_light *sun,
                            const double origin[3], struct host_frustum *out)
{
    double axes[2][3];
    host_frame3(sun->direction, axes[0], axes[1]);
    *out = (struct host_frustum){ .count = 4, .origin = { origin[0], origin[1], origin[2] } };
    for (int side = 0; side < 4; side++) {
        const double sign = side % 2 == 0 ? 1.0 : -1.0;
        for (int i = 0; i < 3; i++)
            out->planes[side][i] = sign * axes[side / 2][i];
        out->planes[side][3] = cascade->half_m - sign * cascade->center[side / 2];
    }
}

static void cascade_draw(struct host_renderer *renderer, VkCommandBuffer cmd, uint32_t layer,
                         const struct host_scene_light *sun)
{
    const struct host_sun_cascade *cascade = &renderer->shadows.cascades[layer];
    const VkClearValue clear = { .depthStencil = { 0.0f, 0 } };
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = renderer->passes.shadow,
        .framebuffer = renderer->shadows.sun_targets[layer],
        .renderArea = { { 0, 0 }, { HOST_SUN_MAP_SIZE, HOST_SUN_MAP_SIZE } },
        .clearValueCount = 1,
        .pClearValues = &clear,
    };
    struct host_frustum frustum;
    static const double scene_center[3];
    float rows[4][4] = { { 0 } };
    cascade_rows(cascade, sun, scene_center, rows);
    rows[3][3] = 1.0f;
    cascade_frustum(cascade, sun, renderer->scene->center, &frustum);
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    host_viewport_set(cmd, 0, HOST_SUN_MAP_SIZE, HOST_SUN_MAP_SIZE);
    host_draw_shadow(renderer, cmd, &frustum, renderer->scene->center, &rows[0][0]);
    vkCmdEndRenderPass(cmd);
}

static bool cascade_same(const struct host_sun_cascade *a, const struct host_sun_cascade *b)
{
    return memcmp(a->direction, b->direction, sizeof(a->direction)) == 0 && a->center[0] == b->center[0] &&
           a->center[1] == b->center[1] && a->half_m == b->half_m && a->near_m == b->near_m &&
           a->far_m == b->far_m;
}

void host_sun_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    for (uint32_t sun = 0; sun < renderer->scene->sun_count; sun++) {
        for (int c = 0; c < HOST_CASCADES; c++) {
            const uint32_t layer = sun * HOST_CASCADES + (uint32_t)c;
            struct host_sun_cascade *cascade = &renderer->shadows.cascades[layer];
            struct host_sun_cascade wanted;
            cascade_place(renderer, &renderer->scene->suns[sun], c, &wanted);
            if (cascade->rendered && cascade_same(cascade, &wanted))
                continue;
            *cascade = wanted;
            cascade->rendered = true;
            cascade_draw(renderer, cmd, layer, &renderer->scene->suns[sun]);
        }
    }
}

void host_sun_fill(const struct host_renderer *renderer, uint32_t index, struct host_sun_data *out)
{
    const struct host_scene_light *sun = &renderer->scene->suns[index];
    double origin[3];
    for (int i = 0; i < 3; i++)
        origin[i] = renderer->camera.origin[i] - renderer->scene->center[i];
    *out = (struct host_sun_data){ .direction = { 0, 0, 0, tanf(0.5f * sun->angle_rad) } };
    for (int i = 0; i < 3; i++) {
        out->direction[i] = (float)-sun->direction[i];
        out->irradiance[i] = sun->intensity[i];
    }
    for (int c = 0; c < HOST_CASCADES; c++) {
        const struct host_sun_cascade *cascade =
            &renderer->shadows.cascades[index * HOST_CASCADES + (uint32_t)c];
        cascade_rows(cascade, sun, origin, out->rows + 3 * c);
        out->scale[c][0] = (float)(2.0 * cascade->half_m / HOST_SUN_MAP_SIZE);
        out->scale[c][1] = (float)(cascade->far_m - cascade->near_m);
    }
}
