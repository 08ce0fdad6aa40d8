/* SPDX-License-Identifier: MIT
 * Lists the light cells that this frame visits: those of a range of each light list, and the watched ones of
 * another (seen.glsl). One thread per word of marks, in the cascade gl_WorkGroupID.y. Nothing depends on the
 * order of the list. What a workgroup lists is filled up, so that those of cell_gather have cells of one
 * cascade. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SEEN
#include "../lib/on_cpu.glsl"
#include "visits.glsl"

layout(local_size_x = SDFGI_GROUP_VISITS) in;
SDFGI_PUSH(sdfgi_visit_list_args);

shared uint group_count; /* visits that the workgroup lists */
shared uint group_first; /* index of the first of them in the list */

/* The lowest n bits. */
uint bits_below(int n)
{
    return n < SDFGI_SEEN_BITS ? (1u << max(n, 0)) - 1u : ~0u;
}

/* For the entries of a word from `first` on, those in [low, high). */
uint bits_between(uint first, uint low, uint high)
{
    return bits_below(int(high - first)) & ~bits_below(int(low - first));
}

uint visited_bits(uint cascade, uint first)
{
    const uint low = sdfgi_frame.cascades[cascade].watched_first,
               high = sdfgi_frame.cascades[cascade].watched_end;
    uint bits = bits_between(first, args.first[cascade], args.end[cascade]);
    if (first < high)
        bits |= watched_bits(cascade, first) & bits_between(first, low, high);
    return bits;
}

/* Makes room for `count` more visits. Returns the index of the first of them. */
uint extend(uint count)
{
    const uint first = atomicAdd(sdfgi_seen[visit_record(0u) + 3u], count);
    for (uint i = 0u; i < uint(SDFGI_VISITS_RECORDS); i++) {
        const uint groups = (first + count + args.groups[i] - 1u) / args.groups[i],
                   rows = (groups + uint(SDFGI_MAX_GROUPS) - 1u) / uint(SDFGI_MAX_GROUPS);
        atomicMax(sdfgi_seen[visit_record(i)], min(groups, uint(SDFGI_MAX_GROUPS)));
        atomicMax(sdfgi_seen[visit_record(i) + 1u], rows);
    }
    return first;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, cascade = gl_WorkGroupID.y;
    const uint first = uint(SDFGI_SEEN_BITS) * gl_GlobalInvocationID.x;
    if (lane == 0u)
        group_count = 0u;
    barrier();
    uint bits = visited_bits(cascade, first), slot = 0u;
    if (bits != 0u)
        slot = atomicAdd(group_count, uint(bitCount(bits)));
    barrier();
    const uint count = group_count, size = uint(SDFGI_VISIT_CELLS),
               filled = (count + size - 1u) / size * size;
    if (count == 0u)
        return;
    if (lane == 0u)
        group_first = extend(filled);
    barrier();
    slot += visit_slot(group_first);
    for (; bits != 0u; bits &= bits - 1u)
        sdfgi_seen[slot++] = visit_pack(cascade, first + uint(findLSB(bits)));
    if (count + lane < filled)
        sdfgi_seen[visit_slot(group_first + count + lane)] = VISIT_NOTHING;
}
