/* SPDX-License-Identifier: MIT
 * Voxelises a mesh instance into one cascade. Each thread of a workgroup culls one triangle against the box;
 * then the columns of those that are left are shared out evenly, whichever triangle they belong to. The
 * triangles of a workgroup lie far apart in the mesh: neighbours, which lie in the box together, go to
 * different ones. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxelize_common.glsl"

layout(local_size_x = SDFGI_GROUP_TRIANGLE) in;

shared ivec4 places[SDFGI_GROUP_TRIANGLE]; /* of each thread's triangle: first column, columns in a row,
                                              dominant axis */
shared uint ends[SDFGI_GROUP_TRIANGLE];    /* how many columns it and those before it have */

/* From one thread to the next, groups are shifted against each other by about the golden section of their
 * number: no rows of a grid of triangles line up with it. */
uint triangle_of(uint group, uint thread)
{
    const uint shift = args.groups * 5u / 8u | 1u;
    return thread * args.groups + (group + thread * shift) % args.groups;
}

/* How many columns of a thread's triangle are to be tested; where they are goes to its place. */
uint triangle_cull(uint t_index, uint thread)
{
    vec3 v[3];
    triangle t;
    if (t_index >= args.triangle_count)
        return 0u;
    if (!triangle_fetch(t_index, v, t.index)) {
        if (gl_WorkGroupID.y == 0u)
            counter_add(SDFGI_COUNTER_TRIANGLES_SKIPPED, 1u);
        return 0u;
    }
    if (!triangle_place(t, v))
        return 0u;
    const ivec2 size = t.columns.zw - t.columns.xy + 1;
    places[thread] = ivec4(t.columns.xy, size.x, t.axis);
    return uint(size.x * size.y);
}

/* Sums of all threads up to each. */
void sum_columns(uint thread, uint count)
{
    ends[thread] = count;
    barrier();
    for (uint reach = 1u; reach < uint(SDFGI_GROUP_TRIANGLE); reach *= 2u) {
        const uint before = thread >= reach ? ends[thread - reach] : 0u;
        barrier();
        ends[thread] += before;
        barrier();
    }
}

/* The thread whose triangle has the column: the first that ends beyond it. */
uint holder_of(uint column)
{
    uint low = 0u;
    for (uint reach = uint(SDFGI_GROUP_TRIANGLE) / 2u; reach > 0u; reach /= 2u)
        low += ends[low + reach - 1u] <= column ? reach : 0u;
    return low;
}

/* Columns [first, last) of one triangle, counted as all are. */
void store_columns(uint group, uint holder, uint first, uint last)
{
    const ivec4 place = places[holder];
    const uint begin = holder > 0u ? ends[holder - 1u] : 0u;
    vec3 v[3];
    triangle t;
    triangle_fetch(triangle_of(group, holder), v, t.index);
    t.axis = place.w;
    triangle_setup(t, v);
    for (uint i = first - begin; i < last - begin; i++)
        triangle_store_column(t, place.xy + ivec2(i % uint(place.z), i / uint(place.z)));
}

void main()
{
    const uint group = gl_WorkGroupID.x + gl_WorkGroupID.z * args.group_width;
    const uint thread = gl_LocalInvocationIndex;
    if (group >= args.groups)
        return;
    sum_columns(thread, triangle_cull(triangle_of(group, thread), thread));

    const uint total = ends[SDFGI_GROUP_TRIANGLE - 1], threads = args.slices * uint(SDFGI_GROUP_TRIANGLE);
    const uint share = (total + threads - 1u) / threads;
    const uint first = (gl_WorkGroupID.y * uint(SDFGI_GROUP_TRIANGLE) + thread) * share,
               last = min(first + share, total);
    for (uint i = first; i < last;) {
        const uint holder = holder_of(i), next = min(ends[holder], last);
        store_columns(group, holder, i, next);
        i = next;
    }
}
