/* SPDX-License-Identifier: MIT
 *
 * Vertices that joints and morph targets move, and animations at a time. The numbers follow from glTF 2.0,
 * 3.7.2.2, 3.7.3.3, 3.11 and appendix C.
 */
#include "scene_files.h"

#include <math.h>
#include <string.h>

static const float triangle[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
static const float up[9] = { 0, 0, 1, 0, 0, 1, 0, 0, 1 };

static struct gltf_scene *pose_load(const struct draft *d, const char *rest, double time_s)
{
    char error[512];
    draft_write(d, rest, "pose.glb");
    struct gltf_scene *const s =
        gltf_scene_load_posed(files_path("pose.glb"), &(struct gltf_pose){ time_s }, error, sizeof error);
    if (s == NULL)
        fail_msg("%s", error);
    scene_check(s);
    return s;
}

/* Where an instance has a vertex. */
static void world_get(const struct gltf_scene *s, uint32_t instance, uint32_t vertex, double out[3])
{
    const struct gltf_instance *const i = &s->instances[instance];
    const float *const p = s->primitives[i->primitive].positions + 3 * vertex;
    for (int row = 0; row < 3; row++)
        out[row] = i->transform[row] * (double)p[0] + i->transform[4 + row] * (double)p[1] +
                   i->transform[8 + row] * (double)p[2] + i->transform[12 + row];
}

static void vertex_expect(const struct gltf_scene *s, uint32_t instance, uint32_t vertex, const double *want)
{
    double got[3];
    world_get(s, instance, vertex, got);
    for (int k = 0; k < 3; k++)
        if (!(fabs(got[k] - want[k]) < 1e-5))
            fail_msg("vertex %u is at %g %g %g, not at %g %g %g", vertex, got[0], got[1], got[2], want[0],
                     want[1], want[2]);
}

#define VERTEX(s, vertex, ...) vertex_expect(s, 0, vertex, (const double[]){ __VA_ARGS__ })

/* ---- Skins ------------------------------------------------------------------------------------------- */

/* Accessors: 0 positions, 1 normals, 2 joints, 3 weights, 4 inverse bind matrices. The first vertex follows
 * joint 0, the second joint 1, the third both by halves; its weights add up to 2. */
static void skin_draft(struct draft *d)
{
    static const uint8_t joints[12] = { 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0 };
    static const float weights[12] = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0 };
    static const float bind[32] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1 };
    draft_floats(d, "VEC3", 3, triangle);
    draft_floats(d, "VEC3", 3, up);
    draft_accessor(d, &(struct elements){ joints, sizeof joints, COMPONENT_UBYTE, "VEC4", 3, NULL });
    draft_floats(d, "VEC4", 3, weights);
    draft_accessor(d, &(struct elements){ bind, sizeof bind, COMPONENT_FLOAT, "MAT4", 2, NULL });
}

#define SKINNED_MESH                                                                                         \
    ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"JOINTS_0\":2,"             \
    "\"WEIGHTS_0\":3}}]}]"
#define SKIN ",\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":4}]"

static void joints_move_their_vertices_and_the_node_does_not(void **state)
{
    (void)state;
    struct draft d = { 0 };
    skin_draft(&d);
    struct gltf_scene *const s = draft_load(
        &d, SKINNED_MESH SKIN ",\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[50,0,0]},"
                              "{\"translation\":[1e7,0,0],\"children\":[2]},{\"translation\":[1,5,0]}]");
    /* Joint 0 adds 1e7; joint 1 adds 1e7 + 1 - 1 and 5 of height. */
    VERTEX(s, 0, 1e7, 0, 0);
    VERTEX(s, 1, 1e7 + 1, 5, 0);
    VERTEX(s, 2, 1e7, 1 + 2.5, 0);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

/* Joint 0 stretches along Y, which flattens slopes; joint 1 turns a quarter around X. */
static void normals_turn_with_their_joint(void **state)
{
    (void)state;
    static const float slopes[9] = { 0, 0.6f, 0.8f, 0, 0, 1, 0, 0, 1 };
    struct draft d = { 0 };
    skin_draft(&d);
    memcpy(d.binary + sizeof triangle, slopes, sizeof slopes);
    struct gltf_scene *const s =
        draft_load(&d, SKINNED_MESH SKIN ",\"nodes\":[{\"mesh\":0,\"skin\":0},{\"scale\":[1,2,1]},"
                                         "{\"rotation\":[0.70710678,0,0,0.70710678]}]");
    const float *const n = s->primitives[s->instances[0].primitive].normals;
    const double length = sqrt(0.3 * 0.3 + 0.8 * 0.8);
    assert_true(fabs((double)n[1] - 0.3 / length) < 1e-6 && fabs((double)n[2] - 0.8 / length) < 1e-6);
    assert_true(fabsf(n[4] + 1) < 1e-6f && fabsf(n[5]) < 1e-6f); /* +Z becomes -Y */
    gltf_scene_destroy(s);
}

static void mirrored_joints_keep_the_front_in_front(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct draft d = { 0 };
        char rest[1024];
        skin_draft(&d);
        snprintf(rest, sizeof rest,
                 SKINNED_MESH SKIN
                 ",\"nodes\":[{\"mesh\":0,\"skin\":0},{\"scale\":[%d,1,1],\"children\":[2]},"
                 "{\"translation\":[1,0,0]}]",
                 mirrored ? -1 : 1);
        struct gltf_scene *const s = draft_load(&d, rest);
        const uint32_t *const i = s->primitives[s->instances[0].primitive].indices;
        assert_int_equal(i[1], mirrored ? 2 : 1);
        assert_int_equal(i[2], mirrored ? 1 : 2);
        gltf_scene_destroy(s);
    }
}

