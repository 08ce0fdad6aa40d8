/* SPDX-License-Identifier: MIT
 *
 * Node hierarchies, scenes, lights and cameras, and the warning.
 */
#include "scene_files.h"

#include <math.h>
#include <string.h>

static const double half_turn = 3.14159265358979323846;

/* A file with one triangle, mesh 0, and `rest`. */
static struct gltf_scene *nodes_load(const char *rest)
{
    struct draft d = { 0 };
    char all[4096];
    draft_floats(&d, "VEC3", 3, (const float[]){ 0, 0, 0, 1, 0, 0, 0, 2, 0 });
    snprintf(all, sizeof all, ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]%s", rest);
    return draft_load(&d, all);
}

static void doubles_expect(const double *got, const double *want, size_t count, double tolerance)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs(got[i] - want[i]) <= tolerance))
            fail_msg("value %zu is %.17g, not %.17g", i, got[i], want[i]);
}

static void floats_expect(const float *got, const double *want, size_t count, double tolerance)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs((double)got[i] - want[i]) <= tolerance))
            fail_msg("value %zu is %.9g, not %.17g", i, (double)got[i], want[i]);
}

/* 10^7 + 1/1024 has no float: the sum survives only in double. */
static void transforms_compose_in_double_precision(void **state)
{
    (void)state;
    struct gltf_scene *const s =
        nodes_load(",\"nodes\":[{\"translation\":[10000000,0,0],\"children\":[1]},"
                   "{\"name\":\"leaf\",\"mesh\":0,\"translation\":[0.0009765625,5,0],\"scale\":[2,3,4]}]");
    assert_int_equal(s->instance_count, 1);
    assert_string_equal(s->instances[0].node_name, "leaf");
    doubles_expect(s->instances[0].transform,
                   (const double[]){ 2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10000000.0009765625, 5, 0, 1 }, 16,
                   0);
    gltf_scene_destroy(s);
}

static void a_matrix_equals_its_translation_rotation_and_scale(void **state)
{
    (void)state;
    struct gltf_scene *const s =
        nodes_load(",\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3],\"rotation\":[0,0,0.70710678118654752,"
                   "0.70710678118654752],\"scale\":[2,3,4]},{\"mesh\":0,\"matrix\":[0,2,0,0,-3,0,0,0,0,0,4,0,"
                   "1,2,3,1]}]");
    assert_int_equal(s->instance_count, 2);
    assert_int_equal(s->primitive_count, 1); /* shared */
    doubles_expect(s->instances[0].transform, s->instances[1].transform, 16, 1e-14);
    gltf_scene_destroy(s);
}

static void parents_turn_and_scale_their_children(void **state)
{
    (void)state;
    struct gltf_scene *const s = nodes_load(
        ",\"nodes\":[{\"rotation\":[0,0.70710678118654752,0,0.70710678118654752],\"scale\":[2,2,2],"
        "\"children\":[1]},{\"mesh\":0,\"translation\":[1,0,0]}]");
    /* A quarter turn about Y takes +X to -Z. */
    doubles_expect(s->instances[0].transform + 12, (const double[]){ 0, 0, -2, 1 }, 4, 1e-14);
    gltf_scene_destroy(s);
}

