/* SPDX-License-Identifier: MIT */
#include "gathering.h"

#include "scene/drift.h"

#include <math.h>

/* So many epochs after a change of lamps or geometry cells still look for what it has changed: light makes a
 * bounce in each. If they did so for as long as sun or sky change, they would wake each other by noise. */
#define LOCAL_EPOCHS 16

/* Frames for which a cell counts as seen, and for which marks on what rays hit are collected and then read.
 */
#define SEEN_FRAMES 64
#define HIT_FRAMES  8

/* First frames in which new cells send SDFGI_NEW_RAYS times as many rays: what is seen has had a rough cycle
 * then. Later few cells are new at a time. */
#define FIRST_FRAMES 20

/* Frames without a change of lights after which cells that one wakes send as many, for as long. Where lights
 * change all the time they do not: frames would take longer for ever. */
#define CALM_FRAMES 120

void sdfgi_gathering_init(struct gathering *gathering)
{
    *gathering = (struct gathering){ .epoch_frames = SDFGI_EPOCH_FRAMES };
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++) {
        gathering->at[c].cycle = 1;
        gathering->at[c].rough = true;
        sdfgi_convergence_reset(&gathering->at[c].convergence);
    }
}

void sdfgi_gathering_restart(struct gathering *gathering)
{
    gathering->first_frames = 0;
}

uint32_t sdfgi_gathering_new_rays(const struct gathering *gathering)
{
    return gathering->first_frames <= FIRST_FRAMES ? SDFGI_NEW_RAYS : 1;
}

void sdfgi_gathering_outdate(struct gathering *gathering)
{
    gathering->epoch_over = gathering->lights_over = true;
    gathering->all_over = true;
}

void sdfgi_gathering_drift(struct gathering *gathering, float change)
{
    gathering->drifted += change;
    if (gathering->drifted > DRIFT_OUTDATES)
        sdfgi_gathering_outdate(gathering);
    gathering->epoch_over = true;
}

void sdfgi_gathering_change(struct gathering *gathering, const struct box *edited)
{
    gathering->epoch_over = true;
    gathering->local_epochs = LOCAL_EPOCHS;
    gathering->lights_over = gathering->lights_over || !edited;
    if (edited)
        sdfgi_edited_places_add(&gathering->edited, edited);
}

void sdfgi_gathering_emitter(struct gathering *gathering, const struct box *box)
{
    sdfgi_gathering_change(gathering, NULL);
    sdfgi_edited_places_add(&gathering->emitters, box);
}

void sdfgi_gathering_flicker(struct gathering *gathering, float change)
{
    gathering->epoch_over = true;
    gathering->local_epochs = LOCAL_EPOCHS;
    gathering->flickered = fmaxf(gathering->flickered, change);
}

bool sdfgi_gathering_changes_are_local(const struct gathering *gathering)
{
    const bool looks = gathering->local_epochs > 0 || gathering->epoch_of_all == gathering->epoch;
    return looks && sdfgi_gathering_next_epoch(gathering) != gathering->epoch_of_all;
}

uint32_t sdfgi_gathering_next_epoch(const struct gathering *gathering)
{
    return gathering->epoch + gathering->epoch_over;
}

/* Cycles are rough at first, as long as light changes much; and further, as long as many cells change, as in
 * a white room, where light makes many bounces. In a large scene some light somewhere changes for long. */
#define ROUGH_CHANGE      (1.0f / 64.0f)
#define FIRST_CYCLES      3
#define MOST_ROUGH_CYCLES 256

static uint32_t visits_of(const struct gather_cursor *cursor, uint32_t cycle_visits)
{
    return cursor->rough && cycle_visits > SDFGI_ROUGH_VISITS ? SDFGI_ROUGH_VISITS : cycle_visits;
}

static void unsettle(struct gather_cursor *cursor)
{
    cursor->settled = false;
    cursor->invalid_cycle = cursor->cycle;
    sdfgi_convergence_reset(&cursor->convergence);
}

/* Cells that are woken begin with rough cycles. */
static void roughen(struct gathering *gathering)
{
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++) {
        gathering->at[c].rough = true;
        gathering->at[c].rough_cycles = 0;
    }
}

/* True if more has changed than sun and sky by a little, and lamps that flicker. */
static bool outdates(const struct gathering *gathering)
{
    return gathering->lights_over || gathering->edited.count > 0;
}

/* What outdates light does not wait for an epoch to end in which all went on from what was known. */
static bool epoch_is_due(const struct gathering *gathering)
{
    const bool waits = gathering->epoch_frames < SDFGI_EPOCH_FRAMES,
               at_once = outdates(gathering) && gathering->epoch_of_local != gathering->epoch;
    return gathering->epoch_over && (!waits || at_once);
}

