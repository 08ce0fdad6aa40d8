/* SPDX-License-Identifier: MIT
 *
 * Materials, textures and images, and where files keep their buffers.
 */
#include "scene_files.h"

#include <math.h>
#include <stb_image_write.h>
#include <stdlib.h>
#include <string.h>

static const uint8_t texels[16] = { 255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 10, 20, 30, 40 };
static const struct png small_png = { 2, 2, 8, texels };

static void floats_expect(const float *got, const float *want, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(got[i] - want[i]) <= 1e-6f))
            fail_msg("value %zu is %.9g, not %.9g", i, (double)got[i], (double)want[i]);
}

static struct gltf_scene *materials_load(const char *rest)
{
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 3, (const float[]){ 0, 0, 0, 1, 0, 0, 0, 1, 0 });
    return draft_load(&d, rest);
}

/* A document whose only texture shows the image that `source` describes. */
static struct gltf_scene *image_load(struct draft *d, const char *source)
{
    char rest[4096];
    snprintf(rest, sizeof rest, ",\"images\":[{%s}],\"textures\":[{\"source\":0}]", source);
    return draft_load(d, rest);
}

static void image_expect(struct gltf_scene *s, const uint8_t *want, size_t size)
{
    assert_int_equal(s->image_count, 1);
    assert_int_equal(4 * s->images[0].width * s->images[0].height, size);
    assert_memory_equal(s->images[0].texels, want, size);
    gltf_scene_destroy(s);
}

static void material_factors_are_read(void **state)
{
    (void)state;
    struct gltf_scene *const s = materials_load(
        ",\"materials\":[{\"name\":\"all\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.4],"
        "\"metallicFactor\":0.5,\"roughnessFactor\":0.6},\"emissiveFactor\":[0.7,0.8,0.9],\"alphaMode\":"
        "\"MASK\","
        "\"alphaCutoff\":0.25,\"doubleSided\":true},{\"alphaMode\":\"BLEND\"},{}]");
    const struct gltf_material *const m = s->materials;
    assert_string_equal(m[0].name, "all");
    floats_expect(m[0].base_color, (const float[]){ 0.1f, 0.2f, 0.3f, 0.4f }, 4);
    floats_expect((const float[]){ m[0].metallic, m[0].roughness, m[0].alpha_cutoff },
                  (const float[]){ 0.5f, 0.6f, 0.25f }, 3);
    floats_expect(m[0].emissive, (const float[]){ 0.7f, 0.8f, 0.9f }, 3);
    assert_int_equal(m[0].alpha_mode, GLTF_ALPHA_MASK);
    assert_true(m[0].double_sided);
    assert_int_equal(m[1].alpha_mode, GLTF_ALPHA_BLEND);
    gltf_scene_destroy(s);
}

static void an_empty_material_has_the_format_s_defaults(void **state)
{
    (void)state;
    struct gltf_scene *const s = materials_load(",\"materials\":[{}]");
    const struct gltf_material *const m = s->materials;
    floats_expect(m->base_color, (const float[]){ 1, 1, 1, 1 }, 4);
    floats_expect(m->emissive, (const float[]){ 0, 0, 0 }, 3);
    floats_expect(
        (const float[]){ m->metallic, m->roughness, m->normal_scale, m->occlusion_strength, m->alpha_cutoff },
        (const float[]){ 1, 1, 1, 1, 0.5f }, 5);
    assert_int_equal(m->alpha_mode, GLTF_ALPHA_OPAQUE);
    assert_false(m->double_sided || m->unlit);
    assert_int_equal(m->base_color_texture.texture, -1);
    floats_expect(m->base_color_texture.uv_transform, (const float[]){ 1, 0, 0, 0, 1, 0 }, 6);
    gltf_scene_destroy(s);
}

static void emissive_strength_multiplies_and_unlit_is_told(void **state)
{
    (void)state;
    struct gltf_scene *const s = materials_load(
        ",\"extensionsUsed\":[\"KHR_materials_emissive_strength\",\"KHR_materials_unlit\"],"
        "\"materials\":[{\"emissiveFactor\":[1,0.5,0],\"extensions\":"
        "{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":20.0},\"KHR_materials_unlit\":{}}}]");
    floats_expect(s->materials[0].emissive, (const float[]){ 20, 10, 0 }, 3);
    assert_true(s->materials[0].unlit);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

static int png_view(struct draft *d, const struct png *image)
{
    uint8_t file[4096];
    return draft_view(d, file, png_encode(image, file, sizeof file));
}

