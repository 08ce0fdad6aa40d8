/* SPDX-License-Identifier: MIT
 * A contact sheet of moments: each a picture without GI above the same with it. */
#ifndef RUNTIME_WALK_SHEET_H
#define RUNTIME_WALK_SHEET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct walk_sheet {
    uint32_t columns, rows; /* of moments */
    uint32_t shrink;        /* texels of a picture along each side of a texel of the sheet */
    uint32_t picture_width, picture_height;
    uint32_t tile_width, tile_height;
    uint32_t width, height;
    uint8_t *rgba;
};

/* For `moments` pairs of pictures of `width` x `height`. False when memory runs out. */
bool walk_sheet_init(struct walk_sheet *sheet, uint32_t moments, uint32_t width, uint32_t height);
void walk_sheet_finish(struct walk_sheet *sheet); /* accepts a zeroed sheet */

/* Shrinks a picture of the size given to walk_sheet_init into its place. */
void walk_sheet_add(struct walk_sheet *sheet, uint32_t moment, bool gi, const uint8_t *rgba);

#endif
