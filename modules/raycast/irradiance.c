/* SPDX-License-Identifier: MIT
 *
 * Irradiance at points in space: the light at a white Lambertian surface, over its reflection.
 */
#include "internal.h"
#include "parallel.h"
#include "random.h"

struct query {
    struct raycast *rc;
    const double *points;
    const float *normals;
    uint32_t samples;
    struct raycast_irradiance *out;
};

struct sums {
    double indirect[3], squares[3], direct[3];
};

static void sums_add(struct sums *s, const struct first_light *light)
{
    const float indirect[3] = { light->irradiance.x, light->irradiance.y, light->irradiance.z };
    const float direct[3] = { light->direct.x, light->direct.y, light->direct.z };
    for (int k = 0; k < 3; k++) {
        s->indirect[k] += indirect[k];
        s->squares[k] += (double)indirect[k] * indirect[k];
        s->direct[k] += direct[k];
    }
}

/* A white surface reflects E / pi, which is how the direct part arrives. */
static void sums_store(const struct sums *s, double n, struct raycast_irradiance *out)
{
    for (int k = 0; k < 3; k++) {
        const double spread = fmax(0.0, s->squares[k] - s->indirect[k] * s->indirect[k] / n);
        out->indirect[k] = (float)(s->indirect[k] / n);
        out->direct[k] = (float)(s->direct[k] / n * VEC3_PI);
        out->indirect_error[k] = n > 1.0 ? (float)sqrt(spread / (n - 1.0) / n) : INFINITY;
    }
}

static void gather(void *context, uint32_t index)
{
    const struct query *q = context;
    const double *p = q->points + 3 * (size_t)index, *origin = q->rc->camera.origin;
    struct surface s = { .diffuse = vec3_splat(1.0f) };
    s.position = vec3_make((float)(p[0] - origin[0]), (float)(p[1] - origin[1]), (float)(p[2] - origin[2]));
    s.normal = s.geometric_normal = vec3_normalize(vec3_load(q->normals + 3 * (size_t)index));
    s.start = geometry_offset(s.position, s.geometric_normal);
    struct sums sums = { 0 };
    uint64_t rays = 0;
    for (uint32_t i = 0; i < q->samples; i++) {
        struct random r = random_begin(q->rc->settings.seed, index, i);
        struct first_light light;
        integrator_first_light(&q->rc->integrator, &s, s.normal, &r, &rays, &light);
        sums_add(&sums, &light);
    }
    sums_store(&sums, q->samples, &q->out[index]);
}

void raycast_irradiance_gather(struct raycast *rc, const double *points, const float *normals, uint32_t count,
                               uint32_t samples, struct raycast_irradiance *out)
{
    struct query q = {
        .rc = rc, .points = points, .normals = normals, .samples = samples > 0 ? samples : 1, .out = out
    };
    raycast_parallel_for(rc->settings.threads, count, gather, &q);
}
