/* SPDX-License-Identifier: MIT
 * Instances, one by one and many at once. Nothing here takes time for instances that do not change, but the
 * search for a free slot. */
#include "same.h"
#include "scene.h"
#include "scene_check.h"

#include <math.h>
#include <stdio.h>

bool sdfgi_scene_touches(const struct scene *scene, const struct box *box)
{
    struct tree_search search;
    uint32_t slot;
    sdfgi_tree_search(&search, &scene->tree, box);
    while (sdfgi_tree_next(&search, &slot)) {
        const struct instance *instance = sdfgi_pool_at(&scene->instances, slot);
        if (sdfgi_box_overlaps(&instance->bounds, box))
            return true;
    }
    return false;
}

/* ---- Checks */

enum fault { FAULT_NONE, FAULT_MESH, FAULT_MATERIAL, FAULT_VALUE };

static enum fault find_fault(const struct scene *scene, const struct sdfgi_instance_desc *desc,
                             struct problem *problem)
{
    if (!sdfgi_pool_get(&scene->meshes, desc->mesh.id))
        return FAULT_MESH;
    if (!sdfgi_pool_get(&scene->materials, desc->material.id))
        return FAULT_MATERIAL;
    *problem = sdfgi_check_transform(&desc->transform);
    if (desc->mobility != SDFGI_STATIC && desc->mobility != SDFGI_EXCLUDED)
        sdfgi_problem_add(problem, "mobility is %d, must be one of enum sdfgi_mobility", (int)desc->mobility);
    return problem->text[0] ? FAULT_VALUE : FAULT_NONE;
}

static enum sdfgi_result report_fault(const struct scene *scene, const char *what, enum fault fault,
                                      const struct sdfgi_instance_desc *desc, const struct problem *problem)
{
    char text[96];
    if (fault == FAULT_VALUE)
        return sdfgi_problem_report(problem, &scene->backend->hooks, what);
    snprintf(text, sizeof text, "%s: %s", what, fault == FAULT_MESH ? "mesh" : "material");
    return sdfgi_check_unknown_handle(scene, text, fault == FAULT_MESH ? desc->mesh.id : desc->material.id);
}

/* "sdfgi_instances_create: descs[5]" */
struct element_name {
    char text[64];
};

static struct element_name element_name(const char *array, uint32_t index)
{
    struct element_name name;
    snprintf(name.text, sizeof name.text, "%s[%u]", array, (unsigned)index);
    return name;
}

static enum sdfgi_result check_limit(const struct scene *scene, const char *what, uint32_t count)
{
    if (count <= MAX_OBJECTS - scene->instances.count)
        return SDFGI_OK;
    sdfgi_message_log(&scene->backend->hooks, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY,
                      "%s: %u more beside %u instances, must be at most %u in all", what, (unsigned)count,
                      (unsigned)scene->instances.count, (unsigned)MAX_OBJECTS);
    return SDFGI_ERROR_OUT_OF_MEMORY;
}

/* Makes room for `count` instances more. */
static enum sdfgi_result make_room(struct scene *scene, const char *what, uint32_t count)
{
    const struct hooks *hooks = &scene->backend->hooks;
    if (!sdfgi_pool_reserve(&scene->instances, hooks, count) ||
        !sdfgi_tree_reserve(&scene->tree, hooks, scene->instances.capacity))
        return sdfgi_check_out_of_slots(scene, what, MAX_OBJECTS);
    if (scene->instance_room == scene->instances.capacity)
        return SDFGI_OK;
    pthread_mutex_lock(&scene->backend->lock);
    scene->instance_room = scene->instances.capacity;
    pthread_mutex_unlock(&scene->backend->lock);
    return SDFGI_OK;
}

/* ---- Lists */

static struct instance *instance_at(const struct scene *scene, uint32_t slot)
{
    return sdfgi_pool_at(&scene->instances, slot);
}

static void link_first(const struct scene *scene, uint32_t *first, uint32_t slot, size_t offset)
{
    struct neighbours *own = (struct neighbours *)((char *)instance_at(scene, slot) + offset);
    *own = (struct neighbours){ .after = *first };
    if (*first > 0)
        ((struct neighbours *)((char *)instance_at(scene, *first - 1) + offset))->before = slot + 1;
    *first = slot + 1;
}

