/* SPDX-License-Identifier: MIT
 * Views: what a resolve makes of a picture, what it needs for that, and what it leaves out. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE, SURFACES = 20 * SIDE };

static const float ZENITH[3] = { 1, 1.5f, 2 };

/* A level floor beside a wall, seen from straight above: clip x, y in [-1, 1] are metres over 3, depth 0 to 1
 * is y from -1.9 to -2.1. Part of the wall glows. Four columns show it, as background. */
struct stage {
    struct gi_test t;
    sdfgi_material smooth; /* of nothing that is there: it calls for reflections */
    struct gpu_test_image depth, normal;
    float depths[PIXELS], normals[PIXELS][4];
    int ridge;  /* this column leans towards +x; 0: none does */
    float lean; /* of all other normals: tangent of the angle */
};

static void fill_picture(struct stage *s)
{
    for (int i = 0; i < PIXELS; i++) {
        const float u = ((float)(i % SIDE) + 0.5f) / SIDE * 2 - 1;
        const bool in_wall = fabsf(3 * u + 2) < 0.6f;
        s->depths[i] = in_wall ? 1.0f : 0.5f;
        const bool leans = s->ridge && i % SIDE == s->ridge;
        memcpy(s->normals[i], (float[]){ leans ? 1 : s->lean, 1, 0, 0 }, sizeof s->normals[i]);
    }
}

static void open_stage(struct stage *s, float smoothness)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.min_cell_size_m = 0.4f;
    gi_test_renew(&s->t, &settings);
    struct test_mesh box = test_mesh_box((double[]){ 0, -3, 0 }, (double[]){ 4, 1, 4 }, test_rotation_none),
                     wall =
                         test_mesh_box((double[]){ -2, 0, 0 }, (double[]){ 0.4, 2, 3 }, test_rotation_none);
    gi_test_add(&s->t, &box, gi_test_material(&s->t, (float[]){ 0.7f, 0.7f, 0.7f }, (float[]){ 0, 0, 0 }));
    gi_test_add(&s->t, &wall,
                gi_test_material(&s->t, (float[]){ 0.8f, 0.2f, 0.1f }, (float[]){ 1, 0.5f, 0 }));
    test_mesh_destroy(&box);
    test_mesh_destroy(&wall);
    const struct sdfgi_material_desc desc = { .smoothness = smoothness };
    REQUIRE_CMP((int)sdfgi_material_create(s->t.gi, &desc, &s->smooth), ==, (int)SDFGI_OK);
    struct sdfgi_sky sky = { .horizon = { 1, 1, 1 } };
    memcpy(sky.zenith, ZENITH, sizeof ZENITH);
    REQUIRE_CMP((int)sdfgi_set_sky(s->t.gi, &sky), ==, (int)SDFGI_OK);
    gi_test_update(&s->t, 8);
    fill_picture(s);
    s->depth = gi_test_gather_image(&s->t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, s->depths);
    s->normal = gi_test_gather_image(&s->t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, s->normals);
}

static void close_stage(struct stage *s)
{
    gpu_test_image_destroy(&s->t.gpu, &s->depth);
    gpu_test_image_destroy(&s->t.gpu, &s->normal);
}

/* ---- Resolves */

static sdfgi_view *create_view_at(struct stage *s, enum sdfgi_gather_resolution reflection)
{
    sdfgi_view *view = NULL;
    const struct sdfgi_view_desc desc = { .width = SIDE, .height = SIDE, .reflection = reflection };
    REQUIRE_CMP((int)sdfgi_view_create(s->t.gi, &desc, &view), ==, (int)SDFGI_OK);
    return view;
}

static sdfgi_view *create_view(struct stage *s)
{
    return create_view_at(s, SDFGI_GATHER_FULL);
}

static struct sdfgi_resolve_desc resolve_desc(const struct stage *s, VkImageView roughness)
{
    return (struct sdfgi_resolve_desc){
        .depth = s->depth.view,
        .normal = s->normal.view,
        .roughness = roughness,
        .background_depth = 1,
        .inverse_view_projection = { 3, 0, 0, 0, 0, 0, 3, 0, 0, -2, 0, 0, 0, -1, 0, 1 },
    };
}

