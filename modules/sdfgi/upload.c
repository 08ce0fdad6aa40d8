/* SPDX-License-Identifier: MIT
 * Small data that changes on the CPU: frame parameters, lights, materials. Recorded inline, so that frames in
 * flight never meet. */
#include "internal.h"

#include <math.h>
#include <string.h>

static uint32_t log2_of(uint32_t power)
{
    uint32_t bits = 0;
    while (power >> (bits + 1))
        bits++;
    return bits;
}

static ivec3 cell_of(const int32_t at[3])
{
    return (ivec3){ at[0], at[1], at[2] };
}

static vec3 point_of(const double at[3])
{
    return (vec3){ (float)at[0], (float)at[1], (float)at[2] };
}

/* What shaders may read of a cascade, and what became new in this frame. */
static void fill_change(const struct sdfgi *gi, uint32_t c, struct sdfgi_cascade_params *p)
{
    const struct cascade *cascade = &gi->cascades[c];
    const struct change *change = &cascade->change;
    const bool completes = schedule_completes(gi, c);
    const struct cell_box *kept = completes ? &change->kept : &cascade->window;
    const uint32_t count = completes ? change->count : 0;
    p->valid_low = cell_of(cascade->window.low);
    p->valid_high = cell_of(cascade->window.high);
    p->dirty_count = (int32_t)count;
    p->blend_low = point_of(cascade->share_low);
    p->blend_high = point_of(cascade->share_high);
    p->kept_low = cell_of(kept->low);
    p->kept_high = cell_of(kept->high);
    p->bounds_axis = change_bounds_axis(change);
    for (uint32_t i = 0; i < count; i++) {
        p->dirty[i].low = cell_of(change->boxes[i].low);
        p->dirty[i].high = cell_of(change->boxes[i].high);
    }
}

static struct sdfgi_cascade_params cascade_params(const struct sdfgi *gi, uint32_t c)
{
    const struct cascade *cascade = &gi->cascades[c], *first = &gi->cascades[0];
    const int64_t n = gi->settings.resolution, side = n / SDFGI_PROBE_SPACING + 1;
    double origin[3], shift[3];
    int32_t wrap[3], probe_wrap[3], probe_base[3];
    for (int i = 0; i < 3; i++) {
        const int64_t probe = floor_div(cascade->origin[i], SDFGI_PROBE_SPACING);
        origin[i] = (double)cascade->origin[i] * cascade->cell_size[i] - gi->origin[i];
        wrap[i] = (int32_t)floor_mod(cascade->origin[i], n);
        probe_wrap[i] = (int32_t)floor_mod(probe, side);
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
    };
    fill_change(gi, c, &p);
    return p;
}

static vec3 scaled(const float color[3], float factor)
{
    return (vec3){ color[0] * factor, color[1] * factor, color[2] * factor };
}

static uint32_t shader_visibility(const struct sdfgi_settings *settings)
{
    static const uint32_t methods[] = {
        [SDFGI_VISIBILITY_CELL_MASK] = SDFGI_SHADER_VISIBILITY_CELL_MASK,
        [SDFGI_VISIBILITY_PROBE_DEPTH] = SDFGI_SHADER_VISIBILITY_PROBE_DEPTH,
        [SDFGI_VISIBILITY_TRACED] = SDFGI_SHADER_VISIBILITY_TRACED,
    };
    return settings->use_occlusion ? methods[settings->visibility] : SDFGI_SHADER_VISIBILITY_NONE;
}

void upload_params(struct sdfgi *gi)
{
    const struct sdfgi_settings *s = &gi->settings;
    const float sky = s->read_sky_light ? gi->exposure : 0.0f;
    struct sdfgi_frame_params p;
    memset(&p, 0, sizeof p);
    for (uint32_t c = 0; c < s->cascades; c++)
        p.cascades[c] = cascade_params(gi, c);
    p.sky_zenith = scaled(gi->scene.sky.zenith, sky);
    p.sky_horizon = scaled(gi->scene.sky.horizon, sky);
    p.sky_ground = scaled(gi->scene.sky.ground, sky);
    p.y_scale = (float)y_scale_factor(s->y_scale);
    p.exposure = gi->exposure;
    p.exposure_inverse = 1.0f / gi->exposure;
    p.energy = s->energy;
    p.normal_bias = s->normal_bias_cells;
    p.probe_bias = s->probe_bias_cells;
    p.bounce_feedback = s->bounce_feedback;
    p.emission_scale = gi->emission_unit * gi->exposure;
    p.resolution = s->resolution;
    p.resolution_log2 = log2_of(s->resolution);
    p.probes_per_side = s->resolution / SDFGI_PROBE_SPACING + 1;
    p.cascade_count = s->cascades;
    p.light_count = gi->scene.lights.count;
    p.light_cell_room = gi->resources ? (uint32_t)gi->resources->extent.light_cells : 0;
    p.visibility = shader_visibility(s);
    p.seed = gi->seed;
    p.cycle_samples = ring_samples(s);
    p.first_sample = gi->ring_frame * s->ray_count;
    p.rays_per_frame = s->ray_count < p.cycle_samples - p.first_sample ? s->ray_count : p.cycle_samples - p.first_sample;
    p.brightest_texel = gi->known_brightest;
    if (gi->converged) {
        /* Nobody reads these: they are no reason to upload anything. */
        p.cycle_samples = gi->params.cycle_samples;
        p.first_sample = gi->params.first_sample;
        p.rays_per_frame = gi->params.rays_per_frame;
        p.brightest_texel = gi->params.brightest_texel;
    }
    if (memcmp(&p, &gi->params, sizeof p) != 0) {
        gi->params = p;
        gi->params_changed = true;
    }
}

