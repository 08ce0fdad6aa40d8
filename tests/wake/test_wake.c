/* SPDX-License-Identifier: MIT
 * Whatever single thing a host changes, settled light wakes, and settles to what a fresh context makes of the
 * final state. */
#include "light_scene.h"
#include "random_setting.h"
#include "require.h"
#include "test_memory.h"
#include "wake_fields.h"
#include "wake_result.h"

#include <stdio.h>
#include <stdlib.h>

/* One change of one element of one field, or of one property. */
struct host_change {
    enum wake_object object;
    uint32_t index;
    bool new_first, cancels;
    bool moves_origin, moves_exposure, raises_cost;
    uint32_t row; /* counts fields, then properties */
    char text[256];
};

enum { ROWS_MOST = 128, CHANGES = 1000 };

struct fuzz {
    struct wake_device device;
    struct wake_world world; /* what `living` has settled to */
    struct wake_context living;
    struct wake_result result; /* a fresh context's of `world` */
    struct sdfgi_settings base;
    struct test_random random;
    bool at_random; /* any object may change */
    uint32_t changes, failures, contexts;
    uint32_t frames;
    bool rescaled;         /* light of `living` may have been stored with other exposures */
    bool shown[ROWS_MOST]; /* a change of the row changed something */
};

static bool is_full(void)
{
    return getenv("SDFGI_TEST_FULL") != NULL;
}

/* Settles in few frames. Few rays are no matter: they are the same in every cycle, and so is their noise.
 * Twice the feedback is 1: with more, light between surfaces hardly ever comes to an end. */
static struct sdfgi_settings fuzz_settings(void)
{
    struct sdfgi_settings s = light_settings(32, 0.4f);
    s.cascades = 2;
    s.frames_to_converge = 1;
    s.cell_rays = 32;
    s.bounce_feedback = 0.5f;
    return s;
}

static uint32_t below(struct fuzz *f, uint32_t count)
{
    return (uint32_t)test_random_real(&f->random, 0, count);
}

/* ---- A change of a field */

static void change_field(struct fuzz *f, uint32_t row, struct wake_world *after, struct host_change *change)
{
    const struct wake_field field = wake_field_get(row);
    const struct wake_group *g = field.group;
    /* The last of each kind of object has use for all of its fields. */
    const uint32_t object = f->at_random ? g->first + below(f, g->end - g->first) : g->end - 1,
                   element = below(f, field.part->count);
    const double before = wake_field_read(&field, &f->device, after, object, element);
    double value = before;
    while (value == before) {
        value = field.part->values[below(f, field.part->value_count)];
        value = field.part->type == WAKE_TYPE_F32 ? (double)(float)value : value; /* as it is read back */
    }
    wake_field_write(&field, &f->device, after, object, element, value);
    change->object = g->object;
    change->index = object;
    change->moves_origin = g->object == WAKE_FRAME && strcmp(field.part->name, "origin") == 0;
    change->moves_exposure = g->object == WAKE_FRAME && strcmp(field.part->name, "exposure") == 0;
    snprintf(change->text, sizeof change->text, "%s[%u].%s[%u] from %g to %g", g->name, object,
             field.part->name, element, before, value);
}

/* ---- A change of a property */

/* Cells that gather and the flood take ten times as long as what they replace, and have fuzzes of their own.
 */
static bool costs_more(const struct sdfgi_settings *settings, const struct sdfgi_settings *base)
{
    return 2 * random_setting_memory(settings) > 3 * random_setting_memory(base) ||
           settings->surface_light != base->surface_light || settings->sdf_method != base->sdf_method;
}

static void change_property(struct fuzz *f, uint32_t row, struct wake_world *after,
                            struct host_change *change)
{
    const struct sdfgi_property_info *info = sdfgi_property_get_info(row);
    char before[RANDOM_SETTING_TEXT], text[RANDOM_SETTING_TEXT];
    REQUIRE_TRUE(sdfgi_settings_format(&after->settings, info->name, before, sizeof before));
    random_setting_change(&f->random, row, &f->base, &after->settings, text);
    change->object = WAKE_SETTINGS;
    change->raises_cost = costs_more(&after->settings, &f->base);
    snprintf(change->text, sizeof change->text, "%s from %s to %s", info->name, before, text);
}

