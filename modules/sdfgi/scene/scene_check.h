/* SPDX-License-Identifier: MIT
 * Checks of what hosts pass. */
#ifndef SDFGI_SCENE_CHECK_H
#define SDFGI_SCENE_CHECK_H

#include "core/problem.h"
#include "scene.h"

enum { MAX_OBJECTS = (1 << 20) - 2 }; /* of one kind: what a handle can number */

struct problem sdfgi_check_material(const struct sdfgi_material_desc *desc);
struct problem sdfgi_check_mesh(const struct sdfgi_mesh_desc *desc, const struct gpu_device *device);
struct problem sdfgi_check_transform(const struct sdfgi_transform *transform);
struct problem sdfgi_check_light(const struct sdfgi_light_desc *desc);
struct problem sdfgi_check_sky(const struct sdfgi_sky *sky);
struct problem sdfgi_check_harmonics(const struct sdfgi_sky_harmonics *harmonics);
struct problem sdfgi_check_box(const double box_min[static 3], const double box_max[static 3]);

/* Report that a pool is full or memory short, or that a handle names nothing. */
enum sdfgi_result sdfgi_check_out_of_slots(const struct scene *scene, const char *what, uint32_t limit);
enum sdfgi_result sdfgi_check_unknown_handle(const struct scene *scene, const char *what, uint32_t id);

#endif
