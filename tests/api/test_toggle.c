/* SPDX-License-Identifier: MIT
 * GI is switched in every frame, 250 times, and a thousand with SDFGI_TEST_FULL=1 on a GPU: nothing is made,
 * and no frame takes longer than one in which GI stays on. The scene has textures, emission and a smooth
 * material, and pictures are gathered and resolved. Prints times of frames; it is the benchmark of the switch
 * on the device of SDFGI_TEST_DEVICE, with default settings if SDFGI_TEST_FULL=1. Times are not checked:
 * other work on the machine is in them. */
#include "counting_vulkan.h"
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <vulkan/vulkan.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FRAMES_MOST = 1000, WARM = 40, BOXES = 8, SIDE = 5, PIXELS = SIDE * SIDE };

static struct gi_test t;
static VkQueryPool queries;
static sdfgi_light lamp;
static struct gpu_test_image texture, depth, normal, roughness, irradiance;
static sdfgi_view *view;

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

static sdfgi_material add_material(const struct sdfgi_material_desc *desc)
{
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t.gi, desc, &material), ==, (int)SDFGI_OK);
    return material;
}

/* Boxes on a floor under a lamp that goes round, so that every frame has something to do. */
static void add_scene(void)
{
    const struct sdfgi_texture brick = { .view = texture.view, .layout = texture.layout };
    const struct sdfgi_material_desc descs[] = {
        { .albedo = { 0.6f, 0.5f, 0.4f }, .albedo_texture = brick },
        { .albedo = { 0.6f, 0.5f, 0.4f }, .smoothness = 0.9f },
        { .albedo = { 0.5f, 0.5f, 0.5f }, .emission = { 1, 2, 3 } },
        { .albedo = { 0.5f, 0.5f, 0.5f }, .emission = { 1, 2, 3 }, .emission_texture = brick },
    };
    sdfgi_material materials[4];
    for (int i = 0; i < 4; i++)
        materials[i] = add_material(&descs[i]);
    for (int i = 0; i <= BOXES; i++) {
        const double angle = 0.7 * i, far = 1.5 + 0.5 * i;
        struct test_mesh box =
            i == BOXES ? test_mesh_box((double[]){ 0, -2, 0 }, (double[]){ 40, 0.5, 40 }, test_rotation_none)
                       : test_mesh_box((double[]){ far * cos(angle), 0, far * sin(angle) },
                                       (double[]){ 0.3, 1.6, 0.4 }, test_rotation_none);
        gi_test_add(&t, &box, materials[i % 4]);
        test_mesh_destroy(&box);
    }
    const struct sdfgi_light_desc desc = lamp_at(0);
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &desc, &lamp), ==, (int)SDFGI_OK);
}

/* A picture of the floor from straight above, 4 m a side, of a surface as smooth as can be. */
static void add_picture(void)
{
    static const uint8_t texels[4][4] = { { 255, 128, 64, 255 },
                                          { 128, 255, 64, 255 },
                                          { 255, 255, 255, 255 } };
    float depths[PIXELS], normals[PIXELS][4], rough[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        depths[i] = 0.5f;
        rough[i] = 0;
        for (int k = 0; k < 4; k++)
            normals[i][k] = k == 1;
    }
    texture = gi_test_gather_image(&t, VK_FORMAT_R8G8B8A8_UNORM, 4, 2, 2, texels);
    depth = gi_test_gather_image(&t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, depths);
    normal = gi_test_gather_image(&t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, normals);
    roughness = gi_test_gather_image(&t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, rough);
    irradiance = gi_test_gather_image(&t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, SIDE, SIDE, NULL);
    const struct sdfgi_view_desc desc = { .width = SIDE, .height = SIDE, .reflections = true };
    REQUIRE_CMP((int)sdfgi_view_create(t.gi, &desc, &view), ==, (int)SDFGI_OK);
}

