/* SPDX-License-Identifier: MIT
 * What lookups read of a cascade.
 *
 * When a cascade steps, its window loses a slab on one side at once and gains one on the other later. Neither
 * may show. The border therefore recedes with the camera on the side that the next step takes away, so that
 * nothing of it is read any more when it goes; and it advances slowly into what was gained. On the side that
 * the camera leaves it leaves some cells free, so that axes that are due one after the other can step
 * together, some of them past the camera, and a cascade steps hardly more often than its fastest axis alone.
 */
#include "internal.h"

#include <math.h>

/* Borders move hardly faster than the camera: by these shares of its step when they advance, and in addition
 * to it when they leave cells free; but by so many cells a frame at least, for they have to arrive. In a box
 * of 5 m whose light cascades see differently, 0.05 cells change light by 1.1 %. */
#define ADVANCE    1.25
#define LEAVE_FREE 0.25
#define LEAST      0.03
/* A border that lacks more than so many cells belongs to a cascade that was left behind: it makes up for the
 * rest of them in so many frames at its present speed. */
#define FAR        (1.5 * SDFGI_PROBE_SPACING)
#define FAR_FRAMES 32
/* Share of the camera's pace along an axis from which on it leaves a side, and the part of a cascade's width
 * that is left free there: half a spacing at most, which is enough for all axes to step with the fastest. */
#define LEAVING   0.125
#define FREE_PART 32.0

/* Cells by which a border may move in this frame: a share of the camera's step. */
static double speed(const struct sdfgi *gi, uint32_t c, double share)
{
    return fmax(LEAST, share * ldexp(gi->schedule.last_step, -(int)c) * SDFGI_PROBE_SPACING);
}

static double moved(double from, double to, double most)
{
    return from + fmin(fmax(to - from, -most), most);
}

static void leave(struct sdfgi *gi, uint32_t c)
{
    struct cascade *cascade = &gi->cascades[c];
    const double most = fmin(gi->settings.resolution / FREE_PART, SDFGI_PROBE_SPACING / 2.0);
    for (int i = 0; i < 3; i++) {
        const double heading = gi->schedule.heading[i];
        const double wanted = fabs(heading) > LEAVING ? copysign(most, heading) : 0;
        cascade->spare[i] = moved(cascade->spare[i], wanted, speed(gi, c, LEAVE_FREE));
    }
}

/* Outwards as fast as it may, inwards at once. `sign` is its outward direction. */
static double border_moved(double border, double target, double sign, double most)
{
    const double outwards = (target - border) * sign;
    return outwards > 0 ? moved(border, target, fmax(most, (outwards - FAR) / FAR_FRAMES)) : target;
}

static void move(struct sdfgi *gi, uint32_t c)
{
    struct cascade *cascade = &gi->cascades[c];
    const double half = gi->settings.resolution / 2.0,
                 most = cascade->fresh ? INFINITY : speed(gi, c, ADVANCE);
    cascade->share_moves = false;
    for (int i = 0; i < 3; i++) {
        const double at = gi->schedule.camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        const double low = fmax(cascade->window.low[i], at - half + fmax(cascade->spare[i], 0)),
                     high = fmin(cascade->window.high[i], at + half + fmin(cascade->spare[i], 0));
        cascade->share_low[i] = border_moved(cascade->share_low[i], low, -1, most);
        cascade->share_high[i] = border_moved(cascade->share_high[i], high, 1, most);
        cascade->share_moves = cascade->share_moves || cascade->spare[i] != 0 ||
                               cascade->share_low[i] != low || cascade->share_high[i] != high;
    }
}

void border_leave(struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        leave(gi, c);
}

void border_move(struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        move(gi, c);
}

bool border_rests(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->cascades[c].share_moves)
            return false;
    return true;
}
