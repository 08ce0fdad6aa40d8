/* SPDX-License-Identifier: MIT
 * Every lookup that hosts have, at places of the test's choice. */
#ifndef HOST_LOOKUP_H
#define HOST_LOOKUP_H

#include "gi_test.h"

enum { HOST_LOOKUP_ANSWERS = 5 };

/* As host_lookup.comp has it. */
struct host_lookup {
    float position[3], roughness, normal[3], rays, to_eye[4];
    float answers[HOST_LOOKUP_ANSWERS][4]; /* two irradiances, a reflection, and the light of the air twice */
};

void host_lookup_run(struct gi_test *t, struct host_lookup *lookups, uint32_t count);

#endif
