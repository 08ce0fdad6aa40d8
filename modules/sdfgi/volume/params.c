/* SPDX-License-Identifier: MIT
 * What shaders know of a volume: frame parameters, lights, materials. */
#include "volume.h"

#include "change.h"

#include <math.h>
#include <string.h>

_Static_assert(SDFGI_UP_Z == 1 && SDFGI_UP_MINUS_Y == 2 && SDFGI_UP_MINUS_Z == 3, "bits of up_axis");

static ivec3 cell_of(const int32_t at[3])
{
    return (ivec3){ at[0], at[1], at[2] };
}

static vec3 point_of(const double at[3])
{
    return (vec3){ (float)at[0], (float)at[1], (float)at[2] };
}

/* Cells from a place to the farthest that is interpolated around it. */
#define PLACE_MARGIN 1.5f

static vec3 place_of(const int32_t cell[3], float margin)
{
    return (vec3){ (float)cell[0] + margin, (float)cell[1] + margin, (float)cell[2] + margin };
}

/* What shaders may read of a cascade, and what becomes complete in this frame. */
static void fill_change(const struct cascade *cascade, struct sdfgi_cascade_params *p)
{
    const struct change *change = &cascade->change;
    const bool completes = sdfgi_cascade_completes(cascade);
    const struct cell_box *kept = completes ? &change->kept : &cascade->valid;
    const uint32_t count = completes ? change->count : 0;
    p->valid_low = cell_of(cascade->valid.low);
    p->valid_high = cell_of(cascade->valid.high);
    p->dirty_count = (int32_t)count;
    p->blend_low = point_of(cascade->blend_low);
    p->blend_high = point_of(cascade->blend_high);
    p->places_low = place_of(cascade->valid.low, PLACE_MARGIN);
    p->places_high = place_of(cascade->valid.high, -PLACE_MARGIN);
    p->kept_low = cell_of(kept->low);
    p->kept_high = cell_of(kept->high);
    p->bounds_axis = sdfgi_change_bounds_axis(change);
    for (uint32_t i = 0; i < count; i++) {
        p->dirty[i].low = cell_of(change->boxes[i].low);
        p->dirty[i].high = cell_of(change->boxes[i].high);
    }
}

/* Cells. Farther off than any cascade reaches, and little enough for floats to tell cells apart. */
#define FARTHEST_CONTENT 1048576.0

/* The cells that a box in the world touches, and so many around them. */
static struct cell_box cells_of_box(const struct cascade *cascade, const struct box *box, double around)
{
    struct cell_box cells;
    for (int i = 0; i < 3; i++) {
        const double cell = cascade->cell_size[i], origin = (double)cascade->origin[i],
                     low = floor(box->min[i] / cell - origin) - around,
                     high = ceil(box->max[i] / cell - origin) + around;
        cells.low[i] = (int32_t)fmin(fmax(low, -FARTHEST_CONTENT), FARTHEST_CONTENT);
        cells.high[i] = (int32_t)fmin(fmax(high, -FARTHEST_CONTENT), FARTHEST_CONTENT);
    }
    return cells;
}

/* Widened by a cell, because surfaces lie in the sub-voxels behind them. */
static void fill_content(const struct cascade *cascade, const struct box *content,
                         struct sdfgi_cascade_params *p)
{
    const struct cell_box cells = cells_of_box(cascade, content, 1);
    p->content_low = cell_of(cells.low);
    p->content_high = cell_of(cells.high);
}

