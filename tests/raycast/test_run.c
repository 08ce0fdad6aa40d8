/* SPDX-License-Identifier: MIT
 * Runs: the same bits for the same seed, interrupted or not; states and settings that are refused. */
#include "files.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 40, HEIGHT = 24, VALUES = WIDTH * HEIGHT * 3, ERROR_BYTES = 256 };

static const struct raycast_settings small = { .width = WIDTH, .height = HEIGHT, .seed = 7 };

static const char *state_path(void)
{
    return files_path("picture.state");
}

/* A room corner with a lamp, blended glass and an emitter, away from the origin by `shift` metres. */
static struct raycast_view scene_make(struct built_scene *s, double shift)
{
    sdfgi_scene_init(s);
    scene_add_material(s, 0.7f);
    scene_add_floor(s, 0, 3, true);
    scene_add_quad(s, (float[]){ -3, 0, -3 }, (float[]){ 6, 0, 0 }, (float[]){ 0, 3, 0 });
    struct gltf_material *m = scene_add_material(s, 0.3f);
    m->alpha_mode = GLTF_ALPHA_BLEND;
    m->base_color[3] = 0.5f;
    scene_add_floor(s, 1, 1, true);
    m = scene_add_material(s, 0.5f);
    m->emissive[1] = 3;
    scene_add_floor(s, 2, 0.5f, false);
    for (uint32_t i = 0; i < s->gltf.instance_count; i++)
        for (int k = 0; k < 3; k++)
            s->instances[i].transform[12 + k] = shift * (k + 1);
    const double position[3] = { 2.25 + shift, 1.5 + 2 * shift, 3 + 3 * shift };
    const double target[3] = { shift, 0.5 + 2 * shift, 3 * shift };
    struct raycast_view v = view_make(position, target, 60);
    view_set_sky(&v, 0.3f);
    v.sun = (struct raycast_sun){ .direction = { -1, -2, -0.5f }, .irradiance = { 2, 2, 1 }, .angle_deg = 2 };
    return v;
}

static void render(struct raycast *rc, uint32_t samples, float out[VALUES])
{
    assert_true(raycast_render(rc, &(struct raycast_budget){ .samples = samples }, NULL, NULL, NULL));
    assert_true(raycast_image(rc, RAYCAST_AOV_RADIANCE, out));
}

static void render_whole(double shift, struct raycast_settings settings, uint32_t samples, float out[VALUES])
{
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, shift);
    struct raycast *rc = tracer_create(&s, &v, &settings);
    render(rc, samples, out);
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    float one[VALUES], many[VALUES], other[VALUES];
    struct raycast_settings settings = small;
    settings.threads = 1;
    render_whole(0, settings, 8, one);
    settings.threads = 5;
    render_whole(0, settings, 8, many);
    assert_memory_equal(one, many, sizeof one);
    settings.seed = 8;
    render_whole(0, settings, 8, other);
    assert_true(memcmp(one, other, sizeof one) != 0);
}

/* Whole metres: the tracer's space is the same, so nothing may differ. */
static void a_million_metres_away_looks_the_same(void **state)
{
    (void)state;
    float near[VALUES], far[VALUES];
    render_whole(0, small, 4, near);
    render_whole(1e6, small, 4, far);
    assert_memory_equal(near, far, sizeof near);
}

static bool stop_at_once(const struct raycast_progress *progress, void *user)
{
    *(uint32_t *)user = progress->samples;
    return false;
}

static void interrupted_run_resumes_to_the_same_bits(void **state)
{
    (void)state;
    float whole[VALUES], resumed[VALUES], variance[2][VALUES];
    char error[ERROR_BYTES] = "";
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, 0);
    struct raycast *a = tracer_create(&s, &v, &small);
    render(a, 20, whole);
    assert_true(raycast_image(a, RAYCAST_AOV_VARIANCE, variance[0]));
    struct raycast *b = tracer_create(&s, &v, &small);
    uint32_t done = 0;
    assert_false(raycast_render(b, &(struct raycast_budget){ .samples = 20 }, stop_at_once, &done, NULL));
    assert_in_range(done, 1, 19);
    state_save(b, state_path());
    raycast_destroy(b);
    struct raycast *c = tracer_create(&s, &v, &small);
    assert_true(raycast_state_load(c, state_path(), error, sizeof error));
    render(c, 20, resumed);
    assert_true(raycast_image(c, RAYCAST_AOV_VARIANCE, variance[1]));
    assert_memory_equal(whole, resumed, sizeof whole);
    assert_memory_equal(variance[0], variance[1], sizeof variance[0]);
    raycast_destroy(a);
    raycast_destroy(c);
    sdfgi_scene_finish(&s);
}