static void begin_epoch(struct gathering *gathering)
{
    if (gathering->lights_over && gathering->calm_frames == CALM_FRAMES)
        sdfgi_gathering_restart(gathering);
    if (gathering->lights_over)
        gathering->calm_frames = 0;
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        unsettle(&gathering->at[c]);
    gathering->epoch++;
    if (outdates(gathering)) {
        roughen(gathering);
        gathering->epoch_of_local = gathering->epoch;
    }
    gathering->flicker = fmaxf(gathering->flickered, gathering->flicker / 2);
    gathering->local_epochs -= gathering->local_epochs > 0;
    if (gathering->all_over) {
        gathering->epoch_of_all = gathering->epoch;
    } else if (gathering->drifted > 0) {
        gathering->epoch_of_drift = gathering->epoch;
        gathering->drift = fmaxf(gathering->drifted, gathering->drift / 2);
    }
    gathering->epoch_frames = 0;
    gathering->epoch_over = gathering->lights_over = gathering->all_over = false;
    gathering->drifted = gathering->flickered = 0;
    gathering->edited_last = gathering->edited;
    gathering->emitters_last = gathering->emitters;
    gathering->edited = gathering->emitters = (struct edited_places){ .count = 0 };
}

void sdfgi_gathering_begin(struct gathering *gathering, uint64_t invalidations)
{
    if (invalidations != gathering->invalidations)
        for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
            unsettle(&gathering->at[c]);
    gathering->invalidations = invalidations;
    gathering->epoch_frames += gathering->epoch_frames < SDFGI_EPOCH_FRAMES;
    gathering->calm_frames += gathering->calm_frames < CALM_FRAMES;
    if (epoch_is_due(gathering))
        begin_epoch(gathering);
}

/* Goes on with the watched cells of a cascade. Where they lie in the list is not known here: as many entries
 * as hold `most` of them, if they are spread evenly. Ranges of them begin with a word. */
static void take_watched(struct gather_cursor *cursor, uint32_t entries, uint32_t watched, uint32_t most,
                         struct gather_range *range)
{
    const uint64_t span =
        most > 0 ? (uint64_t)entries * most / watched / SDFGI_SEEN_BITS * SDFGI_SEEN_BITS + SDFGI_SEEN_BITS
                 : 0;
    const uint32_t first = cursor->watched_end < entries && span < entries ? cursor->watched_end : 0;
    cursor->watched_first = first;
    cursor->round += first == 0;
    cursor->watched_end = first + span < entries ? first + (uint32_t)span : entries;
    range->watched_span = most > 0 ? cursor->watched_end - first : 0;
    range->watched_count = watched < most ? watched : most;
}

/* Goes on with a cascade, at most to the end of the sweep. */
static struct gather_range take(struct gather_cursor *cursor, uint32_t c, uint32_t entries, uint32_t most,
                                uint32_t cycle_visits)
{
    if (cursor->next >= entries)
        cursor->next = 0;
    struct gather_range range = { .cascade = c,
                                  .first = cursor->next,
                                  .visits = visits_of(cursor, cycle_visits),
                                  .marks = sdfgi_cycle_marks(cursor->cycle, cursor->invalid_cycle) };
    range.begins_cycle = cursor->next == 0 && cursor->sweeps == 0;
    range.count = entries - cursor->next < most ? entries - cursor->next : most;
    cursor->next += range.count;
    if (cursor->next < entries)
        return range;
    cursor->next = 0;
    if (++cursor->sweeps >= range.visits) {
        range.ends_cycle = cursor->cycle++;
        cursor->sweeps = 0;
    }
    return range;
}

/* How many of so many cells that rays hit have their turn. */
static uint64_t hits_in_turn(const struct gathering *gathering, uint64_t hit)
{
    return hit >> gathering->hit_turns_log2;
}

/* Cells that rays hit have visits in turn: half as many as cells that are seen. Where these leave less of the
 * `visits` of a frame, they have fewer, but a quarter of these. */
static void read_hit(struct gathering *gathering, const struct light_lists *lists, uint32_t visits)
{
    uint64_t seen = 0, hit = 0;
    for (uint32_t c = 0; c < lists->cascades; c++) {
        gathering->at[c].hit = lists->hit[c];
        hit += lists->hit[c];
        seen += lists->seen[c];
    }
    const uint64_t left = seen < visits ? visits - seen : 0, room = left > visits / 4 ? left : visits / 4,
                   most = seen / 2 < room ? seen / 2 : room;
    gathering->hit_turns_log2 = 0;
    while (hits_in_turn(gathering, SDFGI_SEEN_BITS) > 1 && hits_in_turn(gathering, hit) > most)
        gathering->hit_turns_log2++;
}

/* Of all visits of a frame, those of watched cells, if these are so many. */
static uint32_t visits_for_watched(uint32_t visits)
{
    return (uint32_t)((uint64_t)visits * 7 / 12);
}

/* How many cells of a cascade are watched and have their turn. */
static uint32_t watched_cells(const struct gathering *gathering, const struct light_lists *lists, uint32_t c)
{
    return lists->seen[c] + (uint32_t)hits_in_turn(gathering, gathering->at[c].hit);
}

/* Shares visits among the watched cells of cascades that have not settled. Those of a cascade count twice as
 * much as those of the next one, because what is near is looked at closely. None gets two visits in a frame.
 * Returns how many were shared out. */
