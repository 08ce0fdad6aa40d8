/* SPDX-License-Identifier: MIT
 *
 * Vertices and triangles: what accessors can hold, and what is made where a file has nothing.
 */
#include "scene_files.h"

#include <math.h>
#include <string.h>

/* A unit square in the XY plane, seen from +Z, counter-clockwise from the lower left. */
static const float square[12] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 };
static const float square_normals[12] = { 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1 };
static const float square_uv[8] = { 0, 1, 1, 1, 1, 0, 0, 0 }; /* V falls, as glTF has it */
static const uint16_t square_indices[6] = { 0, 1, 2, 0, 2, 3 };

static int indices_add(struct draft *d, const void *data, size_t size, enum component component, int count)
{
    return draft_accessor(d, &(struct elements){ data, size, component, "SCALAR", count, NULL });
}

/* One mesh with one primitive, drawn by one node. */
static struct gltf_scene *primitive_load(const struct draft *d, const char *primitive)
{
    char rest[1024];
    snprintf(rest, sizeof rest, ",\"meshes\":[{\"primitives\":[{%s}]}],\"nodes\":[{\"mesh\":0}]", primitive);
    return draft_load(d, rest);
}

/* The square with normals and uv, and one more attribute or member of the primitive. */
static struct gltf_scene *square_load(struct draft *d, const char *more)
{
    char primitive[512];
    const int positions = draft_floats(d, "VEC3", 4, square);
    const int normals = draft_floats(d, "VEC3", 4, square_normals);
    const int indices = indices_add(d, square_indices, sizeof square_indices, COMPONENT_USHORT, 6);
    snprintf(primitive, sizeof primitive, "\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d%s},\"indices\":%d",
             positions, normals, more, indices);
    return primitive_load(d, primitive);
}

static void floats_expect(const float *got, const float *want, size_t count, double tolerance)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs((double)got[i] - (double)want[i]) <= tolerance))
            fail_msg("value %zu is %.9g, not %.9g", i, (double)got[i], (double)want[i]);
}

static void indices_expect(const struct gltf_primitive *p, const uint32_t *want, uint32_t count)
{
    assert_int_equal(p->index_count, count);
    assert_memory_equal(p->indices, want, count * sizeof *want);
}

static void every_index_type_gives_the_same_triangles(void **state)
{
    (void)state;
    static const uint8_t narrow[6] = { 0, 1, 2, 0, 2, 3 };
    static const uint32_t wide[6] = { 0, 1, 2, 0, 2, 3 };
    const struct elements types[] = {
        { narrow, sizeof narrow, COMPONENT_UBYTE, "SCALAR", 6, NULL },
        { square_indices, sizeof square_indices, COMPONENT_USHORT, "SCALAR", 6, NULL },
        { wide, sizeof wide, COMPONENT_UINT, "SCALAR", 6, NULL },
    };
    for (size_t i = 0; i < 3; i++) {
        struct draft d = { 0 };
        draft_floats(&d, "VEC3", 4, square);
        draft_floats(&d, "VEC3", 4, square_normals);
        draft_accessor(&d, &types[i]);
        struct gltf_scene *const s =
            primitive_load(&d, "\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2");
        indices_expect(&s->primitives[0], wide, 6);
        assert_int_equal(s->primitives[0].vertex_count, 4);
        gltf_scene_destroy(s);
    }
}

static void without_indices_vertices_are_drawn_in_turn(void **state)
{
    (void)state;
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 3, square);
    draft_floats(&d, "VEC3", 3, square_normals);
    struct gltf_scene *const s = primitive_load(&d, "\"attributes\":{\"POSITION\":0,\"NORMAL\":1}");
    indices_expect(&s->primitives[0], (const uint32_t[]){ 0, 1, 2 }, 3);
    gltf_scene_destroy(s);
}

