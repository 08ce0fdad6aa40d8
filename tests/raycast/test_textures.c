/* SPDX-License-Identifier: MIT
 * Textures, vertex colours, normal maps and mirrored transforms, read back through the albedo and normal
 * AOVs. */
#include "scenes.h"

#include <math.h>
#include <stdlib.h>

/* Four levels of grey in a row; 188 is 0.5029 in linear light. */
static const uint8_t greys[16] = { 0, 0, 0, 255, 188, 188, 188, 255, 255, 255, 255, 255, 255, 255, 255, 255 };
static const double grey = 0.50289;

/* An AOV at a point of the texture space of a level square, seen from straight above. */
static void look_at_uv(const struct built_scene *s, double u, double v, enum raycast_aov aov, float out[3])
{
    const double x = 2 * u - 1, z = 1 - 2 * v;
    struct raycast_view view = view_make((double[]){ x, 1, z }, (double[]){ x, 0, z }, 0.001f);
    view.materials = RAYCAST_MATERIALS_LAMBERT;
    struct raycast *rc =
        tracer_create(s, &view, &(struct raycast_settings){ .width = 1, .height = 1, .aovs = 1u << aov });
    raycast_render(rc, &(struct raycast_budget){ .samples = 1 }, NULL, NULL, NULL);
    assert_true(raycast_image(rc, aov, out));
    raycast_destroy(rc);
}

static void assert_albedo(const struct built_scene *s, double u, double v, double expected)
{
    float albedo[3];
    look_at_uv(s, u, v, RAYCAST_AOV_ALBEDO, albedo);
    assert_float_equal(albedo[0], expected, 2e-4);
    assert_float_equal(albedo[2], expected, 2e-4);
}

static struct gltf_material *textured_floor(struct built_scene *s, enum gltf_filter filter,
                                            enum gltf_wrap wrap)
{
    sdfgi_scene_init(s);
    struct gltf_material *m = scene_add_material(s, 1);
    m->base_color_texture.texture = scene_add_texture(s, 4, 1, greys);
    s->textures[0].mag_filter = filter;
    s->textures[0].wrap_u = s->textures[0].wrap_v = wrap;
    scene_add_floor(s, 0, 1, true);
    return m;
}

static void texels_are_decoded_then_filtered(void **state)
{
    (void)state;
    struct built_scene s;
    textured_floor(&s, GLTF_FILTER_NEAREST, GLTF_WRAP_REPEAT);
    assert_albedo(&s, 0.10, 0.3, 0);
    assert_albedo(&s, 0.26, 0.3, grey);
    assert_albedo(&s, 0.60, 0.3, 1);
    sdfgi_scene_finish(&s);
    textured_floor(&s, GLTF_FILTER_LINEAR, GLTF_WRAP_REPEAT);
    assert_albedo(&s, 0.375, 0.3, grey);
    assert_albedo(&s, 0.25, 0.3, grey / 2);
    assert_albedo(&s, 0.50, 0.3, (grey + 1) / 2);
    sdfgi_scene_finish(&s);
}

/* Beyond the edge: texel 0 is black, texel 3 white. The transform moves u by `shift`. */
static double albedo_beyond(enum gltf_wrap wrap, float shift)
{
    struct built_scene s;
    struct gltf_material *m = textured_floor(&s, GLTF_FILTER_NEAREST, wrap);
    m->base_color_texture.uv_transform[2] = shift;
    float albedo[3];
    look_at_uv(&s, 0.1, 0.3, RAYCAST_AOV_ALBEDO, albedo);
    sdfgi_scene_finish(&s);
    return albedo[0];
}

static void wraps_do_what_they_say(void **state)
{
    (void)state;
    assert_float_equal(albedo_beyond(GLTF_WRAP_REPEAT, 1), 0, 1e-6);
    assert_float_equal(albedo_beyond(GLTF_WRAP_MIRROR, 1), 1, 1e-6);
    assert_float_equal(albedo_beyond(GLTF_WRAP_CLAMP, 1), 1, 1e-6);
    assert_float_equal(albedo_beyond(GLTF_WRAP_REPEAT, -0.3f), 1, 1e-6); /* -0.2 is 0.8 */
    assert_float_equal(albedo_beyond(GLTF_WRAP_MIRROR, -0.2f), 0, 1e-6); /* -0.1 is 0.1 */
    assert_float_equal(albedo_beyond(GLTF_WRAP_CLAMP, -7), 0, 1e-6);
}

