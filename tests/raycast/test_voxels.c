/* SPDX-License-Identifier: MIT
 * Truth over voxels: the same known answers as over triangles where discretisation cannot change them, and no
 * light through closed walls at any angle. */
#include "files.h"
#include "voxel_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ERROR_BYTES = 256 };

static const double pi = 3.14159265358979323846;
static const double tolerance = 0.005;
static const double origin[3] = { 0, 0, 0 };

struct query {
    double point[3];
    float normal[3];
    uint32_t samples;
};

/* Light from all but lamps that arrives at a point in free space. */
static double gather(const struct built_scene *s, const struct voxel_scene *v,
                     const struct raycast_view *view, const struct query *q)
{
    const struct raycast_settings settings = { .width = 1, .height = 1, .voxels = &v->voxels };
    struct raycast *rc = tracer_create(s, view, &settings);
    struct raycast_irradiance out;
    raycast_irradiance_gather(rc, q->point, q->normal, 1, q->samples, &out);
    raycast_destroy(rc);
    return (double)out.indirect[1];
}

enum { WIDTH = 48, HEIGHT = 48, VALUES = WIDTH * HEIGHT * 3 };

static void render(const struct built_scene *s, const struct raycast_voxels *voxels,
                   const struct raycast_view *view, enum raycast_aov aov, uint32_t spp, float out[VALUES])
{
    const struct raycast_settings settings = {
        .width = WIDTH, .height = HEIGHT, .aovs = 1u << aov, .voxels = voxels
    };
    struct raycast *rc = tracer_create(s, view, &settings);
    struct raycast_progress last;
    assert_true(raycast_render(rc, &(struct raycast_budget){ .samples = spp }, NULL, NULL, &last));
    assert_int_equal(last.not_finite, 0);
    assert_true(raycast_image(rc, aov, out));
    raycast_destroy(rc);
}

static double mean(const float values[VALUES])
{
    double sum = 0;
    for (int i = 0; i < VALUES; i++)
        sum += (double)values[i];
    return sum / VALUES;
}

static float picture[VALUES], other[VALUES];

static struct raycast_view lambert_view(double x, double y, double z)
{
    struct raycast_view view = view_make((double[]){ 0.3, 0.2, 0.5 }, (double[]){ x, y, z }, 70);
    view.materials = RAYCAST_MATERIALS_LAMBERT;
    return view;
}

/* ---- Energy ----------------------------------------------------------------------------------------- */

static void add_emissive_material(struct built_scene *s, float albedo, float emission)
{
    struct gltf_material *m = scene_add_material(s, albedo);
    for (int k = 0; k < 3; k++)
        m->emissive[k] = emission;
}

/* Radiance in a closed room whose walls all emit 1, over its exact value. */
static double furnace(float albedo, const double rotation[9], double cell_m, double y_scale,
                      uint32_t cascades)
{
    struct built_scene s;
    struct voxel_scene v;
    sdfgi_scene_init(&s);
    add_emissive_material(&s, albedo, 1);
    scene_add_mesh(&s, test_mesh_room(origin, (double[]){ 1.1, 1, 1.15 }, 0.3, rotation));
    voxel_scene_init(&v, &s, cell_m, y_scale, cascades);
    const struct raycast_view view = lambert_view(1, -1, -2);
    render(&s, &v.voxels, &view, RAYCAST_AOV_RADIANCE, 16, picture);
    voxel_scene_finish(&v);
    sdfgi_scene_finish(&s);
    /* Albedo is stored in 1/255. */
    const double stored = lrintf(255 * albedo) / 255.0;
    const double ratio = mean(picture) / (1 + (double)albedo / (1 - stored));
    printf("furnace of albedo %.1f: %.4f of its light\n", (double)albedo, ratio);
    return ratio;
}

static void closed_room_sums_all_bounces(void **state)
{
    (void)state;
    assert_ratio(furnace(0.5f, test_rotation_none, 0.125, 1, 1), 1, tolerance);
    assert_ratio(furnace(0.8f, test_rotation_none, 0.125, 1, 1), 1, tolerance);
    assert_ratio(furnace(0.8f, test_rotation_none, 0.125, 0.75, 1), 1, tolerance);
}

/* The finest cascade ends inside the room. */
static void cascades_join_without_loss(void **state)
{
    (void)state;
    assert_ratio(furnace(0.8f, test_rotation_none, 0.0625, 1, 2), 1, tolerance);
}

static void turned_room_sums_all_bounces(void **state)
{
    (void)state;
    double rotation[9];
    /* All components of the walls' normals are 1/3 or more: every side of a step is one that its slope emits
     * to. */
    test_rotation((double[]){ 1, 1, 1 }, pi / 3, rotation);
    assert_ratio(furnace(0.5f, rotation, 0.125, 1, 1), 1, tolerance);
    assert_ratio(furnace(0.8f, rotation, 0.0625, 1, 2), 1, tolerance);
}

