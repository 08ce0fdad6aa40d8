/* SPDX-License-Identifier: MIT
 * When light has settled. */
#include "internal.h"

#include <math.h>

/* Stored light is rounded, and rounding can go round in a circle: below this change, so many rings without
 * one that changed clearly less than all before are an end too. */
#define CIRCLING_CHANGE (1.0f / 256.0f)
#define CIRCLING_RINGS  8
#define CLEARLY_LESS    0.9f

void settle_reset(struct settling *s)
{
    *s = (struct settling){ .change = INFINITY, .least = INFINITY };
}

void settle_ring(struct settling *s, float change)
{
    s->change = change;
    s->rings_without_fall++;
    if (change < CLEARLY_LESS * s->least) {
        s->least = change;
        s->rings_without_fall = 0;
    }
}

bool settle_done(const struct settling *s)
{
    return s->change < SDFGI_CONVERGED_CHANGE ||
           (s->change < CIRCLING_CHANGE && s->rings_without_fall >= CIRCLING_RINGS);
}
