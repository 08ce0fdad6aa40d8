/* SPDX-License-Identifier: MIT */
#include "integrator.h"

#include "bsdf.h"

/* Paths may end by chance from this bounce on: earlier, the noise costs more than the rays save. */
#define ROULETTE_START 3

/* The way from one vertex of a path to the next. */
struct leg {
    struct vec3 start, direction;
    float pdf;         /* with which the direction was chosen, per solid angle */
    float lamps_total; /* of lights_sample at the start */
};

struct reflected {
    struct vec3 diffuse, specular, irradiance;
};

/* Neither sky nor emitters get less of the samples than this: their powers say nothing about who is in sight.
 */
#define MIN_SHARE 0.1f

/* Share of the samples that goes to the sky rather than to the emitters. */
static float sky_share(const struct lights *lights, const struct geometry *g)
{
    const float sky = lights->sky.mean_luminance * VEC3_PI * VEC3_PI * g->radius_m * g->radius_m;
    if (sky_is_black(&lights->sky))
        return 0.0f;
    if (!(g->emitter_power > 0.0f))
        return 1.0f;
    return fminf(fmaxf(sky / (sky + g->emitter_power), MIN_SHARE), 1.0f - MIN_SHARE);
}

void integrator_start(struct integrator *it)
{
    it->sky_share = sky_share(&it->lights, it->geometry);
}

/* What stands between a point and a light. */
struct blockers {
    const struct geometry *geometry;
    struct vec3 start; /* of the rays that ask */
};

static bool is_visible(const struct blockers *between, const struct light_sample *light, struct random *r,
                       uint64_t *rays)
{
    struct ray ray = {
        .origin = between->start,
        .direction = light->direction,
        .length_m = INFINITY,
        .key = random_bits(r),
    };
    if (!light->at_infinity) {
        const struct vec3 way = vec3_sub(light->target, ray.origin);
        ray.length_m = vec3_length(way);
        ray.direction = vec3_normalize(way);
    }
    ++*rays;
    return !geometry_occluded(between->geometry, &ray);
}

/* What a surface makes of a light sample, weighted against finding the light by sampling the surface. */
static struct reflected reflect(const struct blockers *between, const struct bsdf *b,
                                const struct light_sample *light, struct random *r, uint64_t *rays)
{
    struct reflected out = { 0 };
    struct bsdf_value v;
    if (!(vec3_max(light->radiance) > 0.0f) || !bsdf_evaluate(b, light->direction, &v) ||
        !is_visible(between, light, r, rays))
        return out;
    const float weight = light->pdf > 0.0f ? mis_weight(light->pdf, v.pdf) : 1.0f;
    const struct vec3 arriving = vec3_scale(light->radiance, weight);
    out.diffuse = vec3_mul(arriving, v.diffuse);
    out.specular = vec3_mul(arriving, v.specular);
    out.irradiance = vec3_scale(arriving, v.cosine);
    return out;
}

static struct reflected lamp_light(const struct integrator *it, const struct blockers *between,
                                   const struct bsdf *b, struct random *r, float *total, uint64_t *rays)
{
    struct light_sample light;
    if (!lights_sample(&it->lights, b->surface->position, b->frame.n, r, total, &light))
        return (struct reflected){ 0 };
    return reflect(between, b, &light, r, rays);
}

/* False: the point chosen cannot shine this way. */
static bool emitter_light(const struct integrator *it, struct vec3 position, float share, struct random *r,
                          struct light_sample *out)
{
    struct emitter_sample e;
    it->geometry->methods->emitter_sample(it->geometry, r, &e);
    const struct vec3 way = vec3_sub(e.position, position);
    const float d2 = vec3_dot(way, way);
    if (!(d2 > 0.0f) || !(e.pdf > 0.0f))
        return false;
    out->direction = vec3_scale(way, 1.0f / sqrtf(d2));
    const float facing = -vec3_dot(out->direction, e.normal);
    if (facing == 0.0f)
        return false;
    out->at_infinity = false;
    out->target = geometry_offset(e.position, facing > 0.0f ? e.normal : vec3_negate(e.normal));
    out->pdf = share * e.pdf * d2 / fabsf(facing);
    out->radiance = vec3_scale(facing > 0.0f ? e.front : e.back, 1.0f / out->pdf);
    return true;
}