/* Two nodes with skins of their own, and one without: a primitive each. */
static void nodes_that_share_a_mesh_have_poses_of_their_own(void **state)
{
    (void)state;
    struct draft d = { 0 };
    skin_draft(&d);
    struct gltf_scene *const s =
        draft_load(&d, SKINNED_MESH
                   ",\"skins\":[{\"joints\":[3,3]},{\"joints\":[4,4]}],\"nodes\":[{\"mesh\":0,\"skin\":0},"
                   "{\"mesh\":0,\"skin\":1},{\"mesh\":0,\"translation\":[0,0,7]},"
                   "{\"translation\":[0,3,0],\"scale\":[2,1,1]},{\"translation\":[0,0,9]}]");
    assert_int_equal(s->instance_count, 3);
    vertex_expect(s, 0, 1, (const double[]){ 2, 3, 0 });
    vertex_expect(s, 1, 1, (const double[]){ 1, 0, 9 });
    vertex_expect(s, 2, 1, (const double[]){ 1, 0, 7 });
    gltf_scene_destroy(s);
}

/* ---- Morph targets ----------------------------------------------------------------------------------- */

#define MORPHED_MESH(members)                                                                                \
    ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1},"          \
    "{\"POSITION\":2}]}]" members "}]"

static void morph_draft(struct draft *d)
{
    draft_floats(d, "VEC3", 3, triangle);
    draft_floats(d, "VEC3", 3, (const float[]){ 0, 0, 1, 0, 0, 0, 0, 0, 0 });
    draft_floats(d, "VEC3", 3, (const float[]){ 0, 0, 0, 4, 0, 0, 0, 0, 0 });
}

static void weights_come_from_the_node_or_else_from_the_mesh(void **state)
{
    (void)state;
    struct draft d = { 0 };
    morph_draft(&d);
    struct gltf_scene *s = draft_load(&d, MORPHED_MESH("") ",\"nodes\":[{\"mesh\":0}]");
    VERTEX(s, 0, 0, 0, 0);
    gltf_scene_destroy(s);
    s = draft_load(&d, MORPHED_MESH(",\"weights\":[0.5,0.25]") ",\"nodes\":[{\"mesh\":0}]");
    VERTEX(s, 0, 0, 0, 0.5);
    VERTEX(s, 1, 2, 0, 0);
    gltf_scene_destroy(s);
    s = draft_load(&d, MORPHED_MESH(",\"weights\":[0.5,0.25]") ",\"nodes\":[{\"mesh\":0,\"weights\":[2,0]}]");
    VERTEX(s, 0, 0, 0, 2);
    VERTEX(s, 1, 1, 0, 0);
    /* Flat normals are those of the moved triangle: its corner at the origin is two metres up. */
    const float *const n = s->primitives[0].normals;
    assert_true(fabsf(n[0] - 2.0f / 3) < 1e-6f && fabsf(n[1] - 2.0f / 3) < 1e-6f);
    gltf_scene_destroy(s);
}

/* ---- Animations -------------------------------------------------------------------------------------- */

/* Accessors: 0 positions, 1 times 1 and 3, 2 two translations, 3 those with tangents, 4 two rotations, a half
 * turn around Z apart, 5 four weights, 6 times that fall. */
static void animation_draft(struct draft *d)
{
    draft_floats(d, "VEC3", 3, triangle);
    draft_floats(d, "SCALAR", 2, (const float[]){ 1, 3 });
    draft_floats(d, "VEC3", 2, (const float[]){ 0, 0, 0, 8, 0, 0 });
    draft_floats(d, "VEC3", 6, (const float[]){ 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0 });
    draft_floats(d, "VEC4", 2, (const float[]){ 0, 0, 0, 1, 0, 0, 1, 0 });
    draft_floats(d, "SCALAR", 4, (const float[]){ 0, 0, 1, 2 });
    draft_floats(d, "SCALAR", 2, (const float[]){ 3, 1 });
}

#define SAMPLER(input, output, more) "{\"input\":" #input ",\"output\":" #output more "}"
#define CHANNEL(sampler, node, path)                                                                         \
    "{\"sampler\":" #sampler ",\"target\":{\"node\":" #node ",\"path\":\"" path "\"}}"
#define ANIMATION(samplers, channels) "{\"samplers\":[" samplers "],\"channels\":[" channels "]}"
#define PLAIN_MESH                                                                                           \
    ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":0},"          \
    "{\"POSITION\":0}]}]}],\"nodes\":[{\"mesh\":0},{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]"

static void keyframes_are_sampled_as_their_interpolation_says(void **state)
{
    (void)state;
    static const struct {
        const char *animation;
        double time_s, want[3]; /* of the vertex at (1, 0, 0) */
    } rows[] = {
        { ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "translation")), 0, { 1, 0, 0 } },
        { ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "translation")), 1.5, { 3, 0, 0 } },
        { ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "translation")), 3, { 9, 0, 0 } },
        { ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "translation")), 99, { 9, 0, 0 } },
        { ANIMATION(SAMPLER(1, 2, ",\"interpolation\":\"STEP\""), CHANNEL(0, 0, "translation")),
          2.9,
          { 1, 0, 0 } },
        /* Hermite: halfway, the mean of the values, and an eighth of the tangent times two seconds. */
        { ANIMATION(SAMPLER(1, 3, ",\"interpolation\":\"CUBICSPLINE\""), CHANNEL(0, 0, "translation")),
          2,
          { 1 + 4, 0.125 * 2 * 4, 0 } },
        { ANIMATION(SAMPLER(1, 3, ",\"interpolation\":\"CUBICSPLINE\""), CHANNEL(0, 0, "translation")),
          3,
          { 9, 0, 0 } },
        /* A third of a half turn. */
        { ANIMATION(SAMPLER(1, 4, ""), CHANNEL(0, 0, "rotation")), 1 + 2.0 / 3, { 0.5, 0.86602540378, 0 } },
        { ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "scale")), 2, { 4, 0, 0 } },
        /* Weights of half of 1 and half of 2, of targets that double the position. */
        { ANIMATION(SAMPLER(1, 5, ""), CHANNEL(0, 0, "weights")), 2, { 1 + 0.5 + 1, 0, 0 } },
        { ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "pointer")), 2, { 1, 0, 0 } },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct draft d = { 0 };
        char rest[1024];
        animation_draft(&d);
        snprintf(rest, sizeof rest, PLAIN_MESH ",\"animations\":[%s]", rows[i].animation);
        struct gltf_scene *const s = pose_load(&d, rest, rows[i].time_s);
        vertex_expect(s, 0, 1, rows[i].want);
        gltf_scene_destroy(s);
    }
}

