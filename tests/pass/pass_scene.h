/* SPDX-License-Identifier: MIT
 * Scenes of one mesh, and what the passes made of them. */
#ifndef TEST_PASS_SCENE_H
#define TEST_PASS_SCENE_H

#include "gi_test.h"
#include "oracle_voxel.h"

/* What the tests of a program share, and a teardown of their group. */
extern struct gi_test pass_context;
int pass_context_close(void **state);

/* Renews a context with `mesh` (NULL: nothing) in grey and updates once. */
void pass_scene_open(struct gi_test *t, const struct sdfgi_settings *settings, const struct test_mesh *mesh);

/* A mesh in object space, placed by a column-major basis and a translation in metres. */
sdfgi_instance pass_scene_place(struct gi_test *t, sdfgi_mesh mesh, const float basis[static 9],
                                const double translation[static 3]);

/* Moves the camera and all that follows to `position`. */
void pass_scene_stand(struct gi_test *t, const double position[static 3]);

/* What was generated of cascade 0, as stored. */
struct pass_volumes {
    uint8_t *bits, *albedo, *normals, *distance;
    uint64_t bits_size, albedo_size, normals_size, distance_size;
};

struct pass_volumes pass_volumes_read(struct gi_test *t);
void pass_volumes_destroy(struct pass_volumes *volumes);
/* Number of bytes in which they differ; says where. */
uint64_t pass_volumes_differ(const struct pass_volumes *a, const struct pass_volumes *b);
void pass_volumes_require_equal(const struct pass_volumes *a, const struct pass_volumes *b);

/* Stored distances against the exact ones of the same bits, in cells; positive: too far. */
struct pass_distance_error {
    double max, mean, min;
};

struct pass_distance_error pass_distance_error(struct gi_test *t, double y_scale);

/* Records a list of work and runs it, beside the frames of the context. */
void pass_scene_run(struct gi_test *t, const struct work_list *list);

/* The first `size` bytes of a buffer. */
void pass_scene_write(struct gi_test *t, enum resource resource, const void *data, uint64_t size);
/* All bytes of a buffer. */
void pass_scene_fill(struct gi_test *t, enum resource resource, uint8_t value);
/* As if every cell had something near: rays go from cell to cell. */
void pass_scene_forget_empty_space(struct gi_test *t);

/* Number that the report gives for a health code; 0 if it is not in there. */
uint64_t pass_health_count(const struct gi_test *t, enum sdfgi_message code);

/* True if the test device can run the raster voxeliser. */
bool pass_raster_is_available(void);

#endif