static struct sdfgi_cascade_params cascade_params(const struct volume_state *state, uint32_t c)
{
    const struct cascade *cascade = &state->cascades.at[c], *first = &state->cascades.at[0];
    const int64_t n = state->cascades.resolution, side = n / SDFGI_PROBE_SPACING + 1;
    double origin[3], shift[3];
    int32_t wrap[3], probe_wrap[3], probe_base[3];
    for (int i = 0; i < 3; i++) {
        const int64_t probe = sdfgi_floor_div(cascade->origin[i], SDFGI_PROBE_SPACING);
        origin[i] = (double)cascade->origin[i] * cascade->cell_size[i] - state->origin[i];
        wrap[i] = (int32_t)sdfgi_floor_mod(cascade->origin[i], n);
        probe_wrap[i] = (int32_t)sdfgi_floor_mod(probe, side);
        probe_base[i] = (int32_t)(uint32_t)(uint64_t)probe;
        /* Cell space of cascade c = (cell space of cascade 0 + first origin) / 2^c - own origin. */
        shift[i] = ldexp((double)first->origin[i], -(int)c) - (double)cascade->origin[i];
    }
    struct sdfgi_cascade_params p = {
        .origin_rel = point_of(origin),
        .cell_m = (float)cascade->cell_size[0],
        .wrap = cell_of(wrap),
        .probe_wrap = cell_of(probe_wrap),
        .from_first = point_of(shift),
        .from_first_scale = ldexpf(1.0f, -(int)c),
        .probe_base = cell_of(probe_base),
        .watched_first = state->gathering.at[c].watched_first,
        .watched_end = state->gathering.at[c].watched_end,
        .hit_bits = sdfgi_gathering_hit_bits(&state->gathering, c),
        .hit_part = sdfgi_gathering_hit_part(&state->gathering),
    };
    fill_change(cascade, &p);
    fill_content(cascade, &state->content, &p);
    return p;
}

/* Light stored with an exposure that does not fit it. Beyond this, where no format reaches, sums of floats
 * could come out infinite. */
#define BRIGHTEST 1e9f
/* Light times the host's exposure that is dark in a picture. Changes count relative to light and this much
 * more: not to the brightest light, which may be a sun outside that a dim room never sees. */
#define DARK (1.0f / 4096)

static vec3 scaled(const float color[static 3], float factor)
{
    return (vec3){ fminf(color[0] * factor, BRIGHTEST), fminf(color[1] * factor, BRIGHTEST),
                   fminf(color[2] * factor, BRIGHTEST) };
}

static void fill_sky(struct sdfgi_frame_params *p, const struct sdfgi_sky *sky, float factor)
{
    p->sky_zenith = scaled(sky->zenith, factor);
    p->sky_horizon = scaled(sky->horizon, factor);
    p->sky_ground = scaled(sky->ground, factor);
}

/* No factor is so large that a product of floats could come out infinite. */
static float limited(float value)
{
    return fminf(fmaxf(value, -BRIGHTEST), BRIGHTEST);
}

static void fill_harmonics(struct sdfgi_frame_params *p, const struct scene *scene, float factor)
{
    float factors[9][3];
    if (factor == 0 || !sdfgi_harmonics_any(&scene->harmonics))
        return;
    sdfgi_harmonics_factors(&scene->harmonics, scene->up_axis, factors);
    p->sky_has_harmonics = 1;
    for (int i = 0; i < 9; i++)
        p->sky_harmonics[i] = (vec4){ limited(factors[i][0] * factor), limited(factors[i][1] * factor),
                                      limited(factors[i][2] * factor), 0 };
}

/* Shorter blends than this are none; smoothstep needs one. */
#define SHORTEST_BLEND 1e-4f

static void fill_settings(struct sdfgi_frame_params *p, const struct sdfgi_settings *s)
{
    p->y_scale = (float)sdfgi_settings_y_scale(s);
    p->energy = s->energy;
    p->normal_bias = s->normal_bias_cells;
    p->probe_bias = s->probe_bias_cells;
    p->bounce_feedback = s->bounce_feedback;
    p->rays_blend = fminf(s->reflection_blend, s->reflection_end - SHORTEST_BLEND);
    p->rays_end = s->reflection_end;
    p->resolution = s->resolution;
    p->resolution_log2 = sdfgi_log2(s->resolution);
    p->probes_per_side = s->resolution / SDFGI_PROBE_SPACING + 1;
    p->cascade_count = s->cascades;
    p->visibility = sdfgi_settings_shader_visibility(s);
    p->cycle_visits = sdfgi_settings_cycle_visits(s);
}

