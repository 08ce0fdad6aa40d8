/* SPDX-License-Identifier: MIT */
#include "walk_curve.h"

#include <base/vec.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Chords between neighbouring stations are shorter than their arcs by about 1 in 24 n^2 for a bend of one
 * radian over n of them: 1e-6. The speed is as constant as that. */
enum { STATIONS_PER_SPAN = 200 };

static const double pi = 3.14159265358979323846;
/* Straight up and down have no yaw. */
static const double pitch_limit = 1.5533; /* 89 degrees */

/* ---- Position --------------------------------------------------------------------------------------- */

/* Beyond the ends, the first and last chord go on. */
static void control_point(const struct walk_path *walk, int64_t index, double out[3])
{
    const struct walk_point *points = walk->points;
    const int64_t last = (int64_t)walk->point_count - 1;
    if (index >= 0 && index <= last) {
        memcpy(out, points[index].position, 3 * sizeof(double));
        return;
    }
    const struct walk_point *end = &points[index < 0 ? 0 : last], *inner = &points[index < 0 ? 1 : last - 1];
    for (int i = 0; i < 3; i++)
        out[i] = 2 * end->position[i] - inner->position[i];
}

static void mix(const double a[3], const double b[3], double t_a, double t_b, double t, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = ((t_b - t) * a[i] + (t - t_a) * b[i]) / (t_b - t_a);
}

/* The span from point `span` to the next at `u` in [0, 1], by the pyramid of Barry and Goldman (A recursive
 * evaluation algorithm for a class of Catmull-Rom splines, 1988). Relative to the span's first point, so that
 * a path far from the world's origin has the same shape. */
static void span_position(const struct walk_path *walk, uint32_t span, double u, double out[3])
{
    double p[4][3], t[4] = { 0 }, a[3][3], b[2][3];
    const double *origin = walk->points[span].position;
    for (int i = 0; i < 4; i++)
        control_point(walk, (int64_t)span - 1 + i, p[i]);
    /* Before the shift, which may round neighbours far from the origin to one point. */
    for (int i = 1; i < 4; i++) {
        double chord[3];
        base_vec3d_sub(p[i], p[i - 1], chord);
        t[i] = t[i - 1] + sqrt(base_vec3d_length(chord));
    }
    for (int i = 0; i < 4; i++)
        base_vec3d_sub(p[i], origin, p[i]);
    const double at = t[1] + u * (t[2] - t[1]);
    for (int i = 0; i < 3; i++)
        mix(p[i], p[i + 1], t[i], t[i + 1], at, a[i]);
    for (int i = 0; i < 2; i++)
        mix(a[i], a[i + 1], t[i], t[i + 2], at, b[i]);
    mix(b[0], b[1], t[1], t[2], at, out);
    for (int i = 0; i < 3; i++)
        out[i] += origin[i];
}

static void measure_positions(struct walk_path *walk)
{
    for (uint32_t i = 0; i < walk->station_count; i++) {
        const uint32_t last_span = walk->point_count - 2;
        const uint32_t span = i / STATIONS_PER_SPAN < last_span ? i / STATIONS_PER_SPAN : last_span;
        struct walk_station *station = &walk->stations[i];
        span_position(walk, span, (double)(i - span * STATIONS_PER_SPAN) / STATIONS_PER_SPAN,
                      station->position);
        if (i == 0)
            continue;
        double chord[3];
        base_vec3d_sub(station->position, station[-1].position, chord);
        station->distance_m = station[-1].distance_m + base_vec3d_length(chord);
    }
    walk->length_m = walk->stations[walk->station_count - 1].distance_m;
}

/* ---- Direction -------------------------------------------------------------------------------------- */

struct heading {
    double yaw, pitch;
};

static struct heading heading_of(const double from[3], const double to[3])
{
    double d[3];
    base_vec3d_sub(to, from, d);
    const double level = hypot(d[0], d[2]);
    return (struct heading){ level > 0 ? atan2(d[0], -d[2]) : 0,
                             fmin(fmax(atan2(d[1], level), -pitch_limit), pitch_limit) };
}

static struct heading heading_along(const struct walk_path *walk, uint32_t station)
{
    const uint32_t before = station > 0 ? station - 1 : 0;
    const uint32_t after = station + 1 < walk->station_count ? station + 1 : station;
    return heading_of(walk->stations[before].position, walk->stations[after].position);
}

static struct heading heading_at_point(const struct walk_path *walk, uint32_t point, uint32_t station)
{
    const struct walk_point *p = &walk->points[point];
    return p->looks ? heading_of(p->position, p->look_at) : heading_along(walk, station);
}

/* The turn from `a` to `b` the short way round. */
static double turn(double a, double b)
{
    return remainder(b - a, 2 * pi);
}

static struct heading heading_here(const struct walk_path *walk, uint32_t station)
{
    if (walk->looks)
        return heading_of(walk->stations[station].position, walk->look_at);
    const uint32_t last_span = walk->point_count - 2;
    const uint32_t span = station / STATIONS_PER_SPAN < last_span ? station / STATIONS_PER_SPAN : last_span;
    const double u = (double)(station - span * STATIONS_PER_SPAN) / STATIONS_PER_SPAN;
    const double share = u * u * (3 - 2 * u);
    const struct heading a = heading_at_point(walk, span, station);
    const struct heading b = heading_at_point(walk, span + 1, station);
    return (struct heading){ a.yaw + share * turn(a.yaw, b.yaw), a.pitch + share * (b.pitch - a.pitch) };
}