/* ---- Light ------------------------------------------------------------------------------------------ */

/* A plane that leans by some degrees sees all of its half of a uniform sky: its own steps do not shade it. */
static void leaning_plane_sees_its_whole_sky(void **state)
{
    (void)state;
    for (int degrees = 0; degrees <= 45; degrees += 9) {
        const float c = (float)cos(degrees * pi / 180), n = (float)sin(degrees * pi / 180);
        struct built_scene s;
        struct voxel_scene v;
        sdfgi_scene_init(&s);
        scene_add_material(&s, 1);
        scene_add_quad(&s, (float[]){ -1.5f * c, -1.5f * n, 1.5f }, (float[]){ 3 * c, 3 * n, 0 },
                       (float[]){ 0, 0, -3 });
        voxel_scene_init(&v, &s, 0.125, 1, 1);
        struct raycast_view view = view_make((double[]){ -n, c, 0 }, origin, 30);
        view.camera.up[0] = c;
        view.camera.up[1] = n;
        view.materials = RAYCAST_MATERIALS_LAMBERT;
        view_set_sky(&view, 2);
        render(&s, &v.voxels, &view, RAYCAST_AOV_RADIANCE, 32, picture);
        printf("plane at %d degrees: %.5f of the sky\n", degrees, mean(picture) / 2);
        assert_ratio(mean(picture), 2, 2e-3);
        voxel_scene_finish(&v);
        sdfgi_scene_finish(&s);
    }
}

/* Form factor of a level square of side 2 `half` seen from below or above its middle. */
static double form_factor(double half, double height)
{
    const double x = half / height, root = sqrt(1 + x * x);
    return 4 / pi * (x / root) * atan(x / root);
}

/* The light of a sunlit floor at a point above it that faces down; of a leaning one, at a point that faces
 * it. */
static void sunlit_plane_lights_what_faces_it(void **state)
{
    (void)state;
    for (int degrees = 0; degrees <= 45; degrees += 15) {
        const float c = (float)cos(degrees * pi / 180), n = (float)sin(degrees * pi / 180);
        struct built_scene s;
        struct voxel_scene v;
        sdfgi_scene_init(&s);
        scene_add_material(&s, 0.6f);
        scene_add_quad(&s, (float[]){ -1.2f * c, -1.2f * n, 1.2f }, (float[]){ 2.4f * c, 2.4f * n, 0 },
                       (float[]){ 0, 0, -2.4f });
        voxel_scene_init(&v, &s, 0.125, 1, 1);
        struct raycast_view view = lambert_view(0, 0, 0);
        view.sun = (struct raycast_sun){ .direction = { 1, -2, 0.5f }, .irradiance = { 3, 3, 3 } };
        const struct query q = { { -n, c, 0 }, { n, -c, 0 }, 40000 };
        const double cosine = (2 * c + n) / sqrt(1 + 4 + 0.25);
        const double expected = 0.6 * 3 * cosine * form_factor(1.2, 1);
        /* The middle of a layer of voxels lies up to half a sub-voxel, 0.016 m, off the plane. */
        assert_ratio(gather(&s, &v, &view, &q), expected, degrees == 0 ? 0.02 : 0.04);
        voxel_scene_finish(&v);
        sdfgi_scene_finish(&s);
    }
}

/* 16 x 16 sub-voxels whose lower faces are at 1.5 m. */
static void emissive_voxels_match_their_form_factor(void **state)
{
    (void)state;
    struct built_scene s;
    struct voxel_scene v;
    sdfgi_scene_init(&s);
    add_emissive_material(&s, 0, 6);
    scene_add_floor(&s, 1.52f, 0.5f, false);
    voxel_scene_init(&v, &s, 0.125, 1, 1);
    const struct raycast_view view = lambert_view(0, 0, 0);
    const struct query q = { { 0, 0, 0 }, { 0, 1, 0 }, 50000 };
    assert_ratio(gather(&s, &v, &view, &q), pi * 6 * form_factor(0.5, 1.5), tolerance);
    voxel_scene_finish(&v);
    sdfgi_scene_finish(&s);
}

/* ---- Walls ------------------------------------------------------------------------------------------ */

static void sealed_room_stays_dark(void **state)
{
    (void)state;
    for (int i = 0; i < 6; i++) {
        double rotation[9];
        struct built_scene s;
        struct voxel_scene v;
        test_rotation((double[]){ i % 3, 1, i / 3 }, i * 0.26, rotation);
        sdfgi_scene_init(&s);
        scene_add_material(&s, 0.8f);
        /* The two sides of a wall fall into the same or neighbouring sub-voxels. */
        scene_add_mesh(&s, test_mesh_room(origin, (double[]){ 1.1, 1, 1.2 }, 0.01, rotation));
        voxel_scene_init(&v, &s, 0.125, 1, i % 2 ? 2 : 1);
        struct raycast_view view = lambert_view(1, -1, -2);
        view.camera.yfov_deg = 120;
        view_set_sky(&view, 1);
        view.sun = (struct raycast_sun){ .direction = { 1, -2, 0.5f }, .irradiance = { 50, 50, 50 } };
        render(&s, &v.voxels, &view, RAYCAST_AOV_RADIANCE, 16, picture);
        if (mean(picture) != 0)
            fail_msg("rotation %d: %g of light outside comes in", i, mean(picture));
        voxel_scene_finish(&v);
        sdfgi_scene_finish(&s);
    }
}

