/* SPDX-License-Identifier: MIT
 * Camera paths: what the file may say, and where the camera then is. */
#include "files.h"
#include "unit.h"

#include "walk/walk_path.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char file_name[] = "path.json";
static char error[300];
static struct walk_path walk;

static bool load(const char *text)
{
    files_write_text(file_name, text);
    return walk_path_load(files_path(file_name), &walk, error, sizeof error);
}

static void require_load(const char *text)
{
    if (!load(text))
        fail_msg("%s", error);
}

static struct host_camera camera_at(double distance_m)
{
    struct host_camera camera;
    walk_path_camera(&walk, distance_m, &camera);
    return camera;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* Small angles between views, which acos would lose. */
static double view_angle(const struct host_camera *a, const struct host_camera *b)
{
    double view_a[3], view_b[3];
    for (int i = 0; i < 3; i++) {
        view_a[i] = a->look_at[i] - a->position[i];
        view_b[i] = b->look_at[i] - b->position[i];
    }
    return 2 * asin(fmin(0.5 * distance(view_a, view_b), 1));
}

static void a_straight_way_is_walked_straight(void **state)
{
    (void)state;
    require_load("{\"points\":[[0,1,0],[10,1,0]]}");
    assert_true(fabs(walk.length_m - 10) < 1e-9);
    assert_true(walk.speed_m_s == 5 && walk.fps == 60);
    for (double at_m = 0; at_m <= 10; at_m += 0.37) {
        const struct host_camera camera = camera_at(at_m);
        const double expected[3] = { at_m, 1, 0 }, ahead[3] = { at_m + 1, 1, 0 };
        assert_true(distance(camera.position, expected) < 1e-9);
        assert_true(distance(camera.look_at, ahead) < 1e-9);
    }
    walk_path_finish(&walk);
}

static void before_the_start_and_past_the_end_the_camera_stands(void **state)
{
    (void)state;
    require_load("{\"points\":[[0,1,0],[10,1,0]]}");
    assert_true(camera_at(-5).position[0] == 0);
    assert_true(fabs(camera_at(1e9).position[0] - 10) < 1e-12);
    walk_path_finish(&walk);
}

static const char bent[] =
    "{\"points\":[[0,0,0],[5,0,1],[6,0,9],[6.5,2,9.25],[-20,3,-4],{\"position\":[-20,0,40],"
    "\"look_at\":[0,0,0]}],\"smooth_m\":3}";

static void the_way_goes_through_every_point(void **state)
{
    (void)state;
    require_load(bent);
    for (uint32_t p = 0; p < walk.point_count; p++) {
        double nearest = 1e9;
        for (double at_m = 0; at_m <= walk.length_m; at_m += 0.005)
            nearest = fmin(nearest, distance(camera_at(at_m).position, walk.points[p].position));
        assert_true(nearest < 0.005);
    }
    walk_path_finish(&walk);
}

/* Chords of 1 cm: shorter than the way by what the curve bends within them. */
static void the_speed_is_constant(void **state)
{
    (void)state;
    require_load(bent);
    struct host_camera before = camera_at(0);
    for (int i = 1; i * 0.01 < walk.length_m; i++) {
        const struct host_camera camera = camera_at(i * 0.01);
        const double step_m = distance(camera.position, before.position);
        if (!(fabs(step_m - 0.01) < 1e-5))
            fail_msg("at %g m a step of 1 cm is %g m long", i * 0.01, step_m);
        before = camera;
    }
    walk_path_finish(&walk);
}

/* Half a turn within 1 cm of the way, spread over 3 m of it. */
static void sudden_turns_are_spread_over_the_way(void **state)
{
    (void)state;
    require_load("{\"points\":[[0,0,0],{\"position\":[5,0,0],\"look_at\":[9,0,0]},"
                 "{\"position\":[5.01,0,0],\"look_at\":[0,0,0.01]},"
                 "{\"position\":[9,0,0],\"look_at\":[0,0,0.01]}],\"smooth_m\":3}");
    double most = 0, whole = 0;
    struct host_camera before = camera_at(0);
    for (int i = 1; i * 0.01 < walk.length_m; i++) {
        const struct host_camera camera = camera_at(i * 0.01);
        most = fmax(most, view_angle(&camera, &before));
        whole += view_angle(&camera, &before);
        before = camera;
    }
    assert_true(whole > 3);
    assert_true(most < 1.05 * 3.1416 * 0.01 / 3);
    walk_path_finish(&walk);
}

static void views_that_are_given_are_taken(void **state)
{
    (void)state;
    require_load("{\"points\":[{\"position\":[0,0,0],\"look_at\":[0,0,-1]},"
                 "{\"position\":[10,0,0],\"look_at\":[11,0,-1]}],\"smooth_m\":0}");
    const struct host_camera start = camera_at(0), end = camera_at(10);
    assert_true(fabs(start.look_at[2] + 1) < 1e-9);
    assert_true(fabs(end.look_at[0] - 10 - sqrt(0.5)) < 1e-9);
    walk_path_finish(&walk);
    require_load("{\"points\":[[0,0,0],[10,0,0]],\"look_at\":[5,0,-5],\"smooth_m\":0}");
    const struct host_camera middle = camera_at(5);
    assert_true(fabs(middle.look_at[2] + 1) < 1e-6);
    walk_path_finish(&walk);
}

/* A turn of 180 degrees past yaw +-pi goes the short way, and in between the camera does not look elsewhere.
 */
static void turns_go_the_short_way(void **state)
{
    (void)state;
    require_load("{\"points\":[{\"position\":[0,0,0],\"look_at\":[-1,0,10]},"
                 "{\"position\":[10,0,0],\"look_at\":[11,0,10]}],\"smooth_m\":0}");
    for (double at_m = 0; at_m <= 10; at_m += 0.1) {
        const struct host_camera camera = camera_at(at_m);
        assert_true(camera.look_at[2] - camera.position[2] > 0.99);
    }
    walk_path_finish(&walk);
}

static void far_from_the_origin_the_way_is_the_same(void **state)
{
    (void)state;
    require_load("{\"points\":[[0,0,0],[4,1,0],[4,2,8]]}");
    struct host_camera near_cameras[32];
    const double near_length_m = walk.length_m;
    for (int i = 0; i < 32; i++)
        near_cameras[i] = camera_at(i * near_length_m / 31);
    walk_path_finish(&walk);
    require_load("{\"points\":[[8388608,0,-8388608],[8388612,1,-8388608],[8388612,2,-8388600]]}");
    assert_true(fabs(walk.length_m - near_length_m) < 1e-7);
    for (int i = 0; i < 32; i++) {
        const struct host_camera camera = camera_at(i * near_length_m / 31);
        const double relative[3] = { camera.position[0] - 8388608, camera.position[1],
                                     camera.position[2] + 8388608 };
        assert_true(distance(relative, near_cameras[i].position) < 1e-6);
        /* Stations are 2 cm apart and known to 2e-9 m, from which directions follow. */
        assert_true(view_angle(&camera, &near_cameras[i]) < 1e-6);
    }
    walk_path_finish(&walk);
}

static void every_key_reaches_its_field(void **state)
{
    (void)state;
    require_load("{\"points\":[[0,0,0],[1,0,0]],\"speed_m_s\":2.5,\"fps\":30,\"yfov_deg\":90,"
                 "\"smooth_m\":0.5,\"view\":\"here.view.json\"}");
    assert_true(walk.speed_m_s == 2.5 && walk.fps == 30 && walk.smooth_m == 0.5);
    assert_true(fabsf(walk.yfov_rad - 1.5707963f) < 1e-6f);
    assert_string_equal(walk.view, files_path("here.view.json"));
    walk_path_finish(&walk);
}

static void a_view_is_found_beside_its_path(void **state)
{
    (void)state;
    require_load("{\"points\":[[0,0,0],[1,0,0]],\"view\":\"views/a.json\"}");
    assert_string_equal(walk.view, files_path("views/a.json"));
    walk_path_finish(&walk);
    assert_int_equal(chdir(files_path("")), 0);
    assert_true(walk_path_load(file_name, &walk, error, sizeof error));
    assert_string_equal(walk.view, "views/a.json");
    walk_path_finish(&walk);
}

static void what_is_wrong_is_named(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "{}", "points: is missing" },
        { "[]", "expected an object" },
        { "{\"points\":3}", "points: expected an array" },
        { "{\"points\":[]}", "points: are 0" },
        { "{\"points\":[[0,0,0]]}", "points: are 1" },
        { "{\"points\":[[0,0,0],[0,0]]}", "points[1]" },
        { "{\"points\":[[0,0,0],[0,0,\"1\"]]}", "points[1]" },
        { "{\"points\":[[0,0,0],[0,0,1e300]]}", "points[1]" },
        { "{\"points\":[[0,0,0],7]}", "points[1]: expected an object" },
        { "{\"points\":[[0,0,0],{\"look_at\":[0,0,0]}]}", "points[1].position: is missing" },
        { "{\"points\":[[0,0,0],{\"position\":[1,0,0],\"up\":1}]}", "points[1].up: unknown key" },
        { "{\"points\":[[0,0,0],[1,0,0],[1,0,0]]}", "points[2]: equals" },
        { "{\"points\":[[0,0,0],[-0.0,0,0]]}", "points[1]: equals" },
        { "{\"points\":[[0,0,0],[1e-200,0,0]]}", "points[1]: equals" },
        { "{\"points\":[[1,0,0],[1.0000001,0,0]]}", "points[1]: equals" },
        { "{\"points\":[[0,0,0],{\"position\":[1,0,0],\"look_at\":[1,0,0]}]}", "points[1]: look_at equals" },
        { "{\"points\":[[1,0,0],{\"position\":[0,0,0],\"look_at\":[0,-0.0,1e-300]}]}",
          "points[1]: look_at equals" },
        { "{\"points\":[[0,0,0],{\"position\":[1,0,0],\"look_at\":[2,0,0]}],\"look_at\":[0,0,9]}",
          "points[1]: look_at is given" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"speed_m_s\":0}", "speed_m_s: is 0" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"speed_m_s\":-1}", "speed_m_s" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"fps\":0}", "fps" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"yfov_deg\":180}", "yfov_deg" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"view\":5}", "view" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"view\":\"\"}", "view" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"smooth\":1}", "smooth: unknown key" },
        { "{\"points\":[[0,0,0],[1,0,0]],\"fps\":1,\"fps\":2}", "fps: given twice" },
        { "{\"points\":[[0,0,0],", "broken JSON" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (load(cases[i][0]) || !strstr(error, cases[i][1]) ||
            strncmp(error, files_path(file_name), strlen(files_path(file_name))) != 0 || strchr(error, '\n'))
            fail_msg("%s: \"%s\"", cases[i][0], error);
        assert_null(walk.points);
    }
}

