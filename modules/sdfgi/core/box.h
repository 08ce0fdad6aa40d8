/* SPDX-License-Identifier: MIT
 * Boxes in the world and boxes of cells. */
#ifndef SDFGI_BOX_H
#define SDFGI_BOX_H

#include <stdbool.h>
#include <stdint.h>

/* Metres, world space. */
struct box {
    double min[3], max[3];
};

/* A box that holds no point. sdfgi_box_around it and another one is the other one. */
struct box sdfgi_box_nothing(void);
bool sdfgi_box_overlaps(const struct box *a, const struct box *b);
struct box sdfgi_box_around(const struct box *a, const struct box *b);
double sdfgi_box_volume(const struct box *box);

/* A list of boxes with room for `room`. Leaves out a box that another one contains, flat ones too. With no
 * room left, the box that grows least takes the new one in. */
void sdfgi_box_list_add(struct box *list, uint32_t *count, uint32_t room, const struct box *box);

/* Likewise for short lists. With no room left, those two boxes become one that grow least by it: two along
 * the way of one thing, and not those of two things. */
enum { BOX_LIST_JOINED = 8 }; /* most room */
void sdfgi_box_list_join(struct box *list, uint32_t *count, uint32_t room, const struct box *box);

/* Local cells [low, high) of a cascade; empty if low >= high along an axis. */
struct cell_box {
    int32_t low[3], high[3];
};

struct cell_box sdfgi_cell_box_whole(uint32_t resolution);
struct cell_box sdfgi_cell_box_shifted(const struct cell_box *box, const int32_t by[static 3]);
struct cell_box sdfgi_cell_box_common(const struct cell_box *a, const struct cell_box *b);
struct cell_box sdfgi_cell_box_widened(const struct cell_box *box, int32_t by);
bool sdfgi_cell_box_empty(const struct cell_box *box);
bool sdfgi_cell_box_contains(const struct cell_box *box, const struct cell_box *other);
uint64_t sdfgi_cell_box_cells(const struct cell_box *box);
int sdfgi_cell_box_longest_axis(const struct cell_box *box);
/* Cuts what is in `box` but not in `hole`, which lies inside it, into up to three boxes; returns how many. */
uint32_t sdfgi_cell_box_difference(const struct cell_box *box, const struct cell_box *hole,
                                   struct cell_box out[static 3]);

/* Floored division and remainder: right for negative coordinates too. */
int64_t sdfgi_floor_div(int64_t a, int64_t b);
int64_t sdfgi_floor_mod(int64_t a, int64_t b);

#endif
