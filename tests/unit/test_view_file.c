/* SPDX-License-Identifier: MIT */
#include "files.h"
#include "unit.h"

#include "view/view_file.h"

#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <string.h>

#define CAMERA "\"camera\":{\"position\":[0,1,2],\"look_at\":[0,0,0],\"yfov_deg\":60}"

static const char file_name[] = "view.json";
static char error[300];
static struct host_view view;

/* The host's own lives beside its Vulkan code, which a unit test does without. */
void host_view_default(struct host_view *out)
{
    *out = (struct host_view){ .camera = { .position = { 0, 0, 5 }, .up = { 0, 1, 0 }, .yfov_rad = 1 },
                               .punctual_scale = 1,
                               .emissive_scale = 1,
                               .default_albedo = { 0.8f, 0.8f, 0.8f } };
}

static bool load(const char *text)
{
    files_write_text(file_name, text);
    return view_file_load(files_path(file_name), &view, error, sizeof error);
}

static void a_camera_is_enough(void **state)
{
    (void)state;
    assert_true(load("{" CAMERA "}"));
    assert_true(view.camera.position[2] == 2 && view.camera.up[1] == 1);
    assert_true(fabsf(view.camera.yfov_rad - 1.0471976f) < 1e-6f);
    assert_false(view.sun.enabled);
    assert_true(view.punctual_scale == 1 && view.emissive_scale == 1);
    assert_int_equal(view.materials, HOST_MATERIALS_GLTF);
    assert_int_equal(view.light_count, 0);
    view_file_finish(&view);
}

static void every_key_reaches_its_field(void **state)
{
    (void)state;
    assert_true(
        load("{" CAMERA ",\"sky\":{\"zenith\":[1,2,3],\"horizon\":[4,5,6],\"ground\":[7,8,9]},"
             "\"sun\":{\"direction\":[0,-2,0],\"irradiance\":[3,2,1],\"angle_deg\":90},"
             "\"fog\":{\"density\":0.5,\"albedo\":[0.9,0.8,0.7],\"height_falloff\":0.25,\"height\":1e7,"
             "\"anisotropy\":-0.9},"
             "\"lights\":[{\"type\":\"point\",\"position\":[1e7,2,3],\"intensity\":[4,5,6],\"radius\":0.5},"
             "{\"type\":\"spot\",\"position\":[0,0,0],\"intensity\":[1,1,1],\"direction\":[1,0,0],"
             "\"inner_deg\":10,\"outer_deg\":45}],"
             "\"punctual_scale\":0,\"emissive_scale\":2,\"materials\":\"lambert\","
             "\"default_albedo\":[0.1,0.2,0.3]}"));
    assert_true(view.sky.zenith[1] == 2 && view.sky.horizon[2] == 6 && view.sky.ground[0] == 7);
    assert_true(view.sun.enabled && view.sun.direction[1] == -2 && view.sun.irradiance[0] == 3);
    assert_true(fabsf(view.sun.angle_rad - 1.5707963f) < 1e-6f);
    assert_true(view.fog.density == 0.5f && view.fog.albedo[1] == 0.8f && view.fog.height_m == 1e7);
    assert_true(view.fog.height_falloff == 0.25f && view.fog.anisotropy == -0.9f);
    assert_int_equal(view.light_count, 2);
    assert_int_equal(view.lights[0].type, HOST_LIGHT_POINT);
    assert_true(view.lights[0].position[0] == 1e7 && view.lights[0].radius_m == 0.5f);
    assert_int_equal(view.lights[1].type, HOST_LIGHT_SPOT);
    assert_true(fabsf(view.lights[1].outer_rad - 0.7853982f) < 1e-6f);
    assert_true(view.punctual_scale == 0 && view.emissive_scale == 2);
    assert_int_equal(view.materials, HOST_MATERIALS_LAMBERT);
    assert_true(view.default_albedo[2] == 0.3f);
    view_file_finish(&view);
}

#define FLAT "\"position\":[0,1,2],\"look_at\":[0,0,0]"

static void a_camera_may_be_orthographic(void **state)
{
    (void)state;
    assert_true(load("{\"camera\":{" FLAT ",\"ymag\":2.5,\"znear\":0.5,\"zfar\":30}}"));
    assert_true(view.camera.ymag_m == 2.5f && view.camera.znear_m == 0.5f && view.camera.zfar_m == 30);
    assert_true(load("{\"camera\":{" FLAT ",\"ymag\":2}}"));
    assert_true(view.camera.znear_m == 0 && view.camera.zfar_m == HOST_ZFAR_M);
    assert_true(load("{" CAMERA "}"));
    assert_true(view.camera.ymag_m == 0);
}

