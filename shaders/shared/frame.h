/* SPDX-License-Identifier: MIT
 * The frame buffer: everything shaders need to know about cascades, sky and settings. */
#ifndef SDFGI_SHARED_FRAME_H
#define SDFGI_SHARED_FRAME_H

#include "types.h"
#include "constants.h"

/* Local cells [low, high) of a cascade. */
struct sdfgi_dirty_box {
    ivec3 low;
    uint padding_0;
    ivec3 high;
    uint padding_1;
};
SDFGI_ASSERT_SIZE(sdfgi_dirty_box, 32);

/* Cell space of a cascade: (0, 0, 0) is its low corner, one unit is one cell along each axis; a cell is as
 * high as y_scale times its width. Metric lengths inside a cascade are counted in cell widths. */
struct sdfgi_cascade_params {
    vec3 origin_rel;    /* low corner in metres relative to the host's origin */
    float cell_m;       /* width of a cell in metres */
    ivec3 wrap;         /* texel of cell (0, 0, 0) in the toroidal volumes, in [0, resolution) */
    uint watched_first; /* entries [watched_first, watched_end) of the list: watched cells are visited, too */
    ivec3 probe_wrap;   /* slot of probe (0, 0, 0), in [0, probes_per_side) */
    uint watched_end;
    vec3 from_first; /* cell space = from_first + from_first_scale * cell space of cascade 0 */
    float from_first_scale;
    ivec3 probe_base; /* world index of probe (0, 0, 0), low 32 bits: seeds its ray directions */
    uint hit_bits;    /* cells of a word that have their turn if rays hit them: see sdfgi/seen.glsl */
    ivec3 valid_low;  /* valid region: cells [low, high) are complete and may be read; empty if low = high */
    int dirty_count;  /* boxes in `dirty` */
    ivec3 valid_high;
    uint hit_part; /* 0 or 1: where marks on these are read; new ones go to the other part */
    /* Blend region: cells [low, high) that lookups sample, inside the valid region. It follows the valid
     * region smoothly, whereas that changes in steps of SDFGI_PROBE_SPACING cells. */
    vec3 blend_low;
    uint padding_4;
    vec3 blend_high;
    uint padding_5;
    /* Where lookups read light cells: places [low, high], around which all cells are in the valid region. */
    vec3 places_low;
    uint padding_9;
    vec3 places_high;
    uint padding_10;
    ivec3 kept_low;  /* cells [low, high) that were valid before this frame */
    int bounds_axis; /* axis across which dirty_bounds.glsl cuts its strips; -1: this change has no bounds */
    ivec3 kept_high;
    uint padding_6;
    /* Cells [low, high) around all geometry, within the cascade or not; low > high if there is none. Rays
     * cross what is beyond them in one step. */
    ivec3 content_low;
    uint padding_7;
    ivec3 content_high;
    uint padding_8;
    /* Boxes that a change completes in this frame. A scroll names the boxes that left the cascade as well:
     * these lie outside [0, resolution). */
    SDFGI_STRUCT(sdfgi_dirty_box) dirty[SDFGI_MAX_CHANGES];
};
SDFGI_ASSERT_SIZE(sdfgi_cascade_params, 240 + 32 * SDFGI_MAX_CHANGES);

