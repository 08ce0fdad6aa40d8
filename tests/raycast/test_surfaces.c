/* SPDX-License-Identifier: MIT
 * Materials: the glossy lobe against quadrature, emission, masks, blends, sides, AOVs. */
#include "scenes.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double origin[3] = { 0, 0, 0 };

/* What a GGX lobe reflects of a uniform sky of radiance 1 towards cosine c, by quadrature over the hemisphere
 * of incoming light: D G2 / (4 c l) l, with Schlick's Fresnel term. */
static double lobe_reflectance(double c, double alpha, double f0)
{
    enum { STEPS = 2000 };
    const double vx = sqrt(1 - c * c), a2 = alpha * alpha;
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        for (int j = 0; j < STEPS; j++) {
            const double lz = (i + 0.5) / STEPS, phi = 2 * pi * (j + 0.5) / STEPS, ring = sqrt(1 - lz * lz);
            const double lx = ring * cos(phi), ly = ring * sin(phi);
            const double hx = lx + vx, hy = ly, hz = lz + c, h2 = hx * hx + hy * hy + hz * hz;
            const double nh2 = hz * hz / h2, d = nh2 * (a2 - 1) + 1;
            const double distribution = a2 / (pi * d * d);
            const double smith = c * sqrt(a2 + (1 - a2) * lz * lz) + lz * sqrt(a2 + (1 - a2) * c * c);
            const double fresnel = f0 + (1 - f0) * pow(1 - (hx * vx + hz * c) / sqrt(h2), 5);
            sum += fresnel * distribution * 0.5 / smith * lz;
        }
    }
    return sum * 2 * pi / STEPS / STEPS;
}

static struct raycast_view tilted_view(double cosine)
{
    const double sine = sqrt(1 - cosine * cosine);
    return view_make((double[]){ 2 * sine, 2 * cosine, 0 }, origin, 0.01f);
}

/* A level floor of metal under a sky of radiance 1. */
static struct gltf_material *metal_floor(struct built_scene *s, float albedo)
{
    sdfgi_scene_init(s);
    struct gltf_material *m = scene_add_material(s, albedo);
    m->metallic = 1;
    m->name = "metal"; /* nameless and rough it would be the default material */
    scene_add_floor(s, 0, 1000, true);
    return m;
}

/* Within 0.2 % by the table of the lobe's shares, and 0.2 % by noise. */
static void white_metal_reflects_all_light(void **state)
{
    (void)state;
    static const double cosines[] = { 1, 0.4, 0.05 };
    static const float roughnesses[] = { 0.05f, 0.4f, 1 };
    enum { COSINES = 3, COUNT = 3 * COSINES };
    struct built_scene s;
    struct gltf_material *m = metal_floor(&s, 1);
    for (int i = 0; i < COUNT; i++) {
        m->roughness = roughnesses[i / COSINES];
        struct raycast_view v = tilted_view(cosines[i % COSINES]);
        view_set_sky(&v, 1);
        assert_ratio(trace_mean(&s, &v, 16, 16, 4096, 0, RAYCAST_AOV_RADIANCE), 1, 0.004);
    }
    sdfgi_scene_finish(&s);
}

/* The lobe times its gain, which gives back the light that goes from facet to facet. */
static void grey_metal_reflects_what_its_lobe_says(void **state)
{
    (void)state;
    static const double cosines[] = { 0.9, 0.3 };
    static const float roughnesses[] = { 0.3f, 0.7f, 1 };
    const float f0 = 0.5f;
    struct built_scene s;
    struct gltf_material *m = metal_floor(&s, f0);
    for (int i = 0; i < 6; i++) {
        const double c = cosines[i % 2];
        m->roughness = roughnesses[i / 2];
        struct raycast_view v = tilted_view(c);
        view_set_sky(&v, 1);
        const double alpha = (double)m->roughness * m->roughness;
        const double gain = 1 + f0 * (1 / lobe_reflectance(c, alpha, 1) - 1);
        const double expected = gain * lobe_reflectance(c, alpha, f0);
        assert_ratio(trace_mean(&s, &v, 16, 16, 1024, 0, RAYCAST_AOV_RADIANCE), expected, 0.003);
        /* Measuring irradiance changes what is sampled, not what comes out. */
        assert_ratio(trace_mean(&s, &v, 16, 16, 1024, 0, RAYCAST_AOV_IRRADIANCE), pi, 0.005);
    }
    sdfgi_scene_finish(&s);
}

