/* SPDX-License-Identifier: MIT
 *
 * Which share of uniform light the GGX lobe of perfect facets reflects. It is below 1: the lobe has light
 * that leaves the first facet it meets, and none that goes on to a second one.
 */
#ifndef RAYCAST_LOBE_H
#define RAYCAST_LOBE_H

/* Linear interpolation between this many steps is within 0.2 % of the integral. */
enum { LOBE_STEPS = 31 };

struct lobe {
    float shares[LOBE_STEPS + 1][LOBE_STEPS + 1]; /* by roughness, then by cosine; see lobe.c */
};

void lobe_init(struct lobe *lobe);

/* In a direction with this cosine to the normal, (0, 1]. */
float lobe_share(const struct lobe *lobe, float cosine, float alpha);

#endif
