/* SPDX-License-Identifier: MIT
 * Views for scenes that come without one, and the parts of a view that the command line gives. */
#include "files.h"
#include "unit.h"

#include "view/view_file.h"
#include "view/view_frame.h"
#include "view/view_glow.h"
#include "view/view_option.h"

#include <base/vec.h>
#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static struct host_view view;

/* In place of the renderer's. */
void host_view_default(struct host_view *out)
{
    *out = (struct host_view){ .camera = { .position = { 0, 0, 5 }, .up = { 0, 1, 0 }, .yfov_rad = 1 } };
}

/* ---- Boxes ------------------------------------------------------------------------------------------- */

/* Up to twelve sides of boxes, a primitive each, seen from where their corners go round counter-clockwise. */
enum { SIDES_MAX = 12 };
struct boxes {
    float positions[SIDES_MAX][12];
    uint32_t indices[6];
    struct gltf_primitive primitives[SIDES_MAX];
    struct gltf_instance instances[SIDES_MAX];
    struct gltf_material material;
    struct gltf_scene scene;
};

static void side_add(struct boxes *b, int axis, float sign, float half, bool inward)
{
    const uint32_t i = b->scene.instance_count++;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool turned = (sign < 0) != inward;
    static const float corners[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    for (int k = 0; k < 4; k++) {
        float *const p = b->positions[i] + 3 * k;
        p[axis] = sign * half;
        p[u] = corners[k][turned ? 1 : 0] * half;
        p[v] = corners[k][turned ? 0 : 1] * half;
    }
    b->primitives[i] = (struct gltf_primitive){
        .vertex_count = 4, .index_count = 6, .positions = b->positions[i], .indices = b->indices
    };
    b->instances[i] =
        (struct gltf_instance){ .primitive = i,
                                .transform = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 } };
}

/* `open` leaves out the side of +Z. */
static void box_add(struct boxes *b, float half, bool inward, bool open)
{
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2)
            if (!(open && axis == 2 && sign > 0))
                side_add(b, axis, (float)sign, half, inward);
}

static struct gltf_scene *boxes_finish(struct boxes *b, bool double_sided)
{
    memcpy(b->indices, (const uint32_t[]){ 0, 1, 2, 0, 2, 3 }, sizeof b->indices);
    b->material = (struct gltf_material){ .double_sided = double_sided, .emissive_texture.texture = -1 };
    b->scene.primitives = b->primitives;
    b->scene.instances = b->instances;
    b->scene.materials = &b->material;
    b->scene.primitive_count = b->scene.instance_count;
    b->scene.material_count = 1;
    for (int i = 0; i < 3; i++) {
        b->scene.bounds_min[i] = -1;
        b->scene.bounds_max[i] = 1;
    }
    return &b->scene;
}

static bool is_inside(const double p[3])
{
    return fabs(p[0]) < 1 && fabs(p[1]) < 1 && fabs(p[2]) < 1;
}

static void a_box_that_is_open_on_one_side_is_looked_into(void **state)
{
    (void)state;
    struct boxes b = { .scene = { 0 } };
    box_add(&b, 1, false, true);
    box_add(&b, 0.95f, true, true);
    host_view_default(&view);
    view_frame_scene(boxes_finish(&b, false), 16.0 / 9, &view.camera);
    assert_true(view.camera.position[2] > 1);
    assert_true(fabs(view.camera.position[0]) < 0.2 * view.camera.position[2]);
    assert_true(fabs(view.camera.position[1]) < 0.5 * view.camera.position[2]);
}

static void a_closed_room_is_seen_from_inside_and_a_solid_from_outside(void **state)
{
    (void)state;
    struct boxes room = { .scene = { 0 } }, solid = { .scene = { 0 } };
    box_add(&room, 1, false, false);
    box_add(&room, 0.95f, true, false);
    view_frame_scene(boxes_finish(&room, false), 16.0 / 9, &view.camera);
    assert_true(is_inside(view.camera.position));
    box_add(&solid, 1, false, false);
    for (int double_sided = 0; double_sided < 2; double_sided++) {
        view_frame_scene(boxes_finish(&solid, double_sided != 0), 16.0 / 9, &view.camera);
        assert_false(is_inside(view.camera.position));
    }
}

