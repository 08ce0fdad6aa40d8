/* SPDX-License-Identifier: MIT */
#include "pass_scene.h"

#include "oracle_edt.h"
#include "require.h"
#include "test_memory.h"

#include <math.h>
#include <vulkan/vulkan.h>

#include <stdio.h>
#include <stdlib.h>

struct gi_test pass_context;

int pass_context_close(void **state)
{
    (void)state;
    if (pass_context.gi)
        gi_test_close(&pass_context);
    return 0;
}

static sdfgi_material grey_material(struct gi_test *t)
{
    const float grey[3] = { 0.5f, 0.5f, 0.5f }, black[3] = { 0, 0, 0 };
    return gi_test_material(t, grey, black);
}

void pass_scene_open(struct gi_test *t, const struct sdfgi_settings *settings, const struct test_mesh *mesh)
{
    gi_test_renew(t, settings);
    if (mesh)
        gi_test_add(t, mesh, grey_material(t));
    gi_test_update(t, 1);
}

sdfgi_instance pass_scene_place(struct gi_test *t, sdfgi_mesh mesh, const float basis[static 9],
                                const double translation[static 3])
{
    struct sdfgi_instance_desc desc = { .mesh = mesh, .material = grey_material(t) };
    memcpy(desc.transform.basis, basis, sizeof desc.transform.basis);
    memcpy(desc.transform.translation, translation, sizeof desc.transform.translation);
    sdfgi_instance handle;
    REQUIRE_CMP(sdfgi_instance_create(t->gi, &desc, &handle), ==, SDFGI_OK);
    return handle;
}

void pass_scene_stand(struct gi_test *t, const double position[static 3])
{
    memcpy(t->frame.camera_position, position, sizeof t->frame.camera_position);
    memcpy(t->frame.origin, position, sizeof t->frame.origin);
}

struct pass_volumes pass_volumes_read(struct gi_test *t)
{
    struct pass_volumes v;
    v.bits = gi_test_read(t, RESOURCE_BITS, &v.bits_size);
    v.albedo = gi_test_read(t, RESOURCE_ALBEDO, &v.albedo_size);
    v.normals = gi_test_read(t, RESOURCE_NORMALS, &v.normals_size);
    v.distance = gi_test_read(t, RESOURCE_DISTANCE, &v.distance_size);
    return v;
}

void pass_volumes_destroy(struct pass_volumes *volumes)
{
    free(volumes->bits);
    free(volumes->albedo);
    free(volumes->normals);
    free(volumes->distance);
}

static uint64_t bytes_that_differ(const char *name, const uint8_t *a, const uint8_t *b, uint64_t size)
{
    uint64_t count = 0, first = 0;
    for (uint64_t i = size; i-- > 0;)
        if (a[i] != b[i]) {
            count++;
            first = i;
        }
    if (count)
        printf("%s: %llu bytes differ, the first at %llu\n", name, (unsigned long long)count,
               (unsigned long long)first);
    return count;
}

uint64_t pass_volumes_differ(const struct pass_volumes *a, const struct pass_volumes *b)
{
    REQUIRE_CMP(a->bits_size, ==, b->bits_size);
    return bytes_that_differ("bits", a->bits, b->bits, a->bits_size) +
           bytes_that_differ("albedo", a->albedo, b->albedo, a->albedo_size) +
           bytes_that_differ("normals", a->normals, b->normals, a->normals_size) +
           bytes_that_differ("distances", a->distance, b->distance, a->distance_size);
}

void pass_volumes_require_equal(const struct pass_volumes *a, const struct pass_volumes *b)
{
    REQUIRE_CMP(pass_volumes_differ(a, b), ==, 0ul);
}

struct pass_distance_error pass_distance_error(struct gi_test *t, double y_scale)
{
    struct oracle_bits bits = gi_test_bits(t, 0);
    float *exact = oracle_edt_cells(&bits, y_scale), *stored = gi_test_distances(t, 0);
    const uint32_t n = t->gi->settings.resolution, cells = n * n * n;
    struct pass_distance_error e = { -INFINITY, 0, INFINITY };
    for (uint32_t i = 0; i < cells; i++) {
        const double over = (double)stored[i] - fmin((double)exact[i], SDFGI_DISTANCE_REACH);
        e.max = fmax(e.max, over);
        e.min = fmin(e.min, over);
        e.mean += over / cells;
    }
    free(exact);
    free(stored);
    oracle_bits_destroy(&bits);
    return e;
}

struct recording {
    struct sdfgi *gi;
    const struct work_list *list;
};

static void record_list(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct recording *recording = user;
    struct sdfgi *gi = recording->gi;
    static struct pass_recorder recorder;
    sdfgi_pass_recorder_begin(&recorder, &gi->backend, gi->volume.resources, cmd,
                              sdfgi_pass_stamps(recording->list));
    gpu_timer_begin_frame(&gi->volume.resources->timer, 0);
    const struct work_list *list = recording->list;
    for (uint32_t i = 0; i < list->count;)
        i += sdfgi_pass_record_at_once(&recorder, &list->items[i], list->count - i);
    sdfgi_pass_recorder_end(&recorder);
}

void pass_scene_run(struct gi_test *t, const struct work_list *list)
{
    struct recording recording = { t->gi, list };
    gpu_test_submit(&t->gpu, record_list, &recording);
}

void pass_scene_write(struct gi_test *t, enum resource resource, const void *data, uint64_t size)
{
    gpu_test_buffer_write(&t->gpu, t->gi->volume.resources->buffers[resource].handle, 0, size, data);
}

void pass_scene_fill(struct gi_test *t, enum resource resource, uint8_t value)
{
    const uint64_t size = t->gi->volume.resources->buffers[resource].size;
    uint8_t *data = test_array_alloc(size, 1);
    memset(data, value, size);
    pass_scene_write(t, resource, data, size);
    free(data);
}

void pass_scene_forget_empty_space(struct gi_test *t)
{
    uint64_t *bits = gi_test_subvoxels(t);
    pass_scene_write(t, RESOURCE_BITS, bits, t->gi->volume.resources->buffers[RESOURCE_BITS].size);
    pass_scene_fill(t, RESOURCE_DISTANCE, 0);
    free(bits);
}

uint64_t pass_health_count(const struct gi_test *t, enum sdfgi_message code)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    for (uint32_t i = 0; i < report.health_count; i++)
        if (report.health[i].code == code)
            return report.health[i].count;
    return 0;
}

bool pass_raster_is_available(void)
{
    static struct gpu_test gpu;
    gpu_test_open(&gpu, sdfgi_get_requirements);
    struct sdfgi_requirements requirements;
    REQUIRE_CMP(
        sdfgi_get_requirements(gpu.instance, gpu.physical_device, vkGetInstanceProcAddr, &requirements), ==,
        SDFGI_OK);
    gpu_test_close(&gpu);
    return requirements.features.fragmentStoresAndAtomics;
}
