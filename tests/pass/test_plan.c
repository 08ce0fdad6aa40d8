/* SPDX-License-Identifier: MIT
 * What a frame runs for each situation, without a device. */
#include "context.h"
#include "require.h"

#define P(id) (UINT64_C(1) << PASS_##id)
#define RAYS  (P(RAY_LIST) | P(PROBE_TRACE))

static const uint64_t listing = P(LIGHT_MARK) | P(LIGHT_LIST),
                      generation = P(REGION_CLEAR) | P(VOXEL_RESOLVE) | P(PROBE_PLACE) | listing,
                      seeding = P(PROBE_SEED) | P(RAY_INVALIDATE),
                      exact = P(DISTANCE_PREPARE) | P(DISTANCE_PLANE) | P(DISTANCE_EXACT),
                      flood = P(FLOOD_SEED) | P(FLOOD_STEP) | P(FLOOD_DISTANCE),
                      light = P(LIGHT_BOUNCE) | P(PROBE_SUM),
                      publishing = P(LIGHT_BOUNCE) | P(PROBE_SUM) | P(PROBE_BLEND);

/* Passes that run; fails if a decision lacks its reason, or gives the same one for running and for not
 * running. */
static uint64_t planned(const struct situation *situation)
{
    struct decision plan[PASS_COUNT];
    memset(plan, 0, sizeof plan);
    plan_make(situation, plan);
    uint64_t runs = 0;
    for (int i = 0; i < PASS_COUNT; i++) {
        REQUIRE_TRUE(plan[i].reason && plan[i].reason[0]);
        runs |= (uint64_t)plan[i].run << i;
    }
    return runs;
}

struct row {
    const char *what;
    struct situation situation;
    uint64_t runs;
};

static void require_rows(const struct row *rows, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint64_t runs = planned(&rows[i].situation);
        if (runs != rows[i].runs)
            require_fail(__FILE__, __LINE__, "%s: passes %#llx run, expected %#llx", rows[i].what,
                         (unsigned long long)runs, (unsigned long long)rows[i].runs);
    }
}

static void nothing_runs_that_is_not_called_for(void **state)
{
    (void)state;
    static const struct row rows[] = {
        { "switched off", { .enabled = false }, 0 },
        { "switched off in a changed scene",
          { .generates = true,
            .measures = true,
            .completes = true,
            .relights = true,
            .has_geometry = true,
            .has_lights = true,
            .lights_changed = true,
            .publish = true,
            .gathers = true },
          0 },
        { "settled", { .enabled = true, .has_geometry = true, .has_lights = true, .converged = true }, 0 },
        { "settled, a publication due",
          { .enabled = true, .has_geometry = true, .converged = true, .publish = true },
          0 },
        { "settled, asked for", { .enabled = true, .converged = true, .gathers = true }, P(GATHER) },
    };
    require_rows(rows, sizeof rows / sizeof *rows);
}

static void unsettled_light_is_traced(void **state)
{
    (void)state;
    static const struct row rows[] = {
        { "between publications", { .enabled = true, .has_geometry = true }, P(PROBE_SUM) },
        { "rays missing",
          { .enabled = true, .has_geometry = true, .rays_missing = true },
          P(PROBE_SUM) | RAYS },
        { "a publication due", { .enabled = true, .has_geometry = true, .publish = true }, publishing },
        { "a publication due, but light waits",
          { .enabled = true, .has_geometry = true, .publish = true, .light_waits = true },
          0 },
        { "light changed",
          { .enabled = true, .has_lights = true, .lights_changed = true },
          light | P(LIGHT_DIRECT) },
        { "last light removed",
          { .enabled = true, .lights_changed = true, .publish = true },
          publishing | P(LIGHT_DIRECT) },
    };
    require_rows(rows, sizeof rows / sizeof *rows);
}

static void a_changed_cascade_is_generated(void **state)
{
    (void)state;
#define FRESH .fresh = true, .generates = true, .measures = true, .completes = true, .relights = true
#define DIRTY .enabled = true, FRESH, .publish = true
    static const struct row rows[] = {
        { "compute, exact", { DIRTY, .has_geometry = true }, 0 },
        { "raster", { DIRTY, .has_geometry = true, .raster = true }, 0 },
        { "empty", { DIRTY }, 0 },
        { "lit", { DIRTY, .has_geometry = true, .has_lights = true }, 0 },
        { "flood, depths", { DIRTY, .has_geometry = true, .flood = true, .occlusion = true }, 0 },
        { "masks", { DIRTY, .has_geometry = true, .masks = true }, 0 },
    };
#undef DIRTY
#undef FRESH
    const uint64_t always = generation | publishing;
    const uint64_t runs[] = { always | exact | P(VOXELIZE),
                              always | exact | P(VOXELIZE_RASTER),
                              always | exact,
                              always | exact | P(VOXELIZE) | P(LIGHT_DIRECT),
                              always | flood | P(VOXELIZE) | P(OCCLUSION_TRACE),
                              always | exact | P(VOXELIZE) | P(CELL_MASK) };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct row row = rows[i];
        row.runs = runs[i];
        require_rows(&row, 1);
    }
}

