/* SPDX-License-Identifier: MIT
 *
 * Compressed meshes and pictures: they hold what went in, and broken or lying ones are refused, soon. Where a
 * decoder is not built, one message says which option builds it.
 */
#include "pack.h"
#include "scene_files.h"

#include <math.h>
#include <string.h>
#include <time.h>
#ifdef GLTF_WITH_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef GLTF_WITH_WEBP
#include <webp/encode.h>
#endif

enum { PACKED_SIZE = 4096 };

#if defined(GLTF_WITH_DRACO) || defined(GLTF_WITH_MESHOPT)
/* A bumpy grid: no two vertices are alike. */
static void grid_make(struct grid *g)
{
    for (uint32_t i = 0; i < GRID_VERTICES; i++) {
        const float x = (float)(i % GRID_SIDE), z = (float)(i / GRID_SIDE);
        memcpy(g->positions + 3 * i, (const float[]){ x, 0.25f * (float)((i * 7) % 5), z }, 12);
        memcpy(g->normals + 3 * i, (const float[]){ 0, 1, 0 }, 12);
        memcpy(g->uv + 2 * i, (const float[]){ x / 8, z / 8 }, 8);
    }
    uint32_t *to = g->indices;
    for (uint32_t z = 0; z + 1 < GRID_SIDE; z++)
        for (uint32_t x = 0; x + 1 < GRID_SIDE; x++) {
            const uint32_t a = z * GRID_SIDE + x, b = a + GRID_SIDE;
            memcpy(to, (const uint32_t[]){ a, b, a + 1, a + 1, b, b + 1 }, 24);
            to += 6;
        }
}
#endif

#ifdef GLTF_WITH_DRACO
/* Twice the signed volume between the grid and its floor, with uv for x: any exchange of vertices shows. */
static double moment(const float *positions, const float *uv, const uint32_t *indices, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i += 3) {
        double uvs[3][2], height = 0;
        for (int k = 0; k < 3; k++) {
            const uint32_t v = indices[i + (uint32_t)k];
            uvs[k][0] = (double)uv[2 * v];
            uvs[k][1] = (double)uv[2 * v + 1];
            height += (double)positions[3 * v + 1] * (double)(1 + positions[3 * v]);
        }
        sum += height * ((uvs[1][0] - uvs[0][0]) * (uvs[2][1] - uvs[0][1]) -
                         (uvs[2][0] - uvs[0][0]) * (uvs[1][1] - uvs[0][1]));
    }
    return sum;
}
#endif

/* ---- Draco ------------------------------------------------------------------------------------------- */

#define DRACO_REQUIRED                                                                                       \
    ",\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],\"extensionsRequired\":"                           \
    "[\"KHR_draco_mesh_compression\"]"

static void draco_write(const uint8_t *data, size_t size)
{
    char rest[1024];
    struct draft d = { 0 };
    const int view = draft_view(&d, data, size);
    draft_accessor(&d, &(struct elements){ NULL, 0, COMPONENT_FLOAT, "VEC3", GRID_VERTICES, NULL });
    draft_accessor(&d, &(struct elements){ NULL, 0, COMPONENT_FLOAT, "VEC2", GRID_VERTICES, NULL });
    draft_accessor(&d, &(struct elements){ NULL, 0, COMPONENT_USHORT, "SCALAR", 3 * GRID_TRIANGLES, NULL });
    snprintf(rest, sizeof rest,
             DRACO_REQUIRED
             ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0,"
             "\"TEXCOORD_0\":1},\"indices\":2,\"extensions\":{\"KHR_draco_mesh_compression\":"
             "{\"bufferView\":%d,\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}}}"
             "}]}],\"nodes\":[{\"mesh\":0}]",
             view);
    draft_write(&d, rest, "packed.glb");
}

#ifdef GLTF_WITH_DRACO
static size_t draco_grid(bool edgebreaker, uint8_t *out)
{
    struct grid g;
    grid_make(&g);
    const size_t size = draco_encode(&g, edgebreaker, out, PACKED_SIZE);
    assert_true(size > 20);
    return size;
}

