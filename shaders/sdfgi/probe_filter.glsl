/* SPDX-License-Identifier: MIT
 * The temporal filter of probe_blend, for one texel and for what all texels of a probe share.
 *
 * A sample cycle takes several frames. Until it is complete, the mean of the cycle before stands for the
 * samples that are missing. Per texel there are the sum S and the weight w of this cycle so far, the mean P
 * and the weight p of the cycle before, and the weight W of a complete cycle:
 *
 *     missing weight   m = min(p, max(W - w, 0)), and 0 once the cycle is complete
 *     estimate         E = (S + m P) / (w + m)
 *     change           c = |E - P| / (max(E, P) + a little), the largest of the channels
 *
 * At the end of a cycle E becomes P, w + m becomes p, and S becomes 0. Every cycle repeats the directions of
 * the one before, so the estimates of a static scene converge exactly.
 *
 * The estimate of a partial cycle deviates from P even while the light stays the same, because the samples
 * so far have another mean than the complete cycle. It does so by the same amounts in every cycle. A texel
 * therefore displays only as much of a change as exceeds the deviation d of the cycle before:
 *
 *     displayed        D = mix(previous D, mix(P, E, k), DISPLAY_BLEND)
 *     with             k = max(1 - d / c, 0), or 1 at the end of a cycle
 *
 * Lookups read D. Light cells read E, because light then converges sooner: alpha holds E over D.
 *
 * That is the filter of a STEADY probe. A probe that is WARMING_UP displays E, because its d is unknown. So
 * does a NEW probe, whose estimate becomes P in every frame. Its m is at most w, so its history counts for no
 * more than the samples that it has just read; a texel that no ray has reached in this frame keeps its
 * history. In both states alpha holds the confidence, negated. A probe is NEW until its second cycle after a
 * history reset ends, and STEADY when its fourth has ended.
 *
 * All texels of a probe share d, and the history of a STEADY probe is reset when its light is sure to change
 * by half. The probe is NEW again then. Both follow from C, the largest c of its texels in a frame:
 *
 *     deviation        d = max(sqrt(M^2 - L^2), DEVIATION_KEPT * previous d)
 *                      M is the largest C of a cycle, and L its last C: a change that stays is no deviation
 *     history reset    if C > RESET_CHANGE * g + RESET_DEVIATIONS * d + RESET_MARGIN
 *                      g is the fraction of the cycle that has been sampled so far */
#ifndef SDFGI_PROBE_FILTER_GLSL
#define SDFGI_PROBE_FILTER_GLSL

#include "probe_store.glsl"
#include "../lib/light_pack.glsl"

SDFGI_PUSH(sdfgi_probe_blend_args);

/* A cycle is complete from this fraction of W on: weights are stored as half floats, which are rounded. */
const float COMPLETE_FRACTION = 0.99;
const float HALF_MAX = 65504.0;
/* The smallest half float with all digits, and the step from one to the next below it. */
const float HALF_NORMAL = 1.0 / 16384.0, HALF_STEP = 1.0 / 16777216.0;
/* The history of a NEW probe counts for this much of what the probe has just read, at most. */
const float NEW_HISTORY_WEIGHT = 1.0;
/* After a history reset, the light so far counts for this fraction of a cycle at most. */
const float RESET_HISTORY_FRACTION = 0.125;

/* A history is reset if the light is sure to change by this much within a cycle. With a quarter instead,
 * light under a lamp that moves at 3 m/s had half as much noise again, and it was further behind the lamp. */
const float RESET_CHANGE = 0.5;
/* A change is sure if it exceeds the deviation by half of it, and by a margin for rounding. */
const float RESET_DEVIATIONS = 1.5;
const float RESET_MARGIN = 0.02;

/* Weight of the target in what a texel displays: new light fades in over several frames. */
const float DISPLAY_BLEND = 0.25;
/* A texel that changes by less than this over a cycle displays its estimate exactly, so that light converges.
 * Nobody sees a step of this size. */
const float INVISIBLE_CHANGE = 1.0 / 256.0;
/* A deviation falls by no more than a quarter in a cycle, because after a cycle in which light changed, it
 * cannot be told from the change and comes out too small. */
