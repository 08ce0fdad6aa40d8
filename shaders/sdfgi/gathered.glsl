/* SPDX-License-Identifier: MIT
 * What light cells have gathered with rays of their own. A visit sends SDFGI_VISIT_RAYS rays from a cell for
 * each axis along which a surface faces; a gather cycle is so many visits. Every cycle repeats the directions
 * of the one before, so what a static scene gathers converges exactly. A long cycle has four times as many as
 * a complete one (gather_cycle.glsl). Per axis a cell has two values:
 *
 * S  Once a cycle has been completed, the sum of this cycle's visits so far. In the first cycle of a new
 *    cell, a mean of the visits so far, in which later ones count more, because they see more bounces.
 * P  The mean of the last complete cycle. After the lights have changed, what the cell showed before.
 *
 * A cell shows P once a cycle has been completed. It does not show S then, because the rays of a part of a
 * cycle have another mean than all of them even while the light stays the same. Only where P is the mean of a
 * rough cycle S is mixed in: at once if that was a first one, or else once it holds as many visits. In the
 * first long cycle, and while light drifts or flickers, it is mixed in at once: its rays are others than
 * those of P. In its first cycle, and in the first one after the lights have changed, a cell shows S; a new
 * cell shows what probes tell before its first visit. */
#ifndef SDFGI_GATHERED_GLSL
#define SDFGI_GATHERED_GLSL

#include "light_cells.glsl"
#include "../lib/rgb48.glsl"

/* Per cascade SDFGI_GATHERED_WORDS planes with a word per entry of the light list: three words per axis with
 * S and P, 48 bits each (lib/rgb48.glsl); the packed gathered_state; and per axis the irradiance before it is
 * filtered, and between the two runs of the filter, as the surfaces' of sdfgi_resources.glsl; its noise; and
 * the last epoch in which its outgoing light changed so much that cells which see it are to be woken. Sums
 * count a visit as 1 / gathered_long_visits(). Behind them stand the counters from SDFGI_COUNTER_GATHER on.
 */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_GATHERED) buffer sdfgi_gathered_buffer
{
    uint sdfgi_gathered[];
};

/* What a cell knows before its first visit counts as half a visit: little, so that cells soon show what they
 * see themselves; not nothing, because the rays of one visit alone are noisy. */
const float GATHERED_PRIOR_VISITS = 0.5;
/* Weight of a visit in S in a first cycle, at least: of six visits and of the two after them, in turn. Light
 * that has gone is soon forgotten (a room of albedo 0.5 has a tenth of a lamp left after ten), and noise is
 * low at the end of a cycle of eight visits, or of a multiple of eight. */
const vec2 GATHERED_RECENT = vec2(0.6, 0.3);
/* A mean of such a cycle is as noisy as one of so many visits that count alike. */
const float GATHERED_FIRST_VISITS = 4.2;
/* And one in which the newest counts GATHERED_RECENT.x. */
const float GATHERED_RECENT_VISITS = 2.3;

/* What P is. */
const uint GATHERED_NOTHING = 0u;  /* there is none: the cell is new */
const uint GATHERED_OUTDATED = 1u; /* what the cell showed before the lights changed */
const uint GATHERED_FIRST = 2u;    /* the mean of a first cycle that was rough */
const uint GATHERED_DRIFTS = 3u;   /* what it showed before light drifted, or lamps flickered */
const uint GATHERED_ROUGH = 4u;    /* the mean of a later rough cycle */
const uint GATHERED_COMPLETE = 5u; /* the mean of a complete cycle */
const uint GATHERED_GOES_ON = 6u;  /* that, too, and the first long cycle is under way */
const uint GATHERED_LONG = 7u;     /* the mean of a long cycle */

const uint GATHERED_MOST_VISITS = 128u; /* in a cycle */

struct gathered_state {
    uint visits; /* in this cycle, less than GATHERED_MOST_VISITS */
    uint mean;   /* GATHERED_NOTHING to _LONG */
    uint epoch;  /* whose changes S and P have taken in; 8 bits */
    uint mark;   /* P when it was last marked, as gathered_mark tells; 14 bits. While it drifts: how many
                  * visits P counts as */
};

/* False if light cells read probes alone. */
bool gathers()
{
    return sdfgi_frame.cycle_visits > 0u;
}

/* Visits in a long cycle. */
uint gathered_long_visits()
{
    return min(4u * sdfgi_frame.cycle_visits, GATHERED_MOST_VISITS);
}

/* Word `plane` of an entry. */
uint gathered_word(uint cascade, uint plane, uint entry)
{
    return (cascade * SDFGI_GATHERED_WORDS + plane) * sdfgi_frame.light_cell_room + entry;
}

/* Word of a counter. */
uint gathered_counter(uint counter)
{
    return gathered_word(sdfgi_frame.cascade_count, 0u, 0u) + counter - uint(SDFGI_COUNTER_GATHER);
}

