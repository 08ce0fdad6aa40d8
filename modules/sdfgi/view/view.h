/* SPDX-License-Identifier: MIT
 * Views: what belongs to one picture. A view holds the descriptor sets of its gather, one for each frame in
 * flight. */
#ifndef SDFGI_VIEW_H
#define SDFGI_VIEW_H

#include "core/problem.h"
#include "pass/pass_record.h"

struct view {
    VkDescriptorPool pool;
    VkDescriptorSet sets[SDFGI_MAX_FRAMES_IN_FLIGHT];
    struct view *next;
};

/* Views are made when a frame asks for more pictures than any frame before. */
struct views {
    struct view *first;
    uint32_t used; /* in this frame */
};

void sdfgi_views_finish(struct backend *backend, struct views *views);
/* The next view of this frame, or NULL and a reason. */
struct view *sdfgi_views_next(struct backend *backend, struct views *views, VkResult *result);

/* What is wrong with the description. */
struct problem sdfgi_view_gather_problem(const struct sdfgi_gather_desc *desc);
/* Writes the pictures of a gather into the view's set of this frame. */
void sdfgi_view_write_set(const struct backend *backend, const struct view *view,
                          const struct sdfgi_gather_desc *desc);
/* The gather as an item of work. */
struct work sdfgi_view_gather_work(const struct sdfgi_gather_desc *desc);

#endif
