/* SPDX-License-Identifier: MIT
 * What the library holds of the scene: for debug views, tests and tools that want to see what it sees. A host
 * that only wants light needs none of this. Conventions as in sdfgi.h.
 *
 * Where things are: cell (x, y, z) of a cascade, each in [0, resolution), is the box from origin_m + (x, y,
 * z) * cell_m to one cell further. Volumes are toroidal: sdfgi_inspect_cell says at which element a cell is
 * stored, and sdfgi_inspect_block at which the block of 2x2x2 cells that holds it. */
#ifndef SDFGI_INSPECT_H
#define SDFGI_INSPECT_H

#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

struct sdfgi_inspect_cascade {
    int64_t origin_cells[3]; /* index of the low corner's cell in a grid through the world's origin */
    double origin_m[3];      /* the same corner in world space */
    double cell_m[3];
    uint32_t resolution; /* cells along a side, a power of two */
    float emission_unit; /* of stored emission, W/(m^2 sr): for sdfgi_inspect_decode_block */
};

/* Where a cascade is since the last sdfgi_update. */
SDFGI_API enum sdfgi_result sdfgi_inspect_get_cascade(const sdfgi *gi, uint32_t cascade,
                                                      struct sdfgi_inspect_cascade *out);

enum sdfgi_volume {
    SDFGI_VOLUME_BITS,     /* per cell, 2 words: sdfgi_inspect_bits */
    SDFGI_VOLUME_ALBEDO,   /* per block, 2 words; this and the next two: sdfgi_inspect_decode_block */
    SDFGI_VOLUME_EMISSION, /* per block, 2 words */
    SDFGI_VOLUME_NORMALS,  /* per block, 1 word */
    SDFGI_VOLUME_COUNT,
};

/* Bytes of one cascade's volume; 0 while GI is disabled. */
SDFGI_API uint64_t sdfgi_inspect_volume_size(const sdfgi *gi, enum sdfgi_volume volume);

/* Records a copy of a cascade's volume to `buffer`, which must have VK_BUFFER_USAGE_TRANSFER_DST_BIT and room
 * for sdfgi_inspect_volume_size bytes from `offset`, a multiple of 4. To be recorded after sdfgi_update in
 * the same queue; the copy is made visible to everything later in the queue and to the host. Refused while
 * there is nothing to copy. */
SDFGI_API enum sdfgi_result sdfgi_inspect_copy(sdfgi *gi, VkCommandBuffer cmd, uint32_t cascade,
                                               enum sdfgi_volume volume, VkBuffer buffer,
                                               VkDeviceSize offset);

/* Element of a local cell in a volume with one element per cell. */
static inline uint64_t sdfgi_inspect_cell(const struct sdfgi_inspect_cascade *c, uint32_t x, uint32_t y,
                                          uint32_t z)
{
    const uint64_t n = c->resolution, mask = n - 1;
    const uint64_t tx = (uint64_t)c->origin_cells[0] + x, ty = (uint64_t)c->origin_cells[1] + y,
                   tz = (uint64_t)c->origin_cells[2] + z;
    return (tx & mask) + n * ((ty & mask) + n * (tz & mask));
}

/* Element of the block that holds a local cell in a volume with one element per block. */
static inline uint64_t sdfgi_inspect_block(const struct sdfgi_inspect_cascade *c, uint32_t x, uint32_t y,
                                           uint32_t z)
{
    const uint64_t n = c->resolution / 2, mask = n - 1;
    const uint64_t tx = ((uint64_t)c->origin_cells[0] + x) >> 1, ty = ((uint64_t)c->origin_cells[1] + y) >> 1,
                   tz = ((uint64_t)c->origin_cells[2] + z) >> 1;
    return (tx & mask) + n * ((ty & mask) + n * (tz & mask));
}

/* What a cell of SDFGI_VOLUME_BITS holds, from its two words: bit x + 4 y + 16 z tells whether sub-voxel
 * (x, y, z) is set. Empty cells may have words that are not 0, which tell how far rays may go at once. */
static inline uint64_t sdfgi_inspect_bits(const uint32_t *cell)
{
    const uint32_t marks_empty_cell = 0xa5a5u;
    return cell[1] >> 16 == marks_empty_cell ? 0 : cell[0] | (uint64_t)cell[1] << 32;
}

/* Axes are counted +x -x +y -y +z -z. */
struct sdfgi_inspect_surface {
    uint16_t albedo[6][3]; /* per axis, in 1/1023; mean of the triangles that are seen from there */
    float emission[3];     /* mean radiance of what is seen from the side that emits most, W/(m^2 sr) */
    uint8_t emitting[6];   /* per axis, in 1/31: share of that radiance that leaves on this side */
    /* Per component k, x to z: mean normal, up to its sign, of the triangles whose largest component is k: 1
     * along k, then, in 1/15, along the next axis and the one after that, in cyclic order. */
    bool has_normal[3];
    int8_t slopes[3][2];
};

/* What a block's words mean. `albedo` and `emission` point to two each; the former may be NULL, and is black.
 */
SDFGI_API void sdfgi_inspect_decode_block(const uint32_t *albedo, const uint32_t *emission, uint32_t normals,
                                          float emission_unit, struct sdfgi_inspect_surface *out);

#ifdef __cplusplus
}
#endif
#endif