static void strips_and_fans_keep_their_front_faces(void **state)
{
    (void)state;
    static const struct {
        int mode;
        uint8_t order[6];
        int count;
        uint32_t want[12];
        uint32_t want_count;
    } rows[] = {
        { 5, { 0, 1, 3, 2 }, 4, { 0, 1, 3, 1, 2, 3 }, 6 },
        { 6, { 0, 1, 2, 3 }, 4, { 0, 1, 2, 0, 2, 3 }, 6 },
        { 5, { 0, 1, 3, 3, 2 }, 5, { 0, 1, 3 }, 3 }, /* joined by degenerate triangles */
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct draft d = { 0 };
        char primitive[128];
        draft_floats(&d, "VEC3", 4, square);
        draft_floats(&d, "VEC3", 4, square_normals);
        indices_add(&d, rows[i].order, (size_t)rows[i].count, COMPONENT_UBYTE, rows[i].count);
        snprintf(primitive, sizeof primitive,
                 "\"mode\":%d,\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2", rows[i].mode);
        struct gltf_scene *const s = primitive_load(&d, primitive);
        indices_expect(&s->primitives[0], rows[i].want, rows[i].want_count);
        gltf_scene_destroy(s);
    }
}

static void sparse_accessors_replace_elements(void **state)
{
    (void)state;
    static const uint8_t which[2] = { 1, 2 };
    static const float values[6] = { 5, 0, 0, 5, 5, 0 };
    for (int with_base = 0; with_base < 2; with_base++) {
        struct draft d = { 0 };
        char sparse[256];
        const int index_view = draft_view(&d, which, sizeof which);
        const int value_view = draft_view(&d, values, sizeof values);
        snprintf(sparse, sizeof sparse,
                 ",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":%d,\"componentType\":5121},"
                 "\"values\":{\"bufferView\":%d}}",
                 index_view, value_view);
        draft_accessor(&d, &(struct elements){ with_base ? square : NULL, 9 * sizeof *square, COMPONENT_FLOAT,
                                               "VEC3", 3, sparse });
        struct gltf_scene *const s = primitive_load(&d, "\"attributes\":{\"POSITION\":0}");
        floats_expect(s->primitives[0].positions, (const float[]){ 0, 0, 0, 5, 0, 0, 5, 5, 0 }, 9, 0);
        gltf_scene_destroy(s);
    }
}

static void interleaved_vertices_are_read_with_their_stride(void **state)
{
    (void)state;
    struct draft d = { 0 };
    const float interleaved[18] = { 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1 };
    draft_view(&d, interleaved, sizeof interleaved);
    char *const end = strrchr(d.views, '}');
    snprintf(end, 32, ",\"byteStride\":24}");
    draft_accessor(&d, &(struct elements){ NULL, 0, COMPONENT_FLOAT, "VEC3", 3, ",\"bufferView\":0" });
    draft_accessor(
        &d, &(struct elements){ NULL, 0, COMPONENT_FLOAT, "VEC3", 3, ",\"bufferView\":0,\"byteOffset\":12" });
    struct gltf_scene *const s = primitive_load(&d, "\"attributes\":{\"POSITION\":0,\"NORMAL\":1}");
    floats_expect(s->primitives[0].positions, square, 9, 0);
    floats_expect(s->primitives[0].normals, square_normals, 9, 0);
    gltf_scene_destroy(s);
}

static void colors_of_every_type_are_linear_rgba(void **state)
{
    (void)state;
    static const uint8_t unorm8[12] = { 255, 0, 51, 255, 0, 51, 255, 0, 51, 255, 0, 51 };
    static const uint8_t unorm8_rows[16] = { 255, 0, 51, 0, 255, 0, 51, 0, 255, 0, 51, 0, 255, 0, 51, 0 };
    static const uint16_t unorm16[16] = { 65535, 0, 13107, 0, 65535, 0, 13107, 0,
                                          65535, 0, 13107, 0, 65535, 0, 13107, 0 };
    static const float real[12] = { 1, 0, 0.2f, 1, 0, 0.2f, 1, 0, 0.2f, 1, 0, 0.2f };
    const struct elements rows[] = {
        { unorm8_rows, sizeof unorm8_rows, COMPONENT_UBYTE, "VEC4", 4, ",\"normalized\":true" },
        { unorm16, sizeof unorm16, COMPONENT_USHORT, "VEC4", 4, ",\"normalized\":true" },
        { unorm8, sizeof unorm8, COMPONENT_UBYTE, "VEC3", 4, ",\"normalized\":true" },
        { real, sizeof real, COMPONENT_FLOAT, "VEC3", 4, NULL },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct draft d = { 0 };
        draft_accessor(&d, &rows[i]);
        struct gltf_scene *const s = square_load(&d, ",\"COLOR_0\":0");
        const float want[4] = { 1, 0, 0.2f, i < 2 ? 0 : 1 };
        assert_non_null(s->primitives[0].colors);
        floats_expect(s->primitives[0].colors, want, 4, 1e-7);
        floats_expect(s->primitives[0].colors + 12, want, 4, 1e-7);
        gltf_scene_destroy(s);
    }
}