static void measure_headings(struct walk_path *walk)
{
    for (uint32_t i = 0; i < walk->station_count; i++) {
        struct walk_station *station = &walk->stations[i];
        const struct heading heading = heading_here(walk, i);
        station->yaw = i > 0 ? station[-1].yaw + turn(station[-1].yaw, heading.yaw) : heading.yaw;
        station->pitch = heading.pitch;
    }
}

/* Integrals of yaw and pitch along the way, from which the mean over any stretch follows at once. */
static struct heading *headings_integrate(const struct walk_path *walk)
{
    struct heading *sum = calloc(walk->station_count, sizeof *sum);
    for (uint32_t i = 1; sum && i < walk->station_count; i++) {
        const struct walk_station *s = &walk->stations[i];
        const double step_m = s->distance_m - s[-1].distance_m;
        sum[i].yaw = sum[i - 1].yaw + 0.5 * step_m * (s->yaw + s[-1].yaw);
        sum[i].pitch = sum[i - 1].pitch + 0.5 * step_m * (s->pitch + s[-1].pitch);
    }
    return sum;
}

/* The first station at `distance_m` or further, but not the very first. */
static uint32_t station_after(const struct walk_path *walk, double distance_m)
{
    uint32_t low = 1, high = walk->station_count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (walk->stations[middle].distance_m < distance_m)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The integrals up to `distance_m`. */
static struct heading headings_until(const struct walk_path *walk, const struct heading *sum,
                                     double distance_m)
{
    const uint32_t index = station_after(walk, distance_m) - 1;
    const struct walk_station *a = &walk->stations[index], *b = a + 1;
    const double step_m = b->distance_m - a->distance_m, into_m = distance_m - a->distance_m;
    const double share = step_m > 0 ? into_m / step_m : 0;
    return (struct heading){ sum[index].yaw + into_m * (a->yaw + 0.5 * share * (b->yaw - a->yaw)),
                             sum[index].pitch + into_m * (a->pitch + 0.5 * share * (b->pitch - a->pitch)) };
}

/* Each heading becomes the mean over `smooth_m` around it, less where an end of the path is near. */
static bool smooth_headings(struct walk_path *walk)
{
    if (walk->smooth_m <= 0)
        return true;
    struct heading *sum = headings_integrate(walk);
    struct heading *smooth = calloc(walk->station_count, sizeof *smooth);
    for (uint32_t i = 0; sum && smooth && i < walk->station_count; i++) {
        const struct walk_station *station = &walk->stations[i];
        const double here_m = station->distance_m;
        const double half_m = fmin(0.5 * walk->smooth_m, fmin(here_m, walk->length_m - here_m));
        smooth[i] = (struct heading){ station->yaw, station->pitch };
        /* Over less, rounding of the integrals would outweigh their difference. */
        if (half_m < 1e-6)
            continue;
        const struct heading from = headings_until(walk, sum, here_m - half_m);
        const struct heading to = headings_until(walk, sum, here_m + half_m);
        smooth[i].yaw = (to.yaw - from.yaw) / (2 * half_m);
        smooth[i].pitch = (to.pitch - from.pitch) / (2 * half_m);
    }
    for (uint32_t i = 0; sum && smooth && i < walk->station_count; i++) {
        walk->stations[i].yaw = smooth[i].yaw;
        walk->stations[i].pitch = smooth[i].pitch;
    }
    const bool complete = sum && smooth;
    free(sum);
    free(smooth);
    return complete;
}

/* ---- The whole -------------------------------------------------------------------------------------- */

bool walk_curve_measure(struct walk_path *walk)
{
    walk->station_count = (walk->point_count - 1) * STATIONS_PER_SPAN + 1;
    walk->stations = calloc(walk->station_count, sizeof *walk->stations);
    if (!walk->stations)
        return false;
    measure_positions(walk);
    measure_headings(walk);
    return smooth_headings(walk);
}

void walk_path_camera(const struct walk_path *walk, double distance_m, struct host_camera *camera)
{
    const double at_m = fmin(fmax(distance_m, 0), walk->length_m);
    const struct walk_station *b = &walk->stations[station_after(walk, at_m)], *a = b - 1;
    const double step_m = b->distance_m - a->distance_m;
    const double share = step_m > 0 ? (at_m - a->distance_m) / step_m : 0;
    const double yaw = a->yaw + share * (b->yaw - a->yaw), pitch = a->pitch + share * (b->pitch - a->pitch);
    const double forward[3] = { sin(yaw) * cos(pitch), sin(pitch), -cos(yaw) * cos(pitch) };
    *camera = (struct host_camera){ .up = { 0, 1, 0 }, .yfov_rad = walk->yfov_rad };
    for (int i = 0; i < 3; i++) {
        camera->position[i] = a->position[i] + share * (b->position[i] - a->position[i]);
        camera->look_at[i] = camera->position[i] + forward[i];
    }
}