static uint32_t row_count(void)
{
    return wake_field_count() + random_setting_rows();
}

static struct host_change any_change(struct fuzz *f, uint32_t row, struct wake_world *after)
{
    struct host_change change = { .row = row, .new_first = below(f, 2), .cancels = below(f, 8) == 0 };
    *after = f->world;
    if (row < wake_field_count())
        change_field(f, row, after, &change);
    else
        change_property(f, row - wake_field_count(), after, &change);
    return change;
}

/* ---- Living and fresh */

static void fresh_result(struct fuzz *f, const struct wake_world *world, struct wake_result *result)
{
    struct wake_context fresh;
    wake_context_create(&fresh, &f->device, world);
    wake_context_place_as(&fresh, &f->living);
    wake_result_take(result, &f->device, &fresh, world);
    f->device.t.gi = f->living.gi;
    sdfgi_destroy(fresh.gi);
    f->contexts++;
}

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct gi_test *t = user;
    REQUIRE_CMP((int)sdfgi_update(t->gi, cmd, &t->frame), ==, (int)SDFGI_OK);
}

/* The swapchain was out of date: the first update after the change never runs. */
static void cancel_update(struct fuzz *f, const struct wake_world *world)
{
    f->device.t.gi = f->living.gi;
    f->device.t.frame = world->frame;
    gpu_test_record_and_drop(&f->device.t.gpu, record_update, &f->device.t);
    sdfgi_cancel_update(f->living.gi);
}

/* The state in which a change was not followed. */
static void print_settings(const struct fuzz *f, const struct wake_world *world)
{
    const struct sdfgi_property_info *info;
    fprintf(stderr, "  exposure %g, seed %u, camera %g %g %g", (double)world->frame.exposure,
            world->frame.seed, world->frame.camera_position[0], world->frame.camera_position[1],
            world->frame.camera_position[2]);
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++)
        if (sdfgi_settings_get(&world->settings, info->name) != sdfgi_settings_get(&f->base, info->name))
            fprintf(stderr, ", %s %g", info->name, sdfgi_settings_get(&world->settings, info->name));
    fprintf(stderr, "\n");
}

/* What is wrong with the living context must not be told of each change that follows. */
static void start_again(struct fuzz *f, const struct wake_world *world)
{
    struct wake_result unused;
    sdfgi_destroy(f->living.gi);
    f->rescaled = false;
    wake_context_create(&f->living, &f->device, world);
    wake_result_take(&unused, &f->device, &f->living, world);
    wake_result_free(&unused);
}

static enum wake_direct direct_after(struct fuzz *f, const struct host_change *change)
{
    f->rescaled = f->rescaled || change->moves_exposure;
    if (change->moves_origin)
        return WAKE_DIRECT_ANY;
    return f->rescaled ? WAKE_DIRECT_ROUNDED : WAKE_DIRECT_EXACT;
}

/* Applies a change to the living context and compares it with `fresh`, which is filled in if it is of another
 * place. */
static void step(struct fuzz *f, const struct host_change *change, const struct wake_world *after,
                 struct wake_result *fresh)
{
    struct wake_result found;
    char text[WAKE_TEXT];
    wake_context_follow(&f->living, &f->device, &f->world, after, change->object, change->index,
                        change->new_first);
    if (change->cancels)
        cancel_update(f, after);
    wake_result_take(&found, &f->device, &f->living, after);
    if (!fresh->settles || !wake_result_placed_alike(&found, fresh)) {
        wake_result_free(fresh);
        fresh_result(f, after, fresh);
    }
    f->changes++;
    f->frames += found.frames;
    if (!wake_result_same(&found, fresh, direct_after(f, change), text)) {
        f->failures++;
        fprintf(stderr, "%u: %s%s%s: %s\n", f->changes, change->text, change->new_first ? ", new first" : "",
                change->cancels ? ", cancelled once" : "", text);
        print_settings(f, after);
        start_again(f, after);
    }
    wake_result_free(&found);
}

/* Settings do not pile up: a change that costs more is taken back. In the short form all others stay. In the
 * long one all are taken back while rows have their turn, so that each finds the world as it was at first,
 * which has use for all fields; a quarter of those at random stays. */
