/* SPDX-License-Identifier: MIT */
#include "box.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct box sdfgi_box_nothing(void)
{
    return (struct box){ { INFINITY, INFINITY, INFINITY }, { -INFINITY, -INFINITY, -INFINITY } };
}

bool sdfgi_box_overlaps(const struct box *a, const struct box *b)
{
    for (int i = 0; i < 3; i++)
        if (a->max[i] < b->min[i] || a->min[i] > b->max[i])
            return false;
    return true;
}

struct box sdfgi_box_around(const struct box *a, const struct box *b)
{
    struct box box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = fmin(a->min[i], b->min[i]);
        box.max[i] = fmax(a->max[i], b->max[i]);
    }
    return box;
}

double sdfgi_box_volume(const struct box *box)
{
    return (box->max[0] - box->min[0]) * (box->max[1] - box->min[1]) * (box->max[2] - box->min[2]);
}

static bool contains(const struct box *box, const struct box *other)
{
    for (int i = 0; i < 3; i++)
        if (other->min[i] < box->min[i] || other->max[i] > box->max[i])
            return false;
    return true;
}

/* Adds a box, if there is room and no other one contains it. False if it has to be joined with others. */
static bool list_takes(struct box *list, uint32_t *count, uint32_t room, const struct box *box)
{
    assert(*count <= room && room > 0);
    for (uint32_t i = 0; i < *count; i++)
        if (contains(&list[i], box))
            return true;
    if (*count == room)
        return false;
    list[(*count)++] = *box;
    return true;
}

void sdfgi_box_list_add(struct box *list, uint32_t *count, uint32_t room, const struct box *box)
{
    if (list_takes(list, count, room, box))
        return;
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < *count; i++) {
        const struct box both = sdfgi_box_around(&list[i], box);
        const double more = sdfgi_box_volume(&both) - sdfgi_box_volume(&list[i]);
        if (more < least) {
            least = more;
            best = i;
        }
    }
    list[best] = sdfgi_box_around(&list[best], box);
}

/* Of flat boxes, too, more than 0. */
static double sum_of_sides(const struct box *box)
{
    return box->max[0] - box->min[0] + box->max[1] - box->min[1] + box->max[2] - box->min[2];
}

/* By how much the larger of two boxes grows when it takes the other one in. */
static double growth(const struct box *a, const struct box *b)
{
    const struct box both = sdfgi_box_around(a, b);
    return sum_of_sides(&both) - fmax(sum_of_sides(a), sum_of_sides(b));
}

/* Makes one box of those two that grow least by it, and leaves out what it holds. Returns how many are left.
 */
static uint32_t join_nearest(struct box *boxes, uint32_t count)
{
    uint32_t one = 0, other = 1, left = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count; j++)
            if (growth(&boxes[i], &boxes[j]) < growth(&boxes[one], &boxes[other])) {
                one = i;
                other = j;
            }
    const struct box joined = sdfgi_box_around(&boxes[one], &boxes[other]);
    for (uint32_t i = 0; i < count; i++)
        if (!contains(&joined, &boxes[i]))
            boxes[left++] = boxes[i];
    boxes[left++] = joined;
    return left;
}

void sdfgi_box_list_join(struct box *list, uint32_t *count, uint32_t room, const struct box *box)
{
    struct box all[BOX_LIST_JOINED + 1];
    assert(room <= BOX_LIST_JOINED);
    if (list_takes(list, count, room, box))
        return;
    memcpy(all, list, room * sizeof *all);
    all[room] = *box;
    *count = join_nearest(all, room + 1);
    memcpy(list, all, *count * sizeof *all);
}

struct cell_box sdfgi_cell_box_whole(uint32_t resolution)
{
    const int32_t n = (int32_t)resolution;
    return (struct cell_box){ { 0, 0, 0 }, { n, n, n } };
}

struct cell_box sdfgi_cell_box_shifted(const struct cell_box *box, const int32_t by[static 3])
{
    struct cell_box shifted;
    for (int i = 0; i < 3; i++) {
        shifted.low[i] = box->low[i] + by[i];
        shifted.high[i] = box->high[i] + by[i];
    }
    return shifted;
}

struct cell_box sdfgi_cell_box_common(const struct cell_box *a, const struct cell_box *b)
{
    struct cell_box common;
    for (int i = 0; i < 3; i++) {
        common.low[i] = a->low[i] > b->low[i] ? a->low[i] : b->low[i];
        common.high[i] = a->high[i] < b->high[i] ? a->high[i] : b->high[i];
    }
    return sdfgi_cell_box_empty(&common) ? (struct cell_box){ 0 } : common;
}

struct cell_box sdfgi_cell_box_widened(const struct cell_box *box, int32_t by)
{
    struct cell_box wide;
    for (int i = 0; i < 3; i++) {
        wide.low[i] = box->low[i] - by;
        wide.high[i] = box->high[i] + by;
    }
    return wide;
}

bool sdfgi_cell_box_empty(const struct cell_box *box)
{
    for (int i = 0; i < 3; i++)
        if (box->low[i] >= box->high[i])
            return true;
    return false;
}

uint64_t sdfgi_cell_box_cells(const struct cell_box *box)
{
    uint64_t cells = 1;
    for (int i = 0; i < 3; i++)
        cells *= (uint64_t)(box->high[i] > box->low[i] ? box->high[i] - box->low[i] : 0);
    return cells;
}

int sdfgi_cell_box_longest_axis(const struct cell_box *box)
{
    int axis = 2;
    for (int i = 1; i >= 0; i--)
        if (box->high[i] - box->low[i] > box->high[axis] - box->low[axis])
            axis = i;
    return axis;
}

bool sdfgi_cell_box_contains(const struct cell_box *box, const struct cell_box *other)
{
    const struct cell_box common = sdfgi_cell_box_common(box, other);
    return sdfgi_cell_box_cells(&common) == sdfgi_cell_box_cells(other);
}

uint32_t sdfgi_cell_box_difference(const struct cell_box *box, const struct cell_box *hole,
                                   struct cell_box out[static 3])
{
    assert(sdfgi_cell_box_contains(box, hole));
    uint32_t count = 0;
    struct cell_box rest = *box;
    for (int i = 0; i < 3; i++) {
        struct cell_box below = rest, above = rest;
        below.high[i] = hole->low[i];
        above.low[i] = hole->high[i];
        if (!sdfgi_cell_box_empty(&below))
            out[count++] = below;
        if (!sdfgi_cell_box_empty(&above) && count < 3)
            out[count++] = above;
        rest.low[i] = hole->low[i];
        rest.high[i] = hole->high[i];
    }
    return count;
}

int64_t sdfgi_floor_div(int64_t a, int64_t b)
{
    return a / b - (a % b != 0 && (a % b < 0) != (b < 0));
}

int64_t sdfgi_floor_mod(int64_t a, int64_t b)
{
    return a - sdfgi_floor_div(a, b) * b;
}
