/* SPDX-License-Identifier: MIT */
#include "journal.h"

void sdfgi_journal_note(struct journal *journals, enum journal_note note)
{
    for (struct journal *j = journals; j; j = j->next)
        j->notes |= (uint32_t)note;
}

void sdfgi_journal_add_box(struct journal *journals, const struct box *box)
{
    for (struct journal *j = journals; j; j = j->next)
        sdfgi_box_list_add(j->boxes, &j->box_count, JOURNAL_BOXES, box);
}

bool sdfgi_journal_is_empty(const struct journal *journal)
{
    return journal->notes == 0 && journal->box_count == 0;
}

void sdfgi_journal_prepend(struct journal *journal, const struct journal *earlier)
{
    const struct journal later = *journal;
    *journal = *earlier;
    journal->next = later.next;
    journal->notes |= later.notes;
    for (uint32_t i = 0; i < later.box_count; i++)
        sdfgi_box_list_add(journal->boxes, &journal->box_count, JOURNAL_BOXES, &later.boxes[i]);
}

void sdfgi_journal_clear(struct journal *journal)
{
    journal->notes = 0;
    journal->box_count = 0;
}
