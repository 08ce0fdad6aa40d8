/* SPDX-License-Identifier: MIT
 * Pictures: the readers of the program, and PNG and JPEG once more as textures of the importer. */
#include "fuzz.h"

#include "files.h"
#include "gltf_scene.h"
#include "image/image.h"
#include "require.h"

#include <stdio.h>
#include <stdlib.h>
#include <zlib.h>

static bool read_image(const char *path, char *error, size_t error_size)
{
    struct image image;
    const bool is_read = image_read(&image, path, error, error_size);
    if (!is_read) {
        REQUIRE_TRUE(image.rgba == NULL);
        return false;
    }
    REQUIRE_TRUE(image.width > 0 && image.width <= IMAGE_SIDE_MAX);
    REQUIRE_TRUE(image.height > 0 && image.height <= IMAGE_SIDE_MAX);
    REQUIRE_TRUE(image.channels == 1 || image.channels == 3 || image.channels == 4);
    /* Copied, for the sanitizer to see whether each is there and was written. */
    const size_t count = 4 * (size_t)image.width;
    float *row = test_array_alloc(count, sizeof *row);
    for (size_t y = 0; y < image.height; y++) {
        memcpy(row, image.rgba + y * count, count * sizeof *row);
        for (size_t i = 3; i < count; i += 4)
            REQUIRE_TRUE(image.channels == 4 || row[i] == 1.0f);
    }
    free(row);
    image_finish(&image);
    return true;
}

static bool read_texture(const char *uri, char *error, size_t error_size)
{
    char text[512];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"images\":[{\"uri\":\"%s\"}],\"textures\":[{\"source\":0}],"
             "\"materials\":[{\"emissiveTexture\":{\"index\":0}}]}",
             uri);
    files_write_text(FUZZ_STEM ".gltf", text);
    struct gltf_scene *const scene = gltf_scene_load(files_path(FUZZ_STEM ".gltf"), error, error_size);
    if (!scene)
        return false;
    REQUIRE_CMP(scene->image_count, ==, 1u);
    const struct gltf_image *const image = &scene->images[0];
    const size_t size = 4 * (size_t)image->width;
    REQUIRE_CMP(size * image->height, >, 0u);
    uint8_t *row = test_array_alloc(size, 1);
    for (size_t y = 0; y < image->height; y++)
        memcpy(row, image->texels + y * size, size);
    free(row);
    gltf_scene_destroy(scene);
    return true;
}

static bool read_jpeg(const char *path, char *error, size_t error_size)
{
    (void)path;
    return read_texture(FUZZ_STEM ".jpg", error, error_size);
}

static bool read_png(const char *path, char *error, size_t error_size)
{
    const bool is_read = read_image(path, error, error_size);
    char importers_error[512];
    read_texture(FUZZ_STEM ".png", importers_error, sizeof importers_error);
    return is_read;
}

/* Chunks: length, name, data, checksum of name and data. */
static void mend_png(uint8_t *data, size_t size)
{
    for (size_t at = 8; at + 12 <= size;) {
        const uint32_t length = fuzz_big_endian(data + at);
        if (length > size - at - 12)
            return;
        fuzz_big_endian_put(data + at + 8 + length, (uint32_t)crc32(0, data + at + 4, length + 4));
        at += 12 + (size_t)length;
    }
}

const struct fuzz_target fuzz_png = { ".png", read_png, NULL, mend_png };
const struct fuzz_target fuzz_jpeg = { ".jpg", read_jpeg, NULL, NULL };
const struct fuzz_target fuzz_hdr = { ".hdr", read_image, NULL, NULL };
const struct fuzz_target fuzz_pfm = { ".pfm", read_image, NULL, NULL };
const struct fuzz_target fuzz_exr = { ".exr", read_image, NULL, NULL };
