/* SPDX-License-Identifier: MIT
 * The frame buffer: everything shaders need to know about cascades, sky and settings. */
#ifndef SDFGI_SHARED_FRAME_H
#define SDFGI_SHARED_FRAME_H

#include "types.h"
#include "constants.h"

/* Cell space of a cascade: (0, 0, 0) is its low corner, one unit is one cell along each axis; a cell is as high as
 * y_scale times its width. Metric lengths inside a cascade are counted in cell widths. */
struct sdfgi_cascade_params {
    vec4 origin_rel;  /* xyz: low corner in metres relative to the host's origin, w: cell width in metres */
    ivec4 wrap;       /* xyz: texel of cell (0, 0, 0) in the toroidal volumes, in [0, resolution) */
    ivec4 probe_wrap; /* xyz: slot of probe (0, 0, 0), in [0, probes_per_side) */
    vec4 from_first;  /* cell space = xyz + w * cell space of cascade 0 */
    ivec4 probe_base; /* xyz: world index of probe (0, 0, 0), low 32 bits: seeds its ray directions */
    ivec4 window_low, window_high; /* xyz: cells [low, high) are complete and may be read; empty if low = high.
                                      window_low.w: boxes in `changed` */
    vec4 share_low, share_high;    /* xyz: cells that lookups read, within the window; moves smoothly where that jumps */
    ivec4 kept_low, kept_high;     /* xyz: cells that were complete before this frame; kept_low.w: axis of content.glsl's
                                      strips, -1: none */
    ivec4 changed[2 * SDFGI_MAX_CHANGES]; /* low and high corner of each box that became new in this frame, cells
                                             that left the cascade included: those lie outside [0, resolution) */
};
SDFGI_ASSERT_SIZE(sdfgi_cascade_params, 176 + 32 * SDFGI_MAX_CHANGES);

struct sdfgi_frame_params {
    SDFGI_STRUCT(sdfgi_cascade_params) cascades[SDFGI_MAX_CASCADES];
    vec4 sky_zenith, sky_horizon, sky_ground; /* xyz: radiance times exposure; zero when the sky is not read */
    vec4 scale;       /* x: y_scale, y: exposure, z: 1 / exposure, w: energy */
    vec4 bias;        /* x: normal bias in cells, y: probe bias in cells, z: feedback, w: emission unit times exposure */
    uvec4 size;       /* x: resolution, y: log2 of it, z: probes per side, w: cascade count */
    uvec4 light;      /* x: light count, y: light cell capacity per cascade, z: visibility method, w: seed */
    uvec4 ring;       /* x: rays per frame, y: first sample of this frame, z: samples in the ring,
                         w: float bits of the brightest probe texel known */
};
SDFGI_ASSERT_SIZE(sdfgi_frame_params, SDFGI_MAX_CASCADES * (176 + 32 * SDFGI_MAX_CHANGES) + 3 * 16 + 5 * 16);

struct sdfgi_light_params {
    vec4 position;  /* xyz: metres relative to the host's origin, w: range in metres (0: unlimited) */
    vec4 direction; /* xyz: unit, the way light travels, w: cos outer */
    vec4 intensity; /* xyz: W/sr or W/m^2, times exposure and indirect energy, w: 1 / (cos inner - cos outer) */
    uvec4 kind;     /* x: SDFGI_LIGHT_KIND_* | SDFGI_LIGHT_CASTS_SHADOW */
};
SDFGI_ASSERT_SIZE(sdfgi_light_params, 64);

#endif
