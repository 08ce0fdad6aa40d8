/* SPDX-License-Identifier: MIT
 * Rough surfaces of a view reflect light by where it comes from: what that needs, and what it leaves alone.
 */
#include "require.h"
#include "test_group.h"
#include "view_stage.h"
#include "host_lookup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct view_stage stage;
static float diffuse[VIEW_STAGE_PIXELS][4], reflection[VIEW_STAGE_PIXELS][4];

/* Frames after which light cells have seen the wall that glows. */
enum { FRAMES = 60 };

/* The floor of the stage, seen along the floor: `side` 1 from beyond its wall, so that the wall lies behind
 * the viewer, -1 from the other end. 20 degrees above the floor. */
static void look_along(struct sdfgi_resolve_desc *desc, float side)
{
    const float eye[] = { -0.94f * side, 0.342f, 0 };
    for (int i = 0; i < 3; i++) {
        desc->inverse_view_projection[8 + i] = -2 * eye[i];
        desc->inverse_view_projection[12 + i] = eye[i] + (i == 1 ? -2.0f : 0.0f);
    }
}

/* What part of the floor a picture shows: all of it, or a tenth as much of each axis, near the wall. Pixels
 * are so small there that the filter of a view blurs nothing. */
static const struct floor_part {
    float x, scale;
} whole = { 0, 1 }, near_wall = { -1.0f, 0.01f };
static const struct floor_part *part = &whole;

/* Resolves the picture with one roughness, that of metal below 0; `side` 0: seen from above. */
static void resolve(sdfgi_view *view, float roughness, float side)
{
    float pixels[VIEW_STAGE_PIXELS];
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        pixels[i] = roughness;
    struct gpu_test_image image =
        gi_test_gather_image(&stage.t, VK_FORMAT_R32_SFLOAT, 4, VIEW_STAGE_SIDE, VIEW_STAGE_SIDE, pixels);
    struct sdfgi_resolve_desc desc = view_stage_desc(&stage, image.view);
    if (side != 0)
        look_along(&desc, side);
    for (int i = 0; i < 8; i++)
        desc.inverse_view_projection[i] *= part->scale;
    desc.inverse_view_projection[12] += part->x;
    gi_test_resolve(&stage.t, view, &desc);
    gpu_test_image_destroy(&stage.t.gpu, &image);
    view_stage_read(&stage, &view->diffuse, diffuse);
    view_stage_read(&stage, &view->reflection, reflection);
}

/* Looks the floor of the same picture up with sdfgi_lighting, which sends so many rays over a lobe. */
static void look_up(float roughness, float side, float rays, struct host_lookup *lookups)
{
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++) {
        const float u = ((float)(i % VIEW_STAGE_SIDE) + 0.5f) / VIEW_STAGE_SIDE * 2 - 1,
                    v = ((float)(i / VIEW_STAGE_SIDE) + 0.5f) / VIEW_STAGE_SIDE * 2 - 1;
        lookups[i] =
            (struct host_lookup){ .position = { part->x + 3 * part->scale * u, -2, 3 * part->scale * v },
                                  .roughness = roughness,
                                  .normal = { 0, 1, 0 },
                                  .rays = rays,
                                  .to_eye = { -0.94f * side, 0.342f, 0 } };
    }
    host_lookup_run(&stage.t, lookups, VIEW_STAGE_PIXELS);
}

static bool on_floor(int pixel)
{
    const int column = pixel % VIEW_STAGE_SIDE, row = pixel / VIEW_STAGE_SIDE;
    return column >= 8 && column <= 19 && row >= 6 && row <= 17;
}

static double luminance(const float *pixel)
{
    return 0.2126 * (double)pixel[0] + 0.7152 * (double)pixel[1] + 0.0722 * (double)pixel[2];
}

/* What the floor between the wall and a metre before the picture's edge reflects over its irradiance over
 * pi. From pixel to pixel there are `stride` floats. */
static double answer_of(const float *reflected, const float *irradiance, size_t stride)
{
    double reflects = 0, arrives = 0;
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        if (on_floor(i)) {
            reflects += luminance(&reflected[stride * (size_t)i]);
            arrives += luminance(&irradiance[stride * (size_t)i]) / 3.14159265;
        }
    REQUIRE_CMP(arrives, >, 0.0);
    return reflects / arrives;
}

/* Of the view's picture. */
static double mean_answer(void)
{
    return answer_of(reflection[0], diffuse[0], 4);
}

static double worst_from_irradiance(void)
{
    double worst = 0;
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double want = (double)diffuse[i][k] / 3.14159265;
            worst = fmax(worst, fabs((double)reflection[i][k] - want) / fmax(want, 0.01));
        }
    return worst;
}

