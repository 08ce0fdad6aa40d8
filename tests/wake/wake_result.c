/* SPDX-License-Identifier: MIT */
#include "wake_result.h"

#include "light_scene.h"
#include "require.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

/* Light settles where a cycle changes it by less than 1/1024. What is still missing is up to g / (1 - g) as
 * much, where g is the gain of a bounce: 0.15 % with albedos of 0.6 at most. One context comes to it from
 * above and the other from below, and both round light to 9 bits, which the same gain makes more of: 0.5 %.
 */
#define TOLERANCE 0.01
/* Points that are darker than this part of the brightest are compared with that part: what they see is the
 * light of a few cells, whose rounding no others make up for. */
#define DARK_PART 0.05
/* sdfgi_frame_desc::exposure promises light down to this over it: radiance. Lookups return pi times as much,
 * and sdfgi_energy times that. */
#define DARK (PI / 4096)
/* A unit of RGB9E5 is at most this part of the brightest channel. Two colours that round apart differ by one
 * in their weak channels (docs/hard_cases.md, row 29), however little they differed before. */
#define UNIT (1.001 / 256)

/* Borders of what lookups sample arrive last (modules/sdfgi/volume/blend.c): 12 cells at 0.03 a frame, after
 * 32 frames for the rest. Light that settles beside them takes a few dozen. */
enum { FRAMES_MOST = 500, FRAMES_IDLE = 3, FLOOR_POINTS = 25, WALL_POINTS = 12, AIR_POINTS = 27 };

/* ---- Points: on the floor, along two walls, and in the air of the room and around it */

static void floor_point(int i, struct gi_test_point *p)
{
    *p = (struct gi_test_point){ { 0.8f * (float)(i % 5 - 2) + 0.07f, -1.7f, 0.8f * (float)(i / 5 - 2) },
                                 { 0, 1, 0 } };
}

static void wall_point(int i, struct gi_test_point *p)
{
    const float along = 0.9f * (float)(i % 4) - 1.3f, up = 0.8f * (float)(i / 4 % 3) - 1.2f;
    *p = (struct gi_test_point){ { -2, up, along }, { 1, 0, 0 } };
}

static void air_point(int i, struct gi_test_point *p)
{
    static const float normals[3][3] = { { 0, 1, 0 }, { 0.6f, 0, 0.8f }, { -0.6f, -0.8f, 0 } };
    *p = (struct gi_test_point){
        { 1.4f * (float)(i % 3 - 1), 1.2f * (float)(i / 3 % 3 - 1), 1.4f * (float)(i / 9 - 1) }, { 0 }
    };
    memcpy(p->normal, normals[i % 3], sizeof p->normal);
}

static struct gi_test_point point_of(int i)
{
    struct gi_test_point p;
    if (i < FLOOR_POINTS) {
        floor_point(i, &p);
    } else if (i < FLOOR_POINTS + WALL_POINTS) {
        wall_point(i - FLOOR_POINTS, &p);
    } else if (i < FLOOR_POINTS + WALL_POINTS + AIR_POINTS) {
        air_point(i - FLOOR_POINTS - WALL_POINTS, &p);
    } else {
        /* Outside, in reach of the second cascade alone. */
        const int k = i - FLOOR_POINTS - WALL_POINTS - AIR_POINTS;
        p = (struct gi_test_point){ { 4.9f * (float)(k % 2 ? 1 : -1), 0.9f * (float)(k / 2) - 1.5f, 3.1f },
                                    { 0, k % 3 ? 1.0f : -1.0f, 0 } };
    }
    return p;
}

static void look(struct wake_result *result, struct wake_device *device, const struct wake_world *world)
{
    struct gi_test_point points[WAKE_POINTS];
    for (int i = 0; i < WAKE_POINTS; i++) {
        points[i] = point_of(i);
        for (int k = 0; k < 3; k++)
            points[i].position[k] = (float)((double)points[i].position[k] - world->frame.origin[k]);
    }
    gi_test_lookup(&device->t, sdfgi_get_descriptor_set(device->t.gi), NULL, points, WAKE_POINTS,
                   result->light);
}

