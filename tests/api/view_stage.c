/* SPDX-License-Identifier: MIT */
#include "view_stage.h"

#include "require.h"

#include <math.h>
#include <string.h>

const float view_stage_zenith[3] = { 1, 1.5f, 2 };

/* The slope of the detail at a pixel: another one for each of the next eight. */
static float slope(int pixel)
{
    return 0.05f * (float)(pixel % 9 - 4);
}

static void fill_picture(struct view_stage *s)
{
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++) {
        const float u = ((float)(i % VIEW_STAGE_SIDE) + 0.5f) / VIEW_STAGE_SIDE * 2 - 1;
        const bool in_wall = fabsf(3 * u + 2) < 0.6f;
        s->depths[i] = in_wall ? 1.0f : 0.5f;
        const int in_square = (i % VIEW_STAGE_SIDE & 1) + 2 * (i / VIEW_STAGE_SIDE & 1);
        const bool is_dot = in_square > 0 && in_square <= s->dots,
                   leans = is_dot || (s->ridge && i % VIEW_STAGE_SIDE == s->ridge);
        const float x = s->detail == VIEW_STAGE_EVEN ? 0 : slope(i % VIEW_STAGE_SIDE),
                    z = s->detail == VIEW_STAGE_COBBLES ? slope(i / VIEW_STAGE_SIDE) : 0;
        memcpy(s->normals[i], (float[]){ leans ? 1 : s->lean + x, 1, z, 0 }, sizeof s->normals[i]);
    }
}

void view_stage_open(struct view_stage *s, float smoothness)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.min_cell_size_m = 0.4f;
    gi_test_renew(&s->t, &settings);
    struct test_mesh box = test_mesh_box((double[]){ 0, -3, 0 }, (double[]){ 4, 1, 4 }, test_rotation_none),
                     wall =
                         test_mesh_box((double[]){ -2, 0, 0 }, (double[]){ 0.4, 2, 3 }, test_rotation_none);
    gi_test_add(&s->t, &box, gi_test_material(&s->t, (float[]){ 0.7f, 0.7f, 0.7f }, (float[]){ 0, 0, 0 }));
    gi_test_add(&s->t, &wall,
                gi_test_material(&s->t, (float[]){ 0.8f, 0.2f, 0.1f }, (float[]){ 1, 0.5f, 0 }));
    test_mesh_destroy(&box);
    test_mesh_destroy(&wall);
    const struct sdfgi_material_desc desc = { .smoothness = smoothness };
    REQUIRE_CMP((int)sdfgi_material_create(s->t.gi, &desc, &s->smooth), ==, (int)SDFGI_OK);
    struct sdfgi_sky sky = { .horizon = { 1, 1, 1 } };
    memcpy(sky.zenith, view_stage_zenith, sizeof view_stage_zenith);
    REQUIRE_CMP((int)sdfgi_set_sky(s->t.gi, &sky), ==, (int)SDFGI_OK);
    gi_test_update(&s->t, 8);
    fill_picture(s);
    s->ridge = 0;
    s->dots = 0;
    s->lean = 0;
    s->detail = VIEW_STAGE_EVEN;
    s->depth =
        gi_test_gather_image(&s->t, VK_FORMAT_R32_SFLOAT, 4, VIEW_STAGE_SIDE, VIEW_STAGE_SIDE, s->depths);
    s->normal = gi_test_gather_image(&s->t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, VIEW_STAGE_SIDE,
                                     VIEW_STAGE_SIDE, s->normals);
}

void view_stage_close(struct view_stage *s)
{
    gpu_test_image_destroy(&s->t.gpu, &s->depth);
    gpu_test_image_destroy(&s->t.gpu, &s->normal);
}

/* ---- Resolves */

sdfgi_view *view_stage_view_of(struct view_stage *s, enum sdfgi_gather_resolution diffuse,
                               enum sdfgi_gather_resolution reflection)
{
    sdfgi_view *view = NULL;
    const struct sdfgi_view_desc desc = {
        .width = VIEW_STAGE_SIDE, .height = VIEW_STAGE_SIDE, .diffuse = diffuse, .reflection = reflection
    };
    REQUIRE_CMP((int)sdfgi_view_create(s->t.gi, &desc, &view), ==, (int)SDFGI_OK);
    return view;
}

sdfgi_view *view_stage_view_at(struct view_stage *s, enum sdfgi_gather_resolution reflection)
{
    return view_stage_view_of(s, SDFGI_GATHER_FULL, reflection);
}

sdfgi_view *view_stage_view(struct view_stage *s)
{
    return view_stage_view_at(s, SDFGI_GATHER_FULL);
}

struct sdfgi_resolve_desc view_stage_desc(const struct view_stage *s, VkImageView roughness)
{
    return (struct sdfgi_resolve_desc){
        .depth = s->depth.view,
        .normal = s->normal.view,
        .roughness = roughness,
        .background_depth = 1,
        .inverse_view_projection = { 3, 0, 0, 0, 0, 0, 3, 0, 0, -2, 0, 0, 0, -1, 0, 1 },
    };
}

void view_stage_resolve_halves(struct view_stage *s, sdfgi_view *view, float left, float right)
{
    float pixels[VIEW_STAGE_PIXELS];
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        pixels[i] = i % VIEW_STAGE_SIDE < VIEW_STAGE_SIDE / 2 ? left : right;
    struct gpu_test_image image =
        gi_test_gather_image(&s->t, VK_FORMAT_R32_SFLOAT, 4, VIEW_STAGE_SIDE, VIEW_STAGE_SIDE, pixels);
    const struct sdfgi_resolve_desc desc = view_stage_desc(s, left < 0 ? VK_NULL_HANDLE : image.view);
    gi_test_resolve(&s->t, view, &desc);
    gpu_test_image_destroy(&s->t.gpu, &image);
}

void view_stage_resolve(struct view_stage *s, sdfgi_view *view, float roughness)
{
    view_stage_resolve_halves(s, view, roughness, roughness);
}

void view_stage_read(struct view_stage *s, const struct gpu_image *image, float (*out)[4])
{
    static uint16_t texels[VIEW_STAGE_PIXELS][4];
    gpu_test_image_read(&s->t.gpu, image->handle, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        (VkExtent3D){ VIEW_STAGE_SIDE, VIEW_STAGE_SIDE, 1 }, 8, texels);
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        for (int k = 0; k < 4; k++)
            out[i][k] = gi_test_half(texels[i][k]);
}

double view_stage_luminance(float (*pixels)[4])
{
    double sum = 0;
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        sum += 0.2126 * (double)pixels[i][0] + 0.7152 * (double)pixels[i][1] + 0.0722 * (double)pixels[i][2];
    return sum / VIEW_STAGE_PIXELS;
}

uint32_t view_stage_dispatches(struct view_stage *s, enum pass pass)
{
    static struct sdfgi_report report;
    sdfgi_get_report(s->t.gi, &report);
    return report.passes[pass].dispatches;
}

uint64_t view_stage_bytes(struct view_stage *s)
{
    static struct sdfgi_report report;
    sdfgi_get_report(s->t.gi, &report);
    return report.memory.bytes[SDFGI_MEMORY_VIEWS];
}