static void uv_transforms_turn(void **state)
{
    (void)state;
    struct built_scene s;
    struct gltf_material *m = textured_floor(&s, GLTF_FILTER_NEAREST, GLTF_WRAP_REPEAT);
    const float swapped[6] = { 0, 1, 0, 1, 0, 0 };
    for (int k = 0; k < 6; k++)
        m->base_color_texture.uv_transform[k] = swapped[k];
    assert_albedo(&s, 0.9, 0.1, 0);
    assert_albedo(&s, 0.1, 0.9, 1);
    sdfgi_scene_finish(&s);
}

static void vertex_colours_multiply(void **state)
{
    (void)state;
    static float colors[16] = { 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 1 };
    struct built_scene s;
    sdfgi_scene_init(&s);
    scene_add_material(&s, 0.5f);
    scene_add_floor(&s, 0, 1, true);
    s.primitives[0].colors = colors;
    assert_albedo(&s, 0.3, 0.6, 0.15);
    sdfgi_scene_finish(&s);
}

/* A map that tilts by atan(0.5) along +u: `mirrored` turns the square over along x, which turns u with it. */
static void tilted_normal(bool mirrored, bool flipped, float out[3])
{
    static const uint8_t tilt[4] = { 184, 128, 242, 255 }; /* (0.443, 0.004, 0.898) */
    struct built_scene s;
    sdfgi_scene_init(&s);
    struct gltf_material *m = scene_add_material(&s, 0.5f);
    m->normal_texture.texture = scene_add_texture(&s, 1, 1, tilt);
    scene_add_floor(&s, 0, 1, !flipped);
    if (mirrored)
        s.instances[0].transform[0] = -1;
    look_at_uv(&s, 0.4, 0.4, RAYCAST_AOV_NORMAL, out);
    sdfgi_scene_finish(&s);
}

static void normal_maps_tilt_along_u(void **state)
{
    (void)state;
    float n[3];
    tilted_normal(false, false, n);
    assert_float_equal(n[0], 0.443, 0.01);
    assert_float_equal(n[1], 0.898, 0.01);
    assert_float_equal(n[2], 0, 0.01);
    tilted_normal(true, false, n);
    assert_float_equal(n[0], -0.443, 0.01);
    assert_float_equal(n[1], 0.898, 0.01);
    /* From behind, the whole normal turns round: the tilt with it. */
    tilted_normal(false, true, n);
    assert_float_equal(n[0], -0.443, 0.01);
    assert_float_equal(n[1], 0.898, 0.01);
}

/* Mirroring keeps fronts in front: a lamp over the mirrored square shines down on its front only. */
static void mirrored_emitters_keep_their_front(void **state)
{
    (void)state;
    for (int up = 0; up < 2; up++) {
        struct built_scene s;
        sdfgi_scene_init(&s);
        struct gltf_material *m = scene_add_material(&s, 0);
        m->emissive[0] = m->emissive[1] = m->emissive[2] = 1;
        scene_add_floor(&s, 1, 1, up != 0);
        s.instances[0].transform[0] = -1;
        const struct raycast_view v = view_make((double[]){ 3, 3, 3 }, (double[]){ 0, 0, 0 }, 40);
        const float e = gather_up(&s, &v, 0, 0, 0, 500).indirect[0];
        assert_true(up ? e == 0 : e > 0.5f);
        sdfgi_scene_finish(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_decoded_then_filtered),
        cmocka_unit_test(wraps_do_what_they_say),
        cmocka_unit_test(uv_transforms_turn),
        cmocka_unit_test(vertex_colours_multiply),
        cmocka_unit_test(normal_maps_tilt_along_u),
        cmocka_unit_test(mirrored_emitters_keep_their_front),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
