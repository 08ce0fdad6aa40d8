/* SPDX-License-Identifier: MIT
 * With 100,000 instances, a frame looks at those that a change touches, and a settled frame at none: their
 * memory is out of reach meanwhile, and a look at it would end the program. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "box_field.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

static struct gi_test t;
static const struct box_field field = { 100000, 1 };
static sdfgi_instance *boxes;

/* ---- Memory that can be put out of reach */

enum { MOST_BLOCKS = 512 };

static struct {
    void *memory;
    size_t size;
} blocks[MOST_BLOCKS];

static void *map_alloc(void *user, size_t size)
{
    (void)user;
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), whole = (size + page - 1) / page * page;
    int i = 0;
    while (i < MOST_BLOCKS && blocks[i].memory)
        i++;
    REQUIRE_CMP(i, <, (int)MOST_BLOCKS);
    void *memory = mmap(NULL, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    REQUIRE_TRUE(memory != MAP_FAILED);
    blocks[i].memory = memory;
    blocks[i].size = whole;
    return memory;
}

static void map_free(void *user, void *memory)
{
    (void)user;
    for (int i = 0; i < MOST_BLOCKS; i++)
        if (blocks[i].memory == memory) {
            munmap(memory, blocks[i].size);
            blocks[i].memory = NULL;
        }
}

static void protect(const void *memory, int access)
{
    for (int i = 0; i < MOST_BLOCKS; i++)
        if (blocks[i].memory == memory)
            REQUIRE_CMP(mprotect(blocks[i].memory, blocks[i].size, access), ==, 0);
}

/* All that grows with the number of instances. */
static void protect_instances(int access)
{
    const struct scene *scene = &t.gi->scene;
    const void *const all[] = { scene->instances.items, scene->instances.live, scene->instances.generations,
                                scene->tree.nodes, scene->tree.parents };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        protect(all[i], access);
}

/* ---- The scene */

static void log_nothing(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)level;
    (void)id;
    (void)text;
}

static int open_field(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.cascades = 2;
    gi_test_open(&t, &settings);
    sdfgi_destroy(t.gi);
    const struct sdfgi_desc desc = { .vulkan = { t.gpu.instance, t.gpu.physical_device, t.gpu.device,
                                                 t.gpu.queue_family_index, vkGetInstanceProcAddr, NULL },
                                     .settings = &settings,
                                     .log = { log_nothing, NULL },
                                     .allocator = { map_alloc, map_free, NULL } };
    REQUIRE_CMP(sdfgi_create(&desc, &t.gi), ==, SDFGI_OK);
    struct test_mesh unit = box_field_unit();
    const sdfgi_mesh mesh = gi_test_mesh(&t, &unit);
    const sdfgi_material grey = gi_test_material(&t, (float[3]){ 0.5f, 0.5f, 0.5f }, (float[3]){ 0 });
    struct sdfgi_instance_desc *descs = test_array_alloc(field.count, sizeof *descs);
    boxes = test_array_alloc(field.count, sizeof *boxes);
    for (uint32_t i = 0; i < field.count; i++)
        descs[i] = (struct sdfgi_instance_desc){ mesh, grey, box_field_place(&field, i), SDFGI_STATIC };
    REQUIRE_CMP(sdfgi_instances_create(t.gi, field.count, descs, boxes), ==, SDFGI_OK);
    const struct sdfgi_sky sky = { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } };
    REQUIRE_CMP(sdfgi_set_sky(t.gi, &sky), ==, SDFGI_OK);
    gi_test_converge(&t, 2000);
    free(descs);
    test_mesh_destroy(&unit);
    return 0;
}

static int close_field(void **state)
{
    (void)state;
    gi_test_close(&t);
    free(boxes);
    return 0;
}

/* The box that stands nearest to the middle of the field, or `steps` boxes from it along x. */
static sdfgi_instance box_near_middle(uint32_t steps)
{
    const uint32_t side = (uint32_t)ceil(sqrt(field.count));
    return boxes[side / 2 * side + side / 2 + steps];
}

static const struct sdfgi_report *report(void)
{
    static struct sdfgi_report newest;
    sdfgi_get_report(t.gi, &newest);
    return &newest;
}

/* ---- Claims */

static void a_settled_frame_looks_at_no_instance(void **state)
{
    (void)state;
    gi_test_converge(&t, 2000);
    protect_instances(PROT_NONE);
    gi_test_update(&t, 6);
    const uint32_t commands = report()->command_count;
    t.frame.camera_position[0] += 0.5; /* within the middle: nothing scrolls */
    gi_test_update(&t, 2);
    t.frame.camera_position[0] -= 0.5;
    protect_instances(PROT_READ | PROT_WRITE);
    REQUIRE_CMP(commands, ==, 0u);
}

