/* SPDX-License-Identifier: MIT
 * Pictures in KTX2 (KHR_texture_basisu): they hold what went in, and broken ones are refused. Where libktx is
 * not there, one message says which option builds it. */
#include "scene_files.h"

#include <string.h>
#ifdef GLTF_WITH_KTX2
#include <ktx.h>
#include <stdbool.h>
#include <stdlib.h>
#endif

#define KTX2_SCENE                                                                                           \
    ",\"extensionsUsed\":[\"KHR_texture_basisu\"],\"extensionsRequired\":[\"KHR_texture_basisu\"],"          \
    "\"images\":[{\"bufferView\":0,\"mimeType\":\"image/ktx2\"}],\"textures\":[{\"extensions\":"             \
    "{\"KHR_texture_basisu\":{\"source\":0}}}],\"materials\":[{\"emissiveTexture\":{\"index\":0}}]"

#ifdef GLTF_WITH_KTX2
/* Blocks of 4 x 4, so that each has one colour. Formats are those of Vulkan: R8G8B8A8_SRGB. */
enum { WIDTH = 12, HEIGHT = 8, FORMAT = 43, WIDTH_AT = 20, BEST = 255 };

static void texel_of(uint32_t x, uint32_t y, uint8_t texel[4])
{
    memcpy(texel, (const uint8_t[4]){ (uint8_t)(40 + 80 * (x / 4)), (uint8_t)(220 - 150 * (y / 4)), 60, 255 },
           4);
}

/* In ETC1S, or as it is. Of malloc. */
static uint8_t *ktx2_encode(bool compressed, size_t *size)
{
    static uint8_t texels[HEIGHT][WIDTH][4];
    const ktxTextureCreateInfo info = { .vkFormat = FORMAT,
                                        .baseWidth = WIDTH,
                                        .baseHeight = HEIGHT,
                                        .baseDepth = 1,
                                        .numDimensions = 2,
                                        .numLevels = 1,
                                        .numLayers = 1,
                                        .numFaces = 1 };
    ktxTexture2 *texture = NULL;
    uint8_t *data = NULL;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        texel_of(i % WIDTH, i / WIDTH, texels[i / WIDTH][i % WIDTH]);
    assert_int_equal(ktxTexture2_Create(&info, KTX_TEXTURE_CREATE_ALLOC_STORAGE, &texture), KTX_SUCCESS);
    ktxTexture *const base = ktxTexture(texture);
    assert_int_equal(ktxTexture_SetImageFromMemory(base, 0, 0, 0, &texels[0][0][0], sizeof texels),
                     KTX_SUCCESS);
    if (compressed)
        assert_int_equal(ktxTexture2_CompressBasis(texture, BEST), KTX_SUCCESS);
    assert_int_equal(ktxTexture_WriteToMemory(base, &data, size), KTX_SUCCESS);
    ktxTexture_Destroy(base);
    return data;
}

/* The encoding, ETC1S, loses some: a twentieth of the range at most, here. */
static void require_texels(const struct gltf_image *image)
{
    assert_int_equal(image->width, WIDTH);
    assert_int_equal(image->height, HEIGHT);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        uint8_t texel[4];
        texel_of(i % WIDTH, i / WIDTH, texel);
        for (int k = 0; k < 4; k++)
            assert_in_range(image->texels[4 * i + (uint32_t)k] + 13 - texel[k], 0, 26);
    }
}

static void a_picture_from_ktx2_is_the_one_that_went_in(void **state)
{
    (void)state;
    size_t size = 0;
    uint8_t *const data = ktx2_encode(true, &size);
    packed_write(data, size, KTX2_SCENE);
    free(data);
    struct gltf_scene *const s = file_load("packed.glb");
    assert_int_equal(s->image_count, 1);
    require_texels(&s->images[0]);
    assert_int_equal(s->materials[0].emissive_texture.texture, 0);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

static void a_plain_picture_gives_way_to_ktx2(void **state)
{
    (void)state;
    size_t size = 0;
    uint8_t *const data = ktx2_encode(true, &size);
    struct draft d = { 0 };
    draft_view(&d, data, size);
    free(data);
    struct gltf_scene *const s =
        draft_load(&d, ",\"images\":[{\"uri\":\"gone.png\"},{\"bufferView\":0}],\"textures\":[{\"source\":0,"
                       "\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}}]");
    assert_int_equal(s->image_count, 1);
    gltf_scene_destroy(s);
}

static void broken_ktx2_is_refused(void **state)
{
    (void)state;
    size_t size = 0;
    uint8_t *const data = ktx2_encode(true, &size);
    for (size_t kept = 1; kept < size; kept += 1 + kept / 16) {
        packed_write(data, kept, KTX2_SCENE);
        refused_with("images[0]");
    }
    data[WIDTH_AT + 2] = 1;
    packed_write(data, size, KTX2_SCENE);
    free(data);
    refused_with("the limits are 1 and");
}

static void texels_that_are_not_compressed_are_refused(void **state)
{
    (void)state;
    size_t size = 0;
    uint8_t *const data = ktx2_encode(false, &size);
    packed_write(data, size, KTX2_SCENE);
    free(data);
    refused_with("not one of KHR_texture_basisu");
}
#else
static void without_libktx_the_message_names_the_option(void **state)
{
    (void)state;
    packed_write("\253KTX 20", 7, KTX2_SCENE);
    refused_with("KHR_texture_basisu, which this build does not have: build it with -Dktx2=enabled");
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef GLTF_WITH_KTX2
        cmocka_unit_test(a_picture_from_ktx2_is_the_one_that_went_in),
        cmocka_unit_test(a_plain_picture_gives_way_to_ktx2),
        cmocka_unit_test(broken_ktx2_is_refused),
        cmocka_unit_test(texels_that_are_not_compressed_are_refused),
#else
        cmocka_unit_test(without_libktx_the_message_names_the_option),
#endif
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