/* Resolves a picture of one roughness; below 0: none is given. */
static void resolve(struct stage *s, sdfgi_view *view, float roughness)
{
    float pixels[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        pixels[i] = roughness;
    struct gpu_test_image image = gi_test_gather_image(&s->t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, pixels);
    const struct sdfgi_resolve_desc desc = resolve_desc(s, roughness < 0 ? VK_NULL_HANDLE : image.view);
    gi_test_resolve(&s->t, view, &desc);
    gpu_test_image_destroy(&s->t.gpu, &image);
}

static void read_picture(struct stage *s, const struct gpu_image *image, float (*out)[4])
{
    static uint16_t texels[PIXELS][4];
    gpu_test_image_read(&s->t.gpu, image->handle, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        (VkExtent3D){ SIDE, SIDE, 1 }, 8, texels);
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 4; k++)
            out[i][k] = gi_test_half(texels[i][k]);
}

static uint32_t dispatches(struct stage *s, enum pass pass)
{
    static struct sdfgi_report report;
    sdfgi_get_report(s->t.gi, &report);
    return report.passes[pass].dispatches;
}

static uint64_t view_bytes(struct stage *s)
{
    static struct sdfgi_report report;
    sdfgi_get_report(s->t.gi, &report);
    return report.memory.bytes[SDFGI_MEMORY_VIEWS];
}

/* ---- Tests */

static struct stage stage;

static void a_scene_without_smooth_materials_makes_nothing_for_reflections(void **state)
{
    (void)state;
    open_stage(&stage, 0.05f);
    sdfgi_view *view = create_view(&stage);
    const uint64_t before = view_bytes(&stage);
    resolve(&stage, view, 0.1f);
    struct sdfgi_view_images images;
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.diffuse != VK_NULL_HANDLE && images.reflection == VK_NULL_HANDLE);
    REQUIRE_CMP(view_bytes(&stage), ==, before);
    REQUIRE_CMP(dispatches(&stage, PASS_GATHER), ==, 1u);
    for (int pass = PASS_REFLECT_TILES; pass <= PASS_REFLECT_FILTER; pass++) {
        REQUIRE_CMP(dispatches(&stage, (enum pass)pass), ==, 0u);
        REQUIRE_TRUE(!stage.t.gi->backend.pipelines.passes[pass][0]);
    }
    close_stage(&stage);
}

static void surfaces_of_roughness_1_reflect_irradiance(void **state)
{
    (void)state;
    static float diffuse[PIXELS][4], reflection[PIXELS][4];
    open_stage(&stage, 1);
    sdfgi_view *view = create_view(&stage);
    resolve(&stage, view, 1);
    read_picture(&stage, &view->diffuse, diffuse);
    read_picture(&stage, &view->reflection, reflection);
    double worst = 0, brightest = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double want = (double)diffuse[i][k] / 3.14159265;
            worst = fmax(worst, fabs((double)reflection[i][k] - want) / fmax(want, 0.01));
            brightest = fmax(brightest, want);
        }
    printf("roughness 1: off by %.2e at most, brightest %.3f\n", worst, brightest);
    close_stage(&stage);
    REQUIRE_CMP(brightest, >, 0.3);
    REQUIRE_CMP(worst, <=, 0.002);
}

static void mirrors_show_the_sky_where_nothing_is_above(void **state)
{
    (void)state;
    static float reflection[PIXELS][4];
    open_stage(&stage, 1);
    sdfgi_view *view = create_view(&stage);
    resolve(&stage, view, 0);
    read_picture(&stage, &view->reflection, reflection);
    double worst = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double want = stage.depths[i] < 1 ? (double)ZENITH[k] : 0;
            worst = fmax(worst, fabs((double)reflection[i][k] - want));
        }
    printf("mirror: off by %.2e at most\n", worst);
    close_stage(&stage);
    REQUIRE_CMP(worst, <=, 0.002);
}

static double mean_luminance(float (*pixels)[4])
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += 0.2126 * (double)pixels[i][0] + 0.7152 * (double)pixels[i][1] + 0.0722 * (double)pixels[i][2];
    return sum / PIXELS;
}

/* Normals of a texture lean by 60 degrees: reflected rays would lead into the floor. Right of the wall they
 * see nothing but sky. */
static void normals_that_lean_reflect_no_surface_of_their_own(void **state)
{
    (void)state;
    static float reflection[PIXELS][4];
    stage.lean = 1.732f;
    open_stage(&stage, 1);
    stage.lean = 0;
    sdfgi_view *view = create_view(&stage);
    resolve(&stage, view, 0);
    read_picture(&stage, &view->reflection, reflection);
    for (int i = 0; i < PIXELS; i++)
        if (i % SIDE > SIDE / 2)
            REQUIRE_CMP(reflection[i][3], >=, 65000.0f);
    close_stage(&stage);
}

