/* SPDX-License-Identifier: MIT
 * A thread per light cell. For software drivers, which run few threads at once: a thread goes over the
 * surfaces that its cell has, and for each over those neighbours that are light cells. */
#ifndef SDFGI_CELL_FILTER_ALONE_GLSL
#define SDFGI_CELL_FILTER_ALONE_GLSL

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

const uint NEIGHBOURS = 27u, ITSELF = 13u;

/* The row of three that a neighbour is in: a third of its number, without a division. */
uint row_of(uint neighbour)
{
    return neighbour * 11u >> 5u;
}

ivec3 place_of(ivec3 cell, uint neighbour)
{
    const uint row = row_of(neighbour), layer = row_of(row);
    const uvec3 away = uvec3(neighbour - 3u * row, row - 3u * layer, layer);
    return cell + FILTER_DISTANCE * (ivec3(away) - 1);
}

/* The neighbours that are light cells, a bit each. */
uint light_neighbours(uint cascade, ivec3 cell)
{
    uint neighbours = 0u, other;
    for (uint i = SDFGI_FIRST; i < NEIGHBOURS; i++) {
        const ivec3 at = place_of(cell, i);
        const bool there = sdfgi_cell_entry(cascade, at, other) && sdfgi_cell_is_valid(cascade, at);
        neighbours |= uint(there) << i;
    }
    return neighbours & ~(1u << ITSELF);
}

/* What a surface gains from all neighbours along an axis, and the sum of shares. Rows are added up first, as
 * cell_filter_shared.glsl does. */
vec4 gain_of(uint cascade, ivec3 cell, uint neighbours, float noise, uint axis, vec3 own)
{
    vec4 gained = vec4(0.0), of_row = vec4(0.0);
    uint row = 0u;
    while (neighbours != 0u) {
        const uint i = uint(findLSB(neighbours));
        uint other;
        sdfgi_cell_entry(cascade, place_of(cell, i), other);
        const float likely = likely_difference(noise + gathered_load_shown_noise(cascade, other));
        const uint word = filtered_word(cascade, axis, other);
        const vec4 gain =
            word < SDFGI_SURFACE_UNKNOWN ? gain_from(own, sdfgi_rgbe_decode(word), likely) : vec4(0.0);
        const bool same = row_of(i) == row;
        gained += same ? vec4(0.0) : of_row;
        of_row = (same ? of_row : vec4(0.0)) + gain;
        row = row_of(i);
        neighbours &= neighbours - 1u;
    }
    return gained + of_row;
}

/* Stores surfaces of which nothing is known as they are; the others, a bit each. */
uint known_surfaces(uint cascade, uint entry)
{
    uint known = 0u;
    for (uint axis = SDFGI_FIRST; axis < 6u; axis++) {
        const uint word = filtered_word(cascade, axis, entry);
        known |= uint(word < SDFGI_SURFACE_UNKNOWN) << axis;
        if (word >= SDFGI_SURFACE_UNKNOWN)
            filter_store(cascade, axis, entry, word);
    }
    return known;
}

void filter_cell(uint cascade, uint entry, ivec3 cell)
{
    const float noise = gathered_load_shown_noise(cascade, entry);
    const uint neighbours = light_neighbours(cascade, cell);
    uint surfaces = known_surfaces(cascade, entry);
    do { /* a cell of which nothing is known goes round once, for nothing */
        const uint axis = uint(findLSB(surfaces | 1u << 5u)), own = filtered_word(cascade, axis, entry);
        const vec4 gained = gain_of(cascade, cell, neighbours, noise, axis, sdfgi_rgbe_decode(own));
        if (surfaces != 0u)
            filter_store(cascade, axis, entry, filter_result(own, gained));
        surfaces &= surfaces - 1u;
    } while (surfaces != 0u);
}

void filter_cells()
{
    uint cascade, entry;
    if (!visit_or_entry(workgroup_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, cascade, entry))
        return;
    const ivec3 cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, entry)));
    if (sdfgi_cell_is_valid(cascade, cell))
        filter_cell(cascade, entry, cell);
}

#endif