static void a_mesh_from_draco_is_the_mesh_that_went_in(void **state)
{
    (void)state;
    struct grid g;
    grid_make(&g);
    for (int edgebreaker = 0; edgebreaker < 2; edgebreaker++) {
        uint8_t data[PACKED_SIZE];
        draco_write(data, draco_grid(edgebreaker != 0, data));
        struct gltf_scene *const s = file_load("packed.glb");
        const struct gltf_primitive *const p = &s->primitives[0];
        assert_int_equal(p->vertex_count, GRID_VERTICES);
        assert_int_equal(p->index_count, 3 * GRID_TRIANGLES);
        assert_null(s->warning);
        const double want = moment(g.positions, g.uv, g.indices, 3 * GRID_TRIANGLES);
        const double got = moment(p->positions, p->uv0, p->indices, p->index_count);
        if (!(fabs(got - want) < 1e-9))
            fail_msg("moment %.9g, expected %.9g", got, want);
        gltf_scene_destroy(s);
    }
}

static void cut_draco_data_is_refused(void **state)
{
    (void)state;
    for (int edgebreaker = 0; edgebreaker < 2; edgebreaker++) {
        uint8_t data[PACKED_SIZE];
        const size_t size = draco_grid(edgebreaker != 0, data);
        for (size_t kept = 1; kept + 8 < size; kept += 3) {
            draco_write(data, kept);
            refused_with("meshes[0].primitives[0]");
        }
    }
}

/* Counts follow the header of eleven bytes, and with edgebreaker a byte for the traversal: a varint of five
 * bytes that says 2^31 takes the place of the first one or two. */
static void draco_data_cannot_claim_more_than_its_size_allows(void **state)
{
    (void)state;
    static const uint8_t huge[5] = { 0x80, 0x80, 0x80, 0x80, 0x08 };
    for (int edgebreaker = 0; edgebreaker < 2; edgebreaker++)
        for (int second = 0; second < 2; second++) {
            uint8_t data[PACKED_SIZE], lying[PACKED_SIZE];
            const size_t size = draco_grid(edgebreaker != 0, data);
            const size_t at = (size_t)(11 + edgebreaker + second);
            memcpy(lying, data, at);
            memcpy(lying + at, huge, sizeof huge);
            memcpy(lying + at + sizeof huge, data + at + 1, size - at - 1);
            draco_write(lying, size + sizeof huge - 1);
            const clock_t start = clock();
            /* With edgebreaker, vertices beyond three for a face are wrong whatever the size. */
            refused_with(edgebreaker && !second ? "the Draco data is broken" : "the limit for files of");
            assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 0.1);
        }
}

