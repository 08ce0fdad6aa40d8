/* SPDX-License-Identifier: MIT */
#include "gi_test.h"

#include "require.h"
#include "shared_pipelines.h"
#include "test_memory.h"

#include <sdfgi/inspect.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void log_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    struct gi_test *t = user;
    t->messages[id]++;
    snprintf(t->last_message, sizeof t->last_message, "%s", text);
    if (level == SDFGI_LOG_ERROR && !t->gpu.messages->quiet)
        fprintf(stderr, "sdfgi: %s\n", text);
}

/* ---- Devices, which stay for the next context */

enum { PARKED_MOST = 2 };

static struct gpu_test parked[PARKED_MOST];
static uint32_t parked_count;

/* At the end of the program. What the validation layer says then, of objects that are left, fails it. */
static void destroy_parked(void)
{
    bool silent = true;
    while (parked_count) {
        struct gpu_test *gpu = &parked[--parked_count];
        shared_pipelines_destroy(gpu->device);
        const struct gpu_test_messages messages = gpu_test_destroy(gpu);
        silent = silent && !messages.errors && !messages.warnings;
    }
    fflush(NULL);
    if (!silent)
        _exit(1);
}

static void take_device(struct gpu_test *gpu)
{
    if (parked_count)
        *gpu = parked[--parked_count];
    else
        gpu_test_open(gpu, sdfgi_get_requirements);
}

static void park_device(struct gpu_test *gpu)
{
    static bool registered;
    if (parked_count == PARKED_MOST) {
        shared_pipelines_destroy(gpu->device);
        gpu_test_close(gpu);
        return;
    }
    if (!registered)
        atexit(destroy_parked);
    registered = true;
    gpu->messages->quiet = false;
    parked[parked_count++] = *gpu;
    gpu_test_require_silence(gpu);
}

/* ---- Contexts */

struct sdfgi_settings gi_test_settings(void)
{
    struct sdfgi_settings s;
    sdfgi_settings_default(&s);
    s.enabled = true;
    s.cascades = 1;
    s.resolution = 64;
    s.min_cell_size_m = 0.25f;
    s.surface_light = SDFGI_SURFACE_LIGHT_PROBES;
    return s;
}

struct sdfgi_desc gi_test_desc(struct gi_test *t, const struct sdfgi_settings *settings)
{
    return (struct sdfgi_desc){
        .vulkan = { t->gpu.instance, t->gpu.physical_device, t->gpu.device, t->gpu.queue_family_index,
                    vkGetInstanceProcAddr, NULL },
        .frames_in_flight = 2,
        .settings = settings,
        .log = { log_message, t },
        .up_axis = t->up_axis,
        .left_handed = t->left_handed,
    };
}

static void create(struct gi_test *t, const struct sdfgi_settings *settings)
{
    struct sdfgi_desc desc = gi_test_desc(t, settings);
    desc.vulkan.get_instance_proc_addr = shared_pipelines_loader();
    REQUIRE_CMP(sdfgi_create(&desc, &t->gi), ==, SDFGI_OK);
}

static void destroy_buffers(struct gi_test *t)
{
    for (uint32_t i = 0; i < t->buffer_count; i++)
        gpu_test_buffer_destroy(&t->gpu, &t->buffers[i]);
    t->buffer_count = 0;
}

void gi_test_destroy(struct gi_test *t)
{
    sdfgi_destroy(t->gi);
    t->gi = NULL;
    destroy_buffers(t);
}

void gi_test_open_device(struct gi_test *t)
{
    memset(t, 0, sizeof *t);
    take_device(&t->gpu);
}

void gi_test_open(struct gi_test *t, const struct sdfgi_settings *settings)
{
    gi_test_open_device(t);
    create(t, settings);
}

void gi_test_restart(struct gi_test *t, const struct sdfgi_settings *settings)
{
    gi_test_destroy(t);
    memset(&t->frame, 0, sizeof t->frame);
    memset(t->messages, 0, sizeof t->messages);
    create(t, settings);
}

void gi_test_close(struct gi_test *t)
{
    gi_test_destroy(t);
    park_device(&t->gpu);
}

static void empty_scene(sdfgi *gi)
{
    const struct sdfgi_sky black = { { 0 }, { 0 }, { 0 } };
    const struct scene *scene = &gi->scene;
    for (uint32_t i = 0; i < scene->lights.end; i++)
        if (sdfgi_pool_at(&scene->lights, i))
            sdfgi_light_destroy(gi, (sdfgi_light){ sdfgi_pool_id(&scene->lights, i) });
    for (uint32_t i = 0; i < scene->meshes.end; i++)
        if (sdfgi_pool_at(&scene->meshes, i))
            sdfgi_mesh_destroy(gi, (sdfgi_mesh){ sdfgi_pool_id(&scene->meshes, i) });
    for (uint32_t i = 0; i < scene->materials.end; i++)
        if (sdfgi_pool_at(&scene->materials, i))
            sdfgi_material_destroy(gi, (sdfgi_material){ sdfgi_pool_id(&scene->materials, i) });
    REQUIRE_CMP(sdfgi_set_sky(gi, &black), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_set_sky_harmonics(gi, &(struct sdfgi_sky_harmonics){ .intensity = 1 }), ==, SDFGI_OK);
}

