/* SPDX-License-Identifier: MIT
 * Small pictures for sdfgi_gather, drawn by rays through the pixels of a pinhole camera. */
#ifndef TEST_GATHER_PICTURE_H
#define TEST_GATHER_PICTURE_H

#include "gi_test.h"

enum { PICTURE_MAX_OBJECTS = 16, PICTURE_NOTHING = -1 };

/* What is drawn. Objects are told apart by their index. */
struct picture_scene {
    struct test_mesh objects[PICTURE_MAX_OBJECTS];
    int count;
};

/* Draws a mesh, and takes it over. */
void picture_scene_show(struct picture_scene *scene, struct test_mesh mesh);
/* The same; adds it to the test's context as well. */
void picture_scene_add(struct picture_scene *scene, struct gi_test *t, struct test_mesh mesh, float albedo,
                       float emission);
void picture_scene_finish(struct picture_scene *scene);

/* Rays begin on the near plane: what lies before it is not seen. */
struct picture_camera {
    double position[3], right[3], up[3], forward[3]; /* unit */
    double tan_x, tan_y, near_m;
};

struct picture {
    uint32_t width, height;
    float *depth; /* reversed: near over distance along the axis; 0: background */
    float (*normals)[4];
    int *objects;
    struct sdfgi_gather_desc desc; /* without images */
};

struct picture picture_draw(const struct picture_scene *scene, const struct picture_camera *camera,
                            uint32_t width, uint32_t height);
void picture_finish(struct picture *picture);

/* Irradiance of the picture, 3 floats a pixel; the caller frees it. */
float (*picture_gather(struct gi_test *t, const struct picture *picture,
                       enum sdfgi_gather_resolution resolution))[3];
/* What a picture's surfaces reflect, by the roughness of each pixel: four half floats a pixel. */
void picture_reflect(struct gi_test *t, const struct picture *picture, const float *roughness,
                     uint16_t (*texels)[4]);

#endif
