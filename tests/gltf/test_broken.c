/* SPDX-License-Identifier: MIT
 *
 * Broken files: each gives no scene and one line that names the file and what is wrong with it.
 */
#include "scene_files.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Accessor 0: three positions; 1: indices 0 1 2; 2: indices 0 1 9; 3: positions with not-a-number. */
static void base_draft(struct draft *d)
{
    static const uint16_t good[3] = { 0, 1, 2 }, bad[3] = { 0, 1, 9 };
    draft_floats(d, "VEC3", 3, (const float[]){ 0, 0, 0, 1, 0, 0, 0, 1, 0 });
    draft_accessor(d, &(struct elements){ good, sizeof good, COMPONENT_USHORT, "SCALAR", 3, NULL });
    draft_accessor(d, &(struct elements){ bad, sizeof bad, COMPONENT_USHORT, "SCALAR", 3, NULL });
    draft_floats(d, "VEC3", 3, (const float[]){ 0, 0, 0, 1, NAN, 0, 0, 1, 0 });
}

#define MESH(primitive) ",\"meshes\":[{\"primitives\":[{" primitive "}]}],\"nodes\":[{\"mesh\":0}]"
#define ATTRIBUTES      "\"attributes\":{\"POSITION\":0}"
#define TRIANGLE        MESH(ATTRIBUTES)
#define LIGHT(light)    ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[" light "]}}"

struct broken {
    const char *name;
    const char *rest;  /* of the document, over the base draft */
    const char *wrong; /* part of the message */
};

