/* SPDX-License-Identifier: MIT
 * Geometry: every attribute of every primitive in one buffer that vertex input and the library both read. */
#include "host_internal.h"
#include "host_texture.h"
#include "host_math.h"

#include <stdlib.h>
#include <string.h>

/* Where the next array goes; the copy itself happens in a second walk over the same primitives. */
struct packer {
    uint8_t *bytes; /* NULL while sizes are being added up */
    VkDeviceSize size;
};

static VkDeviceSize pack(struct packer *packer, const void *data, size_t size)
{
    const VkDeviceSize offset = packer->size;
    if (packer->bytes)
        memcpy(packer->bytes + offset, data, size);
    packer->size += (size + 15) / 16 * 16;
    return offset;
}

static void pack_primitive(struct packer *packer, const struct gltf_primitive *in, VkDeviceSize white,
                           struct host_primitive *out)
{
    const size_t n = in->vertex_count;
    *out = (struct host_primitive){ .vertex_count = in->vertex_count,
                                    .index_count = in->index_count,
                                    .material = in->material,
                                    .has_colors = in->colors };
    memcpy(out->bounds_min, in->bounds_min, sizeof(out->bounds_min));
    memcpy(out->bounds_max, in->bounds_max, sizeof(out->bounds_max));
    out->positions = pack(packer, in->positions, 12 * n);
    out->normals = pack(packer, in->normals, 12 * n);
    out->tangents = pack(packer, in->tangents, 16 * n);
    out->uv[0] = pack(packer, in->uv0, 8 * n);
    out->uv[1] = in->uv1 ? pack(packer, in->uv1, 8 * n) : out->uv[0];
    out->colors = in->colors ? pack(packer, in->colors, 16 * n) : white;
    out->indices = pack(packer, in->indices, sizeof(uint32_t) * in->index_count);
}

/* Primitives without vertex colours share a run of white ones. */
static uint32_t white_count(const struct gltf_scene *gltf)
{
    uint32_t count = 1;
    for (uint32_t i = 0; i < gltf->primitive_count; i++) {
        const struct gltf_primitive *p = &gltf->primitives[i];
        if (!p->colors && p->vertex_count > count)
            count = p->vertex_count;
    }
    return count;
}

static void pack_scene(struct packer *packer, struct host_scene *scene, const struct gltf_scene *gltf,
                       const float *white, uint32_t white_vertices)
{
    packer->size = 0;
    const VkDeviceSize white_offset = pack(packer, white, (size_t)16 * white_vertices);
    for (uint32_t i = 0; i < gltf->primitive_count; i++)
        pack_primitive(packer, &gltf->primitives[i], white_offset, &scene->primitives[i]);
}

static bool geometry_upload(struct host_scene *scene, struct packer *packer)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return host_buffer_create(scene->device, packer->size, usage, false, &scene->geometry) &&
           host_buffer_upload(scene->device, &scene->geometry, 0, packer->bytes, packer->size);
}

static bool geometry_init(struct host_scene *scene, const struct gltf_scene *gltf)
{
    const uint32_t white_vertices = white_count(gltf);
    struct packer packer = { 0 };
    float *white = host_device_alloc(scene->device, white_vertices, 4 * sizeof(float));
    scene->primitive_count = gltf->primitive_count;
    scene->primitives = host_device_alloc(scene->device, gltf->primitive_count, sizeof(*scene->primitives));
    bool ok = white && scene->primitives;
    if (ok) {
        for (size_t i = 0; i < (size_t)4 * white_vertices; i++)
            white[i] = 1.0f;
        pack_scene(&packer, scene, gltf, white, white_vertices);
        packer.bytes = host_device_alloc(scene->device, packer.size, 1);
        ok = packer.bytes != NULL;
    }
    if (ok) {
        pack_scene(&packer, scene, gltf, white, white_vertices);
        ok = geometry_upload(scene, &packer);
    }
    free(packer.bytes);
    free(white);
    return ok;
}

static double determinant(const double m[16])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

