/* SPDX-License-Identifier: MIT */
#include "lights.h"

#include <stdlib.h>

#include "../gltf/gltf_scene.h"

static struct vec3 relative(const double p[3], const double origin[3])
{
    return vec3_make((float)(p[0] - origin[0]), (float)(p[1] - origin[1]), (float)(p[2] - origin[2]));
}

static float radians(float degrees)
{
    return degrees * (VEC3_PI / 180.0f);
}

/* Half-angle form: the difference itself loses the size of the sun to rounding. */
static float one_minus_cosine(float angle)
{
    const float s = sinf(0.5f * angle);
    return 2.0f * s * s;
}

static void add(struct lights *l, struct lamp lamp)
{
    if (!(vec3_max(lamp.intensity) > 0.0f))
        return;
    lamp.direction = vec3_normalize(lamp.direction);
    l->has_discs = l->has_discs || (lamp.type == LAMP_SUN && lamp.one_minus_cos > 0.0f);
    l->lamps[l->lamp_count++] = lamp;
}

static struct lamp lamp_from_gltf(const struct gltf_light *g, const double origin[3], float scale)
{
    static const enum lamp_type types[] = {
        [GLTF_LIGHT_DIRECTIONAL] = LAMP_SUN,
        [GLTF_LIGHT_POINT] = LAMP_POINT,
        [GLTF_LIGHT_SPOT] = LAMP_SPOT,
    };
    return (struct lamp){
        .type = types[g->type],
        .position = relative(g->position, origin),
        .direction = vec3_load(g->direction),
        .intensity = vec3_scale(vec3_load(g->intensity), scale),
        .cos_inner = cosf(g->inner_rad),
        .cos_outer = cosf(g->outer_rad),
        .range_m = g->range > 0.0f ? g->range : INFINITY,
    };
}

static struct lamp lamp_from_view(const struct raycast_light *v, const double origin[3])
{
    return (struct lamp){
        .type = v->type == RAYCAST_LIGHT_SPOT ? LAMP_SPOT : LAMP_POINT,
        .position = relative(v->position, origin),
        .direction = vec3_load(v->direction),
        .intensity = vec3_load(v->intensity),
        .cos_inner = cosf(radians(v->inner_deg)),
        .cos_outer = cosf(radians(v->outer_deg)),
        .radius_m = v->radius_m,
        .range_m = v->range_m > 0.0f ? v->range_m : INFINITY,
    };
}

bool raycast_lights_init(struct lights *l, const struct gltf_scene *scene, const struct raycast_view *view,
                         const double origin[3])
{
    *l = (struct lights){ 0 };
    l->lamps = calloc((size_t)scene->light_count + view->light_count + 1, sizeof(*l->lamps));
    if (l->lamps == NULL)
        return false;
    add(l, (struct lamp){
               .type = LAMP_SUN,
               .direction = vec3_load(view->sun.direction),
               .intensity = vec3_load(view->sun.irradiance),
               .one_minus_cos = one_minus_cosine(radians(0.5f * view->sun.angle_deg)),
           });
    for (uint32_t i = 0; i < scene->light_count; i++)
        add(l, lamp_from_gltf(&scene->lights[i], origin, view->punctual_scale));
    for (uint32_t i = 0; i < view->light_count; i++)
        add(l, lamp_from_view(&view->lights[i], origin));
    l->sky.zenith = vec3_load(view->sky.zenith);
    l->sky.horizon = vec3_load(view->sky.horizon);
    l->sky.ground = vec3_load(view->sky.ground);
    const bool built = environment_init(&l->sky.map, &view->environment);
    sky_bands_build(&l->sky);
    return built;
}

void raycast_lights_finish(struct lights *l)
{
    environment_finish(&l->sky.map);
    free(l->lamps);
    l->lamps = NULL;
    l->lamp_count = 0;
}

/* saturate((cos t - cos o) / (cos i - cos o))^2 with `cosine` between the axis and the way to the point. */
static float cone(const struct lamp *lamp, float cosine)
{
    if (lamp->type != LAMP_SPOT)
        return 1.0f;
    const float range = fmaxf(lamp->cos_inner - lamp->cos_outer, 1e-6f);
    const float x = clamp01((cosine - lamp->cos_outer) / range);
    return x * x;
}

/* What the lamp gives an unshadowed point; for lamps with a size, an upper bound that leaves out the cosine,
 * since part of them can be above a horizon that their centre is below. */
static float weight(const struct lamp *lamp, struct vec3 position, struct vec3 normal)
{
    const float power = vec3_luminance(lamp->intensity);
    if (lamp->type == LAMP_SUN)
        return lamp->one_minus_cos > 0.0f ? power : power * fmaxf(0.0f, -vec3_dot(lamp->direction, normal));
    const struct vec3 way = vec3_sub(lamp->position, position);
    const float d2 = vec3_dot(way, way), r2 = lamp->radius_m * lamp->radius_m;
    if (!(d2 > 0.0f) || d2 > lamp->range_m * lamp->range_m)
        return 0.0f;
    const float distance = sqrtf(d2), falloff = cone(lamp, -vec3_dot(way, lamp->direction) / distance);
    const float cosine = r2 > 0.0f ? 1.0f : fmaxf(0.0f, vec3_dot(way, normal) / distance);
    return power * falloff * cosine / fmaxf(d2, r2);
}

