/* SPDX-License-Identifier: MIT */
#include "triangles_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the filters need beside Embree's own context, which comes first so that the two convert. */
struct trace_context {
    struct RTCIntersectContext base;
    const struct ray *ray;
};

static bool is_back_face(const struct mesh *m, uint32_t triangle, struct vec3 direction)
{
    const struct corners c = mesh_corners(m, triangle);
    return vec3_dot(mesh_front(m, &c), direction) > 0.0f;
}

/* Lets a ray pass where the material is cut out, by chance where it is blended, and through culled backs. The
 * chance hangs on the ray and the triangle, not on how often or in which order Embree asks. */
static void filter(const struct RTCFilterFunctionNArguments *args)
{
    const struct mesh *m = args->geometryUserPtr;
    const struct ray *ray = ((const struct trace_context *)args->context)->ray;
    const struct RTCHit *hit = (const struct RTCHit *)args->hit; /* one ray at a time: N is 1 */
    const uint32_t triangle = hit->primID;
    if (args->valid[0] != -1)
        return;
    if (ray->from_camera && m->owner->cull_back_faces && !m->material->double_sided &&
        is_back_face(m, triangle, ray->direction)) {
        args->valid[0] = 0;
        return;
    }
    if (m->material->alpha_mode == GLTF_ALPHA_OPAQUE)
        return;
    const struct material_point p = mesh_material_point(m, triangle, hit->u, hit->v);
    const float coverage = material_coverage(&m->owner->materials, m->material, &p);
    const uint32_t mesh = (uint32_t)(m - m->owner->meshes);
    if (random_from_keys(ray->key, mesh, triangle) >= coverage)
        args->valid[0] = 0;
}

static struct RTCRay embree_ray(const struct ray *ray)
{
    return (struct RTCRay){
        .org_x = ray->origin.x,
        .org_y = ray->origin.y,
        .org_z = ray->origin.z,
        .dir_x = ray->direction.x,
        .dir_y = ray->direction.y,
        .dir_z = ray->direction.z,
        .tnear = 0.0f,
        .tfar = ray->length_m,
        .mask = UINT32_MAX,
    };
}

static struct trace_context context_for(const struct ray *ray)
{
    struct trace_context c = { .ray = ray };
    rtcInitIntersectContext(&c.base);
    return c;
}

static bool triangles_intersect(const struct geometry *g, const struct ray *ray, struct surface *out)
{
    const struct triangles *t = (const struct triangles *)g;
    struct trace_context context = context_for(ray);
    struct RTCRayHit h = { .ray = embree_ray(ray) };
    h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(t->scene, &context.base, &h);
    if (h.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    triangle_surface(t, ray, &(struct triangle_hit){ h.hit.geomID, h.hit.primID, h.hit.u, h.hit.v }, out);
    return true;
}

static bool triangles_occluded(const struct geometry *g, const struct ray *ray)
{
    const struct triangles *t = (const struct triangles *)g;
    struct trace_context context = context_for(ray);
    struct RTCRay r = embree_ray(ray);
    rtcOccluded1(t->scene, &context.base, &r);
    return r.tfar < 0.0f;
}

/* Rays leave triangles of every kind alike. */
static void triangles_adopt(const struct geometry *g, struct surface *s)
{
    (void)g;
    s->start = geometry_offset(s->position, s->geometric_normal);
}

static void triangles_destroy(struct geometry *g)
{
    struct triangles *t = (struct triangles *)g;
    for (uint32_t i = 0; t->meshes != NULL && i < t->mesh_count; i++)
        free(t->meshes[i].emitter_density);
    rtcReleaseScene(t->scene);
    rtcReleaseDevice(t->device);
    free(t->meshes);
    free(t->emitters);
    free(t->emitter_cdf);
    free(t);
}

static const struct geometry_methods triangles_methods = {
    .intersect = triangles_intersect,
    .occluded = triangles_occluded,
    .emitter_sample = emitters_sample,
    .adopt = triangles_adopt,
    .destroy = triangles_destroy,
};

static bool needs_filter(const struct triangles *t, const struct gltf_material *m)
{
    return m->alpha_mode != GLTF_ALPHA_OPAQUE || (t->cull_back_faces && !m->double_sided);
}

/* Vertices in the tracer's space: the subtraction of the origin is done in double precision. */
static void transform_positions(const struct gltf_primitive *p, const double m[16], const double origin[3],
                                float *out)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const float *v = p->positions + 3 * (size_t)i;
        for (int k = 0; k < 3; k++)
            out[3 * (size_t)i + k] =
                (float)(m[k] * v[0] + m[4 + k] * v[1] + m[8 + k] * v[2] + (m[12 + k] - origin[k]));
    }
}

