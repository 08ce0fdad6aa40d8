/* SPDX-License-Identifier: MIT
 * Resolves the accumulators of each albedo block (2x2x2 cells) to two albedos, emission and normals. The
 * emissive bits tell which sub-voxels emit. One thread per albedo block of the box. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_SURFACE
#define SDFGI_WRITES_EMISSION
#define SDFGI_WRITES_EMITTERS
#include "../lib/on_cpu.glsl"
#include "accumulators.glsl"
#include "block_slices.glsl"
#include "dirty_bounds.glsl"
#include "emitter_shapes.glsl"
#include "surface.glsl"
#include "surface_front.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_region_args);

voxel_part resolved_part()
{
    return voxel_part(args.low, args.high);
}

uint accumulated(uint plane, uint block)
{
    return sdfgi_scratch_at(accumulator(resolved_part(), plane, block));
}

vec3 accumulated3(uint plane, uint block)
{
    return vec3(accumulated(plane, block), accumulated(plane + 1u, block), accumulated(plane + 2u, block));
}

/* Sums of accumulate_wide in voxelize_common.glsl. */
vec3 accumulated_wide3(uint plane, uint block)
{
    vec3 sum;
    for (uint i = 0u; i < 3u; i++)
        sum[i] = float(accumulated(plane + 2u * i + 1u, block)) * SDFGI_EMISSION_UPPER +
                 float(accumulated(plane + 2u * i, block)) * SDFGI_EMISSION_STEP;
    return sum;
}

/* ---- Albedo */

/* Columns of sub-voxels that a side of a block sees. */
const float COLUMNS = 64.0;
/* Sides whose colours differ by less show their mean: what is painted in one colour is exact. */
const float LEAST_CONTRAST = 1.0 / 64.0;

struct color_sum {
    vec3 sum;
    float count; /* of samples */
};

color_sum albedo_sum(uint side, uint layer, uint block)
{
    const uint plane = accumulator_albedo(side, layer);
    return color_sum(accumulated3(plane, block), float(accumulated(plane + 3u, block)));
}

float contrast(vec3 a, vec3 b)
{
    const vec3 difference = abs(a - b);
    return max(difference.r, max(difference.g, difference.b));
}

vec3 mean_albedo(color_sum from)
{
    return from.sum / (max(from.count, 1.0) * SDFGI_ALBEDO_STEPS);
}

/* A side with more samples than columns, in this ratio, has a surface before another. */
const float LAYERED = 1.25;
/* Fronts whose mean differs by less tell no more than the mean of all samples, which has more digits. */
const float FRONT_CONTRAST = 0.02;

/* What a side shows first, if surfaces hide others of the same cells: a mean of its fronts. */
color_sum without_hidden(uint side, uint block, color_sum all, float samples)
{
    vec3 sum = vec3(0.0);
    float fronts = 0.0;
    for (uint i = SDFGI_ZERO; i < FRONTS; i++) {
        const uint packed = accumulated(SDFGI_ACCUM_FRONT + FRONTS * side + i, block);
        sum += front_color(packed);
        fronts += float(packed != 0u);
    }
    const vec3 shown = sum / max(fronts, 1.0);
    const bool layered = samples > LAYERED * COLUMNS / float(FRONTS) * fronts;
    return layered && contrast(shown, mean_albedo(all)) > FRONT_CONTRAST
               ? color_sum(shown * SDFGI_ALBEDO_STEPS * all.count, all.count)
               : all;
}

/* What is seen from a side: the layer of cells that is nearer to the viewer, and behind it as much of the
 * other one as that leaves open. */
color_sum albedo_from(uint side, uint block)
{
    const uint nearer = 1u - (side & 1u);
    const color_sum front = albedo_sum(side, nearer, block), back = albedo_sum(side, 1u - nearer, block);
    const float open = clamp((COLUMNS - front.count) / max(back.count, 1.0), 0.0, 1.0);
    const color_sum all = color_sum(front.sum + open * back.sum, front.count + open * back.count);
    return all.count > 0.0 ? without_hidden(side, block, all, front.count + back.count) : all;
}

/* Two colours for the six sides: that of the side of which most is seen, and that of the side which differs
 * most from it. The others show the one that is more like theirs, and sides that nothing faces the first. */