static void textures_and_samplers_are_read(void **state)
{
    (void)state;
    struct draft d = { 0 };
    png_view(&d, &small_png);
    struct gltf_scene *const s = draft_load(
        &d, ",\"images\":[{\"bufferView\":0,\"mimeType\":\"image/png\"}],\"samplers\":[{\"minFilter\":9728,"
            "\"magFilter\":9729,\"wrapS\":33071,\"wrapT\":33648}],\"textures\":[{\"source\":0,\"sampler\":0},"
            "{\"source\":0}],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
            "\"metallicRoughnessTexture\":{\"index\":1}},\"normalTexture\":{\"index\":1,\"scale\":0.5},"
            "\"occlusionTexture\":{\"index\":0,\"strength\":0.25,\"texCoord\":1},\"emissiveTexture\":{"
            "\"index\":1}}]");
    const struct gltf_material *const m = s->materials;
    assert_int_equal(s->image_count, 1);
    assert_int_equal(s->textures[0].wrap_u, GLTF_WRAP_CLAMP);
    assert_int_equal(s->textures[0].wrap_v, GLTF_WRAP_MIRROR);
    assert_int_equal(s->textures[0].min_filter, GLTF_FILTER_NEAREST);
    assert_int_equal(s->textures[0].mag_filter, GLTF_FILTER_LINEAR);
    assert_int_equal(s->textures[1].wrap_u, GLTF_WRAP_REPEAT);
    assert_int_equal(m->base_color_texture.texture, 0);
    assert_int_equal(m->metallic_roughness_texture.texture, 1);
    assert_int_equal(m->normal_texture.texture, 1);
    assert_int_equal(m->emissive_texture.texture, 1);
    assert_int_equal(m->occlusion_texture.uv_set, 1);
    floats_expect((const float[]){ m->normal_scale, m->occlusion_strength }, (const float[]){ 0.5f, 0.25f },
                  2);
    gltf_scene_destroy(s);
}

/* The example of the extension's text: a quarter turn that keeps to the lower left quadrant of the image. */
static void texture_transform_turns_as_its_example_says(void **state)
{
    (void)state;
    struct draft d = { 0 };
    png_view(&d, &small_png);
    struct gltf_scene *const s = draft_load(
        &d,
        ",\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}],\"materials\":[{\"emissiveTexture\":"
        "{\"index\":0,\"texCoord\":0,\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0,1],"
        "\"rotation\":1.57079632679,\"scale\":[0.5,0.5],\"texCoord\":1}}}}]");
    const struct gltf_texture_ref *const ref = &s->materials[0].emissive_texture;
    floats_expect(ref->uv_transform, (const float[]){ 0, 0.5f, 0, -0.5f, 0, 1 }, 6);
    assert_int_equal(ref->uv_set, 1);
    gltf_scene_destroy(s);
}

static void a_used_second_uv_set_is_never_missing(void **state)
{
    (void)state;
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 3, (const float[]){ 0, 0, 0, 1, 0, 0, 0, 1, 0 });
    char rest[512];
    snprintf(
        rest, sizeof rest,
        ",\"images\":[{\"bufferView\":%d}],\"textures\":[{\"source\":0}],\"materials\":[{\"emissiveTexture\":"
        "{\"index\":0,\"texCoord\":1}}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
        "\"material\":0}]}]",
        png_view(&d, &small_png));
    struct gltf_scene *const s = draft_load(&d, rest);
    assert_non_null(s->primitives[0].uv1);
    gltf_scene_destroy(s);
}

static void png_images_come_from_a_buffer_view(void **state)
{
    (void)state;
    struct draft d = { 0 };
    png_view(&d, &small_png);
    image_expect(image_load(&d, "\"bufferView\":0,\"mimeType\":\"image/png\""), texels, sizeof texels);
}

static void png_images_come_from_a_data_uri(void **state)
{
    (void)state;
    struct draft d = { 0 };
    uint8_t file[1024];
    char text[2048], source[2200];
    base64_encode(file, png_encode(&small_png, file, sizeof file), text, sizeof text);
    snprintf(source, sizeof source, "\"uri\":\"data:image/png;base64,%s\"", text);
    image_expect(image_load(&d, source), texels, sizeof texels);
}

static void png_images_come_from_a_file_with_an_escaped_name(void **state)
{
    (void)state;
    struct draft d = { 0 };
    uint8_t file[1024];
    files_write("a b+c.png", file, png_encode(&small_png, file, sizeof file));
    image_expect(image_load(&d, "\"uri\":\"./a%20b+c.png\""), texels, sizeof texels);
}

static void sixteen_bit_png_images_keep_their_upper_byte(void **state)
{
    (void)state;
    static const uint8_t deep[8] = { 0x12, 0x34, 0xff, 0xff, 0x00, 0x80, 0x80, 0x00 };
    static const uint8_t want[4] = { 0x12, 0xff, 0x00, 0x80 };
    struct draft d = { 0 };
    png_view(&d, &(struct png){ 1, 1, 16, deep });
    image_expect(image_load(&d, "\"bufferView\":0"), want, sizeof want);
}

struct growing {
    uint8_t data[4096];
    size_t size;
};

static void growing_append(void *context, void *data, int size)
{
    struct growing *const g = context;
    assert_true(g->size + (size_t)size <= sizeof g->data);
    memcpy(g->data + g->size, data, (size_t)size);
    g->size += (size_t)size;
}

/* 2.4 GB of image data for one texel: a decoder that inflates them all takes that much memory, or gives up.
 */