/* 64 steps from a mirror to a matt surface. */
static void roughness_changes_reflections_without_a_step(void **state)
{
    (void)state;
    static float reflection[PIXELS][4];
    open_stage(&stage, 1);
    sdfgi_view *view = create_view(&stage);
    double before = 0, worst = 0, first = 0;
    for (int step = 0; step <= 64; step++) {
        resolve(&stage, view, (float)step / 64);
        read_picture(&stage, &view->reflection, reflection);
        const double mean = mean_luminance(reflection);
        if (step > 0)
            worst = fmax(worst, fabs(mean - before) / fmax(mean, before));
        first = step == 0 ? mean : first;
        before = mean;
    }
    printf("roughness 0: %.3f, 1: %.3f, largest step %.2f %%\n", first, before, 100 * worst);
    close_stage(&stage);
    REQUIRE_CMP(fabs(first - before) / first, >, 0.05);
    REQUIRE_CMP(worst, <=, 0.03);
}

static void views_have_pictures_of_their_own_and_give_them_back(void **state)
{
    (void)state;
    static float a[PIXELS][4], b[PIXELS][4];
    open_stage(&stage, 1);
    const uint64_t none = view_bytes(&stage);
    sdfgi_view *one = create_view(&stage), *two = create_view(&stage);
    const uint64_t diffuse = view_bytes(&stage);
    resolve(&stage, one, 0);
    resolve(&stage, two, 1);
    read_picture(&stage, &two->reflection, b);
    resolve(&stage, two, 0);
    read_picture(&stage, &one->reflection, a);
    REQUIRE_CMP(memcmp(a, b, sizeof a), !=, 0);
    read_picture(&stage, &two->reflection, b);
    REQUIRE_CMP(memcmp(a, b, sizeof a), ==, 0);
    const uint64_t all = view_bytes(&stage);
    REQUIRE_CMP(diffuse, >=, none + 2 * 8 * PIXELS);
    REQUIRE_CMP(all, >=, diffuse + 2 * 20 * PIXELS);
    sdfgi_view_destroy(stage.t.gi, one);
    sdfgi_view_destroy(stage.t.gi, NULL);
    gi_test_update(&stage.t, 4);
    REQUIRE_CMP(view_bytes(&stage), ==, none + (all - none) / 2);
    sdfgi_view_destroy(stage.t.gi, two);
    gi_test_update(&stage.t, 4);
    REQUIRE_CMP(view_bytes(&stage), ==, none);
    close_stage(&stage);
}

static uint32_t rays_sent(struct stage *s, const sdfgi_view *view)
{
    uint32_t header[SDFGI_TILES_HEADER];
    gpu_test_buffer_read(&s->t.gpu, view->tiles.handle, 0, sizeof header, header);
    return header[SDFGI_TILES_RAYS + 3];
}

/* A quarter and a sixteenth of the rays, and those of pixels that lie fewer than a step beside the wall,
 * which is background, and of a ridge that lies between rays. So do rough surfaces at full resolution. Few
 * rays of a sixteenth meet the part of the wall that glows: the mean is up to 2.1 % off. */
static void fewer_rays_show_the_same(void **state)
{
    (void)state;
    static float full[PIXELS][4], other[PIXELS][4];
    static const struct {
        enum sdfgi_gather_resolution resolution;
        float roughness, beside; /* of the picture that it is compared with */
        uint32_t step;
    } rows[] = { { SDFGI_GATHER_HALF, 0, 0, 2 },         { SDFGI_GATHER_QUARTER, 0, 0, 4 },
                 { SDFGI_GATHER_HALF, 0.2f, 0.2f, 2 },   { SDFGI_GATHER_QUARTER, 0.2f, 0.2f, 4 },
                 { SDFGI_GATHER_HALF, 0.3f, 0.3f, 2 },   { SDFGI_GATHER_QUARTER, 0.3f, 0.3f, 4 },
                 { SDFGI_GATHER_FULL, 0.56f, 0.54f, 2 }, { SDFGI_GATHER_FULL, 0.65f, 0.63f, 4 } };
    stage.ridge = 13;
    open_stage(&stage, 1);
    stage.ridge = 0;
    sdfgi_view *whole = create_view(&stage);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const float roughness = rows[k].roughness;
        sdfgi_view *view = create_view_at(&stage, rows[k].resolution);
        resolve(&stage, whole, rows[k].beside);
        const uint32_t all = rays_sent(&stage, whole);
        REQUIRE_TRUE(all == SURFACES || rows[k].beside > 0.55f);
        read_picture(&stage, &whole->reflection, full);
        resolve(&stage, view, roughness);
        read_picture(&stage, &view->reflection, other);
        const uint32_t sent = rays_sent(&stage, view), step = rows[k].step;
        const double off = fabs(mean_luminance(other) / mean_luminance(full) - 1);
        for (int i = 0; i < PIXELS; i++)
            REQUIRE_TRUE(other[i][3] >= 0 && (other[i][3] > 0) == (stage.depths[i] < 1));
        for (int i = 13; i < PIXELS && roughness == 0; i += SIDE)
            REQUIRE_TRUE(fabsf(other[i][0] / full[i][0] - 1) < 1e-3f && full[i][2] < ZENITH[2]);
        printf("roughness %.2f: %u rays instead of %u, mean off by %.4f\n", (double)roughness, sent, all,
               off);
        REQUIRE_CMP(sent, >=, SURFACES / (step * step));
        REQUIRE_CMP(sent, <, SURFACES / (step * step) + (2 * step + 1) * SIDE);
        REQUIRE_CMP(off, <=, roughness > 0 ? 0.022 : 1e-5);
        sdfgi_view_destroy(stage.t.gi, view);
    }
    close_stage(&stage);
}

