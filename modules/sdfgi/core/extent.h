/* SPDX-License-Identifier: MIT
 * What follows from settings: lengths of sample cycles, and how many elements everything has. Needs no
 * device. */
#ifndef SDFGI_EXTENT_H
#define SDFGI_EXTENT_H

#include <sdfgi/settings.h>

#include <stdbool.h>
#include <stdint.h>

/* Instances for which there is room at first. */
enum { SDFGI_FIRST_INSTANCES = 1024 };

/* Elements of one cascade, and what else the sizes in the resource table depend on. */
struct extent {
    uint64_t cells, blocks, probes, probes_per_side, cascades, cycle_samples, rays_per_frame, scratch, search,
        occlusion;
    uint64_t light_cells,
        light_cells_max; /* room in the light list of a cascade, and how much it may become */
    uint64_t instances;  /* room for so many of the scene */
    bool gathers;        /* light cells gather with rays of their own */
    bool emits;          /* something in the scene emits: there is room for emission and for emitters */
    bool low_light;      /* a view has reflections: there is room for where light comes from */
};

struct extent sdfgi_extent_from_settings(const struct sdfgi_settings *settings);
/* The same with another room in the light lists. */
void sdfgi_extent_set_light_cells(struct extent *extent, uint64_t light_cells);
/* The same for a scene in which something emits. */
void sdfgi_extent_set_emits(struct extent *extent);
/* The same where a view has reflections. */
void sdfgi_extent_set_low_light(struct extent *extent);

/* Samples of a probe in a cycle that go towards emitters. */
uint64_t sdfgi_extent_emitter_samples(const struct extent *extent);
/* Words of a probe in the ray cache, and the most rays that it sends in a frame. */
uint64_t sdfgi_extent_probe_words(const struct extent *extent);
uint64_t sdfgi_extent_probe_rays(const struct extent *extent);
/* Rays that a visit of a light cell sends along an axis. */
uint32_t sdfgi_extent_visit_rays(const struct extent *extent);

/* Height of a cell over its width. */
double sdfgi_settings_y_scale(const struct sdfgi_settings *settings);
/* Samples in the cycle of a probe: all 25 texels get the same number. */
uint32_t sdfgi_settings_cycle_samples(const struct sdfgi_settings *settings);
/* Frames over which a cycle is spread. */
uint32_t sdfgi_settings_cycle_frames(const struct sdfgi_settings *settings);
/* Visits of a light cell in a gather cycle; 0 if light cells read probes alone. */
uint32_t sdfgi_settings_cycle_visits(const struct sdfgi_settings *settings);
/* The method by which light cells weigh probes: SDFGI_SHADER_VISIBILITY_*. */
uint32_t sdfgi_settings_shader_visibility(const struct sdfgi_settings *settings);

/* What becomes of stored light when settings change: the strongest effect of all that differ. */
enum settings_change {
    SETTINGS_SAME,
    SETTINGS_LOOKUPS, /* it stays, and lookups make something else of it */
    SETTINGS_LIGHT,   /* it settles anew */
    SETTINGS_ALL,     /* all is made anew */
};

enum settings_change sdfgi_settings_change(const struct sdfgi_settings *a, const struct sdfgi_settings *b);

uint32_t sdfgi_log2(uint64_t power);

#endif