static void a_uniform_sky_has_three_equal_colours(void **state)
{
    (void)state;
    assert_true(load("{" CAMERA ",\"sky\":{\"radiance\":[0.1,0.2,0.3]},\"sun\":null}"));
    assert_memory_equal(view.sky.zenith, view.sky.horizon, sizeof view.sky.zenith);
    assert_memory_equal(view.sky.ground, view.sky.horizon, sizeof view.sky.ground);
    assert_true(view.sky.zenith[2] == 0.3f);
    view_file_finish(&view);
}

static void sky_and_sun_may_be_text_as_on_the_command_line(void **state)
{
    (void)state;
    assert_true(load("{" CAMERA ",\"sky\":\"1,2,3\",\"sun\":\"0,-2,0,5,6,7\"}"));
    assert_true(view.sky.zenith[1] == 2 && view.sky.ground[2] == 3);
    assert_true(view.sun.enabled && view.sun.direction[1] == -1 && view.sun.irradiance[2] == 7);
    assert_true(load("{" CAMERA ",\"sky\":\"day\",\"sun\":\"day\"}"));
    assert_memory_equal(&view.sky, &view_day_sky, sizeof view.sky);
    assert_true(view.sun.enabled && view.sun.irradiance[0] == view_day_sun.irradiance[0]);
    assert_true(load("{" CAMERA ",\"sky\":\"none\",\"sun\":\"none\"}"));
    assert_true(view.sky.zenith[0] == 0 && !view.sun.enabled);
}

static void write_map(void)
{
    static const float texels[2 * 3] = { 1, 2, 3, 4, 5, 6 };
    uint8_t file[64];
    const int head = snprintf((char *)file, sizeof file, "PF\n2 1\n-1\n");
    memcpy(file + head, texels, sizeof texels);
    files_write("map.pfm", file, (size_t)head + sizeof texels);
}

/* The tests' folder is not the one they run in. */
static void an_environment_lies_beside_the_file(void **state)
{
    (void)state;
    char text[512];
    write_map();
    assert_true(load("{" CAMERA ",\"environment\":\"map.pfm\",\"sun\":\"day\"}"));
    assert_int_equal(view.environment.width, 2);
    assert_true(view.environment.rgb[1] == 2 && view.environment.rgb[5] == 6);
    assert_true(view.sky.horizon[0] == 0 && view.sun.enabled);
    view_file_finish(&view);
    snprintf(text, sizeof text, "{" CAMERA ",\"sky\":null,\"environment\":\"%s\"}", files_path("map.pfm"));
    assert_true(load(text));
    assert_int_equal(view.environment.width, 2);
    view_file_finish(&view);
    assert_true(load("{" CAMERA ",\"environment\":null}"));
    assert_null(view.environment.rgb);
}

static void fog_needs_a_density_alone(void **state)
{
    (void)state;
    assert_true(load("{" CAMERA ",\"fog\":{\"density\":0.1}}"));
    assert_true(view.fog.density == 0.1f && view.fog.albedo[0] == 1 && view.fog.albedo[2] == 1);
    assert_true(view.fog.height_falloff == 0 && view.fog.height_m == 0 && view.fog.anisotropy == 0);
    assert_true(load("{" CAMERA ",\"fog\":null}"));
    assert_true(view.fog.density == 0);
}

