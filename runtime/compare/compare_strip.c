/* SPDX-License-Identifier: MIT */
#include "compare.h"

#include "image/tone.h"

#include <math.h>
#include <string.h>

static void panel_paint(const struct image *image, float exposure, size_t panel, uint8_t *rgba)
{
    const size_t width = image->width, stride = COMPARE_STRIP_PANELS * width;
    for (size_t i = 0; i < width * image->height; i++) {
        float shown[3];
        if (image->display_referred)
            memcpy(shown, image->rgba + 4 * i, sizeof shown);
        else
            tone_map(image->rgba + 4 * i, exposure, shown);
        uint8_t *const to = rgba + 4 * (i / width * stride + panel * width + i % width);
        for (int c = 0; c < 3; c++)
            to[c] = (uint8_t)(255 * fminf(fmaxf(shown[c], 0), 1) + 0.5f);
        to[3] = 255;
    }
}

void compare_paint_strip(const struct image *picture, const struct image *reference, const float *flip_map,
                         double exposure, uint8_t *rgba)
{
    const size_t width = reference->width, stride = COMPARE_STRIP_PANELS * width;
    panel_paint(picture, (float)exposure, 0, rgba);
    panel_paint(reference, (float)exposure, 1, rgba);
    for (size_t y = 0; y < reference->height; y++)
        compare_paint_map(flip_map + y * width, width, rgba + 4 * (y * stride + 2 * width));
}
