/* SPDX-License-Identifier: MIT
 * The state with which a visit to a light cell begins: as the last one left it, anew, or from what the cell
 * has shown. */
#ifndef SDFGI_CELL_STATES_GLSL
#define SDFGI_CELL_STATES_GLSL

#include "gathered.glsl"

bool is_new(gathered_state state)
{
    return state.mean == GATHERED_NOTHING && state.visits == 0u;
}

/* The state of a cell that is woken: a cycle begins anew. */
gathered_state state_woken(gathered_state state)
{
    return gathered_state(0u, is_new(state) ? GATHERED_NOTHING : GATHERED_OUTDATED,
                          sdfgi_frame.epoch & EPOCH_MASK, state.mark);
}

/* What a cell knows of light that has changed by this part counts as a visit. */
const float DRIFT_OF_VISIT = 0.125;
/* The same of lamps that flicker, whose mean goes to and fro. */
const float FLICKER_OF_VISIT = 0.5;
/* It counts as so many at most, and as one at least. */
const float DRIFT_MOST_VISITS = 96.0;

/* True if the light of a cell has drifted since it was last visited. While it drifts a cell lies back by an
 * epoch: its rays go on to look for what has changed in that. */
bool has_drifted(gathered_state state)
{
    const uint behind = gathered_epochs_behind(state), since = sdfgi_frame.epoch - sdfgi_frame.epoch_of_drift;
    return state.mean >= GATHERED_FIRST &&
           since + (state.mean == GATHERED_DRIFTS ? 1u : 0u) < min(behind, EPOCHS_BACK);
}

/* The state of a cell that goes on from what it has shown. That counts as so many visits at most: the fewer,
 * the more may have changed. */
gathered_state state_going_on(gathered_state state, float visits)
{
    const float most = clamp(visits, 1.0, DRIFT_MOST_VISITS),
                shown = state.mean < GATHERED_FIRST ? min(float(state.visits), GATHERED_RECENT_VISITS)
                                                    : gathered_shown_visits(state);
    return gathered_state(0u, GATHERED_DRIFTS, state.epoch, uint(round(min(shown, most))));
}

/* That of one whose light has drifted. */
gathered_state state_drifted(gathered_state state)
{
    const float change = sdfgi_frame.drift * float(gathered_epochs_behind(state));
    return state_going_on(state, DRIFT_OF_VISIT / max(change, 1e-6));
}

/* Epochs for which light goes round corners, after a change that outdates what is known. */
const uint LOCAL_CHANGE_EPOCHS = 6u;

/* That of one which a change reaches. If lamps that flicker alone have changed, it goes on. */
gathered_state state_reached(gathered_state state)
{
    const uint behind = max(gathered_epochs_behind(state), LOCAL_CHANGE_EPOCHS);
    if (state.mean < GATHERED_FIRST && state.visits == 0u ||
        sdfgi_frame.epoch - sdfgi_frame.epoch_of_local < behind)
        return state_woken(state);
    gathered_state reached = state_going_on(state, FLICKER_OF_VISIT / max(sdfgi_frame.flicker, 1e-6));
    reached.epoch = sdfgi_frame.epoch & EPOCH_MASK;
    return reached;
}

/* The state with which a visit begins, as far as it is known before the rays. `begins`: see visited_cell. */
gathered_state state_of_visit(uint cascade, uint entry, out bool begins)
{
    gathered_state state = gathered_load_state(cascade, entry);
    begins = is_new(state) || gathered_is_behind(state, sdfgi_frame.epoch_of_all) ||
             gathered_epochs_behind(state) > EPOCHS_BACK;
    /* Visited cells alone lie back for long. */
    state.epoch = sdfgi_frame.epoch - min(gathered_epochs_behind(state), EPOCHS_BACK / 2u) & EPOCH_MASK;
    if (begins)
        return state_woken(state);
    begins = has_drifted(state);
    return begins ? state_drifted(state) : state;
}

#endif
