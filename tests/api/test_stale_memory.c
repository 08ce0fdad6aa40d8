/* SPDX-License-Identifier: MIT
 * Memory holds what somebody else left in it. Nothing depends on that. */
#include "counting_vulkan.h"
#include "gather_picture.h"
#include "pool_allocator.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdlib.h>

static struct gi_test t;
static struct pool_allocator pool;

/* A context whose memory holds `stale` in each word. */
static void create(uint32_t stale)
{
    struct sdfgi_settings settings = gi_test_settings();
    gi_test_open_device(&t);
    settings.resolution = 32;
    settings.cascades = 2;
    settings.ray_count = 25;
    settings.frames_to_converge = 5;
    struct sdfgi_desc desc = gi_test_desc(&t, &settings);
    desc.vulkan.get_instance_proc_addr = counting_vulkan_loader_sharing();
    desc.device_allocator = pool_allocator_functions(&pool);
    pool_allocator_open(&pool, &t.gpu);
    pool.stale = stale;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
}

static void destroy(void)
{
    gi_test_destroy(&t);
    pool_allocator_close(&pool);
    gi_test_close(&t);
}

/* ---- Light */

enum { SIDE = 32, PIXELS = SIDE * SIDE, ACROSS = 6, POINTS = ACROSS * ACROSS * ACROSS };

/* Of which there are hashes: what a context holds and shows. */
enum { DISTANCES, PROBES, IRRADIANCE, COUNTERS, FULL, HALF, REFLECTIONS, LOOKUPS, SHOWN };
static const char *const names[SHOWN] = { "distances", "probes",      "irradiance",  "counters",
                                          "gather",    "half gather", "reflections", "lookups" };

/* The first `most` bytes, or all. */
static uint64_t hash_resource(enum resource resource, uint64_t most)
{
    uint64_t size;
    void *data = gi_test_read(&t, resource, &size);
    const uint64_t h = gi_test_hash(data, size < most ? size : most);
    free(data);
    return h;
}

static uint64_t hash_gather(const struct picture *picture, enum sdfgi_gather_resolution resolution)
{
    float(*light)[3] = picture_gather(&t, picture, resolution);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += (double)light[i][1];
    REQUIRE_TRUE(isfinite(sum) && sum / PIXELS > 0.01);
    const uint64_t h = gi_test_hash(light, sizeof(float[PIXELS][3]));
    free(light);
    return h;
}

static uint64_t hash_reflection(const struct picture *picture)
{
    static float roughness[PIXELS];
    static uint16_t texels[PIXELS][4];
    for (int i = 0; i < PIXELS; i++)
        roughness[i] = (float)(i % SIDE) / SIDE;
    picture_reflect(&t, picture, roughness, texels);
    return gi_test_hash(texels, sizeof texels);
}

/* Of points in the air, in walls and beyond all cascades. */
static uint64_t hash_points(void)
{
    static struct gi_test_point points[POINTS];
    static float light[POINTS][3];
    for (int i = 0; i < POINTS; i++) {
        const int at[3] = { i % ACROSS, i / ACROSS % ACROSS, i / ACROSS / ACROSS };
        points[i] = (struct gi_test_point){ .normal = { 0, i % 2 ? 1 : -1, 0 } };
        for (int k = 0; k < 3; k++)
            points[i].position[k] = -11.3f + 4.1f * (float)at[k];
    }
    gi_test_irradiance(&t, points, POINTS, light);
    return gi_test_hash(light, sizeof light);
}

static void show(const struct picture_scene *scene, uint64_t shown[static SHOWN])
{
    static const struct picture_camera camera = { .position = { 0.4, 1.5, 0.3 },
                                                  .right = { 1, 0, 0 },
                                                  .up = { 0, 0, -1 },
                                                  .forward = { 0, -1, 0 },
                                                  .tan_x = 1,
                                                  .tan_y = 1,
                                                  .near_m = 0.05 };
    struct picture picture = picture_draw(scene, &camera, SIDE, SIDE);
    shown[DISTANCES] = hash_resource(RESOURCE_DISTANCE, UINT64_MAX);
    shown[PROBES] = hash_resource(RESOURCE_PROBES, UINT64_MAX);
    shown[IRRADIANCE] = hash_resource(RESOURCE_IRRADIANCE, UINT64_MAX);
    shown[COUNTERS] = hash_resource(RESOURCE_COUNTERS, 4 * (SDFGI_COUNTER_SAMPLES_CUT + 1));
    shown[FULL] = hash_gather(&picture, SDFGI_GATHER_FULL);
    shown[HALF] = hash_gather(&picture, SDFGI_GATHER_HALF);
    shown[REFLECTIONS] = hash_reflection(&picture);
    shown[LOOKUPS] = hash_points();
    picture_finish(&picture);
}