static void a_png_is_inflated_no_further_than_its_rows(void **state)
{
    (void)state;
    enum { SIZE = 15600000 };
    struct draft d = { 0 };
    uint8_t *file = malloc(SIZE);
    assert_non_null(file);
    files_write("bomb.png", file, png_bomb_encode(file, SIZE));
    free(file);
    image_expect(image_load(&d, "\"uri\":\"bomb.png\""), (const uint8_t[4]){ 0 }, 4);
}

static void jpeg_images_are_decoded(void **state)
{
    (void)state;
    struct growing jpeg = { .size = 0 };
    uint8_t grey[8 * 8 * 3];
    memset(grey, 100, sizeof grey);
    assert_int_not_equal(stbi_write_jpg_to_func(growing_append, &jpeg, 8, 8, 3, grey, 95), 0);
    struct draft d = { 0 };
    draft_view(&d, jpeg.data, jpeg.size);
    struct gltf_scene *const s = image_load(&d, "\"bufferView\":0,\"mimeType\":\"image/jpeg\"");
    assert_int_equal(s->images[0].width, 8);
    assert_in_range(s->images[0].texels[0], 98, 102); /* lossy */
    assert_int_equal(s->images[0].texels[3], 255);
    gltf_scene_destroy(s);
}

static void gltf_text_write(const char *uri)
{
    char json[1024];
    snprintf(json, sizeof json,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
             "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}],\"meshes\":[{\"primitives\":"
             "[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}",
             uri);
    files_write_text("text.gltf", json);
}

static void buffers_come_from_files_and_data_uris(void **state)
{
    (void)state;
    static const float positions[9] = { 0, 0, 0, 2, 0, 0, 0, 3, 0 };
    char text[64], uri[128];
    base64_encode((const uint8_t *)positions, sizeof positions, text, sizeof text);
    snprintf(uri, sizeof uri, "data:application/gltf-buffer;base64,%s", text);
    files_write("points of it.bin", positions, sizeof positions);
    const char *const uris[2] = { uri, "points%20of%20it.bin" };
    for (int i = 0; i < 2; i++) {
        gltf_text_write(uris[i]);
        struct gltf_scene *const s = file_load("text.gltf");
        assert_int_equal(s->instance_count, 1);
        floats_expect(s->primitives[0].positions, positions, 9);
        gltf_scene_destroy(s);
    }
}

static void images_that_name_the_same_bytes_are_read_once(void **state)
{
    (void)state;
    struct draft d = { 0 };
    uint8_t file[256];
    png_view(&d, &small_png);
    png_view(&d, &small_png);
    files_write("same.png", file, png_encode(&small_png, file, sizeof file));
    struct gltf_scene *const s = draft_load(
        &d, ",\"images\":[{\"bufferView\":0},{\"uri\":\"same.png\"},{\"bufferView\":0},{\"bufferView\":1},"
            "{\"uri\":\"same.png\"}],\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2},"
            "{\"source\":3},{\"source\":4}]");
    assert_int_equal(s->image_count, 3);
    static const int32_t wanted[] = { 0, 1, 0, 2, 1 };
    for (int i = 0; i < 5; i++)
        assert_int_equal(s->textures[i].image, wanted[i]);
    gltf_scene_destroy(s);
}

static void images_that_no_texture_uses_are_not_read(void **state)
{
    (void)state;
    struct gltf_scene *const s = materials_load(
        ",\"extensionsUsed\":[\"KHR_texture_basisu\"],\"images\":[{\"uri\":\"not_there.ktx2\"}],"
        "\"textures\":[{\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}}],"
        "\"materials\":[{\"emissiveTexture\":{\"index\":0}}]");
    assert_int_equal(s->image_count, 0);
    assert_int_equal(s->materials[0].emissive_texture.texture, -1);
    assert_non_null(strstr(s->warning, "KHR_texture_basisu"));
    gltf_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(material_factors_are_read),
        cmocka_unit_test(an_empty_material_has_the_format_s_defaults),
        cmocka_unit_test(emissive_strength_multiplies_and_unlit_is_told),
        cmocka_unit_test(textures_and_samplers_are_read),
        cmocka_unit_test(texture_transform_turns_as_its_example_says),
        cmocka_unit_test(a_used_second_uv_set_is_never_missing),
        cmocka_unit_test(png_images_come_from_a_buffer_view),
        cmocka_unit_test(png_images_come_from_a_data_uri),
        cmocka_unit_test(png_images_come_from_a_file_with_an_escaped_name),
        cmocka_unit_test(sixteen_bit_png_images_keep_their_upper_byte),
        cmocka_unit_test(a_png_is_inflated_no_further_than_its_rows),
        cmocka_unit_test(jpeg_images_are_decoded),
        cmocka_unit_test(buffers_come_from_files_and_data_uris),
        cmocka_unit_test(images_that_name_the_same_bytes_are_read_once),
        cmocka_unit_test(images_that_no_texture_uses_are_not_read),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
