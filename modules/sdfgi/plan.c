/* SPDX-License-Identifier: MIT
 * What a frame calls for. Each need has one row: a condition on the situation, why it runs, why it is
 * skipped. */
#include "internal.h"

struct need_row {
    bool (*holds)(const struct situation *s);
    const char *why;     /* it runs */
    const char *why_not; /* it is skipped although GI is enabled */
};

static bool needs_voxels(const struct situation *s)
{
    return s->generates && s->has_geometry && !s->raster;
}

static bool needs_voxels_raster(const struct situation *s)
{
    return s->generates && s->has_geometry && s->raster;
}

static bool needs_generate(const struct situation *s)
{
    return s->generates;
}

static bool needs_complete(const struct situation *s)
{
    return s->completes;
}

static bool needs_seed(const struct situation *s)
{
    return s->completes && !s->fresh;
}

static bool needs_list(const struct situation *s)
{
    return s->completes || s->list_grew;
}

static bool needs_exact(const struct situation *s)
{
    return s->measures && !s->flood;
}

static bool needs_flood(const struct situation *s)
{
    return s->measures && s->flood;
}

static bool needs_occlusion(const struct situation *s)
{
    return s->completes && s->occlusion;
}

static bool needs_masks(const struct situation *s)
{
    return needs_list(s) && s->masks;
}

static bool needs_direct(const struct situation *s)
{
    return ((s->relights || needs_list(s)) && s->has_lights) || s->lights_changed;
}

static bool needs_trace(const struct situation *s)
{
    return !s->converged && !s->light_waits;
}

static bool needs_rays(const struct situation *s)
{
    return needs_trace(s) && s->rays_missing;
}

static bool needs_blend(const struct situation *s)
{
    return !s->converged && s->publish && !s->light_waits;
}

static bool needs_light(const struct situation *s)
{
    return needs_blend(s) || (!s->converged && (needs_list(s) || s->lights_changed));
}

static bool needs_gather(const struct situation *s)
{
    return s->gathers;
}

static const struct need_row needs[NEED_COUNT] = {
    [NEED_VOXELS] = { needs_voxels, "geometry in a cascade is new", "no geometry in a cascade changed" },
    [NEED_VOXELS_RASTER] = { needs_voxels_raster, "geometry in a cascade is new",
                             "sdfgi_voxelizer is compute, or no geometry in a cascade changed" },
    [NEED_GENERATE] = { needs_generate, "a cascade moved or its geometry changed",
                        "no cascade changed, or its voxels are due in another frame" },
    [NEED_COMPLETE] = { needs_complete, "the voxels and distances of a change are complete",
                        "no cascade changed, or its voxels and distances are not complete" },
    [NEED_SEED] = { needs_seed, "probes are new, or what they see is, beside others that stay",
                    "no change is complete, or nothing was there before" },
    [NEED_LIST] = { needs_list, "surfaces in a cascade changed, or the list of light cells grew",
                    "no change is complete, and the list of light cells has room" },
    [NEED_EXACT] = { needs_exact, "a change calls for distances and sdfgi_sdf_method is exact",
                     "sdfgi_sdf_method is flood, or no distances are due" },
    [NEED_FLOOD] = { needs_flood, "a change calls for distances and sdfgi_sdf_method is flood",
                     "sdfgi_sdf_method is exact, or no distances are due" },
    [NEED_OCCLUSION] = { needs_occlusion, "a cascade changed and sdfgi_visibility is probe_depth",
                         "sdfgi_visibility is not probe_depth, or no cascade changed" },
    [NEED_MASKS] = { needs_masks, "a cascade changed and lookups read cell masks",
                     "lookups read no cell masks, or no cascade changed" },
    [NEED_DIRECT] = { needs_direct, "lights or the surfaces they reach changed",
                      "no light and no surface changed" },
    [NEED_LIGHT] = { needs_light, "light has not settled", "light has settled, or is due in a later frame" },
    [NEED_TRACE] = { needs_trace, "light has not settled",
                     "light has settled, or waits for the frame after a step" },
    [NEED_RAYS] = { needs_rays, "rays of the ring are not remembered",
                    "all rays are remembered, or light has settled or waits" },
    [NEED_BLEND] = { needs_blend, "light has not settled", "light has settled, or is due in a later frame" },
    [NEED_GATHER] = { needs_gather, "the host called sdfgi_gather", "the host did not call sdfgi_gather" },
};

static const enum need pass_needs[PASS_COUNT] = {
#define ROW(id, file, unit, reads, writes, need) [PASS_##id] = NEED_##need,
    SDFGI_PASSES(ROW)
#undef ROW
};

void plan_make(const struct situation *situation, struct decision plan[PASS_COUNT])
{
    for (int i = 0; i < PASS_COUNT; i++) {
        const struct need_row *row = &needs[pass_needs[i]];
        if (!situation->enabled)
            plan[i] = (struct decision){ false, "GI is switched off" };
        else if (row->holds(situation))
            plan[i] = (struct decision){ true, row->why };
        else
            plan[i] = (struct decision){ false, row->why_not };
    }
}