/* ---- Settling */

static bool is_settled(const struct wake_device *device, bool enabled)
{
    static struct sdfgi_report report;
    sdfgi_get_report(device->t.gi, &report);
    return enabled ? report.converged : !report.active;
}

static bool is_idle(const struct wake_device *device)
{
    static struct sdfgi_report report;
    sdfgi_get_report(device->t.gi, &report);
    return report.command_count == 0;
}

static bool settle(struct wake_result *result, struct wake_device *device, bool enabled)
{
    do {
        gi_test_update(&device->t, 2);
        result->frames += 2;
    } while (!is_settled(device, enabled) && result->frames < FRAMES_MOST);
    bool idle = is_settled(device, enabled);
    for (int i = 0; i < FRAMES_IDLE; i++) {
        gi_test_update(&device->t, 1);
        idle = idle && is_idle(device) && is_settled(device, enabled);
    }
    return idle;
}

/* ---- Copies */

static const enum resource whole[] = { RESOURCE_BITS,     RESOURCE_DISTANCE, RESOURCE_ALBEDO,
                                       RESOURCE_EMISSION, RESOURCE_NORMALS,  RESOURCE_LIGHT_BLOCKS },
                           others[] = { RESOURCE_PROBES,   RESOURCE_LIGHT_CELLS, RESOURCE_DIRECT,
                                        RESOURCE_COUNTERS, RESOURCE_MASKS,       RESOURCE_OCCLUSION };
#define COUNT(array) (sizeof(array) / sizeof *(array))

static void copy(struct wake_result *result, struct wake_device *device, enum resource resource)
{
    result->data[resource] = gi_test_read(&device->t, resource, &result->size[resource]);
}

static void copy_volumes(struct wake_result *result, struct wake_device *device)
{
    const struct volume *volume = &device->t.gi->volume;
    for (size_t i = 0; i < COUNT(whole); i++)
        copy(result, device, whole[i]);
    for (size_t i = 0; i < COUNT(others); i++)
        copy(result, device, others[i]);
    for (uint32_t c = 0; c < volume->state.cascades.count; c++)
        memcpy(result->origins[c], volume->state.cascades.at[c].origin, sizeof result->origins[c]);
    result->room = volume->resources->extent.light_cells;
    result->exposure = volume->state.exposure.stored;
}

void wake_result_take(struct wake_result *result, struct wake_device *device, struct wake_context *context,
                      const struct wake_world *world)
{
    memset(result, 0, sizeof *result);
    device->t.gi = context->gi;
    device->t.frame = world->frame;
    result->settings = world->settings;
    result->active = world->settings.enabled;
    const double exposure = world->frame.exposure > 0 ? (double)world->frame.exposure : 1;
    result->dark = DARK / exposure * (double)world->settings.energy;
    result->settles = settle(result, device, result->active);
    if (result->active)
        copy_volumes(result, device);
    look(result, device, world);
}

void wake_result_free(struct wake_result *result)
{
    for (int i = 0; i < RESOURCE_COUNT; i++)
        free(result->data[i]);
    memset(result, 0, sizeof *result);
}

/* ---- Places */

void wake_context_place_as(struct wake_context *context, const struct wake_context *other)
{
    struct cascades *to = &context->gi->volume.state.cascades;
    const struct cascades *from = &other->gi->volume.state.cascades;
    for (uint32_t c = 0; c < to->count; c++) {
        memcpy(to->at[c].origin, from->at[c].origin, sizeof to->at[c].origin);
        to->at[c].place = CASCADE_OUTDATED;
    }
}

bool wake_result_placed_alike(const struct wake_result *a, const struct wake_result *b)
{
    return memcmp(a->origins, b->origins, sizeof a->origins) == 0;
}

