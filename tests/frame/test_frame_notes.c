/* SPDX-License-Identifier: MIT
 * What a scene notes of lights that change (scene/journal.h), and by which part of their light they do
 * (scene/drift.h, scene/flicker.h). Which materials are the same (scene/same.h). */
#include "core/box.h"
#include "require.h"
#include "scene/drift.h"
#include "scene/flicker.h"
#include "scene/journal.h"
#include "scene/same.h"

#include <math.h>

static void every_journal_of_a_scene_gets_all_notes(void **state)
{
    (void)state;
    struct journal second = { 0 }, first = { .next = &second }, lit = { 0 };
    const struct box box = { { 0, 0, 0 }, { 1, 1, 1 } }, other = { { 2, 0, 0 }, { 3, 1, 1 } };
    sdfgi_journal_note_lamp(&lit, &(struct light_bits){ .changed = 1 }, 1);
    REQUIRE_TRUE(!sdfgi_journal_is_empty(&lit));
    sdfgi_journal_note(&first, JOURNAL_MATERIALS);
    sdfgi_journal_note_lamp(&first, &(struct light_bits){ .changed = 5, .moved = 4 }, 1);
    sdfgi_journal_note_lamp(&first, &(struct light_bits){ .changed = 4 }, 0.1f);
    sdfgi_journal_add_box(&first, &box);
    sdfgi_journal_add_emitter(&first, &box);
    sdfgi_journal_add_emitter(&first, &other);
    sdfgi_journal_clear(&first);
    REQUIRE_CMP(first.lights.changed | first.lights.moved, ==, 0u);
    REQUIRE_TRUE(sdfgi_journal_is_empty(&first) && first.next == &second);
    REQUIRE_CMP(first.emitters.count, ==, 0u);
    REQUIRE_TRUE(!sdfgi_journal_is_empty(&second) && second.box_count == 1);
    REQUIRE_CMP(second.notes, ==, (uint32_t)(JOURNAL_MATERIALS | JOURNAL_LAMPS));
    REQUIRE_NEAR(second.flicker, 0.1f, 0);
    REQUIRE_CMP(second.emitters.count, ==, 2u);
    const struct journal earlier = { .lights = { .changed = 2, .moved = 2 },
                                     .emitters = { { { { -2, 0, 0 }, { -1, 1, 1 } } }, 1 } };
    sdfgi_journal_prepend(&second, &earlier);
    REQUIRE_CMP(second.lights.changed, ==, 7u);
    REQUIRE_CMP(second.lights.moved, ==, 6u);
    REQUIRE_CMP(second.emitters.count, ==, 3u);
}

/* Surfaces follow them in turn. One that changes more is noted as a lamp is. */
static void suns_that_change_a_little_are_noted_apart(void **state)
{
    (void)state;
    struct journal journal = { 0 };
    const struct light_bits sun = { 2, 2 }, other = { 8, 8 };
    sdfgi_journal_note_sun(&journal, &sun, 0.002f);
    sdfgi_journal_note_sun(&journal, &sun, 0.001f);
    sdfgi_journal_note_sky(&journal, 0.004f);
    REQUIRE_CMP(journal.suns.bits.changed, ==, 2u);
    REQUIRE_CMP(journal.suns.bits.moved, ==, 2u);
    REQUIRE_NEAR(journal.suns.most, 0.002f, 0);
    REQUIRE_NEAR(journal.drift, 0.007f, 1e-6);
    REQUIRE_CMP(journal.lights.changed | journal.notes, ==, 0u);
    sdfgi_journal_note_sun(&journal, &other, 0.01f);
    REQUIRE_CMP(journal.lights.changed, ==, 8u);
    REQUIRE_CMP(journal.suns.bits.changed, ==, 2u);
    const struct journal earlier = { .suns = { { 4, 4 }, 0.003f }, .drift = 0.003f };
    sdfgi_journal_prepend(&journal, &earlier);
    REQUIRE_CMP(journal.suns.bits.moved, ==, 6u);
    REQUIRE_NEAR(journal.suns.most, 0.003f, 0);
    REQUIRE_NEAR(journal.drift, 0.02f, 1e-6);
    sdfgi_journal_clear(&journal);
    REQUIRE_TRUE(sdfgi_journal_is_empty(&journal));
    sdfgi_journal_note_sky(&journal, 0.004f);
    REQUIRE_TRUE(!sdfgi_journal_is_empty(&journal));
}