uvec2 resolve_albedo(uint block)
{
    color_sum seen[6], most = color_sum(vec3(0.0), 0.0), all = most;
    [[unroll]] for (uint side = SDFGI_ZERO; side < 6u; side++)
    {
        seen[side] = albedo_from(side, block);
        all = color_sum(all.sum + seen[side].sum, all.count + seen[side].count);
        if (seen[side].count > most.count)
            most = seen[side];
    }
    const vec3 first = mean_albedo(most);
    vec3 other = first;
    [[unroll]] for (uint side = SDFGI_ZERO; side < 6u; side++)
    {
        const vec3 mean = mean_albedo(seen[side]);
        if (seen[side].count > 0.0 && contrast(mean, first) > contrast(other, first))
            other = mean;
    }
    if (contrast(other, first) < LEAST_CONTRAST)
        return surface_pack_albedo(mean_albedo(all), vec3(0.0), 0u);
    uint sides = 0u;
    color_sum second = color_sum(vec3(0.0), 0.0);
    [[unroll]] for (uint side = SDFGI_ZERO; side < 6u; side++)
    {
        const vec3 mean = mean_albedo(seen[side]);
        if (seen[side].count > 0.0 && contrast(mean, other) < contrast(mean, first)) {
            sides |= 1u << side;
            second = color_sum(second.sum + seen[side].sum, second.count + seen[side].count);
        }
    }
    return surface_pack_albedo(mean_albedo(color_sum(all.sum - second.sum, all.count - second.count)),
                               mean_albedo(second), sides);
}

/* ---- Normals */

/* The kind of metal that most samples of a block show; 0: none. */
uint resolve_metal(uint block, uint samples)
{
    const uint count = accumulated(SDFGI_ACCUM_METAL, block),
               sum = accumulated(SDFGI_ACCUM_METAL + 1u, block);
    return 2u * count > samples ? (sum + count / 2u) / count : 0u;
}

/* One normal for each dominant axis: two slopes of 5 bits, means over the samples. And the kind of metal. */
uint resolve_normals(uint block, uint samples)
{
    uint packed = resolve_metal(block, samples) << SURFACE_METAL_SHIFT;
    for (uint major = SDFGI_ZERO; major < 3u; major++) {
        const uint plane = SDFGI_ACCUM_NORMAL + 3u * major;
        const uint count = accumulated(plane, block);
        uint slopes = SURFACE_NO_NORMAL;
        if (count > 0u) {
            const vec2 sum = vec2(int(accumulated(plane + 1u, block)), int(accumulated(plane + 2u, block)));
            const uvec2 q =
                uvec2(round(clamp(sum / (float(count) * SDFGI_SLOPE_STEPS), -1.0, 1.0) * 15.0) + 15.0);
            slopes = q.x | q.y << 5u;
        }
        packed |= slopes << (10u * major);
    }
    return packed;
}

/* Per cell (bit 0 of the index: x, bit 1: y, bit 2: z) its occupancy bits, its emissive bits, and those that
 * emit along an axis. */
uvec2 block_bits[8];
uvec2 block_emissive[8];
uvec2 block_facing[3][8];
/* Of those that emit, and the slice of the box around them along each axis. */
emitter_bounds block_bounds;
uvec2 block_box[3];

/* What one side of the block shows. */
struct side_view {
    uint seen;    /* lines of sight, of 64, that meet a set sub-voxel */
    uint emits;   /* those that meet what emits along them */
    uint walls;   /* those that meet what emits, but along other axes */
    uint reaches; /* those that would meet what emits along them if nothing but walls were there */
    uint inside;  /* those that meet something within the bounds of what emits */
    float depth;  /* mean depth behind the side, in sub-voxels, of what emits */
};

/* Each line of sight along the axis sees the first set sub-voxel that it meets. An emitter a sub-voxel before
 * a wall, or on one side of it, therefore keeps its power whatever lies behind it. `side` is +x -x +y -y +z
 * -z, and a constant where loops are unrolled. */
side_view view_from(uint side)
{
    const int axis = int(side >> 1u);
    uvec2 hidden = uvec2(0u), facing = uvec2(0u), walls = uvec2(0u);
    uint emits = 0u, inside = 0u, depths = 0u;
    [[unroll]] for (int i = int(SDFGI_ZERO); i < 8; i++)
    {
        const int depth = (side & 1u) == 0u ? 7 - i : i;
        const uvec2 first = slice_of_block(block_bits, axis, depth) & ~hidden,
                    faces = slice_of_block(block_facing[axis], axis, depth);
        const uint count = slice_count(first & faces);
        emits += count;
        const bool within = uint(depth) >= block_bounds.low[axis] && uint(depth) <= block_bounds.high[axis];
        inside += within ? slice_count(first & block_box[axis]) : 0u;
        depths += count * uint(i);
        hidden |= first;
        facing |= faces;
        walls |= first & slice_of_block(block_emissive, axis, depth) & ~faces;
    }
    return side_view(slice_count(hidden), emits, slice_count(walls), slice_count(facing & ~walls), inside,
                     float(depths) / float(max(emits, 1u)));
}

/* ---- Emission */