/* One sample of the light that rays can also meet by chance: sky or emitters. */
static struct reflected area_light(const struct integrator *it, const struct bsdf *b, struct random *r,
                                   uint64_t *rays)
{
    const float share = it->sky_share;
    struct light_sample light;
    if (share > 0.0f && (share == 1.0f || random_float(r) < share)) {
        sky_sample(&it->lights.sky, r, &light);
        light.pdf *= share;
        light.radiance = vec3_scale(light.radiance, 1.0f / share);
    } else if (!(it->geometry->emitter_power > 0.0f) ||
               !emitter_light(it, b->surface->start, 1.0f - share, r, &light)) {
        return (struct reflected){ 0 };
    }
    return reflect(&(struct blockers){ it->geometry, b->surface->start }, b, &light, r, rays);
}

static struct vec3 found_discs(const struct integrator *it, const struct leg *leg)
{
    return lights_sun_radiance(&it->lights, leg->direction, leg->lamps_total, leg->pdf);
}

static struct vec3 found_sky(const struct integrator *it, const struct leg *leg)
{
    const float share = it->sky_share;
    if (share == 0.0f)
        return sky_radiance(&it->lights.sky, leg->direction);
    const float weight = mis_weight(leg->pdf, share * sky_pdf(&it->lights.sky, leg->direction));
    return vec3_scale(sky_radiance(&it->lights.sky, leg->direction), weight);
}

static struct vec3 found_emission(const struct integrator *it, const struct leg *leg, const struct surface *s)
{
    if (!s->emits)
        return vec3_splat(0.0f);
    const struct vec3 way = vec3_sub(s->position, leg->start);
    const float pdf = (1.0f - it->sky_share) * s->emission_pdf * vec3_dot(way, way);
    return vec3_scale(s->emission, mis_weight(leg->pdf, pdf));
}

static struct ray leg_ray(const struct leg *leg, struct random *r)
{
    return (struct ray){
        .origin = leg->start,
        .direction = leg->direction,
        .length_m = INFINITY,
        .key = random_bits(r),
    };
}

/* Reflect at a surface beyond the first: add the light sampled there, and turn the leg into the next one. */
static bool scatter(const struct integrator *it, const struct surface *s, struct random *r, struct leg *leg,
                    struct vec3 *throughput, struct vec3 *light, uint64_t *rays)
{
    const struct bsdf b = bsdf_make(s, &it->lobe, vec3_negate(leg->direction), 0.0f);
    float total = 0.0f;
    const struct blockers between = { it->geometry, s->start };
    const struct reflected lamps = lamp_light(it, &between, &b, r, &total, rays),
                           areas = area_light(it, &b, r, rays);
    const struct vec3 sampled =
        vec3_add(vec3_add(lamps.diffuse, lamps.specular), vec3_add(areas.diffuse, areas.specular));
    *light = vec3_add(*light, vec3_mul(*throughput, sampled));
    struct bsdf_value v;
    *leg = (struct leg){ .start = s->start, .lamps_total = total };
    if (!bsdf_sample(&b, r, &leg->direction, &v))
        return false;
    leg->pdf = v.pdf;
    *throughput = vec3_mul(*throughput, vec3_scale(vec3_add(v.diffuse, v.specular), 1.0f / v.pdf));
    return vec3_max(*throughput) > 0.0f;
}

/* Ends a path with the chance of what it has lost, and makes up for it in those that go on. */
static bool survives(struct vec3 *throughput, struct random *r)
{
    const float chance = fminf(vec3_max(*throughput), 1.0f);
    if (random_float(r) >= chance)
        return false;
    *throughput = vec3_scale(*throughput, 1.0f / chance);
    return true;
}

/* Light along a leg that leaves the first surface, without the discs of suns that this leg itself meets:
 * those are direct light. */
