/* SPDX-License-Identifier: MIT */
#include "texture_maker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh_builder.h"
#include "noise.h"
#include "random.h"

enum { SIZE = 256 };

/* What a texture is at one point of the unit square. */
struct sample {
    vec3s color; /* sRGB, [0, 1] */
    float alpha;
    float height; /* of the relief, in tile widths */
};

typedef struct sample (*sample_fn)(uint32_t seed, float u, float v);

static struct sample gray(float value)
{
    return (struct sample){ .color = v3(value, value, value), .alpha = 1 };
}

static struct sample tinted(vec3s color, float value, float height)
{
    return (struct sample){ .color = glms_vec3_scale(color, value), .alpha = 1, .height = height };
}

static struct sample ground_sample(uint32_t seed, float u, float v)
{
    const float coarse = noise_fractal(seed, 8 * u, 8 * v, 8, 4);
    const float grain = noise_value(seed + 9, 128 * u, 128 * v, 128);
    return gray(0.86f + 0.14f * coarse + 0.07f * grain);
}

static struct sample plaster_sample(uint32_t seed, float u, float v)
{
    return gray(0.94f + 0.07f * noise_fractal(seed, 6 * u, 6 * v, 6, 5));
}

static struct sample woven_sample(uint32_t seed, float u, float v)
{
    const float weave = sinf(u * 2 * GLM_PIf * 48) * sinf(v * 2 * GLM_PIf * 48);
    return gray(0.9f + 0.07f * weave + 0.05f * noise_value(seed, 64 * u, 64 * v, 64));
}

/* Distance to the edge of a brick, in units of a row, for bricks in rows shifted by half a brick. */
static float brick_edge(float u, float v, float columns, float rows, uint32_t *id)
{
    const float row = floorf(v * rows);
    const float x = u * columns + 0.5f * (float)((int)row & 1), column = floorf(x);
    const float aspect = rows / columns;
    const float dx = fminf(x - column, column + 1 - x) * aspect;
    const float dy = fminf(v * rows - row, row + 1 - v * rows);
    *id = random_hash3(17, (uint32_t)((int)column % (int)columns), (uint32_t)row);
    return fminf(dx, dy);
}

static struct sample stone_sample(uint32_t seed, float u, float v)
{
    uint32_t id;
    const float warp = 0.012f * noise_fractal(seed + 3, 6 * u, 6 * v, 6, 2);
    const float edge = brick_edge(u + warp, v + warp + 1, 4, 8, &id);
    const float block = smooth_step(0.05f, 0.16f, edge);
    const float rough = noise_fractal(seed, 16 * u, 16 * v, 16, 4);
    const float tone = 0.62f + 0.16f * random_unit(id) + 0.13f * rough;
    const vec3s warm = v3(1, 0.94f + 0.05f * random_unit(random_hash(id)), 0.86f);
    return tinted(warm, mix(0.52f, tone, block), 0.016f * block + 0.006f * rough);
}

static struct sample tiles_sample(uint32_t seed, float u, float v)
{
    const float rows = 8, columns = 8, row = floorf(v * rows);
    const float x = u * columns + 0.5f * (float)((int)row & 1);
    const float across = x - floorf(x) - 0.5f, down = v * rows - row;
    const uint32_t id = random_hash3(seed, (uint32_t)((int)floorf(x) % 8), (uint32_t)row);
    const float gap = smooth_step(0.5f, 0.44f, fabsf(across)) * smooth_step(0, 0.1f, down);
    const float tone =
        mix(0.35f, 0.78f + 0.22f * random_unit(id), gap) + 0.06f * noise_value(seed, 64 * u, 64 * v, 64);
    return tinted(v3(1, 1, 1), tone, 0.03f * down + 0.02f * gap * cosf(across * GLM_PIf));
}

static struct sample planks_sample(uint32_t seed, float u, float v)
{
    const float boards = 6, x = u * boards, board = floorf(x), across = x - board;
    const uint32_t id = random_hash3(seed, (uint32_t)((int)board % 6), 5);
    const float gap = smooth_step(0, 0.05f, fminf(across, 1 - across));
    const float grain = noise_fractal(seed + (id & 255), 48 * u, 3 * v, 0, 3) * smooth_step(0, 0.2f, v) *
                        smooth_step(0, 0.2f, 1 - v);
    const float tone = mix(0.3f, 0.78f + 0.15f * random_unit(id) + 0.2f * grain, gap);
    return tinted(v3(1, 1, 1), tone, 0.006f * gap + 0.003f * grain);
}