/* An almost perfect mirror shows an emitter at its own radiance, in the reflection. */
static void smooth_metal_mirrors(void **state)
{
    (void)state;
    struct built_scene s;
    sdfgi_scene_init(&s);
    struct gltf_material *m = scene_add_material(&s, 1);
    m->metallic = 1;
    m->roughness = 0;
    scene_add_floor(&s, 0, 5, true);
    m = scene_add_material(&s, 0);
    m->emissive[0] = m->emissive[1] = m->emissive[2] = 3;
    scene_add_floor(&s, 6, 100, false);
    const struct raycast_view v = tilted_view(0.6);
    assert_ratio(trace_mean(&s, &v, 8, 8, 64, 0, RAYCAST_AOV_REFLECTION), 3, 0.005);
    sdfgi_scene_finish(&s);
}

/* The interface takes 0.04 from the Lambertian part at normal incidence, and the sun's highlight adds F0 * D
 * * V times the lobe's gain: at the mirror angle with alpha 1, D is 1/pi, V is 1/4, and the share of uniform
 * light that perfect facets reflect is 1 - ln 2. */
static void dielectric_splits_light_between_its_parts(void **state)
{
    (void)state;
    struct built_scene s;
    sdfgi_scene_init(&s);
    scene_add_material(&s, 0.5f);
    scene_add_floor(&s, 0, 1000, true);
    struct raycast_view v = tilted_view(1);
    v.camera.up[1] = 0;
    v.camera.up[0] = 1;
    v.sun = (struct raycast_sun){ .direction = { 0, -1, 0 }, .irradiance = { 2, 2, 2 } };
    const double gain = 1 + 0.04 * (1 / (1 - log(2)) - 1);
    const double expected = 2 * (0.5 * 0.96 / pi + 0.04 * gain / (4 * pi));
    assert_ratio(trace_mean(&s, &v, 4, 4, 4, 0, RAYCAST_AOV_DIRECT), expected, 1e-3);
    sdfgi_scene_finish(&s);
}

static double lit_from_ceiling(bool front_down, bool double_sided)
{
    struct built_scene s;
    sdfgi_scene_init(&s);
    scene_add_material(&s, 0);
    scene_add_floor(&s, 0, 100, true);
    struct gltf_material *m = scene_add_material(&s, 0);
    m->emissive[0] = m->emissive[1] = m->emissive[2] = 2;
    m->double_sided = double_sided;
    scene_add_floor(&s, 1, 1, !front_down);
    const struct raycast_view v = view_make((double[]){ 3, 3, 3 }, origin, 40);
    const double e = gather_up(&s, &v, 0, 0, 0, 20000).indirect[0];
    sdfgi_scene_finish(&s);
    return e;
}

static void emission_leaves_the_front_unless_double_sided(void **state)
{
    (void)state;
    const double front = lit_from_ceiling(true, false);
    assert_true(front > 1);
    assert_true(lit_from_ceiling(false, false) == 0);
    assert_ratio(lit_from_ceiling(false, true), front, 0.01);
    assert_ratio(lit_from_ceiling(true, true), front, 0.01);
}

