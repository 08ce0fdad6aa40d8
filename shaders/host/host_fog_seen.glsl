/* SPDX-License-Identifier: MIT
 * What of the froxels somebody sees. Depth is linear over planes. Needs host_fog_space.glsl. */

/* Per column. x: the least depth in the tile between this column and the next ones. y: the depth where the
 * column is; zw: its change per tile along x and y, that of the surface there. */
layout(set = HOST_SET_FOG, binding = 4, std430) readonly buffer seen_block
{
    vec4 seen[];
};

/* Of the distance to a surface, where light is looked up for fog that would be behind it. */
const float FOG_INSIDE = 0.99;

float fog_distance_of_depth(float depth)
{
    return depth > 0.0 ? min(camera_distance_of_depth(depth), FOG_SKY_M) : FOG_SKY_M;
}

/* Metres to the farthest surface in the tiles from `low` to `high`; `columns` is how many the grid has. */
float fog_reach(ivec2 low, ivec2 high, ivec2 columns)
{
    float depth = 1.0;
    for (int y = max(low.y, 0); y <= min(high.y, columns.y - 2); y++) {
        for (int x = max(low.x, 0); x <= min(high.x, columns.x - 2); x++)
            depth = min(depth, seen[x + columns.x * y].x);
    }
    return fog_distance_of_depth(depth);
}

/* The distance at which light is looked up for fog at `distance_m`, `offset` columns from a column. No pixel
 * shows what is farther off than `reach`. Where the surface at the column goes on, pixels up to `around`
 * columns away show fog at distances at which the column is already below it: there, light above it will do.
 * Behind a silhouette, fog is where it is. */
float fog_lit_distance(vec4 column, vec2 offset, float around, float distance_m, float reach)
{
    const float surface = FOG_INSIDE * fog_distance_of_depth(column.y + dot(column.zw, offset));
    const float goes_on = 1.1 * fog_distance_of_depth(column.y - around * (abs(column.z) + abs(column.w)));
    const float within = min(distance_m, FOG_INSIDE * reach);
    return within > surface && within < goes_on ? surface : within;
}
