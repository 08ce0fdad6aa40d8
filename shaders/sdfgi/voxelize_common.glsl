/* SPDX-License-Identifier: MIT
 * Voxelisation of one triangle. The compute and the raster voxeliser share it. They set the same bits, and
 * differ only in which thread visits which column.
 *
 * Half of the sub-voxel that a surface lies in is before the surface, in the mean. Rooms would be too small
 * by a sub-voxel, and their lamps too bright. Each triangle is therefore moved behind its front side, along
 * its dominant axis, by its inset: half a sub-voxel. Skirts join each edge to its moved twin, so that
 * neighbours that move along different axes leave no gap.
 *
 * A sub-voxel is set if the moved triangle or a skirt crosses one of three segments through its centre. The
 * segments are one sub-voxel long and parallel to the axes. This is the 6-separating set (Schwarz and Seidel
 * 2010, "Fast parallel surface and solid voxelization"; Huang et al. 1998). A path between the centres of two
 * face neighbours that crosses a closed mesh crosses it on one of these segments, so no 6-connected path
 * leads through the mesh. A column is a line of sub-voxels along the triangle's dominant axis. Emitters set
 * more: every column that they cover in part.
 *
 * Loops test at their end: software drivers go through a loop that tests at its beginning once more than is
 * needed. */
#include "voxelize_material.glsl"
#include "accumulators.glsl" /* what voxelize_material.glsl includes says what is written */
#include "surface_front.glsl"

/* In sub-voxels. Points this far outside an edge count as inside, so that rounding cannot open a seam between
 * triangles that share the edge. */
const float EDGE_MARGIN = 1.0 / 256.0;
/* In sub-voxels. Both sides of a panel thinner than half a sub-voxel would change places, and one would hide
 * what the other emits. Emitters have no inset. */
const float INSET = 0.5;
/* In sub-voxels, added to insets: a surface exactly between two sub-voxels sets the one behind it, however
 * the transform rounds. */
const float TIE_BIAS = 1.0 / 2048.0;
/* In sub-voxels: half the length of the segments of a sub-voxel's centre cross. */
const float SEGMENT = 0.5 + EDGE_MARGIN;
/* Triangles of smaller slopes are taken as parallel to the faces of sub-voxels: as flat. */
const float FLAT_SLOPE = 1.0 / 64.0;
/* Of the cross-section of a column: more than rounding makes of an emitter's edge on the border of two. */
const float LEAST_COVERED = 1.0 / 1024.0;
/* Emitters of smaller slopes do not face along an axis: the walls of a room that is turned a little do not
 * face up. */
const float LEAST_SLOPE = 0.1;

struct triangle {
    vec3 v[3];                   /* sub-voxels from the anchor; axes permuted so that z is the dominant one */
    vec2 slope;                  /* dz/dx, dz/dy */
    vec3 edges[3];               /* inside where dot(edge, (x, y, 1)) >= 0, in sub-voxels */
    vec3 bary_x, bary_y, bary_0; /* barycentric coordinates = bary_0 + x bary_x + y bary_y */
    vec3 normal;                 /* metric, unit, front side */
    int axis;                    /* dominant axis */
    uint index[3];
    ivec4 columns; /* to test: low corner in xy, high corner in zw, both included */
    bool tiny;     /* smaller than a sub-voxel: always sets the one that its centre lies in */
    float inset;   /* along the dominant axis, negative if the front faces down */
    float area2;   /* twice its area in the plane of the columns, in sub-voxels^2 */
    triangle_material material;
};

vec3 permute(vec3 p, int axis)
{
    return axis == 0 ? p.yzx : (axis == 1 ? p.zxy : p.xyz);
}

ivec3 permute(ivec3 p, int axis)
{
    return axis == 0 ? p.yzx : (axis == 1 ? p.zxy : p.xyz);
}

ivec3 unpermute(ivec3 p, int axis)
{
    return axis == 0 ? p.zxy : (axis == 1 ? p.yzx : p.xyz);
}

/* Finds the dominant axis and the columns to test. False if the triangle has no area or misses the box. Only
 * the range of columns depends on the box and on the place of the cascade. A sub-voxel is therefore the same
 * whether a scroll or a rebuild sets it. */