/* Loads the bits of the block that begins at a cell. */
void load_block(ivec3 first)
{
    [[unroll]] for (uint i = SDFGI_ZERO; i < 8u; i++)
    {
        const ivec3 cell = first + ivec3(i & 1u, i >> 1u & 1u, i >> 2u);
        block_bits[i] = sdfgi_cell_bits(args.cascade, cell);
        block_emissive[i] = uvec2(0u);
        [[unroll]] for (int axis = int(SDFGI_ZERO); axis < 3; axis++)
        {
            const uint word = emissive_word(resolved_part(), axis, cell);
            block_facing[axis][i] = uvec2(sdfgi_scratch_at(word), sdfgi_scratch_at(word + 1u));
            block_emissive[i] |= block_facing[axis][i];
        }
    }
}

void load_bounds()
{
    [[unroll]] for (int axis = int(SDFGI_ZERO); axis < 3; axis++)
    {
        const uvec2 ends = slices_bounds(block_emissive, axis);
        block_bounds.low[axis] = ends.x;
        block_bounds.high[axis] = ends.y;
    }
    [[unroll]] for (int axis = int(SDFGI_ZERO); axis < 3; axis++)
    {
        block_box[axis] = slice_of_box(axis, block_bounds.low, block_bounds.high);
    }
}

/* What the six sides show of an emitter. */
struct emitter_view {
    float areas[6];  /* that emit, in columns */
    float depths[6]; /* as in side_view */
    float largest;   /* of the areas */
    float projected; /* sum of the areas, in squares of a sub-voxel's width */
    uint inside;     /* the shares of lines that end within the emitter's bounds: emitter_share_pack */
};

/* Area of the triangles that face a side, in columns. They cover their sub-voxels in part. */
float facing_area(uint block, uint side)
{
    return float(accumulated(SDFGI_ACCUM_EMISSION_SIDES + side, block)) / SDFGI_AREA_STEPS;
}

/* Of lines that meet an emitter its area covers a part: at most all of it, however many layers lie there. */
float covered_part(float area, side_view shown)
{
    return min(area / float(max(shown.reaches, 1u)), 1.0);
}

/* Where a wall that emits stands on a floor that emits everywhere, lines through the wall see no face, and
 * what is in the room never sees along them: they do not count. */
float lines_along_walls(float covered, side_view shown)
{
    return float(shown.walls) * clamp(10.0 * covered - 9.0, 0.0, 1.0);
}

/* True if an emitter fills its box badly: it lies deep behind a face, like a room's corner in which floor and
 * walls emit. */
bool is_hollow(emitter_view view)
{
    bool hollow = false;
    [[unroll]] for (uint side = SDFGI_ZERO; side < 6u; side++)
    {
        const uint axis = side >> 1u,
                   face = (side & 1u) == 0u ? 7u - block_bounds.high[axis] : block_bounds.low[axis];
        const float behind = view.depths[side] - float(face),
                    half_width = 0.5 * float(block_bounds.high[axis] - block_bounds.low[axis] + 1u);
        hollow = hollow || (view.areas[side] > 0.2 * view.largest && behind > half_width);
    }
    return hollow;
}

/* Where the block's emissive sub-voxels are, and what the sides show of them and of their surroundings. */
void store_emitter_shape(uint block, ivec3 first, emitter_view view)
{
    if (sdfgi_frame.emitter_samples == 0u)
        return;
    const float area = float(accumulated(SDFGI_ACCUM_EMISSION_AREA, block)) / SDFGI_AREA_STEPS;
    const float fill = is_hollow(view) ? 0.0 : area / max(view.projected, 1e-6);
    const uint word = emitter_shape_word(args.cascade, sdfgi_albedo_block_index(args.cascade, first));
    sdfgi_emitters[word] = emitter_shape_pack(block_bounds, fill);
    sdfgi_emitters[word + 1u] = view.inside;
}

/* Emission of the brightest side, and the six sides relative to it, 5 bits each. */
uvec2 resolve_emission(uint block, ivec3 first)
{
    load_block(first);
    load_bounds();
    emitter_view view;
    view.largest = view.projected = 0.0;
    view.inside = 0u;
    float fractions[6], largest = 0.0, all_sides = 0.0;
    [[unroll]] for (uint side = SDFGI_ZERO; side < 6u; side++)
    {
        const side_view shown = view_from(side);
        const float facing = facing_area(block, side);
        all_sides += facing;
        const float covered = covered_part(facing, shown), along_walls = lines_along_walls(covered, shown),
                    seen = max(float(shown.seen) - along_walls, 1.0);
        fractions[side] = covered * float(shown.emits) / seen;
        view.inside |= emitter_share_pack(max(float(shown.inside) - along_walls, 1.0) / seen, side);
        largest = max(largest, fractions[side]);
        view.areas[side] = fractions[side] * float(shown.seen);
        view.depths[side] = shown.depth;
        view.largest = max(view.largest, view.areas[side]);
        view.projected += view.areas[side] * slices_column_area(int(side >> 1u));
    }
    store_emitter_shape(block, first, view);
    /* Relative to the largest, because that of a lamp in a thousandth of its block would round to 0. */
    uint packed = 0u;
    for (uint side = 0u; side < 6u && largest > 0.0; side++)
        packed |= uint(round(31.0 * fractions[side] / largest)) << (5u * side);
    const vec3 mean = accumulated_wide3(SDFGI_ACCUM_EMISSION, block) / max(all_sides, 1e-6);
    return surface_pack_emission(mean * largest, packed);
}

