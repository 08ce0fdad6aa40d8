/* SPDX-License-Identifier: MIT
 * Pipelines and memory made ahead, by a thread or at a time of the host's choosing, so that the switch stalls
 * no frame. Conventions as in sdfgi.h, which includes this. */
#ifndef SDFGI_PREPARE_H
#define SDFGI_PREPARE_H

#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

struct sdfgi_progress; /* sdfgi/report.h */

/* What to make besides that which every frame needs. */
enum sdfgi_prepare_part {
    SDFGI_PREPARE_TEXTURES = 1,    /* the pipeline for materials with textures */
    SDFGI_PREPARE_EMISSION = 2,    /* the memory for scenes in which something emits: not in the estimate */
    SDFGI_PREPARE_GATHER = 4,      /* pipelines of sdfgi_gather and of sdfgi_view_resolve */
    SDFGI_PREPARE_REFLECTIONS = 8, /* those of reflections, and the memory of sdfgi_rough_lobes, which is not
                                      in the estimate. For their pictures see sdfgi_view_desc */
    SDFGI_PREPARE_DEBUG = 16,      /* that of sdfgi_debug_draw */
};

struct sdfgi_prepare_desc {
    const struct sdfgi_settings
        *settings;             /* to be switched to; `enabled` means nothing here. NULL: defaults */
    uint32_t parts;            /* of enum sdfgi_prepare_part; 0: all but SDFGI_PREPARE_DEBUG */
    uint32_t max_objects;      /* that this call makes; 0: no limit */
    uint32_t max_microseconds; /* after so long this call begins no further object; 0: no limit */
};

/* Makes pipelines and memory for a later switch to `settings`, one object after another, until all are there
 * or the budget of this call is used up; it makes one at least. Writes to `progress` (may be NULL) how far it
 * is: all is there once `made` equals `total`. Call it again with the same description for more.
 *
 * Once all is there, sdfgi_set_settings with these settings and `enabled` set makes no pipeline, allocates no
 * device memory and cannot fail for want of either; nor does sdfgi_update after it, unless surfaces outgrow
 * the list of light cells, or the scene by then the room for instances. That holds for the switch from off to
 * on, and for settings marked "re-create" while GI is on: the volumes in force go on until then. Both are
 * held meanwhile. Settings are as prepared if they agree in all that is marked "re-create".
 *
 * There is room for the instances that the scene has now, and for 1024 at least. If more have been created
 * since, another call makes room for them. Volumes that are on, or kept, get it from the next sdfgi_update
 * while GI is on.
 *
 * Updates with what has been prepared keep to sdfgi_max_scroll_cells_per_frame even where nothing is shown
 * yet, at the start and after a teleport: with the defaults a cascade a frame, the coarsest first. Without,
 * such an update makes all cascades.
 *
 * What has been prepared is kept: from then on switching off keeps the volumes as they are, light included,
 * and switching on goes on from there, with what changed meanwhile. Lookups are black until the next
 * sdfgi_update. sdfgi_release_prepared ends that. To prepare other settings releases volumes
 * that were prepared or kept for those before, at the next sdfgi_update at the latest, and not while they are
 * on.
 *
 * A call that fails takes back what was made of the volumes, and the next one begins them anew. Pipelines
 * stay. SDFGI_ERROR_OUT_OF_MEMORY, SDFGI_ERROR_INVALID_ARGUMENT as for sdfgi_set_settings.
 *
 * Thread-safety: one thread at a time may be in sdfgi_prepare, while one other thread uses the context as
 * usual; only sdfgi_create, sdfgi_destroy and sdfgi_release_prepared must not run at the same time. The
 * callbacks of the context (log, host and device memory, VkAllocationCallbacks) are then called by both
 * threads. So is the pipeline cache of struct sdfgi_desc used, which must not be externally synchronised. No
 * lock is held while Vulkan or a callback is called: neither thread waits for the other. */
SDFGI_API enum sdfgi_result sdfgi_prepare(sdfgi *gi, const struct sdfgi_prepare_desc *desc,
                                          struct sdfgi_progress *progress);

/* Releases what sdfgi_prepare has made and is not in force, pipelines excepted, and volumes that were kept
 * when GI was switched off, as soon as the frames in flight are over. From then on switching off releases
 * memory. */
SDFGI_API void sdfgi_release_prepared(sdfgi *gi);

#ifdef __cplusplus
}
#endif
#endif