bool triangle_place(inout triangle t, vec3 v[3])
{
    const ivec3 box_low = box_corner(args.box_low), box_high = box_corner(args.box_high);
    const vec3 low = min(v[0], min(v[1], v[2]));
    const vec3 high = max(v[0], max(v[1], v[2]));
    if (any(lessThan(high, vec3(box_low) - 1.0)) || any(greaterThan(low, vec3(box_high) + 1.0)))
        return false;
    const vec3 height = abs(cross(v[1] - v[0], v[2] - v[0]));
    const float largest = max(height.x, max(height.y, height.z));
    if (!(largest > 1e-12))
        return false;
    t.axis = height.x >= largest ? 0 : (height.y >= largest ? 1 : 2);
    /* The triangle crosses one of the three segments only if a column's centre is inside it, or a point up to
     * half a sub-voxel beside the centre along x or y. */
    const vec2 first = max(permute(low, t.axis).xy - 1.0 - EDGE_MARGIN, vec2(permute(box_low, t.axis).xy));
    const vec2 last = min(permute(high, t.axis).xy + EDGE_MARGIN, vec2(permute(box_high, t.axis).xy - 1));
    t.columns = ivec4(ivec2(ceil(first)), ivec2(floor(last)));
    return t.columns.x <= t.columns.z && t.columns.y <= t.columns.w;
}

/* Fills the rest of a triangle whose dominant axis is known. */
void triangle_setup(inout triangle t, vec3 v[3])
{
    const vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
    const vec3 n = permute(normal, t.axis);
    t.slope = -n.xy / n.z;
    for (int i = 0; i < 3; i++)
        t.v[i] = permute(v[i], t.axis);
    for (int i = 0; i < 3; i++) {
        /* Both triangles that share the edge compute it from the same end, so that they round it alike. */
        const vec2 a = t.v[i].xy, b = t.v[(i + 1) % 3].xy;
        const bool turned = b.x < a.x || (b.x == a.x && b.y < a.y);
        const vec2 from = turned ? b : a, along = turned ? a - b : b - a;
        const vec2 inward = vec2(-along.y, along.x) / max(length(along), 1e-20);
        t.edges[i] = (turned ? -sign(n.z) : sign(n.z)) * vec3(inward, -dot(inward, from));
    }
    const vec2 a = t.v[0].xy, ab = t.v[1].xy - a, ac = t.v[2].xy - a;
    const float det = ab.x * ac.y - ab.y * ac.x;
    const vec2 to_b = vec2(ac.y, -ac.x) / det, to_c = vec2(-ab.y, ab.x) / det;
    t.bary_x = vec3(-to_b.x - to_c.x, to_b.x, to_c.x);
    t.bary_y = vec3(-to_b.y - to_c.y, to_b.y, to_c.y);
    t.bary_0 = vec3(1.0, 0.0, 0.0) - a.x * t.bary_x - a.y * t.bary_y;
    t.area2 = abs(det);

    /* Back to metric lengths, because cells may be flat, and to the mesh's front side. */
    const vec3 metric = normal / vec3(1.0, sdfgi_space_y_scale(), 1.0);
    t.normal = normalize(metric) * (drawn.reversed ? -1.0 : 1.0);
    t.material = material_load(t.index, t.area2);
    const bool emits = t.material.params.emission != vec3(0.0);
    t.inset = sign(t.normal[t.axis]) * (TIE_BIAS + (emits ? 0.0 : INSET));
    t.tiny = all(lessThan(max(v[0], max(v[1], v[2])) - min(v[0], min(v[1], v[2])), vec3(1.0)));
}

bool triangle_contains(triangle t, vec2 p)
{
    for (int i = 0; i < 3; i++)
        if (!(dot(t.edges[i], vec3(p, 1.0)) >= -EDGE_MARGIN))
            return false;
    return true;
}

/* Height of the triangle's plane along the dominant axis. */
float triangle_height(triangle t, vec2 p)
{
    return t.v[0].z + dot(t.slope, p - t.v[0].xy);
}

/* The column that holds the centre of a tiny triangle. */
ivec2 tiny_column(triangle t)
{
    return ivec2(floor((t.v[0].xy + t.v[1].xy + t.v[2].xy) / 3.0));
}

/* Levels of a column: sub-voxels along the dominant axis, both included; none if the last lies below the
 * first. */
