/* SPDX-License-Identifier: MIT
 * A small scene and a picture of it that tests of views resolve. */
#ifndef SDFGI_TESTS_VIEW_STAGE_H
#define SDFGI_TESTS_VIEW_STAGE_H

#include "gi_test.h"

enum {
    VIEW_STAGE_SIDE = 24,
    VIEW_STAGE_PIXELS = VIEW_STAGE_SIDE * VIEW_STAGE_SIDE,
    VIEW_STAGE_SURFACES = 20 * VIEW_STAGE_SIDE
};

/* Radiance of the sky above. */
extern const float view_stage_zenith[3];

/* A level floor beside a wall, seen from straight above: clip x, y in [-1, 1] are metres over 3, depth 0 to 1
 * is y from -1.9 to -2.1. Part of the wall glows. Four columns show it, as background. */
struct view_stage {
    struct gi_test t;
    sdfgi_material smooth; /* of nothing that is there: it calls for reflections */
    struct gpu_test_image depth, normal;
    float depths[VIEW_STAGE_PIXELS], normals[VIEW_STAGE_PIXELS][4];
    /* Of the next picture that is opened; view_stage_open sets them to 0 again. */
    int ridge;  /* this column leans towards +x; 0: none does */
    float lean; /* of all other normals: tangent of the angle */
    int dots;   /* of each square of 2 x 2 pixels so many lean, from the second on */
    /* Normals change from pixel to pixel along x, or along both axes. */
    enum { VIEW_STAGE_EVEN, VIEW_STAGE_GROOVES, VIEW_STAGE_COBBLES } detail;
};

/* `smoothness`: of a material that is registered, though nothing is of it. */
void view_stage_open(struct view_stage *s, float smoothness);
void view_stage_close(struct view_stage *s);

sdfgi_view *view_stage_view_of(struct view_stage *s, enum sdfgi_gather_resolution diffuse,
                               enum sdfgi_gather_resolution reflection);
sdfgi_view *view_stage_view_at(struct view_stage *s, enum sdfgi_gather_resolution reflection);
sdfgi_view *view_stage_view(struct view_stage *s);

/* A picture of this roughness; VK_NULL_HANDLE: none is given. */
struct sdfgi_resolve_desc view_stage_desc(const struct view_stage *s, VkImageView roughness);
/* Resolves a picture whose columns have one roughness up to VIEW_STAGE_SIDE / 2, and another one from there
 * on; below 0: none is given. */
void view_stage_resolve_halves(struct view_stage *s, sdfgi_view *view, float left, float right);
void view_stage_resolve(struct view_stage *s, sdfgi_view *view, float roughness);
void view_stage_read(struct view_stage *s, const struct gpu_image *image, float (*out)[4]);
double view_stage_luminance(float (*pixels)[4]); /* in the mean */

/* Of the last report. */
uint32_t view_stage_dispatches(struct view_stage *s, enum pass pass);
uint64_t view_stage_bytes(struct view_stage *s);

#endif