/* The rays of this frame. Once light has converged nobody reads these: they stay, and are no reason to upload
 * anything. */
static void fill_cycle(struct sdfgi_frame_params *p, const struct volume_state *state,
                       const struct sdfgi_settings *s)
{
    const struct accumulation *a = &state->accumulation;
    const bool keep = a->phase == LIGHTING_CONVERGED;
    const struct sdfgi_frame_params *old = &state->params;
    const uint32_t samples = sdfgi_settings_cycle_samples(s), first = a->frame * s->ray_count;
    const uint32_t rays = s->ray_count < samples - first ? s->ray_count : samples - first;
    p->cycle_samples = keep ? old->cycle_samples : samples;
    p->first_sample = keep ? old->first_sample : first;
    p->rays_per_frame = keep ? old->rays_per_frame : rays;
}

/* Where something has changed in this epoch, and in the last one. Returns the number of boxes. */
static uint32_t fill_places(struct sdfgi_dirty_box boxes[static SDFGI_EDITED_BOXES],
                            const struct cascade *finest, const struct edited_places *now,
                            const struct edited_places *last)
{
    struct edited_places places = *now;
    for (uint32_t i = 0; i < last->count; i++)
        sdfgi_edited_places_add(&places, &last->boxes[i]);
    for (uint32_t i = 0; i < places.count; i++) {
        const struct cell_box cells = cells_of_box(finest, &places.boxes[i], 0);
        boxes[i].low = cell_of(cells.low);
        boxes[i].high = cell_of(cells.high);
    }
    return places.count;
}

/* What has changed. It stays once light has converged, as in fill_cycle. */
static void fill_epoch(struct sdfgi_frame_params *p, const struct volume_state *state)
{
    const struct gathering *gathering = &state->gathering;
    const struct sdfgi_frame_params *old = &state->params;
    if (state->accumulation.phase == LIGHTING_CONVERGED) {
        memcpy(p->edited, old->edited, sizeof p->edited);
        p->edited_count = old->edited_count;
        memcpy(p->edited_emitters, old->edited_emitters, sizeof p->edited_emitters);
        p->edited_emitter_count = old->edited_emitter_count;
        p->epoch = old->epoch;
        p->epoch_of_all = old->epoch_of_all;
        p->next_epoch = old->next_epoch;
        p->epoch_of_drift = old->epoch_of_drift;
        p->drift = old->drift;
        p->epoch_of_local = old->epoch_of_local;
        p->flicker = old->flicker;
        p->changes_are_local = old->changes_are_local;
        return;
    }
    p->edited_count =
        fill_places(p->edited, &state->cascades.at[0], &gathering->edited, &gathering->edited_last);
    p->edited_emitter_count = fill_places(p->edited_emitters, &state->cascades.at[0], &gathering->emitters,
                                          &gathering->emitters_last);
    p->epoch = gathering->epoch;
    p->epoch_of_all = gathering->epoch_of_all;
    p->next_epoch = sdfgi_gathering_next_epoch(gathering);
    p->epoch_of_drift = gathering->epoch_of_drift;
    p->drift = gathering->drift;
    p->epoch_of_local = gathering->epoch_of_local;
    p->flicker = gathering->flicker;
    p->changes_are_local = sdfgi_gathering_changes_are_local(gathering);
}

static float emission_scale(const struct scene *scene, float exposure)
{
    return scene->emissive > 0 ? fminf(scene->emission_unit * exposure, BRIGHTEST) : 0;
}

