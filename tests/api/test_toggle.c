/* SPDX-License-Identifier: MIT
 * GI is switched in every frame, 250 times, and a thousand with SDFGI_TEST_FULL=1: nothing is made, and no
 * frame takes longer than one in which GI stays on. Prints times of frames; it is the benchmark of the switch
 * on the device of SDFGI_TEST_DEVICE, with default settings if SDFGI_TEST_FULL=1. Times are not checked:
 * other work on the machine is in them. */
#include "counting_vulkan.h"
#include "gi_test.h"
#include "require.h"

#include <vulkan/vulkan.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { FRAMES_MOST = 1000, WARM = 40, BOXES = 24 };

static struct gi_test t;
static VkQueryPool queries;
static sdfgi_light lamp;

struct frame_times {
    double cpu_ms[FRAMES_MOST], gpu_ms[FRAMES_MOST];
    uint32_t count;
};
static struct frame_times steady, on, off;

static bool is_full(void)
{
    return getenv("SDFGI_TEST_FULL") != NULL;
}

static struct sdfgi_settings settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.ray_count = 4;
    if (is_full())
        sdfgi_settings_default(&s);
    s.enabled = enabled;
    return s;
}

static struct sdfgi_light_desc lamp_at(uint32_t frame)
{
    const double angle = 0.01 * frame;
    return (struct sdfgi_light_desc){ .type = SDFGI_LIGHT_POINT,
                                      .position = { cos(angle), 1, sin(angle) },
                                      .intensity = { 20, 20, 20 },
                                      .casts_shadow = true };
}

/* Boxes on a floor under a lamp that goes round, so that every frame has something to do. */
static void add_scene(void)
{
    const sdfgi_material grey = gi_test_material(&t, (float[]){ 0.6f, 0.5f, 0.4f }, (float[]){ 0, 0, 0 });
    for (int i = 0; i <= BOXES; i++) {
        const double angle = 0.7 * i, far = 1.5 + 0.5 * i;
        struct test_mesh box =
            i == BOXES ? test_mesh_box((double[]){ 0, -2, 0 }, (double[]){ 40, 0.5, 40 }, test_rotation_none)
                       : test_mesh_box((double[]){ far * cos(angle), -1, far * sin(angle) },
                                       (double[]){ 0.3, 0.6, 0.4 }, test_rotation_none);
        gi_test_add(&t, &box, grey);
        test_mesh_destroy(&box);
    }
    const struct sdfgi_light_desc desc = lamp_at(0);
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &desc, &lamp), ==, (int)SDFGI_OK);
}

static int open_context(void **state)
{
    (void)state;
    gpu_test_open(&t.gpu, sdfgi_get_requirements);
    const struct sdfgi_settings s = settings(false);
    struct sdfgi_desc desc = gi_test_desc(&t, &s);
    desc.vulkan.get_instance_proc_addr = counting_vulkan_loader();
    desc.pipelines_later = true;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
    const VkQueryPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = 2 };
    REQUIRE_CMP((int)vkCreateQueryPool(t.gpu.device, &info, NULL, &queries), ==, (int)VK_SUCCESS);
    add_scene();
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    vkDestroyQueryPool(t.gpu.device, queries, NULL);
    gi_test_close(&t);
    return 0;
}

/* ---- Frames */

static double now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

struct host_frame {
    const struct sdfgi_settings *settings;
    uint32_t number;
    double cpu_ms;
};

/* What a host calls in a frame, with GPU timestamps around it. */
static void record_frame(VkCommandBuffer cmd, uint32_t index, void *user)
{
    struct host_frame *frame = user;
    const struct sdfgi_light_desc desc = lamp_at(frame->number);
    (void)index;
    vkCmdResetQueryPool(cmd, queries, 0, 2);
    vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 0);
    const double begin = now_ms();
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, frame->settings), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_light_update(t.gi, lamp, &desc), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_update(t.gi, cmd, &t.frame), ==, (int)SDFGI_OK);
    frame->cpu_ms = now_ms() - begin;
    vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries, 1);
}