/* Light is made again, for as many frames as that takes, without a look at geometry. */
static void light_that_changes_looks_at_no_instance(void **state)
{
    (void)state;
    const struct sdfgi_light_desc lamp = { .type = SDFGI_LIGHT_POINT,
                                           .position = { 0, 2, 0 },
                                           .intensity = { 5, 5, 5 } };
    sdfgi_light light;
    protect_instances(PROT_NONE);
    REQUIRE_CMP(sdfgi_light_create(t.gi, &lamp, &light), ==, SDFGI_OK);
    gi_test_update(&t, 20);
    REQUIRE_CMP(sdfgi_light_destroy(t.gi, light), ==, SDFGI_OK);
    gi_test_update(&t, 20);
    const bool voxelizes = report()->passes[PASS_REGION_CLEAR].ran;
    protect_instances(PROT_READ | PROT_WRITE);
    REQUIRE_TRUE(!voxelizes);
}

/* Triangles drawn, and cells cleared, until nothing changes any more. */
static void sum_work(uint64_t *triangles, uint64_t *cells)
{
    *triangles = *cells = 0;
    for (int frame = 0; frame < 12; frame++) {
        gi_test_update(&t, 1);
        *triangles += report()->passes[PASS_VOXELIZE].work;
        *cells += report()->passes[PASS_REGION_CLEAR].work;
    }
    REQUIRE_CMP(report()->scroll.pending_cells, ==, 0ull);
}

static void one_box_that_moves_is_all_that_is_made_again(void **state)
{
    (void)state;
    struct sdfgi_transform place = box_field_place(&field, 0);
    uint64_t triangles, cells;
    memset(place.translation, 0, sizeof place.translation);
    place.translation[1] = 0.75;
    REQUIRE_CMP(sdfgi_instance_set_transform(t.gi, box_near_middle(0), &place), ==, SDFGI_OK);
    sum_work(&triangles, &cells);
    /* Two boxes of 8 cells a side, in each of two cascades, at most: in the coarse one 4 m a side, where 8 x
     * 8 boxes stand at most. */
    REQUIRE_CMP(triangles, >, 0ull);
    REQUIRE_CMP(cells, <=, 2ull * 8 * 512);
    REQUIRE_CMP(triangles, <=, 12ull * 8 * 64);

    /* And the volumes are as those of a fresh start. */
    uint64_t size;
    uint8_t *moved = gi_test_read(&t, RESOURCE_BITS, &size);
    sdfgi_reset(t.gi);
    gi_test_update(&t, 1);
    uint8_t *fresh = gi_test_read(&t, RESOURCE_BITS, NULL);
    REQUIRE_BYTES(fresh, moved, size);
    free(moved);
    free(fresh);
}

static void a_box_that_moves_far_away_wakes_nothing(void **state)
{
    (void)state;
    struct sdfgi_transform place = box_field_place(&field, 0);
    gi_test_converge(&t, 2000);
    place.translation[1] += 10;
    REQUIRE_CMP(sdfgi_instance_set_transform(t.gi, boxes[0], &place), ==, SDFGI_OK);
    gi_test_update(&t, 2);
    REQUIRE_CMP(report()->command_count, ==, 0u);
}

/* What changed while nothing was voxelised, and what was made anew in its slot, is drawn where it is. */
static void changes_far_away_are_there_once_the_camera_is(void **state)
{
    (void)state;
    const struct sdfgi_transform corner = box_field_place(&field, 0);
    t.frame.camera_position[0] = corner.translation[0];
    t.frame.camera_position[2] = corner.translation[2];
    gi_test_update(&t, 40);
    uint64_t size;
    uint8_t *walked = gi_test_read(&t, RESOURCE_BITS, &size);
    sdfgi_reset(t.gi);
    gi_test_update(&t, 1);
    uint8_t *fresh = gi_test_read(&t, RESOURCE_BITS, NULL);
    REQUIRE_BYTES(fresh, walked, size);
    free(walked);
    free(fresh);
}

TEST_GROUP(changes)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_settled_frame_looks_at_no_instance),
        cmocka_unit_test(light_that_changes_looks_at_no_instance),
        cmocka_unit_test(one_box_that_moves_is_all_that_is_made_again),
        cmocka_unit_test(a_box_that_moves_far_away_wakes_nothing),
        cmocka_unit_test(changes_far_away_are_there_once_the_camera_is),
    };
    return cmocka_run_group_tests_name("instances_changes", tests, open_field, close_field);
}
