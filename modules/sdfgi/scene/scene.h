/* SPDX-License-Identifier: MIT
 * What the host registered: meshes, materials, instances, lights, sky; and a journal of what changed. The
 * scene knows no cascades: each volume reads a journal of its own. */
#ifndef SDFGI_SCENE_H
#define SDFGI_SCENE_H

#include "core/pool.h"
#include "flicker.h"
#include "harmonics.h"
#include "instance_tree.h"
#include "journal.h"
#include "mesh_streams.h"
#include "pass/backend.h"

/* A descriptor set of an object, NULL if it has none. Lies in memory of its own, because frames in flight may
 * use it longer than the object lives. */
struct object_set {
    struct gpu_retired retired;
    VkDescriptorSet set;
    struct set_pool *pool;
};

struct mesh {
    struct sdfgi_mesh_desc desc; /* without defaults: see `streams` */
    struct mesh_stream streams[MESH_STREAMS];
    struct object_set *set;
    uint32_t first; /* of its instances: a slot + 1, or 0 */
};

struct material {
    struct sdfgi_material_desc desc;
    struct object_set *set; /* NULL: no textures */
    uint32_t users;         /* instances */
};

/* Neighbours in a list of instances: slots + 1, or 0. */
struct neighbours {
    uint32_t before, after;
};

struct instance {
    struct box bounds; /* world. What searches read comes first: this, and the mesh and material of `desc` */
    struct sdfgi_instance_desc desc;
    uint64_t revision;             /* of the scene, when it was made or moved last */
    struct neighbours of_mesh;     /* all instances of its mesh */
    struct neighbours by_revision; /* all that are in the volumes, newest first */
    bool is_named;                 /* by the list of handles that is being checked */
};

struct light {
    struct sdfgi_light_desc desc;
    struct lamp_habit habit;
};

struct set_pool {
    VkDescriptorPool handle;
    uint32_t free;
    struct set_pool *next;
};

enum { ADDRESS_MODES = 3 }; /* REPEAT, MIRRORED_REPEAT, CLAMP_TO_EDGE: the first ones of Vulkan */

struct scene {
    struct backend *backend;
    enum sdfgi_up_axis up_axis;
    bool left_handed;
    struct pool meshes, materials, instances, lights;
    uint32_t instance_room; /* capacity of the pool of instances, for sdfgi_prepare: behind backend->lock */
    struct set_pool *set_pools;
    VkSampler samplers[ADDRESS_MODES][ADDRESS_MODES]; /* by mode of u, v; null until a texture needs it */
    struct sdfgi_sky sky;
    struct sdfgi_sky_harmonics harmonics; /* beside it */
    uint32_t emissive;                    /* materials that emit */
    uint32_t metals;                      /* materials that reflect what they see */
    float smoothest;                      /* smoothness of the smoothest material; 0: none */
    float most_emission;                  /* of any instance's material so far */
    float emission_unit;                  /* power of two, in which emission is stored: W/(m^2 sr) */
    struct journal *journals;
    struct instance_tree tree; /* of the instances that are in the volumes */
    uint64_t revision;         /* changes of these so far */
    uint32_t newest;           /* of them: a slot + 1, or 0 */
};

void sdfgi_scene_init(struct scene *scene, struct backend *backend);
void sdfgi_scene_finish(struct scene *scene);

/* Has the scene write what changes into a journal too, which must outlive the scene. */
void sdfgi_scene_add_journal(struct scene *scene, struct journal *journal);

/* The functions of sdfgi.h by the same names: they check what they are given. */
enum sdfgi_result sdfgi_scene_material_create(struct scene *scene, const struct sdfgi_material_desc *desc,
                                              sdfgi_material *out);
enum sdfgi_result sdfgi_scene_material_update(struct scene *scene, sdfgi_material material,
                                              const struct sdfgi_material_desc *desc);
enum sdfgi_result sdfgi_scene_material_destroy(struct scene *scene, sdfgi_material material);
enum sdfgi_result sdfgi_scene_mesh_create(struct scene *scene, const struct sdfgi_mesh_desc *desc,
                                          sdfgi_mesh *out);
enum sdfgi_result sdfgi_scene_mesh_destroy(struct scene *scene, sdfgi_mesh mesh);
enum sdfgi_result sdfgi_scene_instance_create(struct scene *scene, const struct sdfgi_instance_desc *desc,
                                              sdfgi_instance *out);
enum sdfgi_result sdfgi_scene_instances_create(struct scene *scene, uint32_t count,
                                               const struct sdfgi_instance_desc *descs, sdfgi_instance *out);
enum sdfgi_result sdfgi_scene_instances_destroy(struct scene *scene, uint32_t count,
                                                const sdfgi_instance *instances);
enum sdfgi_result sdfgi_scene_instance_set_transform(struct scene *scene, sdfgi_instance instance,
                                                     const struct sdfgi_transform *transform);
enum sdfgi_result sdfgi_scene_instance_destroy(struct scene *scene, sdfgi_instance instance);
enum sdfgi_result sdfgi_scene_light_create(struct scene *scene, const struct sdfgi_light_desc *desc,
                                           sdfgi_light *out);
enum sdfgi_result sdfgi_scene_light_update(struct scene *scene, sdfgi_light light,
                                           const struct sdfgi_light_desc *desc);
enum sdfgi_result sdfgi_scene_light_destroy(struct scene *scene, sdfgi_light light);
enum sdfgi_result sdfgi_scene_set_sky(struct scene *scene, const struct sdfgi_sky *sky);
enum sdfgi_result sdfgi_scene_set_harmonics(struct scene *scene, const struct sdfgi_sky_harmonics *harmonics);
enum sdfgi_result sdfgi_scene_invalidate_box(struct scene *scene, const double box_min[static 3],
                                             const double box_max[static 3]);

/* All instances of a material leave the volumes, to enter them again once the material is another one. */
void sdfgi_scene_instances_leave(struct scene *scene, sdfgi_material material);
void sdfgi_scene_instances_enter(struct scene *scene, sdfgi_material material);
/* True if an instance that is in the volumes may touch the box. */
bool sdfgi_scene_touches(const struct scene *scene, const struct box *box);
/* True if a material emits light. */
bool sdfgi_scene_emits(const struct sdfgi_material_desc *desc);
/* A material has its first instance, or is another one and has some. One that nothing shows costs nothing,
 * however bright it is. Sums of emission hold SDFGI_EMISSION_MOST units and fractions of one 10^15 times
 * smaller. Only a material that is brighter makes the unit larger, and no other makes it smaller again: all
 * of the scene is voxelised anew for that. */
void sdfgi_scene_material_shown(struct scene *scene, const struct sdfgi_material_desc *desc);
/* The kind of metal from which rays go on towards what it reflects: 1 for mirrors, to 3; 0 for all else. */
uint32_t sdfgi_scene_metal_kind(const struct sdfgi_material_desc *desc);
/* The brightest that surfaces may get from all there is, about: radiance, or irradiance over pi. */
float sdfgi_scene_brightest(const struct scene *scene, bool reads_sky);
/* True if anything in the scene gives light. */
bool sdfgi_scene_has_light(const struct scene *scene, bool reads_sky);

#endif