/* Distance to the border between the two nearest of a jittered grid's points, which tiles after `cells`. */
static float cell_border(uint32_t seed, float x, float y, int cells, uint32_t *id)
{
    const int ix = (int)floorf(x), iy = (int)floorf(y);
    float nearest = 9, second = 9;
    for (int j = iy - 1; j <= iy + 1; j++)
        for (int i = ix - 1; i <= ix + 1; i++) {
            const uint32_t hash =
                random_hash3(seed, (uint32_t)((i + cells) % cells), (uint32_t)((j + cells) % cells));
            const float px = (float)i + 0.2f + 0.6f * random_unit(hash);
            const float py = (float)j + 0.2f + 0.6f * random_unit(random_hash(hash));
            const float d = sqrtf((px - x) * (px - x) + (py - y) * (py - y));
            if (d < nearest) {
                second = nearest;
                nearest = d;
                *id = hash;
            } else {
                second = fminf(second, d);
            }
        }
    return second - nearest;
}

static struct sample cobbles_sample(uint32_t seed, float u, float v)
{
    uint32_t id = 0;
    const float border = cell_border(seed, 10 * u, 10 * v, 10, &id);
    const float stone = smooth_step(0.03f, 0.3f, border);
    const float tone =
        mix(0.3f, 0.55f + 0.2f * random_unit(id), stone) + 0.06f * noise_value(seed, 64 * u, 64 * v, 64);
    return tinted(v3(0.98f, 0.97f, 1), tone, 0.03f * sqrtf(stone));
}

static struct sample bark_sample(uint32_t seed, float u, float v)
{
    const float ridge = fabsf(noise_fractal(seed, 16 * u, 4 * v, 4, 4));
    return tinted(v3(1, 1, 1), 0.5f + 0.9f * ridge, 0.03f * ridge);
}

/* ---- Cut-outs ---------------------------------------------------------------------------------------- */

/* Coverage of an ellipse at (x, y) turned by `angle`: a leaf that narrows towards its tip. */
static float leaf_cover(float u, float v, float x, float y, float angle, float length, float width)
{
    const float dx = u - x, dy = v - y;
    const float along = (dx * cosf(angle) + dy * sinf(angle)) / length;
    const float side = (dy * cosf(angle) - dx * sinf(angle)) / width;
    if (along < 0 || along > 1)
        return 0;
    return smooth_step(0.0f, 0.25f, sinf(along * GLM_PIf) - fabsf(side));
}

static struct sample leaves_sample(uint32_t seed, float u, float v)
{
    struct sample sample = { .color = v3(0.75f, 0.8f, 0.6f) };
    struct random random = { seed };
    for (int i = 0; i < 80; i++) {
        const float x = random_range(&random, 0.06f, 0.8f), y = random_range(&random, 0.1f, 0.9f);
        const float angle = random_range(&random, -1.2f, 1.2f), length = random_range(&random, 0.11f, 0.19f);
        const float tone = random_range(&random, 0.72f, 1);
        const float cover = leaf_cover(u, v, x, y, angle, length, length * 0.28f);
        if (cover < 0.5f)
            continue;
        sample.alpha = cover;
        sample.color = v3(tone * 0.92f, tone, tone * 0.78f);
    }
    return sample;
}

static struct sample needles_sample(uint32_t seed, float u, float v)
{
    /* A bough from the left edge to the right, side twigs at a slant, narrower towards the tip. */
    const float reach = 0.46f * (1 - u) + 0.05f, off = fabsf(v - 0.5f);
    const float twig = u * 22 - off * 16;
    const float comb = fabsf(twig - floorf(twig) - 0.5f);
    const float tone = 0.72f + 0.28f * noise_value(seed, 32 * u, 32 * v, 32);
    const bool stem = off < 0.012f, inside = off < reach && u < 0.98f && u > 0.01f;
    const float cover = inside && (stem || comb < 0.34f) ? 1.0f : 0.0f;
    return (struct sample){ .color = v3(tone * 0.8f, tone, tone * 0.8f), .alpha = cover };
}