static struct vec3 arriving_light(const struct integrator *it, struct leg leg, struct random *r,
                                  uint64_t *rays)
{
    struct vec3 light = vec3_splat(0.0f), throughput = vec3_splat(1.0f);
    for (uint32_t bounce = 1;; bounce++) {
        const struct ray ray = leg_ray(&leg, r);
        struct surface s;
        ++*rays;
        if (!geometry_intersect(it->geometry, &ray, &s)) {
            if (bounce > 1)
                light = vec3_add(light, vec3_mul(throughput, found_discs(it, &leg)));
            return vec3_add(light, vec3_mul(throughput, found_sky(it, &leg)));
        }
        light = vec3_add(light, vec3_mul(throughput, found_emission(it, &leg, &s)));
        if (bounce >= it->max_bounces || !scatter(it, &s, r, &leg, &throughput, &light, rays))
            return light;
        if (bounce >= ROULETTE_START && !survives(&throughput, r))
            return light;
    }
}

/* The discs of suns that the first leg meets. */
static struct vec3 direct_discs(const struct integrator *it, const struct blockers *between,
                                const struct leg *leg, struct random *r, uint64_t *rays)
{
    const struct vec3 radiance = found_discs(it, leg);
    const struct light_sample light = { .direction = leg->direction, .at_infinity = true };
    if (!(vec3_max(radiance) > 0.0f) || !is_visible(between, &light, r, rays))
        return vec3_splat(0.0f);
    return radiance;
}

void integrator_first_light(const struct integrator *it, const struct surface *s, struct vec3 towards_viewer,
                            struct random *r, uint64_t *rays, struct first_light *out)
{
    const struct bsdf b = bsdf_make(s, &it->lobe, towards_viewer, it->min_diffuse_share);
    struct leg leg = { .start = s->start };
    const struct blockers between = { it->seen, geometry_offset(s->position, s->geometric_normal) };
    const struct reflected lamps = lamp_light(it, &between, &b, r, &leg.lamps_total, rays);
    const struct reflected areas = area_light(it, &b, r, rays);
    *out = (struct first_light){
        .direct = vec3_add(lamps.diffuse, lamps.specular),
        .diffuse = areas.diffuse,
        .reflection = areas.specular,
        .irradiance = areas.irradiance,
    };
    struct bsdf_value v;
    if (!bsdf_sample(&b, r, &leg.direction, &v))
        return;
    leg.pdf = v.pdf;
    const struct vec3 discs = direct_discs(it, &between, &leg, r, rays);
    const struct vec3 light = vec3_scale(arriving_light(it, leg, r, rays), 1.0f / v.pdf);
    out->diffuse = vec3_add(out->diffuse, vec3_mul(v.diffuse, light));
    out->reflection = vec3_add(out->reflection, vec3_mul(v.specular, light));
    out->irradiance = vec3_add(out->irradiance, vec3_scale(light, v.cosine));
    out->direct =
        vec3_add(out->direct, vec3_scale(vec3_mul(vec3_add(v.diffuse, v.specular), discs), 1.0f / v.pdf));
}

void integrator_path(const struct integrator *it, const struct camera_ray *from, struct random *r,
                     uint64_t *rays, struct path_sample *out)
{
    const struct ray ray = {
        .origin = from->origin,
        .direction = from->direction,
        .length_m = from->length_m,
        .key = random_bits(r),
        .from_camera = true,
    };
    struct surface s;
    *out = (struct path_sample){ 0 };
    ++*rays;
    out->hit = geometry_intersect(it->seen, &ray, &s);
    if (!out->hit) {
        out->emission = sky_radiance(&it->lights.sky, ray.direction);
        return;
    }
    if (s.emits)
        out->emission = s.emission;
    out->position = s.position;
    out->normal = s.normal;
    out->albedo = s.diffuse;
    it->geometry->methods->adopt(it->geometry, &s);
    integrator_first_light(it, &s, vec3_negate(ray.direction), r, rays, &out->light);
}