static void draco_attributes_that_are_not_there_are_refused(void **state)
{
    (void)state;
    uint8_t data[PACKED_SIZE];
    const size_t size = draco_grid(true, data);
    struct draft d = { 0 };
    draft_view(&d, data, size);
    draft_accessor(&d, &(struct elements){ NULL, 0, COMPONENT_FLOAT, "VEC3", GRID_VERTICES, NULL });
#define DRACO_MESH(attributes, packed)                                                                       \
    DRACO_REQUIRED ",\"meshes\":[{\"primitives\":[{\"attributes\":{" attributes "},\"extensions\":"          \
                   "{\"KHR_draco_mesh_compression\":{" packed "}}}]}],\"nodes\":[{\"mesh\":0}]"
    static const struct {
        const char *rest, *wrong;
    } rows[] = {
        { DRACO_MESH("\"POSITION\":0", "\"bufferView\":0,\"attributes\":{\"POSITION\":9}"),
          "no attribute 9" },
        { DRACO_MESH("\"POSITION\":0", "\"bufferView\":0,\"attributes\":{\"NORMAL\":1}"),
          "has NORMAL, and the primitive has not" },
        { DRACO_MESH("\"POSITION\":0", "\"bufferView\":7,\"attributes\":{\"POSITION\":0}"), "view 7" },
        { DRACO_MESH("\"POSITION\":0", "\"bufferView\":0"), "attributes is missing" },
        { DRACO_MESH("\"POSITION\":5", "\"bufferView\":0,\"attributes\":{\"POSITION\":0}"), "accessor 5" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        draft_write(&d, rows[i].rest, "packed.glb");
        refused_with(rows[i].wrong);
    }
}
#else
static void without_draco_the_message_names_the_option(void **state)
{
    (void)state;
    draco_write((const uint8_t[4]){ 0 }, 4);
    refused_with("KHR_draco_mesh_compression, which this build does not have: build it with -Ddraco=enabled");
}
#endif

/* ---- meshoptimizer ----------------------------------------------------------------------------------- */

/* One view of the compressed bytes, in buffer 0, and accessors that read a fallback buffer without data. */
static void meshopt_write(const uint8_t *data, size_t size, const char *packed, const char *accessors)
{
    char json[4096];
    static uint8_t file[2 * PACKED_SIZE];
    snprintf(json, sizeof json,
             "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"EXT_meshopt_compression\"],"
             "\"extensionsRequired\":[\"EXT_meshopt_compression\"],"
             "\"buffers\":[{\"byteLength\":%zu},{\"byteLength\":99999,\"extensions\":"
             "{\"EXT_meshopt_compression\":{\"fallback\":true}}}],\"bufferViews\":[%s],\"accessors\":[%s],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}",
             size, packed, accessors);
    files_write("packed.glb", file, glb_assemble(file, sizeof file, json, data, size));
}

#ifdef GLTF_WITH_MESHOPT
static size_t meshopt_grid(uint8_t *out)
{
    struct grid g;
    grid_make(&g);
    const size_t size =
        meshopt_encodeVertexBuffer(out, PACKED_SIZE, g.positions, GRID_VERTICES, 3 * sizeof(float));
    assert_true(size > 0);
    return size;
}

static void meshopt_grid_write(const uint8_t *data, size_t size, const char *members)
{
    char packed[512], accessors[256];
    snprintf(packed, sizeof packed,
             "{\"buffer\":1,\"byteLength\":%d,\"byteStride\":12,\"extensions\":{\"EXT_meshopt_compression\":"
             "{\"buffer\":0,\"byteLength\":%zu%s}}}",
             12 * GRID_VERTICES, size, members);
    snprintf(accessors, sizeof accessors,
             "{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":%d}", GRID_VERTICES);
    meshopt_write(data, size, packed, accessors);
}

#define MESHOPT_GRID ",\"byteStride\":12,\"count\":36,\"mode\":\"ATTRIBUTES\""

static void vertices_from_meshoptimizer_are_those_that_went_in(void **state)
{
    (void)state;
    uint8_t data[PACKED_SIZE];
    struct grid g;
    grid_make(&g);
    meshopt_grid_write(data, meshopt_grid(data), MESHOPT_GRID);
    struct gltf_scene *const s = file_load("packed.glb");
    assert_memory_equal(s->primitives[0].positions, g.positions, sizeof g.positions);
    gltf_scene_destroy(s);
}

/* Of quaternions nothing is drawn; what the filters decode is the library's business. */
static void filters_of_meshoptimizer_run(void **state)
{
    (void)state;
    static const struct {
        const char *members, *wrong;
    } rows[] = {
        { MESHOPT_GRID ",\"filter\":\"EXPONENTIAL\"", NULL },
        { MESHOPT_GRID ",\"filter\":\"OCTAHEDRAL\"", "OCTAHEDRAL has no stride of 12" },
        { MESHOPT_GRID ",\"filter\":\"QUATERNION\"", "QUATERNION has no stride of 12" },
        { MESHOPT_GRID ",\"filter\":\"SECRET\"", "'SECRET' is unknown" },
    };
    uint8_t data[PACKED_SIZE];
    const size_t size = meshopt_grid(data);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        meshopt_grid_write(data, size, rows[i].members);
        if (rows[i].wrong != NULL) {
            refused_with(rows[i].wrong);
            continue;
        }
        struct gltf_scene *const s = file_load("packed.glb");
        struct grid g;
        grid_make(&g);
        assert_memory_not_equal(s->primitives[0].positions, g.positions, sizeof g.positions);
        gltf_scene_destroy(s);
    }
}

