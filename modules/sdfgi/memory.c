/* SPDX-License-Identifier: MIT
 * How large everything is. Needs no device. */
#include "internal.h"

#include <string.h>

/* Light cells a list holds at first, in layers of n^2 cells: surfaces grow with the square of the resolution.
 * The sample world's village has 5.3. */
#define LIGHT_CELL_LAYERS 8

/* A list may grow to this share of all cells, or of 128^3 cells in smaller cascades: with the defaults a
 * cascade then takes just under 64 MiB, scratch included. */
#define LIGHT_CELL_SHARE (37.0 / 256)

double y_scale_factor(enum sdfgi_y_scale scale)
{
    static const double factors[] = {
        [SDFGI_Y_SCALE_50] = 0.5, [SDFGI_Y_SCALE_75] = 0.75, [SDFGI_Y_SCALE_100] = 1.0
    };
    return factors[scale];
}

uint32_t ring_samples(const struct sdfgi_settings *settings)
{
    const uint32_t rays = settings->ray_count * settings->frames_to_converge;
    return (rays + SDFGI_IRRADIANCE_COUNT - 1) / SDFGI_IRRADIANCE_COUNT * SDFGI_IRRADIANCE_COUNT;
}

uint32_t ring_frames(const struct sdfgi_settings *settings)
{
    return (ring_samples(settings) + settings->ray_count - 1) / settings->ray_count;
}

static uint64_t light_cells_max(uint64_t cells)
{
    const uint64_t least = 128 * 128 * 128;
    const uint64_t share = (uint64_t)(LIGHT_CELL_SHARE * (double)(cells > least ? cells : least));
    return share < cells ? share : cells;
}

static uint32_t log2_of(uint64_t power)
{
    uint32_t bits = 0;
    while (power >> (bits + 1))
        bits++;
    return bits;
}

/* Bytes that the largest tenant needs: shared/scratch.h. */
static uint64_t scratch_size(const struct extent *e, uint32_t rays_per_frame)
{
    const uint32_t bits = log2_of(e->cells) / 3;
    const uint64_t tenants[] = {
        sdfgi_scratch_accumulators_end(bits),
        sdfgi_scratch_distance_end(bits),
        sdfgi_scratch_flood_end(bits),
        sdfgi_scratch_light_end(bits, (uint32_t)e->light_cells_max),
        e->probes * e->cascades * rays_per_frame,
    };
    uint64_t most = 0;
    for (size_t i = 0; i < sizeof tenants / sizeof *tenants; i++)
        most = tenants[i] > most ? tenants[i] : most;
    return 4 * most;
}

struct extent extent_from_settings(const struct sdfgi_settings *settings)
{
    const uint64_t n = settings->resolution;
    const uint64_t side = n / SDFGI_PROBE_SPACING + 1;
    struct extent e = {
        .cells = n * n * n,
        .blocks = n * n * n / 8,
        .probes = side * side * side,
        .probes_per_side = side,
        .light_cells = LIGHT_CELL_LAYERS * n * n,
        .light_cells_max = light_cells_max(n * n * n),
        .cascades = settings->cascades,
        .ring_samples = ring_samples(settings),
        .occlusion = 4,
    };
    e.scratch = scratch_size(&e, settings->ray_count);
    if (settings->visibility == SDFGI_VISIBILITY_PROBE_DEPTH)
        e.occlusion = e.probes * e.cascades * SDFGI_OCCLUSION_STRIDE * SDFGI_OCCLUSION_STRIDE * 4;
    return e;
}

uint64_t resource_size(enum resource resource, const struct extent *s)
{
    switch (resource) {
#define SIZE(id, category, size, lifetime)                                                                   \
    case RESOURCE_##id:                                                                                      \
        return size;
        SDFGI_BUFFERS(SIZE)
#undef SIZE
    case RESOURCE_COUNT:
        break;
    }
    return 0;
}

static const struct {
    const char *name;
    enum sdfgi_memory_category category;
} rows[RESOURCE_COUNT] = {
#define ROW(id, category, size, lifetime) [RESOURCE_##id] = { "sdfgi " #id, SDFGI_MEMORY_##category },
    SDFGI_BUFFERS(ROW)
#undef ROW
};

const char *resource_name(enum resource resource)
{
    return rows[resource].name;
}

enum sdfgi_memory_category resource_category(enum resource resource)
{
    return rows[resource].category;
}

VkDescriptorType resource_descriptor(enum resource resource)
{
    return resource == RESOURCE_FRAME ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

uint64_t readback_size(uint32_t frames_in_flight)
{
    return (uint64_t)frames_in_flight * SDFGI_COUNTER_COUNT * sizeof(uint32_t);
}

const char *sdfgi_memory_category_name(enum sdfgi_memory_category category)
{
    static const char *const names[SDFGI_MEMORY_CATEGORY_COUNT] = {
        [SDFGI_MEMORY_VOLUMES] = "volumes",   [SDFGI_MEMORY_PROBES] = "probes",
        [SDFGI_MEMORY_SCRATCH] = "scratch",   [SDFGI_MEMORY_LISTS] = "lists",
        [SDFGI_MEMORY_READBACK] = "readback",
    };
    return (unsigned)category < SDFGI_MEMORY_CATEGORY_COUNT ? names[category] : "";
}

enum sdfgi_result sdfgi_estimate_memory(const struct sdfgi_settings *settings, uint32_t frames_in_flight,
                                        struct sdfgi_memory *memory)
{
    struct sdfgi_settings resolved;
    sdfgi_settings_default(&resolved);
    if (settings)
        resolved = *settings;
    if (!sdfgi_settings_validate(&resolved, NULL, 0) || frames_in_flight > SDFGI_MAX_FRAMES_IN_FLIGHT)
        return SDFGI_ERROR_INVALID_ARGUMENT;
    const struct extent extent = extent_from_settings(&resolved);
    memset(memory, 0, sizeof *memory);
    for (int i = 0; i < RESOURCE_COUNT; i++)
        memory->bytes[resource_category((enum resource)i)] += resource_size((enum resource)i, &extent);
    memory->bytes[SDFGI_MEMORY_READBACK] = readback_size(frames_in_flight ? frames_in_flight : 2);
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        memory->total_bytes += memory->bytes[i];
    return SDFGI_OK;
}
