/* SPDX-License-Identifier: MIT
 * Views of pictures that the host has drawn. */
#include "api_world.h"

#include "require.h"

static struct sdfgi_view_desc random_view(struct api_world *w)
{
    return (struct sdfgi_view_desc){ .width = API_PICTURE,
                                     .height = API_PICTURE,
                                     .diffuse = (enum sdfgi_gather_resolution)api_below(w, 3),
                                     .reflection = (enum sdfgi_gather_resolution)api_below(w, 3),
                                     .reflections = api_below(w, 4) == 0 };
}

static struct sdfgi_resolve_desc resolve_desc(struct api_world *w)
{
    return (struct sdfgi_resolve_desc){
        .depth = w->device->depth.view,
        .normal = w->device->normal.view,
        .roughness = api_below(w, 4) == 0 ? VK_NULL_HANDLE : w->device->roughness.view,
        .inverse_view_projection = { 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1 },
        .background_depth = 1,
    };
}

void api_change_view(struct api_world *w)
{
    sdfgi_view **const view = &w->views[api_below(w, API_VIEWS)];
    const struct sdfgi_view_desc desc = random_view(w);
    sdfgi_view *const old = *view;
    *view = NULL;
    sdfgi_view_destroy(w->t->gi, old);
    if (!old)
        REQUIRE_CMP((int)sdfgi_view_create(w->t->gi, &desc, view), ==, (int)SDFGI_OK);
}

void api_record_views(struct api_world *w, VkCommandBuffer cmd)
{
    for (int i = 0; i < API_VIEWS; i++) {
        const struct sdfgi_resolve_desc desc = resolve_desc(w);
        if (w->views[i] && api_below(w, 2))
            REQUIRE_CMP((int)sdfgi_view_resolve(w->t->gi, w->views[i], cmd, &desc), ==, (int)SDFGI_OK);
    }
}

void api_views_close(struct api_world *w)
{
    for (int i = 0; i < API_VIEWS; i++) {
        sdfgi_view_destroy(w->t->gi, w->views[i]);
        w->views[i] = NULL;
    }
}

enum sdfgi_result api_wrong_view(struct api_world *w)
{
    struct sdfgi_view_desc desc = random_view(w);
    sdfgi_view *view = (sdfgi_view *)w;
    switch (api_below(w, 4)) {
    case 0:
        desc.width = 0;
        break;
    case 1:
        desc.height = UINT32_MAX;
        break;
    case 2:
        desc.diffuse = (enum sdfgi_gather_resolution)3;
        break;
    default:
        desc.reflection = (enum sdfgi_gather_resolution)7;
    }
    const enum sdfgi_result result = sdfgi_view_create(w->t->gi, &desc, &view);
    REQUIRE_TRUE(view == (sdfgi_view *)w);
    return result;
}