static const struct broken rows[] = {
    { "an_index_out_of_range_is_refused", MESH(ATTRIBUTES ",\"indices\":2"), "index 9 is out of range" },
    { "a_position_that_is_not_a_number_is_refused", MESH("\"attributes\":{\"POSITION\":3}"),
      "vertex 1 is not finite" },
    { "a_missing_accessor_is_refused", MESH("\"attributes\":{\"POSITION\":77}"), "accessor 77" },
    { "a_negative_index_is_refused", MESH(ATTRIBUTES ",\"indices\":-1"), "meshes[0].primitives[0].indices" },
    { "indices_of_the_wrong_type_are_refused", MESH(ATTRIBUTES ",\"indices\":0"),
      "unsigned integer scalars" },
    { "positions_of_the_wrong_type_are_refused", MESH("\"attributes\":{\"POSITION\":1}"), "1 components" },
    { "an_unknown_mode_is_refused", MESH(ATTRIBUTES ",\"mode\":9"), "mode 9" },
    { "a_missing_material_is_refused", MESH(ATTRIBUTES ",\"material\":3"), "material 3" },
    { "the_default_material_has_no_index",
      ",\"meshes\":[{\"primitives\":[{" ATTRIBUTES "},{" ATTRIBUTES
      ",\"material\":0}]}],\"nodes\":[{\"mesh\":0}]",
      "material 0 is out of range, there are 0" },
    { "attributes_of_different_lengths_are_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},"
      "{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":2}]" MESH(
          "\"attributes\":{\"POSITION\":0,\"NORMAL\":1}"),
      "2 elements, and there are 3 positions" },
    { "an_accessor_longer_than_its_view_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":4}]" TRIANGLE,
      "do not fit" },
    { "an_offset_far_outside_of_the_view_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"byteOffset\":999999999999999,\"componentType\":5126,\"type\":"
      "\"VEC3\","
      "\"count\":3}]" TRIANGLE,
      "do not fit" },
    { "a_huge_count_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":999999999999999}"
      "]" TRIANGLE,
      "more than" },
    { "a_huge_count_without_data_is_refused",
      ",\"accessors\":[{\"componentType\":5126,\"type\":\"VEC3\",\"count\":100000}]" TRIANGLE,
      "vertices, the limit for files of" },
    { "an_offset_of_a_petabyte_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"byteOffset\":1000000000000000,\"componentType\":5126,\"type\":"
      "\"VEC3\","
      "\"count\":3}]" TRIANGLE,
      "accessors[0].byteOffset" },
    { "a_negative_count_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":-3}]" TRIANGLE,
      "accessors[0].count" },
    { "an_unknown_component_type_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5124,\"type\":\"VEC3\",\"count\":3}]" TRIANGLE,
      "5124" },
    { "a_view_outside_of_its_buffer_is_refused",
      ",\"bufferViews\":[{\"buffer\":0,\"byteOffset\":8,\"byteLength\":4000000000}],\"accessors\":[{"
      "\"bufferView\":0,"
      "\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}]" TRIANGLE,
      "outside of the buffer" },
    { "a_view_of_a_missing_buffer_is_refused",
      ",\"bufferViews\":[{\"buffer\":4,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
      "\"componentType\":5126,"
      "\"type\":\"VEC3\",\"count\":3}]" TRIANGLE,
      "buffer 4" },
    { "a_missing_view_is_refused",
      ",\"accessors\":[{\"bufferView\":40,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}]" TRIANGLE,
      "view 40" },
    { "a_sparse_index_out_of_range_is_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3,\"sparse\":{"
      "\"count\":3,"
      "\"indices\":{\"bufferView\":2,\"componentType\":5123},\"values\":{\"bufferView\":0}}}]" TRIANGLE,
      "sparse index 9" },
    { "sparse_values_longer_than_their_view_are_refused",
      ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3,\"sparse\":{"
      "\"count\":99,"
      "\"indices\":{\"bufferView\":1,\"componentType\":5123},\"values\":{\"bufferView\":0}}}]" TRIANGLE,
      "do not fit" },
    { "nodes_that_are_their_own_ancestors_are_refused",
      ",\"nodes\":[{\"children\":[1]},{\"children\":[2]},"
      "{\"children\":[1]}]",
      "parents" },
    { "a_ring_of_nodes_is_refused", ",\"nodes\":[{\"children\":[1]},{\"children\":[0]}]", "cyclic" },
    { "a_node_that_is_its_own_child_is_refused", ",\"nodes\":[{\"children\":[0]}]", "cyclic" },
    { "a_missing_child_is_refused", ",\"nodes\":[{\"children\":[5]}]", "child 5" },
    { "a_node_twice_in_a_scene_is_refused", ",\"nodes\":[{}],\"scenes\":[{\"nodes\":[0,0]}]", "twice" },
    { "a_missing_root_is_refused", ",\"nodes\":[{}],\"scenes\":[{\"nodes\":[3]}]", "node 3" },
    { "a_missing_scene_is_refused", ",\"scene\":2,\"scenes\":[{}]", "scene 2" },
    { "a_missing_mesh_is_refused", ",\"nodes\":[{\"mesh\":0}]", "mesh 0" },
    { "a_camera_that_ends_before_it_begins_is_refused",
      ",\"cameras\":[{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,\"znear\":2,"
      "\"zfar\":2}}],\"nodes\":[{\"camera\":0}]",
      "cameras[0]: zfar must be greater" },
    { "a_missing_camera_is_refused", ",\"nodes\":[{\"camera\":1}]", "camera 1" },
    { "a_missing_light_is_refused",
      ",\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}}]" LIGHT("{\"type\":\"point\"}"),
      "light 1" },
    { "an_unknown_light_type_is_refused",
      ",\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]" LIGHT("{\"type\":\"area\"}"),
      "'area'" },
    { "a_transform_that_overflows_is_refused",
      ",\"nodes\":[{\"scale\":[1e200,1,1],\"children\":[1]},{\"scale\":[1e200,1,1]}]",
      "nodes[1]: the transform" },
    { "bounds_that_overflow_are_refused",
      ",\"meshes\":[{\"primitives\":[{" ATTRIBUTES "}]}],\"nodes\":[{\"mesh\":0,\"scale\":[1.7e308,1,1],"
      "\"translation\":[1.7e308,0,0]}]",
      "bounds" },
    { "a_number_too_large_for_a_double_is_refused", ",\"nodes\":[{\"translation\":[1e999,0,0]}]",
      "translation" },
    { "a_matrix_with_perspective_is_refused", ",\"nodes\":[{\"matrix\":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1]}]",
      "not affine" },
    { "a_short_matrix_is_refused", ",\"nodes\":[{\"matrix\":[1,0,0,0]}]",
      "nodes[0].matrix is not an array of 16" },
    { "a_string_for_a_number_is_refused", ",\"nodes\":[{\"mesh\":\"0\"}]", "nodes[0].mesh is not an index" },
    { "an_index_of_33_bits_is_refused", ",\"nodes\":[{\"mesh\":4294967296}]", "nodes[0].mesh" },
    { "a_mesh_without_attributes_is_refused", ",\"meshes\":[{\"primitives\":[{}]}]",
      "attributes is missing" },
    { "a_missing_image_file_is_refused", ",\"images\":[{\"uri\":\"gone.png\"}],\"textures\":[{\"source\":0}]",
      "images[0]: 'gone.png': No such file" },
    { "a_file_outside_of_the_folder_is_refused",
      ",\"images\":[{\"uri\":\"a/../../x.png\"}],\"textures\":[{\"source\":0}]", "not a path below" },
    { "a_folder_for_an_image_is_refused", ",\"images\":[{\"uri\":\".\"}],\"textures\":[{\"source\":0}]",
      "not a plain file" },
    { "an_image_that_is_none_is_refused", ",\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}]",
      "not a PNG or JPEG" },
    { "a_missing_image_is_refused", ",\"textures\":[{\"source\":2}]", "image 2" },
    { "a_missing_texture_is_refused", ",\"materials\":[{\"normalTexture\":{\"index\":1}}]", "texture 1" },
    { "a_missing_sampler_is_refused", ",\"textures\":[{\"sampler\":1}]", "sampler 1" },
    { "an_unknown_alpha_mode_is_refused", ",\"materials\":[{\"alphaMode\":\"GLASS\"}]", "'GLASS'" },
    { "a_key_that_is_given_twice_is_refused", ",\"skins\":[],\"nodes\":[],\"skins\":[]",
      "skins is given twice" },
    { "an_inner_key_that_is_given_twice_is_refused", ",\"nodes\":[{},{\"name\":\"a\",\"name\":\"a\"}]",
      "nodes[1].name is given twice" },
    { "a_uri_that_is_given_twice_is_refused",
      ",\"images\":[{\"uri\":\"a.png\",\"uri\":\"b.png\"}],\"textures\":[{\"source\":0}]",
      "images[0].uri is given twice" },
    { "a_required_extension_is_named", ",\"extensionsRequired\":[\"KHR_texture_transform\",\"VENDOR_new\"]",
      "requires VENDOR_new, which is not supported" },
    { "an_extension_without_a_library_says_what_to_do", ",\"extensionsRequired\":[\"KHR_texture_basisu\"]",
      "requires KHR_texture_basisu, which this build does not have: build it with -Dktx2=enabled (libktx" },
};

