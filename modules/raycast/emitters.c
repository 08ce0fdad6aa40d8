/* SPDX-License-Identifier: MIT
 *
 * Emissive triangles, chosen in proportion to their power.
 */
#include <stdlib.h>

#include "triangles_internal.h"

/* Points at which the mean of a textured emission is taken. Too few only costs noise: a triangle that looks
 * dark here is still found by rays that leave surfaces. */
#define TEXTURE_POINTS 64

/* Point k of a sequence that fills a triangle evenly: the R2 lattice of Roberts 2018 (inverse powers of the
 * plastic number), folded over the diagonal. */
static void lattice_point(uint32_t k, float *u, float *v)
{
    const double a = 0.5 + 0.7548776662466927 * k, b = 0.5 + 0.5698402909980532 * k;
    *u = (float)(a - floor(a));
    *v = (float)(b - floor(b));
    if (*u + *v > 1.0f) {
        *u = 1.0f - *u;
        *v = 1.0f - *v;
    }
}

static struct vec3 emitted(const struct triangles *t, const struct mesh *m, uint32_t triangle, float u,
                           float v)
{
    const struct material_point p = mesh_material_point(m, triangle, u, v);
    return vec3_scale(material_emission(&t->materials, m->material, &p),
                      material_coverage(&t->materials, m->material, &p));
}

static bool varies(const struct gltf_material *m)
{
    return m->emissive_texture.texture >= 0 || m->alpha_mode != GLTF_ALPHA_OPAQUE;
}

/* Luminous power: pi times radiance times area. */
static double power(const struct triangles *t, const struct mesh *m, uint32_t triangle, double area)
{
    const uint32_t points = varies(m->material) ? TEXTURE_POINTS : 1;
    double sum = 0.0;
    for (uint32_t k = 0; k < points; k++) {
        float u, v;
        lattice_point(k, &u, &v);
        sum += vec3_luminance(emitted(t, m, triangle, u, v));
    }
    return sum / points * area * VEC3_PI * (m->material->double_sided ? 2.0 : 1.0);
}

static bool is_emitter(const struct triangles *t, const struct mesh *m)
{
    return m->primitive->index_count > 0 && !m->material->unlit && material_emits(m->material) &&
           t->materials.emissive_scale > 0.0f;
}

static double mesh_area(const struct mesh *m, uint32_t triangle)
{
    const struct corners c = mesh_corners(m, triangle);
    return 0.5 * vec3_length(mesh_front(m, &c));
}

/* Append the triangles of a mesh; their powers go to the cdf, to be summed later. */
static bool emitters_add(struct triangles *t, uint32_t mesh)
{
    struct mesh *m = &t->meshes[mesh];
    const uint32_t count = m->primitive->index_count / 3;
    const size_t total = (size_t)t->emitter_count + count;
    struct emitter *emitters = realloc(t->emitters, total * sizeof(*emitters));
    if (emitters != NULL)
        t->emitters = emitters;
    double *cdf = realloc(t->emitter_cdf, total * sizeof(*cdf));
    if (cdf != NULL)
        t->emitter_cdf = cdf;
    m->emitter_density = calloc(count, sizeof(*m->emitter_density));
    if (emitters == NULL || cdf == NULL || m->emitter_density == NULL)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const double p = power(t, m, i, mesh_area(m, i));
        if (!(p > 0.0) || !isfinite(p))
            continue;
        t->emitters[t->emitter_count] = (struct emitter){ mesh, i };
        t->emitter_cdf[t->emitter_count++] = p;
    }
    return true;
}

bool emitters_build(struct triangles *t)
{
    for (uint32_t i = 0; i < t->mesh_count; i++) {
        if (is_emitter(t, &t->meshes[i]) && !emitters_add(t, i))
            return false;
    }
    double total = 0.0;
    for (uint32_t i = 0; i < t->emitter_count; i++)
        total += t->emitter_cdf[i];
    t->base.emitter_power = (float)total;
    double sum = 0.0;
    for (uint32_t i = 0; i < t->emitter_count; i++) {
        const struct emitter e = t->emitters[i];
        struct mesh *m = &t->meshes[e.mesh];
        m->emitter_density[e.triangle] = (float)(t->emitter_cdf[i] / total / mesh_area(m, e.triangle));
        sum += t->emitter_cdf[i];
        t->emitter_cdf[i] = sum / total;
    }
    return true;
}

/* First entry of the cdf above x. */
static uint32_t find(const struct triangles *t, double x)
{
    uint32_t low = 0, high = t->emitter_count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (t->emitter_cdf[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void emitters_sample(const struct geometry *g, struct random *r, struct emitter_sample *out)
{
    const struct triangles *t = (const struct triangles *)g;
    const struct emitter e = t->emitters[find(t, random_float(r))];
    const struct mesh *m = &t->meshes[e.mesh];
    const struct corners c = mesh_corners(m, e.triangle);
    const float root = sqrtf(random_float(r)), v = random_float(r) * root, u = 1.0f - root;
    out->position = vec3_mad(vec3_mad(vec3_scale(c.p[0], 1.0f - u - v), c.p[1], u), c.p[2], v);
    out->normal = vec3_normalize(mesh_front(m, &c));
    out->front = emitted(t, m, e.triangle, u, v);
    out->back = m->material->double_sided ? out->front : vec3_splat(0.0f);
    out->pdf = m->emitter_density[e.triangle];
}
