/* SPDX-License-Identifier: MIT
 * Small scenes with a known answer or a known difficulty: what builders share. */
#ifndef SAMPLES_REFERENCE_SCENES_H
#define SAMPLES_REFERENCE_SCENES_H

#include "glb_writer.h"
#include "mesh_builder.h"
#include "view_file.h"

struct surface {
    vec3s albedo;
    vec3s emission;  /* radiance */
    float roughness; /* 0: 1, a matt surface; use a small number for a mirror */
    float metallic;
};

static inline struct surface matt(float r, float g, float b)
{
    return (struct surface){ .albedo = v3(r, g, b) };
}

/* Shapes go into `mesh`; scene_flush turns what is there into a node with a material of its own. */
struct scene {
    struct glb_writer *writer;
    struct mesh mesh;
    struct view view;
};

void scene_flush(struct scene *scene, const char *name, const struct surface *surface);

/* A closed shell: an inner room and, `thickness` further out, the outside. Both sides are modelled. */
void scene_shell(struct scene *scene, vec3s low, vec3s high, float thickness, const struct surface *surface);

/* A box of one material. */
void scene_box(struct scene *scene, const char *name, vec3s low, vec3s high, const struct surface *surface);

/* A floor with its top at y = 0, of square tiles of 1 m around the origin. */
void scene_tiles(struct scene *scene, int across, int along, const struct surface *light,
                 const struct surface *dark);
void scene_look(struct scene *scene, vec3s position, vec3s look_at, float yfov_deg);
void scene_sky(struct scene *scene, float radiance);
void scene_sun(struct scene *scene, vec3s direction, float irradiance);
void scene_point_light(struct scene *scene, vec3s position, vec3s color, float intensity);

/* Builders: `a` and `b` are the numbers of the scene's row. */
void furnace_build(struct scene *scene, float albedo, float unused);
void sun_plane_build(struct scene *scene, float albedo, float unused);
void sky_plane_build(struct scene *scene, float albedo, float unused);
void right_angle_build(struct scene *scene, float albedo, float unused);
void point_light_build(struct scene *scene, float albedo, float unused);
void cornell_build(struct scene *scene, float unused_a, float unused_b);
void emitter_build(struct scene *scene, float side_m, float unused);
void color_bleed_build(struct scene *scene, float unused_a, float unused_b);
void glossy_spheres_build(struct scene *scene, float unused_a, float unused_b);

void two_rooms_build(struct scene *scene, float wall_m, float angle_deg);
void two_rooms_lit_build(struct scene *scene, float wall_m, float angle_deg);
void two_rooms_door_build(struct scene *scene, float wall_m, float angle_deg);
void sealed_room_build(struct scene *scene, float wall_m, float unused);
void corridor_build(struct scene *scene, float unused_a, float unused_b);
void corridor_turn_build(struct scene *scene, float unused_a, float unused_b);
void maze_build(struct scene *scene, float wall_m, float unused);
void courtyard_build(struct scene *scene, float unused_a, float unused_b);
void pillars_build(struct scene *scene, float unused_a, float unused_b);
void many_lights_build(struct scene *scene, float count, float unused);

void white_metal_furnace_build(struct scene *scene, float unused_a, float unused_b);
void metal_sphere_build(struct scene *scene, float roughness, float unused);
void mirror_room_build(struct scene *scene, float unused_a, float unused_b);
void brushed_corridor_build(struct scene *scene, float unused_a, float unused_b);
void wet_street_night_build(struct scene *scene, float unused_a, float unused_b);
void chrome_lamp_build(struct scene *scene, float unused_a, float unused_b);

#endif
