/* SPDX-License-Identifier: MIT
 * The host looks light up where it shades, or before: pictures are the same. */
#include "far_stage.h"
#include "far_scene.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct host_device *device;

/* A renderer of the stage's scene, with as many frames behind it as the stage's own. */
static struct host_renderer *renderer_open(const struct far_stage *stage, enum host_lookup lookup)
{
    struct sdfgi_settings settings;
    host_renderer_get_settings(stage->renderer, &settings);
    const struct host_renderer_desc desc = { .width = FAR_WIDTH,
                                             .height = FAR_HEIGHT,
                                             .settings = &settings,
                                             .lookups = { lookup, HOST_LOOKUP_FULL } };
    struct host_renderer *renderer = host_renderer_create(device, stage->scene, &desc);
    const struct host_until_desc until = { .frames = 8 };
    if (!renderer || !host_render_until(renderer, &stage->view.camera, &until, NULL))
        fail_msg("%s", host_device_error(device));
    return renderer;
}

static float *read_aov(struct host_renderer *renderer, enum host_aov aov)
{
    float *rgba = malloc(4 * sizeof(float) * FAR_PIXELS);
    if (!rgba || !host_renderer_read_aov(renderer, aov, rgba))
        fail_msg("%s", host_device_error(device));
    return rgba;
}

/* Mean absolute difference over the mean of what is expected. */
static double difference(const float *expected, const float *found)
{
    double sum = 0, light = 0;
    for (int i = 0; i < 4 * FAR_PIXELS; i++) {
        if (i % 4 == 3)
            continue;
        sum += fabs((double)found[i] - (double)expected[i]);
        light += fabs((double)expected[i]);
    }
    REQUIRE_CMP(light, >, 0.0);
    return sum / light;
}

/* Half floats of normals and of the result are what tells full from forward. Colour holds reflections as
 * well: those of a picture are means over the lobe, by what facets reflect, where a forward lookup sends one
 * ray. */
static void require_alike(const struct far_stage *stage, struct host_renderer *renderer,
                          enum host_lookup lookup)
{
    static const double tolerance[HOST_LOOKUP_COUNT] = {
        [HOST_LOOKUP_FULL] = 1e-3, [HOST_LOOKUP_HALF] = 2e-3, [HOST_LOOKUP_QUARTER] = 2e-3
    };
    static const double of_reflections = 2e-3;
    static const enum host_aov aovs[] = { HOST_AOV_IRRADIANCE, HOST_AOV_COLOR };
    for (int i = 0; i < 2; i++) {
        float *expected = read_aov(stage->renderer, aovs[i]), *found = read_aov(renderer, aovs[i]);
        const double d = difference(expected, found);
        printf("%s, looked up at %s resolution: differs by %.5f\n", host_aov_name(aovs[i]),
               host_lookup_name(lookup), d);
        REQUIRE_CMP(d, <=, aovs[i] == HOST_AOV_COLOR ? of_reflections : tolerance[lookup]);
        free(expected);
        free(found);
    }
}

static void require_the_same_after_a_frame_without_gi(struct host_renderer *renderer,
                                                      const struct host_camera *camera)
{
    struct host_times times;
    float *before = read_aov(renderer, HOST_AOV_COLOR);
    REQUIRE_TRUE(host_renderer_frame_without_gi(renderer, camera));
    host_renderer_get_times(renderer, &times);
    REQUIRE_CMP(times.shadow_ns + times.update_ns, <=, times.frame_ns);
    float *after = read_aov(renderer, HOST_AOV_COLOR);
    REQUIRE_CMP(memcmp(before, after, 4 * sizeof(float) * FAR_PIXELS), ==, 0);
    free(before);
    free(after);
}

static void pictures_are_alike_wherever_light_is_looked_up(void **state)
{
    (void)state;
    struct far_stage stage;
    far_stage_open(&stage, device, (double[]){ 0, 0, 0 }, true, 0);
    for (int i = HOST_LOOKUP_FULL; i < HOST_LOOKUP_COUNT; i++) {
        struct host_renderer *renderer = renderer_open(&stage, (enum host_lookup)i);
        require_alike(&stage, renderer, (enum host_lookup)i);
        require_the_same_after_a_frame_without_gi(renderer, &stage.view.camera);
        REQUIRE_TRUE(host_renderer_resize(renderer, FAR_WIDTH / 2, FAR_HEIGHT / 2));
        REQUIRE_TRUE(host_renderer_frame(renderer, &stage.view.camera));
        host_renderer_destroy(renderer);
    }
    require_the_same_after_a_frame_without_gi(stage.renderer, &stage.view.camera);
    far_stage_close(&stage);
}

static void lookups_have_names(void **state)
{
    (void)state;
    for (int i = 0; i < HOST_LOOKUP_COUNT; i++)
        REQUIRE_CMP((int)host_lookup_from_name(host_lookup_name((enum host_lookup)i)), ==, i);
    REQUIRE_CMP((int)host_lookup_from_name("eighth"), ==, (int)HOST_LOOKUP_COUNT);
}

TEST_GROUP(lookups)
{
    const int code = far_place_open(&device);
    if (code)
        return code;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_alike_wherever_light_is_looked_up),
        cmocka_unit_test(lookups_have_names),
    };
    return far_place_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
