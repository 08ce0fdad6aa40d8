/* SPDX-License-Identifier: MIT
 * Pictures of a surface that reflects. */
#ifndef MIRROR_H
#define MIRROR_H

#include "gi_test.h"

struct mirror {
    struct gi_test *t;
    struct gpu_test_image depth, normal, roughness;
    sdfgi_view *view;
    struct sdfgi_resolve_desc desc;
    uint32_t width, height;
};

/* A level surface in the plane y = -1, whose pixels cover x and z in [-`half_m`, `half_m`]. All are seen
 * along (1, -1, 0). */
void mirror_open_rough(struct mirror *m, struct gi_test *t, uint32_t width, uint32_t height, float half_m,
                       const float *roughness);
/* The same, a mirror everywhere. */
void mirror_open(struct mirror *m, struct gi_test *t, uint32_t width, uint32_t height, float half_m);
void mirror_close(struct mirror *m);

/* Radiance in channel 1, metres in channel 3. */
void mirror_read(struct mirror *m, uint16_t (*texels)[4]);

#endif