static void unlink_from(const struct scene *scene, uint32_t *first, uint32_t slot, size_t offset)
{
    const struct neighbours own = *(struct neighbours *)((char *)instance_at(scene, slot) + offset);
    if (own.before > 0)
        ((struct neighbours *)((char *)instance_at(scene, own.before - 1) + offset))->after = own.after;
    else
        *first = own.after;
    if (own.after > 0)
        ((struct neighbours *)((char *)instance_at(scene, own.after - 1) + offset))->before = own.before;
}

/* ---- In the volumes */

static struct box transformed_bounds(const struct mesh *mesh, const struct sdfgi_transform *t)
{
    struct box box;
    for (int row = 0; row < 3; row++) {
        double low = t->translation[row], high = low;
        for (int column = 0; column < 3; column++) {
            const double a = (double)t->basis[3 * column + row] * mesh->desc.bounds_min[column];
            const double b = (double)t->basis[3 * column + row] * mesh->desc.bounds_max[column];
            low += fmin(a, b);
            high += fmax(a, b);
        }
        box.min[row] = low;
        box.max[row] = high;
    }
    return box;
}

/* The volumes hold something else where an instance is. */
static void instance_changed(struct scene *scene, const struct instance *instance)
{
    const struct material *material = sdfgi_pool_get(&scene->materials, instance->desc.material.id);
    sdfgi_journal_add_box(scene->journals, &instance->bounds);
    if (material && sdfgi_scene_emits(&material->desc))
        sdfgi_journal_add_emitter(scene->journals, &instance->bounds);
}

/* The instance is, or is no longer, what volumes hold where its bounds are. */
static void enter_volumes(struct scene *scene, uint32_t slot)
{
    struct instance *instance = instance_at(scene, slot);
    if (instance->desc.mobility != SDFGI_STATIC)
        return;
    instance->revision = ++scene->revision;
    link_first(scene, &scene->newest, slot, offsetof(struct instance, by_revision));
    sdfgi_tree_add(&scene->tree, slot, &instance->bounds);
    instance_changed(scene, instance);
}

static void leave_volumes(struct scene *scene, uint32_t slot)
{
    const struct instance *instance = instance_at(scene, slot);
    if (instance->desc.mobility != SDFGI_STATIC)
        return;
    unlink_from(scene, &scene->newest, slot, offsetof(struct instance, by_revision));
    sdfgi_tree_remove(&scene->tree, slot);
    instance_changed(scene, instance);
}

static void for_all_of(struct scene *scene, sdfgi_material material, void (*call)(struct scene *, uint32_t))
{
    for (uint32_t slot = 0; slot < scene->instances.end; slot++) {
        const struct instance *instance = sdfgi_pool_at(&scene->instances, slot);
        if (instance && instance->desc.material.id == material.id)
            call(scene, slot);
    }
}

void sdfgi_scene_instances_leave(struct scene *scene, sdfgi_material material)
{
    for_all_of(scene, material, leave_volumes);
}

void sdfgi_scene_instances_enter(struct scene *scene, sdfgi_material material)
{
    for_all_of(scene, material, enter_volumes);
}

/* ---- Life */

/* There is room, and the description has been checked. */
static sdfgi_instance add(struct scene *scene, const struct sdfgi_instance_desc *desc)
{
    struct mesh *mesh = sdfgi_pool_get(&scene->meshes, desc->mesh.id);
    struct material *material = sdfgi_pool_get(&scene->materials, desc->material.id);
    sdfgi_instance handle;
    struct instance *instance = sdfgi_pool_add(&scene->instances, &scene->backend->hooks, &handle.id);
    const uint32_t slot = sdfgi_pool_index(&scene->instances, handle.id);
    instance->desc = *desc;
    instance->bounds = transformed_bounds(mesh, &desc->transform);
    link_first(scene, &mesh->first, slot, offsetof(struct instance, of_mesh));
    if (material->users++ == 0)
        sdfgi_scene_material_shown(scene, &material->desc);
    enter_volumes(scene, slot);
    return handle;
}

static void remove_live(struct scene *scene, sdfgi_instance handle)
{
    const uint32_t slot = sdfgi_pool_index(&scene->instances, handle.id);
    const struct instance *instance = instance_at(scene, slot);
    struct mesh *mesh = sdfgi_pool_get(&scene->meshes, instance->desc.mesh.id);
    struct material *material = sdfgi_pool_get(&scene->materials, instance->desc.material.id);
    leave_volumes(scene, slot);
    unlink_from(scene, &mesh->first, slot, offsetof(struct instance, of_mesh));
    material->users--;
    sdfgi_pool_remove(&scene->instances, handle.id);
}