static void quantized_vertices_unpack(void **state)
{
    (void)state;
    static const int16_t positions[12] = { 0, 0, 0, 0, 1000, 0, 0, 0, -1000, 1000, 0, 0 }; /* stride 8 */
    static const int8_t normals[12] = { 0, 0, 127, 0, 0, 0, 127, 0, -128, 0, 0, 0 };       /* stride 4 */
    static const uint16_t uv[6] = { 0, 65535, 32768, 0, 65535, 13107 };
    struct draft d = { 0 };
    draft_accessor(&d, &(struct elements){ positions, sizeof positions, COMPONENT_SHORT, "VEC3", 3, NULL });
    snprintf(strrchr(d.views, '}'), 32, ",\"byteStride\":8}");
    draft_accessor(
        &d, &(struct elements){ normals, sizeof normals, COMPONENT_BYTE, "VEC3", 3, ",\"normalized\":true" });
    snprintf(strrchr(d.views, '}'), 32, ",\"byteStride\":4}");
    draft_accessor(&d,
                   &(struct elements){ uv, sizeof uv, COMPONENT_USHORT, "VEC2", 3, ",\"normalized\":true" });
    struct gltf_scene *const s =
        draft_load(&d, ",\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
                       "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"nodes\":[{\"mesh\":0}],"
                       "\"meshes\":[{\"primitives\":[{\"attributes\":"
                       "{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}}]}]");
    const struct gltf_primitive *const p = &s->primitives[0];
    floats_expect(p->positions, (const float[]){ 0, 0, 0, 1000, 0, 0, -1000, 1000, 0 }, 9, 0);
    floats_expect(p->normals, (const float[]){ 0, 0, 1, 0, 0, 1, -1, 0, 0 }, 9, 0);
    floats_expect(p->uv0, (const float[]){ 0, 1, 0.5f, 0, 1, 0.2f }, 6, 1e-5);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

static void missing_normals_become_flat_ones(void **state)
{
    (void)state;
    static const float tent[12] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    static const uint16_t faces[6] = { 0, 1, 2, 0, 2, 3 };
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 4, tent);
    indices_add(&d, faces, sizeof faces, COMPONENT_USHORT, 6);
    struct gltf_scene *const s = primitive_load(&d, "\"attributes\":{\"POSITION\":0},\"indices\":1");
    const struct gltf_primitive *const p = &s->primitives[0];
    assert_int_equal(p->vertex_count, 6); /* no longer shared */
    for (int i = 0; i < 3; i++) {
        floats_expect(p->normals + 3 * i, (const float[]){ 0, 0, 1 }, 3, 0);
        floats_expect(p->normals + 9 + 3 * i, (const float[]){ 1, 0, 0 }, 3, 0);
    }
    gltf_scene_destroy(s);
}

static void missing_tangents_follow_u_and_mirror_with_v(void **state)
{
    (void)state;
    static const float mirrored[8] = { 1, 1, 0, 1, 0, 0, 1, 0 };
    const float *const uv[2] = { square_uv, mirrored };
    for (int i = 0; i < 2; i++) {
        struct draft d = { 0 };
        draft_floats(&d, "VEC2", 4, uv[i]);
        struct gltf_scene *const s = square_load(&d, ",\"TEXCOORD_0\":0");
        const float sign = i == 0 ? 1 : -1;
        for (int v = 0; v < 4; v++)
            floats_expect(s->primitives[0].tangents + 4 * v, (const float[]){ sign, 0, 0, sign }, 4, 1e-6);
        gltf_scene_destroy(s);
    }
}

static void tangents_without_usable_uv_stay_at_right_angles(void **state)
{
    (void)state;
    struct draft d = { 0 };
    struct gltf_scene *const s = square_load(&d, "");
    const struct gltf_primitive *const p = &s->primitives[0];
    for (size_t i = 0; i < p->vertex_count; i++) {
        const float *const n = p->normals + 3 * i, *const t = p->tangents + 4 * i;
        assert_true(fabsf(n[0] * t[0] + n[1] * t[1] + n[2] * t[2]) < 1e-6f);
    }
    floats_expect(p->uv0, (const float[8]){ 0 }, 8, 0);
    gltf_scene_destroy(s);
}