/* What the angle of view leaves of a corner's place: 1 at the border of the picture. */
static double corner_reach(const struct host_camera *camera, double aspect, const double corner[3])
{
    double forward[3], right[3],
        up[3] = { (double)camera->up[0], (double)camera->up[1], (double)camera->up[2] };
    double relative[3];
    base_vec3d_sub(camera->look_at, camera->position, forward);
    base_vec3d_normalize(forward);
    base_vec3d_cross(forward, up, right);
    base_vec3d_normalize(right);
    base_vec3d_cross(right, forward, up);
    base_vec3d_sub(corner, camera->position, relative);
    const double depth = base_vec3d_dot(relative, forward), tan_y = tan((double)camera->yfov_rad / 2);
    assert_true(depth > 0);
    return fmax(fabs(base_vec3d_dot(relative, right)) / (aspect * tan_y * depth),
                fabs(base_vec3d_dot(relative, up)) / (tan_y * depth));
}

static void a_scene_without_camera_fills_the_picture(void **state)
{
    (void)state;
    const struct gltf_scene scene = { .bounds_min = { 10, 0, -5 }, .bounds_max = { 14, 3, 7 } };
    for (double aspect = 0.5; aspect <= 2; aspect *= 2) {
        double most = 0;
        view_file_from_scene(&scene, aspect, &view);
        for (int i = 0; i < 8; i++) {
            const double corner[3] = { i & 1 ? 10 : 14, i & 2 ? 0 : 3, i & 4 ? -5 : 7 };
            most = fmax(most, corner_reach(&view.camera, aspect, corner));
        }
        assert_true(most > 0.93 && most < 0.95);
    }
}

static void cells_fit_scenes_that_are_larger_or_smaller_than_cascades(void **state)
{
    (void)state;
    const struct host_camera camera = { .position = { 0, 0, 100 } };
    struct gltf_scene scene = { .bounds_min = { -50, -50, -50 }, .bounds_max = { 50, 50, 50 } };
    assert_true(view_cells_scale(&scene, &camera, 25, 300) == 1);
    assert_true(view_cells_scale(&scene, &camera, 25, 100) == 3);
    assert_true(view_cells_scale(&scene, &camera, 600, 1000) == 0.5);
    scene.bounds_max[0] = (double)INFINITY;
    assert_true(view_cells_scale(&scene, &camera, 25, 100) == 1);
}

/* ---- Light ------------------------------------------------------------------------------------------- */

/* A closed box whose six sides all send out radiance 4: irradiance 4 pi. */
static void only_what_is_brighter_than_paper_lights_a_scene(void **state)
{
    (void)state;
    struct boxes b = { .scene = { 0 } };
    box_add(&b, 1, false, false);
    boxes_finish(&b, false);
    for (int c = 0; c < 3; c++)
        b.material.emissive[c] = 4;
    assert_true(fabs(view_glow_irradiance(&b.scene) - 4 * 3.14159265) < 1e-4);
    view_file_from_scene(&b.scene, 1, &view);
    assert_false(view.sun.enabled);
    assert_true(view.sky.horizon[0] == 0);
    for (int c = 0; c < 3; c++)
        b.material.emissive[c] = 1;
    assert_true(view_glow_irradiance(&b.scene) == 0);
    view_file_from_scene(&b.scene, 1, &view);
    assert_true(view.sun.enabled && view.sky.horizon[0] > 0);
}

/* ---- Options ----------------------------------------------------------------------------------------- */

static void skies_and_suns_are_read_from_text(void **state)
{
    (void)state;
    char error[256];
    host_view_default(&view);
    assert_true(view_option_sky("2", &view, error, sizeof error));
    assert_true(view.sky.zenith[2] == 2 && view.sky.ground[0] == 2);
    assert_true(view_option_sky("1,2,3", &view, error, sizeof error));
    assert_true(view.sky.horizon[0] == 1 && view.sky.horizon[2] == 3 && view.sky.ground[1] == 2);
    assert_true(view_option_sky("1,2,3,4,5,6,7,8,9", &view, error, sizeof error));
    assert_true(view.sky.zenith[0] == 1 && view.sky.horizon[0] == 4 && view.sky.ground[2] == 9);
    assert_true(view_option_sky("none", &view, error, sizeof error));
    assert_true(view.sky.zenith[0] == 0 && view.sky.ground[2] == 0);
    assert_true(view_option_sun("0,-2,0,5,6,7", &view, error, sizeof error));
    assert_true(view.sun.enabled && view.sun.direction[1] == -1 && view.sun.irradiance[2] == 7);
    assert_true(view_option_sun("none", &view, error, sizeof error));
    assert_false(view.sun.enabled);
    assert_true(view_option_sun("day", &view, error, sizeof error));
    assert_true(view.sun.enabled);
}

