/* SPDX-License-Identifier: MIT
 * The valley: a height field in chunks, finer near the village, with a stream. */
#include "world.h"

#include <math.h>
#include <stdlib.h>

#include "noise.h"

enum {
    CHUNKS = 16, /* along a side */
    CHUNK_M = 64,
    HALF_M = CHUNKS * CHUNK_M / 2,
};

float world_path_z(float x)
{
    return x > -60 ? 0 : 12 * (1 - cosf((x + 60) / 50));
}

float world_stream_z(float x)
{
    return -58 + 9 * sinf(x / 60) + 3 * sinf(x / 23 + 1);
}

/* The spur that the tunnel leads through. Inside the cutting before each portal it is taken away. */
static float spur_height(uint32_t seed, float x, float z)
{
    const float wild = smooth_step(9, 30, fabsf(z));
    const float wander = wild * (14 * sinf(z / 37) + 10 * noise_value(seed + 70, x / 40, z / 40, 0));
    const float along = (x - 125 - wander) / (22 + 6 * wild);
    const float crest = 22 + wild * (9 * noise_fractal(seed + 71, x / 25, z / 25, 0, 4) + 6);
    const float spur = crest * expf(-along * along) * smooth_step(-46, -16, z);
    const bool inside = x > TUNNEL_START_M + 0.5f && x < TUNNEL_END_M - 0.5f;
    return inside ? spur : spur * smooth_step(3.2f, 8, fabsf(z));
}

float world_height(uint32_t seed, float x, float z)
{
    const float from_axis = fabsf(z + 25 - 15 * sinf(x / 160) * smooth_step(100, 260, fabsf(x)));
    const float from_stream = fabsf(z - world_stream_z(x)), from_path = fabsf(z - world_path_z(x));
    const float rise = smooth_step(70, 430, from_axis);
    const float village = smooth_step(92, 66, fabsf(x)) * smooth_step(56, 40, fabsf(z));
    const float calm = (1 - village) * smooth_step(6, 22, from_stream) * smooth_step(4, 16, from_path);
    const float bumps = noise_fractal(seed, x / 30, z / 30, 0, 5);
    const float ranges = noise_fractal(seed + 50, x / 170 + 7, z / 170, 0, 4);
    float height =
        150 * rise * (0.75f + 0.5f * ranges) + calm * bumps * mix(1.6f, 16, smooth_step(50, 230, from_axis));
    height += calm * 3 * smooth_step(30, 90, from_axis) * (1 + ranges);
    return height + spur_height(seed, x, z) - 2.3f * smooth_step(7.5f, 2, from_stream);
}

/* Quads per chunk along a side: 1 m in the village and at the tunnel, 8 m at the rim. */
static int chunk_cells(int i, int j)
{
    if (i < 0 || j < 0 || i >= CHUNKS || j >= CHUNKS)
        return 0;
    const int di = abs(2 * i - CHUNKS + 1) / 2, dj = abs(2 * j - CHUNKS + 1) / 2;
    const bool tunnel = i == 9 || i == 10;
    if ((di == 0 || (tunnel && j >= 7 && j <= 8)) && dj == 0)
        return 64;
    const int ring = di > dj ? di : dj;
    return ring <= 1 ? 32 : ring <= 3 ? 16 : 8;
}

static vec3s ground_color(uint32_t seed, float x, float z, vec3s normal)
{
    const float patch = noise_fractal(seed + 11, x / 18, z / 18, 0, 4),
                fine = noise_value(seed + 12, x / 2, z / 2, 0);
    const float height = world_height(seed, x, z);
    vec3s color = glms_vec3_lerp(v3(0.10f, 0.17f, 0.035f), v3(0.25f, 0.25f, 0.075f), clamp01(0.5f + patch));
    color = glms_vec3_lerp(color, v3(0.33f, 0.28f, 0.13f), 0.6f * smooth_step(50, 130, height + 25 * patch));
    const float rock = smooth_step(0.78f, 0.62f, normal.y + 0.06f * fine + 0.12f * patch);
    color = glms_vec3_lerp(color, v3(0.31f, 0.29f, 0.26f), rock);
    const float bank = smooth_step(8.5f, 6, fabsf(z - world_stream_z(x)) + fine);
    color = glms_vec3_lerp(color, v3(0.30f, 0.27f, 0.22f), bank);
    const float path = smooth_step(3.2f, 2.0f, fabsf(z - world_path_z(x)) + 0.5f * fine + 0.4f * patch);
    color =
        glms_vec3_lerp(color, v3(0.36f, 0.27f, 0.17f), path * smooth_step(2.5f, 1, spur_height(seed, x, z)));
    const float square = smooth_step(11, 8, sqrtf(x * x + z * z) + fine);
    return glms_vec3_scale(glms_vec3_lerp(color, v3(0.33f, 0.27f, 0.2f), square), 1 + 0.12f * fine);
}

