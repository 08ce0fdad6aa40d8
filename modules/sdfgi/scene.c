/* SPDX-License-Identifier: MIT
 * The scene as the host describes it: meshes, materials, instances, lights, sky. Every value is checked here,
 * at the edge; the stages trust it. */
#include "internal.h"
#include "scene_sets.h"

#include <math.h>
#include <string.h>

enum { MAX_OBJECTS = (1 << 20) - 2 };

void scene_init(struct sdfgi *gi)
{
    pool_init(&gi->scene.meshes, sizeof(struct mesh), MAX_OBJECTS);
    pool_init(&gi->scene.materials, sizeof(struct material), SDFGI_MAX_MATERIALS);
    pool_init(&gi->scene.instances, sizeof(struct instance), MAX_OBJECTS);
    pool_init(&gi->scene.lights, sizeof(struct light), SDFGI_MAX_LIGHTS);
}

void scene_finish(struct sdfgi *gi)
{
    scene_sets_finish(gi);
    pool_finish(&gi->scene.meshes, &gi->allocator);
    pool_finish(&gi->scene.materials, &gi->allocator);
    pool_finish(&gi->scene.instances, &gi->allocator);
    pool_finish(&gi->scene.lights, &gi->allocator);
}

void light_disturb(struct sdfgi *gi)
{
    gi->converged = false;
    gi->disturbed_ring = gi->ring;
    settle_reset(&gi->settling);
}

static struct box box_around(const struct box *a, const struct box *b)
{
    struct box box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = fmin(a->min[i], b->min[i]);
        box.max[i] = fmax(a->max[i], b->max[i]);
    }
    return box;
}

static double box_volume(const struct box *box)
{
    return (box->max[0] - box->min[0]) * (box->max[1] - box->min[1]) * (box->max[2] - box->min[2]);
}

/* Adds a box to those that changed; with no room left, the one that grows least takes it in. */
static void add_edit(struct cascade *cascade, const struct box *box)
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < cascade->edit_count; i++) {
        const struct box both = box_around(&cascade->edits[i], box);
        const double growth = box_volume(&both) - box_volume(&cascade->edits[i]);
        if (growth <= 0)
            return;
        if (growth < least) {
            least = growth;
            best = i;
        }
    }
    if (cascade->edit_count < SDFGI_MAX_CHANGES)
        cascade->edits[cascade->edit_count++] = *box;
    else
        cascade->edits[best] = box_around(&cascade->edits[best], box);
}

void scene_touch(struct sdfgi *gi, const struct box *box)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        struct cascade *cascade = &gi->cascades[c];
        const struct box own = cascade_box(cascade, gi->settings.resolution);
        if (cascade->placed && box_overlaps(&own, box)) {
            add_edit(cascade, box);
            light_disturb(gi);
        }
    }
}

static void touch_everything(struct sdfgi *gi)
{
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        gi->cascades[c].rebuild = true;
    light_disturb(gi);
}

