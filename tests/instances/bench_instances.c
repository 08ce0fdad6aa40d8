/* SPDX-License-Identifier: MIT
 * What many instances cost: CPU time of sdfgi_update, settled and walking, and GPU time of voxelisation,
 * beside that of one mesh with as many triangles. A benchmark, not a test.
 *
 *   bench_instances [INSTANCES] [RESOLUTION] [FRAMES] [SPACING_M]
 *
 * Set SDFGI_TEST_DEVICE to choose a device and SDFGI_TEST_VALIDATION=0 to measure without validation. With
 * SDFGI_BENCH_RECORD=1 dispatches and draws are left out: a software driver then takes no time that CPU times
 * could be lost in, and there are no GPU times. */
#include "box_field.h"
#include "layered_vulkan.h"
#include "require.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SETTLE_MOST = 4000, RESTARTS = 3, WARM_UP_STARTS = 100 };

struct bench {
    struct gi_test t;
    struct box_field field;
    uint32_t resolution, frames;
    double voxelize_ms[2][2]; /* GPU time: of instances and of one mesh; of a first frame and of a walk */
    double update_ms;         /* CPU time of the last update, of the thread that records */
};

static struct bench bench;

static double thread_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static void record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    struct bench *b = user;
    const double begin = thread_ms();
    REQUIRE_CMP(sdfgi_update(b->t.gi, cmd, &b->t.frame), ==, SDFGI_OK);
    b->update_ms = thread_ms() - begin;
}

static void update(void)
{
    gpu_test_submit(&bench.t.gpu, record, &bench);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_times(const char *what, double *ms, uint32_t count)
{
    qsort(ms, count, sizeof *ms, compare);
    printf("%-34s median %8.3f  95 %% %8.3f  worst %8.3f ms\n", what, ms[count / 2], ms[count * 95 / 100],
           ms[count - 1]);
}

/* ---- A device that does nothing */

static VKAPI_ATTR void VKAPI_CALL no_dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    (void)cmd, (void)x, (void)y, (void)z;
}

static VKAPI_ATTR void VKAPI_CALL no_dispatch_indirect(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize at)
{
    (void)cmd, (void)buffer, (void)at;
}

static const struct layered_function idle[] = {
    LAYERED("vkCmdDispatch", no_dispatch),
    LAYERED("vkCmdDispatchIndirect", no_dispatch_indirect),
    { NULL, NULL },
};

static void open_device(void)
{
    struct sdfgi_settings off;
    sdfgi_settings_default(&off);
    gi_test_open(&bench.t, &off);
    const char *record = getenv("SDFGI_BENCH_RECORD");
    if (!record || strcmp(record, "1") != 0)
        return;
    const struct gpu_test *gpu = &bench.t.gpu;
    const struct sdfgi_desc desc = { .vulkan = { gpu->instance, gpu->physical_device, gpu->device,
                                                 gpu->queue_family_index, layered_vulkan_loader(idle),
                                                 NULL } };
    sdfgi_destroy(bench.t.gi);
    REQUIRE_CMP(sdfgi_create(&desc, &bench.t.gi), ==, SDFGI_OK);
}

/* ---- Scenes */

static void open_context(void)
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.enabled = true;
    settings.resolution = bench.resolution;
    gi_test_renew(&bench.t, &settings);
    const uint32_t none[SDFGI_COUNTER_COUNT] = { 0 }; /* where no shader writes them */
    gpu_test_buffer_write(&bench.t.gpu, bench.t.gi->volume.resources->buffers[RESOURCE_COUNTERS].handle, 0,
                          sizeof none, none);
    bench.t.frame.camera_position[1] = 1.7;
    const struct sdfgi_sky sky = { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } };
    REQUIRE_CMP(sdfgi_set_sky(bench.t.gi, &sky), ==, SDFGI_OK);
}

static void add_instances(void)
{
    struct test_mesh unit = box_field_unit();
    const sdfgi_mesh mesh = gi_test_mesh(&bench.t, &unit);
    const sdfgi_material material =
        gi_test_material(&bench.t, (float[3]){ 0.5f, 0.5f, 0.5f }, (float[3]){ 0 });
    struct sdfgi_instance_desc *descs = test_array_alloc(bench.field.count, sizeof *descs);
    sdfgi_instance *handles = test_array_alloc(bench.field.count, sizeof *handles);
    for (uint32_t i = 0; i < bench.field.count; i++)
        descs[i] =
            (struct sdfgi_instance_desc){ mesh, material, box_field_place(&bench.field, i), SDFGI_STATIC };
    const double begin = thread_ms();
    REQUIRE_CMP(sdfgi_instances_create(bench.t.gi, bench.field.count, descs, handles), ==, SDFGI_OK);
    printf("%-34s %.1f ms\n", "creating them", thread_ms() - begin);
    test_mesh_destroy(&unit);
    free(descs);
    free(handles);
}

