/* SPDX-License-Identifier: MIT
 * The report: what the last update did and why, what it took, what is held, and what is wrong. Conventions as
 * in sdfgi.h, which includes this. */
#ifndef SDFGI_REPORT_H
#define SDFGI_REPORT_H

#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SDFGI_MAX_PASSES = 48 };

struct sdfgi_pass_report {
    const char *name;    /* static; shader, label and timer have the same */
    bool ran;            /* in the last recorded frame */
    const char *reason;  /* static: the condition of the scene that called for it, or why it was skipped */
    uint32_t dispatches; /* recorded in the last frame */
    uint64_t work;       /* units of the pass's domain processed (cells, probes, rays, ...) in the last frame
                            known; for passes with indirect size this is read back, frames_in_flight late */
    const char *work_unit; /* static */
    uint64_t gpu_ns;   /* of the last frame read back in which it ran; 0: not known. Passes that run side by
                          side have one time, that of the first of them */
    bool gpu_ns_valid; /* a new timing arrived with the last update */
};

struct sdfgi_health {
    enum sdfgi_message code;
    uint64_t count;
    const char *hint; /* static */
};

/* How cascades keep up with the camera and with geometry that changes. Cells count once when they are
 * voxelised and once when they are given a distance. */
struct sdfgi_scroll_report {
    uint64_t steps_begun;       /* times that a cascade moved, since it was switched on */
    uint64_t cells;             /* done in the last sdfgi_update */
    uint64_t budget_cells;      /* sdfgi_max_scroll_cells_per_frame */
    uint64_t pending_cells;     /* begun and not done yet */
    uint32_t cascades_changing; /* cascades that still have pending cells or wait to be completed */
    uint32_t cascades_waiting;  /* too slow for the camera within the budget: coarser ones answer */
};

/* How far sdfgi_prepare has come, in pipelines and memory objects. */
struct sdfgi_progress {
    uint32_t made, total; /* total 0: nothing has been asked for */
};

struct sdfgi_report {
    uint64_t update_count; /* frames recorded so far while enabled */
    bool active;
    bool converged;           /* nothing more will change unless the scene does; no GI work is recorded */
    float converged_fraction; /* [0, 1]: estimated share of the way */
    uint32_t pass_count;
    struct sdfgi_pass_report passes[SDFGI_MAX_PASSES];
    uint32_t command_count;     /* Vulkan commands the library recorded in the last sdfgi_update */
    struct sdfgi_memory memory; /* device bytes held now */
    uint32_t health_count;
    struct sdfgi_health health[SDFGI_MESSAGE_COUNT];
    struct sdfgi_scroll_report scroll;
    struct sdfgi_progress prepared; /* by the last sdfgi_prepare, which may be running */
};

/* State after the last sdfgi_update. GPU figures are those of the newest frame known to be finished. */
SDFGI_API void sdfgi_get_report(const sdfgi *gi, struct sdfgi_report *report);

#ifdef __cplusplus
}
#endif
#endif
