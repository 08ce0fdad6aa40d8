/* SPDX-License-Identifier: MIT */
#include "relight.h"

#include <assert.h>

/* Of frames that are all busy, one in so many lights cells again. */
#define PATIENCE 4

void sdfgi_relight_init(struct relight *relight)
{
    *relight = (struct relight){ .budget = RELIGHT_CELLS };
}

void sdfgi_relight_count(struct relight *relight)
{
    relight->lit = relight->lit % SDFGI_LIGHT_MOST_LIT + 1;
}

uint32_t sdfgi_light_list_entries(const struct relight *relight, const struct light_lists *lists, uint32_t c)
{
    const bool known = lists->frame >= relight->at[c].listed_at + lists->frames_in_flight;
    return known && lists->counted[c] < lists->room ? lists->counted[c] : lists->room;
}

/* How many cells an edit may add. */
#define MORE_CELLS 1024

uint32_t sdfgi_light_list_expected(const struct relight *relight, const struct light_lists *lists, uint32_t c)
{
    const uint32_t entries = sdfgi_light_list_entries(relight, lists, c), counted = lists->counted[c],
                   expected = counted + counted / 8 + MORE_CELLS;
    const bool alike = lists->frame >= relight->at[c].made_at + lists->frames_in_flight;
    return alike && expected < entries ? expected : entries;
}

static uint32_t less(uint32_t count, uint32_t by)
{
    return by < count ? count - by : 0;
}

/* Leaves so many entries behind. */
static void pass(struct relight_cursor *cursor, uint32_t entries)
{
    cursor->left = less(cursor->left, entries);
    cursor->shadows = less(cursor->shadows, entries);
}

/* Goes on to the next entry that there is. */
static void skip_room(struct relight *relight, const struct light_lists *lists, uint32_t c)
{
    struct relight_cursor *cursor = &relight->at[c];
    const uint32_t entries = sdfgi_light_list_entries(relight, lists, c);
    while (cursor->left > 0 && cursor->next >= entries) {
        assert(cursor->next <= lists->room);
        pass(cursor, lists->room - cursor->next);
        cursor->next = 0;
    }
}

bool sdfgi_relight_is_due(const struct relight *relight)
{
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        if (relight->at[c].left > 0)
            return true;
    return false;
}

/* A change of a cascade throws shadows on finer ones, too: their rays go on into coarser cascades. */
static uint32_t cascades_in_shadow(const struct light_lists *lists, const enum relist *relists)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < lists->cascades; c++)
        if (relists[c] != RELIST_NOT)
            count = c + 1;
    return count;
}

static void note_list(struct relight_cursor *cursor, enum relist relist, uint64_t frame)
{
    if (relist != RELIST_NOT)
        cursor->listed_at = frame;
    if (relist == RELIST_NEW)
        cursor->made_at = frame;
}

/* All cells have their turn while a sun changes by this part of its light. */
#define DRIFT_OF_TURN (1.0f / 64.0f)

/* How many cells are to be lit in a frame, so that those which wait for their turn are not far behind. */
static uint32_t cells_to_follow(const struct relight *relight, const struct light_lists *lists, float drift)
{
    uint32_t cells = 0;
    for (uint32_t c = 0; c < lists->cascades; c++)
        cells += sdfgi_light_list_entries(relight, lists, c);
    return drift < DRIFT_OF_TURN ? (uint32_t)((float)cells * (drift / DRIFT_OF_TURN)) : cells;
}

/* Where a list changes, or a sun, while a pass over it is under way, the pass goes on at the same entry until
 * it has come round once more: it may have passed by cells that have moved to entries before it. */
void sdfgi_relight_note(struct relight *relight, const struct light_lists *lists,
                        const enum relist relists[static SDFGI_MAX_CASCADES], const struct sun_drift *suns,
                        bool lit_anyway)
{
    const uint32_t in_shadow = cascades_in_shadow(lists, relists);
    for (uint32_t c = 0; c < lists->cascades; c++)
        note_list(&relight->at[c], relists[c], lists->frame);
    if (!sdfgi_relight_is_due(relight)) {
        relight->cascade = 0;
        relight->suns = (struct light_bits){ 0 };
    }
    sdfgi_light_bits_add(&relight->suns, &suns->bits);
    relight->hurries = cells_to_follow(relight, lists, suns->most);
    for (uint32_t c = 0; c < lists->cascades; c++) {
        if (c < in_shadow)
            relight->at[c].shadows = lists->room;
        if (c < in_shadow || suns->bits.changed != 0)
            relight->at[c].left = lists->room;
        if (relists[c] == RELIST_NEW || lit_anyway)
            relight->at[c].left = relight->at[c].shadows = 0;
        skip_room(relight, lists, c);
    }
}

/* Goes on with a cascade, at most to the end of its list. */
static struct relight_range take(struct relight *relight, const struct light_lists *lists, uint32_t c,
                                 uint32_t most)
{
    struct relight_cursor *cursor = &relight->at[c];
    struct relight_range range = { .cascade = c, .first = cursor->next };
    if (cursor->left == 0)
        return range;
    range.count = sdfgi_light_list_entries(relight, lists, c) - cursor->next;
    range.count = range.count < cursor->left ? range.count : cursor->left;
    range.count = range.count < most ? range.count : most;
    cursor->next += range.count;
    pass(cursor, range.count);
    skip_room(relight, lists, c);
    return range;
}

struct light_bits sdfgi_relight_lights(const struct relight *relight)
{
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        if (relight->at[c].shadows > 0)
            return (struct light_bits){ SDFGI_LIGHT_ALL, SDFGI_LIGHT_ALL };
    return relight->suns;
}

uint32_t sdfgi_relight_take(struct relight *relight, const struct light_lists *lists, bool busy,
                            struct relight_range ranges[static SDFGI_MAX_CASCADES])
{
    uint32_t count = 0, left = relight->hurries > relight->budget ? relight->hurries : relight->budget;
    relight->waits = busy ? (relight->waits + 1) % PATIENCE : 0;
    if (relight->waits > 0 || !sdfgi_relight_is_due(relight))
        return 0;
    for (uint32_t i = 0; i < lists->cascades && left > 0; i++) {
        const struct relight_range range = take(relight, lists, relight->cascade, left);
        left -= range.count;
        if (range.count > 0)
            ranges[count++] = range;
        /* In turn, so that changes frame after frame do not keep coarse cascades waiting for ever. */
        if (left > 0)
            relight->cascade = (relight->cascade + 1) % lists->cascades;
    }
    return count;
}