static void add_mesh(void)
{
    struct test_mesh mesh = box_field_mesh(&bench.field);
    gi_test_add(&bench.t, &mesh, gi_test_material(&bench.t, (float[3]){ 0.5f, 0.5f, 0.5f }, (float[3]){ 0 }));
    test_mesh_destroy(&mesh);
}

/* GPU time of voxelisation that arrived with the last update. */
static double voxelize_ms(void)
{
    static struct sdfgi_report report;
    sdfgi_get_report(bench.t.gi, &report);
    const struct sdfgi_pass_report *pass = &report.passes[PASS_VOXELIZE];
    return pass->gpu_ns_valid ? (double)pass->gpu_ns * 1e-6 : 0;
}

/* The first starts on an idle H200 take 4.5 ms instead of 1: its clocks rise within a second. */
static void warm_up(void)
{
    for (int i = 0; i < WARM_UP_STARTS; i++) {
        sdfgi_reset(bench.t.gi);
        update();
    }
}

static void time_start(int which, const char *what)
{
    double cpu[RESTARTS], gpu[RESTARTS];
    for (int i = 0; i < RESTARTS; i++) {
        sdfgi_reset(bench.t.gi);
        update();
        cpu[i] = bench.update_ms;
        gpu[i] = 0;
        for (int k = 0; k < 3; k++) {
            update();
            gpu[i] += voxelize_ms();
        }
    }
    char text[64];
    snprintf(text, sizeof text, "%s: first frame, CPU", what);
    print_times(text, cpu, RESTARTS);
    snprintf(text, sizeof text, "%s: first frame, voxelize", what);
    print_times(text, gpu, RESTARTS);
    bench.voxelize_ms[which][0] = gpu[RESTARTS / 2];
}

static void time_settled(const char *what)
{
    static struct sdfgi_report report;
    double *ms = calloc(bench.frames, sizeof *ms);
    for (int i = 0; i < SETTLE_MOST && !report.converged; i++) {
        update();
        sdfgi_get_report(bench.t.gi, &report);
    }
    printf("%s: %s\n", what, report.converged ? "settled" : "not settled");
    for (uint32_t i = 0; i < bench.frames; i++) {
        update();
        ms[i] = bench.update_ms;
    }
    char text[64];
    snprintf(text, sizeof text, "%s: settled, CPU", what);
    print_times(text, ms, bench.frames);
    free(ms);
}

/* At 5 m/s and 60 frames a second. */
static void time_walk(int which, const char *what)
{
    double *cpu = calloc(bench.frames, sizeof *cpu), gpu = 0;
    for (uint32_t i = 0; i < bench.frames; i++) {
        bench.t.frame.camera_position[0] += 5.0 / 60;
        update();
        cpu[i] = bench.update_ms;
        gpu += voxelize_ms();
    }
    char text[64];
    snprintf(text, sizeof text, "%s: walking, CPU", what);
    print_times(text, cpu, bench.frames);
    printf("%s: walking, voxelize              %.3f ms in all\n", what, gpu);
    bench.voxelize_ms[which][1] = gpu;
    free(cpu);
}

int main(int argc, char **argv)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    bench.field.count = argc > 1 ? (uint32_t)atoi(argv[1]) : 100000;
    bench.resolution = argc > 2 ? (uint32_t)atoi(argv[2]) : 128;
    bench.frames = argc > 3 ? (uint32_t)atoi(argv[3]) : 600;
    bench.field.spacing_m = argc > 4 ? atof(argv[4]) : 1;
    setvbuf(stdout, NULL, _IOLBF, 0);
    open_device();
    open_context();
    printf("%u boxes, %u^3 cells, on %s\n", bench.field.count, bench.resolution,
           bench.t.gpu.properties.deviceName);
    add_instances();
    warm_up();
    time_start(0, "instances");
    time_settled("instances");
    time_walk(0, "instances");
    open_context();
    add_mesh();
    time_start(1, "one mesh");
    time_walk(1, "one mesh");
    printf("voxelize, instances over one mesh: first frame %.2f, walking %.2f\n",
           bench.voxelize_ms[0][0] / bench.voxelize_ms[1][0],
           bench.voxelize_ms[0][1] / bench.voxelize_ms[1][1]);
    gi_test_close(&bench.t);
    return 0;
}