static bool mesh_add(struct triangles *t, const struct triangles_desc *desc, uint32_t index)
{
    const struct gltf_instance *instance = &desc->scene->instances[index];
    const struct gltf_primitive *p = &desc->scene->primitives[instance->primitive];
    struct mesh *m = &t->meshes[index];
    *m = (struct mesh){ .owner = t, .primitive = p, .material = &desc->scene->materials[p->material] };
    if (material_is_default(desc->scene, p->material)) {
        t->default_material = material_default(desc->scene, p->material, desc->view->default_albedo);
        m->material = &t->default_material;
    }
    mesh_transform_set(m, instance->transform);
    if (p->index_count == 0)
        return true;
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                               3 * sizeof(float), p->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), p->index_count / 3);
    if (positions != NULL && indices != NULL) {
        transform_positions(p, instance->transform, desc->origin, positions);
        memcpy(indices, p->indices, p->index_count * sizeof(*indices));
        m->positions = positions;
        m->indices = indices;
        rtcSetGeometryUserData(g, m);
        if (needs_filter(t, m->material)) {
            rtcSetGeometryIntersectFilterFunction(g, filter);
            rtcSetGeometryOccludedFilterFunction(g, filter);
        }
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(t->scene, g, index);
    }
    rtcReleaseGeometry(g);
    return positions != NULL && indices != NULL;
}

static bool fill(struct triangles *t, const struct triangles_desc *desc)
{
    const uint32_t count = desc->scene->instance_count;
    t->meshes = calloc(count > 0 ? count : 1, sizeof(*t->meshes));
    if (t->meshes == NULL)
        return false;
    t->mesh_count = count;
    for (uint32_t i = 0; i < count; i++) {
        if (!mesh_add(t, desc, i))
            return false;
    }
    rtcCommitScene(t->scene);
    struct RTCBounds bounds;
    rtcGetSceneBounds(t->scene, &bounds);
    const struct vec3 size = vec3_make(bounds.upper_x - bounds.lower_x, bounds.upper_y - bounds.lower_y,
                                       bounds.upper_z - bounds.lower_z);
    t->base.radius_m = count > 0 ? 0.5f * vec3_length(size) : 0.0f;
    return rtcGetDeviceError(t->device) == RTC_ERROR_NONE && emitters_build(t);
}

struct geometry *triangles_create(const struct triangles_desc *desc, char *error, size_t error_size)
{
    struct triangles *t = calloc(1, sizeof(*t));
    if (t == NULL) {
        snprintf(error, error_size, "reference: out of memory");
        return NULL;
    }
    t->base.methods = &triangles_methods;
    t->cull_back_faces = desc->cull_back_faces;
    material_context_init(&t->materials, desc->scene, desc->view);
    /* One thread builds: parallel builds order the tree by chance, and with it which of two coplanar faces
     * is hit. */
    t->device = rtcNewDevice("threads=1");
    t->scene = t->device != NULL ? rtcNewScene(t->device) : NULL;
    if (t->scene == NULL) {
        snprintf(error, error_size, "reference: Embree refused to start");
        if (t->device != NULL)
            rtcReleaseDevice(t->device);
        free(t);
        return NULL;
    }
    rtcSetSceneFlags(t->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(t->scene, RTC_BUILD_QUALITY_HIGH);
    if (!fill(t, desc)) {
        snprintf(error, error_size, "reference: out of memory for the scene's triangles");
        triangles_destroy(&t->base);
        return NULL;
    }
    return &t->base;
}