static void a_longer_list_is_written_and_nothing_is_generated(void **state)
{
    (void)state;
#define GREW .enabled = true, .has_geometry = true, .list_grew = true, .relights = true
    static const struct row rows[] = {
        { "unlit", { GREW }, 0 },
        { "lit, masks", { GREW, .has_lights = true, .masks = true }, 0 },
        { "flood, depths", { GREW, .flood = true, .occlusion = true }, 0 },
    };
#undef GREW
    const uint64_t runs[] = { light | listing, light | listing | P(LIGHT_DIRECT) | P(CELL_MASK),
                              light | listing };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct row row = rows[i];
        row.runs = runs[i];
        require_rows(&row, 1);
    }
}

/* A step is spread over frames: each runs what it is about, and only that. */
static void a_step_runs_in_parts(void **state)
{
    (void)state;
#define MOVING .enabled = true, .has_geometry = true, .has_lights = true, .masks = true, .publish = true
    static const struct row rows[] = {
        { "voxels", { MOVING, .generates = true }, 0 },
        { "distances", { MOVING, .measures = true }, 0 },
        { "complete", { MOVING, .completes = true, .relights = true }, 0 },
        { "another cascade's light", { MOVING, .relights = true }, 0 },
    };
#undef MOVING
    const uint64_t runs[] = {
        publishing | P(REGION_CLEAR) | P(VOXELIZE) | P(VOXEL_RESOLVE),
        publishing | exact,
        publishing | seeding | P(PROBE_PLACE) | listing | P(CELL_MASK) | P(LIGHT_DIRECT),
        publishing | P(LIGHT_DIRECT),
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct row row = rows[i];
        row.runs = runs[i];
        require_rows(&row, 1);
    }
}

/* Every situation there is: decisions have reasons, and follow from the situation alone. */
static void every_situation_has_reasons_and_one_plan(void **state)
{
    (void)state;
    uint64_t ever = 0;
    for (uint32_t i = 0; i < 1u << 19; i++) {
        const struct situation s = {
            .enabled = i & 1,
            .generates = i >> 1 & 1,
            .measures = i >> 12 & 1,
            .completes = i >> 13 & 1,
            .fresh = i >> 14 & 1,
            .relights = i >> 15 & 1,
            .has_geometry = i >> 2 & 1,
            .has_lights = i >> 3 & 1,
            .converged = i >> 4 & 1,
            .lights_changed = i >> 5 & 1,
            .publish = i >> 6 & 1,
            .gathers = i >> 7 & 1,
            .raster = i >> 8 & 1,
            .flood = i >> 9 & 1,
            .occlusion = i >> 10 & 1,
            .masks = i >> 11 & 1,
            .list_grew = i >> 16 & 1,
            .light_waits = i >> 17 & 1,
            .rays_missing = i >> 18 & 1,
        };
        const uint64_t runs = planned(&s);
        REQUIRE_CMP(runs, ==, planned(&s));
        if (!s.enabled)
            REQUIRE_CMP(runs, ==, 0u);
        REQUIRE_TRUE(!(runs & P(VOXELIZE)) || !(runs & P(VOXELIZE_RASTER)));
        REQUIRE_TRUE(!(runs & exact) || !(runs & flood));
        REQUIRE_TRUE(!(runs & P(PROBE_BLEND)) || (runs & P(PROBE_SUM)));
        ever |= runs;
    }
    REQUIRE_CMP(ever, ==, (UINT64_C(1) << PASS_COUNT) - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_runs_that_is_not_called_for),
        cmocka_unit_test(unsettled_light_is_traced),
        cmocka_unit_test(a_changed_cascade_is_generated),
        cmocka_unit_test(a_longer_list_is_written_and_nothing_is_generated),
        cmocka_unit_test(a_step_runs_in_parts),
        cmocka_unit_test(every_situation_has_reasons_and_one_plan),
    };
    return cmocka_run_group_tests_name("plan", tests, NULL, NULL);
}
