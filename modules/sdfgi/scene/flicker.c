/* SPDX-License-Identifier: MIT */
#include "flicker.h"

#include "drift.h"
#include "same.h"

#include "shaders/shared/constants.h"

#include <math.h>

/* What a frame leaves of the means. */
#define USUAL_STAYS  (63.0f / 64.0f)
#define LATELY_STAYS (15.0f / 16.0f)

/* A lamp is restless that has changed in this share of the last frames: in one of sixteen. */
#define RESTLESS (1.0f / 16.0f)

/* Light that differs from the usual one by more than this part is another one: a third, or three times. */
#define UNUSUAL (2.0f / 3.0f)

/* The mean over 64 frames goes towards that over 16 by this part of their difference in an epoch. */
#define PART_OF_EPOCH (SDFGI_EPOCH_FRAMES / 64.0f)

/* Parts below it are as good as none. */
#define LEAST_PART (1.0f / 4096.0f)

/* Squares, as powf may differ from machine to machine. */
static float raised(float base, uint64_t exponent)
{
    float result = 1;
    for (; exponent > 0; exponent >>= 1) {
        result *= exponent & 1 ? base : 1;
        base *= base;
    }
    return result;
}

static void approach(float mean[static 3], const float value[static 3], float stays)
{
    for (int i = 0; i < 3; i++)
        mean[i] = value[i] + stays * (mean[i] - value[i]);
}

/* So many frames with the light of before have passed. */
static void take_in(struct lamp_habit *habit, const struct sdfgi_light_desc *before, uint64_t frames)
{
    float was[3];
    sdfgi_light_power(before, was);
    approach(habit->usual, was, raised(USUAL_STAYS, frames));
    approach(habit->lately, was, raised(LATELY_STAYS, frames));
    habit->restless *= raised(USUAL_STAYS, frames);
    if (frames > 0)
        habit->restless += 1 - USUAL_STAYS;
}

struct lamp_habit sdfgi_habit_begin(const struct sdfgi_light_desc *lamp, uint64_t frame)
{
    struct lamp_habit habit = { .frame = frame };
    sdfgi_light_power(lamp, habit.usual);
    sdfgi_light_power(lamp, habit.lately);
    return habit;
}

float sdfgi_habit_change(struct lamp_habit *habit, const struct sdfgi_light_desc *before,
                         const struct sdfgi_light_desc *after, uint64_t frame)
{
    float is[3];
    sdfgi_light_power(after, is);
    take_in(habit, before, frame - habit->frame);
    habit->frame = frame;
    if (!sdfgi_same_reach(before, after) || habit->restless < RESTLESS ||
        sdfgi_relative_difference(habit->usual, is, 3) > UNUSUAL)
        return 1;
    return fmaxf(sdfgi_relative_difference(habit->usual, habit->lately, 3) * PART_OF_EPOCH, LEAST_PART);
}
