/* SPDX-License-Identifier: MIT
 * Empty boxes: for each octant, one that begins at an empty cell and leads into that octant, by which rays
 * cross empty space. A box has a side of `size` cells, or twice as many, along each axis. It extends the
 * chessboard distance per octant of Es and Isler 2007, "Accelerated regular grid traversals using extended
 * anisotropic chessboard distance fields on a parallel stream processor": their boxes are cubes.
 *
 * A cell without sub-voxels holds its boxes in the place of its bits. Octants are numbered by a bit for each
 * axis along which they lead down. The first word has four bits for each: the size, and whether the side
 * along x is twice as long. The second word has two bits for each: whether the sides along y and z are. Its
 * upper half tells cells that hold boxes from others. */
#ifndef SDFGI_SHARED_BOXES_H
#define SDFGI_SHARED_BOXES_H

#define SDFGI_BOX_SIZES 7 /* the largest: three bits */
#define SDFGI_BOX_REACH 14 /* cells: the longest side */

/* The upper half of the second word. As sub-voxels it would be chequered. A cell that has all of these
 * sub-voxels has the other one as well, and is not taken for empty. */
#define SDFGI_BOXES_MARK       0xa5a50000u
#define SDFGI_BOXES_MASK       0xffff0000u
#define SDFGI_BOXES_MARK_OTHER 0x00020000u

/* Which boxes are better, by their size and by how many of their sides are twice as long: from 1 on in the
 * order of how far a ray goes until it leaves the box. That is a mean over directions, and over places in the
 * first cell. */
#define SDFGI_BOX_RANKS                                                                                      \
    {                                                                                                        \
        { 1, 2, 3, 5 },     { 4, 6, 7, 10 },    { 8, 9, 12, 17 },   { 11, 13, 16, 22 },                      \
        { 14, 15, 21, 25 }, { 18, 20, 24, 27 }, { 19, 23, 26, 28 },                                          \
    }

/* A tile of empty_cubes: a word of 32 cells along x in so many rows along y, and along z. One tile before the
 * cascade along each axis has cubes that lead into it. */
#define SDFGI_CUBES_ROWS 16

#endif
