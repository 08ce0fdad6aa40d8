/* SPDX-License-Identifier: MIT
 * The exposure that light is stored with. Hosts with automatic exposure give another hint in each frame, and
 * pictures may fade to black; what is stored should neither change with that nor lose anything. Plain
 * arithmetic. */
#ifndef SDFGI_EXPOSURE_H
#define SDFGI_EXPOSURE_H

/* Powers of two. */
struct exposure {
    int hint;   /* about the host's: what is dark in a picture follows from it */
    int stored; /* factor of stored light */
};

/* The exposures after those `before` (NULL: there was no frame), with a host's hint (0: none) and the
 * brightest light of the scene. */
struct exposure sdfgi_exposure_next(const struct exposure *before, float hint, float brightest);

#endif
