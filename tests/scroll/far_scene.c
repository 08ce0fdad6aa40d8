/* SPDX-License-Identifier: MIT */
#include "far_scene.h"

#include "files.h"
#include "require.h"

#include <stdio.h>

/* Boxes as centre, size and colour. The root node carries the shift, half of it as a matrix, half as a
 * translation further down: the importer has to add them up in doubles. */
struct box {
    double center[3], size[3];
    float color[3];
};

static const struct box boxes[] = {
    { { 0, -0.25, 0 }, { 16, 0.5, 16 }, { 0.8f, 0.8f, 0.8f } },
    { { -4.5, 1.5, 0 }, { 0.25, 3, 8 }, { 0.8f, 0.2f, 0.1f } },
    { { 0, 1.5, -4.5 }, { 8, 3, 0.25 }, { 0.2f, 0.7f, 0.3f } },
    { { -2, 3.125, -2 }, { 5, 0.25, 5 }, { 0.7f, 0.7f, 0.8f } },
    { { 1, 0.75, 0.5 }, { 0.75, 1.5, 0.75 }, { 0.6f, 0.6f, 0.6f } },
    { { -1.5, 0.5, -1.25 }, { 1, 1, 1.5 }, { 0.3f, 0.3f, 0.9f } },
    { { 2.75, 0.375, -2 }, { 0.25, 0.75, 2 }, { 0.9f, 0.8f, 0.2f } },
};

enum { BOX_COUNT = sizeof boxes / sizeof boxes[0], FACES = 6, VERTICES = 4 * FACES, INDICES = 6 * FACES };

/* A cube of side 1 around the origin. */
static void write_cube(void)
{
    struct {
        float positions[VERTICES][3], normals[VERTICES][3];
        uint16_t indices[INDICES];
    } cube;
    for (int face = 0; face < FACES; face++) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const float side = face % 2 ? -1.0f : 1.0f;
        for (int i = 0; i < 4; i++) {
            float *p = cube.positions[4 * face + i], *n = cube.normals[4 * face + i];
            memset(n, 0, 3 * sizeof(float));
            n[axis] = side;
            p[axis] = 0.5f * side;
            p[u] = 0.5f * side * (i == 1 || i == 2 ? 1.0f : -1.0f);
            p[v] = i >= 2 ? 0.5f : -0.5f;
        }
        static const uint16_t corners[6] = { 0, 1, 2, 0, 2, 3 };
        for (int i = 0; i < 6; i++)
            cube.indices[6 * face + i] = (uint16_t)(4 * face + corners[i]);
    }
    files_write("far.bin", &cube, sizeof cube);
}

static void write_boxes(FILE *file)
{
    fputs("\"materials\":[", file);
    for (int i = 0; i < BOX_COUNT; i++)
        fprintf(file,
                "%s{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],\"metallicFactor\":0,"
                "\"roughnessFactor\":0.6}}",
                i ? "," : "", (double)boxes[i].color[0], (double)boxes[i].color[1],
                (double)boxes[i].color[2]);
    fputs("],\"meshes\":[", file);
    for (int i = 0; i < BOX_COUNT; i++)
        fprintf(file,
                "%s{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2,"
                "\"material\":%d}]}",
                i ? "," : "", i);
    fputs("],", file);
}

static void write_nodes(FILE *file, const double shift[3])
{
    fprintf(file,
            "\"nodes\":[{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,%.17g,%.17g,%.17g,1],\"children\":[1]},"
            "{\"translation\":[%.17g,%.17g,%.17g],\"children\":[",
            0.5 * shift[0], 0.5 * shift[1], 0.5 * shift[2], 0.5 * shift[0], 0.5 * shift[1], 0.5 * shift[2]);
    for (int i = 0; i < BOX_COUNT; i++)
        fprintf(file, "%s%d", i ? "," : "", i + 2);
    fputs("]}", file);
    for (int i = 0; i < BOX_COUNT; i++) {
        const struct box *b = &boxes[i];
        fprintf(file, ",{\"mesh\":%d,\"translation\":[%.17g,%.17g,%.17g],\"scale\":[%.17g,%.17g,%.17g]}", i,
                b->center[0], b->center[1], b->center[2], b->size[0], b->size[1], b->size[2]);
    }
    fputs("],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}\n", file);
}

const char *far_scene_write(const double shift[3])
{
    write_cube();
    const char *path = files_path("far.gltf");
    FILE *file = fopen(path, "wb");
    REQUIRE_TRUE(file != NULL);
    const unsigned bytes = 12 * VERTICES;
    fprintf(file,
            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"far.bin\",\"byteLength\":%u}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%u},{\"buffer\":0,\"byteOffset\":%u,"
            "\"byteLength\":%u},{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}],\"accessors\":["
            "{\"bufferView\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\","
            "\"min\":[-0.5,-0.5,-0.5],\"max\":[0.5,0.5,0.5]},"
            "{\"bufferView\":1,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
            "{\"bufferView\":2,\"componentType\":5123,\"count\":%d,\"type\":\"SCALAR\"}],",
            2 * bytes + 2 * INDICES, bytes, bytes, bytes, 2 * bytes, 2 * INDICES, VERTICES, VERTICES,
            INDICES);
    write_boxes(file);
    write_nodes(file, shift);
    assert_int_equal(fclose(file), 0);
    return path;
}

static void place(double out[3], const double shift[3], double x, double y, double z)
{
    out[0] = shift[0] + x;
    out[1] = shift[1] + y;
    out[2] = shift[2] + z;
}

struct host_view far_scene_view(const double shift[3], struct host_light lights[2])
{
    struct host_view view;
    host_view_default(&view);
    view.sky = (struct host_sky){ { 0.4f, 0.6f, 1 }, { 0.8f, 0.9f, 1 }, { 0.2f, 0.2f, 0.2f } };
    view.sun = (struct host_sun){ true, { -0.6f, -1, -0.35f }, { 8, 7, 6 }, 0.02f };
    lights[0] = (struct host_light){ .type = HOST_LIGHT_POINT, .intensity = { 6, 4, 2 } };
    lights[1] = (struct host_light){ .type = HOST_LIGHT_SPOT,
                                     .direction = { -0.25f, -1, 0.125f },
                                     .intensity = { 5, 15, 20 },
                                     .inner_rad = 0.3f,
                                     .outer_rad = 0.6f };
    place(lights[0].position, shift, -2.25, 2, -2.75);
    place(lights[1].position, shift, 2, 3.5, 1);
    view.lights = lights;
    view.light_count = 2;
    place(view.camera.position, shift, 5.125, 3.25, 6.5);
    place(view.camera.look_at, shift, -0.75, 0.75, -0.5);
    return view;
}