/* Two eyes, 40 cm apart from a metre above, whose pictures show the same points of the floor. */
static void eyes_share_an_update_and_see_the_same_light(void **state)
{
    (void)state;
    static float pictures[2][PIXELS][4];
    open_stage(&stage, 1);
    const uint32_t gathers = dispatches(&stage, PASS_GATHER), traces = dispatches(&stage, PASS_PROBE_TRACE);
    double worst = 0, brightest = 0;
    for (int eye = 0; eye < 2; eye++) {
        sdfgi_view *view = create_view(&stage);
        struct sdfgi_resolve_desc desc = resolve_desc(&stage, VK_NULL_HANDLE);
        desc.inverse_view_projection[8] = eye == 0 ? 0.4f : -0.4f;
        desc.inverse_view_projection[12] = eye == 0 ? -0.2f : 0.2f;
        gi_test_resolve(&stage.t, view, &desc);
        read_picture(&stage, &view->diffuse, pictures[eye]);
    }
    REQUIRE_CMP(dispatches(&stage, PASS_GATHER), ==, gathers + 2);
    REQUIRE_CMP(dispatches(&stage, PASS_PROBE_TRACE), ==, traces);
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double left = (double)pictures[0][i][k], right = (double)pictures[1][i][k];
            worst = fmax(worst, fabs(left - right) / fmax(fmax(left, right), 0.01));
            brightest = fmax(brightest, left);
        }
    printf("eyes: off by %.2e at most, brightest %.3f\n", worst, brightest);
    close_stage(&stage);
    REQUIRE_CMP(brightest, >, 0.3);
    REQUIRE_CMP(worst, <=, 0.01);
}

static void without_a_picture_of_roughness_there_are_no_reflections(void **state)
{
    (void)state;
    open_stage(&stage, 1);
    sdfgi_view *view = create_view(&stage);
    struct sdfgi_view_images images;
    resolve(&stage, view, 0);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection != VK_NULL_HANDLE);
    resolve(&stage, view, -1);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection == VK_NULL_HANDLE);
    close_stage(&stage);
}

/* ---- Thresholds */

/* Gives other thresholds to light that has settled: the update that follows does nothing else. */
static void set_thresholds(float blend, float end)
{
    static struct sdfgi_report report;
    struct sdfgi_settings settings;
    sdfgi_get_settings(stage.t.gi, &settings);
    settings.reflection_blend = blend;
    settings.reflection_end = end;
    REQUIRE_CMP((int)sdfgi_set_settings(stage.t.gi, &settings), ==, (int)SDFGI_OK);
    gi_test_update(&stage.t, 1);
    sdfgi_get_report(stage.t.gi, &report);
    REQUIRE_TRUE(report.converged);
    for (uint32_t i = 0; i < report.pass_count; i++)
        REQUIRE_CMP(report.passes[i].dispatches, ==, 0u);
}

/* Share of a picture of roughness 0.6 that is not what irradiance makes of it. */
static double unlike_irradiance(sdfgi_view *view)
{
    static float diffuse[PIXELS][4], reflection[PIXELS][4];
    double unlike = 0, sum = 0;
    resolve(&stage, view, 0.6f);
    read_picture(&stage, &view->diffuse, diffuse);
    read_picture(&stage, &view->reflection, reflection);
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            unlike += fabs((double)reflection[i][k] - (double)diffuse[i][k] / 3.14159265);
            sum += (double)diffuse[i][k] / 3.14159265;
        }
    return unlike / sum;
}