static void the_default_scene_is_drawn_else_the_first_else_all_roots(void **state)
{
    (void)state;
    static const struct {
        const char *scenes;
        double x[2];
        uint32_t count;
    } rows[] = {
        { ",\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}]", { 2, 0 }, 1 },
        { ",\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}]", { 1, 0 }, 1 },
        { "", { 1, 2 }, 2 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char rest[512];
        snprintf(rest, sizeof rest,
                 ",\"nodes\":[{\"mesh\":0,\"translation\":[1,0,0]},{\"mesh\":0,\"translation\":[2,0,0]}]%s",
                 rows[i].scenes);
        struct gltf_scene *const s = nodes_load(rest);
        assert_int_equal(s->instance_count, rows[i].count);
        for (uint32_t k = 0; k < rows[i].count; k++)
            assert_true(s->instances[k].transform[12] == rows[i].x[k]);
        gltf_scene_destroy(s);
    }
}

static void bounds_hold_all_instances(void **state)
{
    (void)state;
    struct gltf_scene *const s =
        nodes_load(",\"nodes\":[{\"mesh\":0,\"translation\":[10,0,0],\"scale\":[-1,1,1]},{\"mesh\":0}]");
    doubles_expect(s->bounds_min, (const double[]){ 0, 0, 0 }, 3, 0);
    doubles_expect(s->bounds_max, (const double[]){ 10, 2, 0 }, 3, 0);
    gltf_scene_destroy(s);
}

/* Ten thousand nodes in one chain: no recursion of the loader is that deep. */
static void deep_hierarchies_are_walked(void **state)
{
    (void)state;
    enum { DEPTH = 10000 };
    static char json[DEPTH * 64];
    static uint8_t file[sizeof json + 64];
    int length = snprintf(json, sizeof json,
                          "{\"asset\":{\"version\":\"2.0\"},\"cameras\":[{\"type\":\"perspective\","
                          "\"perspective\":{\"yfov\":1,\"znear\":0.1}}],\"nodes\":[");
    for (int i = 0; i < DEPTH - 1; i++)
        length += snprintf(json + length, sizeof json - (size_t)length,
                           "{\"translation\":[1,0,0],\"children\":[%d]},", i + 1);
    snprintf(json + length, sizeof json - (size_t)length, "{\"camera\":0}]}");
    files_write("deep.glb", file, glb_assemble(file, sizeof file, json, NULL, 0));
    struct gltf_scene *const s = file_load("deep.glb");
    assert_true(s->cameras[0].transform[12] == DEPTH - 1);
    gltf_scene_destroy(s);
}

static void lights_shine_along_minus_z_whatever_their_node_s_scale(void **state)
{
    (void)state;
    struct gltf_scene *const s = nodes_load(
        ",\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
        "{\"type\":\"directional\",\"name\":\"sun\",\"color\":[1,0.5,0.25],\"intensity\":8},"
        "{\"type\":\"point\",\"intensity\":100,\"range\":7},"
        "{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}},"
        "{\"type\":\"spot\",\"spot\":{\"innerConeAngle\":3,\"outerConeAngle\":2}}]}},"
        "\"nodes\":[{\"rotation\":[-0.70710678118654752,0,0,0.70710678118654752],\"scale\":[1,2,3],"
        "\"translation\":[4,5,6],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
        "{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},"
        "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}},"
        "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":3}}}]");
    const struct gltf_light *const l = s->lights;
    assert_int_equal(s->light_count, 4);
    assert_int_equal(l[0].type, GLTF_LIGHT_DIRECTIONAL);
    assert_string_equal(l[0].name, "sun");
    floats_expect(l[0].direction, (const double[]){ 0, -1, 0 }, 3, 1e-7);
    floats_expect(l[0].intensity, (const double[]){ 8, 4, 2 }, 3, 0);
    assert_int_equal(l[1].type, GLTF_LIGHT_POINT);
    doubles_expect(l[1].position, (const double[]){ 1, 2, 3 }, 3, 0);
    floats_expect(l[1].intensity, (const double[]){ 100, 100, 100 }, 3, 0);
    floats_expect((const float[]){ l[0].range, l[1].range }, (const double[]){ 0, 7 }, 2, 0);
    assert_int_equal(l[2].type, GLTF_LIGHT_SPOT);
    floats_expect(l[2].direction, (const double[]){ 0, 0, -1 }, 3, 0);
    floats_expect((const float[]){ l[2].inner_rad, l[2].outer_rad }, (const double[]){ 0.25, 0.5 }, 2, 0);
    floats_expect(&l[3].outer_rad, (const double[]){ half_turn / 2 }, 1, 1e-6);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