static void set_property(const char *name, const char *value)
{
    struct sdfgi_settings settings;
    sdfgi_get_settings(stage.t.gi, &settings);
    char error[160];
    REQUIRE_TRUE(sdfgi_settings_set(&settings, name, value, error, sizeof error));
    REQUIRE_CMP((int)sdfgi_set_settings(stage.t.gi, &settings), ==, (int)SDFGI_OK);
}

/* The stage with light cells that gather. Its wall alone glows. */
static void open_stage(float smoothness)
{
    view_stage_open(&stage, smoothness);
    REQUIRE_CMP((int)sdfgi_set_sky(stage.t.gi, &(struct sdfgi_sky){ 0 }), ==, (int)SDFGI_OK);
    set_property("sdfgi_surface_light", "cells");
    gi_test_update(&stage.t, 8);
}

static void close_stage(sdfgi_view *view)
{
    sdfgi_view_destroy(stage.t.gi, view);
    view_stage_close(&stage);
}

/* A view that has resolved reflections, and light that knows where it comes from. */
static sdfgi_view *open_lit(void)
{
    open_stage(1);
    sdfgi_view *view = view_stage_view(&stage);
    resolve(view, 1, 0);
    gi_test_update(&stage.t, FRAMES);
    return view;
}

static void a_floor_reflects_the_wall_beyond_and_not_the_one_behind(void **state)
{
    (void)state;
    sdfgi_view *view = open_lit();
    resolve(view, 0.8f, -1);
    const double beyond = mean_answer();
    resolve(view, 0.8f, 1);
    const double behind = mean_answer();
    set_property("sdfgi_reflection_end", "1");
    set_property("sdfgi_reflection_blend", "0.99");
    gi_test_update(&stage.t, 1);
    resolve(view, 0.8f, -1);
    const double by_rays = mean_answer();
    resolve(view, 0.8f, 1);
    const double behind_by_rays = mean_answer();
    printf("reflected over irradiance: the wall beyond %.3f, by rays %.3f; behind %.3f, by rays %.3f\n",
           beyond, by_rays, behind, behind_by_rays);
    close_stage(view);
    /* Five moments do not tell how narrow light is that comes from beyond. */
    REQUIRE_CMP(beyond, >, 0.6 * by_rays);
    REQUIRE_CMP(beyond, <, 1.1 * by_rays);
    REQUIRE_CMP(fabs(behind / behind_by_rays - 1), <, 0.1);
}

static void metal_of_roughness_1_reflects_irradiance(void **state)
{
    (void)state;
    sdfgi_view *view = open_lit();
    resolve(view, -1, -1);
    const double metal = worst_from_irradiance();
    REQUIRE_CMP(view_stage_dispatches(&stage, PASS_REFLECT_LOBES), ==, 1u);
    resolve(view, 1, -1);
    const double dielectric = worst_from_irradiance();
    printf("roughness 1 from irradiance: metal off by %.2e, dielectric by %.2f\n", metal, dielectric);
    close_stage(view);
    REQUIRE_CMP(metal, <=, 0.002);
    REQUIRE_CMP(dielectric, >, 0.1);
}

static bool keeps_low_light(void)
{
    return stage.t.gi->volume.state.low_light;
}

/* The words of all light cells. */
static uint64_t known_surfaces(void)
{
    const struct extent *e = &stage.t.gi->volume.resources->extent;
    uint64_t size, known = 0;
    uint32_t *words = gi_test_read(&stage.t, RESOURCE_SEEN, &size);
    for (uint64_t i = sdfgi_seen_low_light((uint32_t)e->light_cells, (uint32_t)e->cascades); i < size / 4;
         i++)
        known += words[i] != 0;
    free(words);
    return known;
}

/* True if the last update cleared what light cells knew of before. */
static bool cleared(void)
{
    const struct work_list *list = &stage.t.gi->frame.work;
    for (uint32_t i = 0; i < list->count; i++) {
        const struct work *work = &list->items[i];
        if (work->kind == WORK_CLEAR && work->resource == RESOURCE_SEEN && work->offset == 0 &&
            work->bytes == sdfgi_resource_size(RESOURCE_SEEN, &stage.t.gi->volume.resources->extent))
            return true;
    }
    return false;
}