static void cameras_are_read_from_text(void **state)
{
    (void)state;
    char error[256], name[] = "Kitchen";
    struct gltf_camera cameras[2] = {
        { .ymag = 1 },
        { .transform = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1 }, .yfov_rad = 0.8f, .name = name },
    };
    const struct gltf_scene scene = { .cameras = cameras, .camera_count = 2 };
    host_view_default(&view);
    assert_true(view_option_camera("1,2,3,1,2,0,30", &scene, 1, &view, error, sizeof error));
    assert_true(view.camera.position[2] == 3 && view.camera.look_at[2] == 0);
    assert_true(fabs((double)view.camera.yfov_rad - 0.5235988) < 1e-6);
    assert_true(view_option_camera("0,9,0,0,0,0", &scene, 1, &view, error, sizeof error));
    assert_true(view.camera.up[2] == -1);
    static const char *const known[] = { "1", "Kitchen" };
    for (int i = 0; i < 2; i++) {
        host_view_default(&view);
        assert_true(view_option_camera(known[i], &scene, 1, &view, error, sizeof error));
        assert_true(view.camera.position[0] == 5 && view.camera.yfov_rad == 0.8f);
    }
    assert_true(view_option_camera("auto", &scene, 1, &view, error, sizeof error));
}

static void wrong_options_are_named_and_change_nothing(void **state)
{
    (void)state;
    static const char *const skies[] = { "", "blue", "-1", "1,2", "1,2,3,4", "1,2,", "1e30", "nan" };
    static const char *const suns[] = { "", "1", "0,0,0", "1,2,3,4", "0,-1,0,1,1,-1" };
    static const char *const cameras[] = { "", "1", "1,2,3", "1,2,3,1,2,3", "0,0,0,0,0,1,180", "Garden" };
    struct gltf_camera orthographic = { .ymag = 1 };
    const struct gltf_scene scene = { .cameras = &orthographic, .camera_count = 1 };
    struct host_view before;
    char error[256];
    host_view_default(&view);
    memcpy(&before, &view, sizeof before);
    for (size_t i = 0; i < sizeof skies / sizeof *skies; i++)
        assert_false(view_option_sky(skies[i], &view, error, sizeof error) ||
                     strncmp(error, "is \"", 4) != 0);
    for (size_t i = 0; i < sizeof suns / sizeof *suns; i++)
        assert_false(view_option_sun(suns[i], &view, error, sizeof error) || strncmp(error, "is \"", 4) != 0);
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++)
        assert_false(view_option_camera(cameras[i], &scene, 1, &view, error, sizeof error) ||
                     strncmp(error, "is \"", 4) != 0);
    assert_memory_equal(&before, &view, sizeof before);
    assert_true(view_option_camera("0", &scene, 1, &view, error, sizeof error));
}

static void an_environment_and_a_sky_take_each_others_place(void **state)
{
    (void)state;
    static const float texels[2 * 3] = { 1, 2, 3, 4, -5, NAN };
    char error[256];
    uint8_t file[64];
    const int head = snprintf((char *)file, sizeof file, "PF\n2 1\n-1\n");
    memcpy(file + head, texels, sizeof texels);
    files_write("map.pfm", file, (size_t)head + sizeof texels);
    host_view_default(&view);
    assert_false(view_option_environment("map.png", &view, error, sizeof error));
    assert_non_null(strstr(error, "picture of radiance"));
    assert_false(view_option_environment("gone.hdr", &view, error, sizeof error));
    assert_null(view.environment.rgb);
    view.sky = view_day_sky;
    view.sun = view_day_sun;
    assert_true(view_option_environment(files_path("map.pfm"), &view, error, sizeof error));
    assert_int_equal(view.environment.width, 2);
    assert_true(view.environment.rgb[1] == 2 && view.environment.rgb[3] == 4);
    assert_true(view.environment.rgb[4] == 0 && view.environment.rgb[5] == 0);
    assert_true(view.sky.horizon[0] == 0 && !view.sun.enabled);
    assert_false(view_option_sky("blue", &view, error, sizeof error));
    assert_non_null(view.environment.rgb);
    assert_true(view_option_sky("2", &view, error, sizeof error));
    assert_null(view.environment.rgb);
    view_file_finish(&view);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_that_is_open_on_one_side_is_looked_into),
        cmocka_unit_test(a_closed_room_is_seen_from_inside_and_a_solid_from_outside),
        cmocka_unit_test(a_scene_without_camera_fills_the_picture),
        cmocka_unit_test(cells_fit_scenes_that_are_larger_or_smaller_than_cascades),
        cmocka_unit_test(only_what_is_brighter_than_paper_lights_a_scene),
        cmocka_unit_test(skies_and_suns_are_read_from_text),
        cmocka_unit_test(cameras_are_read_from_text),
        cmocka_unit_test(wrong_options_are_named_and_change_nothing),
        cmocka_unit_test(an_environment_and_a_sky_take_each_others_place),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