struct column_levels {
    int first, last;
};

/* Height of the inset triangle's plane. */
float inset_height(triangle t, vec2 p)
{
    return triangle_height(t, p) - t.inset;
}

/* The level that it crosses. Outside the triangle its plane may lead beyond all integers. */
int inset_level(triangle t, vec2 p)
{
    return int(floor(clamp(inset_height(t, p), -MAX_COORDINATE, MAX_COORDINATE)));
}

/* The part of the line through `centre` along `axis` (0 or 1) that lies in the triangle, widened by `margin`:
 * from x to y from the centre, or x > y. */
vec2 triangle_section(triangle t, vec2 centre, int axis, float margin)
{
    vec2 section = vec2(-1.0, 1.0);
    for (int i = 0; i < 3; i++) {
        const float inside = dot(t.edges[i], vec3(centre, 1.0)) + margin, rise = t.edges[i][axis];
        if (rise > 0.0)
            section.x = max(section.x, -inside / rise);
        else if (rise < 0.0)
            section.y = min(section.y, -inside / rise);
        else if (!(inside >= 0.0))
            return vec2(1.0, -1.0);
    }
    return section;
}

/* Adds the levels whose segment along `axis` crosses the inset triangle, or the skirt of an edge. What lies
 * over that line is one stretch of heights: the inset triangle's and, at each edge, up to the edge itself. */
void levels_add_crossed(triangle t, vec2 centre, int axis, inout column_levels levels)
{
    const vec2 wide = triangle_section(t, centre, axis, EDGE_MARGIN);
    if (wide.x > SEGMENT || wide.y < -SEGMENT || wide.x > wide.y)
        return;
    vec2 section = triangle_section(t, centre, axis, 0.0);
    if (section.x > section.y)
        section = vec2(0.5 * (wide.x + wide.y));
    float low = 1e30, high = -1e30;
    for (int i = 0; i < 2; i++) {
        vec2 p = centre;
        p[axis] += clamp(section[i], -SEGMENT, SEGMENT);
        const float inset = inset_height(t, p),
                    edge = abs(section[i]) <= SEGMENT ? triangle_height(t, p) : inset;
        low = min(low, min(inset, edge));
        high = max(high, max(inset, edge));
    }
    levels.first = min(levels.first, int(ceil(low - SEGMENT)));
    levels.last = max(levels.last, int(floor(high - 1.0 + SEGMENT)));
}

/* The levels that a column sets. The inset triangles and the skirts of a closed mesh are closed, and this is
 * their 6-separating set. Flat triangles need no skirts: where they meet, their sub-voxels touch at edges,
 * which suffices. */
column_levels triangle_levels(triangle t, ivec2 column)
{
    const vec2 centre = vec2(column) + 0.5;
    const int level = inset_level(t, centre);
    column_levels levels = column_levels(level, level);
    if (!((t.tiny && all(equal(column, tiny_column(t)))) || triangle_contains(t, centre)))
        levels = column_levels(0x7fffffff, -0x7fffffff);
    if (max(abs(t.slope.x), abs(t.slope.y)) > FLAT_SLOPE) {
        levels_add_crossed(t, centre, 0, levels);
        levels_add_crossed(t, centre, 1, levels);
    }
    return levels;
}

/* The surface at the centre of a column. */
surface_sample triangle_sample(triangle t, ivec2 column)
{
    const vec2 p = vec2(column) + 0.5;
    vec3 bary = clamp(t.bary_0 + p.x * t.bary_x + p.y * t.bary_y, 0.0, 1.0);
    bary /= max(bary.x + bary.y + bary.z, 1e-20);
    return material_sample(t.material, bary);
}

voxel_part drawn_part()
{
    return voxel_part(unpacked_corner(args.box_low), unpacked_corner(args.box_high));
}

void accumulate(uint plane, uint block, uint value)
{
    if (value != 0u)
        atomicAdd(sdfgi_scratch[accumulator(drawn_part(), plane, block)], value);
}

/* False if sums of a block are so large that they might wrap: thousands of surfaces lie in it one on the
 * other. Their mean is known well enough then. What is left out is counted. */
bool has_room(uint plane, uint block, uint limit)
{
    const bool room = sdfgi_scratch_at(accumulator(drawn_part(), plane, block)) < limit;
    if (!room)
        counter_add(SDFGI_COUNTER_SAMPLES_CUT, 1u);
    return room;
}