enum sdfgi_result sdfgi_scene_instance_create(struct scene *scene, const struct sdfgi_instance_desc *desc,
                                              sdfgi_instance *out)
{
    struct problem problem;
    const enum fault fault = find_fault(scene, desc, &problem);
    if (fault != FAULT_NONE)
        return report_fault(scene, "sdfgi_instance_create", fault, desc, &problem);
    enum sdfgi_result result = check_limit(scene, "sdfgi_instance_create", 1);
    if (result == SDFGI_OK)
        result = make_room(scene, "sdfgi_instance_create", 1);
    if (result == SDFGI_OK)
        *out = add(scene, desc);
    return result;
}

enum sdfgi_result sdfgi_scene_instances_create(struct scene *scene, uint32_t count,
                                               const struct sdfgi_instance_desc *descs, sdfgi_instance *out)
{
    const enum sdfgi_result limit = check_limit(scene, "sdfgi_instances_create", count);
    if (limit != SDFGI_OK)
        return limit;
    for (uint32_t i = 0; i < count; i++) {
        struct problem problem;
        const enum fault fault = find_fault(scene, &descs[i], &problem);
        if (fault != FAULT_NONE)
            return report_fault(scene, element_name("sdfgi_instances_create: descs", i).text, fault,
                                &descs[i], &problem);
    }
    const enum sdfgi_result room = make_room(scene, "sdfgi_instances_create", count);
    if (room != SDFGI_OK)
        return room;
    for (uint32_t i = 0; i < count; i++)
        out[i] = add(scene, &descs[i]);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_instance_set_transform(struct scene *scene, sdfgi_instance handle,
                                                     const struct sdfgi_transform *transform)
{
    struct instance *instance = sdfgi_pool_get(&scene->instances, handle.id);
    if (!instance)
        return sdfgi_check_unknown_handle(scene, "sdfgi_instance_set_transform", handle.id);
    const struct problem problem = sdfgi_check_transform(transform);
    if (problem.text[0])
        return sdfgi_problem_report_of(&problem, &scene->backend->hooks, "sdfgi_instance_set_transform",
                                       "instance", handle.id);
    if (sdfgi_same_transform(&instance->desc.transform, transform))
        return SDFGI_OK;
    const uint32_t slot = sdfgi_pool_index(&scene->instances, handle.id);
    leave_volumes(scene, slot);
    instance->desc.transform = *transform;
    instance->bounds = transformed_bounds(sdfgi_pool_get(&scene->meshes, instance->desc.mesh.id), transform);
    enter_volumes(scene, slot);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_instance_destroy(struct scene *scene, sdfgi_instance handle)
{
    if (!sdfgi_pool_get(&scene->instances, handle.id))
        return sdfgi_check_unknown_handle(scene, "sdfgi_instance_destroy", handle.id);
    remove_live(scene, handle);
    return SDFGI_OK;
}

/* How many of the handles are live and named once: all, or those before the first that is not. Marks them. */
static uint32_t mark(struct scene *scene, uint32_t count, const sdfgi_instance *handles)
{
    for (uint32_t i = 0; i < count; i++) {
        struct instance *instance = sdfgi_pool_get(&scene->instances, handles[i].id);
        if (!instance || instance->is_named)
            return i;
        instance->is_named = true;
    }
    return count;
}

enum sdfgi_result sdfgi_scene_instances_destroy(struct scene *scene, uint32_t count,
                                                const sdfgi_instance *handles)
{
    const uint32_t good = mark(scene, count, handles);
    for (uint32_t i = 0; i < good; i++) {
        if (good == count)
            remove_live(scene, handles[i]);
        else
            ((struct instance *)sdfgi_pool_get(&scene->instances, handles[i].id))->is_named = false;
    }
    if (good == count)
        return SDFGI_OK;
    const struct element_name name = element_name("sdfgi_instances_destroy: instances", good);
    if (!sdfgi_pool_get(&scene->instances, handles[good].id))
        return sdfgi_check_unknown_handle(scene, name.text, handles[good].id);
    return sdfgi_message_invalid(&scene->backend->hooks, "%s: handle %u is there twice", name.text,
                                 (unsigned)handles[good].id);
}
