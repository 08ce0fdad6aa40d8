/* SPDX-License-Identifier: MIT */
#include "ggx.h"
#include "triangles_internal.h"

struct corners mesh_corners(const struct mesh *m, uint32_t triangle)
{
    const uint32_t *i = m->indices + 3 * (size_t)triangle;
    struct corners c;
    for (int k = 0; k < 3; k++)
        c.p[k] = vec3_load(m->positions + 3 * (size_t)i[k]);
    return c;
}

struct vec3 mesh_front(const struct mesh *m, const struct corners *c)
{
    const struct vec3 n = vec3_cross(vec3_sub(c->p[1], c->p[0]), vec3_sub(c->p[2], c->p[0]));
    return m->mirrored ? vec3_negate(n) : n;
}

/* Cofactors are the inverse transpose times the determinant, and need no division. */
void mesh_transform_set(struct mesh *m, const double t[16])
{
    double cofactor[3][3];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            cofactor[r][c] = t[4 * c1 + r1] * t[4 * c2 + r2] - t[4 * c1 + r2] * t[4 * c2 + r1];
        }
    }
    const double det = t[0] * cofactor[0][0] + t[1] * cofactor[1][0] + t[2] * cofactor[2][0];
    double largest = 0.0;
    for (int k = 0; k < 9; k++)
        largest = fmax(largest, fabs(cofactor[k / 3][k % 3]));
    const double scale = largest > 0.0 ? (det < 0.0 ? -1.0 : 1.0) / largest : 0.0;
    m->mirrored = det < 0.0;
    for (int k = 0; k < 3; k++) {
        m->linear[k] = vec3_make((float)t[4 * k], (float)t[4 * k + 1], (float)t[4 * k + 2]);
        m->normal_rows[k] = vec3_make((float)(cofactor[k][0] * scale), (float)(cofactor[k][1] * scale),
                                      (float)(cofactor[k][2] * scale));
    }
}

/* Weighted sum of an attribute with `n` floats a vertex. */
static void interpolate(const float *values, uint32_t n, const uint32_t *i, float u, float v, float *out)
{
    const float w = 1.0f - u - v;
    for (uint32_t k = 0; k < n; k++)
        out[k] = values[n * (size_t)i[0] + k] * w + values[n * (size_t)i[1] + k] * u +
                 values[n * (size_t)i[2] + k] * v;
}

struct material_point mesh_material_point(const struct mesh *m, uint32_t triangle, float u, float v)
{
    struct material_point p = { .color = { 1.0f, 1.0f, 1.0f, 1.0f } };
    const uint32_t *i = m->indices + 3 * (size_t)triangle;
    interpolate(m->primitive->uv0, 2, i, u, v, p.uv[0]);
    if (m->primitive->uv1 != NULL)
        interpolate(m->primitive->uv1, 2, i, u, v, p.uv[1]);
    if (m->primitive->colors != NULL)
        interpolate(m->primitive->colors, 4, i, u, v, p.color);
    return p;
}

static struct vec3 normal_to_world(const struct mesh *m, struct vec3 n)
{
    return vec3_normalize(vec3_make(vec3_dot(m->normal_rows[0], n), vec3_dot(m->normal_rows[1], n),
                                    vec3_dot(m->normal_rows[2], n)));
}

static struct vec3 direction_to_world(const struct mesh *m, struct vec3 d)
{
    return vec3_mad(vec3_mad(vec3_scale(m->linear[0], d.x), m->linear[1], d.y), m->linear[2], d.z);
}

/* The normal map's normal in world space. The bitangent is made in object space, so that mirroring transforms
 * mirror it too. */
static struct vec3 map_normal(const struct mesh *m, const uint32_t *i, const struct triangle_hit *hit,
                              struct vec3 normal_object, struct vec3 normal_world, struct vec3 mapped)
{
    float tangent[4];
    interpolate(m->primitive->tangents, 4, i, hit->u, hit->v, tangent);
    const struct vec3 t = vec3_load(tangent);
    const struct vec3 b = vec3_scale(vec3_cross(normal_object, t), tangent[3] < 0.0f ? -1.0f : 1.0f);
    const struct vec3 t_world = vec3_normalize(direction_to_world(m, t));
    const struct vec3 b_world = vec3_normalize(direction_to_world(m, b));
    return vec3_normalize(
        vec3_mad(vec3_mad(vec3_scale(t_world, mapped.x), b_world, mapped.y), normal_world, mapped.z));
}