struct sdfgi_frame_params {
    SDFGI_STRUCT(sdfgi_cascade_params) cascades[SDFGI_MAX_CASCADES];
    vec3 sky_zenith; /* radiance times exposure; zero when the sky is not read */
    uint sky_has_harmonics;
    vec3 sky_horizon;
    uint up_axis; /* enum sdfgi_up_axis. Bit 0: up is along Z, not Y; bit 1: against it */
    vec3 sky_ground;
    uint has_metal; /* 1: a material is metal that reflects what it sees */
    float y_scale;  /* height of a cell over its width */
    float exposure;
    float exposure_inverse; /* 1 / exposure */
    float energy;
    float normal_bias; /* cells */
    float probe_bias;  /* cells */
    float bounce_feedback;
    float emission_scale; /* unit of stored emission times exposure; 0: nothing emits */
    uint resolution;      /* cells along a side */
    uint resolution_log2;
    uint probes_per_side;
    uint cascade_count;
    uint light_count;
    uint light_cell_room; /* entries of the light list per cascade */
    uint visibility;      /* SDFGI_SHADER_VISIBILITY_* */
    uint seed;
    uint rays_per_frame;   /* rays of a probe in a frame */
    uint first_sample;     /* this frame's first sample in the sample cycle */
    uint cycle_samples;    /* samples of a probe in a sample cycle */
    uint cycle_visits;     /* visits of a light cell in a gather cycle; 0: light cells read probes alone */
    uint emitter_samples;  /* of a probe in a cycle, towards emitters; 0: nothing emits and none is listed */
    float dark;            /* light times exposure that counts as dark */
    float rays_blend;      /* roughness from which on reflections blend into irradiance */
    float rays_end;        /* roughness from which on they are irradiance; above rays_blend */
    uint next_epoch;       /* to which belongs what changes in this frame */
    uint epoch;            /* changes of a time: see sdfgi/gathered.glsl */
    uint epoch_of_all;     /* the last one that changed the light of all light cells */
    uint edited_count;     /* boxes in `edited` */
    uint epoch_of_drift;   /* the last one that changed the light of all light cells a little, */
    float drift;           /* and by which part of it */
    uint changes_are_local; /* 1: something has changed of late for some light cells alone */
    uint epoch_of_local;   /* the last one in which more than lamps that flicker had changed */
    float flicker;         /* by which part the mean of these lamps' light has changed of late */
    uint edited_emitter_count; /* boxes in `edited_emitters` */
    uint keeps_low_light;  /* 1: light cells keep from where they get their light */
    uint low_light_begin;  /* where in SEEN that begins, for shaders of hosts; 0: they cannot read it */
    vec4 sky_harmonics[9]; /* factors of 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2; w unused */
    /* Around geometry that has changed in the last epochs, of cascade 0. They may lie beyond it. */
    SDFGI_STRUCT(sdfgi_dirty_box) edited[SDFGI_EDITED_BOXES];
    /* Of these, around things that emit, or did. */
    SDFGI_STRUCT(sdfgi_dirty_box) edited_emitters[SDFGI_EDITED_BOXES];
};
SDFGI_ASSERT_SIZE(sdfgi_frame_params,
                  SDFGI_MAX_CASCADES *(240 + 32 * SDFGI_MAX_CHANGES) + 21 * 16 + 64 * SDFGI_EDITED_BOXES);

struct sdfgi_light_params {
    vec3 position;  /* metres relative to the host's origin */
    float range_m;  /* 0: unlimited */
    vec3 direction; /* unit vector in which light travels */
    float cos_outer;
    vec3 intensity;   /* W/sr or W/m^2, times exposure and indirect energy */
    float cone_scale; /* 1 / (cos inner - cos outer) */
    uint kind;        /* SDFGI_LIGHT_KIND_* | SDFGI_LIGHT_CASTS_SHADOW */
    uint bit;         /* of SDFGI_LIGHT_BITS: its own, or shared if there are more lights */
    uint padding_0, padding_1;
};
SDFGI_ASSERT_SIZE(sdfgi_light_params, 64);

#define SDFGI_MATERIAL_ALBEDO_TEXTURE        1u
#define SDFGI_MATERIAL_EMISSION_TEXTURE      2u
#define SDFGI_MATERIAL_DOUBLE_SIDED_EMISSION 4u
#define SDFGI_MATERIAL_ALBEDO_SRGB           8u /* the texture's texels are encoded, and it does not decode */
#define SDFGI_MATERIAL_EMISSION_SRGB         16u
/* Two bits: the kind of metal that reflects what it sees, from 1 for mirrors to 3; 0 for all else. */
#define SDFGI_MATERIAL_METAL_SHIFT 5u

struct sdfgi_material_params {
    vec3 albedo;
    float alpha;
    vec3 emission;      /* in units of stored emission */
    float alpha_cutoff; /* 0: opaque */
    vec4 albedo_uv[2];  /* rows of uv' = M (u, v, 1); w unused */
    vec4 emission_uv[2];
    uint flags;            /* SDFGI_MATERIAL_* */
    float specular_albedo; /* added to albedo and its texture */
    uint padding_0, padding_1;
};
SDFGI_ASSERT_SIZE(sdfgi_material_params, 112);

#endif
