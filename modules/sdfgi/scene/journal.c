/* SPDX-License-Identifier: MIT */
#include "journal.h"

#include "drift.h"

static float larger(float a, float b)
{
    return a > b ? a : b;
}

void sdfgi_edited_places_add(struct edited_places *places, const struct box *box)
{
    sdfgi_box_list_join(places->boxes, &places->count, SDFGI_EDITED_BOXES, box);
}

uint32_t sdfgi_light_bit(uint32_t slot)
{
    return 1u << slot % SDFGI_LIGHT_BITS;
}

void sdfgi_journal_note(struct journal *journals, enum journal_note note)
{
    for (struct journal *j = journals; j; j = j->next)
        j->notes |= (uint32_t)note;
}

void sdfgi_light_bits_add(struct light_bits *bits, const struct light_bits *others)
{
    bits->changed |= others->changed;
    bits->moved |= others->moved;
}

static void note_light(struct journal *journals, const struct light_bits *bits)
{
    for (struct journal *j = journals; j; j = j->next)
        sdfgi_light_bits_add(&j->lights, bits);
}

void sdfgi_journal_note_lamp(struct journal *journals, const struct light_bits *bits, float change)
{
    note_light(journals, bits);
    if (change >= 1)
        sdfgi_journal_note(journals, JOURNAL_LAMPS);
    else
        for (struct journal *j = journals; j; j = j->next)
            j->flicker = larger(j->flicker, change);
}

/* If a sun changes by more than this part of its light in a frame, all surfaces follow in this frame. */
#define SUDDEN (DRIFT_OUTDATES / SDFGI_EPOCH_FRAMES)

static void add_suns(struct sun_drift *suns, const struct sun_drift *others)
{
    sdfgi_light_bits_add(&suns->bits, &others->bits);
    suns->most = larger(suns->most, others->most);
}

void sdfgi_journal_note_sun(struct journal *journals, const struct light_bits *bits, float change)
{
    const struct sun_drift sun = { *bits, change };
    if (change > SUDDEN)
        note_light(journals, bits);
    for (struct journal *j = journals; j && change <= SUDDEN; j = j->next)
        add_suns(&j->suns, &sun);
    sdfgi_journal_note_sky(journals, change);
}

void sdfgi_journal_note_sky(struct journal *journals, float change)
{
    for (struct journal *j = journals; j; j = j->next)
        j->drift += change;
}

void sdfgi_journal_add_box(struct journal *journals, const struct box *box)
{
    for (struct journal *j = journals; j; j = j->next)
        sdfgi_box_list_add(j->boxes, &j->box_count, JOURNAL_BOXES, box);
}

void sdfgi_journal_add_emitter(struct journal *journals, const struct box *box)
{
    for (struct journal *j = journals; j; j = j->next)
        sdfgi_edited_places_add(&j->emitters, box);
}

bool sdfgi_journal_is_empty(const struct journal *journal)
{
    return journal->notes == 0 && journal->drift == 0 && journal->lights.changed == 0 &&
           journal->suns.bits.changed == 0 && journal->box_count == 0;
}

void sdfgi_journal_prepend(struct journal *journal, const struct journal *earlier)
{
    const struct journal later = *journal;
    *journal = *earlier;
    journal->next = later.next;
    journal->notes |= later.notes;
    journal->drift += later.drift;
    journal->flicker = larger(journal->flicker, later.flicker);
    sdfgi_light_bits_add(&journal->lights, &later.lights);
    add_suns(&journal->suns, &later.suns);
    for (uint32_t i = 0; i < later.box_count; i++)
        sdfgi_box_list_add(journal->boxes, &journal->box_count, JOURNAL_BOXES, &later.boxes[i]);
    for (uint32_t i = 0; i < later.emitters.count; i++)
        sdfgi_edited_places_add(&journal->emitters, &later.emitters.boxes[i]);
}

void sdfgi_journal_clear(struct journal *journal)
{
    journal->notes = 0;
    journal->drift = 0;
    journal->flicker = 0;
    journal->lights = (struct light_bits){ 0 };
    journal->suns = (struct sun_drift){ .most = 0 };
    journal->box_count = 0;
    journal->emitters = (struct edited_places){ .count = 0 };
}
