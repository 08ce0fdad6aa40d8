/* SPDX-License-Identifier: MIT
 * Views: what belongs to one picture. A view holds the pictures that it resolves, and the descriptor sets of
 * its passes, one for each frame in flight. Gathers into pictures of the host's use views without pictures.
 */
#ifndef SDFGI_VIEW_VIEW_H
#define SDFGI_VIEW_VIEW_H

#include "core/problem.h"
#include "pass/pass_record.h"
#include "pass/resources.h"

struct sdfgi_view;

/* Those of gathers are made when a frame asks for more pictures than any frame before. */
struct views {
    struct sdfgi_view *of_gathers;
    uint32_t used; /* of these, in this frame */
    struct sdfgi_view *of_host;
};

struct sdfgi_view {
    struct gpu_retired retired;
    struct sdfgi_view_desc desc;
    VkDescriptorPool pool;
    VkDescriptorSet sets[SDFGI_MAX_FRAMES_IN_FLIGHT];
    struct gpu_image diffuse;
    struct gpu_image reflection, filtered; /* these, and the tiles, once a resolve has asked for them */
    struct gpu_buffer tiles;
    bool reflects;         /* the last resolve made reflections */
    struct views resolves; /* these have the sets: a picture may be resolved again without an update */
    uint64_t frame;        /* of the last resolve */
    struct sdfgi_view *next;
};

void sdfgi_views_finish(struct backend *backend, struct views *views);
/* The next view for a gather in this frame, or NULL and a reason. */
struct sdfgi_view *sdfgi_views_next(struct backend *backend, struct views *views, VkResult *result);

/* A view with a picture of diffuse light if the description has a size, else one with sets. */
struct sdfgi_view *sdfgi_view_make(struct backend *backend, const struct sdfgi_view_desc *desc,
                                   VkResult *result);
/* Adds what reflections need, unless it is there. */
VkResult sdfgi_view_add_reflection(struct backend *backend, struct sdfgi_view *view);
/* True if one of the host's views has what reflections need. */
bool sdfgi_views_reflect(const struct views *views);
/* Destroys a view of the host's once no frame in flight can use it. */
void sdfgi_views_retire(struct backend *backend, struct views *views, struct sdfgi_view *view);

/* Pictures that the passes of a view read and write, as the host names them. */
struct view_pictures {
    VkImageView depth, normal, roughness; /* roughness: VK_NULL_HANDLE for none */
    VkImageLayout input_layout;
    VkImageView diffuse;
};

/* Writes these pictures, and those of the view, into the set of this frame that `holder` has. */
void sdfgi_view_write_set(const struct backend *backend, const struct sdfgi_view *holder,
                          const struct sdfgi_view *view, const struct view_pictures *pictures);
/* What holds the set of the next resolve of a view, or NULL and a reason. */
struct sdfgi_view *sdfgi_view_next_resolve(struct backend *backend, struct sdfgi_view *view,
                                           VkResult *result);

#endif
