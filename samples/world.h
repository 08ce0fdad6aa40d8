/* SPDX-License-Identifier: MIT
 * The parts of the sample world: every file of it adds one kind of thing to the same glb scene.
 *
 * The valley runs along x. The village lies around the origin, its street along z = 0; a stream flows at
 * about z = -58; a spur of the hills crosses the street at x = 125, where a tunnel leads through. */
#ifndef SAMPLES_WORLD_H
#define SAMPLES_WORLD_H

#include "glb_writer.h"
#include "mesh_builder.h"
#include "random.h"

enum world_material {
    MATERIAL_GROUND,
    MATERIAL_WATER,
    MATERIAL_PLASTER,
    MATERIAL_STONE,
    MATERIAL_ROOF,
    MATERIAL_WOOD,
    MATERIAL_COBBLES, /* wet */
    MATERIAL_COPPER,
    MATERIAL_IRON,
    MATERIAL_BARK,
    MATERIAL_LEAVES,
    MATERIAL_NEEDLES,
    MATERIAL_GRASS,
    MATERIAL_FABRIC,
    MATERIAL_PAINT,
    MATERIAL_GLOW,
    MATERIAL_COUNT,
};

struct world {
    struct glb_writer *writer;
    uint32_t seed;
    glb_handle materials[MATERIAL_COUNT];
    uint32_t triangle_count; /* drawn: shared meshes count once per node */
};

/* One thing made of several materials: a mesh for each, sharing a transform. */
struct object {
    struct mesh parts[MATERIAL_COUNT];
    mat4s transform;
};

void world_materials_make(struct world *world);

void object_begin(struct object *object, mat4s transform);
/* The part made of `material`, ready to take shapes of this colour. */
struct mesh *object_part(struct object *object, enum world_material material, vec3s color);
void object_box(struct object *object, enum world_material material, vec3s color, vec3s low, vec3s high);
/* Adds the object to the file as one mesh and frees it; returns 0 if it is empty. */
glb_handle object_finish(struct world *world, struct object *object, const char *name);
/* The same, and one node that shows it where it was built. */
void object_place(struct world *world, struct object *object, const char *name);

/* A point light of `intensity` W/sr and a glowing body of about `radius_m` just above it, which does not
 * shade it. */
void world_lamp_add(struct world *world, struct object *object, vec3s position, vec3s color, float intensity,
                    float radius_m);

/* ---- Ground ----------------------------------------------------------------------------------------- */

enum { TUNNEL_START_M = 97, TUNNEL_END_M = 153 };

float world_height(uint32_t seed, float x, float z);
float world_path_z(float x);
float world_stream_z(float x);
void world_terrain_add(struct world *world);

/* Centre line of the tunnel's floor at `t` in [0, 1]. */
vec3s world_tunnel_point(float t);
void world_tunnel_add(struct world *world);

/* ---- Village ---------------------------------------------------------------------------------------- */

enum { HOUSE_COUNT = 12 };

/* Houses with a part to play in the views. */
enum house_role { HOUSE_PLAIN, HOUSE_SUNLIT, HOUSE_LAMPLIT, HOUSE_COLORED };

struct house {
    vec3s position;                   /* of the middle, on the ground */
    float yaw_rad;                    /* the front looks along +Z before it */
    float width, depth, height, wall; /* metres, outside; thickness of the walls */
    vec3s outside, inside, accent, roof;
    enum house_role role;
    uint32_t seed;
};

enum { HOUSE_FLOOR_MM = 160 };

void world_houses_layout(uint32_t seed, struct house houses[HOUSE_COUNT]);
void world_house_add(struct world *world, const struct house *house, uint32_t index);
void house_furnish(struct world *world, struct object *object, const struct house *house);
/* From coordinates of the house to the world's. */
vec3s house_point(const struct house *house, vec3s local);

/* Walls: a slab in the plane z = 0 of `frame`, its outside towards +z, `thickness` deep, x in [0, length]. */
struct opening {
    float x0, x1, y0, y1;
};

struct wall {
    mat4s frame;
    float length, bottom, top, thickness;
    const struct opening *openings;
    uint32_t opening_count;
    enum world_material material;
    vec3s outside, inside;
};

void wall_add(struct object *object, const struct wall *wall);

/* Well, tower, fountain stone, lanterns, fences. */
void world_props_add(struct world *world);
void world_plants_add(struct world *world, const struct house houses[HOUSE_COUNT]);

/* ---- Views ------------------------------------------------------------------------------------------ */

/* Writes the VIEW.json files and walk.json into `folder`; false with one line in `error` on failure. */
bool world_views_save(const struct world *world, const struct house houses[HOUSE_COUNT], const char *folder,
                      char *error, size_t error_size);

#endif
