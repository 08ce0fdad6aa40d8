/* SPDX-License-Identifier: MIT */
#include "view_raster.h"

#include <math.h>
#include <string.h>

enum { CLIPPED_MAX = 4 };

/* The part of a triangle beyond the near plane: three or four corners, or none. */
static int clip_near(double in[3][3], double near_m, double out[CLIPPED_MAX][3])
{
    int count = 0;
    for (int i = 0; i < 3; i++) {
        const double *const a = in[i], *const b = in[(i + 1) % 3];
        if (a[2] >= near_m)
            memcpy(out[count++], a, 3 * sizeof *a);
        if ((a[2] >= near_m) == (b[2] >= near_m))
            continue;
        const double t = (near_m - a[2]) / (b[2] - a[2]);
        for (int k = 0; k < 3; k++)
            out[count][k] = a[k] + t * (b[k] - a[k]);
        count++;
    }
    return count;
}

/* A corner in pixels, and how near it is. */
struct corner {
    double x, y, nearness;
};

static struct corner project(const struct view_eye *eye, const double p[3])
{
    const double half = 0.5 * VIEW_RASTER_SIDE;
    return (struct corner){ half + half * p[0] / (eye->tan_x * p[2]),
                            half - half * p[1] / (eye->tan_y * p[2]), 1 / p[2] };
}

static double side_of(const struct corner *a, const struct corner *b, double x, double y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static int pixel_from(double x)
{
    return (int)fmin(fmax(ceil(x - 0.5), 0), VIEW_RASTER_SIDE);
}

static void fill_row(struct view_raster *raster, const struct corner c[3], double area, int y, uint32_t what)
{
    const double least = fmin(fmin(c[0].x, c[1].x), c[2].x), most = fmax(fmax(c[0].x, c[1].x), c[2].x);
    for (int x = pixel_from(least); x < pixel_from(most); x++) {
        double share[3], nearness = 0;
        for (int i = 0; i < 3; i++) {
            share[i] = side_of(&c[(i + 1) % 3], &c[(i + 2) % 3], x + 0.5, y + 0.5) / area;
            nearness += share[i] * c[i].nearness;
        }
        float *const pixel = &raster->nearness[y * VIEW_RASTER_SIDE + x];
        if (share[0] < 0 || share[1] < 0 || share[2] < 0 || nearness <= (double)*pixel)
            continue;
        *pixel = (float)nearness;
        raster->what[y * VIEW_RASTER_SIDE + x] = what;
    }
}

static void fill(struct view_raster *raster, const struct corner c[3], uint32_t what)
{
    const double area = side_of(&c[0], &c[1], c[2].x, c[2].y);
    if (area == 0 || !isfinite(area))
        return;
    const double least = fmin(fmin(c[0].y, c[1].y), c[2].y), most = fmax(fmax(c[0].y, c[1].y), c[2].y);
    for (int y = pixel_from(least); y < pixel_from(most); y++)
        fill_row(raster, c, area, y, what);
}

void view_raster_triangle(struct view_raster *raster, const struct view_eye *eye, double corners[3][3],
                          double near_m, uint32_t what)
{
    double clipped[CLIPPED_MAX][3];
    const int count = clip_near(corners, near_m, clipped);
    for (int i = 1; i + 1 < count; i++) {
        const struct corner c[3] = { project(eye, clipped[0]), project(eye, clipped[i]),
                                     project(eye, clipped[i + 1]) };
        fill(raster, c, what);
    }
}