void sdfgi_params_fill(struct sdfgi_frame_params *p, const struct volume_state *state,
                       const struct params_input *input)
{
    const float exposure = ldexpf(1, state->exposure.stored);
    memset(p, 0, sizeof *p);
    for (uint32_t c = 0; c < state->cascades.count; c++)
        p->cascades[c] = cascade_params(state, c);
    p->up_axis = (uint32_t)input->scene->up_axis;
    fill_sky(p, &input->scene->sky, input->settings->read_sky_light ? exposure : 0.0f);
    fill_harmonics(p, input->scene, input->settings->read_sky_light ? exposure : 0.0f);
    fill_settings(p, input->settings);
    p->exposure = exposure;
    p->exposure_inverse = 1.0f / exposure;
    p->dark = ldexpf(DARK, state->exposure.stored - state->exposure.hint);
    p->emission_scale = emission_scale(input->scene, exposure);
    p->light_count = input->scene->lights.count;
    p->light_cell_room = (uint32_t)input->extent->light_cells;
    p->emitter_samples = (uint32_t)sdfgi_extent_emitter_samples(input->extent);
    p->has_metal = input->scene->metals > 0;
    p->seed = state->seed;
    p->keeps_low_light = state->low_light;
    p->low_light_begin = state->low_light ? input->low_light_begin : 0;
    fill_epoch(p, state);
    fill_cycle(p, state, input->settings);
}

struct sdfgi_light_params sdfgi_params_of_light(const struct volume_state *state, uint32_t slot,
                                                const struct sdfgi_light_desc *l)
{
    /* Squares of floats fit a double, however long or short the vector. */
    const double x = (double)l->direction[0], y = (double)l->direction[1], z = (double)l->direction[2];
    const double length = sqrt(x * x + y * y + z * z), unit = length > 0 ? 1 / length : 0;
    const float cos_inner = cosf(l->inner_angle_rad), cos_outer = cosf(l->outer_angle_rad);
    const double *o = state->origin;
    return (struct sdfgi_light_params){
        .position = { (float)(l->position[0] - o[0]), (float)(l->position[1] - o[1]),
                      (float)(l->position[2] - o[2]) },
        .range_m = l->range_m,
        .direction = { (float)(x * unit), (float)(y * unit), (float)(z * unit) },
        .cos_outer = cos_outer,
        .intensity = scaled(l->intensity, l->indirect_energy * ldexpf(1, state->exposure.stored)),
        .cone_scale = 1 / fmaxf(cos_inner - cos_outer, 1e-4f),
        .kind = (uint32_t)l->type | (l->casts_shadow ? SDFGI_LIGHT_CASTS_SHADOW : 0),
        .bit = sdfgi_light_bit(slot),
    };
}

static void uv_rows(const float m[6], vec4 rows[2])
{
    static const float identity[6] = { 1, 0, 0, 0, 1, 0 };
    bool zero = true;
    for (int i = 0; i < 6; i++)
        zero = zero && m[i] == 0;
    const float *use = zero ? identity : m;
    rows[0] = (vec4){ use[0], use[1], use[2], 0 };
    rows[1] = (vec4){ use[3], use[4], use[5], 0 };
}

struct sdfgi_material_params sdfgi_params_of_material(const struct scene *scene,
                                                      const struct sdfgi_material_desc *m)
{
    struct sdfgi_material_params p = {
        .albedo = { m->albedo[0], m->albedo[1], m->albedo[2] },
        .alpha = m->alpha,
        .emission = scaled(m->emission, 1 / scene->emission_unit),
        .alpha_cutoff = m->alpha_cutoff,
        .specular_albedo = m->specular_albedo,
        .flags = sdfgi_scene_metal_kind(m) << SDFGI_MATERIAL_METAL_SHIFT |
                 (m->albedo_texture.view ? SDFGI_MATERIAL_ALBEDO_TEXTURE : 0) |
                 (m->emission_texture.view ? SDFGI_MATERIAL_EMISSION_TEXTURE : 0) |
                 (m->double_sided_emission ? SDFGI_MATERIAL_DOUBLE_SIDED_EMISSION : 0) |
                 (m->albedo_texture.decode_srgb ? SDFGI_MATERIAL_ALBEDO_SRGB : 0) |
                 (m->emission_texture.decode_srgb ? SDFGI_MATERIAL_EMISSION_SRGB : 0),
    };
    uv_rows(m->albedo_texture.uv_transform, p.albedo_uv);
    uv_rows(m->emission_texture.uv_transform, p.emission_uv);
    return p;
}