static bool finite_floats(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

static bool finite_doubles(const double *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

static bool non_negative(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!(isfinite(v[i]) && v[i] >= 0))
            return false;
    return true;
}

static enum sdfgi_result out_of_slots(struct sdfgi *gi, const char *what, uint32_t limit)
{
    message(gi, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "%s: out of host memory, or more than %u of them", what,
            limit);
    return SDFGI_ERROR_OUT_OF_MEMORY;
}

static enum sdfgi_result stale(struct sdfgi *gi, const char *what, uint32_t id)
{
    message(gi, SDFGI_MESSAGE_INVALID_HANDLE, "%s: no object with handle %u", what, id);
    return SDFGI_ERROR_INVALID_ARGUMENT;
}

/* ---- Materials */

/* Emission is stored in units of the brightest material's, so that integer sums keep precision. */
static void update_emission_unit(struct sdfgi *gi)
{
    float unit = 0;
    for (uint32_t i = 0; i < gi->scene.materials.end; i++) {
        const struct material *m = pool_at(&gi->scene.materials, i);
        for (int k = 0; m && k < 3; k++)
            unit = fmaxf(unit, m->desc.emission[k]);
    }
    if (unit == gi->emission_unit)
        return;
    gi->emission_unit = unit;
    gi->materials_changed = true;
    touch_everything(gi);
}

static const char *material_problem(const struct sdfgi_material_desc *d)
{
    if (!non_negative(d->albedo, 3) || d->albedo[0] > 1 || d->albedo[1] > 1 || d->albedo[2] > 1)
        return "albedo is outside [0, 1]";
    if (!non_negative(d->emission, 3))
        return "emission is negative or not finite";
    if (!non_negative(&d->alpha, 1) || d->alpha > 1 || !non_negative(&d->alpha_cutoff, 1))
        return "alpha is outside [0, 1] or alpha_cutoff is negative";
    if (!finite_floats(d->albedo_texture.uv_transform, 6) ||
        !finite_floats(d->emission_texture.uv_transform, 6))
        return "a uv_transform is not finite";
    if ((d->albedo_texture.view && !d->albedo_texture.sampler) ||
        (d->emission_texture.view && !d->emission_texture.sampler))
        return "a texture has a view but no sampler";
    return NULL;
}

enum sdfgi_result sdfgi_material_create(sdfgi *gi, const struct sdfgi_material_desc *desc,
                                        sdfgi_material *out)
{
    const char *problem = material_problem(desc);
    if (problem)
        return invalid(gi, "sdfgi_material_create: %s", problem);
    uint32_t id;
    struct material *material = pool_add(&gi->scene.materials, &gi->allocator, &id);
    if (!material)
        return out_of_slots(gi, "sdfgi_material_create", SDFGI_MAX_MATERIALS);
    material->desc = *desc;
    const VkResult result = scene_sets_material(gi, material);
    if (result != VK_SUCCESS) {
        pool_remove(&gi->scene.materials, id);
        return message_vulkan(gi, result, "sdfgi_material_create");
    }
    gi->materials_changed = true;
    update_emission_unit(gi);
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_material_destroy(sdfgi *gi, sdfgi_material handle)
{
    struct material *material = pool_get(&gi->scene.materials, handle.id);
    if (!material)
        return stale(gi, "sdfgi_material_destroy", handle.id);
    for (uint32_t i = 0; i < gi->scene.instances.end; i++) {
        const struct instance *instance = pool_at(&gi->scene.instances, i);
        if (instance && instance->desc.material.id == handle.id)
            return invalid(gi, "sdfgi_material_destroy: instance %u still uses material %u",
                           pool_id(&gi->scene.instances, i), handle.id);
    }
    scene_sets_retire(gi, material->set, material->pool);
    pool_remove(&gi->scene.materials, handle.id);
    update_emission_unit(gi);
    return SDFGI_OK;
}

/* ---- Meshes */

static const char *mesh_problem(const struct sdfgi_mesh_desc *d)
{
    if (!d->position_buffer)
        return "position_buffer is null";
    if (d->vertex_count == 0 || d->triangle_count == 0)
        return "vertex_count or triangle_count is 0";
    if (!d->index_buffer && d->triangle_count > d->vertex_count / 3)
        return "triangle_count exceeds vertex_count / 3 without an index buffer";
    if (d->index_buffer && d->index_type != VK_INDEX_TYPE_UINT16 && d->index_type != VK_INDEX_TYPE_UINT32)
        return "index_type is neither UINT16 nor UINT32";
    if ((d->position_offset | d->position_stride | d->uv_offset | d->uv_stride | d->color_offset |
         d->color_stride | d->index_offset) &
        3)
        return "an offset or stride is not a multiple of 4";
    if ((d->position_offset | d->uv_offset | d->color_offset | d->index_offset) >> 34)
        return "an offset exceeds 16 GiB";
    if (!finite_floats(d->bounds_min, 3) || !finite_floats(d->bounds_max, 3) ||
        d->bounds_min[0] > d->bounds_max[0] || d->bounds_min[1] > d->bounds_max[1] ||
        d->bounds_min[2] > d->bounds_max[2])
        return "bounds are not finite or bounds_min exceeds bounds_max";
    return NULL;
}

enum sdfgi_result sdfgi_mesh_create(sdfgi *gi, const struct sdfgi_mesh_desc *desc, sdfgi_mesh *out)
{
    const char *problem = mesh_problem(desc);
    if (problem)
        return invalid(gi, "sdfgi_mesh_create: %s", problem);
    uint32_t id;
    struct mesh *mesh = pool_add(&gi->scene.meshes, &gi->allocator, &id);
    if (!mesh)
        return out_of_slots(gi, "sdfgi_mesh_create", MAX_OBJECTS);
    mesh->desc = *desc;
    mesh->desc.position_stride = desc->position_stride ? desc->position_stride : 12;
    mesh->desc.uv_stride = desc->uv_stride ? desc->uv_stride : 8;
    mesh->desc.color_stride = desc->color_stride ? desc->color_stride : 16;
    const VkResult result = scene_sets_mesh(gi, mesh);
    if (result != VK_SUCCESS) {
        pool_remove(&gi->scene.meshes, id);
        return message_vulkan(gi, result, "sdfgi_mesh_create");
    }
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_mesh_destroy(sdfgi *gi, sdfgi_mesh handle)
{
    struct mesh *mesh = pool_get(&gi->scene.meshes, handle.id);
    if (!mesh)
        return stale(gi, "sdfgi_mesh_destroy", handle.id);
    for (uint32_t i = 0; i < gi->scene.instances.end; i++) {
        const struct instance *instance = pool_at(&gi->scene.instances, i);
        if (instance && instance->desc.mesh.id == handle.id)
            sdfgi_instance_destroy(gi, (sdfgi_instance){ pool_id(&gi->scene.instances, i) });
    }
    scene_sets_retire(gi, mesh->set, mesh->pool);
    pool_remove(&gi->scene.meshes, handle.id);
    return SDFGI_OK;
}

/* ---- Instances */

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

static bool transform_finite(const struct sdfgi_transform *t)
{
    return finite_floats(t->basis, 9) && finite_doubles(t->translation, 3);
}

enum sdfgi_result sdfgi_instance_create(sdfgi *gi, const struct sdfgi_instance_desc *desc,
                                        sdfgi_instance *out)
{
    const struct mesh *mesh = pool_get(&gi->scene.meshes, desc->mesh.id);
    if (!mesh)
        return stale(gi, "sdfgi_instance_create: mesh", desc->mesh.id);
    if (!pool_get(&gi->scene.materials, desc->material.id))
        return stale(gi, "sdfgi_instance_create: material", desc->material.id);
    if (!transform_finite(&desc->transform))
        return invalid(gi, "sdfgi_instance_create: transform is not finite");
    if (desc->mobility != SDFGI_STATIC && desc->mobility != SDFGI_EXCLUDED)
        return invalid(gi, "sdfgi_instance_create: unknown mobility %d", (int)desc->mobility);
    uint32_t id;
    struct instance *instance = pool_add(&gi->scene.instances, &gi->allocator, &id);
    if (!instance)
        return out_of_slots(gi, "sdfgi_instance_create", MAX_OBJECTS);
    instance->desc = *desc;
    instance->bounds = transformed_bounds(mesh, &desc->transform);
    if (desc->mobility == SDFGI_STATIC)
        scene_touch(gi, &instance->bounds);
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_instance_set_transform(sdfgi *gi, sdfgi_instance handle,
                                               const struct sdfgi_transform *transform)
{
    struct instance *instance = pool_get(&gi->scene.instances, handle.id);
    if (!instance)
        return stale(gi, "sdfgi_instance_set_transform", handle.id);
    if (!transform_finite(transform))
        return invalid(gi, "sdfgi_instance_set_transform: transform is not finite");
    const bool in_volumes = instance->desc.mobility == SDFGI_STATIC;
    if (in_volumes)
        scene_touch(gi, &instance->bounds);
    instance->desc.transform = *transform;
    instance->bounds = transformed_bounds(pool_get(&gi->scene.meshes, instance->desc.mesh.id), transform);
    if (in_volumes)
        scene_touch(gi, &instance->bounds);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_instance_destroy(sdfgi *gi, sdfgi_instance handle)
{
    const struct instance *instance = pool_get(&gi->scene.instances, handle.id);
    if (!instance)
        return stale(gi, "sdfgi_instance_destroy", handle.id);
    if (instance->desc.mobility == SDFGI_STATIC)
        scene_touch(gi, &instance->bounds);
    pool_remove(&gi->scene.instances, handle.id);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_invalidate_box(sdfgi *gi, const double box_min[3], const double box_max[3])
{
    struct box box;
    memcpy(box.min, box_min, sizeof box.min);
    memcpy(box.max, box_max, sizeof box.max);
    for (int i = 0; i < 3; i++)
        if (!(box.min[i] <= box.max[i]))
            return invalid(gi, "sdfgi_invalidate_box: box_min exceeds box_max, or one is not a number");
    scene_touch(gi, &box);
    return SDFGI_OK;
}

/* ---- Lights and sky */

static const char *light_problem(const struct sdfgi_light_desc *d)
{
    const bool aims = d->type == SDFGI_LIGHT_DIRECTIONAL || d->type == SDFGI_LIGHT_SPOT;
    if (d->type > SDFGI_LIGHT_SPOT)
        return "unknown type";
    if (!non_negative(d->intensity, 3) || !non_negative(&d->indirect_energy, 1) ||
        !non_negative(&d->range_m, 1))
        return "intensity, indirect_energy or range_m is negative or not finite";
    if (!finite_doubles(d->position, 3))
        return "position is not finite";
    if (aims && (!finite_floats(d->direction, 3) ||
                 (d->direction[0] == 0 && d->direction[1] == 0 && d->direction[2] == 0)))
        return "direction is zero or not finite";
    if (d->type == SDFGI_LIGHT_SPOT && !(d->inner_angle_rad >= 0 && d->inner_angle_rad < d->outer_angle_rad &&
                                         d->outer_angle_rad <= 1.5708f))
        return "angles do not satisfy 0 <= inner < outer <= pi/2";
    return NULL;
}

static void lights_disturb(struct sdfgi *gi)
{
    gi->lights_changed = true;
    light_disturb(gi);
}

enum sdfgi_result sdfgi_light_create(sdfgi *gi, const struct sdfgi_light_desc *desc, sdfgi_light *out)
{
    const char *problem = light_problem(desc);
    if (problem)
        return invalid(gi, "sdfgi_light_create: %s", problem);
    uint32_t id;
    struct light *light = pool_add(&gi->scene.lights, &gi->allocator, &id);
    if (!light)
        return out_of_slots(gi, "sdfgi_light_create", SDFGI_MAX_LIGHTS);
    light->desc = *desc;
    lights_disturb(gi);
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_light_update(sdfgi *gi, sdfgi_light handle, const struct sdfgi_light_desc *desc)
{
    struct light *light = pool_get(&gi->scene.lights, handle.id);
    if (!light)
        return stale(gi, "sdfgi_light_update", handle.id);
    const char *problem = light_problem(desc);
    if (problem)
        return invalid(gi, "sdfgi_light_update: %s", problem);
    light->desc = *desc;
    lights_disturb(gi);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_light_destroy(sdfgi *gi, sdfgi_light handle)
{
    if (!pool_get(&gi->scene.lights, handle.id))
        return stale(gi, "sdfgi_light_destroy", handle.id);
    pool_remove(&gi->scene.lights, handle.id);
    lights_disturb(gi);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_set_sky(sdfgi *gi, const struct sdfgi_sky *sky)
{
    if (!non_negative(sky->zenith, 3) || !non_negative(sky->horizon, 3) || !non_negative(sky->ground, 3))
        return invalid(gi, "sdfgi_set_sky: a radiance is negative or not finite");
    if (memcmp(&gi->scene.sky, sky, sizeof *sky) == 0)
        return SDFGI_OK;
    gi->scene.sky = *sky;
    light_disturb(gi);
    return SDFGI_OK;
}