static void cameras_are_rigid_and_keep_their_lens(void **state)
{
    (void)state;
    struct gltf_scene *const s = nodes_load(
        ",\"cameras\":[{\"type\":\"perspective\",\"name\":\"eye\",\"perspective\":{\"yfov\":0.75,\"znear\":0."
        "1}},"
        "{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,\"ymag\":-3,\"znear\":0.5,\"zfar\":9}}],"
        "\"nodes\":[{\"camera\":0,\"scale\":[2,3,4],\"translation\":[1,2,3]},{\"camera\":1}]");
    assert_int_equal(s->camera_count, 2);
    assert_string_equal(s->cameras[0].name, "eye");
    doubles_expect(s->cameras[0].transform,
                   (const double[]){ 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1 }, 16, 1e-15);
    floats_expect(&s->cameras[0].yfov_rad, (const double[]){ 0.75 }, 1, 0);
    const struct gltf_camera *flat = &s->cameras[1];
    floats_expect((const float[]){ flat->yfov_rad, flat->ymag, flat->znear, flat->zfar },
                  (const double[]){ 0, 3, 0.5, 9 }, 4, 0);
    gltf_scene_destroy(s);
}

static void a_scene_without_meshes_is_empty(void **state)
{
    (void)state;
    struct draft d = { 0 };
    struct gltf_scene *const s = draft_load(&d, "");
    assert_int_equal(s->primitive_count + s->instance_count + s->light_count + s->material_count, 0);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

static void one_warning_names_everything_left_out(void **state)
{
    (void)state;
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 3, (const float[]){ 0, 0, 0, 1, 0, 0, 0, 2, 0 });
    struct gltf_scene *const s = draft_load(
        &d, ",\"extensionsUsed\":[\"KHR_materials_clearcoat\",\"VENDOR_new\\nline\",\"KHR_lights_punctual\"],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0}]},"
            "{\"mode\":1,\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]");
    static const char *const names[] = { "draft.glb", "KHR_materials_clearcoat", "VENDOR_new line",
                                         "1 primitives of points or lines" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strstr(s->warning, names[i]) == NULL)
            fail_msg("'%s' is not in '%s'", names[i], s->warning);
    assert_null(strstr(s->warning, "KHR_lights_punctual"));
    gltf_scene_destroy(s);
}

/* 254 bytes and a character of two: it goes whole. */
static void long_names_are_cut_between_characters(void **state)
{
    (void)state;
    char name[400] = { 0 }, rest[512];
    memset(name, 'n', 254);
    memcpy(name + 254, "\xc3\xa9 and more", 11);
    snprintf(rest, sizeof rest, ",\"nodes\":[{\"mesh\":0,\"name\":\"%s\"}]", name);
    struct gltf_scene *const s = nodes_load(rest);
    name[254] = '\0';
    assert_string_equal(s->instances[0].node_name, name);
    gltf_scene_destroy(s);
}

static void whole_numbers_may_be_written_with_a_point(void **state)
{
    (void)state;
    struct gltf_scene *const s =
        nodes_load(",\"nodes\":[{\"mesh\":0.0}],\"scene\":0.0,\"scenes\":[{\"nodes\":[0.0]}]");
    assert_int_equal(s->instance_count, 1);
    gltf_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_compose_in_double_precision),
        cmocka_unit_test(a_matrix_equals_its_translation_rotation_and_scale),
        cmocka_unit_test(parents_turn_and_scale_their_children),
        cmocka_unit_test(the_default_scene_is_drawn_else_the_first_else_all_roots),
        cmocka_unit_test(bounds_hold_all_instances),
        cmocka_unit_test(deep_hierarchies_are_walked),
        cmocka_unit_test(lights_shine_along_minus_z_whatever_their_node_s_scale),
        cmocka_unit_test(cameras_are_rigid_and_keep_their_lens),
        cmocka_unit_test(a_scene_without_meshes_is_empty),
        cmocka_unit_test(one_warning_names_everything_left_out),
        cmocka_unit_test(long_names_are_cut_between_characters),
        cmocka_unit_test(whole_numbers_may_be_written_with_a_point),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