static void cut_and_lying_data_of_meshoptimizer_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *members, *wrong;
    } rows[] = {
        { ",\"byteStride\":12,\"count\":36,\"mode\":\"WAVELETS\"", "'WAVELETS' is unknown" },
        { ",\"byteStride\":12,\"count\":65,\"mode\":\"ATTRIBUTES\"", "compressed data is broken" },
        { ",\"byteStride\":12,\"count\":2000000000,\"mode\":\"ATTRIBUTES\"", "too few" },
        { ",\"byteStride\":13,\"count\":36,\"mode\":\"ATTRIBUTES\"", "stride of 13" },
        { ",\"byteStride\":0,\"count\":36,\"mode\":\"ATTRIBUTES\"", "stride of 0" },
        { ",\"byteStride\":12,\"count\":36,\"mode\":\"TRIANGLES\"", "indices have 2 or 4" },
        { ",\"byteStride\":4,\"count\":35,\"mode\":\"TRIANGLES\"", "35 indices" },
        { ",\"byteStride\":4,\"count\":36,\"mode\":\"TRIANGLES\"", "compressed data is broken" },
        { ",\"byteStride\":4,\"count\":36,\"mode\":\"INDICES\"", "compressed data is broken" },
        { ",\"byteStride\":12,\"count\":36", "mode is missing" },
        { ",\"byteOffset\":9999,\"byteStride\":12,\"count\":36,\"mode\":\"ATTRIBUTES\"", "outside" },
    };
    uint8_t data[PACKED_SIZE];
    const size_t size = meshopt_grid(data);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        meshopt_grid_write(data, size, rows[i].members);
        refused_with(rows[i].wrong);
    }
    for (size_t kept = 1; kept < size; kept++) {
        meshopt_grid_write(data, kept, MESHOPT_GRID);
        refused_with("bufferViews[0].EXT_meshopt_compression");
    }
}

/* Many views may name the same compressed bytes. */
static void what_meshoptimizer_unpacks_is_bounded(void **state)
{
    (void)state;
    enum { VIEWS = 4000 };
    static char json[VIEWS * 200 + 1000];
    static uint8_t zeros[512 * 256], packed[4 * PACKED_SIZE], file[sizeof json + sizeof packed];
    const size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, zeros, sizeof zeros / 256, 256);
    size_t at = (size_t)snprintf(json, sizeof json,
                                 "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu}],"
                                 "\"bufferViews\":[",
                                 size);
    for (int i = 0; i < VIEWS; i++)
        at +=
            (size_t)snprintf(json + at, sizeof json - at,
                             "%s{\"buffer\":0,\"byteLength\":1,\"extensions\":{\"EXT_meshopt_compression\":{"
                             "\"buffer\":0,\"byteLength\":%zu,\"byteStride\":256,\"count\":%zu,\"mode\":"
                             "\"ATTRIBUTES\"}}}",
                             i == 0 ? "" : ",", size, sizeof zeros / 256);
    snprintf(json + at, sizeof json - at, "]}");
    files_write("packed.glb", file, glb_assemble(file, sizeof file, json, packed, size));
    assert_true(size > 0);
    refused_with("unpacked bytes, the limit for files of");
}
#else
static void without_meshoptimizer_the_message_names_the_option(void **state)
{
    (void)state;
    meshopt_write((const uint8_t[4]){ 0 }, 4, "", "");
    refused_with("EXT_meshopt_compression, which this build does not have: build it with -Dmeshopt=enabled");
}
#endif

/* ---- WebP -------------------------------------------------------------------------------------------- */