static void thresholds_of_roughness_are_followed_and_wake_no_light(void **state)
{
    (void)state;
    static struct sdfgi_report report;
    struct sdfgi_view_images images;
    open_stage(&stage, 1);
    for (int i = 0; i < 400 && !report.converged; i++) {
        gi_test_update(&stage.t, 1);
        sdfgi_get_report(stage.t.gi, &report);
    }
    REQUIRE_TRUE(report.converged);
    sdfgi_view *view = create_view(&stage);
    const double blended = unlike_irradiance(view);
    set_thresholds(1, 1);
    const double rays = unlike_irradiance(view);
    set_thresholds(0.7f, 0.6f); /* the blend would begin beyond its end: there is none */
    const double rough = unlike_irradiance(view);
    set_thresholds(0.7f, 0.61f);
    const double sharp = unlike_irradiance(view);
    printf("unlike irradiance: blended %.4f, rays alone %.4f, rough %.4f\n", blended, rays, rough);
    REQUIRE_NEAR(sharp, rays, 1e-6);
    REQUIRE_CMP(rays, >, 1.2 * blended);
    REQUIRE_CMP(blended, >, 0.01);
    REQUIRE_CMP(rough, <=, 1e-3);
    set_thresholds(0.4f, 0);
    resolve(&stage, view, 0);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection == VK_NULL_HANDLE);
    REQUIRE_CMP(dispatches(&stage, PASS_REFLECT_TILES), ==, 0u);
    close_stage(&stage);
}

static void bad_views_are_refused(void **state)
{
    (void)state;
    open_stage(&stage, 1);
    static const struct sdfgi_view_desc wrong[] = { { .height = 4 },
                                                    { .width = 4 },
                                                    { .width = 4, .height = UINT32_MAX },
                                                    { 4, 4, .diffuse = (enum sdfgi_gather_resolution)7 },
                                                    { 4, 4, .reflection = (enum sdfgi_gather_resolution)3 } };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        sdfgi_view *view = (sdfgi_view *)&stage;
        REQUIRE_CMP((int)sdfgi_view_create(stage.t.gi, &wrong[i], &view), ==,
                    (int)SDFGI_ERROR_INVALID_ARGUMENT);
        REQUIRE_TRUE(view == (sdfgi_view *)&stage);
    }
    sdfgi_view *view = create_view(&stage);
    struct sdfgi_resolve_desc desc = resolve_desc(&stage, VK_NULL_HANDLE);
    desc.depth = VK_NULL_HANDLE;
    REQUIRE_CMP((int)sdfgi_view_resolve(stage.t.gi, view, (VkCommandBuffer)&stage, &desc), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(stage.t.last_message, "depth is null") != NULL);
    desc = resolve_desc(&stage, VK_NULL_HANDLE);
    desc.scale = NAN;
    REQUIRE_CMP((int)sdfgi_view_resolve(stage.t.gi, view, (VkCommandBuffer)&stage, &desc), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    const struct sdfgi_material_desc too_smooth = { .smoothness = 1.5f };
    sdfgi_material material = { 77 };
    REQUIRE_CMP((int)sdfgi_material_create(stage.t.gi, &too_smooth, &material), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(stage.t.last_message, "smoothness") != NULL);
    const struct sdfgi_material_desc bad_metal = { .metallic = -0.01f };
    REQUIRE_CMP((int)sdfgi_material_create(stage.t.gi, &bad_metal, &material), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(stage.t.last_message, "metallic") != NULL);
    close_stage(&stage);
}

static int finish(void **state)
{
    (void)state;
    gi_test_close(&stage.t);
    return 0;
}

TEST_GROUP(view)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_without_smooth_materials_makes_nothing_for_reflections),
        cmocka_unit_test(surfaces_of_roughness_1_reflect_irradiance),
        cmocka_unit_test(mirrors_show_the_sky_where_nothing_is_above),
        cmocka_unit_test(normals_that_lean_reflect_no_surface_of_their_own),
        cmocka_unit_test(roughness_changes_reflections_without_a_step),
        cmocka_unit_test(views_have_pictures_of_their_own_and_give_them_back),
        cmocka_unit_test(fewer_rays_show_the_same),
        cmocka_unit_test(eyes_share_an_update_and_see_the_same_light),
        cmocka_unit_test(without_a_picture_of_roughness_there_are_no_reflections),
        cmocka_unit_test(thresholds_of_roughness_are_followed_and_wake_no_light),
        cmocka_unit_test(bad_views_are_refused),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, finish);
}