static void lamps_that_flicker_are_noted_apart(void **state)
{
    (void)state;
    struct journal journal = { 0 };
    sdfgi_journal_note_lamp(&journal, &(struct light_bits){ 2, 0 }, 0.02f);
    sdfgi_journal_note_lamp(&journal, &(struct light_bits){ 4, 0 }, 0.01f);
    REQUIRE_CMP(journal.lights.changed, ==, 6u);
    REQUIRE_CMP(journal.notes, ==, 0u);
    REQUIRE_NEAR(journal.flicker, 0.02f, 0);
    const struct journal earlier = { .flicker = 0.03f };
    sdfgi_journal_prepend(&journal, &earlier);
    REQUIRE_NEAR(journal.flicker, 0.03f, 0);
    sdfgi_journal_clear(&journal);
    REQUIRE_TRUE(sdfgi_journal_is_empty(&journal) && !(journal.flicker > 0));
}

/* ---- By which part of their light suns and skies change */

static void a_sun_drifts_by_its_angle_and_by_its_light(void **state)
{
    (void)state;
    const struct sdfgi_light_desc noon = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                           .direction = { 0, -3, 0 },
                                           .intensity = { 4, 2, 1 },
                                           .indirect_energy = 1,
                                           .casts_shadow = true };
    struct sdfgi_light_desc later = noon;
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 0, 0);
    later.direction[0] = 3 * tanf(0.01f);
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 0.01, 1e-6);
    later.intensity[1] = 2.2f;
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 0.01 + 0.05, 1e-6);
    later = noon;
    later.indirect_energy = 0.5f;
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 0.5, 1e-6);
    later = noon;
    later.direction[1] = 1;
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 3.14159265, 1e-6);
    later = noon;
    later.casts_shadow = false;
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 1, 0);
    later = noon;
    later.type = SDFGI_LIGHT_POINT;
    REQUIRE_NEAR(sdfgi_drift_of_sun(&noon, &later), 1, 0);
    REQUIRE_NEAR(sdfgi_drift_of_sun(&later, &noon), 1, 0);
}

static void a_sky_drifts_by_its_brightest_colours(void **state)
{
    (void)state;
    const struct sdfgi_sky none = { .zenith = { 0 } },
                           day = { { 1, 2, 4 }, { 3, 3, 3 }, { 0.1f, 0.1f, 0.1f } };
    struct sdfgi_sky later = day;
    REQUIRE_NEAR(sdfgi_drift_of_sky(&none, &none), 0, 0);
    REQUIRE_NEAR(sdfgi_drift_of_sky(&none, &day), 1, 0);
    later.ground[1] = 0.2f;
    REQUIRE_NEAR(sdfgi_drift_of_sky(&day, &later), 0.025, 1e-6);
    later.horizon[0] = 2;
    REQUIRE_NEAR(sdfgi_drift_of_sky(&day, &later), 0.25, 1e-6);
    const struct sdfgi_sky_harmonics before = { .coefficients = { { 2, 2, 2 }, { -4, 0, 0 } } };
    struct sdfgi_sky_harmonics after = before;
    after.coefficients[1][0] = -3;
    after.rotation_rad = -0.02f;
    REQUIRE_NEAR(sdfgi_drift_of_harmonics(&before, &after), 0.25 + 0.02, 1e-6);
    after = before;
    after.intensity = 1;
    REQUIRE_NEAR(sdfgi_drift_of_harmonics(&before, &after), 0, 0);
    after.intensity = 0.75f;
    REQUIRE_NEAR(sdfgi_drift_of_harmonics(&before, &after), 0.25, 1e-6);
}