/* Has begun as many tiles as it is worth, and then asks for an end. */
static bool stop_after(void *user)
{
    uint32_t *left = user;
    return *left == 0 || --*left == 0;
}

/* In the middle of a pass: tiles to the left and above have a sample more than the others. */
static struct raycast_progress stop_inside(struct raycast *rc, uint32_t tiles)
{
    struct raycast_progress p;
    const struct raycast_budget budget = { .samples = 4, .stop = stop_after };
    assert_false(raycast_render(rc, &budget, NULL, &tiles, &p));
    assert_true(p.mean_samples > p.samples && p.mean_samples < p.samples + 1);
    return p;
}

static void run_stopped_inside_a_pass_resumes_to_the_same_bits(void **state)
{
    (void)state;
    float whole[VALUES], resumed[VALUES];
    char error[ERROR_BYTES] = "";
    struct built_scene s;
    struct raycast_settings settings = small;
    settings.threads = 1;
    const struct raycast_view v = scene_make(&s, 0);
    render_whole(0, settings, 4, whole);
    struct raycast *a = tracer_create(&s, &v, &settings), *b = tracer_create(&s, &v, &settings);
    assert_int_equal(stop_inside(a, 4).samples, 0);
    assert_false(raycast_image(a, RAYCAST_AOV_RADIANCE, resumed));
    state_save(a, state_path());
    assert_true(raycast_state_load(b, state_path(), error, sizeof error));
    render(b, 4, resumed);
    assert_memory_equal(whole, resumed, sizeof whole);
    raycast_destroy(a);
    raycast_destroy(b);
    sdfgi_scene_finish(&s);
}

/* Each tile's sums are shared among its own samples. */
static void run_stopped_inside_a_pass_is_as_bright(void **state)
{
    (void)state;
    float picture[VALUES];
    struct built_scene s;
    struct raycast_settings settings = small;
    settings.threads = 1;
    sdfgi_scene_init(&s);
    struct raycast_view v = view_make((double[]){ 0, 0, 0 }, (double[]){ 0, 0, -1 }, 60);
    view_set_sky(&v, 0.25f);
    struct raycast *rc = tracer_create(&s, &v, &settings);
    assert_int_equal(stop_inside(rc, 12).samples, 1);
    assert_true(raycast_image(rc, RAYCAST_AOV_RADIANCE, picture));
    for (int i = 0; i < VALUES; i++)
        assert_ratio((double)picture[i], 0.25, 1e-6);
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

static void refuses(const struct raycast_view *v, const struct built_scene *s,
                    struct raycast_settings settings)
{
    char error[ERROR_BYTES] = "";
    float before[VALUES], after[VALUES];
    struct raycast *rc = tracer_create(s, v, &settings);
    if (settings.width == WIDTH) {
        render(rc, 1, before);
        assert_false(raycast_state_load(rc, state_path(), error, sizeof error));
        render(rc, 1, after);
        assert_memory_equal(before, after, sizeof before);
    } else {
        assert_false(raycast_state_load(rc, state_path(), error, sizeof error));
    }
    assert_non_null(strstr(error, state_path()));
    raycast_destroy(rc);
}

static void states_of_other_pictures_are_refused(void **state)
{
    (void)state;
    float picture[VALUES];
    struct built_scene s;
    struct raycast_view v = scene_make(&s, 0);
    struct raycast *rc = tracer_create(&s, &v, &small);
    render(rc, 2, picture);
    state_save(rc, state_path());
    raycast_destroy(rc);
    struct raycast_settings settings = small;
    settings.seed = 6;
    refuses(&v, &s, settings);
    settings = small;
    settings.width = 20;
    refuses(&v, &s, settings);
    settings = small;
    settings.aovs = 1u << RAYCAST_AOV_DEPTH;
    refuses(&v, &s, settings);
    v.sun.irradiance[2] = 1.5f;
    refuses(&v, &s, small);
    v.sun.irradiance[2] = 1;
    s.primitives[0].positions[4] += 0.125f;
    refuses(&v, &s, small);
    s.primitives[0].positions[4] -= 0.125f;
    /* Last byte changed, then cut off, then all of it. */
    FILE *file = fopen(state_path(), "r+b");
    fseek(file, -1, SEEK_END);
    const int last = fgetc(file);
    fseek(file, -1, SEEK_END);
    fputc(last ^ 1, file);
    const long size = ftell(file);
    fclose(file);
    refuses(&v, &s, small);
    assert_int_equal(truncate(state_path(), size - 1), 0);
    refuses(&v, &s, small);
    assert_int_equal(truncate(state_path(), 0), 0);
    refuses(&v, &s, small);
    sdfgi_scene_finish(&s);
}

static void flip_byte(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    fseek(file, at, SEEK_SET);
    const int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 4, file);
    fclose(file);
}

