/* SPDX-License-Identifier: MIT
 *
 * Teaches: how to put pictures of the same size side by side.
 *
 * Tiles PNG files row by row, shrunk by a whole factor if asked to. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <stb_image.h>
#include <stb_image_write.h>

#include "file_write.h"

enum { GAP = 4, MAX_SIDE = 32768 };

struct sheet {
    const char *out;
    int columns, shrink, tile_width, tile_height, count;
    char **inputs;
    uint8_t *texels;
    char error[512];
};

static bool failed(struct sheet *sheet, const char *path, const char *why)
{
    snprintf(sheet->error, sizeof(sheet->error), "%s: %s", path, why);
    return false;
}

static int sheet_width(const struct sheet *sheet)
{
    return sheet->columns * (sheet->tile_width + GAP) + GAP;
}

static int sheet_height(const struct sheet *sheet)
{
    return (sheet->count + sheet->columns - 1) / sheet->columns * (sheet->tile_height + GAP) + GAP;
}

/* The first picture decides the size of all. */
static bool sheet_begin(struct sheet *sheet)
{
    int width, height, channels;
    if (!stbi_info(sheet->inputs[0], &width, &height, &channels))
        return failed(sheet, sheet->inputs[0], "cannot be read as a picture");
    sheet->tile_width = width / sheet->shrink;
    sheet->tile_height = height / sheet->shrink;
    if (sheet->tile_width < 1 || sheet->tile_height < 1 || sheet_width(sheet) > MAX_SIDE ||
        sheet_height(sheet) > MAX_SIDE)
        return failed(sheet, sheet->out, "the sheet would be empty or wider than 32768 texels");
    const size_t bytes = (size_t)3 * (size_t)sheet_width(sheet) * (size_t)sheet_height(sheet);
    sheet->texels = malloc(bytes);
    if (!sheet->texels)
        return failed(sheet, sheet->out, "out of memory");
    memset(sheet->texels, 24, bytes);
    return true;
}

/* One texel of a tile: the mean of a square of the picture's. */
static void texel_average(const struct sheet *sheet, const uint8_t *picture, int x, int y, uint8_t *target)
{
    const int side = sheet->shrink, width = sheet->tile_width * side;
    for (int c = 0; c < 3; c++) {
        int sum = 0;
        for (int i = 0; i < side * side; i++)
            sum += picture[3 * ((y * side + i / side) * width + x * side + i % side) + c];
        target[c] = (uint8_t)((sum + side * side / 2) / (side * side));
    }
}

static bool tile_add(struct sheet *sheet, int index)
{
    int width, height, channels;
    uint8_t *picture = stbi_load(sheet->inputs[index], &width, &height, &channels, 3);
    if (!picture)
        return failed(sheet, sheet->inputs[index], "cannot be read as a picture");
    if (width != sheet->tile_width * sheet->shrink || height != sheet->tile_height * sheet->shrink) {
        stbi_image_free(picture);
        return failed(sheet, sheet->inputs[index],
                      "has another size than the first, or one that --shrink does not divide");
    }
    const int left = GAP + index % sheet->columns * (sheet->tile_width + GAP);
    const int top = GAP + index / sheet->columns * (sheet->tile_height + GAP);
    for (int y = 0; y < sheet->tile_height; y++)
        for (int x = 0; x < sheet->tile_width; x++)
            texel_average(sheet, picture, x, y,
                          sheet->texels + 3 * ((top + y) * sheet_width(sheet) + left + x));
    stbi_image_free(picture);
    return true;
}

struct png {
    struct sheet *sheet;
    bool written;
};

static void png_write(void *user, void *data, int size)
{
    struct png *png = user;
    const struct file_part part = { data, (size_t)size };
    png->written = file_write_parts(png->sheet->out, &part, 1, png->sheet->error, sizeof(png->sheet->error));
}

static bool sheet_make(struct sheet *sheet)
{
    bool ok = sheet_begin(sheet);
    for (int i = 0; ok && i < sheet->count; i++)
        ok = tile_add(sheet, i);
    struct png png = { sheet, false };
    const int width = sheet_width(sheet);
    if (ok &&
        !stbi_write_png_to_func(png_write, &png, width, sheet_height(sheet), 3, sheet->texels, 3 * width))
        failed(sheet, sheet->out, "cannot be encoded");
    free(sheet->texels);
    return ok && png.written;
}

static int usage(FILE *stream)
{
    fprintf(stream, "usage: contact_sheet OUT.png COLUMNS SHRINK IN.png...\n"
                    "Tiles pictures of one size; SHRINK averages squares of that many texels (1 to 16).\n");
    return stream == stdout ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--help") == 0)
        return usage(stdout);
    if (argc < 5)
        return usage(stderr);
    struct sheet sheet = {
        .out = argv[1], .columns = atoi(argv[2]), .shrink = atoi(argv[3]), .count = argc - 4
    };
    sheet.inputs = argv + 4;
    if (sheet.columns < 1 || sheet.columns > 64 || sheet.shrink < 1 || sheet.shrink > 16)
        return usage(stderr);
    if (sheet_make(&sheet))
        return EXIT_SUCCESS;
    fprintf(stderr, "contact_sheet: %s\n", sheet.error);
    return EXIT_FAILURE;
}