const float DEVIATION_KEPT = 0.75;
/* A fraction of the brightest channel. Channels of a light cell share an exponent: one of a quarter of the
 * brightest is rounded by up to 0.8 % of itself, and light goes round in circles that wide. */
const float WEAKEST_CHANNEL = 0.25;
/* Light cells read at most this many times what is displayed, and at least its inverse. */
const float MAX_GAIN = 8.0;

struct texel {
    vec4 sum;      /* S and w */
    vec4 previous; /* P and p */
    vec4 estimate; /* E and w + m */
    float change;  /* c */
    bool clamped;  /* E was more than a half float holds */
};

/* A probe whose texels are filtered. */
struct filtered_probe {
    uint slot;
    probe_history history; /* before this frame */
    uint state;
};

bool cycle_ends()
{
    return args.cycle_ends != 0u;
}

/* No probe is STEADY before a first sample cycle is complete, counted from when the cascades were empty. */
uint filter_state(probe_history history)
{
    const uint state = probe_history_state(history);
    return args.without_history != 0u ? min(state, PROBE_WARMING_UP) : state;
}

/* Relative difference of two colours, at most 1. No channel counts as weaker than WEAKEST_CHANNEL. What half
 * floats round off that are too small for all of their digits does not count. */
float texel_change(vec3 estimate, vec3 previous)
{
    const vec3 larger = max(estimate, previous);
    const float weakest = WEAKEST_CHANNEL * max(larger.r, max(larger.g, larger.b));
    const vec3 rounded = HALF_STEP * vec3(lessThan(larger, vec3(HALF_NORMAL)));
    const vec3 change =
        max(abs(estimate - previous) - rounded, 0.0) / (max(larger, weakest) + sdfgi_frame.dark);
    return min(max(change.r, max(change.g, change.b)), 1.0);
}

/* m, for the weights w and p. */
float missing_weight(float sum_weight, float previous_weight, bool is_new)
{
    /* W. The maximum is for a probe that became new in the middle of the cycle before: p is too small. */
    const float cycle = max(previous_weight, probe_cycle_weight());
    const bool complete = cycle_ends() && sum_weight > COMPLETE_FRACTION * cycle;
    float missing =
        complete || args.without_history != 0u ? 0.0 : min(previous_weight, max(cycle - sum_weight, 0.0));
    if (is_new && sum_weight > 0.0)
        missing = min(previous_weight, NEW_HISTORY_WEIGHT * sum_weight);
    return missing;
}

texel texel_load(filtered_probe probe, uint k)
{
    texel t;
    t.sum = probe_load_sum(probe.slot, k);
    t.previous = probe_load_previous(probe.slot, k);
    const float missing = missing_weight(t.sum.w, t.previous.w, probe.state == PROBE_NEW);
    const float weight = t.sum.w + missing;
    const vec3 mean = (t.sum.rgb + missing * t.previous.rgb) / max(weight, 1e-12);
    t.clamped = any(greaterThan(mean, vec3(HALF_MAX)));
    t.estimate = vec4(min(mean, vec3(HALF_MAX)), weight);
    t.change = texel_change(t.estimate.rgb, t.previous.rgb);
    return t;
}

/* Whether the history of a probe is reset, whose texels have changed by `change` at most. */
bool probe_resets(filtered_probe probe, float change)
{
    if (probe.state != PROBE_STEADY)
        return false;
    const float sampled =
        float(sdfgi_frame.first_sample + sdfgi_frame.rays_per_frame) / float(sdfgi_frame.cycle_samples);
    return change > RESET_CHANGE * sampled + RESET_DEVIATIONS * probe.history.deviation + RESET_MARGIN;
}

/* E over D, as luminances. */
float texel_gain(vec3 displayed, vec3 estimate)
{
    const float a = sdfgi_light_luminance(displayed), b = sdfgi_light_luminance(estimate);
    return a > 0.0 ? clamp(b / a, 1.0 / MAX_GAIN, MAX_GAIN) : 1.0;
}