static bool change_stays(struct fuzz *f, const struct host_change *change, const struct wake_result *fresh)
{
    const bool may = !change->raises_cost && !change->moves_origin && fresh->active;
    return may && (!is_full() || (f->at_random && below(f, 4) == 0));
}

/* A change, and with it taken back another, unless it stays. */
static void change_and_back(struct fuzz *f, uint32_t row)
{
    struct wake_world after;
    struct host_change change = any_change(f, row, &after);
    struct wake_result fresh = { .settles = false };
    char text[WAKE_TEXT];
    step(f, &change, &after, &fresh);
    f->shown[row] = f->shown[row] || !wake_result_same(&fresh, &f->result, WAKE_DIRECT_EXACT, text);
    const bool stays = change_stays(f, &change, &fresh);
    const struct wake_world before = f->world;
    f->world = after;
    if (!stays) {
        change.new_first = below(f, 2);
        snprintf(change.text + strlen(change.text), sizeof change.text - strlen(change.text), ", and back");
        step(f, &change, &before, &f->result);
        f->world = before;
        wake_result_free(&fresh);
        return;
    }
    wake_result_free(&f->result);
    f->result = fresh;
}

/* One value of a field may say the same as another, or be of an element that nobody looks at. */
static void change_until_shown(struct fuzz *f, uint32_t row)
{
    const bool shows = row < wake_field_count() && wake_field_get(row).part->shows;
    uint32_t tries = 0;
    do
        change_and_back(f, row);
    while (shows && !f->shown[row] && ++tries < 10);
}

static void fuzz_open(struct fuzz *f, const struct sdfgi_settings *settings, uint32_t seed)
{
    memset(f, 0, sizeof *f);
    f->random.state = seed;
    f->base = *settings;
    wake_device_open(&f->device);
    wake_world_init(&f->world, &f->device, settings);
    wake_context_create(&f->living, &f->device, &f->world);
    wake_result_take(&f->result, &f->device, &f->living, &f->world);
    REQUIRE_CMP(row_count(), <=, (uint32_t)ROWS_MOST);
}

static void fuzz_close(struct fuzz *f)
{
    sdfgi_destroy(f->living.gi);
    wake_result_free(&f->result);
    wake_device_close(&f->device);
}

/* ---- Tests */

/* Fields of materials and meshes reach the library as whole objects; so do properties that recreate
 * everything. Of those the first ones stand for all. */
static bool is_telling(uint32_t row)
{
    if (row >= wake_field_count())
        return !sdfgi_property_get_info(row - wake_field_count())->recreates;
    const struct wake_field field = wake_field_get(row);
    const bool replaced = field.group->object == WAKE_MATERIAL || field.group->object == WAKE_MESH;
    return !replaced || field.part - field.group->parts < 2;
}

/* A field that never shows would hide that it does not wake. */
static void require_shown(const struct fuzz *f)
{
    for (uint32_t row = 0; row < wake_field_count(); row++) {
        const struct wake_field field = wake_field_get(row);
        if (field.part->shows && !f->shown[row])
            require_fail(__FILE__, __LINE__, "no change of %s.%s changed anything", field.group->name,
                         field.part->name);
    }
}

static void finish(struct fuzz *f, const char *what)
{
    printf("%s: %u changes of %u fields and properties, %u fresh contexts, %.1f frames a change\n", what,
           f->changes, row_count(), f->contexts, f->frames / (double)f->changes);
    const uint32_t failures = f->failures;
    fuzz_close(f);
    REQUIRE_CMP(failures, ==, 0u);
}

/* Each row in turn, then rows at random. */
static void every_change_wakes_settled_light(void **state)
{
    (void)state;
    static struct fuzz f;
    const struct sdfgi_settings settings = fuzz_settings();
    fuzz_open(&f, &settings, 1);
    for (uint32_t i = 0; i < row_count(); i++)
        if (is_full())
            change_until_shown(&f, i);
        else if (is_telling(i))
            change_and_back(&f, i);
    f.at_random = true;
    while (is_full() && f.changes < gpu_test_repeats(&f.device.t.gpu, CHANGES))
        change_and_back(&f, below(&f, row_count()));
    finish(&f, "probes");
    if (is_full())
        require_shown(&f);
}