static void what_is_wrong_is_named_in_one_line(void **state)
{
    (void)state;
    write_map();
    static const char *const cases[][2] = {
        { "", "line 1" },
        { "{\n" CAMERA ",\n}", "line 3" },
        { "{" CAMERA "} x", "broken JSON" },
        { "[]", "expected an object" },
        { "{}", "camera: is missing" },
        { "{\"camera\":3}", "camera: expected an object" },
        { "{" CAMERA ",\"skies\":null}", "skies: unknown key" },
        { "{" CAMERA "," CAMERA "}", "camera: given twice" },
        { "{\"camera\":{\"position\":[0,1,2]}}", "camera.look_at: is missing" },
        { "{\"camera\":{\"position\":[0,1],\"look_at\":[0,0,0]}}", "camera.position: expected an array" },
        { "{\"camera\":{\"position\":[0,1,\"2\"],\"look_at\":[0,0,0]}}",
          "camera.position: expected a number" },
        { "{\"camera\":{\"position\":[0,1,1e999],\"look_at\":[0,0,0]}}", "camera.position: is inf" },
        { "{\"camera\":{\"position\":[0,1,2],\"look_at\":[0,1,2]}}", "camera.look_at: equals" },
        { "{\"camera\":{\"position\":[0,1,0],\"look_at\":[0,0,0]}}", "camera.up: is parallel" },
        { "{\"camera\":{\"position\":[0,1,0],\"look_at\":[0,0,1],\"up\":[0,0,0]}}", "camera.up: has no" },
        { "{\"camera\":{\"position\":[0,1,0],\"look_at\":[0,0,1],\"yfov_deg\":180}}",
          "camera.yfov_deg: is 180" },
        { "{\"camera\":{" FLAT ",\"ymag\":0}}", "camera.ymag: is 0" },
        { "{\"camera\":{" FLAT ",\"ymag\":1,\"znear\":-1}}", "camera.znear: is -1" },
        { "{\"camera\":{" FLAT ",\"ymag\":1,\"yfov_deg\":60}}", "camera: yfov_deg is for perspective" },
        { "{\"camera\":{" FLAT ",\"zfar\":10}}", "camera: zfar is for orthographic" },
        { "{\"camera\":{" FLAT ",\"ymag\":1,\"znear\":5,\"zfar\":5}}", "camera: znear must be smaller" },
        { "{\"camera\":{" FLAT ",\"ymag\":1,\"znear\":20000}}", "camera: znear must be smaller" },
        { "{" CAMERA ",\"sky\":{\"radiance\":[-1,0,0]}}", "sky.radiance: is -1" },
        { "{" CAMERA ",\"sky\":{\"zenith\":[1,0,0]}}", "sky.horizon: is missing" },
        { "{" CAMERA ",\"sky\":{\"radiance\":[1,0,0],\"zenith\":[1,0,0]}}", "sky.zenith: unknown key" },
        { "{" CAMERA ",\"sky\":7}", "sky: expected an object" },
        { "{" CAMERA ",\"sky\":\"blue\"}", "sky: is \"blue\", expected none, day" },
        { "{" CAMERA ",\"sky\":\"1,2\"}", "sky: is \"1,2\"" },
        { "{" CAMERA ",\"sun\":\"0,0,0\"}", "sun: is \"0,0,0\", expected none, day" },
        { "{" CAMERA ",\"environment\":{}}", "environment: expected the name of a file" },
        { "{" CAMERA ",\"environment\":\"\"}", "environment: expected the name of a file" },
        { "{" CAMERA ",\"environment\":\"map.png\"}", "expected a picture of radiance" },
        { "{" CAMERA ",\"environment\":\"gone.hdr\"}", "gone.hdr" },
        { "{" CAMERA ",\"environment\":\"map.pfm\",\"sky\":\"day\"}", "environment: and sky" },
        { "{" CAMERA ",\"environment\":\"map.pfm\",\"sun\":\"1\"}", "sun: is \"1\"" },
        { "{" CAMERA ",\"sun\":{\"direction\":[0,0,0],\"irradiance\":[1,1,1]}}", "sun.direction: has no" },
        { "{" CAMERA ",\"sun\":{\"direction\":[0,-1,0]}}", "sun.irradiance: is missing" },
        { "{" CAMERA ",\"fog\":0.1}", "fog: expected an object" },
        { "{" CAMERA ",\"fog\":{}}", "fog.density: is missing" },
        { "{" CAMERA ",\"fog\":{\"density\":-1}}", "fog.density: is -1" },
        { "{" CAMERA ",\"fog\":{\"density\":1,\"albedo\":[1,1,1.5]}}", "fog.albedo: is 1.5" },
        { "{" CAMERA ",\"fog\":{\"density\":1,\"height_falloff\":-1}}", "fog.height_falloff: is -1" },
        { "{" CAMERA ",\"fog\":{\"density\":1,\"height\":[0]}}", "fog.height: expected a number" },
        { "{" CAMERA ",\"fog\":{\"density\":1,\"height\":1e12}}", "fog.height: is 1e+12" },
        { "{" CAMERA ",\"fog\":{\"density\":1,\"anisotropy\":1}}", "fog.anisotropy: is 1" },
        { "{" CAMERA ",\"fog\":{\"density\":1,\"colour\":1}}", "fog.colour: unknown key" },
        { "{" CAMERA ",\"lights\":{}}", "lights: expected an array" },
        { "{" CAMERA ",\"lights\":[{\"type\":\"area\"}]}", "lights[0].type: expected one of point,spot" },
        { "{" CAMERA ",\"lights\":[{\"type\":\"point\",\"position\":[0,0,0],\"intensity\":[1,1,1],"
          "\"direction\":[0,0,1]}]}",
          "lights[0]: direction is for spot" },
        { "{" CAMERA ",\"lights\":[{\"type\":\"spot\",\"position\":[0,0,0],\"intensity\":[1,1,1],"
          "\"direction\":[0,0,1],\"inner_deg\":50,\"outer_deg\":40}]}",
          "lights[0]: inner_deg" },
        { "{" CAMERA ",\"materials\":\"toon\"}", "materials: expected one of gltf,lambert" },
        { "{" CAMERA ",\"default_albedo\":[1,1,2]}", "default_albedo: is 2" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (load(cases[i][0]))
            fail_msg("taken: %s", cases[i][0]);
        assert_int_equal(strncmp(error, files_path(file_name), strlen(files_path(file_name))), 0);
        if (!strstr(error, cases[i][1]) || strchr(error, '\n'))
            fail_msg("\"%s\" does not say \"%s\"", error, cases[i][1]);
        assert_null(view.lights);
        assert_null(view.environment.rgb);
    }
    assert_false(view_file_load("no-such-folder/view.json", &view, error, sizeof error));
    assert_non_null(strstr(error, "no-such-folder/view.json"));
}

/* Broken anywhere, a file is refused and nothing is leaked or read out of bounds. */
static void every_truncation_is_refused(void **state)
{
    (void)state;
    const char whole[] =
        "{" CAMERA ",\"lights\":[{\"type\":\"point\",\"position\":[1,2,3],\"intensity\":[4,5,6]}]}";
    char part[sizeof whole];
    for (size_t length = 0; length + 1 < sizeof whole; length++) {
        memcpy(part, whole, length);
        part[length] = '\0';
        assert_false(load(part));
    }
    assert_true(load(whole));
    view_file_finish(&view);
}

static void the_camera_of_a_scene_looks_along_minus_z(void **state)
{
    (void)state;
    struct gltf_camera camera = { .transform = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1 },
                                  .yfov_rad = 0.8f };
    struct gltf_light light = { .type = GLTF_LIGHT_POINT };
    const struct gltf_scene scene = {
        .cameras = &camera, .camera_count = 1, .lights = &light, .light_count = 1
    };
    view_file_from_scene(&scene, 16.0 / 9, &view);
    assert_true(view.camera.position[0] == 5 && view.camera.look_at[0] == 5);
    assert_true(view.camera.position[2] == 7 && view.camera.look_at[2] == 6);
    assert_true(view.camera.yfov_rad == 0.8f);
    assert_false(view.sun.enabled);
}

static void an_orthographic_camera_of_a_scene_is_taken(void **state)
{
    (void)state;
    struct gltf_camera camera = {
        .transform = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1 }, .ymag = 3, .znear = 1, .zfar = 50
    };
    const struct gltf_scene scene = { .cameras = &camera, .camera_count = 1 };
    view_file_from_scene(&scene, 1, &view);
    assert_true(view.camera.position[1] == 6 && view.camera.look_at[2] == 6);
    assert_true(view.camera.ymag_m == 3 && view.camera.znear_m == 1 && view.camera.zfar_m == 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_camera_is_enough),
        cmocka_unit_test(a_camera_may_be_orthographic),
        cmocka_unit_test(an_orthographic_camera_of_a_scene_is_taken),
        cmocka_unit_test(every_key_reaches_its_field),
        cmocka_unit_test(a_uniform_sky_has_three_equal_colours),
        cmocka_unit_test(sky_and_sun_may_be_text_as_on_the_command_line),
        cmocka_unit_test(an_environment_lies_beside_the_file),
        cmocka_unit_test(fog_needs_a_density_alone),
        cmocka_unit_test(what_is_wrong_is_named_in_one_line),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(the_camera_of_a_scene_looks_along_minus_z),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
