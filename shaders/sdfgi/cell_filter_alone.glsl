/* SPDX-License-Identifier: MIT
 * A thread per light cell. For software drivers, which run few threads at once. */
#ifndef SDFGI_CELL_FILTER_ALONE_GLSL
#define SDFGI_CELL_FILTER_ALONE_GLSL

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

void filter_cell(uint cascade, uint entry)
{
    const ivec3 cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, entry)));
    if (!sdfgi_cell_is_valid(cascade, cell))
        return;
    const float noise = gathered_load_shown_noise(cascade, entry);
    uint own[6];
    vec4 gained[6]; /* light, and the sum of shares */
    for (uint axis = 0u; axis < 6u; axis++) {
        own[axis] = filtered_word(cascade, axis, entry);
        gained[axis] = vec4(0.0);
    }
    for (int i = 0; i < 9; i++) {
        const row r = load_row(cascade, cell, entry, noise, i);
        for (uint axis = 0u; axis < 6u; axis++)
            if (own[axis] < SDFGI_SURFACE_UNKNOWN)
                gained[axis] += gain_from_row(cascade, r, axis, sdfgi_rgbe_decode(own[axis]));
    }
    for (uint axis = 0u; axis < 6u; axis++)
        filter_store(cascade, axis, entry, filter_result(own[axis], gained[axis]));
}

void filter_cells()
{
    uint cascade, entry;
    if (visit_or_entry(workgroup_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, cascade, entry))
        filter_cell(cascade, entry);
}

#endif