const uint GATHERED_STATE = 18u, GATHERED_RAW = 19u, GATHERED_BETWEEN = 25u, GATHERED_NOISE = 31u,
           GATHERED_CHANGED = 32u;

gathered_state gathered_load_state(uint cascade, uint entry)
{
    const uint packed = sdfgi_gathered_at(gathered_word(cascade, GATHERED_STATE, entry));
    return gathered_state(packed & 0x7fu, packed >> 7u & 7u, packed >> 10u & 0xffu, packed >> 18u);
}

void gathered_store_state(uint cascade, uint entry, gathered_state state)
{
    sdfgi_gathered[gathered_word(cascade, GATHERED_STATE, entry)] =
        state.visits | state.mean << 7u | state.epoch << 10u | state.mark << 18u;
}

/* ---- Epochs: times in which something has changed. A change wakes the cells that it reaches: what they show
 * is outdated. */

/* What a cell keeps of an epoch; and how many epochs it may lie back: later its number comes again. */
const uint EPOCH_MASK = 0xffu, EPOCHS_BACK = 64u;

/* Epochs that a cell has not taken in. */
uint gathered_epochs_behind(gathered_state state)
{
    return sdfgi_frame.epoch - state.epoch & EPOCH_MASK;
}

/* True if an epoch has come of late, and the cell has not taken in what changed in it. */
bool gathered_is_behind(gathered_state state, uint epoch)
{
    return sdfgi_frame.epoch - epoch < min(gathered_epochs_behind(state), EPOCHS_BACK);
}

/* Noise: variance over the square of what the cell shows, of the axis with the most of it. */
struct gathered_noise {
    float sum;   /* of the means of this cycle's visits so far */
    float shown; /* of what the cell shows; 0 while that is what probes tell */
};

/* The high half of the word is that of the float `shown`, which therefore costs nothing to unpack; the low
 * one is `sum` as a half float. */
float gathered_load_shown_noise(uint cascade, uint entry)
{
    return uintBitsToFloat(sdfgi_gathered_at(gathered_word(cascade, GATHERED_NOISE, entry)) & 0xffff0000u);
}

gathered_noise gathered_load_noise(uint cascade, uint entry)
{
    const uint packed = sdfgi_gathered_at(gathered_word(cascade, GATHERED_NOISE, entry));
    return gathered_noise(unpackHalf2x16(packed).x, uintBitsToFloat(packed & 0xffff0000u));
}

void gathered_store_noise(uint cascade, uint entry, gathered_noise noise)
{
    sdfgi_gathered[gathered_word(cascade, GATHERED_NOISE, entry)] =
        (floatBitsToUint(noise.shown) & 0xffff0000u) | packHalf2x16(vec2(noise.sum, 0.0));
}

/* How many visits P is worth where S is mixed in. */
float gathered_worth(gathered_state state)
{
    return state.mean == GATHERED_FIRST    ? GATHERED_FIRST_VISITS
           : state.mean == GATHERED_DRIFTS ? float(state.mark)
           : state.mean == GATHERED_ROUGH  ? float(SDFGI_ROUGH_VISITS)
                                           : float(sdfgi_frame.cycle_visits);
}

/* True if each visit makes what the cell shows better. */
bool gathered_mixes(gathered_state state)
{
    return state.mean == GATHERED_FIRST || state.mean == GATHERED_DRIFTS || state.mean == GATHERED_GOES_ON;
}

/* Of how many visits what a cell shows is the mean, from the end of its first cycle on. */
float gathered_shown_visits(gathered_state state)
{
    const float visits = float(state.visits), worth = gathered_worth(state);
    return state.mean == GATHERED_LONG ? float(gathered_long_visits())
           : gathered_mixes(state) || state.mean == GATHERED_ROUGH && visits >= worth ? visits + worth
                                                                                      : worth;
}

/* Noise of one visit in a first cycle, whatever its rays found: rays that would have found more may come. The
 * last two visits count most. */
const float GATHERED_NOISE_OF_VISIT = 0.5;

/* Noise that the mean of a first cycle has at least, for the same reason, with so many visits after it. Cells
 * that have missed what is bright take themselves for sure, and would show as dark spots. */
float gathered_least_noise(float visits)
{
    const float share = GATHERED_FIRST_VISITS / (GATHERED_FIRST_VISITS + visits);
    return 0.5 * GATHERED_NOISE_OF_VISIT * share * share * share;
}

/* Noise after a visit that found `found`; `state` is the one before it. `mean`: what the cycle makes that
 * ends with the visit, or GATHERED_NOTHING. After a first cycle each visit adds to its mean, as in a first
 * long cycle. */