static uint32_t share_watched(const struct gathering *gathering, const struct light_lists *lists,
                              uint32_t visits, uint32_t parts[static SDFGI_MAX_CASCADES])
{
    uint64_t weights[SDFGI_MAX_CASCADES] = { 0 }, sum = 0;
    uint32_t given = 0;
    for (uint32_t c = 0; c < lists->cascades; c++) {
        const uint64_t watched = watched_cells(gathering, lists, c);
        weights[c] = gathering->at[c].settled ? 0 : watched << (SDFGI_MAX_CASCADES - c);
        sum += weights[c];
    }
    for (uint32_t c = 0; c < lists->cascades; c++) {
        const uint64_t part = sum > 0 ? visits * weights[c] / sum : 0;
        const uint32_t watched = watched_cells(gathering, lists, c);
        parts[c] = part < watched ? (uint32_t)part : watched;
        given += parts[c];
    }
    return given;
}

uint32_t sdfgi_gathering_take(struct gathering *gathering, const struct relight *relight,
                              const struct light_lists *lists, uint32_t cells, uint32_t cycle_visits,
                              struct gather_range ranges[static SDFGI_MAX_CASCADES])
{
    uint32_t count = 0, unsettled = 0, watched[SDFGI_MAX_CASCADES];
    gathering->seen_frames = (gathering->seen_frames + 1) % SEEN_FRAMES;
    gathering->first_frames += gathering->first_frames <= FIRST_FRAMES;
    if (sdfgi_gathering_forgets_hit(gathering))
        read_hit(gathering, lists, visits_for_watched(cells));
    uint32_t rest = cells - share_watched(gathering, lists, visits_for_watched(cells), watched);
    for (uint32_t c = 0; c < lists->cascades; c++)
        unsettled += !gathering->at[c].settled;
    for (uint32_t c = 0; c < lists->cascades; c++) {
        if (gathering->at[c].settled) {
            gathering->at[c].watched_first = gathering->at[c].watched_end = 0;
            continue;
        }
        const uint32_t most = --unsettled > 0 ? (rest + 1) / 2 : rest;
        const uint32_t entries = sdfgi_light_list_expected(relight, lists, c);
        /* Where all cells have a visit in each frame there is nothing to choose. */
        const uint32_t watched_most = entries > most + watched[c] ? watched[c] : 0;
        struct gather_range *range = &ranges[count++];
        rest += watched[c] - watched_most;
        *range = take(&gathering->at[c], c, entries, most + watched[c] - watched_most, cycle_visits);
        take_watched(&gathering->at[c], entries, watched_cells(gathering, lists, c), watched_most, range);
        rest -= range->count;
    }
    return count;
}

bool sdfgi_gathering_forgets_hit(const struct gathering *gathering)
{
    return gathering->seen_frames % HIT_FRAMES == 0;
}

void sdfgi_gathering_forget_hit(struct gathering *gathering, uint32_t c)
{
    gathering->at[c].hit = 0;
}

uint32_t sdfgi_gathering_hit_part(const struct gathering *gathering)
{
    return gathering->seen_frames / HIT_FRAMES % 2;
}

uint32_t sdfgi_gathering_hit_bits(const struct gathering *gathering, uint32_t c)
{
    const uint32_t turns = 1u << gathering->hit_turns_log2;
    uint32_t bits = 0;
    for (uint32_t i = gathering->at[c].round % turns; i < SDFGI_SEEN_BITS; i += turns)
        bits |= 1u << i;
    return bits;
}

bool sdfgi_gathering_forgets_seen(const struct gathering *gathering)
{
    return gathering->seen_frames == 0;
}

static bool stays_rough(const struct gather_cursor *cursor, const struct gather_change *change)
{
    if (cursor->rough_cycles < FIRST_CYCLES)
        return change->most >= ROUGH_CHANGE;
    return change->changing > change->cells / 8 && cursor->rough_cycles < MOST_ROUGH_CYCLES;
}

void sdfgi_gathering_add_known(struct gathering *gathering, uint32_t c, uint64_t cycle,
                               const struct gather_change *change)
{
    struct gather_cursor *cursor = &gathering->at[c];
    if (cycle <= cursor->invalid_cycle)
        return;
    sdfgi_convergence_add(&cursor->convergence, change->most);
    sdfgi_convergence_add_drift(&cursor->convergence, change->drift,
                                sdfgi_cycle_span(cycle, cursor->invalid_cycle));
    cursor->settled = sdfgi_convergence_done(&cursor->convergence) && !cursor->rough;
    cursor->rough_cycles += cursor->rough;
    if (!cursor->rough || stays_rough(cursor, change))
        return;
    cursor->rough = false;
    cursor->invalid_cycle = cursor->cycle;
    sdfgi_convergence_reset(&cursor->convergence);
}

bool sdfgi_gathering_has_settled(const struct gathering *gathering, uint32_t cascades)
{
    for (uint32_t c = 0; c < cascades; c++)
        if (!gathering->at[c].settled)
            return false;
    return true;
}
