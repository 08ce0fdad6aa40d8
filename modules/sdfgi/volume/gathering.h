/* SPDX-License-Identifier: MIT
 * Which light cells gather in a frame.
 *
 * A sweep visits each entry of a cascade's light list once. A gather cycle takes as many sweeps as a cell has
 * visits in a cycle: few after the lights have changed, because light makes a bounce in each cycle, and more
 * once most of the light changes little. Near cascades get most of a frame's rays: each gets half of what is
 * left, and the last one all of it. Where pictures are gathered, up to 7/12 of all rays go to watched cells:
 * to those that pictures read, which are seen, and in turn to those that rays of watched cells hit. A cascade
 * whose light changes no more from cycle to cycle has settled, and gets none. Plain data.
 */
#ifndef SDFGI_GATHERING_H
#define SDFGI_GATHERING_H

#include "accumulation.h"
#include "relight.h"
#include "scene/journal.h"

struct gather_cursor {
    uint32_t next;          /* entry */
    uint32_t sweeps;        /* of this cycle */
    uint64_t cycle;         /* cycles are numbered from 1 */
    uint64_t invalid_cycle; /* the last one with light from before it was invalidated */
    struct convergence convergence;
    uint32_t rough_cycles; /* since the lights changed */
    uint32_t watched_first,
        watched_end; /* entries of which those that are watched are visited in this frame, too */
    uint32_t hit;    /* cells that rays had hit when marks on them were last read anew */
    uint32_t round;  /* of visits to watched cells: in each, other cells that rays hit have their turn */
    bool rough;      /* cycles are short, because the lights have changed */
    bool settled;
};

struct gathering {
    struct gather_cursor at[SDFGI_MAX_CASCADES];
    uint64_t invalidations;           /* of the light, as far as they are taken in */
    uint32_t epoch;                   /* changes of a time: of lights and of geometry */
    uint32_t epoch_frames;            /* since it began, as far as they matter, */
    uint32_t calm_frames;             /* and since one began in which lights had changed */
    bool epoch_over;                  /* something has changed since, */
    bool lights_over;                 /* lights, sun or sky among that, */
    bool all_over;                    /* and it changes the light of all cells */
    uint32_t epoch_of_all;            /* the last one that did */
    uint32_t epoch_of_drift;          /* the last one in which that of all changed a little, */
    float drift;                      /* and by which part of it */
    float drifted;                    /* the part by which it has changed since the epoch began */
    uint32_t epoch_of_local;          /* the last one in which geometry changed, or lights by more */
    float flicker;                    /* by which part the mean of lamps that flicker has changed of late, */
    float flickered;                  /* and since the epoch began */
    uint32_t local_epochs;            /* for which cells look for changes of lamps and geometry */
    struct edited_places edited;      /* geometry, since the epoch began, */
    struct edited_places edited_last; /* and in the one before */
    struct edited_places emitters;    /* things that emit, likewise */
    struct edited_places emitters_last;
    uint32_t seen_frames;    /* since it was forgotten which cells were seen */
    uint32_t first_frames;   /* that have taken cells since many of them were new, or were woken */
    uint32_t hit_turns_log2; /* each cell that rays hit has its turn once in 2^hit_turns_log2 rounds */
};

struct gather_range {
    uint32_t cascade, first, count;
    uint32_t watched_span,
        watched_count; /* entries among which watched ones are visited, and about how many these are */
    bool begins_cycle;
    uint64_t ends_cycle; /* the cycle whose last entries these are; 0: none */
    uint32_t visits;     /* of a cell in a cycle */
    bool marks;          /* cells mark how much light they have at the end of this cycle */
};

/* What a cycle of a cascade has changed. */
struct gather_change {
    float most;               /* largest relative change of a light cell */
    uint32_t changing, cells; /* light cells that changed by SDFGI_SMALL_CHANGE or more, and all of them */
    float drift;              /* largest relative change of a light cell since the cycle that marked it */
};

void sdfgi_gathering_init(struct gathering *gathering);
/* All cells are new, or many are woken. */
void sdfgi_gathering_restart(struct gathering *gathering);
/* Times as many rays as others new and woken cells send in this frame. */
uint32_t sdfgi_gathering_new_rays(const struct gathering *gathering);
/* What all cells have gathered is outdated: sun or sky is another one, or everything. */
void sdfgi_gathering_outdate(struct gathering *gathering);
/* Sun or sky have changed by a part of their light. If that is small, cells go on from what they know. */
void sdfgi_gathering_drift(struct gathering *gathering, float change);
/* Some have to gather anew: those whose rays meet what a lamp lights otherwise than before; or, if geometry
 * has changed in a box, those whose rays cross it. NULL: none has. */
void sdfgi_gathering_change(struct gathering *gathering, const struct box *edited);
/* Something in a box emits, or did: those have to gather anew that see the box. */
void sdfgi_gathering_emitter(struct gathering *gathering, const struct box *box);
/* Lamps that flicker have changed; the mean of their light by a part of it. Cells that they reach go on from
 * what they know. */
void sdfgi_gathering_flicker(struct gathering *gathering, float change);
/* Begins a frame. `invalidations` counts those of the light so far: after one no cascade is settled. */
void sdfgi_gathering_begin(struct gathering *gathering, uint64_t invalidations);
/* Takes a frame's part of `cells` cells at most; returns how many ranges it filled in. */
uint32_t sdfgi_gathering_take(struct gathering *gathering, const struct relight *relight,
                              const struct light_lists *lists, uint32_t cells, uint32_t cycle_visits,
                              struct gather_range ranges[static SDFGI_MAX_CASCADES]);
/* True in the frames in which it is forgotten which cells were seen: a view may have turned away. */
bool sdfgi_gathering_forgets_seen(const struct gathering *gathering);
/* True in the frames in which marks on what rays hit are read anew, and new ones begin. */
bool sdfgi_gathering_forgets_hit(const struct gathering *gathering);
/* The entries of a cascade's list are others. */
void sdfgi_gathering_forget_hit(struct gathering *gathering, uint32_t cascade);
/* hit_part and hit_bits of sdfgi_cascade_params. */
uint32_t sdfgi_gathering_hit_part(const struct gathering *gathering);
uint32_t sdfgi_gathering_hit_bits(const struct gathering *gathering, uint32_t cascade);
/* A cycle that ended came back from the GPU. */
void sdfgi_gathering_add_known(struct gathering *gathering, uint32_t cascade, uint64_t cycle,
                               const struct gather_change *change);
/* True if lamps or geometry have changed of late, so that some cells have to gather anew. */
bool sdfgi_gathering_changes_are_local(const struct gathering *gathering);
/* The epoch in which what changes in this frame is taken in. */
uint32_t sdfgi_gathering_next_epoch(const struct gathering *gathering);
/* True if the cells of all cascades have settled. */
bool sdfgi_gathering_has_settled(const struct gathering *gathering, uint32_t cascades);

#endif