/* ---- By which part the mean of a lamp's light changes */

struct lamp {
    struct sdfgi_light_desc desc;
    struct lamp_habit habit;
    uint64_t frame;
};

static struct lamp lamp_of(float power)
{
    struct lamp lamp = { .desc = { .type = SDFGI_LIGHT_POINT, .indirect_energy = 1 }, .frame = 1000 };
    for (int i = 0; i < 3; i++)
        lamp.desc.intensity[i] = power;
    lamp.habit = sdfgi_habit_begin(&lamp.desc, lamp.frame);
    return lamp;
}

/* Some frames later the lamp has another power. */
static float set(struct lamp *lamp, uint64_t frames, float power)
{
    struct sdfgi_light_desc after = lamp->desc;
    for (int i = 0; i < 3; i++)
        after.intensity[i] = power;
    const float change = sdfgi_habit_change(&lamp->habit, &lamp->desc, &after, lamp->frame += frames);
    lamp->desc = after;
    return change;
}

/* Every so many frames it goes from 0.8 to 1.2 and back. */
static float flicker(struct lamp *lamp, int times, uint64_t frames)
{
    float most = 0;
    for (int i = 0; i < times; i++)
        most = fmaxf(most, set(lamp, frames, i % 2 ? 0.8f : 1.2f));
    return most;
}

static void a_lamp_that_changes_often_flickers(void **state)
{
    (void)state;
    struct lamp lamp = lamp_of(0.8f);
    const float first = set(&lamp, 5000, 1.2f), seldom = flicker(&lamp, 4, 5000);
    flicker(&lamp, 400, 2);
    const float often = flicker(&lamp, 200, 2), slow = flicker(&lamp, 200, 12), calm = set(&lamp, 300, 1);
    flicker(&lamp, 40, 24);
    const float slower = set(&lamp, 24, 1);
    REQUIRE_NEAR(first, 1, 0);
    REQUIRE_NEAR(seldom, 1, 0);
    REQUIRE_CMP(often, <, 0.01f);
    REQUIRE_CMP(slow, <, 0.05f);
    REQUIRE_NEAR(calm, 1, 0);
    REQUIRE_NEAR(slower, 1, 0);
}

static void a_lamp_that_goes_off_flickers_no_more(void **state)
{
    (void)state;
    struct lamp lamp = lamp_of(1);
    flicker(&lamp, 200, 1);
    struct lamp off = lamp, bright = lamp, moved = lamp, red = lamp;
    const float goes_off = set(&off, 1, 0), glares = set(&bright, 1, 4);
    moved.desc.position[1] = 0.01;
    red.desc.intensity[0] *= 4;
    const float moves = sdfgi_habit_change(&moved.habit, &lamp.desc, &moved.desc, lamp.frame + 1),
                reddens = sdfgi_habit_change(&red.habit, &lamp.desc, &red.desc, lamp.frame + 1);
    REQUIRE_NEAR(goes_off, 1, 0);
    REQUIRE_NEAR(glares, 1, 0);
    REQUIRE_NEAR(moves, 1, 0);
    REQUIRE_NEAR(reddens, 1, 0);
}

/* In five seconds it loses nine tenths of its light: light would be behind if that counted as flicker. */
static void a_lamp_that_fades_changes_its_mean(void **state)
{
    (void)state;
    struct lamp lamp = lamp_of(1);
    flicker(&lamp, 200, 1);
    float least = 1;
    for (int i = 1; i <= 270; i++) {
        const float change = set(&lamp, 1, 1 - (float)i / 300);
        least = i > 60 ? fminf(least, change) : least;
    }
    REQUIRE_CMP(least, >, 0.015f);
}

