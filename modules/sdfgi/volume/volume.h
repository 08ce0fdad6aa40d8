/* SPDX-License-Identifier: MIT
 * A volume: cascades that follow one camera, their light, and how far it has converged. */
#ifndef SDFGI_VOLUME_H
#define SDFGI_VOLUME_H

#include "accumulation.h"
#include "exposure.h"
#include "gathering.h"
#include "pass/resources.h"
#include "relight.h"
#include "scene/scene.h"
#include "scroll.h"

/* All that a volume knows on the host. Plain data: a frame is planned on a copy, which replaces it once the
 * frame has been recorded. */
struct volume_state {
    struct cascades cascades;
    struct scroll scroll;
    struct accumulation accumulation;
    struct relight relight;
    struct gathering gathering;
    struct box content;   /* world: around all that the cascades hold */
    bool content_shrinks; /* once they are complete: some of it may be gone */
    double origin[3];     /* world position of (0, 0, 0) in the host's shaders */
    struct exposure exposure;
    uint32_t seed;
    uint32_t seed_asked;              /* by the last frame: taken over once two in a row ask for it */
    struct sdfgi_frame_params params; /* as last uploaded */
    bool low_light;                   /* light cells keep from where they get their light */
    uint64_t instances;               /* revision of the scene up to which instances have been uploaded */
    uint64_t updates;                 /* frames recorded since there was nothing */
    bool paused;                      /* GI has been switched off since, and volumes are kept */
};

/* What a frame in flight brings back. */
enum feedback_content { FEEDBACK_NOTHING, FEEDBACK_TIMES, FEEDBACK_TIMES_AND_COUNTERS };

struct feedback_slot {
    enum feedback_content content;
    uint32_t number;                            /* of the frame */
    uint64_t ended_cycle;                       /* the sample cycle that ended in it; 0: none */
    uint64_t ended_gathers[SDFGI_MAX_CASCADES]; /* the gather cycle of a cascade that ended in it; 0: none */
};

struct feedback_time {
    uint64_t ns;
    bool is_new; /* arrived with the last update */
};

/* What came back from the GPU, frames_in_flight frames late. */
struct feedback {
    struct feedback_slot slots[SDFGI_MAX_FRAMES_IN_FLIGHT];
    uint32_t counters[SDFGI_COUNTER_COUNT]; /* of the newest finished frame */
    struct feedback_time times[PASS_COUNT];
    uint64_t light_cells_refused; /* light cells for which there was no room; 0: there always was */
    bool emitters_refused;        /* there was no memory for emission */
    bool low_light_refused;       /* nor for where light comes from */
    uint64_t instances_refused; /* revision of the scene with instances for which there was no memory, or 0 */
};

/* Buffers that have been made and that no frame has filled. */
struct volume_gaps {
    bool lists;    /* the light lists are empty */
    bool emitters; /* the emitter lists hold anything */
    bool seen;     /* so do the marks on light cells */
};

/* What the last frame began with, in case it never runs. */
struct volume_undo {
    bool valid;
    struct volume_state state;
    struct journal journal;
    struct volume_gaps gaps;
};

struct volume {
    struct backend *backend;
    struct resources *resources; /* NULL while GI is off */
    struct journal journal;      /* of the scene */
    struct volume_state state;
    struct volume_gaps gaps;
    struct volume_undo undo;
    struct feedback feedback;
};

/* A volume of a scene, without resources. */
void sdfgi_volume_init(struct volume *volume, struct backend *backend, struct scene *scene);
void sdfgi_volume_finish(struct volume *volume);
/* Replaces the resources (NULL: none) and forgets all light and cascades. */
void sdfgi_volume_reset(struct volume *volume, struct resources *resources,
                        const struct sdfgi_settings *settings);
/* Forgets all light and cascades, and keeps the resources. */
void sdfgi_volume_forget(struct volume *volume, const struct sdfgi_settings *settings);
/* GI is switched off, and goes on from here with its next frame. */
void sdfgi_volume_pause(struct volume *volume);
/* Undoes the last frame. What changed in the scene since then is kept. */
void sdfgi_volume_cancel(struct volume *volume);
/* Settings changed: light goes on until it has converged again, also if the last frame is undone. */
void sdfgi_volume_invalidate(struct volume *volume);

/* Applies what changed in the scene since the last frame to a state: boxes become edits, light is
 * invalidated. */
void sdfgi_volume_apply_journal(const struct journal *journal, struct volume_state *state);
/* Notes what changes of cascades that are under way bring in. What they take out stays until all are
 * complete. What no cascade touches does not count, so that it costs nothing. */
void sdfgi_volume_note_content(const struct scene *scene, struct volume_state *state);
/* True if the light has converged and nothing has changed since. */
bool sdfgi_volume_has_converged(const struct volume *volume);
/* And nothing that lookups show moves any more. */
bool sdfgi_volume_has_settled(const struct volume *volume);

/* Takes in what the frame that last used the slot left there, if it has run. */
VkResult sdfgi_volume_read_back(struct volume *volume, uint32_t slot, bool *has_run);
/* Makes the light lists longer where the newest counters say that they were too short. */
void sdfgi_volume_make_room(struct volume *volume);
/* Makes room for emission and for emitters as soon as something emits. Where there is no memory, it is asked
 * for again once nothing has emitted meanwhile. */
void sdfgi_volume_add_emitters(struct volume *volume, bool scene_emits);
/* Sees to it that light cells can keep from where they get their light, if that is wanted. False if they
 * cannot, or need not. Where there is no memory, it is asked for again once it was not wanted meanwhile. */
bool sdfgi_volume_add_low_light(struct volume *volume, bool wanted);
/* Makes room for all instances of the scene. */
void sdfgi_volume_add_instances(struct volume *volume, const struct scene *scene);
/* The lists as far as counters know them. */
struct light_lists sdfgi_volume_light_lists(const struct volume *volume);

/* Frame parameters of a state. */
struct params_input {
    const struct sdfgi_settings *settings;
    const struct scene *scene;
    const struct extent *extent;
    uint32_t low_light_begin;
};
void sdfgi_params_fill(struct sdfgi_frame_params *params, const struct volume_state *state,
                       const struct params_input *input);
struct sdfgi_light_params sdfgi_params_of_light(const struct volume_state *state, uint32_t slot,
                                                const struct sdfgi_light_desc *light);
struct sdfgi_instance_params sdfgi_params_of_instance(const struct cascades *cascades,
                                                      const struct scene *scene,
                                                      const struct instance *instance);
/* A cascade's low corner along an axis, counted as the place of an instance. */
int64_t sdfgi_params_corner(const struct cascades *cascades, uint32_t cascade, int axis);
struct sdfgi_material_params sdfgi_params_of_material(const struct scene *scene,
                                                      const struct sdfgi_material_desc *material);

#endif
