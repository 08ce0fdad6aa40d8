/* SPDX-License-Identifier: MIT */
#include "frame_needs.h"

struct need_row {
    bool (*holds)(const struct situation *s);
    const char *why;     /* it runs */
    const char *why_not; /* it does not: true whatever keeps it from running */
};

static bool needs_voxels(const struct situation *s)
{
    return s->geometry_due && !s->raster;
}

static bool needs_voxels_raster(const struct situation *s)
{
    return s->geometry_due && s->raster;
}

static bool needs_generate(const struct situation *s)
{
    return s->voxels_due;
}

static bool needs_complete(const struct situation *s)
{
    return s->completes;
}

static bool needs_seed(const struct situation *s)
{
    return s->completes && !s->from_nothing;
}

static bool needs_list(const struct situation *s)
{
    return s->completes || s->list_grew;
}

static bool needs_emitters(const struct situation *s)
{
    return s->completes && s->lists_emitters;
}

static bool needs_exact(const struct situation *s)
{
    return s->distances_due && !s->flood;
}

static bool needs_flood(const struct situation *s)
{
    return s->distances_due && s->flood;
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
    return !s->converged && s->shows && !s->light_waits;
}

/* What arrives at cells that stay changes: with their own rays, or with the probes. */
static bool needs_arriving(const struct situation *s)
{
    return !s->converged && (s->gathering ? s->gathers : needs_blend(s));
}

static bool needs_light(const struct situation *s)
{
    const bool lists = needs_list(s), lights = s->lights_changed && s->lists_stay;
    return needs_arriving(s) || (!s->converged && (lists || lights));
}

static bool needs_rescale(const struct situation *s)
{
    return s->rescales;
}

/* Pictures are not planned with the frame: the host asks for them afterwards. */
static bool needs_picture(const struct situation *s)
{
    (void)s;
    return false;
}

static bool needs_cells(const struct situation *s)
{
    return s->gathers;
}

static bool needs_filter(const struct situation *s)
{
    return s->cells && needs_arriving(s);
}

static const struct need_row needs[NEED_COUNT] = {
    [NEED_VOXELS] = { needs_voxels, "geometry lies in cells that are voxelised",
                      "no geometry lies in cells that are voxelised in this frame, or sdfgi_voxelizer is "
                      "raster" },
    [NEED_VOXELS_RASTER] = { needs_voxels_raster, "geometry lies in cells that are voxelised",
                             "sdfgi_voxelizer is compute, or no geometry lies in cells that are voxelised" },
    [NEED_GENERATE] = { needs_generate, "voxels of a change are due",
                        "no cascade changed, or its voxels are due in another frame" },
    [NEED_COMPLETE] = { needs_complete, "a change completes: its voxels and distances are there",
                        "no change of a cascade completes in this frame" },
    [NEED_SEED] = { needs_seed, "a change completes beside probes and rays that stay",
                    "no change completes in this frame, or nothing of before is left" },
    [NEED_LIST] = { needs_list, "surfaces in a cascade changed, or the light list grew",
                    "no change completes in this frame, and the light list did not grow" },
    [NEED_EMITTERS] = { needs_emitters, "surfaces in a cascade changed, and a material emits",
                        "no material emits, or no change completes in this frame" },
    [NEED_EXACT] = { needs_exact, "a change calls for distances and sdfgi_sdf_method is exact",
                     "sdfgi_sdf_method is flood, or no distances are due" },
    [NEED_FLOOD] = { needs_flood, "a change calls for distances and sdfgi_sdf_method is flood",
                     "sdfgi_sdf_method is exact, or no distances are due" },
    [NEED_OCCLUSION] = { needs_occlusion, "a change completes, and lookups read depths around probes",
                         "lookups read no depths around probes, or no change completes in this frame" },
    [NEED_MASKS] = { needs_masks, "light cells are listed, and their visibility bits are read",
                     "no visibility bits are read, or no light cells are listed in this frame" },
    [NEED_DIRECT] = { needs_direct, "lights, their exposure or the surfaces that they reach changed",
                      "no light and no surface changed, there is no light, or cells wait for a later frame" },
    [NEED_LIGHT] = { needs_light, "light has not converged",
                     "light has converged, or no cell has new light in this frame" },
    [NEED_TRACE] = { needs_trace, "light has not converged",
                     "light has converged, or waits for the frame after a scroll" },
    [NEED_RAYS] = { needs_rays, "rays of the sample cycle are not cached",
                    "all rays are cached, or light has converged or waits" },
    [NEED_BLEND] = { needs_blend, "light has not converged",
                     "light has converged, or is due in a later frame" },
    [NEED_CELLS] = { needs_cells, "the light of light cells has not settled",
                     "light cells have settled, or light waits, or sdfgi_surface_light is probes" },
    [NEED_FILTER] = { needs_filter, "light cells have new light",
                      "no light cell has new light, or sdfgi_surface_light is probes" },
    [NEED_RESCALE] = { needs_rescale, "light is stored with another exposure",
                       "light is stored with the same exposure as before" },
    [NEED_GATHER] = { needs_picture, "the host called sdfgi_gather or resolved a view",
                      "the host called for no picture at full resolution" },
    [NEED_GATHER_SPARSE] = { needs_picture, "the host called for a picture at half or quarter resolution",
                             "the host called for no picture at half or quarter resolution" },
    [NEED_REFLECTIONS] = { needs_picture,
                           "a material is smooth, and the host resolved a view with reflections",
                           "no material is smooth, or the host resolved no view with reflections" },
    [NEED_ROUGH_LOBES] = { needs_picture,
                           "the host resolved a view with reflections, and light has a direction",
                           "the host resolved no view with reflections, or sdfgi_rough_lobes is off" },
    [NEED_DEBUG_VIEW] = { needs_picture, "the host called sdfgi_debug_draw",
                          "the host did not call sdfgi_debug_draw" },
    [NEED_DEBUG_TIER] = { needs_picture, "the host called sdfgi_debug_draw for tiers of reflections",
                          "the host did not call sdfgi_debug_draw for tiers of reflections" },
};

struct situation_needs sdfgi_frame_needs(const struct situation *situation)
{
    struct situation_needs result;
    for (int i = 0; i < NEED_COUNT; i++)
        result.holds[i] = needs[i].holds(situation);
    return result;
}

const char *sdfgi_need_reason(enum need need)
{
    return needs[need].why;
}

const char *sdfgi_need_reason_not(enum need need)
{
    return needs[need].why_not;
}