/* Its mean is a number afterwards, so that a lamp which goes off is no flicker. */
static void a_lamp_may_be_brighter_than_floats_can_tell(void **state)
{
    (void)state;
    struct lamp lamp = lamp_of(1);
    lamp.desc.indirect_energy = 1e30f;
    set(&lamp, 1, 1e30f);
    set(&lamp, 1, 1);
    lamp.desc.indirect_energy = 1;
    flicker(&lamp, 20000, 1);
    const float goes_off = set(&lamp, 1, 0);
    REQUIRE_NEAR(goes_off, 1, 0);
    REQUIRE_NEAR(lamp.habit.usual[1], 1, 0.01);
}

/* How many updates a frame has makes no difference. */
static void a_habit_counts_frames(void **state)
{
    (void)state;
    struct lamp once = lamp_of(1), often = once;
    for (int i = 0; i < 100; i++) {
        const float power = i % 3 ? 1.1f : 0.9f;
        set(&once, 3, power);
        set(&often, 3, 0.5f);
        set(&often, 0, power);
    }
    REQUIRE_NEAR(often.habit.usual[1], once.habit.usual[1], 0);
    REQUIRE_NEAR(often.habit.restless, once.habit.restless, 0);
    REQUIRE_NEAR(once.habit.usual[1], 1.0333, 0.02);
    REQUIRE_NEAR(once.habit.restless, 1.0 / 3, 0.02);
}

/* Hosts push their materials in each frame: what is as before must not be voxelised anew, and nothing else
 * may count as such. */
static void each_field_makes_another_material(void **state)
{
    (void)state;
    const struct sdfgi_material_desc before = { .albedo = { 0.5f, 0.4f, 0.3f }, .alpha = 1 };
    struct sdfgi_material_desc after = before;
    REQUIRE_TRUE(sdfgi_same_material(&before, &after));
#define DIFFERS(change)                                                                                      \
    do {                                                                                                     \
        after = before;                                                                                      \
        change;                                                                                              \
        REQUIRE_TRUE(!sdfgi_same_material(&before, &after));                                                 \
    } while (0)
    DIFFERS(after.albedo[2] = 0.2f);
    DIFFERS(after.alpha = 0.5f);
    DIFFERS(after.emission[0] = 1);
    DIFFERS(after.alpha_cutoff = 0.5f);
    DIFFERS(after.double_sided_emission = true);
    DIFFERS(after.smoothness = 1);
    DIFFERS(after.specular_albedo = 0.1f);
    DIFFERS(after.metallic = 1);
    DIFFERS(after.albedo_texture.view = (VkImageView)(uintptr_t)1);
    DIFFERS(after.emission_texture.view = (VkImageView)(uintptr_t)1);
    DIFFERS(after.albedo_texture.layout = VK_IMAGE_LAYOUT_GENERAL);
    DIFFERS(after.albedo_texture.uv_transform[5] = 1);
    DIFFERS(after.albedo_texture.address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    DIFFERS(after.albedo_texture.address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    DIFFERS(after.albedo_texture.decode_srgb = true);
#undef DIFFERS
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_journal_of_a_scene_gets_all_notes),
        cmocka_unit_test(suns_that_change_a_little_are_noted_apart),
        cmocka_unit_test(lamps_that_flicker_are_noted_apart),
        cmocka_unit_test(a_sun_drifts_by_its_angle_and_by_its_light),
        cmocka_unit_test(a_sky_drifts_by_its_brightest_colours),
        cmocka_unit_test(a_lamp_that_changes_often_flickers),
        cmocka_unit_test(a_lamp_that_goes_off_flickers_no_more),
        cmocka_unit_test(a_lamp_that_fades_changes_its_mean),
        cmocka_unit_test(a_lamp_may_be_brighter_than_floats_can_tell),
        cmocka_unit_test(a_habit_counts_frames),
        cmocka_unit_test(each_field_makes_another_material),
    };
    return cmocka_run_group_tests_name("notes", tests, NULL, NULL);
}