#define WEBP_SCENE                                                                                           \
    ",\"extensionsUsed\":[\"EXT_texture_webp\"],\"extensionsRequired\":[\"EXT_texture_webp\"],\"images\":"   \
    "[{\"bufferView\":0,\"mimeType\":\"image/webp\"}],\"textures\":[{\"extensions\":{\"EXT_texture_webp\":"  \
    "{\"source\":0}}}],\"materials\":[{\"emissiveTexture\":{\"index\":0}}]"

#ifdef GLTF_WITH_WEBP
static const uint8_t texels[16] = { 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 10, 20, 30, 40 };

static void a_picture_from_webp_is_the_one_that_went_in(void **state)
{
    (void)state;
    uint8_t *data = NULL;
    const size_t size = WebPEncodeLosslessRGBA(texels, 2, 2, 8, &data);
    assert_true(size > 0);
    packed_write(data, size, WEBP_SCENE);
    WebPFree(data);
    struct gltf_scene *const s = file_load("packed.glb");
    assert_int_equal(s->image_count, 1);
    assert_int_equal(s->images[0].width, 2);
    assert_int_equal(s->images[0].height, 2);
    assert_memory_equal(s->images[0].texels, texels, sizeof texels);
    assert_int_equal(s->materials[0].emissive_texture.texture, 0);
    assert_null(s->warning);
    gltf_scene_destroy(s);
}

static void a_plain_picture_gives_way_to_webp(void **state)
{
    (void)state;
    uint8_t *data = NULL;
    struct draft d = { 0 };
    const size_t size = WebPEncodeLosslessRGBA(texels, 2, 2, 8, &data);
    draft_view(&d, data, size);
    WebPFree(data);
    struct gltf_scene *const s =
        draft_load(&d, ",\"images\":[{\"uri\":\"gone.png\"},{\"bufferView\":0}],\"textures\":[{\"source\":0,"
                       "\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}}]");
    assert_int_equal(s->image_count, 1);
    gltf_scene_destroy(s);
}

static void broken_webp_is_refused(void **state)
{
    (void)state;
    uint8_t *data = NULL;
    const size_t size = WebPEncodeLosslessRGBA(texels, 2, 2, 8, &data);
    for (size_t kept = 1; kept + 2 < size; kept++) {
        packed_write(data, kept, WEBP_SCENE);
        refused_with("images[0]");
    }
    /* Lossless: after "VP8L", its size and a signature, 14 bits each of width - 1 and height - 1. */
    data[21] = 0xff;
    data[22] = 0xff;
    data[23] = 0xff;
    data[24] |= 0x0f;
    packed_write(data, size, WEBP_SCENE);
    WebPFree(data);
    refused_with("more than 67108864 texels");
}
#else
static void without_webp_the_message_names_the_option(void **state)
{
    (void)state;
    packed_write("RIFF", 4, WEBP_SCENE);
    refused_with("EXT_texture_webp, which this build does not have: build it with -Dwebp=enabled");
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef GLTF_WITH_DRACO
        cmocka_unit_test(a_mesh_from_draco_is_the_mesh_that_went_in),
        cmocka_unit_test(cut_draco_data_is_refused),
        cmocka_unit_test(draco_data_cannot_claim_more_than_its_size_allows),
        cmocka_unit_test(draco_attributes_that_are_not_there_are_refused),
#else
        cmocka_unit_test(without_draco_the_message_names_the_option),
#endif
#ifdef GLTF_WITH_MESHOPT
        cmocka_unit_test(vertices_from_meshoptimizer_are_those_that_went_in),
        cmocka_unit_test(filters_of_meshoptimizer_run),
        cmocka_unit_test(cut_and_lying_data_of_meshoptimizer_is_refused),
        cmocka_unit_test(what_meshoptimizer_unpacks_is_bounded),
#else
        cmocka_unit_test(without_meshoptimizer_the_message_names_the_option),
#endif
#ifdef GLTF_WITH_WEBP
        cmocka_unit_test(a_picture_from_webp_is_the_one_that_went_in),
        cmocka_unit_test(a_plain_picture_gives_way_to_webp),
        cmocka_unit_test(broken_webp_is_refused),
#else
        cmocka_unit_test(without_webp_the_message_names_the_option),
#endif
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