static void animations_play_together_and_the_first_wins(void **state)
{
    (void)state;
    struct draft d = { 0 };
    animation_draft(&d);
    struct gltf_scene *const s = pose_load(
        &d,
        PLAIN_MESH
        ",\"animations\":[" ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 0, "translation")) "," ANIMATION(
            SAMPLER(1, 3, ",\"interpolation\":\"CUBICSPLINE\""),
            CHANNEL(0, 0, "translation")) "," ANIMATION(SAMPLER(1, 4, ""), CHANNEL(0, 0, "rotation")) "]",
        2);
    VERTEX(s, 1, 4, 1, 0); /* of the second there would be one metre more of height */
    gltf_scene_destroy(s);
}

/* ---- What is refused --------------------------------------------------------------------------------- */

struct bad {
    const char *rest, *wrong;
};

static void refused_expect(const struct draft *d, const struct bad *row)
{
    char error[512];
    draft_write(d, row->rest, "pose.glb");
    struct gltf_scene *const s =
        gltf_scene_load_posed(files_path("pose.glb"), &(struct gltf_pose){ 2 }, error, sizeof error);
    if (s != NULL || strstr(error, row->wrong) == NULL || strchr(error, '\n') != NULL)
        fail_msg("the message is '%s'; it should hold '%s'", s == NULL ? error : "(loaded)", row->wrong);
}

