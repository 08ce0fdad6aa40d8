/* SPDX-License-Identifier: MIT
 * What a host does to look light up: gi_lookup.comp, a host's shader, over a list of points, and images for
 * sdfgi_gather. */
#include "gi_test.h"

#include "gpu_test_compute.h"
#include "require.h"
#include "test_memory.h"

#include "gi_lookup.comp.h"
#include "gi_lookup_software.comp.h"

#include <stdlib.h>

enum { FLOATS_PER_POINT = 12 };

void gi_test_lookup(struct gi_test *t, VkDescriptorSet set, const float *viewer,
                    const struct gi_test_point *points, uint32_t count, float (*irradiance)[3])
{
    float(*rows)[FLOATS_PER_POINT] = test_array_alloc(count, sizeof *rows);
    for (uint32_t i = 0; i < count; i++) {
        memset(rows[i], 0, sizeof rows[i]);
        memcpy(&rows[i][0], points[i].position, sizeof points[i].position);
        memcpy(&rows[i][4], points[i].normal, sizeof points[i].normal);
        for (int k = 0; k < 3; k++)
            rows[i][3 + 4 * k] = viewer ? viewer[k] - points[i].position[k] : 0.1f * points[i].normal[k];
        /* What a shader that does not write would leave behind must not look like light. */
        rows[i][8] = rows[i][9] = rows[i][10] = NAN;
    }
    const struct gpu_test_shader shader = GI_TEST_SHADER(t->gi, set, gi_lookup);
    gpu_test_compute(&t->gpu, &shader, count, rows, count * sizeof *rows);
    for (uint32_t i = 0; i < count; i++)
        memcpy(irradiance[i], &rows[i][8], sizeof irradiance[i]);
    free(rows);
}

void gi_test_irradiance_from(struct gi_test *t, const float *viewer, const struct gi_test_point *points,
                             uint32_t count, float (*irradiance)[3])
{
    REQUIRE_TRUE(sdfgi_is_active(t->gi));
    gi_test_lookup(t, sdfgi_get_descriptor_set(t->gi), viewer, points, count, irradiance);
}

void gi_test_irradiance(struct gi_test *t, const struct gi_test_point *points, uint32_t count,
                        float (*irradiance)[3])
{
    gi_test_irradiance_from(t, NULL, points, count, irradiance);
}

struct gather {
    sdfgi *gi;
    const struct sdfgi_gather_desc *desc;
};

static void gather_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct gather *g = user;
    REQUIRE_CMP((int)sdfgi_gather(g->gi, cmd, g->desc), ==, (int)SDFGI_OK);
}

void gi_test_gather(struct gi_test *t, const struct sdfgi_gather_desc *desc)
{
    struct gather g = { t->gi, desc };
    gpu_test_submit(&t->gpu, gather_record, &g);
}

struct resolve {
    sdfgi *gi;
    sdfgi_view *view;
    const struct sdfgi_resolve_desc *desc;
};

static void resolve_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct resolve *r = user;
    REQUIRE_CMP((int)sdfgi_view_resolve(r->gi, r->view, cmd, r->desc), ==, (int)SDFGI_OK);
}

void gi_test_resolve(struct gi_test *t, sdfgi_view *view, const struct sdfgi_resolve_desc *desc)
{
    struct resolve r = { t->gi, view, desc };
    gpu_test_submit(&t->gpu, resolve_record, &r);
}

struct gpu_test_image gi_test_gather_image(struct gi_test *t, VkFormat format, uint32_t texel_size,
                                           uint32_t width, uint32_t height, const void *texels)
{
    const bool output = format == VK_FORMAT_R16G16B16A16_SFLOAT;
    const struct gpu_test_image_desc desc = {
        .format = format,
        .extent = { width, height, 1 },
        .usage = output ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT,
        .layout = output ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .texels = texels,
        .texel_size = texel_size,
    };
    return gpu_test_image_create(&t->gpu, &desc);
}
