/* SPDX-License-Identifier: MIT
 * Meshes, materials and what follows from them. Every value is checked here, at the edge; the
 * stages trust it. */
#include "scene.h"
#include "same.h"
#include "scene_check.h"
#include "scene_sets.h"

#include "shaders/shared/constants.h"

#include <math.h>
#include <string.h>

void sdfgi_scene_init(struct scene *scene, struct backend *backend)
{
    scene->backend = backend;
    scene->emission_unit = 1;
    sdfgi_pool_init(&scene->meshes, sizeof(struct mesh), MAX_OBJECTS);
    sdfgi_pool_init(&scene->materials, sizeof(struct material), SDFGI_MAX_MATERIALS);
    sdfgi_pool_init(&scene->instances, sizeof(struct instance), MAX_OBJECTS);
    sdfgi_pool_init(&scene->lights, sizeof(struct light), SDFGI_MAX_LIGHTS);
    sdfgi_tree_init(&scene->tree);
}

static void free_sets(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->meshes.end; i++) {
        const struct mesh *mesh = sdfgi_pool_at(&scene->meshes, i);
        if (mesh)
            sdfgi_hooks_free(&scene->backend->hooks, mesh->set);
    }
    for (uint32_t i = 0; i < scene->materials.end; i++) {
        const struct material *material = sdfgi_pool_at(&scene->materials, i);
        if (material)
            sdfgi_hooks_free(&scene->backend->hooks, material->set);
    }
}

void sdfgi_scene_finish(struct scene *scene)
{
    const struct hooks *hooks = &scene->backend->hooks;
    free_sets(scene);
    sdfgi_scene_sets_finish(scene);
    sdfgi_pool_finish(&scene->meshes, hooks);
    sdfgi_pool_finish(&scene->materials, hooks);
    sdfgi_pool_finish(&scene->instances, hooks);
    sdfgi_pool_finish(&scene->lights, hooks);
    sdfgi_tree_finish(&scene->tree, hooks);
}

void sdfgi_scene_add_journal(struct scene *scene, struct journal *journal)
{
    journal->next = scene->journals;
    scene->journals = journal;
}

bool sdfgi_scene_has_light(const struct scene *scene, bool reads_sky)
{
    static const struct sdfgi_sky none;
    const bool sky =
        reads_sky && (!sdfgi_same_sky(&scene->sky, &none) || sdfgi_harmonics_any(&scene->harmonics));
    return scene->lights.count > 0 || scene->emissive > 0 || sky;
}

static float brightest_channel(const float color[static 3])
{
    return fmaxf(color[0], fmaxf(color[1], color[2]));
}

/* Irradiance over pi. Of a lamp from a quarter of a metre: cells that are nearer are few. */
static float brightest_of_light(const struct sdfgi_light_desc *light)
{
    const float pi = 3.14159265f, near_m = 0.25f;
    const float intensity = brightest_channel(light->intensity) * light->indirect_energy / pi;
    return light->type == SDFGI_LIGHT_DIRECTIONAL ? intensity : intensity / (near_m * near_m);
}

float sdfgi_scene_brightest(const struct scene *scene, bool reads_sky)
{
    const struct sdfgi_sky *sky = &scene->sky;
    float everywhere = 0, lamp = scene->most_emission;
    if (reads_sky)
        everywhere = fmaxf(brightest_channel(sky->zenith),
                           fmaxf(brightest_channel(sky->horizon), brightest_channel(sky->ground))) +
                     sdfgi_harmonics_brightest(&scene->harmonics);
    for (uint32_t i = 0; i < scene->lights.end; i++) {
        const struct light *light = sdfgi_pool_at(&scene->lights, i);
        if (light && light->desc.type == SDFGI_LIGHT_DIRECTIONAL)
            everywhere += brightest_of_light(&light->desc);
        else if (light)
            lamp = fmaxf(lamp, brightest_of_light(&light->desc));
    }
    return everywhere + lamp;
}

/* ---- Materials */

