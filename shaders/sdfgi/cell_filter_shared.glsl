/* SPDX-License-Identifier: MIT
 * A workgroup takes SDFGI_FILTER_CELLS light cells: first a thread per cell and row of neighbours, then one
 * per cell and axis. Rows are added in order, as if one thread went over all of them. Shared memory: 13.5
 * KiB. */
#ifndef SDFGI_CELL_FILTER_SHARED_GLSL
#define SDFGI_CELL_FILTER_SHARED_GLSL

const uint CELLS = uint(SDFGI_FILTER_CELLS), ROWS = 9u;
layout(local_size_x = 9 * SDFGI_FILTER_CELLS) in;

/* Three neighbours in a row, or the cell itself in place of one that is no light cell. */
struct row {
    uint entries[3];
    float likely[3]; /* relative differences */
    bool there[3];
};

/* The i-th of nine rows. They, and places in them, go from -1 to 1 times the distance. Everything is loaded
 * before it is needed: loads overlap, so that a thread waits once for three of them. */
row load_row(uint cascade, ivec3 cell, uint entry, float noise, int i)
{
    row r;
    for (int k = 0; k < 3; k++) {
        const ivec3 away = ivec3(k, i % 3, i / 3) - 1, at = cell + FILTER_DISTANCE * away;
        uint other;
        const bool is_light = sdfgi_cell_entry(cascade, at, other);
        r.there[k] = is_light && sdfgi_cell_is_valid(cascade, at) && away != ivec3(0);
        r.entries[k] = r.there[k] ? other : entry;
    }
    for (int k = 0; k < 3; k++)
        r.likely[k] = likely_difference(noise + gathered_load_shown_noise(cascade, r.entries[k]));
    return r;
}

/* What a surface gains from those of a row along an axis, and the sum of shares. */
vec4 gain_from_row(uint cascade, row r, uint axis, vec3 own)
{
    uint words[3];
    for (int k = 0; k < 3; k++)
        words[k] = filtered_word(cascade, axis, r.entries[k]);
    vec4 gained = vec4(0.0);
    for (int k = 0; k < 3; k++) {
        const vec3 other = sdfgi_rgbe_decode(words[k]);
        if (words[k] < SDFGI_SURFACE_UNKNOWN && r.there[k])
            gained += gain_from(own, other, r.likely[k]);
    }
    return gained;
}

shared vec4 gained[6u * ROWS * CELLS];

uint gained_slot(uint axis, uint row, uint own)
{
    return (axis * ROWS + row) * CELLS + own;
}

void gain(uint cascade, uint entry, ivec3 cell, uint row_index, uint own)
{
    const row r = load_row(cascade, cell, entry, gathered_load_shown_noise(cascade, entry), int(row_index));
    for (uint axis = 0u; axis < 6u; axis++) {
        const uint word = filtered_word(cascade, axis, entry);
        if (word < SDFGI_SURFACE_UNKNOWN)
            gained[gained_slot(axis, row_index, own)] =
                gain_from_row(cascade, r, axis, sdfgi_rgbe_decode(word));
    }
}

vec4 sum_of_rows(uint axis, uint own)
{
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < ROWS; i++)
        sum += gained[gained_slot(axis, i, own)];
    return sum;
}

void filter_cells()
{
    const uint own = gl_LocalInvocationIndex % CELLS, part = gl_LocalInvocationIndex / CELLS;
    uint cascade, entry;
    bool there = visit_or_entry(workgroup_index() * CELLS + own, cascade, entry);
    ivec3 cell = ivec3(0);
    if (there)
        cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, entry)));
    there = there && sdfgi_cell_is_valid(cascade, cell);
    if (there)
        gain(cascade, entry, cell, part, own);
    barrier();
    if (!there || part >= 6u)
        return;
    const uint word = filtered_word(cascade, part, entry);
    filter_store(cascade, part, entry, filter_result(word, sum_of_rows(part, own)));
}

#endif
