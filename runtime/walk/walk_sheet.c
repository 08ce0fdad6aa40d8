/* SPDX-License-Identifier: MIT */
#include "walk_sheet.h"

#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 4, TILE_WIDTH_MAX = 480, PAIR_GAP = 1, GAP = 6, BACKGROUND = 24 };

bool walk_sheet_init(struct walk_sheet *sheet, uint32_t moments, uint32_t width, uint32_t height)
{
    *sheet = (struct walk_sheet){ .columns = moments < COLUMNS ? moments : COLUMNS,
                                  .picture_width = width,
                                  .picture_height = height };
    sheet->rows = (moments + sheet->columns - 1) / sheet->columns;
    sheet->shrink = (width + TILE_WIDTH_MAX - 1) / TILE_WIDTH_MAX;
    sheet->tile_width = width / sheet->shrink;
    /* A picture far wider than high still has a row of texels. */
    sheet->tile_height = height > sheet->shrink ? height / sheet->shrink : 1;
    sheet->width = sheet->columns * (sheet->tile_width + GAP) + GAP;
    sheet->height = sheet->rows * (2 * sheet->tile_height + PAIR_GAP + GAP) + GAP;
    const size_t bytes = (size_t)4 * sheet->width * sheet->height;
    sheet->rgba = malloc(bytes);
    if (sheet->rgba)
        memset(sheet->rgba, BACKGROUND, bytes);
    return sheet->rgba != NULL;
}

void walk_sheet_finish(struct walk_sheet *sheet)
{
    free(sheet->rgba);
    *sheet = (struct walk_sheet){ 0 };
}

/* The mean of the encoded values: what a viewer does who shrinks the picture. */
static void texel_average(const struct walk_sheet *sheet, const uint8_t *rgba, uint32_t stride, uint32_t rows,
                          uint8_t *out)
{
    for (uint32_t c = 0; c < 4; c++) {
        uint32_t sum = 0;
        for (uint32_t y = 0; y < rows; y++)
            for (uint32_t x = 0; x < sheet->shrink; x++)
                sum += rgba[4 * ((size_t)y * stride + x) + c];
        const uint32_t count = rows * sheet->shrink;
        out[c] = (uint8_t)((sum + count / 2) / count);
    }
}

void walk_sheet_add(struct walk_sheet *sheet, uint32_t moment, bool gi, const uint8_t *rgba)
{
    const uint32_t left = GAP + moment % sheet->columns * (sheet->tile_width + GAP);
    const uint32_t pair = moment / sheet->columns * (2 * sheet->tile_height + PAIR_GAP + GAP);
    const uint32_t top = GAP + pair + (gi ? sheet->tile_height + PAIR_GAP : 0);
    const uint32_t rows = sheet->picture_height < sheet->shrink ? sheet->picture_height : sheet->shrink;
    for (uint32_t y = 0; y < sheet->tile_height; y++)
        for (uint32_t x = 0; x < sheet->tile_width; x++)
            texel_average(
                sheet, rgba + 4 * ((size_t)y * sheet->shrink * sheet->picture_width + x * sheet->shrink),
                sheet->picture_width, rows, sheet->rgba + 4 * ((size_t)(top + y) * sheet->width + left + x));
}