bool sdfgi_scene_emits(const struct sdfgi_material_desc *desc)
{
    return desc->emission[0] > 0 || desc->emission[1] > 0 || desc->emission[2] > 0;
}

/* Least smoothness of each kind. Rougher metals count as diffuse: what they reflect comes from all around.
 * Hosts have roughness, and 1 less 0.6 is a little below 0.4. */
static const float METAL_SMOOTHNESS[3] = { 0.8f, 0.6f, 0.4f };
#define ROUNDING 1e-5f

uint32_t sdfgi_scene_metal_kind(const struct sdfgi_material_desc *desc)
{
    for (uint32_t kind = 0; kind < 3 && desc->metallic > 0.5f; kind++)
        if (desc->smoothness >= METAL_SMOOTHNESS[kind] - ROUNDING)
            return kind + 1;
    return 0;
}

static float smoothest(const struct scene *scene)
{
    float most = 0;
    for (uint32_t i = 0; i < scene->materials.end; i++) {
        const struct material *material = sdfgi_pool_at(&scene->materials, i);
        if (material)
            most = fmaxf(most, material->desc.smoothness);
    }
    return most;
}

void sdfgi_scene_material_shown(struct scene *scene, const struct sdfgi_material_desc *desc)
{
    const float brightest = brightest_channel(desc->emission);
    sdfgi_journal_note(scene->journals, JOURNAL_MATERIALS);
    scene->most_emission = fmaxf(scene->most_emission, brightest);
    if (brightest <= scene->emission_unit * SDFGI_EMISSION_MOST)
        return;
    while (brightest > scene->emission_unit * SDFGI_EMISSION_MOST)
        scene->emission_unit *= 65536;
    sdfgi_journal_note(scene->journals, JOURNAL_EVERYTHING);
}

/* What zero stands for is filled in. */
static struct sdfgi_material_desc resolved(const struct sdfgi_material_desc *desc)
{
    struct sdfgi_material_desc material = *desc;
    material.alpha = desc->alpha > 0 ? desc->alpha : 1;
    return material;
}

/* The scene has a material, */
static void count_in(struct scene *scene, const struct sdfgi_material_desc *desc)
{
    scene->emissive += sdfgi_scene_emits(desc);
    scene->metals += sdfgi_scene_metal_kind(desc) > 0;
    scene->smoothest = fmaxf(scene->smoothest, desc->smoothness);
}

/* or no longer has it. */
static void count_out(struct scene *scene, const struct sdfgi_material_desc *desc)
{
    scene->emissive -= sdfgi_scene_emits(desc);
    scene->metals -= sdfgi_scene_metal_kind(desc) > 0;
    if (desc->smoothness >= scene->smoothest)
        scene->smoothest = smoothest(scene);
}