/* Two texels of four glow: far away that is half the light of a square that glows all over. */
static void textured_emission_keeps_its_mean(void **state)
{
    (void)state;
    static const uint8_t checker[16] = { 255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255 };
    double e[2];
    for (int textured = 0; textured < 2; textured++) {
        struct built_scene s;
        sdfgi_scene_init(&s);
        struct gltf_material *m = scene_add_material(&s, 0);
        m->emissive[0] = m->emissive[1] = m->emissive[2] = 500;
        if (textured)
            m->emissive_texture.texture = scene_add_texture(&s, 2, 2, checker);
        scene_add_floor(&s, 50, 1, false);
        const struct raycast_view v = view_make((double[]){ 3, 3, 3 }, origin, 40);
        e[textured] = gather_up(&s, &v, 0, 0, 0, 50000).indirect[0];
        sdfgi_scene_finish(&s);
    }
    assert_ratio(e[1], e[0] / 2, 0.01);
}

/* Share of a sun's light that a square of this material lets through. */
static double let_through(enum gltf_alpha_mode mode, float alpha, bool textured)
{
    static const uint8_t half_cut[8] = { 255, 255, 255, 255, 255, 255, 255, 0 };
    struct built_scene s;
    sdfgi_scene_init(&s);
    scene_add_material(&s, 0.5f);
    scene_add_floor(&s, 0, 1, true);
    struct gltf_material *m = scene_add_material(&s, 0);
    m->alpha_mode = mode;
    m->base_color[3] = alpha;
    if (textured)
        m->base_color_texture.texture = scene_add_texture(&s, 2, 1, half_cut);
    scene_add_floor(&s, 1, 1, true);
    struct raycast_view v = view_make((double[]){ 0, 0.5, 0 }, origin, 60);
    v.sun = (struct raycast_sun){ .direction = { 0, -1, 0 }, .irradiance = { 1, 1, 1 } };
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    const double open = 0.5 / pi;
    const double share = trace_mean(&s, &v, 32, 32, 64, 0, RAYCAST_AOV_DIRECT) / open;
    sdfgi_scene_finish(&s);
    return share;
}

static void masks_cut_and_blends_let_their_share_pass(void **state)
{
    (void)state;
    assert_true(let_through(GLTF_ALPHA_OPAQUE, 0.3f, true) == 0);
    assert_true(let_through(GLTF_ALPHA_MASK, 0.6f, false) == 0);
    assert_ratio(let_through(GLTF_ALPHA_MASK, 0.4f, false), 1, 1e-3);
    assert_ratio(let_through(GLTF_ALPHA_MASK, 1, true), 0.5, 0.005);
    assert_ratio(let_through(GLTF_ALPHA_BLEND, 0.25f, false), 0.75, 0.01);
}

static void backs_are_seen_unless_culled(void **state)
{
    (void)state;
    struct built_scene s;
    sdfgi_scene_init(&s);
    struct gltf_material *m = scene_add_material(&s, 0.5f);
    scene_add_floor(&s, 0, 10, false);
    struct raycast_view v = view_make((double[]){ 0, 2, 0 }, origin, 40);
    for (int culled = 0; culled < 2; culled++) {
        for (int double_sided = 0; double_sided < 2; double_sided++) {
            m->double_sided = double_sided != 0;
            struct raycast *rc = tracer_create(&s, &v,
                                               &(struct raycast_settings){ .width = 4,
                                                                           .height = 4,
                                                                           .aovs = 1u << RAYCAST_AOV_DEPTH,
                                                                           .cull_back_faces = culled != 0 });
            float depth[16];
            raycast_render(rc, &(struct raycast_budget){ .samples = 1 }, NULL, NULL, NULL);
            assert_true(raycast_image(rc, RAYCAST_AOV_DEPTH, depth));
            assert_float_equal(depth[5], culled && !double_sided ? 0 : 2, 1e-5);
            raycast_destroy(rc);
        }
    }
    sdfgi_scene_finish(&s);
}