/* The nearest points that are taken, beyond the longest of chords. */
static void points_that_nearly_coincide_are_walked(void **state)
{
    (void)state;
    require_load("{\"points\":[[-1.5e11,0,0],[0,0,0],[1.1e-6,0,0],[1.1e-6,1.1e-6,0]]}");
    for (uint32_t i = 0; i < walk.station_count; i++)
        assert_true(isfinite(walk.stations[i].distance_m) && isfinite(walk.stations[i].yaw));
    assert_true(walk.length_m >= 1.5e11 && walk.length_m < 1.6e11);
    walk_path_finish(&walk);
}

static void too_many_points_are_refused(void **state)
{
    (void)state;
    FILE *file = fopen(files_path(file_name), "wb");
    assert_non_null(file);
    fputs("{\"points\":[", file);
    for (int i = 0; i <= WALK_POINTS_MAX; i++)
        fprintf(file, "%s[%d,0,0]", i ? "," : "", i);
    fputs("]}", file);
    fclose(file);
    assert_false(walk_path_load(files_path(file_name), &walk, error, sizeof error));
    assert_non_null(strstr(error, "1025"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_way_is_walked_straight),
        cmocka_unit_test(before_the_start_and_past_the_end_the_camera_stands),
        cmocka_unit_test(the_way_goes_through_every_point),
        cmocka_unit_test(the_speed_is_constant),
        cmocka_unit_test(sudden_turns_are_spread_over_the_way),
        cmocka_unit_test(views_that_are_given_are_taken),
        cmocka_unit_test(turns_go_the_short_way),
        cmocka_unit_test(far_from_the_origin_the_way_is_the_same),
        cmocka_unit_test(every_key_reaches_its_field),
        cmocka_unit_test(a_view_is_found_beside_its_path),
        cmocka_unit_test(what_is_wrong_is_named),
        cmocka_unit_test(points_that_nearly_coincide_are_walked),
        cmocka_unit_test(too_many_points_are_refused),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