static void switch_off(struct gi_test *t)
{
    struct sdfgi_settings off;
    sdfgi_get_settings(t->gi, &off);
    off.enabled = false;
    REQUIRE_CMP(sdfgi_set_settings(t->gi, &off), ==, SDFGI_OK);
    gi_test_update(t, 4); /* until no frame in flight uses what is to be destroyed */
}

void gi_test_renew(struct gi_test *t, const struct sdfgi_settings *settings)
{
    if (!t->gi) {
        gi_test_open(t, settings);
        return;
    }
    empty_scene(t->gi);
    switch_off(t);
    destroy_buffers(t);
    memset(&t->frame, 0, sizeof t->frame);
    memset(t->messages, 0, sizeof t->messages);
    REQUIRE_CMP(sdfgi_set_settings(t->gi, settings), ==, SDFGI_OK);
}

sdfgi_mesh gi_test_mesh(struct gi_test *t, const struct test_mesh *mesh)
{
    return gi_test_mesh_within(t, mesh, mesh);
}

sdfgi_mesh gi_test_mesh_within(struct gi_test *t, const struct test_mesh *mesh,
                               const struct test_mesh *bounded)
{
    REQUIRE_CMP(t->buffer_count, <, 2 * GI_TEST_MAX_MESHES);
    const struct gpu_test_buffer positions = gpu_test_buffer_device(
        &t->gpu, 12 * (VkDeviceSize)mesh->vertex_count, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, mesh->positions);
    const struct gpu_test_buffer indices = gpu_test_buffer_device(
        &t->gpu, 12 * (VkDeviceSize)mesh->triangle_count, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, mesh->indices);
    t->buffers[t->buffer_count++] = positions;
    t->buffers[t->buffer_count++] = indices;
    struct sdfgi_mesh_desc desc = { .position_buffer = positions.buffer,
                                    .index_buffer = indices.buffer,
                                    .index_type = VK_INDEX_TYPE_UINT32,
                                    .vertex_count = mesh->vertex_count,
                                    .triangle_count = mesh->triangle_count };
    test_mesh_bounds(bounded, desc.bounds_min, desc.bounds_max);
    sdfgi_mesh handle;
    REQUIRE_CMP(sdfgi_mesh_create(t->gi, &desc, &handle), ==, SDFGI_OK);
    return handle;
}

sdfgi_material gi_test_material(struct gi_test *t, const float albedo[static 3],
                                const float emission[static 3])
{
    struct sdfgi_material_desc desc = { .alpha = 1, .double_sided_emission = true };
    memcpy(desc.albedo, albedo, sizeof desc.albedo);
    memcpy(desc.emission, emission, sizeof desc.emission);
    sdfgi_material handle;
    REQUIRE_CMP(sdfgi_material_create(t->gi, &desc, &handle), ==, SDFGI_OK);
    return handle;
}

sdfgi_instance gi_test_add(struct gi_test *t, const struct test_mesh *mesh, sdfgi_material material)
{
    const struct sdfgi_instance_desc desc = { .mesh = gi_test_mesh(t, mesh),
                                              .material = material,
                                              .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } } };
    sdfgi_instance handle;
    REQUIRE_CMP(sdfgi_instance_create(t->gi, &desc, &handle), ==, SDFGI_OK);
    return handle;
}

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    struct gi_test *t = user;
    REQUIRE_CMP(sdfgi_update(t->gi, cmd, &t->frame), ==, SDFGI_OK);
}

void gi_test_update(struct gi_test *t, uint32_t count)
{
    for (uint32_t done = 0; done < count; done += 2)
        gpu_test_submit_many(&t->gpu, count - done < 2 ? count - done : 2, record_update, t);
}

uint32_t gi_test_converge(struct gi_test *t, uint32_t limit)
{
    static struct sdfgi_report report;
    for (uint32_t frames = 0; frames < limit; frames += 2) {
        gi_test_update(t, 2);
        sdfgi_get_report(t->gi, &report);
        if (report.converged)
            return frames + 2;
    }
    require_fail(__FILE__, __LINE__, "not converged after %u frames: change %g", limit,
                 (double)t->gi->volume.state.accumulation.known_change);
    return limit;
}

void *gi_test_read(struct gi_test *t, enum resource resource, uint64_t *size)
{
    const struct gpu_buffer *buffer = &t->gi->volume.resources->buffers[resource];
    uint8_t *data = test_array_alloc(buffer->size, 1);
    gpu_test_buffer_read(&t->gpu, buffer->handle, 0, buffer->size, data);
    if (size)
        *size = buffer->size;
    return data;
}

