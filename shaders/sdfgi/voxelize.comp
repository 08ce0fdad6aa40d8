/* SPDX-License-Identifier: MIT
 * Voxelises instances of a mesh into one cascade. Triangles are numbered instance after instance. Each thread
 * of a workgroup culls one triangle against the box. Then the threads share the columns of the remaining
 * triangles evenly, whichever triangle they belong to. The triangles of a workgroup have numbers far apart,
 * because neighbours lie in the box together and would give one workgroup most of the work. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "voxelize_common.glsl"

layout(local_size_x = SDFGI_GROUP_TRIANGLE) in;

/* Per thread, of its triangle. Columns of a workgroup are numbered, triangle after triangle. */
shared ivec4 ranges[SDFGI_GROUP_TRIANGLE]; /* low corner of its columns, their width, dominant axis */
shared uint ends[SDFGI_GROUP_TRIANGLE];    /* number of its last column, plus 1 */

/* Groups of triangles. */
uint group_count()
{
    return (args.triangle_count * args.draw_count - 1u) / uint(SDFGI_GROUP_TRIANGLE) + 1u;
}

/* The triangle of a thread. Thread i of all groups reads the i-th part of them. From part to part the
 * order of the groups is shifted by about the golden ratio of their number, so that the rows of a grid of
 * triangles do not meet in one group. */
uint triangle_of(uint group, uint thread)
{
    const uint groups = group_count(), shift = groups * 5u / 8u | 1u;
    return thread * groups + (group + thread * shift) % groups;
}

/* Takes the instance of a triangle, and fetches it. */
bool triangle_take(uint number, out vec3 v[3], out uint index[3])
{
    const uint instance = number / args.triangle_count;
    instance_load(instance);
    return triangle_fetch(number - instance * args.triangle_count, v, index);
}

/* Number of columns of a thread's triangle that are to be tested; fills its range. */
uint triangle_cull(uint number, uint thread)
{
    vec3 v[3];
    triangle t;
    if (number >= args.triangle_count * args.draw_count)
        return 0u;
    const bool valid = triangle_take(number, v, t.index);
    if (gl_WorkGroupID.y == 0u)
        triangle_count_faults(valid, v);
    if (!valid || !triangle_place(t, v))
        return 0u;
    const ivec2 size = t.columns.zw - t.columns.xy + 1;
    ranges[thread] = ivec4(t.columns.xy, size.x, t.axis);
    return uint(size.x * size.y);
}

/* Fills `ends`: sums of the counts of all threads up to each. Called by the whole workgroup. */
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

/* The thread whose triangle has a column: the first whose columns end beyond it. */
uint owner_of(uint column)
{
    uint low = 0u;
    for (uint reach = uint(SDFGI_GROUP_TRIANGLE) / 2u; reach > 0u; reach /= 2u)
        low += ends[low + reach - 1u] <= column ? reach : 0u;
    return low;
}

/* Stores the columns [first, last), one or more, which are all of one triangle. Loops test at their end:
 * software drivers go through a loop that tests at its beginning once more than is needed. */
void store_columns(uint group, uint owner, uint first, uint last)
{
    const ivec4 range = ranges[owner];
    const uint begin = owner > 0u ? ends[owner - 1u] : 0u;
    vec3 v[3];
    triangle t;
    triangle_take(triangle_of(group, owner), v, t.index);
    t.axis = range.w;
    triangle_setup(t, v);
    const int row = int((float(first - begin) + 0.5) / float(range.z)); /* exact up to 2^20 columns */
    ivec2 at = ivec2(int(first - begin) - row * range.z, row);
    uint i = first;
    do {
        triangle_store_column(t, range.xy + at);
        at = at.x + 1 < range.z ? ivec2(at.x + 1, at.y) : ivec2(0, at.y + 1);
    } while (++i < last);
}

void main()
{
    const uint group = gl_WorkGroupID.x + gl_WorkGroupID.z * uint(SDFGI_VOXELIZE_WIDTH);
    const uint thread = gl_LocalInvocationIndex;
    if (group >= group_count())
        return;
    sum_columns(thread, triangle_cull(triangle_of(group, thread), thread));

    const uint total = ends[SDFGI_GROUP_TRIANGLE - 1], threads = args.slices * uint(SDFGI_GROUP_TRIANGLE);
    const uint per_thread = (total + threads - 1u) / threads;
    uint i = (gl_WorkGroupID.y * uint(SDFGI_GROUP_TRIANGLE) + thread) * per_thread;
    const uint last = min(i + per_thread, total);
    if (i >= last)
        return;
    do {
        const uint owner = owner_of(i), next = min(ends[owner], last);
        store_columns(group, owner, i, next);
        i = next;
    } while (i < last);
}