gathered_noise gathered_add_noise(gathered_state state, gathered_noise noise, float found, uint mean)
{
    const float visits = float(state.visits + 1u);
    const bool is_first = state.mean < GATHERED_FIRST, goes_on = mean == GATHERED_NOTHING;
    noise.sum = found + (state.visits > 0u ? noise.sum : 0.0);
    const float of_visit = noise.sum / visits;
    if (is_first && goes_on)
        noise.shown = GATHERED_NOISE_OF_VISIT / min(visits, 2.0);
    else if (is_first)
        noise.shown =
            max(of_visit / GATHERED_FIRST_VISITS, mean == GATHERED_FIRST ? gathered_least_noise(0.0) : 0.0);
    else if (!goes_on)
        noise.shown = of_visit / visits;
    else if (state.mean == GATHERED_DRIFTS)
        noise.shown = of_visit / (visits + gathered_worth(state));
    else if (state.mean == GATHERED_FIRST)
        noise.shown = max(of_visit / (GATHERED_FIRST_VISITS + visits), gathered_least_noise(visits));
    else if (gathered_mixes(state))
        noise.shown *= 1.0 - 1.0 / (visits + gathered_worth(state));
    return noise;
}

/* ---- Marks: logarithms of light in MARK_STEPS parts of an octave, modulo eight octaves. They tell small
 * changes of light of any brightness. */

const int MARK_BITS = 14, MARK_STEPS = 1 << MARK_BITS - 3;

uint gathered_mark(float light)
{
    const float octaves = clamp(log2(max(light + sdfgi_frame.dark, 1e-30)), -100.0, 128.0);
    return uint(int(round(octaves * float(MARK_STEPS)))) & (1u << MARK_BITS) - 1u;
}

/* Relative change from one mark to another, at most 1. */
float gathered_mark_change(uint from, uint to)
{
    const int steps = int(to - from << 32 - MARK_BITS) >> 32 - MARK_BITS;
    return 1.0 - exp2(-float(abs(steps)) / float(MARK_STEPS));
}

/* S and P of an axis. */
struct gathered_light {
    vec3 sum, mean;
};

gathered_light gathered_load(uint cascade, uint entry, uint axis)
{
    const uint plane = sdfgi_frame.light_cell_room, word = gathered_word(cascade, 3u * axis, entry);
    const uint shared_word = sdfgi_gathered_at(word + plane);
    return gathered_light(
        sdfgi_rgb48_decode(uvec2(sdfgi_gathered_at(word), shared_word & 0xffffu)),
        sdfgi_rgb48_decode(uvec2(sdfgi_gathered_at(word + 2u * plane), shared_word >> 16u)));
}

void gathered_store(uint cascade, uint entry, uint axis, gathered_light light)
{
    const uint plane = sdfgi_frame.light_cell_room, word = gathered_word(cascade, 3u * axis, entry);
    const uvec2 sum = sdfgi_rgb48_encode(light.sum), mean = sdfgi_rgb48_encode(light.mean);
    sdfgi_gathered[word] = sum.x;
    sdfgi_gathered[word + plane] = sum.y | mean.y << 16u;
    sdfgi_gathered[word + 2u * plane] = mean.x;
}

/* The irradiance that a cell shows along an axis. `prior` is what probes tell, with its weight, 0 or 1, in a.
 * False if there is nothing to tell. */
bool gathered_irradiance(gathered_state state, gathered_light gathered, vec4 prior, out vec3 light)
{
    light = gathered.mean;
    if (state.mean == GATHERED_OUTDATED && state.visits > 0u)
        light = gathered.sum;
    const float worth = gathered_worth(state);
    if (gathered_mixes(state) || state.mean == GATHERED_ROUGH && float(state.visits) >= worth)
        light = (gathered.sum * float(gathered_long_visits()) + gathered.mean * worth) /
                (float(state.visits) + worth);
    if (state.mean != GATHERED_NOTHING)
        return true;
    const vec4 known = float(state.visits) * vec4(gathered.sum, 1.0) +
                       prior.a * GATHERED_PRIOR_VISITS * vec4(prior.rgb, 1.0);
    light = known.rgb / max(known.a, 1e-6);
    return known.a > 0.0;
}

/* S after a visit that found `light`; `state` is the one before it. */
vec3 gathered_add(gathered_state state, gathered_light gathered, vec3 light)
{
    if (state.mean >= GATHERED_FIRST)
        return gathered.sum + light / float(gathered_long_visits());
    const float before =
        float(state.visits) + (state.mean == GATHERED_OUTDATED ? GATHERED_PRIOR_VISITS : 0.0);
    return mix(state.visits == 0u ? gathered.mean : gathered.sum, light,
               max(1.0 / (before + 1.0), state.visits % 8u < 6u ? GATHERED_RECENT.x : GATHERED_RECENT.y));
}

/* The mean of a cycle that ends with this S, after so many visits. */
vec3 gathered_mean(gathered_state state, vec3 sum, uint visits)
{
    return state.mean >= GATHERED_FIRST ? sum * (float(gathered_long_visits()) / float(visits)) : sum;
}

#endif