static struct sample grass_sample(uint32_t seed, float u, float v)
{
    struct sample sample = { .color = v3(0.8f, 0.9f, 0.5f) };
    struct random random = { seed + 77 };
    const float up = 1 - v;
    for (int i = 0; i < 34; i++) {
        const float x = random_range(&random, 0.08f, 0.92f), lean = random_range(&random, -0.16f, 0.16f);
        const float top = random_range(&random, 0.45f, 0.98f), tone = random_range(&random, 0.65f, 1);
        const float at = up / top, center = x + lean * at * at;
        if (at > 1 || fabsf(u - center) > 0.016f * (1.02f - at))
            continue;
        sample.alpha = 1;
        sample.color = v3(tone * mix(0.75f, 1, at), tone, tone * 0.55f);
    }
    return sample;
}

/* ---- Drawing ----------------------------------------------------------------------------------------- */

static const struct texture_info {
    const char *name;
    sample_fn sample;
    bool relief, cutout;
} infos[TEXTURE_KIND_COUNT] = {
    [TEXTURE_GROUND] = { "ground", ground_sample, false, false },
    [TEXTURE_PLASTER] = { "plaster", plaster_sample, false, false },
    [TEXTURE_STONE] = { "stone", stone_sample, true, false },
    [TEXTURE_TILES] = { "tiles", tiles_sample, true, false },
    [TEXTURE_PLANKS] = { "planks", planks_sample, true, false },
    [TEXTURE_COBBLES] = { "cobbles", cobbles_sample, true, false },
    [TEXTURE_BARK] = { "bark", bark_sample, true, false },
    [TEXTURE_WOVEN] = { "woven", woven_sample, false, false },
    [TEXTURE_LEAVES] = { "leaves", leaves_sample, false, true },
    [TEXTURE_NEEDLES] = { "needles", needles_sample, false, true },
    [TEXTURE_GRASS] = { "grass", grass_sample, false, true },
};

static uint8_t byte_from_unit(float value)
{
    return (uint8_t)lrintf(255 * clamp01(value));
}

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    if (!memory) {
        fprintf(stderr, "out of memory while drawing a texture\n");
        exit(EXIT_FAILURE);
    }
    return memory;
}

static void color_draw(const struct texture_info *info, uint32_t seed, uint8_t *texels, float *heights)
{
    const uint32_t channels = info->cutout ? 4 : 3;
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        const float u = ((float)(i % SIZE) + 0.5f) / SIZE, v = ((float)(i / SIZE) + 0.5f) / SIZE;
        const struct sample sample = info->sample(seed, u, v);
        for (uint32_t c = 0; c < 3; c++)
            texels[channels * i + c] = byte_from_unit(sample.color.raw[c]);
        if (info->cutout)
            texels[channels * i + 3] = byte_from_unit(sample.alpha);
        heights[i] = sample.height;
    }
}

/* Tangent-space normals of the relief, +Y up in the texture as glTF has it. */
static void normal_draw(const float *heights, uint8_t *texels)
{
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        const uint32_t x = i % SIZE, y = i / SIZE;
        const float dx = heights[y * SIZE + (x + 1) % SIZE] - heights[y * SIZE + (x + SIZE - 1) % SIZE];
        const float dy = heights[(y + 1) % SIZE * SIZE + x] - heights[(y + SIZE - 1) % SIZE * SIZE + x];
        const vec3s n = glms_vec3_normalize(v3(-dx * SIZE / 2, dy * SIZE / 2, 1));
        for (uint32_t c = 0; c < 3; c++)
            texels[3 * i + c] = byte_from_unit(0.5f + 0.5f * n.raw[c]);
    }
}

struct texture_pair texture_make(struct glb_writer *writer, enum texture_kind kind, uint32_t seed)
{
    const struct texture_info *info = &infos[kind];
    uint8_t *texels = allocate(4 * SIZE * SIZE);
    float *heights = allocate(sizeof(float) * SIZE * SIZE);
    struct texture_pair pair = { 0 };
    color_draw(info, random_hash(seed), texels, heights);
    pair.color = glb_writer_add_texture(writer, info->name, SIZE, SIZE, info->cutout ? 4 : 3, texels);
    if (info->relief) {
        normal_draw(heights, texels);
        pair.normal = glb_writer_add_texture(writer, info->name, SIZE, SIZE, 3, texels);
    }
    free(texels);
    free(heights);
    return pair;
}