/* Keeps the sample if it is the front of its columns. `sub` counts sub-voxels from the cascade's first. */
void accumulate_front(triangle t, ivec3 sub, uint block, uint side, vec3 albedo)
{
    const ivec3 at = sub - drawn.anchor;
    const ivec2 column = permute(at, t.axis).xy;
    const float above = sdfgi_finite_clamp(inset_height(t, vec2(column) + 0.5) - float(at[t.axis]), 0.0, 1.0);
    const uint major = side >> 1u;
    const float level = float(sub[major] & 7) + (int(major) == t.axis ? above : 0.5),
                height = (side & 1u) == 0u ? level : 8.0 - level;
    const uvec2 in_block = uvec2(sub[(major + 1u) % 3u], sub[(major + 2u) % 3u]) & 7u;
    const uint plane = SDFGI_ACCUM_FRONT + FRONTS * side + front_of_columns(in_block);
    atomicMax(sdfgi_scratch[accumulator(drawn_part(), plane, block)], front_pack(height, in_block, albedo));
}

/* Sums are integers, so that they do not depend on the order of additions. */
void accumulate_surface(triangle t, ivec3 sub, uint block, surface_sample s)
{
    const ivec3 cell = sub >> 2;
    const vec3 height = abs(t.normal);
    const uint major = height.x >= height.y && height.x >= height.z ? 0u : (height.y >= height.z ? 1u : 2u);
    if (!has_room(SDFGI_ACCUM_NORMAL + 3u * major, block, SDFGI_ACCUM_MOST_SAMPLES))
        return;
    const bool negative = t.normal[major] < 0.0;
    const uint facing = 2u * major + uint(negative),
               plane = accumulator_albedo(facing, uint(cell[major] & 1));
    const vec3 color = sdfgi_finite_color(s.albedo.rgb, 1.0);
    const uvec3 albedo = uvec3(color * SDFGI_ALBEDO_STEPS + 0.5);
    accumulate_front(t, sub, block, facing, color);
    uint channel = SDFGI_ZERO;
    do
        accumulate(plane + channel, block, albedo[channel]);
    while (++channel < 3u);
    accumulate(plane + 3u, block, 1u);
    const float side = negative ? -1.0 : 1.0;
    accumulate(SDFGI_ACCUM_NORMAL + 3u * major, block, 1u);
    const uint metal = s.flags >> SDFGI_MATERIAL_METAL_SHIFT & 3u;
    accumulate(SDFGI_ACCUM_METAL, block, min(metal, 1u));
    accumulate(SDFGI_ACCUM_METAL + 1u, block, metal);
    uint next = 1u + SDFGI_ZERO;
    do {
        const float slope =
            sdfgi_finite_clamp(t.normal[(major + next) % 3u] * side / height[major], -1.0, 1.0);
        accumulate(SDFGI_ACCUM_NORMAL + 3u * major + next, block,
                   uint(int(round(slope * SDFGI_SLOPE_STEPS))));
    } while (++next <= 2u);
}

/* The part of a column that a triangle covers. */
struct covered_part {
    float area;  /* of the column's cross-section */
    vec2 centre; /* where the triangle's plane is looked at: the column's centre if that is covered */
};

/* Integrals of y, of x y and of y^2 / 2 over x, along a line from `a` to `b`. */
vec3 line_integrals(vec2 a, vec2 b)
{
    return (b.x - a.x) * vec3((a.y + b.y) / 2.0, (a.x * (2.0 * a.y + b.y) + b.x * (a.y + 2.0 * b.y)) / 6.0,
                              (a.y * a.y + a.y * b.y + b.y * b.y) / 6.0);
}

/* The same along the part of a line whose x lies in [0, 1], with y cut to [0, 1]. Over the edges of a polygon
 * they sum up to the area that it has in common with the unit square, and to that times the centroid (Green's
 * theorem). A polygon that is clipped needs an array of corners, for which software drivers took four times
 * as long for all triangles. */