static struct sdfgi_light_params light_params(const struct sdfgi *gi, const struct sdfgi_light_desc *l)
{
    /* Squares of floats fit a double, however long or short the vector. */
    const double x = (double)l->direction[0], y = (double)l->direction[1], z = (double)l->direction[2];
    const double length = sqrt(x * x + y * y + z * z), unit = length > 0 ? 1 / length : 0;
    const float cos_inner = cosf(l->inner_angle_rad), cos_outer = cosf(l->outer_angle_rad);
    return (struct sdfgi_light_params){
        .position = { (float)(l->position[0] - gi->origin[0]), (float)(l->position[1] - gi->origin[1]),
                      (float)(l->position[2] - gi->origin[2]) },
        .range_m = l->range_m,
        .direction = { (float)(x * unit), (float)(y * unit), (float)(z * unit) },
        .cos_outer = cos_outer,
        .intensity = scaled(l->intensity, l->indirect_energy * gi->exposure),
        .cone_scale = 1 / fmaxf(cos_inner - cos_outer, 1e-4f),
        .kind = (uint32_t)l->type | (l->casts_shadow ? SDFGI_LIGHT_CASTS_SHADOW : 0),
    };
}

static void record_lights(struct sdfgi *gi, struct gpu_recorder *rec)
{
    struct sdfgi_light_params batch[64];
    uint32_t filled = 0, done = 0;
    const struct pool *lights = &gi->scene.lights;
    for (uint32_t i = 0; i < lights->end; i++) {
        const struct light *light = pool_at(lights, i);
        if (light)
            batch[filled++] = light_params(gi, &light->desc);
        if (filled == 64 || (i + 1 == lights->end && filled > 0)) {
            gpu_update(rec, &gi->resources->buffers[RESOURCE_LIGHTS], done * sizeof *batch,
                       filled * sizeof *batch, batch);
            done += filled;
            filled = 0;
        }
    }
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

static struct sdfgi_material_params material_params(const struct sdfgi *gi,
                                                    const struct sdfgi_material_desc *m)
{
    struct sdfgi_material_params p = {
        .albedo = { m->albedo[0], m->albedo[1], m->albedo[2] },
        .alpha = m->alpha,
        .emission = scaled(m->emission, gi->emission_unit > 0 ? 1 / gi->emission_unit : 0),
        .alpha_cutoff = m->alpha_cutoff,
        .flags = (m->albedo_texture.view ? SDFGI_MATERIAL_ALBEDO_TEXTURE : 0) |
                 (m->emission_texture.view ? SDFGI_MATERIAL_EMISSION_TEXTURE : 0) |
                 (m->double_sided_emission ? SDFGI_MATERIAL_DOUBLE_SIDED_EMISSION : 0),
    };
    uv_rows(m->albedo_texture.uv_transform, p.albedo_uv);
    uv_rows(m->emission_texture.uv_transform, p.emission_uv);
    return p;
}

static void record_materials(struct sdfgi *gi, struct gpu_recorder *rec)
{
    const struct pool *materials = &gi->scene.materials;
    for (uint32_t i = 0; i < materials->end; i++) {
        const struct material *material = pool_at(materials, i);
        if (!material)
            continue;
        const struct sdfgi_material_params p = material_params(gi, &material->desc);
        gpu_update(rec, &gi->resources->buffers[RESOURCE_MATERIALS], i * sizeof p, sizeof p, &p);
    }
}

void upload_record(struct sdfgi *gi, struct gpu_recorder *rec)
{
    if (gi->params_changed) {
        gpu_use(rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(FRAME));
        gpu_update(rec, &gi->resources->buffers[RESOURCE_FRAME], 0, sizeof gi->params, &gi->params);
    }
    if (gi->plan[PASS_PROBE_SUM].run) {
        const uint32_t no_rays[5] = { 0, 1, 1, 0, 0 };
        gpu_use(rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(INDIRECT));
        gpu_update(rec, &gi->resources->buffers[RESOURCE_INDIRECT], 16 * SDFGI_INDIRECT_RAYS, sizeof no_rays,
                   no_rays);
    }
    if (gi->plan[PASS_LIGHT_DIRECT].run && gi->scene.lights.count > 0) {
        gpu_use(rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(LIGHTS));
        record_lights(gi, rec);
    }
    if (gi->materials_changed) {
        gpu_use(rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(MATERIALS));
        record_materials(gi, rec);
    }
    gi->params_changed = gi->materials_changed = false;
}
