/* SPDX-License-Identifier: MIT */
#include "exposure.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Powers of two. Formats hold light of 2^-14 to 2^16 well: what is stored with another exposure than the
 * hint's keeps its precision if the two are no further apart than this. */
#define APART 8
/* The brightest stored light: light that surfaces throw to and fro may be twice as bright. */
#define HIGHEST 15
/* Farthest exposure that light is stored with: times any light that makes sense, it fits a float. */
#define FARTHEST 40

static int clamp(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* The power of two above a light; 0 for none. */
static int power_above(float light)
{
    return light > 0 ? clamp(ilogbf(light), -FARTHEST, FARTHEST) + 1 : 0;
}

struct exposure sdfgi_exposure_next(const struct exposure *before, float hint, float brightest)
{
    const int asked = clamp(ilogbf(hint > 0 ? hint : 1.0f), -FARTHEST, FARTHEST),
              above = power_above(brightest);
    /* More would cut the brightest light; less gains nothing, and loses the dimmest. */
    const int high = HIGHEST - above, low = above > 0 ? -above : 0;
    const bool known = before && abs(asked - before->hint) <= APART;
    struct exposure next = { .hint = known ? before->hint : asked };
    const bool stays =
        before && before->stored >= low && before->stored <= high && abs(before->stored - next.hint) <= APART;
    next.stored = stays ? before->stored : clamp(next.hint, low, high);
    return next;
}