/* Shading normal on the front side. Vertex normals that point away from their face's front are turned round:
 * the winding decides which side is which. */
static struct vec3 front_normal(const struct triangles *t, const struct mesh *m,
                                const struct triangle_hit *hit, const struct material_point *p,
                                struct vec3 geometric)
{
    const uint32_t *i = m->indices + 3 * (size_t)hit->triangle;
    float n[3];
    interpolate(m->primitive->normals, 3, i, hit->u, hit->v, n);
    struct vec3 object = vec3_normalize(vec3_load(n)), world = normal_to_world(m, object);
    if (!(vec3_dot(world, world) > 0.5f))
        return geometric;
    if (vec3_dot(world, geometric) < 0.0f) {
        object = vec3_negate(object);
        world = vec3_negate(world);
    }
    struct vec3 mapped;
    if (!material_tangent_normal(&t->materials, m->material, p, &mapped))
        return world;
    const struct vec3 bent = map_normal(m, i, hit, object, world, mapped);
    return vec3_dot(bent, bent) > 0.5f ? bent : world;
}

/* Base colour, roughness and metallic into the two reflecting parts, as glTF's appendix B has them. */
static void reflectance(const struct triangles *t, const struct mesh *m, const struct material_point *p,
                        struct surface *out)
{
    const struct rgba color = material_base_color(&t->materials, m->material, p);
    const struct vec3 base = vec3_make(clamp01(color.r), clamp01(color.g), clamp01(color.b));
    out->glossy = t->materials.mode == RAYCAST_MATERIALS_GLTF && !m->material->unlit;
    out->diffuse = base;
    if (!out->glossy)
        return;
    float roughness, metallic;
    material_roughness_metallic(&t->materials, m->material, p, &roughness, &metallic);
    out->diffuse = vec3_scale(base, 1.0f - metallic);
    out->specular = vec3_lerp(vec3_splat(0.04f), base, metallic);
    out->alpha = fmaxf(roughness * roughness, GGX_MIN_ALPHA);
}

static void emission(const struct triangles *t, const struct mesh *m, const struct ray *ray, bool front,
                     const struct triangle_hit *hit, const struct material_point *p, struct surface *out)
{
    if (m->material->unlit) {
        out->emits = ray->from_camera;
        out->emission = out->diffuse;
        if (ray->from_camera)
            out->diffuse = vec3_splat(0.0f);
        return;
    }
    out->emits = material_emits(m->material) && (front || m->material->double_sided);
    if (out->emits)
        out->emission = material_emission(&t->materials, m->material, p);
    if (!out->emits || m->emitter_density == NULL)
        return;
    const float facing = fabsf(vec3_dot(ray->direction, out->geometric_normal));
    out->emission_pdf = m->emitter_density[hit->triangle] / fmaxf(facing, 1e-12f);
}

void triangle_surface(const struct triangles *t, const struct ray *ray, const struct triangle_hit *hit,
                      struct surface *out)
{
    const struct mesh *m = &t->meshes[hit->mesh];
    const struct corners c = mesh_corners(m, hit->triangle);
    const struct material_point p = mesh_material_point(m, hit->triangle, hit->u, hit->v);
    *out = (struct surface){ 0 };
    out->position =
        vec3_mad(vec3_mad(vec3_scale(c.p[0], 1.0f - hit->u - hit->v), c.p[1], hit->u), c.p[2], hit->v);
    out->geometric_normal = vec3_normalize(mesh_front(m, &c));
    out->normal = front_normal(t, m, hit, &p, out->geometric_normal);
    const bool front = vec3_dot(out->geometric_normal, ray->direction) < 0.0f;
    if (!front) {
        out->geometric_normal = vec3_negate(out->geometric_normal);
        out->normal = vec3_negate(out->normal);
    }
    out->start = geometry_offset(out->position, out->geometric_normal);
    reflectance(t, m, &p, out);
    emission(t, m, ray, front, hit, &p, out);
}