static void run_frame(const struct sdfgi_settings *s, uint32_t number, struct frame_times *times)
{
    struct host_frame frame = { .settings = s, .number = number };
    uint64_t ticks[2];
    gpu_test_submit(&t.gpu, record_frame, &frame);
    REQUIRE_CMP((int)vkGetQueryPoolResults(t.gpu.device, queries, 0, 2, sizeof ticks, ticks, sizeof *ticks,
                                           VK_QUERY_RESULT_64_BIT),
                ==, (int)VK_SUCCESS);
    if (!times)
        return;
    times->cpu_ms[times->count] = frame.cpu_ms;
    times->gpu_ms[times->count++] =
        1e-6 * (double)t.gpu.properties.limits.timestampPeriod * (double)(ticks[1] - ticks[0]);
}

/* ---- Times */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct summary {
    double median, worst;
};

static struct summary summarise(const double *cpu, const double *gpu, uint32_t count)
{
    static double sums[FRAMES_MOST];
    for (uint32_t i = 0; i < count; i++)
        sums[i] = (cpu ? cpu[i] : 0) + (gpu ? gpu[i] : 0);
    qsort(sums, count, sizeof *sums, compare);
    return (struct summary){ sums[count / 2], sums[count - 1] };
}

static struct summary print_times(const char *what, const struct frame_times *times)
{
    const struct summary cpu = summarise(times->cpu_ms, NULL, times->count),
                         gpu = summarise(NULL, times->gpu_ms, times->count),
                         both = summarise(times->cpu_ms, times->gpu_ms, times->count);
    printf("%-28s %8.3f %8.3f   %8.3f %8.3f   %8.3f %8.3f\n", what, cpu.median, cpu.worst, gpu.median,
           gpu.worst, both.median, both.worst);
    return both;
}

static void print_summary(double first_ms)
{
    printf("%s, ms                 CPU median    worst   GPU median    worst     sum median    worst\n",
           t.gpu.properties.deviceName);
    const struct summary base = print_times("on throughout", &steady), ons = print_times("switched on", &on),
                         offs = print_times("switched off", &off);
    const double worst = fmax(ons.worst, offs.worst);
    printf("the first frame that was on took %.3f ms\n", first_ms);
    printf("worst switched frame over the median frame that stays on: %.2f\n", worst / base.median);
}

/* ---- The test */

static void prepare(const struct sdfgi_settings *s)
{
    const struct sdfgi_prepare_desc desc = { .settings = s, .max_objects = 8 };
    struct sdfgi_progress p = { 0, 1 };
    while (p.made < p.total)
        REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_OK);
}

static uint32_t message_count(void)
{
    uint32_t count = 0;
    for (int i = 0; i < SDFGI_MESSAGE_COUNT; i++)
        count += t.messages[i];
    return count;
}

static uint64_t held(void)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t.gi, &report);
    return report.memory.total_bytes;
}

static void switches_make_nothing(void **state)
{
    (void)state;
    const struct sdfgi_settings s[2] = { settings(false), settings(true) };
    prepare(&s[0]);
    const struct counting_vulkan prepared = counting_vulkan_get();
    struct frame_times first = { .count = 0 };
    const uint32_t frames = is_full() ? FRAMES_MOST : FRAMES_MOST / 4, steady_frames = frames / 5;
    for (uint32_t i = 0; i < WARM; i++)
        run_frame(&s[1], i, i == 0 ? &first : NULL);
    const struct counting_vulkan before = counting_vulkan_get();
    const uint64_t bytes = held();
    REQUIRE_CMP(before.pipelines, ==, prepared.pipelines);
    for (uint32_t i = 0; i < steady_frames; i++)
        run_frame(&s[1], WARM + i, &steady);
    for (uint32_t i = 0; i < frames; i++)
        run_frame(&s[i % 2], WARM + steady_frames + i, i % 2 ? &on : &off);
    print_summary(first.cpu_ms[0] + first.gpu_ms[0]);
    const struct counting_vulkan after = counting_vulkan_get();
    REQUIRE_CMP(after.pipelines, ==, before.pipelines);
    REQUIRE_CMP(after.memory, ==, before.memory);
    REQUIRE_CMP(after.objects, ==, before.objects);
    REQUIRE_CMP(held(), ==, bytes);
    REQUIRE_CMP(message_count(), ==, 0u);
    REQUIRE_CMP(on.count + off.count, ==, frames);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(switches_make_nothing, open_context, close_context),
    };
    return cmocka_run_group_tests_name("api_toggle", tests, NULL, NULL);
}