/* A direction evenly within the cone around `axis`, and its density. */
static struct vec3 sample_cone(struct vec3 axis, float one_minus_cos, struct random *r, float *pdf)
{
    const float down = random_float(r) * one_minus_cos, phi = 2.0f * VEC3_PI * random_float(r);
    const float ring = sqrtf(fmaxf(0.0f, down * (2.0f - down)));
    const struct frame f = frame_around(axis);
    *pdf = 1.0f / (2.0f * VEC3_PI * one_minus_cos);
    return vec3_normalize(frame_to_world(&f, vec3_make(ring * cosf(phi), ring * sinf(phi), 1.0f - down)));
}

/* A disc of irradiance E facing it has E / (pi sin^2) everywhere. */
static struct vec3 disc_radiance(const struct lamp *sun)
{
    const float sin2 = sun->one_minus_cos * (2.0f - sun->one_minus_cos);
    return vec3_scale(sun->intensity, 1.0f / (VEC3_PI * sin2));
}

static void sample_sun(const struct lamp *sun, float chance, struct random *r, struct light_sample *out)
{
    out->at_infinity = true;
    out->direction = vec3_negate(sun->direction);
    out->radiance = vec3_scale(sun->intensity, 1.0f / chance);
    out->pdf = 0.0f;
    if (!(sun->one_minus_cos > 0.0f))
        return;
    float pdf;
    out->direction = sample_cone(out->direction, sun->one_minus_cos, r, &pdf);
    out->pdf = pdf * chance;
    out->radiance = vec3_scale(disc_radiance(sun), 1.0f / out->pdf);
}

/* A sphere of radius r and intensity I has radiance I / (pi r^2); its cone is sampled, and the ray ends where
 * it meets the sphere. */
static void sample_sphere(const struct lamp *lamp, struct vec3 position, struct vec3 way, float chance,
                          struct random *r, struct light_sample *out)
{
    const float distance = vec3_length(way);
    const float radius2 = lamp->radius_m * lamp->radius_m, sin2 = radius2 / (distance * distance);
    const float one_minus_cos = sin2 / (1.0f + sqrtf(1.0f - sin2)); /* keeps small spheres exact */
    float pdf;
    out->direction = sample_cone(vec3_scale(way, 1.0f / distance), one_minus_cos, r, &pdf);
    const float along = vec3_dot(way, out->direction);
    const float depth2 = radius2 - (distance * distance - along * along);
    out->target = vec3_mad(position, out->direction, along - sqrtf(fmaxf(0.0f, depth2)));
    out->radiance = vec3_scale(lamp->intensity, 1.0f / (VEC3_PI * radius2 * pdf * chance));
}

static void sample_lamp(const struct lamp *lamp, struct vec3 position, float chance, struct random *r,
                        struct light_sample *out)
{
    if (lamp->type == LAMP_SUN) {
        sample_sun(lamp, chance, r, out);
        return;
    }
    const struct vec3 way = vec3_sub(lamp->position, position);
    const float distance = vec3_length(way);
    const float falloff = cone(lamp, -vec3_dot(way, lamp->direction) / distance);
    out->at_infinity = false;
    out->pdf = 0.0f;
    if (distance > lamp->radius_m && lamp->radius_m > 0.0f) {
        sample_sphere(lamp, position, way, chance, r, out);
    } else {
        out->direction = vec3_scale(way, 1.0f / distance);
        out->target = lamp->position;
        out->radiance = vec3_scale(lamp->intensity, 1.0f / (distance * distance * chance));
    }
    out->radiance = vec3_scale(out->radiance, falloff);
}

/* One pass keeps lamp i with chance w_i / (w_0 + ... + w_i), which leaves each with w_i / total. */
bool lights_sample(const struct lights *l, struct vec3 position, struct vec3 normal, struct random *r,
                   float *total, struct light_sample *out)
{
    const struct lamp *chosen = NULL;
    float sum = 0.0f, chosen_weight = 0.0f;
    for (uint32_t i = 0; i < l->lamp_count; i++) {
        const float w = weight(&l->lamps[i], position, normal);
        if (!(w > 0.0f))
            continue;
        sum += w;
        if (chosen == NULL || random_float(r) * sum < w) {
            chosen = &l->lamps[i];
            chosen_weight = w;
        }
    }
    *total = sum;
    if (chosen == NULL)
        return false;
    sample_lamp(chosen, position, chosen_weight / sum, r, out);
    return true;
}

struct vec3 lights_sun_radiance(const struct lights *l, struct vec3 direction, float total, float pdf)
{
    struct vec3 sum = vec3_splat(0.0f);
    for (uint32_t i = 0; l->has_discs && i < l->lamp_count; i++) {
        const struct lamp *lamp = &l->lamps[i];
        if (lamp->type != LAMP_SUN || !(lamp->one_minus_cos > 0.0f) || !(total > 0.0f))
            continue;
        const struct vec3 off_axis = vec3_add(lamp->direction, direction);
        if (0.5f * vec3_dot(off_axis, off_axis) > lamp->one_minus_cos)
            continue;
        const float chance = vec3_luminance(lamp->intensity) / total;
        const float light_pdf = chance / (2.0f * VEC3_PI * lamp->one_minus_cos);
        sum = vec3_add(sum, vec3_scale(disc_radiance(lamp), mis_weight(pdf, light_pdf)));
    }
    return sum;
}