/* ---- Comparisons of volumes */

static bool differ(char text[static WAKE_TEXT], enum resource resource, uint64_t place, uint32_t found,
                   uint32_t fresh)
{
    snprintf(text, WAKE_TEXT, "%s differs first at word %llu: %#x, fresh %#x",
             sdfgi_resource_row(resource)->name, (unsigned long long)place, found, fresh);
    return false;
}

/* Words of which a mask tells what counts. */
static bool same_words(const struct wake_result *a, const struct wake_result *b, enum resource resource,
                       uint32_t mask, char text[static WAKE_TEXT])
{
    if (a->size[resource] != b->size[resource]) {
        snprintf(text, WAKE_TEXT, "%s: %llu bytes, fresh %llu", sdfgi_resource_row(resource)->name,
                 (unsigned long long)a->size[resource], (unsigned long long)b->size[resource]);
        return false;
    }
    const uint32_t *x = (const uint32_t *)(void *)a->data[resource],
                   *y = (const uint32_t *)(void *)b->data[resource];
    for (uint64_t i = 0; i < a->size[resource] / 4; i++)
        if ((x[i] ^ y[i]) & mask)
            return differ(text, resource, i, x[i], y[i]);
    return true;
}

/* Colours of shared exponent whose mantissas differ by one unit of the larger exponent at most. */
static bool same_color(uint32_t a, uint32_t b)
{
    const int x = (int)(a >> 27), y = (int)(b >> 27), most = x > y ? x : y;
    for (int shift = 0; shift < 27; shift += 9) {
        const double p = ldexp(a >> shift & 511, x - most), q = ldexp(b >> shift & 511, y - most);
        if (fabs(p - q) > 1)
            return false;
    }
    return true;
}

/* The bits of lights depend on the order in which these were made. */
static bool same_direct(const struct gi_test_direct *a, const struct gi_test_direct *b,
                        enum wake_direct direct)
{
    if (direct == WAKE_DIRECT_ANY)
        return true;
    return (direct == WAKE_DIRECT_EXACT ? a->color == b->color : same_color(a->color, b->color)) &&
           a->axes == b->axes;
}

static const uint32_t *words_of(const struct wake_result *result, enum resource resource)
{
    return (const uint32_t *)(void *)result->data[resource];
}

static bool same_cells(const struct wake_result *a, const struct wake_result *b, enum wake_direct direct,
                       char text[static WAKE_TEXT])
{
    const uint32_t *counters = words_of(b, RESOURCE_COUNTERS);
    for (uint32_t c = 0; c < a->settings.cascades; c++)
        for (uint64_t i = 0; i < counters[SDFGI_COUNTER_LIGHT_CELLS + c]; i++) {
            const uint32_t x = words_of(a, RESOURCE_LIGHT_CELLS)[c * a->room + i],
                           y = words_of(b, RESOURCE_LIGHT_CELLS)[c * b->room + i];
            const struct gi_test_direct p = gi_test_direct_at(words_of(a, RESOURCE_DIRECT), a->room, c, i),
                                        q = gi_test_direct_at(words_of(b, RESOURCE_DIRECT), b->room, c, i);
            if (x != y)
                return differ(text, RESOURCE_LIGHT_CELLS, i, x, y);
            if (!same_direct(&p, &q, direct))
                return differ(text, RESOURCE_DIRECT, i, p.color, q.color);
        }
    return true;
}

