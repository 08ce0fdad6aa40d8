/* SPDX-License-Identifier: MIT
 * Boxes in fog, drawn by the host renderer, so that pictures can be compared with formulas. Failures end the
 * test. */
#ifndef TEST_FOG_SCENE_H
#define TEST_FOG_SCENE_H

#include "host.h"

/* Whole tiles of froxels along both sides. */
enum { FOG_WIDTH = 96, FOG_HEIGHT = 72, FOG_PIXELS = FOG_WIDTH * FOG_HEIGHT };

struct fog_box {
    double center[3], size[3];
    float color[4]; /* albedo and alpha; less than 1: blended */
    float emission;
    bool metal;       /* unless materials are Lambertian */
    float smoothness; /* 1 - roughness, likewise */
};

struct fog_scene {
    struct host_view view;
    const struct fog_box *boxes;
    uint32_t box_count;
    bool gi;
    float eye_distance_m; /* above 0: two eyes, in a picture that is twice as wide */
    uint32_t supersample; /* of a side of a pixel; 0: 1 */
    uint32_t frames;      /* to draw at first; 0: until light has settled, or nearly so */
    bool forward;         /* light is looked up where surfaces are shaded, not for the whole picture */
};

struct fog_stage {
    struct host_scene *scene;
    struct host_renderer *renderer;
    struct host_camera camera;
};

/* A camera in the origin that looks along -z, materials that are Lambertian, and fog of albedo 1 and nothing
 * else. */
struct fog_scene fog_scene_empty(float density);

/* Draws the scene's first frames. */
void fog_stage_open(struct fog_stage *stage, struct host_device *device, const struct fog_scene *scene);
void fog_stage_close(struct fog_stage *stage);
/* Radiance, four floats a pixel. */
void fog_stage_read(struct fog_stage *stage, float rgba[4 * FOG_PIXELS]);
/* The same for those who need nothing else. */
void fog_scene_draw(struct host_device *device, const struct fog_scene *scene, float rgba[4 * FOG_PIXELS]);

/* From a camera that looks from the origin at (0, y, -1) through the middle of a pixel, 1 m along its axis.
 */
void fog_ray(const struct host_view *view, int x, int y, double ray[3]);

#endif
