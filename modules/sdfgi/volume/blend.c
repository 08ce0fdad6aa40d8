/* SPDX-License-Identifier: MIT */
#include "blend.h"

#include <math.h>

/* Borders move hardly faster than the camera: by these fractions of its way when they advance, and in
 * addition to it when they leave cells free. They move by so many cells a frame at least, because they have
 * to arrive. In a box of 5 m whose light cascades see differently, 0.05 cells change light by 1.1 %. */
#define ADVANCE    1.25
#define LEAVE_FREE 0.25
#define LEAST      0.03
/* A border that lacks more than so many cells belongs to a cascade that was left behind: it makes up for the
 * rest of them in so many frames at its present speed. */
#define FAR        (1.5 * SDFGI_PROBE_SPACING)
#define FAR_FRAMES 32
/* Fraction of the camera's pace along an axis from which on it leaves a side, and the part of a cascade's
 * width that is left free there: half a spacing at most, which is enough for all axes to scroll with the
 * fastest. */
#define LEAVING   0.125
#define FREE_PART 32.0

/* Cells by which a border may move in this frame: a fraction of the camera's way. */
static double speed(const struct scroll *scroll, uint32_t c, double fraction)
{
    return fmax(LEAST, fraction * ldexp(scroll->moved, -(int)c) * SDFGI_PROBE_SPACING);
}

static double moved(double from, double to, double most)
{
    return from + fmin(fmax(to - from, -most), most);
}

static void reserve(struct cascade *cascade, uint32_t c, const struct scroll *scroll, uint32_t resolution)
{
    const double most = fmin(resolution / FREE_PART, SDFGI_PROBE_SPACING / 2.0);
    for (int i = 0; i < 3; i++) {
        const double heading = scroll->heading[i];
        const double wanted = fabs(heading) > LEAVING ? copysign(most, heading) : 0;
        cascade->spare[i] = moved(cascade->spare[i], wanted, speed(scroll, c, LEAVE_FREE));
    }
}

void sdfgi_blend_reserve(struct cascades *cascades, const struct scroll *scroll)
{
    for (uint32_t c = 0; c < cascades->count; c++)
        reserve(&cascades->at[c], c, scroll, cascades->resolution);
}

/* Outwards as fast as it may, inwards at once. `sign` is its outward direction. */
static double border_moved(double border, double target, double sign, double most)
{
    const double outwards = (target - border) * sign;
    return outwards > 0 ? moved(border, target, fmax(most, (outwards - FAR) / FAR_FRAMES)) : target;
}

/* Returns true if a border has not arrived. */
static bool move(struct cascade *cascade, const struct scroll *scroll, uint32_t resolution, double most)
{
    const double half = resolution / 2.0;
    bool moves = false;
    for (int i = 0; i < 3; i++) {
        const double at = scroll->camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        const double low = fmax(cascade->valid.low[i], at - half + fmax(cascade->spare[i], 0)),
                     high = fmin(cascade->valid.high[i], at + half + fmin(cascade->spare[i], 0));
        cascade->blend_low[i] = border_moved(cascade->blend_low[i], low, -1, most);
        cascade->blend_high[i] = border_moved(cascade->blend_high[i], high, 1, most);
        moves =
            moves || cascade->spare[i] != 0 || cascade->blend_low[i] != low || cascade->blend_high[i] != high;
    }
    return moves;
}

void sdfgi_blend_move(struct cascades *cascades, struct scroll *scroll, bool jumps)
{
    scroll->blends_moving = 0;
    for (uint32_t c = 0; c < cascades->count; c++)
        scroll->blends_moving += move(&cascades->at[c], scroll, cascades->resolution,
                                      jumps || cascades->at[c].cut ? INFINITY : speed(scroll, c, ADVANCE));
}