/* Counts of samples and rays as much as sums: with a wrong count the picture would be too bright or too dark.
 */
static void states_with_any_other_byte_before_their_sums_are_refused(void **state)
{
    (void)state;
    enum { HEADER = 56, TILES = 6 };
    char error[ERROR_BYTES] = "";
    float picture[VALUES];
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, 0);
    struct raycast *rc = tracer_create(&s, &v, &small);
    render(rc, 2, picture);
    state_save(rc, state_path());
    for (long at = 0; at < HEADER + 4 * TILES; at++) {
        flip_byte(state_path(), at);
        if (raycast_state_load(rc, state_path(), error, sizeof error))
            fail_msg("byte %ld is not looked at", at);
        flip_byte(state_path(), at);
    }
    assert_true(raycast_state_load(rc, state_path(), error, sizeof error));
    raycast_destroy(rc);
    rc = tracer_create(&s, &v, &small);
    state_save(rc, state_path());
    assert_false(raycast_state_load(rc, state_path(), error, sizeof error));
    assert_non_null(strstr(error, "no samples"));
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

static void unwritable_states_are_reported(void **state)
{
    (void)state;
    char error[ERROR_BYTES] = "";
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, 0);
    struct raycast *rc = tracer_create(&s, &v, &small);
    FILE *full = fopen("/dev/full", "wb");
    if (full) {
        assert_false(raycast_state_write(rc, full));
        fclose(full);
    }
    assert_false(raycast_state_load(rc, "/nonexistent/a.state", error, sizeof error));
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

static void runs_stop_at_their_limits(void **state)
{
    (void)state;
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, 0);
    struct raycast_progress p;
    struct raycast *rc = tracer_create(&s, &v, &small);
    assert_true(raycast_render(rc, &(struct raycast_budget){ .error = 0.1 }, NULL, NULL, &p));
    assert_true(p.error <= 0.1 && p.samples >= 16 && p.fraction == 1);
    const uint32_t before = p.samples;
    assert_true(raycast_render(rc, &(struct raycast_budget){ .seconds = 0.2 }, NULL, NULL, &p));
    assert_true(p.samples > before && p.seconds >= 0.2 && p.seconds < 3);
    assert_true(p.rays >= (uint64_t)(p.samples - before) * WIDTH * HEIGHT);
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

/* One sample of each of these pixels would take many seconds. */
static void time_is_kept_inside_a_pass(void **state)
{
    (void)state;
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, 0);
    const struct raycast_settings settings = { .width = 4096, .height = 4096 };
    struct raycast_progress p;
    struct raycast *rc = tracer_create(&s, &v, &settings);
    assert_true(raycast_render(rc, &(struct raycast_budget){ .seconds = 0.1 }, NULL, NULL, &p));
    assert_true(p.seconds >= 0.1 && p.seconds < 1 && p.mean_samples > 0);
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

