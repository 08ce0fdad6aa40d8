/* SPDX-License-Identifier: MIT
 * Decides which part of the pending work of cascades this frame does.
 *
 * A cascade that scrolls keeps serving the cells that its old and its new place share. All volumes are
 * toroidal, so the cells that enter take the storage of those that leave, and nothing is held twice. The work
 * of a change is cut into whole slices and layers: voxels, then distances, then, in one frame, probes, light
 * cells and light. In that frame the valid region becomes the whole cascade again.
 *
 * Each frame does as much as keeps all cascades just ahead of the camera, near ones first, so that work is
 * even from frame to frame. A frame never exceeds the budget, except while nothing is shown yet, if the host
 * has not asked for a start in parts, or for distances by a flood, which cannot be cut. Where the camera is
 * faster than the budget allows, fine cascades wait and coarser ones answer. */
#ifndef SDFGI_SCROLL_H
#define SDFGI_SCROLL_H

#include "cascade.h"

enum { SCROLL_CALM_FRAMES = 3 }; /* at a slow pace, between frames in which cascades complete */

/* How the camera moves, and what that asks for. */
struct scroll {
    double camera[3];       /* m */
    double moved;           /* in the last frame: probe spacings of cascade 0 along the fastest axis */
    double pace;            /* the same, sustained over frames */
    double heading[3];      /* fraction of that along each axis: a running mean */
    uint64_t frames;        /* that the camera has been followed */
    uint64_t scrolls_begun; /* since the start */
    uint32_t calm_frames;   /* before this one, in a row, in which no cascade completed */
    uint32_t blends_moving; /* cascades whose blend region still moves */
};

enum piece_kind { PIECE_VOXELS, PIECE_DISTANCES };

/* A part of a change that this frame does. */
struct scroll_piece {
    enum piece_kind kind;
    uint32_t cascade;
    bool begins;           /* voxels: the first of its change */
    struct cell_box box;   /* voxels */
    struct cell_box made;  /* voxels: what earlier parts of the same piece made */
    uint32_t first, count; /* distances: layers of light blocks along x */
    bool finds_bits;       /* distances: where set bits are is not known of earlier layers of the change */
};

enum { SCROLL_MAX_PIECES = 64 };

struct scroll_plan {
    struct scroll_piece pieces[SCROLL_MAX_PIECES];
    uint32_t piece_count;
    uint64_t cells;    /* voxelised or given distances */
    bool from_nothing; /* no cascade was complete before this frame */
    uint32_t begun;    /* a bit per cascade whose change begins */
};

/* What of the settings matters here. */
struct scroll_limits {
    uint64_t max_cells;   /* in a frame */
    bool flood;           /* distances cannot be cut: a cascade's are made at once */
    bool starts_in_parts; /* `max_cells` holds while nothing is shown yet, too */
};

void sdfgi_scroll_init(struct scroll *scroll);
/* Before the plan of a frame whose picture has nothing to do with the one before. */
void sdfgi_scroll_cut(struct scroll *scroll, struct cascades *cascades);
/* Begins what cascades need and decides how much of it this frame does. `blend_jumps`: no light has been
 * shown yet, so that blend regions need not move smoothly. */
void sdfgi_scroll_plan(struct scroll *scroll, struct cascades *cascades, const struct scroll_limits *limits,
                       const double camera[static 3], bool blend_jumps, struct scroll_plan *plan);
/* After the frame: what completed is finished. */
void sdfgi_scroll_finish(struct scroll *scroll, struct cascades *cascades);

bool sdfgi_scroll_plan_has(const struct scroll_plan *plan, enum piece_kind kind);

#endif
