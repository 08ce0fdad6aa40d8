/* SPDX-License-Identifier: MIT */
#include "image.h"
#include "image_codec.h"
#include "file/input_file.h"
#include "file/output_file.h"

#include <base/text.h>
#include <picture/picture_png.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The largest picture, in floats. */
static const uint64_t file_bytes_max = UINT64_C(16) * IMAGE_SIDE_MAX * IMAGE_SIDE_MAX;

struct codec {
    const char *ending;
    bool (*read)(struct image *image, const struct image_input *input, char *error, size_t error_size);
    bool (*write)(const struct image_source *source, FILE *stream, char *error, size_t error_size);
};

static const struct codec codecs[IMAGE_FORMAT_COUNT] = {
    [IMAGE_EXR] = { ".exr", image_exr_read, image_exr_write },
    [IMAGE_HDR] = { ".hdr", image_hdr_read, image_hdr_write },
    [IMAGE_PFM] = { ".pfm", image_pfm_read, image_pfm_write },
    [IMAGE_PNG] = { ".png", image_png_read, NULL },
};

enum image_format image_format_from_path(const char *path)
{
    const size_t length = strlen(path);
    int format = 0;
    for (; format < IMAGE_FORMAT_COUNT; format++) {
        const size_t ending = strlen(codecs[format].ending);
        if (length > ending && strcasecmp(path + length - ending, codecs[format].ending) == 0)
            break;
    }
    return (enum image_format)format;
}

const char *image_format_list(void)
{
    return ".exr, .hdr, .pfm or .png";
}

bool image_check_size(uint32_t width, uint32_t height, char *error, size_t error_size)
{
    if (width > 0 && height > 0 && width <= IMAGE_SIDE_MAX && height <= IMAGE_SIDE_MAX)
        return true;
    return base_text_error(error, error_size, "a picture of %u x %u, expected sides from 1 to %d", width,
                           height, IMAGE_SIDE_MAX);
}

bool image_init(struct image *image, uint32_t width, uint32_t height, char *error, size_t error_size)
{
    *image = (struct image){ 0 };
    if (!image_check_size(width, height, error, error_size))
        return false;
    float *rgba = calloc((size_t)width * height, 4 * sizeof(float));
    if (!rgba)
        return base_text_error(error, error_size, "out of memory for a picture of %u x %u", width, height);
    *image = (struct image){ .width = width, .height = height, .channels = 4, .rgba = rgba };
    return true;
}

bool image_init_backed(struct image *image, uint32_t width, uint32_t height, uint64_t need, uint64_t have,
                       char *error, size_t error_size)
{
    if (!image_check_size(width, height, error, error_size))
        return false;
    if (need > have)
        return base_text_error(error, error_size, "broken picture: the file is too short for %u x %u pixels",
                               width, height);
    return image_init(image, width, height, error, error_size);
}

void image_finish(struct image *image)
{
    free(image->rgba);
    *image = (struct image){ 0 };
}

bool image_read(struct image *image, const char *path, char *error, size_t error_size)
{
    *image = (struct image){ 0 };
    const enum image_format format = image_format_from_path(path);
    if (format == IMAGE_FORMAT_COUNT)
        return base_text_error(error, error_size, "%s: unknown picture format, expected %s", path,
                               image_format_list());
    char reason[256] = "larger than 16 GiB";
    struct image_input input = { .path = path };
    input.stream = input_file_open(path, &input.size, reason, sizeof reason);
    const bool complete = input.stream && input.size <= file_bytes_max &&
                          codecs[format].read(image, &input, reason, sizeof reason);
    if (input.stream)
        fclose(input.stream);
    if (complete)
        return true;
    image_finish(image);
    return base_text_error(error, error_size, "%s: %s", path, reason);
}

bool image_write_float(const char *path, const float *rgba, uint32_t width, uint32_t height,
                       uint32_t channels, char *error, size_t error_size)
{
    const enum image_format format = image_format_from_path(path);
    if (format == IMAGE_FORMAT_COUNT || !codecs[format].write)
        return base_text_error(error, error_size, "%s: expected a float format: .exr, .hdr or .pfm", path);
    struct output_file file;
    if (!output_file_begin(&file, path, error, error_size))
        return false;
    const struct image_source source = { rgba, width, height, channels };
    char reason[256] = "";
    if (codecs[format].write(&source, file.stream, reason, sizeof reason))
        return output_file_commit(&file, error, error_size);
    output_file_cancel(&file);
    return base_text_error(error, error_size, "%s: %s", path, reason);
}

bool image_write_png(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height,
                     uint32_t channels, char *error, size_t error_size)
{
    if (image_format_from_path(path) != IMAGE_PNG)
        return base_text_error(error, error_size, "%s: expected a name that ends in .png", path);
    struct output_file file;
    if (!output_file_begin(&file, path, error, error_size))
        return false;
    char reason[256];
    if (picture_png_write(file.stream, rgba, width, height, channels, reason, sizeof reason))
        return output_file_commit(&file, error, error_size);
    output_file_cancel(&file);
    return base_text_error(error, error_size, "%s: %s", path, reason);
}
