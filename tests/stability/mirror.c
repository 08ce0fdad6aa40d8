/* SPDX-License-Identifier: MIT */
#include "mirror.h"

#include "require.h"

#include <stdlib.h>

void mirror_open_rough(struct mirror *m, struct gi_test *t, uint32_t width, uint32_t height, float half_m,
                       const float *roughness)
{
    const uint32_t pixels = width * height;
    float *depth = calloc(pixels, sizeof *depth), (*normal)[4] = calloc(pixels, sizeof *normal);
    const struct sdfgi_view_desc view = { .width = width, .height = height };
    const struct sdfgi_material_desc smooth = { .smoothness = 1 };
    sdfgi_material material;
    REQUIRE_TRUE(depth && normal);
    for (uint32_t i = 0; i < pixels; i++) {
        depth[i] = 0.5f;
        normal[i][1] = 1;
    }
    *m = (struct mirror){ .t = t, .width = width, .height = height };
    m->depth = gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, width, height, depth);
    m->normal = gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, width, height, normal);
    m->roughness = gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, width, height, roughness);
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &smooth, &material), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_view_create(t->gi, &view, &m->view), ==, (int)SDFGI_OK);
    /* A depth of 0 is a metre before the mirror, one of 1 a metre behind it. */
    m->desc = (struct sdfgi_resolve_desc){
        .depth = m->depth.view,
        .normal = m->normal.view,
        .roughness = m->roughness.view,
        .background_depth = 1,
        .inverse_view_projection = { half_m, 0, 0, 0, 0, 0, half_m, 0, 2, -2, 0, 0, -1, 0, 0, 1 },
    };
    free(depth);
    free(normal);
}

void mirror_open(struct mirror *m, struct gi_test *t, uint32_t width, uint32_t height, float half_m)
{
    float *roughness = calloc(width * height, sizeof *roughness);
    REQUIRE_TRUE(roughness != NULL);
    mirror_open_rough(m, t, width, height, half_m, roughness);
    free(roughness);
}

void mirror_close(struct mirror *m)
{
    sdfgi_view_destroy(m->t->gi, m->view);
    gpu_test_image_destroy(&m->t->gpu, &m->depth);
    gpu_test_image_destroy(&m->t->gpu, &m->normal);
    gpu_test_image_destroy(&m->t->gpu, &m->roughness);
}

void mirror_read(struct mirror *m, uint16_t (*texels)[4])
{
    gi_test_resolve(m->t, m->view, &m->desc);
    gpu_test_image_read(&m->t->gpu, m->view->reflection.handle, VK_IMAGE_LAYOUT_GENERAL,
                        VK_IMAGE_ASPECT_COLOR_BIT, (VkExtent3D){ m->width, m->height, 1 }, 8, texels);
}
