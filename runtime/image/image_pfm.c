/* SPDX-License-Identifier: MIT
 * PFM: "PF" or "Pf", width, height, a scale whose sign is the byte order (negative: little endian), one byte
 * of white space, then rows of floats from the bottom. The size of the scale is not applied. */
#include "image_codec.h"

#include <base/text.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool machine_is_little_endian(void)
{
    const uint16_t one = 1;
    return *(const uint8_t *)&one == 1;
}

static void swap_bytes(float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint8_t bytes[4];
        memcpy(bytes, &values[i], 4);
        const uint8_t swapped[4] = { bytes[3], bytes[2], bytes[1], bytes[0] };
        memcpy(&values[i], swapped, 4);
    }
}

static bool read_rows(struct image *image, FILE *file, bool swap)
{
    const size_t row_values = (size_t)image->width * image->channels;
    float *row = malloc(row_values * sizeof(float));
    bool complete = row != NULL;
    for (uint32_t y = image->height; complete && y-- > 0;) {
        complete = fread(row, sizeof(float), row_values, file) == row_values;
        if (complete && swap)
            swap_bytes(row, row_values);
        float *out = image->rgba + 4 * (size_t)y * image->width;
        for (size_t x = 0; complete && x < image->width; x++) {
            for (uint32_t c = 0; c < 3; c++)
                out[4 * x + c] = row[x * image->channels + (image->channels == 1 ? 0 : c)];
            out[4 * x + 3] = 1;
        }
    }
    free(row);
    return complete;
}

bool image_pfm_read(struct image *image, const struct image_input *input, char *error, size_t error_size)
{
    char kind[3] = "";
    unsigned width, height;
    float scale;
    if (fscanf(input->stream, "%2s %9u %9u %f", kind, &width, &height, &scale) != 4 || kind[0] != 'P' ||
        (kind[1] != 'F' && kind[1] != 'f') || !isfinite(scale) || scale == 0)
        return base_text_error(error, error_size, "broken picture: not a PFM header");
    fgetc(input->stream);
    const uint32_t channels = kind[1] == 'F' ? 3 : 1;
    const uint64_t need = (uint64_t)width * height * channels * sizeof(float);
    if (!image_init_backed(image, width, height, need, input->size, error, error_size))
        return false;
    image->channels = channels;
    return read_rows(image, input->stream, (scale < 0) != machine_is_little_endian()) ||
           base_text_error(error, error_size, "broken picture: the file ends before its last row");
}

bool image_pfm_write(const struct image_source *source, FILE *stream, char *error, size_t error_size)
{
    (void)error;
    (void)error_size;
    const uint32_t channels = source->channels == 1 ? 1 : 3;
    fprintf(stream, "%s\n%u %u\n%s\n", channels == 3 ? "PF" : "Pf", source->width, source->height,
            machine_is_little_endian() ? "-1.0" : "1.0");
    for (uint32_t y = source->height; y-- > 0;)
        for (uint32_t x = 0; x < source->width; x++)
            fwrite(source->rgba + 4 * ((size_t)y * source->width + x), sizeof(float), channels, stream);
    return true;
}