/* Every kind of light and both kinds of material in one room. */
static void rich_scene(struct built_scene *s, struct raycast_view *v, struct raycast_light *light)
{
    sdfgi_scene_init(s);
    struct gltf_material *m = scene_add_material(s, 0.7f);
    m->roughness = 0.4f;
    m->metallic = 0.5f;
    scene_add_floor(s, 0, 2, true);
    m = scene_add_material(s, 0.2f);
    m->emissive[0] = m->emissive[1] = m->emissive[2] = 4;
    scene_add_floor(s, 2, 0.5f, false);
    *v = view_make((double[]){ 2, 1.5, 2 }, (double[]){ 0, 0.5, 0 }, 60);
    view_set_sky(v, 0.5f);
    v->sun = (struct raycast_sun){ .direction = { 1, -2, 0 }, .irradiance = { 2, 2, 2 }, .angle_deg = 5 };
    *light = (struct raycast_light){ .position = { 1, 1, 0 }, .intensity = { 1, 1, 1 } };
    v->lights = light;
    v->light_count = 1;
}

static void parts_add_up_to_the_picture(void **state)
{
    (void)state;
    enum { VALUES = 16 * 16 * 3 };
    struct built_scene s;
    struct raycast_view v;
    struct raycast_light light;
    rich_scene(&s, &v, &light);
    struct raycast *rc = tracer_create(
        &s, &v,
        &(struct raycast_settings){ .width = 16, .height = 16, .aovs = (1u << RAYCAST_AOV_COUNT) - 1 });
    raycast_render(rc, &(struct raycast_budget){ .samples = 16 }, NULL, NULL, NULL);
    float radiance[VALUES], part[VALUES], sum[VALUES] = { 0 };
    assert_true(raycast_image(rc, RAYCAST_AOV_RADIANCE, radiance));
    for (int aov = RAYCAST_AOV_EMISSION; aov <= RAYCAST_AOV_REFLECTION; aov++) {
        double total = 0;
        assert_true(raycast_image(rc, aov, part));
        for (int i = 0; i < VALUES; i++) {
            sum[i] += part[i];
            total += part[i];
        }
        assert_true(total > 0);
    }
    for (int i = 0; i < VALUES; i++)
        assert_float_equal(sum[i], radiance[i], 1e-5 * (1 + radiance[i]));
    raycast_destroy(rc);
    sdfgi_scene_finish(&s);
}

static void plain_materials_follow_the_view(void **state)
{
    (void)state;
    struct built_scene s;
    sdfgi_scene_init(&s);
    struct gltf_material *m = scene_add_material(&s, 1);
    m->metallic = 1; /* glTF's default material, as the importer appends it */
    scene_add_floor(&s, 0, 100, true);
    struct raycast_view v = view_make((double[]){ 0, 2, 0 }, origin, 40);
    v.default_albedo[0] = v.default_albedo[1] = v.default_albedo[2] = 0.3f;
    assert_ratio(trace_mean(&s, &v, 4, 4, 1, 0, RAYCAST_AOV_ALBEDO), 0.3, 1e-5);
    m->name = "named";
    assert_true(trace_mean(&s, &v, 4, 4, 1, 0, RAYCAST_AOV_ALBEDO) == 0);
    m->unlit = true;
    assert_ratio(trace_mean(&s, &v, 4, 4, 1, 0, RAYCAST_AOV_RADIANCE), 1, 1e-5);
    sdfgi_scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_metal_reflects_all_light),
        cmocka_unit_test(grey_metal_reflects_what_its_lobe_says),
        cmocka_unit_test(smooth_metal_mirrors),
        cmocka_unit_test(dielectric_splits_light_between_its_parts),
        cmocka_unit_test(emission_leaves_the_front_unless_double_sided),
        cmocka_unit_test(textured_emission_keeps_its_mean),
        cmocka_unit_test(masks_cut_and_blends_let_their_share_pass),
        cmocka_unit_test(backs_are_seen_unless_culled),
        cmocka_unit_test(parts_add_up_to_the_picture),
        cmocka_unit_test(plain_materials_follow_the_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