vec3 edge_integrals(vec2 a, vec2 b)
{
    const float slope = b.x != a.x ? (b.y - a.y) / (b.x - a.x) : 0.0;
    const vec2 x = clamp(vec2(a.x, b.x), 0.0, 1.0);
    const vec2 y = vec2(a.y, b.y) + (x - vec2(a.x, b.x)) * slope, cut = clamp(y, 0.0, 1.0);
    /* Where the line enters the square and leaves it, as shares of its way from x.x to x.y. */
    const float rise = y.y - y.x;
    vec2 shares = vec2(0.0, 1.0);
    if (rise != 0.0)
        shares = clamp((vec2(rise > 0.0 ? 0.0 : 1.0, rise > 0.0 ? 1.0 : 0.0) - y.x) / rise, 0.0, 1.0);
    const vec2 inside = mix(x.xx, x.yy, shares);
    return line_integrals(vec2(x.x, cut.x), vec2(inside.x, cut.x)) +
           line_integrals(vec2(inside.x, cut.x), vec2(inside.y, cut.y)) +
           line_integrals(vec2(inside.y, cut.y), vec2(x.y, cut.y));
}

covered_part triangle_covers(triangle t, ivec2 column)
{
    const vec2 middle = vec2(column) + 0.5;
    if (t.tiny)
        return covered_part(all(equal(column, tiny_column(t))) ? 0.5 * t.area2 : 0.0, middle);
    vec2 from = t.v[0].xy - vec2(column), to = t.v[1].xy - vec2(column), next = t.v[2].xy - vec2(column);
    vec3 sums = vec3(0.0);
    uint edge = SDFGI_ZERO;
    do {
        sums += edge_integrals(from, to);
        const vec2 last = from;
        from = to;
        to = next;
        next = last;
    } while (++edge < 3u);
    const bool aside = sums.x != 0.0 && !triangle_contains(t, middle);
    return covered_part(min(abs(sums.x), 1.0),
                        aside ? vec2(column) + clamp(sums.yz / sums.x, 0.0, 1.0) : middle);
}

/* Adds a value, in W/(m^2 sr) times the area of a column, to a sum of 64 bits. The lower word carries over
 * into the upper one, whatever the order of additions. */
void accumulate_wide(uint plane, uint block, float value)
{
    const float upper = floor(value / SDFGI_EMISSION_UPPER);
    const uint lower = uint((value - upper * SDFGI_EMISSION_UPPER) / SDFGI_EMISSION_STEP + 0.5);
    const uint word = accumulator(drawn_part(), plane, block),
               before = lower != 0u ? atomicAdd(sdfgi_scratch[word], lower) : 0u;
    accumulate(plane + 1u, block, uint(upper) + uint(before + lower < before));
}

/* Adds what a triangle emits from the part of a column that it covers, to each side as much as that sees. */
void accumulate_emission(triangle t, float covered, uint block, surface_sample s)
{
    const bool both = (s.flags & SDFGI_MATERIAL_DOUBLE_SIDED_EMISSION) != 0u;
    const float sides = both ? 2.0 : 1.0, column = t.axis == 1 ? 1.0 : sdfgi_space_y_scale();
    const vec3 seen = covered * vec3(1.0, abs(t.slope)); /* along the dominant axis and the next two */
    const vec3 emission =
        sdfgi_finite_color(s.emission, SDFGI_EMISSION_MOST) * sides * (seen.x + seen.y + seen.z);
    if (all(lessThan(emission, vec3(SDFGI_EMISSION_STEP))) ||
        !has_room(SDFGI_ACCUM_EMISSION_AREA, block, SDFGI_ACCUM_MOST_AREA))
        return;
    uint channel = SDFGI_ZERO;
    do
        accumulate_wide(SDFGI_ACCUM_EMISSION + 2u * channel, block, emission[channel]);
    while (++channel < 3u);
    const float area = sides * covered * column / max(abs(t.normal[t.axis]), 0.1);
    accumulate(SDFGI_ACCUM_EMISSION_AREA, block, uint(area * SDFGI_AREA_STEPS + 0.5));
    int n = int(SDFGI_ZERO);
    do {
        const int axis = (t.axis + n) % 3;
        const uint front = 2u * uint(axis) + (t.normal[axis] < 0.0 ? 1u : 0u),
                   steps = uint(seen[n] * SDFGI_AREA_STEPS + 0.5);
        accumulate(SDFGI_ACCUM_EMISSION_SIDES + front, block, steps);
        if (both)
            accumulate(SDFGI_ACCUM_EMISSION_SIDES + (front ^ 1u), block, steps);
    } while (++n < 3);
}

