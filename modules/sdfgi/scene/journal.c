/* SPDX-License-Identifier: MIT */
#include "journal.h"

#include "shaders/shared/constants.h"

uint32_t sdfgi_light_bit(uint32_t slot)
{
    return 1u << slot % SDFGI_LIGHT_BITS;
}

void sdfgi_journal_note(struct journal *journals, enum journal_note note)
{
    for (struct journal *j = journals; j; j = j->next)
        j->notes |= (uint32_t)note;
}

static void add_bits(struct light_bits *bits, const struct light_bits *others)
{
    bits->changed |= others->changed;
    bits->moved |= others->moved;
}

void sdfgi_journal_note_light(struct journal *journals, const struct light_bits *bits)
{
    for (struct journal *j = journals; j; j = j->next)
        add_bits(&j->lights, bits);
}

void sdfgi_journal_add_box(struct journal *journals, const struct box *box)
{
    for (struct journal *j = journals; j; j = j->next)
        sdfgi_box_list_add(j->boxes, &j->box_count, JOURNAL_BOXES, box);
}

bool sdfgi_journal_is_empty(const struct journal *journal)
{
    return journal->notes == 0 && journal->lights.changed == 0 && journal->box_count == 0;
}

void sdfgi_journal_prepend(struct journal *journal, const struct journal *earlier)
{
    const struct journal later = *journal;
    *journal = *earlier;
    journal->next = later.next;
    journal->notes |= later.notes;
    add_bits(&journal->lights, &later.lights);
    for (uint32_t i = 0; i < later.box_count; i++)
        sdfgi_box_list_add(journal->boxes, &journal->box_count, JOURNAL_BOXES, &later.boxes[i]);
}

void sdfgi_journal_clear(struct journal *journal)
{
    journal->notes = 0;
    journal->lights = (struct light_bits){ 0 };
    journal->box_count = 0;
}
