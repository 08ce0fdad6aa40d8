/* SPDX-License-Identifier: MIT
 * What changed in a scene since its reader looked last. */
#ifndef SDFGI_JOURNAL_H
#define SDFGI_JOURNAL_H

#include "core/box.h"

#include "shaders/shared/constants.h"

enum { JOURNAL_BOXES = 64 };

enum journal_note {
    JOURNAL_MATERIALS = 1,  /* constants of materials that are shown */
    JOURNAL_EVERYTHING = 2, /* all that was voxelised is out of date */
    JOURNAL_LAMPS = 4,      /* a light other than a sun has changed, and does not flicker */
};

/* Which lights have changed, a bit each of SDFGI_LIGHT_BITS. */
struct light_bits {
    uint32_t changed; /* made, changed or destroyed */
    uint32_t moved;   /* those that may light what they did not light before */
};

/* Suns that have changed so little that surfaces need not follow at once. */
struct sun_drift {
    struct light_bits bits;
    float most; /* by which part of its light one has, at most */
};

void sdfgi_light_bits_add(struct light_bits *bits, const struct light_bits *others);
/* The bit of the light in a slot. Slots that are so far apart share one. */
uint32_t sdfgi_light_bit(uint32_t slot);

/* Where something has changed. */
struct edited_places {
    struct box boxes[SDFGI_EDITED_BOXES]; /* world */
    uint32_t count;
};

/* With no room left, places that are near each other become one. */
void sdfgi_edited_places_add(struct edited_places *places, const struct box *box);

struct journal {
    uint32_t notes;                  /* enum journal_note */
    struct light_bits lights;        /* that were made, changed or destroyed */
    struct sun_drift suns;           /* those that have changed a little alone */
    float drift;                     /* by which part of their light suns and sky have changed; 1: by all */
    float flicker;                   /* by which part the mean of a lamp that flickers changes, at most */
    struct box boxes[JOURNAL_BOXES]; /* world: geometry changed there. When they are full, boxes grow */
    uint32_t box_count;
    struct edited_places emitters; /* of these, around things that emit */
    struct journal *next;          /* of the same scene */
};

void sdfgi_journal_note(struct journal *journals, enum journal_note note);
/* Another light has changed: see sdfgi_habit_change. */
void sdfgi_journal_note_lamp(struct journal *journals, const struct light_bits *bits, float change);
/* A sun, or the sky, has changed by a part of its light. */
void sdfgi_journal_note_sun(struct journal *journals, const struct light_bits *bits, float change);
void sdfgi_journal_note_sky(struct journal *journals, float change);
void sdfgi_journal_add_box(struct journal *journals, const struct box *box);
/* Something in a box emits, or did. */
void sdfgi_journal_add_emitter(struct journal *journals, const struct box *box);
bool sdfgi_journal_is_empty(const struct journal *journal);
/* Adds the entries of `earlier` before those of the journal. */
void sdfgi_journal_prepend(struct journal *journal, const struct journal *earlier);
/* Forgets all entries; it stays the scene's. */
void sdfgi_journal_clear(struct journal *journal);

#endif
