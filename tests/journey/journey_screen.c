/* SPDX-License-Identifier: MIT */
#include "journey_screen.h"

#include "require.h"

enum { PIXELS = JOURNEY_SCREEN_WIDTH * JOURNEY_SCREEN_HEIGHT };

void journey_screen_open(struct journey_screen *screen, struct gi_test *t)
{
    static float depth[PIXELS], normals[PIXELS][4];
    for (int i = 0; i < PIXELS; i++) {
        depth[i] = i % 17 == 3 ? 1.0f : 0.25f + 0.001f * (float)i;
        normals[i][1] = 1;
    }
    screen->depth =
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, JOURNEY_SCREEN_WIDTH, JOURNEY_SCREEN_HEIGHT, depth);
    screen->normal = gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, JOURNEY_SCREEN_WIDTH,
                                          JOURNEY_SCREEN_HEIGHT, normals);
    screen->output = gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, JOURNEY_SCREEN_WIDTH,
                                          JOURNEY_SCREEN_HEIGHT, NULL);
    screen->made = true;
}

void journey_screen_close(struct journey_screen *screen, struct gi_test *t)
{
    if (!screen->made)
        return;
    gpu_test_image_destroy(&t->gpu, &screen->depth);
    gpu_test_image_destroy(&t->gpu, &screen->normal);
    gpu_test_image_destroy(&t->gpu, &screen->output);
}

const void *journey_screen_gather(struct journey_screen *screen, struct gi_test *t,
                                  enum sdfgi_gather_resolution resolution)
{
    const struct sdfgi_gather_desc desc = { .depth = screen->depth.view,
                                            .normal = screen->normal.view,
                                            .output = screen->output.view,
                                            .width = JOURNEY_SCREEN_WIDTH,
                                            .height = JOURNEY_SCREEN_HEIGHT,
                                            .background_depth = 1,
                                            .resolution = resolution,
                                            /* clip (x, y, depth) to (6 x, -1 - 2 depth, 6 y), column-major */
                                            .inverse_view_projection = { 6, 0, 0, 0, 0, 0, 6, 0, 0, -2, 0, 0,
                                                                         0, -1, 0, 1 } };
    gi_test_gather(t, &desc);
    gpu_test_image_read(&t->gpu, screen->output.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        screen->output.extent, 8, screen->pixels);
    return screen->pixels;
}