static void add_light(void)
{
    static const struct sdfgi_light_desc desc = { .type = SDFGI_LIGHT_POINT,
                                                  .position = { 0, 1, 0 },
                                                  .range_m = 10,
                                                  .intensity = { 5, 5, 5 },
                                                  .indirect_energy = 1,
                                                  .casts_shadow = true };
    sdfgi_light light;
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &desc, &light), ==, (int)SDFGI_OK);
}

static void add_box(struct picture_scene *scene, const double center[static 3], const double half[static 3],
                    float emission)
{
    picture_scene_add(scene, &t, test_mesh_box(center, half, test_rotation_none), 0.5f, emission);
}

/* A floor, a wall and a light; a lamp and a roof come later, and the camera walks on. */
static void journey(uint32_t stale, uint64_t shown[static 2 * SHOWN])
{
    static const struct sdfgi_material_desc smooth = { .smoothness = 1 }; /* with it reflections exist */
    struct picture_scene scene = { .count = 0 };
    sdfgi_material material;
    create(stale);
    REQUIRE_CMP((int)sdfgi_material_create(t.gi, &smooth, &material), ==, (int)SDFGI_OK);
    add_box(&scene, (double[]){ 0, -1.1, 0 }, (double[]){ 6, 0.4, 6 }, 0);
    add_box(&scene, (double[]){ 1, 0, 0 }, (double[]){ 0.2, 0.9, 1.5 }, 0);
    add_light();
    gi_test_update(&t, 4);
    show(&scene, shown);
    add_box(&scene, (double[]){ -1, 0, 0 }, (double[]){ 0.3, 0.3, 0.3 }, 3);
    gi_test_update(&t, 8);
    add_box(&scene, (double[]){ 0, 2.2, 0 }, (double[]){ 1.5, 0.2, 1.5 }, 0);
    gi_test_update(&t, 4);
    t.frame.camera_position[0] += 3;
    gi_test_update(&t, 6);
    show(&scene, shown + SHOWN);
    picture_scene_finish(&scene);
    destroy();
}

static void light_does_not_depend_on_what_memory_held(void **state)
{
    (void)state;
    static const uint32_t stale[] = { 1, 0x7fc00000 /* NaN */, UINT32_MAX };
    uint64_t expected[2 * SHOWN], found[2 * SHOWN];
    journey(0, expected);
    for (int i = 0; i < (int)(sizeof stale / sizeof *stale); i++) {
        journey(stale[i], found);
        for (int k = 0; k < 2 * SHOWN; k++)
            if (found[k] != expected[k])
                require_fail(__FILE__, __LINE__, "%s, %s: another where memory held %#x", names[k % SHOWN],
                             k < SHOWN ? "first light" : "after a walk", (unsigned)stale[i]);
    }
}

/* ---- Lost updates */

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index, (void)user;
    REQUIRE_CMP((int)sdfgi_update(t.gi, cmd, &t.frame), ==, (int)SDFGI_OK);
}

/* Memory may hold the numbers of another context's updates: they are not this one's. */
static void a_first_update_that_is_lost_is_noticed(void **state)
{
    (void)state;
    for (uint32_t number = 0; number < 4; number++) {
        create(number);
        gpu_test_record_and_drop(&t.gpu, record_update, NULL);
        gi_test_update(&t, 6);
        REQUIRE_CMP(t.messages[SDFGI_MESSAGE_UPDATE_LOST], ==, 1u);
        destroy();
    }
}

TEST_GROUP(stale_memory)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_does_not_depend_on_what_memory_held),
        cmocka_unit_test(a_first_update_that_is_lost_is_noticed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
