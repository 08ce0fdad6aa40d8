/* SPDX-License-Identifier: MIT
 * Work along real ways, at the default budget and without a device: the walk through the sample world at 5
 * m/s, and a flight over its valley at 100 m/s.
 *
 *     test_scroll_paths walk.json flight.json */
#include "require.h"
#include "scroll_drive.h"
#include "walk/walk_path.h"

#include <math.h>
#include <stdio.h>

enum { FRAMES_PER_SECOND = 60 };

static const char *walk_file, *flight_file;

static void along(const void *user, uint32_t i, double camera[static 3])
{
    const struct walk_path *path = user;
    struct host_camera at;
    walk_path_camera(path, i * path->speed_m_s / FRAMES_PER_SECOND, &at);
    memcpy(camera, at.position, sizeof at.position);
}

/* From a place where everything is there to the end of the way. The first second, in which cascades have yet
 * to start stepping, is not counted. */
static struct trip travel(const char *file, double speed_m_s)
{
    struct walk_path path;
    char error[256];
    double camera[3];
    REQUIRE_TRUE(walk_path_load(file, &path, error, sizeof error));
    REQUIRE_NEAR(path.speed_m_s, speed_m_s, 0);
    struct sdfgi_settings defaults;
    sdfgi_settings_default(&defaults);
    struct scroll_drive drive = scroll_drive_begin(defaults.resolution, defaults.max_scroll_cells);
    along(&path, 0, camera);
    scroll_drive_frame(&drive, camera);
    const uint32_t frames = (uint32_t)(path.length_m / speed_m_s * FRAMES_PER_SECOND);
    const struct trip j =
        scroll_drive_trip(&drive, file, FRAMES_PER_SECOND, frames - FRAMES_PER_SECOND, along, &path);
    REQUIRE_CMP(j.most, <=, (uint64_t)defaults.max_scroll_cells);
    walk_path_finish(&path);
    return j;
}

static void a_walk_through_the_world_costs_the_same_in_every_frame(void **state)
{
    (void)state;
    const struct trip j = travel(walk_file, 5);
    REQUIRE_CMP((double)j.p99, <=, 1.2 * (double)j.median);
    REQUIRE_CMP(j.apart, >=, 4u);
    for (int c = 0; c < 4; c++)
        REQUIRE_CMP(j.covered[c], ==, j.frames);
}

/* The finest cascade would have to step in every frame: it waits. */
static void a_flight_over_the_world_costs_the_same_in_every_frame(void **state)
{
    (void)state;
    const struct trip j = travel(flight_file, 100);
    REQUIRE_CMP((double)j.p99, <=, 1.2 * (double)j.median);
    for (int c = 1; c < 4; c++)
        REQUIRE_CMP(j.covered[c], ==, j.frames);
}

/* Cells that lookups read around the camera, along the axis where that is least. */
static double cells_read(const struct cascade *cascade, const double camera[static 3])
{
    double least = INFINITY;
    for (int i = 0; i < 3; i++) {
        const double at = camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        least = fmin(least, fmin(at - cascade->blend_low[i], cascade->blend_high[i] - at));
    }
    return least;
}

/* One frame a second, 32 cells: every frame is a jump of most of the finest cascade. Lookups still read all
 * of them. */
static void jumps_along_the_walk_read_all_cascades(void **state)
{
    (void)state;
    struct walk_path path;
    char error[256];
    double camera[3], least[4] = { INFINITY, INFINITY, INFINITY, INFINITY };
    REQUIRE_TRUE(walk_path_load(walk_file, &path, error, sizeof error));
    struct scroll_drive drive = scroll_drive_begin(32, 4194304);
    for (uint32_t i = 0; i < (uint32_t)(path.length_m / 5); i++) {
        along(&path, i * FRAMES_PER_SECOND, camera);
        scroll_drive_frame(&drive, camera);
        for (uint32_t c = 0; c < 4; c++)
            least[c] = fmin(least[c], cells_read(&drive.cascades.at[c], camera));
    }
    printf("one frame a second, 32 cells: at least %.1f %.1f %.1f %.1f cells are read around the camera\n",
           least[0], least[1], least[2], least[3]);
    for (uint32_t c = 0; c < 4; c++)
        REQUIRE_CMP(least[c], >=, 6.0);
    walk_path_finish(&path);
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    walk_file = argv[1];
    flight_file = argv[2];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_walk_through_the_world_costs_the_same_in_every_frame),
        cmocka_unit_test(a_flight_over_the_world_costs_the_same_in_every_frame),
        cmocka_unit_test(jumps_along_the_walk_read_all_cascades),
    };
    return cmocka_run_group_tests_name("scroll_paths", tests, NULL, NULL);
}