/* Notes that a sub-voxel emits, and along which axes. */
void store_emitter(triangle t, ivec3 cell, uint bit)
{
    int n = int(SDFGI_ZERO);
    do {
        const int axis = (t.axis + n) % 3;
        const uint word = emissive_word(drawn_part(), axis, cell) + (bit >> 5u);
        if (n == 0 || abs(t.slope[max(n, 1) - 1]) > LEAST_SLOPE)
            atomicOr(sdfgi_scratch[word], 1u << (bit & 31u));
    } while (++n < 3);
}

/* Sub-voxels of a cell's second word must not look like the mark of empty boxes: one more is set then.
 * `bits`: those that the word has had since. */
void keep_from_mark(uint cell, uint bits)
{
    if ((bits & SDFGI_BOXES_MARK) == SDFGI_BOXES_MARK)
        atomicOr(sdfgi_bits[cell].y, SDFGI_BOXES_MARK_OTHER);
}

/* On a GPU a test spares the atomic, because many triangles may share a sub-voxel and their atomics would
 * wait for one another (HARD_CASES row 17). On a CPU each test and each branch takes as long as an atomic. */
void store_bit(uint cell, uint bit)
{
    const uint word_bit = 1u << (bit & 31u);
#ifdef SDFGI_SOFTWARE
    const uint bits = atomicOr(sdfgi_bits[cell][bit >> 5u], word_bit) | word_bit;
    keep_from_mark(cell, bit < 32u ? 0u : bits);
#else
    if (bit < 32u) {
        if ((sdfgi_bits_at(cell).x & word_bit) == 0u)
            atomicOr(sdfgi_bits[cell].x, word_bit);
    } else if ((sdfgi_bits_at(cell).y & word_bit) == 0u) {
        keep_from_mark(cell, atomicOr(sdfgi_bits[cell].y, word_bit) | word_bit);
    }
#endif
}

/* Sets the sub-voxel at `from_anchor`. */
void store_sub_voxel(triangle t, ivec3 from_anchor, surface_sample s)
{
    const ivec3 sub = from_anchor + drawn.anchor, cell = sub >> 2, inner = sub & 3;
    const uint block = part_block(drawn_part(), cell);
    const uint bit = uint(inner.x + 4 * inner.y + 16 * inner.z);
    store_bit(sdfgi_cell_index(args.cascade, cell), bit);
    accumulate_surface(t, sub, block, s);
    if (emission_is_kept() && s.emission != vec3(0.0))
        store_emitter(t, cell, bit);
}

/* Tests one column of those that lie in the box, and stores the sample that the triangle has there. Emitters
 * set columns whose centre they miss, too: rays must find all that emits, or a lamp would lose power where
 * its rim misses centres. */
void triangle_store_column(triangle t, ivec2 column)
{
    const bool emits = emission_is_kept() && t.material.params.emission != vec3(0.0);
    const int low = permute(box_corner(args.box_low), t.axis).z,
              high = permute(box_corner(args.box_high), t.axis).z;
    covered_part part = covered_part(0.0, vec2(column) + 0.5);
    if (emits)
        part = triangle_covers(t, column);
    const int level = inset_level(t, part.centre);
    const bool emits_here = part.area > 0.0 && level >= low && level < high;
    const column_levels levels = triangle_levels(t, column);
    const int first = max(levels.first, low), last = min(levels.last, high - 1);
    if (first > last && !emits_here)
        return;
    const surface_sample s = triangle_sample(t, column);
    if (s.albedo.a < t.material.params.alpha_cutoff)
        return;
    const ivec3 emitting = unpermute(ivec3(column, level), t.axis);
    if (emits_here)
        accumulate_emission(t, part.area, part_block(drawn_part(), (emitting + drawn.anchor) >> 2), s);
    const bool apart = emits_here && part.area > LEAST_COVERED && (level < first || level > last);
    const int count = first > last ? 0 : last - first + 1;
    if (!apart && count == 0)
        return;
    int i = apart ? -1 : 0;
    do
        store_sub_voxel(t, unpermute(ivec3(column, i < 0 ? level : first + i), t.axis), s);
    while (++i < count);
}
