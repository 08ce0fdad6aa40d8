/* SPDX-License-Identifier: MIT */
#include "extent.h"

#include "shaders/shared/constants.h"
#include "shaders/shared/scratch.h"

/* Light cells that a list has room for at first, in quarters of a layer of n^2 cells: surfaces grow with the
 * square of the resolution. The sample world's village has 5.3 layers. */
#define LIGHT_CELL_QUARTER_LAYERS 23

/* A list may grow to this share of all cells, or of 128^3 cells in smaller cascades. With the defaults a
 * cascade takes just under 64 MiB, scratch included, and just under 100 MiB with the longest list. */
#define LIGHT_CELL_SHARE (60.0 / 512)

double sdfgi_settings_y_scale(const struct sdfgi_settings *settings)
{
    static const double factors[] = {
        [SDFGI_Y_SCALE_50] = 0.5, [SDFGI_Y_SCALE_75] = 0.75, [SDFGI_Y_SCALE_100] = 1.0
    };
    return factors[settings->y_scale];
}

uint32_t sdfgi_settings_cycle_samples(const struct sdfgi_settings *settings)
{
    const uint32_t rays = settings->ray_count * settings->frames_to_converge;
    return (rays + SDFGI_IRRADIANCE_COUNT - 1) / SDFGI_IRRADIANCE_COUNT * SDFGI_IRRADIANCE_COUNT;
}

uint32_t sdfgi_settings_cycle_frames(const struct sdfgi_settings *settings)
{
    return (sdfgi_settings_cycle_samples(settings) + settings->ray_count - 1) / settings->ray_count;
}

uint32_t sdfgi_settings_cycle_visits(const struct sdfgi_settings *settings)
{
    const bool gathers = settings->surface_light == SDFGI_SURFACE_LIGHT_CELLS;
    return gathers ? (settings->cell_rays + SDFGI_VISIT_RAYS - 1) / SDFGI_VISIT_RAYS : 0;
}

uint32_t sdfgi_settings_shader_visibility(const struct sdfgi_settings *settings)
{
    static const uint32_t methods[] = {
        [SDFGI_VISIBILITY_CELL_MASK] = SDFGI_SHADER_VISIBILITY_CELL_MASK,
        [SDFGI_VISIBILITY_PROBE_DEPTH] = SDFGI_SHADER_VISIBILITY_PROBE_DEPTH,
    };
    return settings->use_occlusion ? methods[settings->visibility] : SDFGI_SHADER_VISIBILITY_NONE;
}

uint32_t sdfgi_log2(uint64_t power)
{
    uint32_t bits = 0;
    while (power >> (bits + 1))
        bits++;
    return bits;
}

static uint64_t light_cells_max(uint64_t cells)
{
    const uint64_t least = 128 * 128 * 128;
    const uint64_t share = (uint64_t)(LIGHT_CELL_SHARE * (double)(cells > least ? cells : least));
    return share < cells ? share : cells;
}

/* Bytes that the largest tenant of the scratch buffer needs: shared/scratch.h. */
static uint64_t scratch_size(const struct extent *e)
{
    const uint32_t bits = sdfgi_log2(e->cells) / 3;
    const uint64_t tenants[] = {
        sdfgi_scratch_part_words(sdfgi_scratch_part_cells(bits), e->emits),
        sdfgi_scratch_distance_end(bits),
        sdfgi_scratch_flood_end(bits),
        sdfgi_scratch_cubes_end(bits),
        sdfgi_scratch_light_end(bits, (uint32_t)e->light_cells, e->low_light),
        e->probes * e->cascades * sdfgi_extent_probe_rays(e),
    };
    uint64_t most = 0;
    for (size_t i = 0; i < sizeof tenants / sizeof *tenants; i++)
        most = tenants[i] > most ? tenants[i] : most;
    return 4 * most;
}

void sdfgi_extent_set_light_cells(struct extent *extent, uint64_t light_cells)
{
    extent->light_cells = light_cells;
    extent->scratch = scratch_size(extent);
}

void sdfgi_extent_set_emits(struct extent *extent)
{
    extent->emits = true;
    extent->scratch = scratch_size(extent);
}

void sdfgi_extent_set_low_light(struct extent *extent)
{
    extent->low_light = extent->gathers;
    extent->scratch = scratch_size(extent);
}

uint64_t sdfgi_extent_emitter_samples(const struct extent *extent)
{
    return extent->emits ? extent->cycle_samples / SDFGI_SAMPLES_PER_EMITTER_SAMPLE : 0;
}

uint64_t sdfgi_extent_probe_words(const struct extent *extent)
{
    return extent->cycle_samples + SDFGI_EMITTER_SAMPLE_WORDS * sdfgi_extent_emitter_samples(extent);
}

uint64_t sdfgi_extent_probe_rays(const struct extent *extent)
{
    const uint64_t rays = extent->rays_per_frame;
    return rays + (extent->emits ? rays / SDFGI_SAMPLES_PER_EMITTER_SAMPLE + 2 : 0);
}

uint32_t sdfgi_extent_visit_rays(const struct extent *extent)
{
    return SDFGI_VISIT_RAYS + (extent->emits ? SDFGI_VISIT_EMITTER_RAYS : 0);
}

struct extent sdfgi_extent_from_settings(const struct sdfgi_settings *settings)
{
    const uint64_t n = settings->resolution, side = n / SDFGI_PROBE_SPACING + 1;
    struct extent e = {
        .cells = n * n * n,
        .blocks = n * n * n / 8,
        .probes = side * side * side,
        .probes_per_side = side,
        .light_cells_max = light_cells_max(n * n * n),
        .cascades = settings->cascades,
        .cycle_samples = sdfgi_settings_cycle_samples(settings),
        .rays_per_frame = settings->ray_count,
        .search = sdfgi_search_end(sdfgi_log2(n)),
        .occlusion = 1,
        .instances = SDFGI_FIRST_INSTANCES,
        .gathers = sdfgi_settings_cycle_visits(settings) > 0,
    };
    sdfgi_extent_set_light_cells(&e, LIGHT_CELL_QUARTER_LAYERS * n * n / 4);
    if (settings->visibility == SDFGI_VISIBILITY_PROBE_DEPTH)
        e.occlusion = e.probes * e.cascades * SDFGI_OCCLUSION_STRIDE * SDFGI_OCCLUSION_STRIDE;
    return e;
}
