/* SPDX-License-Identifier: MIT
 * Begins the reflections of a picture: lists the tiles that the filter takes, in which a surface is smooth
 * but no mirror, and the pixels that send a ray: those of a grid, and those that are unlike the pixels of the
 * grid around them. A workgroup takes a square of tiles, a thread a pixel of each. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "../include/sdfgi_reflection_rays.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;

/* Share of the four pixels around, by their weights, that must be like a pixel that sends no ray. */
const float ENOUGH_LIKE = 0.4;

/* A workgroup takes squares of so many tiles a side: fewer workgroups count in the same words. */
const int SIDE = SDFGI_GROUP_TILES / SDFGI_GROUP_PIXELS;
const uint TILES = uint(SIDE * SIDE);

shared uint is_filtered, first_tile; /* a bit for each tile that the filter takes; place of the first */
shared uint senders[2u * TILES];     /* a bit for each pixel that sends a ray, two words a tile */
shared uint first_ray;               /* place of the first of these rays */
shared uint rays_before[2u * TILES]; /* how many of them are in words before each */

/* True if a pixel sends a ray of its own. */
bool sends_ray(ivec2 pixel, picture_surface s, float roughness)
{
    const int step = picture_ray_step(roughness);
    if (picture_is_on_grid(pixel, step))
        return true;
    const ivec2 at = pixel & (step - 1);
    const vec2 t = vec2(at) / float(step);
    const picture_comparison to = picture_compare(s, roughness, float(SDFGI_RAYS_SIDE * step), pixel - at);
    float like = 0.0;
    for (int i = 0; i < 4; i++) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 near = mix(1.0 - t, t, vec2(corner));
        if (near.x * near.y > 0.0)
            like += near.x * near.y * picture_likeness(to, pixel - at + step * corner);
    }
    return like < ENOUGH_LIKE;
}

/* Where a tile lies, in tiles. */
ivec2 tile_at(uint tile)
{
    return SIDE * ivec2(gl_WorkGroupID.xy) + ivec2(tile % uint(SIDE), tile / uint(SIDE));
}

/* The pixel of this thread in a tile. */
ivec2 pixel_of(uint tile)
{
    return SDFGI_GROUP_PIXELS * tile_at(tile) + ivec2(gl_LocalInvocationID.xy);
}

/* Looks at a pixel of a tile. True if it sends a ray. */
bool look_at(uint tile)
{
    const ivec2 pixel = pixel_of(tile);
    picture_surface s;
    float roughness;
    if (!picture_reflects(pixel, s, roughness))
        return false;
    if (roughness > picture_mirror_end())
        atomicOr(is_filtered, 1u << tile);
    if (sends_ray(pixel, s, roughness))
        return true;
    imageStore(reflection_image, pixel, vec4(0.0, 0.0, 0.0, PICTURE_NO_RAY));
    return false;
}

/* Notes that this thread's pixel of a tile sends a ray. */
void note_sender(uint tile)
{
    const uint i = gl_LocalInvocationIndex;
    atomicOr(senders[2u * tile + (i >> 5u)], 1u << (i & 31u));
}

/* PICTURE_DENSE if half of the pixels between those of the grid send rays, in the square of this thread's
 * pixel. Squares have two or four pixels a side, and tiles rows of eight. */
uint density(uint tile)
{
    const uvec2 corner = gl_LocalInvocationID.xy & ~(args.ray_step - 1u);
    const uint row = (1u << args.ray_step) - 1u, square = row * (args.ray_step == 2u ? 0x101u : 0x1010101u),
               sending = senders[2u * tile + (corner.y >> 2u)] >> (corner.x + 8u * (corner.y & 3u)) & square;
    const bool dense = 2 * (bitCount(sending) - 1) >= bitCount(square) - 1;
    return args.ray_step > 1u && dense ? PICTURE_DENSE : 0u;
}

/* How many rays the words before one have. */
uint count_rays_before(uint word)
{
    uint sum = 0u;
    for (uint i = 0u; i < word; i++)
        sum += uint(bitCount(senders[i]));
    return sum;
}

/* Makes room for the tiles and their rays. */
void make_room()
{
    const uint rays = count_rays_before(2u * TILES);
    if (gl_WorkGroupID.xy == uvec2(0u))
        for (uint i = 1u; i <= 2u; i++)
            sdfgi_tiles[uint(SDFGI_TILES_RAYS) + i] = sdfgi_tiles[uint(SDFGI_TILES_TILES) + i] = 1u;
    const uint tiles = uint(bitCount(is_filtered));
    if (tiles + rays == 0u)
        return;
    first_tile = atomicAdd(sdfgi_tiles[TILES_COUNT], tiles);
    atomicMax(sdfgi_tiles[SDFGI_TILES_TILES], min(first_tile + tiles, uint(SDFGI_MAX_GROUPS)));
    first_ray = atomicAdd(sdfgi_tiles[RAYS_COUNT], rays);
    const uint groups = (first_ray + rays + uint(SDFGI_GROUP_REFLECT) - 1u) / uint(SDFGI_GROUP_REFLECT);
    atomicMax(sdfgi_tiles[SDFGI_TILES_RAYS], min(groups, uint(SDFGI_MAX_GROUPS)));
}

void list_tile(uint tile)
{
    const uint before = is_filtered & (1u << tile) - 1u;
    if ((is_filtered >> tile & 1u) != 0u)
        sdfgi_tiles[picture_tile_word(first_tile + uint(bitCount(before)))] = picture_pack(tile_at(tile));
}

/* Lists the ray of this thread's pixel of a tile, if it sends one. Rays are in the order of their pixels:
 * those of a subgroup go similar ways. */
void list_ray(uint tile)
{
    const uint i = gl_LocalInvocationIndex, word = 2u * tile + (i >> 5u), bit = 1u << (i & 31u),
               sending = senders[word];
    if ((sending & bit) != 0u)
        sdfgi_tiles[picture_ray_word(first_ray + rays_before[word] + uint(bitCount(sending & bit - 1u)))] =
            picture_pack(pixel_of(tile)) | density(tile);
}

void main()
{
    const uint i = gl_LocalInvocationIndex;
    if (i == 0u)
        is_filtered = 0u;
    if (i < 2u * TILES)
        senders[i] = 0u;
    barrier();
    for (uint tile = 0u; tile < TILES; tile++)
        if (look_at(tile))
            note_sender(tile);
    barrier();
    if (i == 0u)
        make_room();
    if (i < 2u * TILES)
        rays_before[i] = count_rays_before(i);
    barrier();
    if (i < TILES)
        list_tile(i);
    for (uint tile = 0u; tile < TILES; tile++)
        list_ray(tile);
}