static void switched_off_surfaces_reflect_irradiance_and_cells_forget(void **state)
{
    (void)state;
    sdfgi_view *view = open_lit();
    REQUIRE_TRUE(keeps_low_light());
    REQUIRE_CMP(known_surfaces(), >, 100u);
    set_property("sdfgi_rough_lobes", "false");
    gi_test_update(&stage.t, 2);
    REQUIRE_TRUE(!keeps_low_light());
    resolve(view, 0.8f, -1);
    REQUIRE_CMP(worst_from_irradiance(), <=, 0.002);
    REQUIRE_CMP(view_stage_dispatches(&stage, PASS_REFLECT_LOBES), ==, 0u);
    set_property("sdfgi_rough_lobes", "true");
    gi_test_update(&stage.t, 1);
    REQUIRE_TRUE(cleared());
    gi_test_update(&stage.t, FRAMES);
    REQUIRE_TRUE(!cleared());
    resolve(view, 0.8f, -1);
    REQUIRE_CMP(mean_answer(), >, 2.0);
    close_stage(view);
}

/* Nothing of it is there before a view has reflections, and it settles. */
static void light_cells_keep_it_for_reflections_alone(void **state)
{
    (void)state;
    open_stage(0.05f);
    set_property("sdfgi_cell_rays", "128"); /* light settles sooner */
    sdfgi_view *view = view_stage_view(&stage);
    view_stage_resolve(&stage, view, 1);
    gi_test_update(&stage.t, 2);
    const struct volume *volume = &stage.t.gi->volume;
    REQUIRE_TRUE(!keeps_low_light() && !volume->resources->extent.low_light);
    REQUIRE_TRUE(!sdfgi_pipelines_has(&stage.t.gi->backend, PASS_CELL_GATHER, PASS_LOBES));
    const struct sdfgi_material_desc smooth = { .smoothness = 1 };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(stage.t.gi, &smooth, &material), ==, (int)SDFGI_OK);
    for (int i = 0; i < 6000 && !sdfgi_volume_has_settled(volume); i++)
        gi_test_update(&stage.t, 1);
    REQUIRE_TRUE(sdfgi_volume_has_settled(volume) && !keeps_low_light());
    resolve(view, 0.8f, -1);
    REQUIRE_CMP(worst_from_irradiance(), <=, 0.002);
    gi_test_update(&stage.t, 1);
    REQUIRE_TRUE(keeps_low_light() && !sdfgi_volume_has_settled(volume));
    int frames = 0;
    for (; frames < 6000 && !sdfgi_volume_has_settled(volume); frames++)
        gi_test_update(&stage.t, 1);
    resolve(view, 0.8f, -1);
    printf("settles again in %d frames, and reflects %.3f of irradiance; %u surfaces know it\n", frames,
           mean_answer(), (unsigned)known_surfaces());
    REQUIRE_TRUE(sdfgi_volume_has_settled(volume));
    REQUIRE_CMP(mean_answer(), >, 2.0);
    close_stage(view);
}

/* What is new lies above the picture, behind the viewer. */
static void cells_keep_it_where_the_list_is_written_anew(void **state)
{
    (void)state;
    sdfgi_view *view = open_lit();
    resolve(view, 0.8f, -1);
    const double before = mean_answer();
    struct test_mesh box =
        test_mesh_box((double[]){ 3.2, 2, 3.2 }, (double[]){ 0.5, 0.5, 0.5 }, test_rotation_none);
    gi_test_add(&stage.t, &box, gi_test_material(&stage.t, (float[]){ 0, 0, 0 }, (float[]){ 0, 0, 0 }));
    test_mesh_destroy(&box);
    bool listed = false;
    for (int i = 0; i < 60 && !listed; i++) {
        gi_test_update(&stage.t, 1);
        listed = stage.t.gi->passes[PASS_LIGHT_LIST].tally.dispatches > 0;
    }
    REQUIRE_TRUE(listed);
    resolve(view, 0.8f, -1);
    printf("reflected over irradiance: %.3f, and %.3f in the frame of a change\n", before, mean_answer());
    REQUIRE_CMP(fabs(mean_answer() / before - 1), <, 0.05);
    close_stage(view);
}

/* Of a shader of the host's own over a view's picture: reflections on the floor, in the mean, and how far one
 * is off at most where the picture has asked the lobe and does not interpolate. */
struct agreement {
    double mean, worst;
};

static bool asks_lobe(int pixel)
{
    return pixel % VIEW_STAGE_SIDE % SDFGI_LOBE_STEP == 0 && pixel / VIEW_STAGE_SIDE % SDFGI_LOBE_STEP == 0;
}

static struct agreement forward_over_picture(sdfgi_view *view, float roughness, float side, float rays)
{
    static struct host_lookup lookups[VIEW_STAGE_PIXELS];
    resolve(view, roughness, side);
    look_up(roughness, side, rays, lookups);
    double forward = 0, picture = 0, worst = 0;
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++) {
        if (!on_floor(i))
            continue;
        const double a = luminance(lookups[i].answers[2]), b = luminance(reflection[i]);
        forward += a;
        picture += b;
        if (asks_lobe(i))
            worst = fmax(worst, fabs(a / b - 1));
    }
    printf("roughness %.2f from side %.0f, %.0f rays: forward over picture %.4f, off by %.4f at most\n",
           (double)roughness, (double)side, (double)rays, forward / picture, worst);
    return (struct agreement){ forward / picture, worst };
}

