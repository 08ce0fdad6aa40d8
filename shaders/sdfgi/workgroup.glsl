/* SPDX-License-Identifier: MIT
 * Dispatches spread over y what exceeds SDFGI_MAX_GROUPS along x: every device takes so many. */
#ifndef SDFGI_WORKGROUP_GLSL
#define SDFGI_WORKGROUP_GLSL

/* The number of this workgroup. */
uint workgroup_index()
{
    return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
}

#endif
