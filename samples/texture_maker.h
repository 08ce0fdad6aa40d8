/* SPDX-License-Identifier: MIT
 * Procedural, repeating textures for the sample world. */
#ifndef SAMPLES_TEXTURE_MAKER_H
#define SAMPLES_TEXTURE_MAKER_H

#include "glb_writer.h"

enum texture_kind {
    TEXTURE_GROUND,
    TEXTURE_PLASTER,
    TEXTURE_STONE,
    TEXTURE_TILES,
    TEXTURE_PLANKS,
    TEXTURE_COBBLES,
    TEXTURE_BARK,
    TEXTURE_WOVEN,
    TEXTURE_LEAVES, /* from here on: cut-outs with an alpha channel */
    TEXTURE_NEEDLES,
    TEXTURE_GRASS,
    TEXTURE_KIND_COUNT,
    TEXTURE_NONE = TEXTURE_KIND_COUNT,
};

struct texture_pair {
    glb_handle color;
    glb_handle normal; /* 0 for those without relief */
};

/* Draws the texture and adds it to the file. */
struct texture_pair texture_make(struct glb_writer *writer, enum texture_kind kind, uint32_t seed);

#endif