/* Depths around probes that are dead are not read. */
static bool same_depths(const struct wake_result *a, const struct wake_result *b, char text[static WAKE_TEXT])
{
    enum { WORDS = SDFGI_OCCLUSION_STRIDE * SDFGI_OCCLUSION_STRIDE };
    const uint32_t *x = (const uint32_t *)(void *)a->data[RESOURCE_OCCLUSION],
                   *y = (const uint32_t *)(void *)b->data[RESOURCE_OCCLUSION],
                   *states = (const uint32_t *)(void *)b->data[RESOURCE_PROBES];
    for (uint64_t i = 0; i < a->size[RESOURCE_OCCLUSION] / 4; i++)
        if (x[i] != y[i] && !(states[i / WORDS] & SDFGI_PROBE_DEAD))
            return differ(text, RESOURCE_OCCLUSION, i, x[i], y[i]);
    return true;
}

static bool same_volumes(const struct wake_result *a, const struct wake_result *b, enum wake_direct direct,
                         char text[static WAKE_TEXT])
{
    for (size_t i = 0; i < COUNT(whole); i++)
        if (!same_words(a, b, whole[i], UINT32_MAX, text))
            return false;
    if (!same_words(a, b, RESOURCE_PROBES, ~SDFGI_PROBE_NEW, text) || !same_cells(a, b, direct, text))
        return false;
    if (!a->settings.use_occlusion)
        return true;
    return a->settings.visibility == SDFGI_VISIBILITY_PROBE_DEPTH
               ? same_depths(a, b, text)
               : same_words(a, b, RESOURCE_MASKS, UINT32_MAX, text);
}

/* ---- Comparisons of light */

static double brightest(const struct wake_result *r)
{
    double most = 0;
    for (int i = 0; i < 3 * WAKE_POINTS; i++)
        most = fmax(most, (double)r->light[i / 3][i % 3]);
    return most;
}

static double unit_at(const struct wake_result *r, int point)
{
    const float *c = r->light[point];
    return UNIT * (double)fmaxf(c[0], fmaxf(c[1], c[2]));
}

static double allowed(const struct wake_result *a, const struct wake_result *b, int i)
{
    const double x = (double)a->light[i / 3][i % 3], y = (double)b->light[i / 3][i % 3];
    const double dark = fmax(DARK_PART * brightest(b), fmax(a->dark, b->dark));
    return fmax(TOLERANCE * fmax(fmax(x, y), dark), unit_at(b, i / 3));
}

static double light_off(const struct wake_result *a, const struct wake_result *b, int i)
{
    const double x = (double)a->light[i / 3][i % 3], y = (double)b->light[i / 3][i % 3];
    const double off = fabs(x - y) / fmax(allowed(a, b, i), 1e-30);
    return x == y ? 0 : isnan(off) ? (double)INFINITY : off;
}

/* Largest difference over what is allowed. */
static double worst_off(const struct wake_result *a, const struct wake_result *b)
{
    double worst = 0;
    for (int i = 0; i < 3 * WAKE_POINTS; i++)
        worst = fmax(worst, light_off(a, b, i));
    return worst;
}

static bool same_light(const struct wake_result *a, const struct wake_result *b, char text[static WAKE_TEXT])
{
    for (int i = 0; i < 3 * WAKE_POINTS; i++)
        if (light_off(a, b, i) > 1) {
            snprintf(text, WAKE_TEXT, "light of point %d, channel %d: %g, fresh %g, %.1f times off", i / 3,
                     i % 3, (double)a->light[i / 3][i % 3], (double)b->light[i / 3][i % 3], worst_off(a, b));
            return false;
        }
    return true;
}

bool wake_result_same(const struct wake_result *found, const struct wake_result *fresh,
                      enum wake_direct direct, char text[static WAKE_TEXT])
{
    if (!found->settles || !fresh->settles) {
        snprintf(text, WAKE_TEXT, "%s after %u frames, or it is not idle",
                 found->settles ? "the fresh one has not settled" : "it has not settled",
                 found->settles ? fresh->frames : found->frames);
        return false;
    }
    const enum wake_direct known = found->exposure == fresh->exposure ? direct : WAKE_DIRECT_ANY;
    if (found->active && !same_volumes(found, fresh, known, text))
        return false;
    return same_light(found, fresh, text);
}
