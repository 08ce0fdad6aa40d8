/* SPDX-License-Identifier: MIT
 * Sets and bindings, as modules/sdfgi/resource_table.h has them. */
#ifndef SDFGI_SHARED_BINDINGS_H
#define SDFGI_SHARED_BINDINGS_H

/* Sets of the library's own passes. Hosts bind LOOKUP alone, at an index of their choice: SDFGI_SET. */
#define SDFGI_SET_LOOKUP   0
#define SDFGI_SET_WORK     1
#define SDFGI_SET_MESH     2
#define SDFGI_SET_MATERIAL 3
#define SDFGI_SET_VIEW     2

/* Added to the binding of a storage buffer: where its texel buffer is bound, on software drivers alone. */
#define SDFGI_BINDING_TEXELS 32

/* LOOKUP: all that the lookups of sdfgi.glsl read. */
#define SDFGI_BINDING_FRAME        0
#define SDFGI_BINDING_BITS         1
#define SDFGI_BINDING_DISTANCE     2
#define SDFGI_BINDING_LIGHT        3
#define SDFGI_BINDING_PROBES       4
#define SDFGI_BINDING_IRRADIANCE   5
#define SDFGI_BINDING_LIGHT_BLOCKS 6
#define SDFGI_BINDING_SURFACES     7
#define SDFGI_BINDING_EMISSION     8
#define SDFGI_BINDING_LOW_LIGHT    9 /* texels of SEEN, for hosts: they may bind no more storage buffers */

/* WORK: what only passes bind. */
#define SDFGI_BINDING_LIGHTS      0
#define SDFGI_BINDING_MATERIALS   1
#define SDFGI_BINDING_SCRATCH     2
#define SDFGI_BINDING_ALBEDO      3
#define SDFGI_BINDING_NORMALS     4
#define SDFGI_BINDING_LIGHT_CELLS 5
#define SDFGI_BINDING_RAYS        6
#define SDFGI_BINDING_SUMS        7
#define SDFGI_BINDING_PREVIOUS    8
#define SDFGI_BINDING_COUNTERS    9
#define SDFGI_BINDING_INDIRECT    10
#define SDFGI_BINDING_BOUNDS      11
#define SDFGI_BINDING_MASKS       12
#define SDFGI_BINDING_OCCLUSION   13
#define SDFGI_BINDING_GATHERED    14
#define SDFGI_BINDING_EMITTERS    15
#define SDFGI_BINDING_SEEN        16
#define SDFGI_BINDING_SEARCH      17
#define SDFGI_BINDING_INSTANCES   18
#define SDFGI_BINDING_DIRECT      19

/* MESH. */
#define SDFGI_BINDING_MESH_POSITIONS 0
#define SDFGI_BINDING_MESH_UVS       1
#define SDFGI_BINDING_MESH_COLORS    2
#define SDFGI_BINDING_MESH_INDICES   3

/* MATERIAL. */
#define SDFGI_BINDING_MATERIAL_ALBEDO   0
#define SDFGI_BINDING_MATERIAL_EMISSION 1

/* VIEW: the pictures of a gather or a resolve. Those that passes write have bits in the pass table: V(NAME).
 */
#define SDFGI_BINDING_VIEW_DEPTH      0
#define SDFGI_BINDING_VIEW_NORMAL     1
#define SDFGI_BINDING_VIEW_ROUGHNESS  2
#define SDFGI_BINDING_VIEW_DIFFUSE    3
#define SDFGI_BINDING_VIEW_REFLECTION 4
#define SDFGI_BINDING_VIEW_TILES      5
#define SDFGI_BINDING_VIEW_FILTERED   6

#endif
