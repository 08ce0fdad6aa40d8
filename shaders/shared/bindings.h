/* SPDX-License-Identifier: MIT
 * Bindings of the library's descriptor set, in the order of modules/sdfgi/resource_table.h. */
#ifndef SDFGI_SHARED_BINDINGS_H
#define SDFGI_SHARED_BINDINGS_H

/* Sets of the library's own passes. Hosts choose where they bind the LOOKUP set: SDFGI_SET. */
#define SDFGI_SET_LOOKUP   0
#define SDFGI_SET_WORK     0
#define SDFGI_SET_MESH     1
#define SDFGI_SET_VIEW     1
#define SDFGI_SET_MATERIAL 2

#define SDFGI_BINDING_FRAME       0
#define SDFGI_BINDING_LIGHTS      1
#define SDFGI_BINDING_MATERIALS   2
#define SDFGI_BINDING_BITS        3
#define SDFGI_BINDING_DISTANCE    4
#define SDFGI_BINDING_SCRATCH     5
#define SDFGI_BINDING_ALBEDO      6
#define SDFGI_BINDING_EMISSION    7
#define SDFGI_BINDING_NORMALS     8
#define SDFGI_BINDING_LIGHT       9
#define SDFGI_BINDING_LIGHT_CELLS 10
#define SDFGI_BINDING_MASKS       11
#define SDFGI_BINDING_PROBES      12
#define SDFGI_BINDING_RAYS        13
#define SDFGI_BINDING_SUMS        14
#define SDFGI_BINDING_PREVIOUS    15
#define SDFGI_BINDING_OCCLUSION   16
#define SDFGI_BINDING_IRRADIANCE  17
#define SDFGI_BINDING_COUNTERS    18
#define SDFGI_BINDING_INDIRECT    19
#define SDFGI_BINDING_BOUNDS      20

/* Set 1: a mesh. */
#define SDFGI_BINDING_MESH_POSITIONS 0
#define SDFGI_BINDING_MESH_UVS       1
#define SDFGI_BINDING_MESH_COLORS    2
#define SDFGI_BINDING_MESH_INDICES   3
/* Set 2: a material's textures. */
#define SDFGI_BINDING_MATERIAL_ALBEDO   0
#define SDFGI_BINDING_MATERIAL_EMISSION 1
/* Set 1 of the gather pass. */
#define SDFGI_BINDING_GATHER_DEPTH  0
#define SDFGI_BINDING_GATHER_NORMAL 1
#define SDFGI_BINDING_GATHER_OUTPUT 2

#endif
