/* SPDX-License-Identifier: MIT
 * Reference encodings in double precision: octahedral directions and shared-exponent colours. */
#ifndef TEST_ORACLE_ENCODE_H
#define TEST_ORACLE_ENCODE_H

#include <stdint.h>

/* Signed octahedral map (Cigolle et al. 2014): unit direction <-> square [-1, 1]^2, z up, the lower half
 * folded over the diagonals. Zero counts as positive. decode gives unit length. */
void oracle_octahedral_encode(const double direction[static 3], double square[static 2]);
void oracle_octahedral_decode(const double square[static 2], double direction[static 3]);

/* Solid angle per area of the square at a point; integrates to 4 pi over [-1, 1]^2. */
double oracle_octahedral_density(const double square[static 2]);

/* Solid angle of texel (x, y) of a size x size map. */
double oracle_octahedral_texel_sr(uint32_t size, uint32_t x, uint32_t y);

/* For a size x size map with a border of one texel: the inner texel whose value border texel (x, y) of the
 * (size + 2)^2 map repeats, in the same coordinates (1..size). Inner texels map to themselves. */
void oracle_octahedral_border(uint32_t size, uint32_t x, uint32_t y, uint32_t source[static 2]);

/* E5B9G9R9_UFLOAT_PACK32 as the Vulkan specification packs and unpacks it: negative values and NaN give 0,
 * values above 65408 give 65408, mantissas round to nearest. Red is in the low bits. */
uint32_t oracle_rgbe_encode(const double rgb[static 3]);
void oracle_rgbe_decode(uint32_t packed, double rgb[static 3]);

#define ORACLE_RGBE_MAX      65408.0
#define ORACLE_RGBE_SMALLEST 0x1p-24

#endif