static void stored_tangents_are_kept(void **state)
{
    (void)state;
    static const float tangents[16] = { 0, 1, 0, -1, 0, 1, 0, -1, 0, 2, 0, -1, 0, 1, 0, -1 };
    struct draft d = { 0 };
    draft_floats(&d, "VEC4", 4, tangents);
    struct gltf_scene *const s = square_load(&d, ",\"TANGENT\":0");
    for (int i = 0; i < 4; i++)
        floats_expect(s->primitives[0].tangents + 4 * i, tangents, 4, 0);
    gltf_scene_destroy(s);
}

static void broken_normals_uv_and_colors_are_repaired(void **state)
{
    (void)state;
    static const float normals[12] = { NAN, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 3 };
    static const float uv[8] = { NAN, INFINITY, 1, 1, 1, 0, 0, 0 };
    static const float colors[12] = { NAN, 1, -1, 1e30f, 0.5f, 1, 1, 1, 1, 1, 1, 1 };
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 4, square);
    draft_floats(&d, "VEC3", 4, normals);
    draft_floats(&d, "VEC2", 4, uv);
    draft_floats(&d, "VEC3", 4, colors);
    indices_add(&d, square_indices, sizeof square_indices, COMPONENT_USHORT, 6);
    struct gltf_scene *const s = primitive_load(
        &d, "\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"COLOR_0\":3},\"indices\":4");
    const struct gltf_primitive *const p = &s->primitives[0];
    floats_expect(p->normals, square_normals, 12, 0);
    floats_expect(p->uv0, (const float[]){ 0, 0, 1, 1 }, 4, 0);
    floats_expect(p->colors, (const float[]){ 0, 1, 0, 1, 1, 0.5f, 1, 1 }, 8, 0);
    gltf_scene_destroy(s);
}

static void points_and_lines_are_left_out_and_counted(void **state)
{
    (void)state;
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 3, square);
    struct gltf_scene *const s = draft_load(
        &d,
        ",\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0},"
        "{\"attributes\":{\"POSITION\":0},\"mode\":3},{\"attributes\":{\"POSITION\":0}}]}]");
    assert_int_equal(s->primitive_count, 1);
    assert_int_equal(s->instance_count, 1);
    assert_non_null(strstr(s->warning, "2 primitives of points or lines"));
    gltf_scene_destroy(s);
}

static void primitives_without_material_share_the_default_one(void **state)
{
    (void)state;
    struct draft d = { 0 };
    draft_floats(&d, "VEC3", 3, square);
    struct gltf_scene *const s = draft_load(
        &d,
        ",\"materials\":[{\"name\":\"own\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}},"
        "{\"attributes\":{\"POSITION\":0},\"material\":0}]}]");
    assert_int_equal(s->material_count, 2);
    assert_int_equal(s->primitives[0].material, 1);
    assert_int_equal(s->primitives[1].material, 0);
    floats_expect(s->materials[1].base_color, (const float[]){ 1, 1, 1, 1 }, 4, 0);
    gltf_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_index_type_gives_the_same_triangles),
        cmocka_unit_test(without_indices_vertices_are_drawn_in_turn),
        cmocka_unit_test(strips_and_fans_keep_their_front_faces),
        cmocka_unit_test(sparse_accessors_replace_elements),
        cmocka_unit_test(interleaved_vertices_are_read_with_their_stride),
        cmocka_unit_test(colors_of_every_type_are_linear_rgba),
        cmocka_unit_test(quantized_vertices_unpack),
        cmocka_unit_test(missing_normals_become_flat_ones),
        cmocka_unit_test(missing_tangents_follow_u_and_mirror_with_v),
        cmocka_unit_test(tangents_without_usable_uv_stay_at_right_angles),
        cmocka_unit_test(stored_tangents_are_kept),
        cmocka_unit_test(broken_normals_uv_and_colors_are_repaired),
        cmocka_unit_test(points_and_lines_are_left_out_and_counted),
        cmocka_unit_test(primitives_without_material_share_the_default_one),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