static int open_context(void **state)
{
    (void)state;
    gi_test_open_device(&t);
    const struct sdfgi_settings s = settings(false);
    struct sdfgi_desc desc = gi_test_desc(&t, &s);
    desc.vulkan.get_instance_proc_addr = counting_vulkan_loader_sharing();
    desc.pipelines_later = true;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
    const VkQueryPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = 2 };
    REQUIRE_CMP((int)vkCreateQueryPool(t.gpu.device, &info, NULL, &queries), ==, (int)VK_SUCCESS);
    add_picture();
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    struct gpu_test_image *images[] = { &texture, &depth, &normal, &roughness, &irradiance };
    vkDestroyQueryPool(t.gpu.device, queries, NULL);
    for (int i = 0; i < 5; i++)
        gpu_test_image_destroy(&t.gpu, images[i]);
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

static const float world_from_clip[16] = { 2, 0, 0, 0, 0, 0, 2, 0, 0, -0.2f, 0, 0, 0, -1.4f, 0, 1 };

/* A software driver takes 20 ms for each, however small it is: in a short run few frames have them. */
static bool has_pictures(uint32_t number)
{
    return is_full() || number % 20 < 2;
}

static void record_pictures(VkCommandBuffer cmd)
{
    struct sdfgi_gather_desc gather = {
        .depth = depth.view, .normal = normal.view, .output = irradiance.view, .width = SIDE, .height = SIDE
    };
    struct sdfgi_resolve_desc resolve = { .depth = depth.view,
                                          .normal = normal.view,
                                          .roughness = roughness.view };
    memcpy(gather.inverse_view_projection, world_from_clip, sizeof world_from_clip);
    memcpy(resolve.inverse_view_projection, world_from_clip, sizeof world_from_clip);
    REQUIRE_CMP((int)sdfgi_gather(t.gi, cmd, &gather), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_view_resolve(t.gi, view, cmd, &resolve), ==, (int)SDFGI_OK);
}

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
    if (has_pictures(frame->number))
        record_pictures(cmd);
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

/* Or else nothing was switched but the volumes. */
static void require_pictures_with_light(void)
{
    uint16_t texels[PIXELS][4];
    struct sdfgi_view_images images;
    float sum = 0;
    gpu_test_image_read(&t.gpu, irradiance.image, irradiance.layout, VK_IMAGE_ASPECT_COLOR_BIT,
                        irradiance.extent, sizeof *texels, texels);
    for (int i = 0; i < PIXELS; i++)
        sum += gi_test_half(texels[i][1]);
    REQUIRE_CMP(sum / PIXELS, >, 0.01f);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.diffuse && images.reflection);
}

static void switches_make_nothing(void **state)
{
    (void)state;
    const struct sdfgi_settings s[2] = { settings(false), settings(true) };
    prepare(&s[0]);
    const struct counting_vulkan prepared = counting_vulkan_get();
    add_scene();
    struct frame_times first = { .count = 0 };
    const uint32_t frames = is_full() ? gpu_test_repeats(&t.gpu, FRAMES_MOST) : FRAMES_MOST / 4,
                   steady_frames = frames / 5, warm = gpu_test_is_software(&t.gpu) ? WARM / 4 : WARM;
    for (uint32_t i = 0; i < warm; i++)
        run_frame(&s[1], i, i == 0 ? &first : NULL);
    const struct counting_vulkan before = counting_vulkan_get();
    const uint64_t bytes = held();
    REQUIRE_CMP(before.pipelines, ==, prepared.pipelines);
    REQUIRE_CMP(before.memory, ==, prepared.memory);
    for (uint32_t i = 0; i < steady_frames; i++)
        run_frame(&s[1], warm + i, &steady);
    for (uint32_t i = 0; i < frames; i++)
        run_frame(&s[i % 2], warm + steady_frames + i, i % 2 ? &on : &off);
    print_summary(first.cpu_ms[0] + first.gpu_ms[0]);
    const struct counting_vulkan after = counting_vulkan_get();
    REQUIRE_CMP(after.pipelines, ==, before.pipelines);
    REQUIRE_CMP(after.memory, ==, before.memory);
    REQUIRE_CMP(after.objects, ==, before.objects);
    REQUIRE_CMP(held(), ==, bytes);
    REQUIRE_CMP(message_count(), ==, 0u);
    REQUIRE_CMP(on.count + off.count, ==, frames);
    require_pictures_with_light();
}

TEST_GROUP(toggle)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(switches_make_nothing, open_context, close_context),
    };
    return cmocka_run_group_tests_name("api_toggle", tests, NULL, NULL);
}