/* Other settings to begin with. */
static void every_change_wakes_light_of_cells(void **state)
{
    (void)state;
    static struct fuzz f;
    struct sdfgi_settings settings = fuzz_settings();
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    fuzz_open(&f, &settings, 2);
    for (uint32_t i = 0; i < row_count(); i++)
        if (is_telling(i))
            change_and_back(&f, i);
    finish(&f, "cells");
}

static void every_change_wakes_light_behind_depths(void **state)
{
    (void)state;
    static struct fuzz f;
    struct sdfgi_settings settings = fuzz_settings();
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    settings.sdf_method = SDFGI_SDF_FLOOD;
    fuzz_open(&f, &settings, 3);
    for (uint32_t i = 0; i < row_count(); i++)
        if (is_telling(i))
            change_and_back(&f, i);
    finish(&f, "depths");
}

/* Nothing that gives light but a dim sky: what does not show at one exposure shows at another. */
static void dim_the_world(struct wake_world *world)
{
    for (int i = 0; i < WAKE_LIGHTS; i++)
        world->light_exists[i] = false;
    for (int i = 0; i < WAKE_MATERIALS; i++)
        memset(world->materials[i].emission, 0, sizeof world->materials[i].emission);
    for (int k = 0; k < 3; k++)
        world->sky.zenith[k] = world->sky.horizon[k] = world->sky.ground[k] = 0.02f;
}

/* From an exposure that shows nothing of the world to one that does. */
static void expose(struct fuzz *f, float exposure, const char *what)
{
    struct host_change change = { .object = WAKE_FRAME };
    struct wake_result fresh = { .settles = false };
    snprintf(change.text, sizeof change.text, "frame.exposure from 1e-5 to %g", (double)exposure);
    f->world.frame.exposure = 1e-5f;
    wake_context_create(&f->living, &f->device, &f->world);
    wake_result_take(&f->result, &f->device, &f->living, &f->world);
    struct wake_world after = f->world;
    after.frame.exposure = exposure;
    step(f, &change, &after, &fresh);
    wake_result_free(&fresh);
    finish(f, what);
}

static void light_that_an_exposure_hid_settles_once_it_shows(void **state)
{
    (void)state;
    static struct fuzz f;
    const struct sdfgi_settings settings = fuzz_settings();
    wake_device_open(&f.device);
    wake_world_init(&f.world, &f.device, &settings);
    dim_the_world(&f.world);
    expose(&f, 1, "a dim sky");
}

/* A lamp that shines into the sky has light stored with a low exposure, which leaves four bits to that of a
 * dim one. */
static void direct_light_that_an_exposure_hid_has_all_its_digits_once_it_shows(void **state)
{
    (void)state;
    static struct fuzz f;
    const struct sdfgi_settings settings = fuzz_settings();
    wake_device_open(&f.device);
    wake_world_init(&f.world, &f.device, &settings);
    dim_the_world(&f.world);
    struct sdfgi_light_desc *dim = &f.world.lights[SDFGI_LIGHT_POINT],
                            *away = &f.world.lights[SDFGI_LIGHT_SPOT];
    for (int k = 0; k < 3; k++) {
        dim->intensity[k] = 0.002f;
        away->intensity[k] = 20;
        away->direction[k] = k == 1;
    }
    f.world.light_exists[SDFGI_LIGHT_POINT] = f.world.light_exists[SDFGI_LIGHT_SPOT] = true;
    expose(&f, 300, "a dim lamp");
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest one[] = {
        cmocka_unit_test(every_change_wakes_settled_light),
        cmocka_unit_test(light_that_an_exposure_hid_settles_once_it_shows),
        cmocka_unit_test(direct_light_that_an_exposure_hid_has_all_its_digits_once_it_shows),
    };
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_change_wakes_settled_light),
        cmocka_unit_test(every_change_wakes_light_of_cells),
        cmocka_unit_test(every_change_wakes_light_behind_depths),
        cmocka_unit_test(light_that_an_exposure_hid_settles_once_it_shows),
        cmocka_unit_test(direct_light_that_an_exposure_hid_has_all_its_digits_once_it_shows),
    };
    if (!is_full())
        return cmocka_run_group_tests_name("wake", one, NULL, NULL);
    return cmocka_run_group_tests_name("wake_full", tests, NULL, NULL);
}
