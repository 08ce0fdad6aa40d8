/* SPDX-License-Identifier: MIT
 * What stands along the way of journeys, besides scroll_world. */
#ifndef TEST_JOURNEY_THINGS_H
#define TEST_JOURNEY_THINGS_H

#include "journey.h"

/* A picture with holes on an upright wall whose vertices have colours and texture coordinates. */
struct journey_poster {
    struct gpu_test_image picture;
    struct gpu_test_buffer positions, uvs, colors;
};

void journey_poster_add(struct journey_poster *poster, struct gi_test *t);
/* To be called once the context is gone, or with its device idle. */
void journey_poster_destroy(struct journey_poster *poster, struct gi_test *t);

/* Level planes, half a metre apart: with cells of 0.25 m every second cell is one that light falls on. */
sdfgi_instance journey_add_shelves(struct gi_test *t, const double center[static 3], sdfgi_material material);

/* A box of half a metre around its own origin, and where to put it. */
sdfgi_mesh journey_box_mesh(struct gi_test *t);
struct sdfgi_transform journey_at(double x, double y, double z, float size);
sdfgi_instance journey_add(struct gi_test *t, sdfgi_mesh mesh, sdfgi_material material,
                           const struct sdfgi_transform *transform, enum sdfgi_mobility mobility);

#endif
