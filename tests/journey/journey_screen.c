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
    const struct sdfgi_view_desc view = { .width = JOURNEY_SCREEN_WIDTH, .height = JOURNEY_SCREEN_HEIGHT };
    const struct sdfgi_material_desc smooth = { .smoothness = 1 };
    sdfgi_material unused;
    REQUIRE_CMP((int)sdfgi_view_create(t->gi, &view, &screen->view), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &smooth, &unused), ==, (int)SDFGI_OK);
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

/* Clip (x, y, depth) to (6 x, -1 - 2 depth, 6 y), column-major. */
static const float to_position[16] = { 6, 0, 0, 0, 0, 0, 6, 0, 0, -2, 0, 0, 0, -1, 0, 1 };

static const void *read_pixels(struct journey_screen *screen, struct gi_test *t, VkImage image)
{
    gpu_test_image_read(&t->gpu, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        screen->output.extent, 8, screen->pixels);
    return screen->pixels;
}

const void *journey_screen_gather(struct journey_screen *screen, struct gi_test *t,
                                  enum sdfgi_gather_resolution resolution)
{
    struct sdfgi_gather_desc desc = { .depth = screen->depth.view,
                                      .normal = screen->normal.view,
                                      .output = screen->output.view,
                                      .width = JOURNEY_SCREEN_WIDTH,
                                      .height = JOURNEY_SCREEN_HEIGHT,
                                      .background_depth = 1,
                                      .resolution = resolution };
    memcpy(desc.inverse_view_projection, to_position, sizeof to_position);
    gi_test_gather(t, &desc);
    return read_pixels(screen, t, screen->output.image);
}

const void *journey_screen_reflect(struct journey_screen *screen, struct gi_test *t)
{
    struct sdfgi_resolve_desc desc = { .depth = screen->depth.view,
                                       .normal = screen->normal.view,
                                       .roughness = screen->depth.view,
                                       .background_depth = 1 };
    memcpy(desc.inverse_view_projection, to_position, sizeof to_position);
    gi_test_resolve(t, screen->view, &desc);
    return read_pixels(screen, t, screen->view->reflection.handle);
}

struct debug {
    sdfgi *gi;
    struct sdfgi_debug_desc desc;
};

static void record_debug(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct debug *debug = user;
    REQUIRE_CMP((int)sdfgi_debug_draw(debug->gi, cmd, &debug->desc), ==, (int)SDFGI_OK);
}

const void *journey_screen_debug(struct journey_screen *screen, struct gi_test *t, enum sdfgi_debug_view view)
{
    struct debug debug = { t->gi,
                           { .output = screen->output.view,
                             .width = JOURNEY_SCREEN_WIDTH,
                             .height = JOURNEY_SCREEN_HEIGHT,
                             .background_depth = 1,
                             .view = view,
                             .depth = screen->depth.view,
                             .normal = screen->normal.view,
                             .roughness = screen->depth.view } };
    memcpy(debug.desc.inverse_view_projection, to_position, sizeof to_position);
    gpu_test_submit(&t->gpu, record_debug, &debug);
    return read_pixels(screen, t, screen->output.image);
}
