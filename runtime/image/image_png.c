/* SPDX-License-Identifier: MIT
 * PNG is read through libpng. */
#include "image_codec.h"

#include "file/input_file.h"

#include <base/text.h>
#include <picture/picture_png.h>
#include <stdlib.h>

static void take_texels(struct image *image, const struct picture_png *png)
{
    const uint8_t *bytes = png->texels;
    const uint16_t *words = png->texels;
    const size_t count = 4 * (size_t)image->width * image->height;
    if (png->depth == 16)
        for (size_t i = 0; i < count; i++)
            image->rgba[i] = (float)words[i] / 65535;
    else
        for (size_t i = 0; i < count; i++)
            image->rgba[i] = (float)bytes[i] / 255;
    image->channels = png->channels;
    image->display_referred = true;
}

static bool read_bytes(struct image *image, const uint8_t *bytes, size_t size, char *error, size_t error_size)
{
    char reason[128];
    uint32_t width, height;
    struct picture_png png;
    if (!picture_png_size(bytes, size, &width, &height))
        return base_text_error(error, error_size, "broken picture: not a PNG file");
    if (!image_check_size(width, height, error, error_size))
        return false;
    if (!picture_png_read(&png, bytes, size, true, reason, sizeof reason))
        return base_text_error(error, error_size, "broken picture: %s", reason);
    const bool complete = image_init(image, png.width, png.height, error, error_size);
    if (complete)
        take_texels(image, &png);
    free(png.texels);
    return complete;
}

bool image_png_read(struct image *image, const struct image_input *input, char *error, size_t error_size)
{
    char *bytes = input_file_read(input->stream, input->size, error, error_size);
    const bool complete =
        bytes && read_bytes(image, (const uint8_t *)bytes, (size_t)input->size, error, error_size);
    free(bytes);
    return complete;
}