/* ---- Blocks */

uint samples_in(uint block)
{
    return accumulated(SDFGI_ACCUM_NORMAL, block) + accumulated(SDFGI_ACCUM_NORMAL + 3u, block) +
           accumulated(SDFGI_ACCUM_NORMAL + 6u, block);
}

bool emits(uint block)
{
    return emission_is_kept() && accumulated(SDFGI_ACCUM_EMISSION_AREA, block) > 0u;
}

uint out_index(ivec3 cell)
{
    return sdfgi_albedo_block_index(args.cascade, cell) + args.cascade * sdfgi_albedo_block_count();
}

/* Stores the surfaces of a block that has samples. */
void store_surfaces(ivec3 cell, uint block)
{
    sdfgi_albedo[out_index(cell)] = resolve_albedo(block);
    sdfgi_normals[out_index(cell)] = resolve_normals(block, samples_in(block));
    if (args.bounds_axis >= 0)
        bounds_add(args.cascade, BOUNDS_ADDED, args.bounds_axis, cell, cell + 2);
}

void store_no_surfaces(ivec3 cell)
{
    sdfgi_albedo[out_index(cell)] = uvec2(0u);
    sdfgi_normals[out_index(cell)] = SURFACE_NO_NORMALS;
}

/* The first cell of the i-th block. False if there is none. */
bool block_at(uint i, out ivec3 cell)
{
    const uvec3 size = uvec3(args.high - args.low) / 2u;
    cell = args.low + 2 * ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y));
    return i < size.x * size.y * size.z;
}

#ifdef SDFGI_SOFTWARE
/* Software drivers run what is under a condition in any case, but a loop only as often as one of its threads
 * needs. Most blocks have no samples: a thread looks at several, and resolves those that have. */
void main()
{
    const uint first =
        SDFGI_RESOLVE_BLOCKS * SDFGI_GROUP_LINEAR * workgroup_index() + gl_LocalInvocationIndex;
    ivec3 cell;
    uint filled = 0u, emissive = 0u, voxels = 0u;
    for (uint k = SDFGI_ZERO; k < SDFGI_RESOLVE_BLOCKS; k++) {
        if (!block_at(first + k * SDFGI_GROUP_LINEAR, cell))
            break;
        const uint block = part_block(resolved_part(), cell), samples = samples_in(block);
        store_no_surfaces(cell);
        sdfgi_emission[out_index(cell)] = uvec2(0u);
        filled |= uint(samples > 0u) << k;
        emissive |= uint(emits(block)) << k;
        voxels += samples;
    }
    for (; filled != 0u; filled &= filled - 1u) {
        block_at(first + uint(findLSB(filled)) * SDFGI_GROUP_LINEAR, cell);
        store_surfaces(cell, part_block(resolved_part(), cell));
    }
    for (; emissive != 0u; emissive &= emissive - 1u) {
        block_at(first + uint(findLSB(emissive)) * SDFGI_GROUP_LINEAR, cell);
        sdfgi_emission[out_index(cell)] = resolve_emission(part_block(resolved_part(), cell), cell);
    }
    if (voxels > 0u)
        counter_add(SDFGI_COUNTER_VOXELS, voxels);
}
#else
/* Samples in the blocks of the workgroup, so that one atomic adds them to the counter. */
shared uint voxels;

void resolve(ivec3 cell)
{
    const uint block = part_block(resolved_part(), cell), samples = samples_in(block);
    if (samples > 0u)
        store_surfaces(cell, block);
    else
        store_no_surfaces(cell);
    uvec2 emission = uvec2(0u);
    if (emits(block))
        emission = resolve_emission(block, cell);
    sdfgi_emission[out_index(cell)] = emission;
    if (samples > 0u)
        atomicAdd(voxels, samples);
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        voxels = 0u;
    barrier();
    ivec3 cell;
    if (block_at(workgroup_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, cell))
        resolve(cell);
    barrier();
    if (gl_LocalInvocationIndex == 0u && voxels > 0u)
        counter_add(SDFGI_COUNTER_VOXELS, voxels);
}
#endif
