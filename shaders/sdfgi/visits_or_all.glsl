/* SPDX-License-Identifier: MIT
 * The light cells of a dispatch: those that the frame visits, or all of all light lists. Includers have
 * args.visited and args.end, the ends of the lists. */
#ifndef SDFGI_VISITS_OR_ALL_GLSL
#define SDFGI_VISITS_OR_ALL_GLSL

#include "visits.glsl"

/* Threads that the list of a cascade takes: those of a workgroup have the same cascade. */
uint threads_of_list(uint cascade)
{
    const uint group = uint(SDFGI_GROUP_LINEAR);
    return (args.end[cascade] + group - 1u) / group * group;
}

/* The n-th of all entries: the lists of the cascades follow one another. False if there is none. */
bool entry_of_all(uint n, out uint cascade, out uint entry)
{
    cascade = 0u;
    entry = n;
    for (; cascade + 1u < uint(SDFGI_MAX_CASCADES) && entry >= threads_of_list(cascade); cascade++)
        entry -= threads_of_list(cascade);
    return entry < min(args.end[cascade], light_cell_count(cascade));
}

/* Cascade and entry of the n-th light cell of the dispatch. False if there is none. */
bool visit_or_entry(uint n, out uint cascade, out uint entry)
{
    return args.visited != 0u ? visit_find(n, cascade, entry) : entry_of_all(n, cascade, entry);
}

#endif