/* The row's own accessors and views replace those of the base draft, so that names are there once. */
static void row_write(const struct broken *row, const char *file)
{
    struct draft d = { 0 };
    base_draft(&d);
    if (strstr(row->rest, "\"accessors\"") != NULL)
        d.accessor_count = 0;
    char rest[2048], buffers[64];
    snprintf(buffers, sizeof buffers, ",\"buffers\":[{\"byteLength\":%zu}]", d.binary_size);
    const bool own_views = strstr(row->rest, "\"bufferViews\"") != NULL;
    snprintf(rest, sizeof rest, "%s%s", row->rest, own_views ? buffers : "");
    if (own_views)
        d.view_count = 0;
    draft_write(&d, rest, file);
}

static void refused_expect(const char *file, const char *wrong)
{
    char error[512];
    struct gltf_scene *const scene = gltf_scene_load(files_path(file), error, sizeof error);
    if (scene != NULL)
        fail_msg("%s was accepted", file);
    if (strstr(error, file) == NULL || strstr(error, wrong) == NULL || strchr(error, '\n') != NULL)
        fail_msg("the message is '%s'; it should hold '%s' and '%s'", error, file, wrong);
}

static void row_is_refused(void **state)
{
    const struct broken *const row = *state;
    row_write(row, "broken.glb");
    refused_expect("broken.glb", row->wrong);
}

/* The same draft, unbroken, loads: what the rows break is what they are refused for. */
static void the_unbroken_file_loads(void **state)
{
    (void)state;
    struct draft d = { 0 };
    base_draft(&d);
    struct gltf_scene *const s = draft_load(&d, MESH(ATTRIBUTES ",\"indices\":1"));
    assert_int_equal(s->instance_count, 1);
    gltf_scene_destroy(s);
}

static void every_truncation_is_refused(void **state)
{
    (void)state;
    struct draft d = { 0 };
    char json[4096];
    uint8_t file[8192];
    base_draft(&d);
    draft_json(&d, TRIANGLE, json, sizeof json);
    const size_t size = glb_assemble(file, sizeof file, json, d.binary, d.binary_size);
    for (size_t kept = 0; kept < size; kept += kept < 40 ? 1 : 13) {
        files_write("cut.glb", file, kept);
        refused_expect("cut.glb", "");
    }
}

static void text_is_refused(const char *text, const char *wrong)
{
    files_write_text("broken.gltf", text);
    refused_expect("broken.gltf", wrong);
}