/* ---- A room ----------------------------------------------------------------------------------------- */

static void room_build(struct built_scene *s)
{
    double rotation[9];
    sdfgi_scene_init(s);
    scene_add_material(s, 0.7f);
    scene_add_room(s, 1.4f);
    scene_add_material(s, 0.5f);
    test_rotation((double[]){ 0, 1, 0 }, 0.4, rotation);
    scene_add_mesh(s, test_mesh_box((double[]){ 0.5, -1, -0.6 }, (double[]){ 0.35, 0.4, 0.35 }, rotation));
    add_emissive_material(s, 0.2f, 10);
    scene_add_floor(s, 1.37f, 0.41f, false);
}

static void room_agrees_with_triangles(void **state)
{
    (void)state;
    struct built_scene s;
    struct voxel_scene v;
    room_build(&s);
    voxel_scene_init(&v, &s, 0.1, 1, 1);
    const struct raycast_view view = lambert_view(0, -0.4, -1);
    render(&s, NULL, &view, RAYCAST_AOV_DIFFUSE_INDIRECT, 64, other);
    render(&s, &v.voxels, &view, RAYCAST_AOV_DIFFUSE_INDIRECT, 64, picture);
    const double ratio = mean(picture) / mean(other);
    printf("room, light over voxels / over triangles: %.4f\n", ratio);
    assert_ratio(ratio, 1, 0.1);
    /* What the camera sees is the same. */
    render(&s, NULL, &view, RAYCAST_AOV_NORMAL, 4, other);
    render(&s, &v.voxels, &view, RAYCAST_AOV_NORMAL, 4, picture);
    assert_ratio(mean(picture), mean(other), 0.02);
    voxel_scene_finish(&v);
    sdfgi_scene_finish(&s);
}

static void volumes_are_part_of_a_picture(void **state)
{
    (void)state;
    char error[ERROR_BYTES] = "";
    struct built_scene s;
    struct voxel_scene v;
    room_build(&s);
    voxel_scene_init(&v, &s, 0.1, 1, 1);
    const struct raycast_view view = lambert_view(0, -0.4, -1);
    const struct raycast_settings settings = { .width = 8, .height = 8, .voxels = &v.voxels };
    struct raycast *a = tracer_create(&s, &view, &settings);
    assert_true(raycast_render(a, &(struct raycast_budget){ .samples = 2 }, NULL, NULL, NULL));
    state_save(a, files_path("picture.state"));
    assert_true(raycast_state_load(a, files_path("picture.state"), error, sizeof error));
    raycast_destroy(a);
    v.bits[0][5]++;
    struct raycast *b = tracer_create(&s, &view, &settings);
    assert_false(raycast_state_load(b, files_path("picture.state"), error, sizeof error));
    raycast_destroy(b);
    voxel_scene_finish(&v);
    sdfgi_scene_finish(&s);
}

static void volumes_off_the_lattice_are_refused(void **state)
{
    (void)state;
    char error[ERROR_BYTES] = "";
    struct built_scene s;
    struct voxel_scene v;
    room_build(&s);
    voxel_scene_init(&v, &s, 0.1, 1, 2);
    const struct raycast_view view = lambert_view(0, -0.4, -1);
    const struct raycast_settings settings = { .width = 8, .height = 8, .voxels = &v.voxels };
    v.voxels.cascades[1].low_m[2] += 0.2;
    assert_null(raycast_create(&s.gltf, &view, &settings, error, sizeof error));
    assert_non_null(strstr(error, "cascade 1"));
    v.voxels.cascade_count = RAYCAST_MAX_CASCADES + 1;
    assert_null(raycast_create(&s.gltf, &view, &settings, error, sizeof error));
    assert_non_null(strstr(error, "9 cascades"));
    voxel_scene_finish(&v);
    sdfgi_scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_room_sums_all_bounces),
        cmocka_unit_test(cascades_join_without_loss),
        cmocka_unit_test(turned_room_sums_all_bounces),
        cmocka_unit_test(leaning_plane_sees_its_whole_sky),
        cmocka_unit_test(sunlit_plane_lights_what_faces_it),
        cmocka_unit_test(emissive_voxels_match_their_form_factor),
        cmocka_unit_test(sealed_room_stays_dark),
        cmocka_unit_test(room_agrees_with_triangles),
        cmocka_unit_test_setup_teardown(volumes_are_part_of_a_picture, files_setup, files_teardown),
        cmocka_unit_test(volumes_off_the_lattice_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