enum sdfgi_result sdfgi_scene_material_create(struct scene *scene, const struct sdfgi_material_desc *desc,
                                              sdfgi_material *out)
{
    const struct problem problem = sdfgi_check_material(desc);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_material_create");
    uint32_t id;
    struct material *material = sdfgi_pool_add(&scene->materials, &scene->backend->hooks, &id);
    if (!material)
        return sdfgi_check_out_of_slots(scene, "sdfgi_material_create", SDFGI_MAX_MATERIALS);
    material->desc = resolved(desc);
    const VkResult result = sdfgi_scene_sets_material(scene, material);
    if (result != VK_SUCCESS) {
        sdfgi_pool_remove(&scene->materials, id);
        return sdfgi_message_vulkan(&scene->backend->hooks, result, "sdfgi_material_create");
    }
    count_in(scene, desc);
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_material_update(struct scene *scene, sdfgi_material handle,
                                              const struct sdfgi_material_desc *desc)
{
    static const char name[] = "sdfgi_material_update";
    struct material *material = sdfgi_pool_get(&scene->materials, handle.id);
    if (!material)
        return sdfgi_check_unknown_handle(scene, name, handle.id);
    const struct problem problem = sdfgi_check_material(desc);
    if (problem.text[0])
        return sdfgi_problem_report_of(&problem, &scene->backend->hooks, name, "material", handle.id);
    const struct material before = *material;
    struct material after = { .desc = resolved(desc), .users = before.users };
    if (sdfgi_same_material(&before.desc, &after.desc))
        return SDFGI_OK;
    const VkResult result = sdfgi_scene_sets_material(scene, &after);
    if (result != VK_SUCCESS)
        return sdfgi_message_vulkan(&scene->backend->hooks, result, name);
    sdfgi_scene_instances_leave(scene, handle);
    sdfgi_scene_sets_retire(scene, before.set);
    *material = after;
    count_in(scene, &after.desc);
    count_out(scene, &before.desc);
    if (after.users > 0)
        sdfgi_scene_material_shown(scene, &after.desc);
    sdfgi_scene_instances_enter(scene, handle);
    return SDFGI_OK;
}

static enum sdfgi_result still_used(const struct scene *scene, sdfgi_material handle)
{
    uint32_t user = 0;
    for (uint32_t i = 0; i < scene->instances.end; i++) {
        const struct instance *instance = sdfgi_pool_at(&scene->instances, i);
        if (instance && instance->desc.material.id == handle.id)
            user = sdfgi_pool_id(&scene->instances, i);
    }
    return sdfgi_message_invalid(&scene->backend->hooks,
                                 "sdfgi_material_destroy: instance %u still uses material %u", user,
                                 handle.id);
}

enum sdfgi_result sdfgi_scene_material_destroy(struct scene *scene, sdfgi_material handle)
{
    struct material *material = sdfgi_pool_get(&scene->materials, handle.id);
    if (!material)
        return sdfgi_check_unknown_handle(scene, "sdfgi_material_destroy", handle.id);
    if (material->users > 0)
        return still_used(scene, handle);
    const struct sdfgi_material_desc desc = material->desc;
    sdfgi_scene_sets_retire(scene, material->set);
    sdfgi_pool_remove(&scene->materials, handle.id);
    count_out(scene, &desc);
    return SDFGI_OK;
}

/* ---- Meshes */

enum sdfgi_result sdfgi_scene_mesh_create(struct scene *scene, const struct sdfgi_mesh_desc *desc,
                                          sdfgi_mesh *out)
{
    const struct problem problem = sdfgi_check_mesh(desc, &scene->backend->device);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_mesh_create");
    uint32_t id;
    struct mesh *mesh = sdfgi_pool_add(&scene->meshes, &scene->backend->hooks, &id);
    if (!mesh)
        return sdfgi_check_out_of_slots(scene, "sdfgi_mesh_create", MAX_OBJECTS);
    mesh->desc = *desc;
    sdfgi_mesh_streams(desc, mesh->streams);
    const VkResult result = sdfgi_scene_sets_mesh(scene, mesh);
    if (result != VK_SUCCESS) {
        sdfgi_pool_remove(&scene->meshes, id);
        return sdfgi_message_vulkan(&scene->backend->hooks, result, "sdfgi_mesh_create");
    }
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_mesh_destroy(struct scene *scene, sdfgi_mesh handle)
{
    struct mesh *mesh = sdfgi_pool_get(&scene->meshes, handle.id);
    if (!mesh)
        return sdfgi_check_unknown_handle(scene, "sdfgi_mesh_destroy", handle.id);
    while (mesh->first > 0)
        sdfgi_scene_instance_destroy(scene,
                                     (sdfgi_instance){ sdfgi_pool_id(&scene->instances, mesh->first - 1) });
    sdfgi_scene_sets_retire(scene, mesh->set);
    sdfgi_pool_remove(&scene->meshes, handle.id);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_invalidate_box(struct scene *scene, const double box_min[3],
                                             const double box_max[3])
{
    const struct problem problem = sdfgi_check_box(box_min, box_max);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_invalidate_box");
    struct box box;
    memcpy(box.min, box_min, sizeof box.min);
    memcpy(box.max, box_max, sizeof box.max);
    sdfgi_journal_add_box(scene->journals, &box);
    if (scene->emissive > 0)
        sdfgi_journal_add_emitter(scene->journals, &box);
    return SDFGI_OK;
}