static vec3s ground_normal(uint32_t seed, float x, float z, float step)
{
    const float dx = world_height(seed, x + step, z) - world_height(seed, x - step, z);
    const float dz = world_height(seed, x, z + step) - world_height(seed, x, z - step);
    return glms_vec3_normalize(v3(-dx, 2 * step, -dz));
}

/* Height at a vertex; on an edge shared with a coarser chunk, on the straight line between that chunk's
 * vertices, so that no crack opens between them. */
static float stitched_height(uint32_t seed, float x, float z, int along_x, int edge_cells, int index)
{
    const float spacing = (float)CHUNK_M / (float)edge_cells;
    const float start = floorf((float)index / spacing) * spacing - (float)index;
    if (start == 0)
        return world_height(seed, x, z);
    const float dx = along_x ? 1 : 0, dz = along_x ? 0 : 1, end = start + spacing;
    const float low = world_height(seed, x + dx * start, z + dz * start);
    const float high = world_height(seed, x + dx * end, z + dz * end);
    return mix(low, high, -start / spacing);
}

static float vertex_height(uint32_t seed, int ci, int cj, int cells, int i, int j, float x, float z)
{
    const int spacing = CHUNK_M / cells;
    const int beside_x = i == 0 ? chunk_cells(ci - 1, cj) : i == cells ? chunk_cells(ci + 1, cj) : 0;
    const int beside_z = j == 0 ? chunk_cells(ci, cj - 1) : j == cells ? chunk_cells(ci, cj + 1) : 0;
    if (beside_x && beside_x < cells)
        return stitched_height(seed, x, z, 0, beside_x, j * spacing);
    if (beside_z && beside_z < cells)
        return stitched_height(seed, x, z, 1, beside_z, i * spacing);
    return world_height(seed, x, z);
}

/* Quads behind a portal's wall, where the ground jumps from the cutting to the hillside. */
static bool quad_is_cut(float x, float z, float spacing)
{
    const bool portal = x == TUNNEL_START_M || x == TUNNEL_END_M - 1;
    return spacing == 1 && portal && z >= -7 && z < 7;
}

static void chunk_add(struct world *world, int ci, int cj)
{
    const int cells = chunk_cells(ci, cj), row = cells + 1;
    const float spacing = (float)CHUNK_M / (float)cells;
    struct object object;
    object_begin(&object, glms_mat4_identity());
    struct mesh *mesh = object_part(&object, MATERIAL_GROUND, v3(1, 1, 1));
    for (int j = 0; j <= cells; j++)
        for (int i = 0; i <= cells; i++) {
            const float x = (float)(ci * CHUNK_M - HALF_M) + (float)i * spacing;
            const float z = (float)(cj * CHUNK_M - HALF_M) + (float)j * spacing;
            const float y = vertex_height(world->seed, ci, cj, cells, i, j, x, z);
            const vec3s normal = ground_normal(world->seed, x, z, fminf(spacing, 1.0f));
            mesh->color = ground_color(world->seed, x, z, normal);
            mesh_vertex(mesh, v3(x, y, z), normal, x * mesh->uv_per_m, z * mesh->uv_per_m);
        }
    for (int j = 0; j < cells; j++)
        for (int i = 0; i < cells; i++) {
            const float x = (float)(ci * CHUNK_M - HALF_M) + (float)i * spacing;
            const float z = (float)(cj * CHUNK_M - HALF_M) + (float)j * spacing;
            if (quad_is_cut(x, z, spacing))
                continue;
            const uint32_t a = (uint32_t)(j * row + i), b = a + (uint32_t)row;
            mesh_triangle(mesh, a, b, a + 1);
            mesh_triangle(mesh, a + 1, b, b + 1);
        }
    object_place(world, &object, "terrain");
}

/* Bedrock below the valley floor: without it the ground is a sheet, and light enters the voxels from beneath.
 */
static void bedrock_add(struct world *world)
{
    struct object object;
    object_begin(&object, glms_mat4_identity());
    const float half = HALF_M, y = -4;
    mesh_quad(object_part(&object, MATERIAL_GROUND, v3(0.1f, 0.08f, 0.06f)), v3(-half, y, half),
              v3(half, y, half), v3(half, y, -half), v3(-half, y, -half));
    object_place(world, &object, "bedrock");
}

static void stream_add(struct world *world)
{
    struct object object;
    object_begin(&object, glms_mat4_identity());
    struct mesh *mesh = object_part(&object, MATERIAL_WATER, v3(0.03f, 0.06f, 0.065f));
    for (int x = -HALF_M; x < HALF_M; x += 8) {
        const float x0 = (float)x, x1 = (float)(x + 8), z0 = world_stream_z(x0), z1 = world_stream_z(x1);
        mesh_quad(mesh, v3(x0, -1, z0 + 7), v3(x1, -1, z1 + 7), v3(x1, -1, z1 - 7), v3(x0, -1, z0 - 7));
    }
    object_place(world, &object, "stream");
}

void world_terrain_add(struct world *world)
{
    for (int j = 0; j < CHUNKS; j++)
        for (int i = 0; i < CHUNKS; i++)
            chunk_add(world, i, j);
    stream_add(world);
    bedrock_add(world);
}