uint64_t gi_test_ordered_bytes(const struct gi_test *t, enum resource resource)
{
    const struct resources *r = t->gi->volume.resources;
    const uint64_t marks =
        4ull * sdfgi_seen_records((uint32_t)r->extent.light_cells, (uint32_t)r->extent.cascades);
    if (sdfgi_resource_row(resource)->keep == RESOURCE_KEEP_SCRATCH)
        return 0;
    return resource == RESOURCE_SEEN && marks < r->buffers[resource].size ? marks : r->buffers[resource].size;
}

uint64_t gi_test_hash(const void *bytes, uint64_t size)
{
    uint64_t hash = UINT64_C(1469598103934665603);
    for (uint64_t i = 0; i < size; i++)
        hash = (hash ^ ((const uint8_t *)bytes)[i]) * UINT64_C(1099511628211);
    return hash;
}

uint32_t gi_test_cell(const struct gi_test *t, uint32_t cascade, uint32_t x, uint32_t y, uint32_t z)
{
    const ivec3 wrap = t->gi->volume.state.params.cascades[cascade].wrap;
    const uint32_t n = t->gi->settings.resolution, mask = n - 1;
    return ((x + (uint32_t)wrap.x) & mask) +
           n * (((y + (uint32_t)wrap.y) & mask) + n * (((z + (uint32_t)wrap.z) & mask) + n * cascade));
}

struct gi_test_direct gi_test_direct_at(const uint32_t *copy, uint64_t room, uint32_t cascade, uint64_t entry)
{
    const uint32_t *words = copy + SDFGI_DIRECT_WORDS * cascade * room + entry;
    return (struct gi_test_direct){ words[0], words[room], words[2 * room] & SDFGI_LIGHT_ALL };
}

uint32_t gi_test_light_entry(struct gi_test *t, uint32_t cascade, const uint32_t cell[static 3])
{
    const uint32_t n = t->gi->settings.resolution, side = n / 4,
                   texel = gi_test_cell(t, cascade, cell[0], cell[1], cell[2]) % (n * n * n);
    const uint32_t x = texel % n, y = texel / n % n, z = texel / n / n;
    uint32_t(*halves)[2] = gi_test_read(t, RESOURCE_LIGHT_BLOCKS, NULL);
    const uint32_t block = x / 4 + side * (y / 4 + side * (z / 4 + side * cascade));
    const uint32_t *half = halves[2 * block + z / 2 % 2], bit = x % 4 + 4 * (y % 4) + 16 * (z % 2);
    REQUIRE_TRUE(half[0] >> bit & 1);
    const uint32_t entry = half[1] + (uint32_t)__builtin_popcount(half[0] & ((1u << bit) - 1));
    free(halves);
    return cascade * (uint32_t)t->gi->volume.resources->extent.light_cells + entry;
}

float gi_test_half(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const float value =
        exponent ? ldexpf((float)(mantissa + 1024), exponent - 25) : ldexpf((float)mantissa, -24);
    return half & 0x8000 ? -value : value;
}

uint64_t *gi_test_subvoxels(struct gi_test *t)
{
    uint64_t size;
    uint64_t *cells = gi_test_read(t, RESOURCE_BITS, &size);
    for (uint64_t i = 0; i < size / sizeof *cells; i++) {
        const uint32_t words[2] = { (uint32_t)cells[i], (uint32_t)(cells[i] >> 32) };
        cells[i] = sdfgi_inspect_bits(words);
    }
    return cells;
}

struct oracle_bits gi_test_bits(struct gi_test *t, uint32_t cascade)
{
    const uint32_t n = t->gi->settings.resolution;
    uint64_t *cells = gi_test_subvoxels(t);
    struct oracle_bits bits = oracle_bits_create(4 * n);
    for (uint32_t z = 0; z < n; z++)
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++)
                for (uint64_t rest = cells[gi_test_cell(t, cascade, x, y, z)]; rest; rest &= rest - 1) {
                    const uint32_t bit = (uint32_t)__builtin_ctzll(rest);
                    oracle_bits_set(&bits, 4 * x + (bit & 3), 4 * y + (bit >> 2 & 3), 4 * z + (bit >> 4));
                }
    free(cells);
    return bits;
}

struct oracle_grid gi_test_grid(const struct gi_test *t, uint32_t cascade)
{
    struct oracle_grid grid;
    const struct cascade *c = &t->gi->volume.state.cascades.at[cascade];
    for (int i = 0; i < 3; i++) {
        grid.origin[i] = (double)c->origin[i] * c->cell_size[i];
        grid.step[i] = c->cell_size[i] / 4;
    }
    return grid;
}

float *gi_test_distances(struct gi_test *t, uint32_t cascade)
{
    const uint32_t n = t->gi->settings.resolution;
    uint16_t *stored = gi_test_read(t, RESOURCE_DISTANCE, NULL);
    float *distances = test_array_alloc((size_t)n * n * n, sizeof *distances);
    for (uint32_t z = 0, i = 0; z < n; z++)
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++, i++)
                distances[i] = (float)stored[gi_test_cell(t, cascade, x, y, z)] / (32768.0f / (float)n);
    free(stored);
    return distances;
}