/* D and the gain, of a steady probe. */
vec4 texel_display(texel t, vec3 displayed_before, float deviation)
{
    const float k = cycle_ends() ? 1.0 : max(1.0 - deviation / max(t.change, 1e-12), 0.0);
    const vec3 target = mix(t.previous.rgb, t.estimate.rgb, k);
    const bool exact = cycle_ends() && t.change < INVISIBLE_CHANGE;
    const vec3 displayed = mix(displayed_before, target, exact ? 1.0 : DISPLAY_BLEND);
    return sdfgi_irradiance_pack_gain(displayed, texel_gain(displayed, t.estimate.rgb));
}

void texel_publish(filtered_probe probe, uint k, texel t, uint state)
{
    vec4 value = sdfgi_irradiance_pack_confidence(t.estimate.rgb, probe_confidence(t.estimate.w));
    if (state == PROBE_STEADY)
        value = texel_display(t, probe_load_irradiance(probe.slot, k).rgb, probe.history.deviation);
    probe_store_irradiance(probe.slot, k, value);
}

/* The estimate becomes the mean of the cycle before, and the sums start again. */
void texel_start_cycle(filtered_probe probe, uint k, texel t, bool resets)
{
    const float most = resets ? RESET_HISTORY_FRACTION * probe_cycle_weight() : HALF_MAX;
    probe_store_previous(probe.slot, k, t.estimate.rgb, min(t.estimate.w, most));
    sdfgi_sums[probe_sums(probe.slot) + k] = vec4(0.0);
}

void texel_store(filtered_probe probe, uint k, texel t, bool resets)
{
    const uint state = resets ? PROBE_NEW : probe.state;
    texel_publish(probe, k, t, state);
    if (cycle_ends() || state == PROBE_NEW)
        texel_start_cycle(probe, k, t, resets);
}

probe_history next_history(probe_history h, float change, bool resets)
{
    h.largest_change = max(h.largest_change, change);
    h.cycles = resets ? 0.0 : h.cycles;
    if (!cycle_ends())
        return h;
    const float deviation = sqrt(max(h.largest_change * h.largest_change - change * change, 0.0));
    h.deviation = max(deviation, DEVIATION_KEPT * h.deviation);
    h.largest_change = 0.0;
    h.cycles = min(h.cycles + 1.0, PROBE_STEADY_CYCLES);
    return h;
}

/* Tells the host how far light is from converged. Where the cycle before was not complete, the change is
 * unknown. It counts as 1 then, so that light is not taken for converged. */
void count_change(probe_history history, float change)
{
    const bool known = history.cycles >= PROBE_COMPLETE_CYCLES;
    atomicMax(sdfgi_counters[SDFGI_COUNTER_MAX_CHANGE], floatBitsToUint(known ? change : 1.0));
}

/* The same of the change since the probe was marked. */
void count_drift(float light, float mark)
{
    const float larger = max(light, mark) + float(SDFGI_IRRADIANCE_COUNT) * sdfgi_frame.dark;
    atomicMax(sdfgi_counters[SDFGI_COUNTER_MAX_DRIFT], floatBitsToUint(min(abs(light - mark) / larger, 1.0)));
}

/* ---- The probe */

/* False if the probe is dead or not valid. */
bool probe_begin(uint cascade, uint linear, out filtered_probe probe)
{
    const ivec3 coords = probe_from_linear(linear);
    probe.slot = sdfgi_probe_index(cascade, coords);
    if (sdfgi_probe_is_dead(sdfgi_probes_at(probe.slot)) || !sdfgi_probe_is_valid(cascade, coords))
        return false;
    probe.history = probe_history_load(probe.slot);
    probe.state = filter_state(probe.history);
    return true;
}

/* Stores the history. `change`: of its texels, the largest; `light`: the sum of their luminances, in order,
 * which is used where args.marks asks for it. */
void probe_end(filtered_probe probe, float change, float light, bool resets)
{
    probe_history next = next_history(probe.history, change, resets);
    if (args.marks != 0u)
        next.mark = light;
    probe_history_store(probe.slot, next);
    if (cycle_ends())
        count_change(probe.history, change);
    if (args.marks != 0u)
        count_drift(light, probe.history.mark);
}

#endif
