/* SPDX-License-Identifier: MIT */
#include "journal.h"

void journal_note(struct journal *journals, enum journal_note note)
{
    for (struct journal *j = journals; j; j = j->next)
        j->notes |= (uint32_t)note;
}

void journal_add_box(struct journal *journals, const struct box *box)
{
    for (struct journal *j = journals; j; j = j->next)
        box_list_add(j->boxes, &j->box_count, JOURNAL_BOXES, box);
}

bool journal_is_empty(const struct journal *journal)
{
    return journal->notes == 0 && journal->box_count == 0;
}

void journal_clear(struct journal *journal)
{
    journal->notes = 0;
    journal->box_count = 0;
}
