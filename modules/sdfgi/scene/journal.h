/* SPDX-License-Identifier: MIT
 * What changed in a scene since its reader looked last. */
#ifndef SDFGI_JOURNAL_H
#define SDFGI_JOURNAL_H

#include "core/box.h"

enum { JOURNAL_BOXES = 64 };

enum journal_note {
    JOURNAL_MATERIALS = 1, /* constants of materials that are shown */
    JOURNAL_SKY = 2,
    JOURNAL_EVERYTHING = 4, /* all that was voxelised is out of date */
    JOURNAL_FAR = 8,        /* a sun has changed, or something that emits: its light may reach all */
};

/* Which lights have changed, a bit each of SDFGI_LIGHT_BITS. */
struct light_bits {
    uint32_t changed; /* made, changed or destroyed */
    uint32_t moved;   /* those that may light what they did not light before */
};

/* The bit of the light in a slot. Slots that are so far apart share one. */
uint32_t sdfgi_light_bit(uint32_t slot);

struct journal {
    uint32_t notes;                  /* enum journal_note */
    struct light_bits lights;        /* that were made, changed or destroyed */
    struct box boxes[JOURNAL_BOXES]; /* world: geometry changed there. When they are full, boxes grow */
    uint32_t box_count;
    struct journal *next; /* of the same scene */
};

void sdfgi_journal_note(struct journal *journals, enum journal_note note);
void sdfgi_journal_note_light(struct journal *journals, const struct light_bits *bits);
void sdfgi_journal_add_box(struct journal *journals, const struct box *box);
bool sdfgi_journal_is_empty(const struct journal *journal);
/* Adds the entries of `earlier` before those of the journal. */
void sdfgi_journal_prepend(struct journal *journal, const struct journal *earlier);
/* Forgets all entries; it stays the scene's. */
void sdfgi_journal_clear(struct journal *journal);

#endif