/* The standard error that one run estimates against the spread of many runs. */
static void variance_predicts_the_spread_of_seeds(void **state)
{
    (void)state;
    enum { RUNS = 24, SAMPLES = 16 };
    static double sum[VALUES], squares[VALUES];
    static float picture[VALUES], variance[VALUES];
    double predicted = 0, observed = 0;
    struct built_scene s;
    const struct raycast_view v = scene_make(&s, 0);
    for (uint64_t seed = 0; seed < RUNS; seed++) {
        struct raycast_settings settings = small;
        settings.seed = seed;
        struct raycast *rc = tracer_create(&s, &v, &settings);
        render(rc, SAMPLES, picture);
        assert_true(raycast_image(rc, RAYCAST_AOV_VARIANCE, variance));
        for (int i = 0; i < VALUES; i++) {
            sum[i] += picture[i];
            squares[i] += (double)picture[i] * picture[i];
            predicted += variance[i];
        }
        raycast_destroy(rc);
    }
    for (int i = 0; i < VALUES; i++)
        observed += (squares[i] - sum[i] * sum[i] / RUNS) / (RUNS - 1);
    assert_ratio(predicted / RUNS, observed, 0.1);
    sdfgi_scene_finish(&s);
}

static void refused(const struct built_scene *s, struct raycast_view v, struct raycast_settings settings,
                    const char *field)
{
    char error[ERROR_BYTES] = "";
    assert_null(raycast_create(&s->gltf, &v, &settings, error, sizeof error));
    if (strstr(error, field) == NULL)
        fail_msg("\"%s\" does not name %s", error, field);
}

static void wrong_views_are_refused_by_name(void **state)
{
    (void)state;
    struct built_scene s;
    const struct raycast_view good = scene_make(&s, 0);
    struct raycast_view v = good;
    v.camera.position[1] = NAN;
    refused(&s, v, small, "camera");
    v = good;
    memcpy(v.camera.look_at, v.camera.position, sizeof v.camera.look_at);
    refused(&s, v, small, "camera.look_at");
    v = good;
    for (int k = 0; k < 3; k++)
        v.camera.up[k] = (float)(v.camera.look_at[k] - v.camera.position[k]);
    refused(&s, v, small, "camera.up");
    v = good;
    v.camera.yfov_deg = 180;
    refused(&s, v, small, "camera.yfov_deg");
    v = good;
    v.sun.angle_deg = -1;
    refused(&s, v, small, "sun.angle_deg");
    v = good;
    v.sky.ground[0] = INFINITY;
    refused(&s, v, small, "sky");
    v = good;
    const struct raycast_light spot = {
        .type = RAYCAST_LIGHT_SPOT, .direction = { 0, 0, 1 }, .inner_deg = 30, .outer_deg = 30
    };
    v.lights = &spot;
    v.light_count = 1;
    refused(&s, v, small, "lights[0]");
    struct raycast_settings settings = small;
    settings.width = 1u << 20;
    refused(&s, good, settings, "size");
    sdfgi_scene_finish(&s);
}

static void an_empty_scene_is_its_sky(void **state)
{
    (void)state;
    struct built_scene s;
    sdfgi_scene_init(&s);
    struct raycast_view v = view_make((double[]){ 0, 0, 0 }, (double[]){ 0, 0, -1 }, 60);
    view_set_sky(&v, 0.25f);
    assert_ratio(trace_mean(&s, &v, 8, 8, 2, 0, RAYCAST_AOV_RADIANCE), 0.25, 1e-6);
    sdfgi_scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_million_metres_away_looks_the_same),
        cmocka_unit_test(interrupted_run_resumes_to_the_same_bits),
        cmocka_unit_test(run_stopped_inside_a_pass_resumes_to_the_same_bits),
        cmocka_unit_test(run_stopped_inside_a_pass_is_as_bright),
        cmocka_unit_test(states_of_other_pictures_are_refused),
        cmocka_unit_test(states_with_any_other_byte_before_their_sums_are_refused),
        cmocka_unit_test(unwritable_states_are_reported),
        cmocka_unit_test(runs_stop_at_their_limits),
        cmocka_unit_test(time_is_kept_inside_a_pass),
        cmocka_unit_test(variance_predicts_the_spread_of_seeds),
        cmocka_unit_test(wrong_views_are_refused_by_name),
        cmocka_unit_test(an_empty_scene_is_its_sky),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