static void shaders_of_hosts_answer_as_pictures_do(void **state)
{
    (void)state;
    sdfgi_view *view = open_lit();
    const float roughness[] = { 0.8f, 1, -1 };
    for (int i = 0; i < 6; i++) {
        const struct agreement a = forward_over_picture(view, roughness[i / 2], i % 2 ? 1 : -1, 1);
        /* Pictures have half floats, and interpolate over a metre. */
        REQUIRE_CMP(a.worst, <=, 0.002);
        REQUIRE_CMP(fabs(a.mean - 1), <=, 0.01);
    }
    close_stage(view);
}

/* Many rays over a lobe bring what a view makes of the rays of neighbouring pixels. They take the mean of
 * what a block's side emits, and a view does not: that is 4 to 9 % here. One ray, along the middle of the
 * lobe, does not meet the wall that stands beside what is seen from above. */
static void rays_over_the_lobe_bring_what_pictures_show(void **state)
{
    (void)state;
    sdfgi_view *view = open_lit();
    part = &near_wall;
    const float roughness[] = { 0.3f, 0.45f, -0.45f };
    for (int i = 0; i < 6; i++) {
        const float side = i % 2 ? 0 : -1;
        const double one = forward_over_picture(view, roughness[i / 2], side, 1).mean,
                     many = forward_over_picture(view, roughness[i / 2], side, 64).mean;
        REQUIRE_CMP(fabs(many - 1), <=, 0.1);
        REQUIRE_TRUE(side < 0 || one < 0.01);
    }
    part = &whole;
    close_stage(view);
}

/* Of sdfgi_lighting alone, beyond the viewer. */
static double forward_answer(void)
{
    static struct host_lookup lookups[VIEW_STAGE_PIXELS];
    look_up(0.8f, -1, 1, lookups);
    return answer_of(lookups[0].answers[2], lookups[0].answers[1], sizeof *lookups / sizeof(float));
}

/* A host without views says that its shaders reflect. */
static void forward_hosts_ask_for_it(void **state)
{
    (void)state;
    open_stage(0);
    stage.t.frame.forward_reflections = true;
    gi_test_update(&stage.t, 2);
    REQUIRE_TRUE(!keeps_low_light());
    const struct sdfgi_material_desc smooth = { .smoothness = 0.1f };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(stage.t.gi, &smooth, &material), ==, (int)SDFGI_OK);
    gi_test_update(&stage.t, FRAMES);
    const double asked = forward_answer();
    /* As on a device whose texel buffers are too short. */
    uint32_t *limit = &stage.t.gi->backend.device.limits.maxTexelBufferElements;
    const uint32_t of_device = *limit;
    *limit = (uint32_t)(stage.t.gi->volume.resources->buffers[RESOURCE_SEEN].size / 4) - 1;
    gi_test_update(&stage.t, 2);
    const double on_small_device = forward_answer();
    *limit = of_device;
    stage.t.frame.forward_reflections = false;
    gi_test_update(&stage.t, 2);
    const double not_asked = forward_answer();
    view_stage_close(&stage);
    printf("forward: reflected over irradiance %.3f; where texel buffers are short %.3f; not asked %.3f\n",
           asked, on_small_device, not_asked);
    REQUIRE_CMP(asked, >, 2.0);
    REQUIRE_CMP(fabs(on_small_device - 1), <=, 0.002);
    REQUIRE_CMP(fabs(not_asked - 1), <=, 0.002);
    REQUIRE_TRUE(!keeps_low_light());
}

static int finish(void **state)
{
    (void)state;
    gi_test_close(&stage.t);
    return 0;
}

TEST_GROUP(rough_lobes)
{
    const struct CMUnitTest tests[] = {
        /* first: the pipelines of a context stay */
        cmocka_unit_test(light_cells_keep_it_for_reflections_alone),
        cmocka_unit_test(a_floor_reflects_the_wall_beyond_and_not_the_one_behind),
        cmocka_unit_test(metal_of_roughness_1_reflects_irradiance),
        cmocka_unit_test(switched_off_surfaces_reflect_irradiance_and_cells_forget),
        cmocka_unit_test(cells_keep_it_where_the_list_is_written_anew),
        cmocka_unit_test(shaders_of_hosts_answer_as_pictures_do),
        cmocka_unit_test(rays_over_the_lobe_bring_what_pictures_show),
        cmocka_unit_test(forward_hosts_ask_for_it),
    };
    return cmocka_run_group_tests_name("rough_lobes", tests, NULL, finish);
}
