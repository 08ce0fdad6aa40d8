/* SPDX-License-Identifier: MIT */
#include "debug_pixel.h"

#include "require.h"

#include <math.h>

struct sdfgi_debug_desc debug_desc(enum debug_camera camera, const double eye[static 3], int axis)
{
    const double near_m = 0.01, tan_half = 0.05;
    struct sdfgi_debug_desc desc = { .background_depth = camera == DEBUG_CAMERA_REVERSED ? 0 : 1 };
    float *m = desc.inverse_view_projection;
    const int along = axis / 2, right = (along + 1) % 3, up = (along + 2) % 3;
    const float forward = axis % 2 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        const float scale = (float)(camera == DEBUG_CAMERA_ORTHOGRAPHIC ? 0.01 : near_m * tan_half);
        m[k] = k == right ? scale : 0;
        m[4 + k] = k == up ? scale : 0;
        m[8 + k] = k == along && camera == DEBUG_CAMERA_ORTHOGRAPHIC ? 1000 * forward : 0;
        m[12 + k] = (float)eye[k];
    }
    m[15] = 1;
    if (camera == DEBUG_CAMERA_ORTHOGRAPHIC)
        return desc;
    /* Of depth z the way along the axis is near / z, or near / (1 - z): a far plane would make it end. */
    const float sign = camera == DEBUG_CAMERA_REVERSED ? 1 : -1;
    for (int k = 0; k < 3; k++) {
        m[8 + k] = sign * (float)eye[k];
        m[12 + k] = (camera == DEBUG_CAMERA_REVERSED ? 0 : (float)eye[k]) +
                    (k == along ? (float)near_m * forward : 0);
    }
    m[11] = sign;
    m[15] = camera == DEBUG_CAMERA_REVERSED ? 0 : 1;
    return desc;
}

struct draw {
    sdfgi *gi;
    const struct sdfgi_debug_desc *desc;
};

static void record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct draw *draw = user;
    REQUIRE_CMP((int)sdfgi_debug_draw(draw->gi, cmd, draw->desc), ==, (int)SDFGI_OK);
}

struct debug_color debug_pixel(struct gi_test *t, const struct sdfgi_debug_desc *desc)
{
    uint16_t texels[DEBUG_PIXELS][4];
    struct gpu_test_image output =
        gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, DEBUG_SIDE, DEBUG_SIDE, NULL);
    struct sdfgi_debug_desc full = *desc;
    full.output = output.view;
    full.width = full.height = DEBUG_SIDE;
    struct draw draw = { t->gi, &full };
    gpu_test_submit(&t->gpu, record, &draw);
    gpu_test_image_read(&t->gpu, output.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        output.extent, 8, texels);
    gpu_test_image_destroy(&t->gpu, &output);
    struct debug_color color;
    for (int i = 0; i < DEBUG_PIXELS; i++) {
        REQUIRE_CMP(gi_test_half(texels[i][3]), ==, 1.0f);
        for (int k = 0; k < 3; k++) {
            const double value = (double)gi_test_half(texels[i][k]);
            REQUIRE_TRUE(value >= 0 && value <= 1);
            if (i == DEBUG_PIXELS / 2)
                color.rgb[k] = value;
        }
    }
    return color;
}

struct debug_color debug_look(struct gi_test *t, enum sdfgi_debug_view view, const double eye[static 3],
                              int axis)
{
    struct sdfgi_debug_desc desc = debug_desc(DEBUG_CAMERA_REVERSED, eye, axis);
    desc.view = view;
    return debug_pixel(t, &desc);
}

struct debug_color debug_hue(struct debug_color color)
{
    const double most = fmax(color.rgb[0], fmax(color.rgb[1], color.rgb[2]));
    for (int k = 0; k < 3; k++)
        color.rgb[k] /= most;
    return color;
}

struct debug_color debug_blue_to_red(double value)
{
    const double from_green = 4 * value - 2, rgb[3] = { from_green, 2 - fabs(from_green), -from_green };
    struct debug_color color;
    for (int k = 0; k < 3; k++)
        color.rgb[k] = fmin(fmax(rgb[k], 0), 1);
    return color;
}

double debug_value_of(struct debug_color color)
{
    const struct debug_color hue = debug_hue(color);
    double best = 0, least = INFINITY;
    for (int i = 0; i <= 1000; i++) {
        const struct debug_color on_scale = debug_blue_to_red(i / 1000.0);
        double off = 0;
        for (int k = 0; k < 3; k++)
            off = fmax(off, fabs(on_scale.rgb[k] - hue.rgb[k]));
        if (off < least) {
            least = off;
            best = i / 1000.0;
        }
    }
    REQUIRE_CMP(least, <=, 0.01);
    return best;
}