/* Sphere around the transformed corners of the primitive's box. */
static void instance_bound(const struct host_primitive *primitive, struct host_instance *instance)
{
    const double *m = instance->transform;
    const float *lo = primitive->bounds_min, *hi = primitive->bounds_max;
    double half[3], center[3];
    for (int i = 0; i < 3; i++) {
        half[i] = 0.5 * ((double)hi[i] - (double)lo[i]);
        center[i] = 0.5 * ((double)hi[i] + (double)lo[i]);
    }
    double extent[3];
    for (int i = 0; i < 3; i++) {
        instance->center[i] = m[i] * center[0] + m[4 + i] * center[1] + m[8 + i] * center[2] + m[12 + i];
        extent[i] = fabs(m[i]) * half[0] + fabs(m[4 + i]) * half[1] + fabs(m[8 + i]) * half[2];
    }
    instance->radius = sqrt(host_dot3(extent, extent));
}

static void scene_bound(struct host_scene *scene)
{
    double lo[3] = { INFINITY, INFINITY, INFINITY }, hi[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct host_instance *instance = &scene->instances[i];
        for (int k = 0; k < 3; k++) {
            lo[k] = fmin(lo[k], instance->center[k] - instance->radius);
            hi[k] = fmax(hi[k], instance->center[k] + instance->radius);
        }
    }
    /* Exact in doubles wherever the scene is: what is measured from it does not change as the scene moves. */
    for (int k = 0; k < 3 && scene->instance_count > 0; k++)
        scene->center[k] = floor(32.0 * (lo[k] + hi[k])) / 64.0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const struct host_instance *instance = &scene->instances[i];
        double d[3];
        for (int k = 0; k < 3; k++)
            d[k] = instance->center[k] - scene->center[k];
        scene->radius = fmax(scene->radius, sqrt(host_dot3(d, d)) + instance->radius);
    }
}

static bool instances_init(struct host_scene *scene, const struct gltf_scene *gltf)
{
    scene->instances = host_device_alloc(scene->device, gltf->instance_count, sizeof(*scene->instances));
    if (!scene->instances)
        return false;
    for (uint32_t i = 0; i < gltf->instance_count; i++) {
        const struct gltf_instance *in = &gltf->instances[i];
        if (gltf->primitives[in->primitive].index_count == 0)
            continue;
        struct host_instance *out = &scene->instances[scene->instance_count++];
        out->primitive = in->primitive;
        memcpy(out->transform, in->transform, sizeof(out->transform));
        out->mirrored = determinant(in->transform) < 0.0;
        instance_bound(&scene->primitives[in->primitive], out);
    }
    scene_bound(scene);
    return true;
}

const struct host_material *host_instance_material(const struct host_scene *scene, uint32_t instance)
{
    return &scene->materials[scene->primitives[scene->instances[instance].primitive].material];
}

enum host_cull host_instance_cull(const struct host_scene *scene, uint32_t instance)
{
    if (host_instance_material(scene, instance)->double_sided)
        return HOST_CULL_NONE;
    return scene->instances[instance].mirrored ? HOST_CULL_FRONT : HOST_CULL_BACK;
}

struct host_scene *host_scene_create(struct host_device *device, const struct gltf_scene *gltf,
                                     const struct host_view *view)
{
    struct host_scene *scene = host_device_alloc(device, 1, sizeof(*scene));
    if (!scene)
        return NULL;
    scene->device = device;
    if (!geometry_init(scene, gltf) || !instances_init(scene, gltf) ||
        !host_materials_init(scene, gltf, view) || !host_lights_init(scene, gltf, view) ||
        !host_environment_init(scene, &view->environment)) {
        host_scene_destroy(scene);
        return NULL;
    }
    return scene;
}

void host_scene_destroy(struct host_scene *scene)
{
    if (!scene)
        return;
    vkDeviceWaitIdle(scene->device->device);
    host_materials_finish(scene);
    host_environment_finish(scene);
    host_buffer_destroy(scene->device, &scene->geometry);
    free(scene->primitives);
    free(scene->instances);
    free(scene->suns);
    free(scene->lights);
    free(scene);
}
