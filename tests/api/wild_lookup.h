/* SPDX-License-Identifier: MIT
 * Every lookup that hosts have, at places of the test's choice. */
#ifndef WILD_LOOKUP_H
#define WILD_LOOKUP_H

#include "gi_test.h"

enum { WILD_LOOKUP_ANSWERS = 5 };

/* As wild_lookup.comp has it. */
struct wild_lookup {
    float position[3], roughness, normal[4], to_eye[4];
    float answers[WILD_LOOKUP_ANSWERS][4]; /* two irradiances, a reflection, and the light of the air twice */
};

void wild_lookup_run(struct gi_test *t, struct wild_lookup *lookups, uint32_t count);

#endif
