/* SPDX-License-Identifier: MIT
 * What the library says of a life without trouble, to hosts that want to know. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <vulkan/vulkan.h>

#include <stdio.h>
#include <string.h>

enum { MOST = 32 };

/* Messages in the order in which they came. */
struct diary {
    enum sdfgi_message ids[MOST];
    char texts[MOST][128];
    uint32_t count;
};

static void write_down(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    struct diary *diary = user;
    REQUIRE_CMP((int)level, ==, (int)SDFGI_LOG_INFO);
    REQUIRE_CMP(diary->count, <, (uint32_t)MOST);
    diary->ids[diary->count] = id;
    snprintf(diary->texts[diary->count++], sizeof *diary->texts, "%s", text);
    printf("%s\n", text);
}

static void open_context(struct gi_test *t, bool log_info, struct diary *diary)
{
    memset(t, 0, sizeof *t);
    memset(diary, 0, sizeof *diary);
    gpu_test_open(&t->gpu, sdfgi_get_requirements);
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    const struct sdfgi_desc desc = { .vulkan = { t->gpu.instance, t->gpu.physical_device, t->gpu.device,
                                                 t->gpu.queue_family_index, vkGetInstanceProcAddr },
                                     .settings = &settings,
                                     .log = { write_down, diary },
                                     .log_info = log_info };
    REQUIRE_CMP((int)sdfgi_create(&desc, &t->gi), ==, (int)SDFGI_OK);
}

static void set_sky(struct gi_test *t, float radiance)
{
    const struct sdfgi_sky sky = { { radiance, radiance, radiance },
                                   { radiance, radiance, radiance },
                                   { radiance, radiance, radiance } };
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &sky), ==, (int)SDFGI_OK);
}

static void add_floor(struct gi_test *t)
{
    struct test_mesh box = test_mesh_box((double[]){ 0, -1, 0 }, (double[]){ 2, 0.5, 2 }, test_rotation_none);
    gi_test_add(t, &box, gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 0, 0, 0 }));
    test_mesh_destroy(&box);
    set_sky(t, 1);
}

static void switch_to(struct gi_test *t, bool enabled)
{
    struct sdfgi_settings settings;
    sdfgi_get_settings(t->gi, &settings);
    settings.enabled = enabled;
    REQUIRE_CMP((int)sdfgi_set_settings(t->gi, &settings), ==, (int)SDFGI_OK);
}

static void live(struct gi_test *t)
{
    add_floor(t);
    gi_test_converge(t, 400);
    gi_test_update(t, 4); /* what has settled does not settle again */
    set_sky(t, 2);
    gi_test_converge(t, 400);
    switch_to(t, false);
    switch_to(t, true);
    gi_test_converge(t, 400);
    sdfgi_reset(t->gi);
    gi_test_converge(t, 400);
}

static void require_text(const struct diary *diary, uint32_t entry, const char *part)
{
    if (!strstr(diary->texts[entry], part))
        require_fail(__FILE__, __LINE__, "\"%s\" does not say %s", diary->texts[entry], part);
}

static void messages_tell_what_becomes_of_light(void **state)
{
    (void)state;
    static const enum sdfgi_message expected[] = {
        SDFGI_MESSAGE_SWITCHED, SDFGI_MESSAGE_CREATED,     SDFGI_MESSAGE_FIRST_LIGHT,
        SDFGI_MESSAGE_SETTLED,  SDFGI_MESSAGE_SETTLED, /* the other sky */
        SDFGI_MESSAGE_SWITCHED, SDFGI_MESSAGE_SWITCHED,    SDFGI_MESSAGE_FIRST_LIGHT,
        SDFGI_MESSAGE_SETTLED,  SDFGI_MESSAGE_FIRST_LIGHT, SDFGI_MESSAGE_SETTLED, /* after the reset */
    };
    static struct gi_test t;
    static struct diary diary;
    char mib[32];
    open_context(&t, true, &diary);
    snprintf(mib, sizeof mib, "%.1f MiB", (double)t.gi->backend.held.total_bytes / (1024 * 1024));
    live(&t);
    REQUIRE_CMP(diary.count, ==, (uint32_t)(sizeof expected / sizeof *expected));
    for (uint32_t i = 0; i < diary.count; i++)
        REQUIRE_CMP((int)diary.ids[i], ==, (int)expected[i]);
    require_text(&diary, 0, mib);
    require_text(&diary, 1, t.gpu.properties.deviceName);
    gi_test_close(&t);
}

static void who_does_not_ask_hears_none(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct diary diary;
    open_context(&t, false, &diary);
    add_floor(&t);
    gi_test_converge(&t, 400);
    REQUIRE_CMP(diary.count, ==, 0u);
    gi_test_close(&t);
}

TEST_GROUP(info)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages_tell_what_becomes_of_light),
        cmocka_unit_test(who_does_not_ask_hears_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