static void text_that_is_not_gltf_is_refused(void **state)
{
    (void)state;
    text_is_refused("", "empty");
    text_is_refused("hello", "JSON");
    text_is_refused("[]", "not an object");
    text_is_refused("{\"asset\":{\"version\":\"2.0\"}", "JSON");
    text_is_refused("{\"asset\":{\"version\":\"2.0\"}} x", "after its end");
    text_is_refused("{}", "asset is missing");
    text_is_refused("{\"asset\":{\"version\":\"1.0\"}}", "version '1.0'");
    text_is_refused("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}", "version '2.1'");
}

static void deep_nesting_is_refused(void **state)
{
    (void)state;
    enum { DEPTH = 200000 };
    static char text[DEPTH + 64];
    const int start = snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},\"extras\":");
    memset(text + start, '[', DEPTH);
    text_is_refused(text, "JSON");
}

static void broken_buffers_are_refused(void **state)
{
    (void)state;
#define BUFFER(members) "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{" members "}]}"
    files_write_text("short.bin", "abc");
    text_is_refused(BUFFER("\"byteLength\":4,\"uri\":\"gone.bin\""), "'gone.bin': No such file");
    text_is_refused(BUFFER("\"byteLength\":4,\"uri\":\"short.bin\""), "byteLength is 4, and there are 3");
    text_is_refused(BUFFER("\"byteLength\":999999999999999,\"uri\":\"short.bin\""), "there are 3");
    text_is_refused(BUFFER("\"byteLength\":0,\"uri\":\"short.bin\""), "zero");
    text_is_refused(BUFFER("\"byteLength\":4"), "neither a uri nor");
    text_is_refused(BUFFER("\"byteLength\":4,\"uri\":\"data:text/plain,abcd\""), "not base64");
    text_is_refused(BUFFER("\"byteLength\":4,\"uri\":\"/etc/hostname\""), "not a path below");
}

/* The first link points at the file beside it, the other two at what lies elsewhere. */
static void links_that_lead_outside_of_the_folder_are_refused(void **state)
{
    (void)state;
    files_write_text("near.bin", "abc");
    assert_int_equal(symlink("near.bin", files_path("inside.bin")), 0);
    assert_int_equal(symlink("/etc/passwd", files_path("outside.bin")), 0);
    assert_int_equal(symlink("/etc", files_path("outside")), 0);
    files_write_text("link.gltf", BUFFER("\"byteLength\":3,\"uri\":\"inside.bin\""));
    gltf_scene_destroy(file_load("link.gltf"));
    text_is_refused(BUFFER("\"byteLength\":3,\"uri\":\"outside.bin\""), "'outside.bin' leads outside");
    text_is_refused(BUFFER("\"byteLength\":3,\"uri\":\"outside/passwd\""), "leads outside");
}
#undef BUFFER

/* The second file is a hole that takes no room on the disk; reading it would take 4 GiB of memory. */
static void buffers_of_more_than_4_gib_in_all_are_refused(void **state)
{
    (void)state;
    files_write_text("small.bin", "abc");
    files_write_text("hole.bin", "abc");
    assert_int_equal(truncate(files_path("hole.bin"), UINT32_MAX), 0);
    text_is_refused("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"small.bin\"},"
                    "{\"byteLength\":3,\"uri\":\"hole.bin\"}]}",
                    "buffers[1]: 'hole.bin': larger than 4294967292 bytes");
}

static void image_is_refused(const struct png *image, size_t keep, const char *wrong)
{
    struct draft d = { 0 };
    uint8_t file[4096];
    const size_t size = png_encode(image, file, sizeof file);
    draft_view(&d, file, keep == 0 ? size : keep);
    draft_write(&d, ",\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}]", "image.glb");
    refused_expect("image.glb", wrong);
}

static void broken_images_are_refused(void **state)
{
    (void)state;
    static const uint8_t texel[4] = { 1, 2, 3, 4 };
    image_is_refused(&(struct png){ 0, 0, 8, texel }, 0, "images[0]");
    image_is_refused(&(struct png){ 100000, 0, 8, texel }, 0, "images[0]");
    image_is_refused(&(struct png){ 1, 1, 8, texel }, 40, "images[0]");
    image_is_refused(&(struct png){ 1, 1, 3, texel }, 0, "images[0]");
}