#define BAD_ANIMATION(...) PLAIN_MESH ",\"animations\":[" ANIMATION(__VA_ARGS__) "]"

static void bad_animations_are_refused_where_they_are_played(void **state)
{
    (void)state;
    static const struct bad rows[] = {
        { BAD_ANIMATION(SAMPLER(6, 2, ""), CHANNEL(0, 0, "translation")),
          "animations[0].channels[0]: the time of keyframe 1 does not come after" },
        { BAD_ANIMATION(SAMPLER(1, 3, ""), CHANNEL(0, 0, "translation")), "2 keyframes, and 18 numbers" },
        { BAD_ANIMATION(SAMPLER(1, 2, ",\"interpolation\":\"BOUNCE\""), CHANNEL(0, 0, "translation")),
          "'BOUNCE' is unknown" },
        { BAD_ANIMATION(SAMPLER(1, 4, ""), CHANNEL(0, 0, "translation")), "4 components, expected 3" },
        { BAD_ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 1, "translation")),
          "matrix, which cannot be animated" },
        { BAD_ANIMATION(SAMPLER(1, 2, ""), CHANNEL(0, 7, "translation")), "node 7 is out of range" },
        { BAD_ANIMATION(SAMPLER(77, 2, ""), CHANNEL(0, 0, "translation")), "accessor 77" },
    };
    struct draft d = { 0 };
    animation_draft(&d);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        refused_expect(&d, &rows[i]);
        gltf_scene_destroy(draft_load(&d, rows[i].rest)); /* at rest they are of no account */
    }
    static const struct bad always[] = {
        { BAD_ANIMATION(SAMPLER(1, 2, ""), CHANNEL(5, 0, "translation")), "sampler 5 is out of range" },
        { PLAIN_MESH ",\"animations\":[{\"channels\":[]}]", "animations[0].samplers is missing" },
        { PLAIN_MESH ",\"skins\":[{}]", "skins[0].joints is missing" },
    };
    for (size_t i = 0; i < sizeof always / sizeof *always; i++)
        refused_expect(&d, &always[i]);
}

static void bad_skins_are_refused(void **state)
{
    (void)state;
#define BAD_SKIN(skins) SKINNED_MESH ",\"skins\":[{" skins "}],\"nodes\":[{\"mesh\":0,\"skin\":0},{},{}]"
    static const struct bad rows[] = {
        { BAD_SKIN("\"joints\":[1]"), "vertex 1 has joint 1, and the skin has 1" },
        { BAD_SKIN("\"joints\":[]"), "skins[0] has no joints" },
        { BAD_SKIN("\"joints\":[1,9]"), "joint 9 is out of range" },
        { BAD_SKIN("\"joints\":[1,2,1],\"inverseBindMatrices\":4"), "2 matrices for 3 joints" },
        { BAD_SKIN("\"joints\":[1,2],\"inverseBindMatrices\":3"), "4 x 4 matrices" },
        { SKINNED_MESH SKIN ",\"nodes\":[{\"mesh\":0,\"skin\":3},{},{}]", "skin 3 is out of range" },
        { ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2}}]}]" SKIN
          ",\"nodes\":[{\"mesh\":0,\"skin\":0},{},{}]",
          "has JOINTS_0 and no WEIGHTS_0" },
    };
    struct draft d = { 0 };
    skin_draft(&d);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        refused_expect(&d, &rows[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_move_their_vertices_and_the_node_does_not),
        cmocka_unit_test(normals_turn_with_their_joint),
        cmocka_unit_test(mirrored_joints_keep_the_front_in_front),
        cmocka_unit_test(nodes_that_share_a_mesh_have_poses_of_their_own),
        cmocka_unit_test(weights_come_from_the_node_or_else_from_the_mesh),
        cmocka_unit_test(keyframes_are_sampled_as_their_interpolation_says),
        cmocka_unit_test(animations_play_together_and_the_first_wins),
        cmocka_unit_test(bad_animations_are_refused_where_they_are_played),
        cmocka_unit_test(bad_skins_are_refused),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
