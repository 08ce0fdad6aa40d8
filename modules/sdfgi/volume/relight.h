/* SPDX-License-Identifier: MIT
 * Which direct light is to be made again.
 *
 * A light cell that is listed as dirty is lit in the same frame. The others keep their direct light; but
 * surfaces that were added or removed may throw shadows on them, or throw them no more. They are lit again
 * over the following frames, so many a frame: a cursor goes through the light list of each cascade. So are
 * all cells while a sun goes on slowly. Plain data. */
#ifndef SDFGI_RELIGHT_H
#define SDFGI_RELIGHT_H

#include "scene/journal.h"

#include "shaders/shared/constants.h"

enum { RELIGHT_CELLS = 16384 }; /* light cells a frame that are lit again because others changed */

struct relight_cursor {
    uint32_t next, left; /* entries: the next to be lit again, how many are left, */
    uint32_t shadows;    /* and how many of these because shadows may have changed */
    uint64_t listed_at;  /* frame in which the list was written last, */
    uint64_t made_at;    /* and in which all of its cells were new */
};

struct relight {
    struct relight_cursor at[SDFGI_MAX_CASCADES];
    uint32_t cascade;       /* whose turn it is */
    uint32_t waits;         /* frames in a row that have put it off */
    uint32_t budget;        /* cells a frame */
    uint32_t hurries;       /* cells in this frame, if that is more: a sun goes on fast */
    struct light_bits suns; /* for which cells wait that have no new shadows */
    uint32_t lit;           /* number of the last change of lights, from 1 to SDFGI_LIGHT_MOST_LIT */
};

/* The light lists, as far as the host knows them. */
struct light_lists {
    uint32_t cascades, room;              /* entries that a list has room for */
    uint32_t counted[SDFGI_MAX_CASCADES]; /* entries of the newest list that came back */
    uint32_t seen[SDFGI_MAX_CASCADES];    /* of these, how many pictures have seen of late */
    uint32_t hit[SDFGI_MAX_CASCADES];     /* of these, how many rays of watched cells have hit of late */
    uint64_t frame;
    uint32_t frames_in_flight;
};

/* What happens to a cascade's list in this frame. */
enum relist {
    RELIST_NOT,
    RELIST_DIRTY, /* written again; only cells in dirty blocks are new */
    RELIST_NEW,   /* all its cells are new */
};

struct relight_range {
    uint32_t cascade, first, count;
};

void sdfgi_relight_init(struct relight *relight);
/* Counts a change of lights. */
void sdfgi_relight_count(struct relight *relight);
/* Entries of a list: as counted, once the count of this list has come back; until then all that it has room
 * for. */
uint32_t sdfgi_light_list_entries(const struct relight *relight, const struct light_lists *lists,
                                  uint32_t cascade);
/* The same for passes that may miss some cells. While edits write a list again in each frame, the newest
 * count is that of an earlier list: so many, and some more. */
uint32_t sdfgi_light_list_expected(const struct relight *relight, const struct light_lists *lists,
                                   uint32_t cascade);
/* Notes which lists are written in this frame, which suns have changed a little, and what has to be lit again
 * because of it: nothing if all cells are lit in this frame anyway, or if there is no light. */
void sdfgi_relight_note(struct relight *relight, const struct light_lists *lists,
                        const enum relist relists[static SDFGI_MAX_CASCADES], const struct sun_drift *suns,
                        bool lit_anyway);
/* The lights that may light cells which wait otherwise than before. */
struct light_bits sdfgi_relight_lights(const struct relight *relight);
/* Takes this frame's part; returns how many ranges it filled in. `busy`: the frame has enough to do. */
uint32_t sdfgi_relight_take(struct relight *relight, const struct light_lists *lists, bool busy,
                            struct relight_range ranges[static SDFGI_MAX_CASCADES]);
/* True if cells wait to be lit again. */
bool sdfgi_relight_is_due(const struct relight *relight);

#endif
