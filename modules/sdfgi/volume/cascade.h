/* SPDX-License-Identifier: MIT
 * Cascades: where they are, which of their cells may be read, and what is being changed in them. Plain data
 * and arithmetic, no Vulkan. */
#ifndef SDFGI_CASCADE_H
#define SDFGI_CASCADE_H

#include "core/box.h"

#include <sdfgi/settings.h>

#include "shaders/shared/constants.h"

/* Why cells of a cascade are made again. */
enum change_cause {
    CHANGE_NONE,
    CHANGE_REBUILD, /* all of it */
    CHANGE_SCROLL,  /* it moves: cells enter on one side and leave on another */
    CHANGE_EDIT,    /* geometry changed in boxes; they may be read meanwhile */
};

/* How far a change has come. One goes to the next: change.c asserts it. */
enum change_stage {
    CHANGE_IDLE,      /* cause: NONE */
    CHANGE_BEGUN,     /* nothing has been voxelised */
    CHANGE_VOXELS,    /* boxes are left to voxelise */
    CHANGE_DISTANCES, /* layers are left that need distances */
    CHANGE_READY,     /* waits for a frame that completes it */
    CHANGE_COMPLETES, /* completes in this frame */
};

/* Cells of a cascade that are made again, over as many frames as the budget takes. */
struct change {
    enum change_cause cause;
    enum change_stage stage;
    /* Boxes inside the cascade are voxelised. Cached rays that cross any box are invalidated; a scroll names
     * those that left the cascade, too. */
    struct cell_box boxes[SDFGI_MAX_CHANGES];
    uint32_t count;
    struct cell_box kept; /* complete all the while */
    int32_t before[3];    /* low corner of the cells that were complete, in cells of the new place */
    uint32_t box;         /* of `boxes`: the next to be voxelised, ... */
    int32_t slice;        /* ... from this cell on along its longest axis */
    uint32_t layer;       /* of light blocks: the next to get distances */
    uint64_t cells_left;  /* to be voxelised or given distances */
};

/* Whether what is stored belongs to where the cascade is. */
enum cascade_place {
    CASCADE_UNPLACED, /* nothing is stored, and it has no place */
    CASCADE_OUTDATED, /* it must be rebuilt */
    CASCADE_CURRENT,  /* what is stored is right, or being changed */
};

/* Whether a cascade follows the camera in this frame: the budget decides. */
enum cascade_following {
    CASCADE_KEEPS_UP,
    CASCADE_WAITS,       /* the camera is too fast for it to scroll */
    CASCADE_LEFT_BEHIND, /* it waits, and the camera is off its centre */
};

struct cascade {
    int64_t origin[3];   /* world index of the low corner's cell, a multiple of SDFGI_PROBE_SPACING */
    double cell_size[3]; /* metres */
    enum cascade_place place;
    enum cascade_following following;
    enum change_cause last_turn; /* SCROLL or EDIT: they take turns */
    struct change change;
    struct cell_box valid;              /* valid region: complete cells, which shaders may read */
    double blend_low[3], blend_high[3]; /* blend region: the part of it that lookups sample, see blend.h */
    double spare[3]; /* cells left free on the side that the camera leaves: the low one if positive */
    bool cut;        /* since a camera cut it has not arrived: its blend region need not move smoothly */
    struct box edits[SDFGI_MAX_CHANGES]; /* world: geometry changed there since the last change began */
    uint32_t edit_count;
};

struct cascades {
    uint32_t count, resolution;
    uint32_t searched; /* cascade of the last search for distances: SEARCH tells where its set bits are */
    struct cascade at[SDFGI_MAX_CASCADES];
};

/* Cascades of these settings that hold nothing yet. */
void sdfgi_cascades_init(struct cascades *cascades, const struct sdfgi_settings *settings);

/* Places a cascade around a camera: at first centred to within half a probe. Afterwards a cascade moves in
 * steps of one probe spacing, when the camera is more than one spacing from its centre on some axis; other
 * axes move in the same step if `spare` has reserved room for it. A camera that oscillates around a point
 * causes one step at most. Returns true if it moved. */
bool sdfgi_cascade_place(struct cascade *cascade, uint32_t resolution, const double camera[static 3]);
/* Cells that a box in the world touches, widened to whole probe spacings, clipped to the cascade. */
struct cell_box sdfgi_cascade_cells(const struct cascade *cascade, uint32_t resolution,
                                    const struct box *box);
/* The world box of some cells, and a sub-voxel more: triangles set sub-voxels that they touch. */
struct box sdfgi_cascade_world_box(const struct cascade *cascade, const struct cell_box *cells);

/* Notes that everything stored is out of date. */
void sdfgi_cascade_outdate(struct cascade *cascade);
/* True if a box lies in a cascade, in part at least. */
bool sdfgi_cascade_overlaps(const struct cascade *cascade, uint32_t resolution, const struct box *box);
/* Notes that geometry changed in a box. Returns false if the cascade has no cell there. */
bool sdfgi_cascade_add_edit(struct cascade *cascade, uint32_t resolution, const struct box *box);

/* True in the frame in which the cascade's change completes. */
bool sdfgi_cascade_completes(const struct cascade *cascade);
/* True if a change completes in this frame, of any cascade. */
bool sdfgi_cascades_complete(const struct cascades *cascades);
/* True if all cascades hold the scene as it is: nothing is being changed or waits for its turn. */
bool sdfgi_cascades_are_current(const struct cascades *cascades);
/* True if no cascade changes or has to catch up with the camera. */
bool sdfgi_cascades_rest(const struct cascades *cascades);

#endif