/* A decoder that trusts the table's 257 codes writes past its end; with 256 it confuses the last. */
static void a_jpeg_with_too_many_huffman_codes_is_refused(void **state)
{
    (void)state;
    uint8_t jpeg[400] = { 0xff, 0xd8, 0xff, 0xfe, 0, 4, 'h', 'i', 0xff, 0xc4, 1, 0x40 };
    memset(jpeg + 13, 16, 16);
    static const char *const reasons[] = { "not a PNG or JPEG", "256 codes", "257 codes" };
    for (int codes = 255; codes <= 257; codes++) {
        struct draft d = { 0 };
        jpeg[28] = (uint8_t)(codes - 240);
        draft_view(&d, jpeg, sizeof jpeg);
        draft_write(&d, ",\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}]", "image.glb");
        refused_expect("image.glb", reasons[codes - 255]);
    }
}

/* A frame of 8 x 8, or of as many texels as 16 bits can say, and `scans` scans without data. */
static size_t empty_jpeg(uint8_t *out, bool large, int scans)
{
    static const uint8_t frame[] = { 0xff, 0xd8, 0xff, 0xc2, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0 };
    static const uint8_t scan[] = { 0xff, 0xda, 0, 8, 1, 1, 0, 1, 1, 0 };
    memcpy(out, frame, sizeof frame);
    if (large)
        memset(out + 7, 0x3f, 4);
    for (int i = 0; i < scans; i++)
        memcpy(out + sizeof frame + (size_t)i * sizeof scan, scan, sizeof scan);
    return sizeof frame + (size_t)scans * sizeof scan;
}

static void jpegs_that_cost_more_than_their_bytes_are_refused(void **state)
{
    (void)state;
    static const struct {
        bool large;
        int scans;
        const char *wrong;
    } cases[] = { { true, 1, "too short" }, { false, 65, "65 scans" }, { false, 64, "cannot be decoded" } };
    for (int i = 0; i < 3; i++) {
        struct draft d = { 0 };
        uint8_t jpeg[1024];
        draft_view(&d, jpeg, empty_jpeg(jpeg, cases[i].large, cases[i].scans));
        draft_write(&d, ",\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}]", "image.glb");
        refused_expect("image.glb", cases[i].wrong);
    }
}

static void a_small_png_cannot_claim_a_large_picture(void **state)
{
    (void)state;
    static const uint8_t texel[4];
    struct draft d = { 0 };
    uint8_t png[256];
    const size_t size = png_encode(&(struct png){ 1, 1, 8, texel }, png, sizeof png);
    png_resize(png, 8192, 8192);
    draft_view(&d, png, size);
    draft_write(&d, ",\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}]", "image.glb");
    refused_expect("image.glb", "too short");
}

static void missing_files_folders_and_pipes_are_refused(void **state)
{
    (void)state;
    char error[64];
    refused_expect("not_there.glb", "No such file");
    assert_int_equal(mkfifo(files_path("pipe.glb"), 0600), 0);
    refused_expect("pipe.glb", "not a plain file");
    assert_null(gltf_scene_load(files_path(""), error, sizeof error));
    assert_null(gltf_scene_load(NULL, error, sizeof error));
    assert_true(strlen(error) > 0);
}

static void messages_end_where_the_buffer_does(void **state)
{
    (void)state;
    char error[8] = "xxxxxxx";
    assert_null(gltf_scene_load("a_rather_long_name.glb", error, 6));
    assert_string_equal(error, "a_rat");
    assert_int_equal(error[6], 'x');
    assert_null(gltf_scene_load("a_rather_long_name.glb", NULL, 0));
    gltf_scene_destroy(NULL);
}

enum { ROW_COUNT = sizeof rows / sizeof *rows, FIXED_COUNT = 13 };

int main(void)
{
    struct CMUnitTest tests[FIXED_COUNT + ROW_COUNT] = {
        cmocka_unit_test(the_unbroken_file_loads),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(text_that_is_not_gltf_is_refused),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(broken_buffers_are_refused),
        cmocka_unit_test(links_that_lead_outside_of_the_folder_are_refused),
        cmocka_unit_test(buffers_of_more_than_4_gib_in_all_are_refused),
        cmocka_unit_test(broken_images_are_refused),
        cmocka_unit_test(a_jpeg_with_too_many_huffman_codes_is_refused),
        cmocka_unit_test(jpegs_that_cost_more_than_their_bytes_are_refused),
        cmocka_unit_test(a_small_png_cannot_claim_a_large_picture),
        cmocka_unit_test(missing_files_folders_and_pipes_are_refused),
        cmocka_unit_test(messages_end_where_the_buffer_does),
    };
    for (size_t i = 0; i < ROW_COUNT; i++)
        tests[FIXED_COUNT + i] =
            (struct CMUnitTest){ rows[i].name, row_is_refused, NULL, NULL, (void *)&rows[i] };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
