/* SPDX-License-Identifier: MIT
 *
 * Parts of a file that name the same data again and again: what they unpack to is bounded by the size of the
 * files, and not by its square.
 */
#include "scene_files.h"
#include "test_memory.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 1 << 19 };

static char text[TEXT_SIZE];
static size_t text_size;

static void append(const char *part, int times)
{
    const size_t size = strlen(part);
    for (int i = 0; i < times; i++) {
        assert_true(size < TEXT_SIZE - text_size);
        memcpy(text + text_size, part, size + 1);
        text_size += size;
    }
}

/* A list of that many. */
static void append_list(const char *name, const char *element, int count)
{
    char first[512];
    snprintf(first, sizeof first, ",\"%s\":[%s", name, element);
    append(first, 1);
    snprintf(first, sizeof first, ",%s", element);
    append(first, count - 1);
    append("]", 1);
}

static void begin(void)
{
    text_size = 0;
    append("{\"asset\":{\"version\":\"2.0\"}", 1);
}

static void write_file(void)
{
    append("}", 1);
    files_write_text("bounds.gltf", text);
}

static void require_read(void)
{
    write_file();
    gltf_scene_destroy(file_load("bounds.gltf"));
}

static void require_refused(const char *wrong)
{
    char error[512];
    write_file();
    assert_null(gltf_scene_load(files_path("bounds.gltf"), error, sizeof error));
    if (strstr(error, wrong) == NULL)
        fail_msg("the message is '%s'; it should hold '%s'", error, wrong);
}

/* Positions at the edge of a box, `vertex_count` of them, and as many indices. */
static void begin_vertices(int vertex_count)
{
    char rest[512];
    float *const positions = test_array_alloc((size_t)vertex_count * 3, sizeof *positions);
    uint16_t *const indices = test_array_alloc((size_t)vertex_count, sizeof *indices);
    for (int i = 0; i < vertex_count; i++) {
        positions[3 * i + i % 3] = 1;
        indices[i] = (uint16_t)i;
    }
    files_write("positions.bin", positions, (size_t)vertex_count * 12);
    files_write("indices.bin", indices, (size_t)vertex_count * 2);
    free(positions);
    free(indices);
    begin();
    snprintf(rest, sizeof rest,
             ",\"buffers\":[{\"uri\":\"positions.bin\",\"byteLength\":%d},"
             "{\"uri\":\"indices.bin\",\"byteLength\":%d}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%d},{\"buffer\":1,\"byteLength\":%d}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":%d},"
             "{\"bufferView\":1,\"componentType\":5123,\"type\":\"SCALAR\",\"count\":%d}]",
             vertex_count * 12, vertex_count * 2, vertex_count * 12, vertex_count * 2, vertex_count,
             vertex_count);
    append(rest, 1);
}

static void append_mesh(const char *primitive, int count)
{
    append(",\"meshes\":[{\"name\":\"m\"", 1);
    append_list("primitives", primitive, count);
    append("}]", 1);
}

static void primitives_may_share_vertices(void **state)
{
    (void)state;
    begin_vertices(300);
    append_mesh("{\"attributes\":{\"POSITION\":0,\"NORMAL\":0}}", 100);
    require_read();
}

static void many_primitives_of_the_same_vertices_are_refused(void **state)
{
    (void)state;
    begin_vertices(12000);
    append_mesh("{\"attributes\":{\"POSITION\":0,\"NORMAL\":0}}", 4000);
    require_refused("vertices, the limit for files of");
}

/* Without normals, each corner of a triangle becomes a vertex. */
static void many_flat_primitives_of_the_same_indices_are_refused(void **state)
{
    (void)state;
    begin_vertices(60000);
    append_mesh("{\"attributes\":{\"POSITION\":0},\"indices\":1}", 500);
    require_refused("vertices, the limit for files of");
}

static void many_strips_of_the_same_indices_are_refused(void **state)
{
    (void)state;
    begin_vertices(12000);
    append_mesh("{\"mode\":5,\"attributes\":{\"POSITION\":0,\"NORMAL\":0},\"indices\":1}", 1000);
    require_refused("indices, the limit for files of");
}

static void many_nodes_of_a_mesh_of_many_primitives_are_refused(void **state)
{
    (void)state;
    begin_vertices(3);
    append_mesh("{\"attributes\":{\"POSITION\":0}}", 1000);
    append_list("nodes", "{\"mesh\":0}", 3000);
    require_refused("instances, the limit for files of");
}

/* All of them name one file, and differ in how. */
static void append_named(const char *list, const char *more, const char *file, int count)
{
    char start[64], element[512], dots[256] = "";
    snprintf(start, sizeof start, ",\"%s\":[", list);
    append(start, 1);
    for (int i = 0; i < count; i++) {
        snprintf(element, sizeof element, "%s{\"uri\":\"%s%s\"%s}", i == 0 ? "" : ",", dots, file, more);
        append(element, 1);
        memcpy(dots + 2 * i, "./", 3);
    }
    append("]", 1);
}

static void many_buffers_of_the_same_file_are_refused(void **state)
{
    (void)state;
    static const uint8_t zeros[50000];
    files_write("zeros.bin", zeros, sizeof zeros);
    begin();
    append_named("buffers", ",\"byteLength\":1", "zeros.bin", 16);
    require_read();
    begin();
    append_named("buffers", ",\"byteLength\":1", "zeros.bin", 40);
    require_refused("bytes to read, the limit for files of");
}

/* 64 MiB of texels out of 17 KB. */
static void many_images_of_the_same_file_are_refused(void **state)
{
    (void)state;
    enum { SIDE = 4096, COUNT = 4 };
    uint8_t *const texels = test_array_alloc(SIDE, SIDE);
    png_image png = {
        .version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE, .format = PNG_FORMAT_GRAY
    };
    assert_true(png_image_write_to_file(&png, files_path("black.png"), 0, texels, 0, NULL));
    free(texels);
    begin();
    append_named("images", "", "black.png", COUNT);
    append(",\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2},{\"source\":3}]", 1);
    require_read();
    begin();
    append_named("images", "", "black.png", COUNT + 1);
    append(",\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2},{\"source\":3},{\"source\":4}]", 1);
    require_refused("images[4]: more than 67108864 texels");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(primitives_may_share_vertices),
        cmocka_unit_test(many_primitives_of_the_same_vertices_are_refused),
        cmocka_unit_test(many_flat_primitives_of_the_same_indices_are_refused),
        cmocka_unit_test(many_strips_of_the_same_indices_are_refused),
        cmocka_unit_test(many_nodes_of_a_mesh_of_many_primitives_are_refused),
        cmocka_unit_test(many_buffers_of_the_same_file_are_refused),
        cmocka_unit_test(many_images_of_the_same_file_are_refused),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
