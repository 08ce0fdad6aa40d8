/* SPDX-License-Identifier: MIT
 * The table of settings. Defaults, parsing, validation, `--set`, the documentation and the inspector all come
 * from its rows. Names and ranges are those of Godot's Environment.sdfgi_*; defaults are the physically right
 * ones, so feedback and energy are 1 and Y is not squeezed. */
#include "core/extent.h"

#include <base/text.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct row {
    struct sdfgi_property_info info;
    size_t offset;               /* in struct sdfgi_settings; not used when derived */
    enum settings_change change; /* what another value does */
    /* Derived properties: metres per metre of min_cell_size. */
    double (*factor)(const struct sdfgi_settings *settings);
};

/* Enums are read and written as int. */
_Static_assert(sizeof(enum sdfgi_y_scale) == sizeof(int), "enum size");
_Static_assert(sizeof(enum sdfgi_visibility) == sizeof(int), "enum size");
_Static_assert(sizeof(enum sdfgi_surface_light) == sizeof(int), "enum size");
_Static_assert(sizeof(enum sdfgi_sdf_method) == sizeof(int), "enum size");
_Static_assert(sizeof(enum sdfgi_voxelizer) == sizeof(int), "enum size");

static double cascade0_factor(const struct sdfgi_settings *settings)
{
    return settings->resolution / 2.0;
}

static double max_distance_factor(const struct sdfgi_settings *settings)
{
    return ldexp(cascade0_factor(settings), (int)settings->cascades);
}

/* clang-format off */
/* Rows: member or factor, name, type, default, minimum, maximum, unit, choices, what more of it buys, what it
 * costs, description. LIVE takes effect at once, LOOKUPS too and wakes no light, RECREATE rebuilds
 * everything, DERIVED sets min_cell_size. */
#define INFO(name_, type_, default_, min_, max_, unit_, choices_, buys_, costs_, text_, again_, derived_) \
    .info = { .name = name_, .type = SDFGI_PROPERTY_##type_, .default_value = default_, .minimum = min_,    \
              .maximum = max_, .unit = unit_, .choices = choices_, .buys = buys_, .costs = costs_,           \
              .recreates = again_, .derived = derived_, .description = text_ }
#define MEMBER(member)      .offset = offsetof(struct sdfgi_settings, member)
#define LIVE(member, ...)     { INFO(__VA_ARGS__, false, false), MEMBER(member), .change = SETTINGS_LIGHT }
#define LOOKUPS(member, ...)  { INFO(__VA_ARGS__, false, false), MEMBER(member), .change = SETTINGS_LOOKUPS }
#define RECREATE(member, ...) { INFO(__VA_ARGS__, true, false), MEMBER(member), .change = SETTINGS_ALL }
#define DERIVED(factor_, ...) { INFO(__VA_ARGS__, true, true), .factor = factor_ }

static const struct row rows[] = {
    LIVE(enabled, "sdfgi_enabled", BOOL, 0, 0, 1, "", "",
        "indirect light", "memory and GPU time; off costs neither",
        "The one switch. Off, the library records no command and holds no device memory."),
    RECREATE(use_occlusion, "sdfgi_use_occlusion", BOOL, 1, 0, 1, "", "",
        "no light through walls",
        "a visibility test per light cell and probe when geometry changes, and its data",
        "Weighs the probes around a light cell by what they can see of it. Off, light leaks through walls "
        "thinner than the distance between probes."),
    LIVE(read_sky_light, "sdfgi_read_sky_light", BOOL, 1, 0, 1, "", "",
        "light from the sky", "one evaluation of the sky for each ray that leaves the cascades",
        "Rays that leave the last cascade return the radiance of the sky; off, they return black."),
    LIVE(bounce_feedback, "sdfgi_bounce_feedback", FLOAT, 1, 0, 1.99, "", "",
        "light of the second and later bounces", "more frames to converge in bright rooms",
        "Factor on the light that probes hand back to surfaces. 1 is physical, 0 keeps the first bounce "
        "alone. Albedo times feedback is limited so that light cannot grow without bound; the report says "
        "when that happens."),
    RECREATE(cascades, "sdfgi_cascades", INT, 4, 1, 8, "", "",
        "range: each further cascade doubles it", "memory and time in proportion",
        "Number of nested volumes around the camera, each with cells twice as large as the one inside it."),
    RECREATE(min_cell_size_m, "sdfgi_min_cell_size", FLOAT, 0.2, 0.01, 64, "m", "",
        "range; smaller cells buy detail", "detail: surfaces closer together than a cell share their light",
        "Edge of a cell in the finest cascade. Walls are resolved to a quarter of it."),
    DERIVED(cascade0_factor, "sdfgi_cascade0_distance", FLOAT, 12.8, 0.16, 8192, "m", "",
        "range of the finest cascade", "detail, as sdfgi_min_cell_size",
        "Half the edge of the finest cascade: sdfgi_min_cell_size times half of sdfgi_resolution. Setting "
        "it changes sdfgi_min_cell_size."),
    DERIVED(max_distance_factor, "sdfgi_max_distance", FLOAT, 204.8, 0.32, 2097152, "m", "",
        "range of all cascades", "detail, as sdfgi_min_cell_size",
        "The edge of the coarsest cascade: sdfgi_cascade0_distance times 2 to the power of sdfgi_cascades. "
        "Setting it changes sdfgi_min_cell_size."),
    RECREATE(y_scale, "sdfgi_y_scale", ENUM, SDFGI_Y_SCALE_100, 0, 2, "", "50%,75%,100%",
        "range upwards and downwards", "vertical detail below 100 %, which buys it for flat worlds",
        "Height of a cell over its width. Distances and light are computed in true metres whatever the "
        "scale."),
    LIVE(energy, "sdfgi_energy", FLOAT, 1, 0, 100, "", "",
        "brighter indirect light", "physical correctness away from 1",
        "Factor on what lookups return. It does not enter the bounces."),
    LIVE(normal_bias_cells, "sdfgi_normal_bias", FLOAT, 1, 0, 4, "cells", "",
        "fewer dark specks where a surface hides from its own cells", "light leaks and contact detail",
        "How far a lookup moves along the surface normal before it reads light cells."),
    LIVE(probe_bias_cells, "sdfgi_probe_bias", FLOAT, 1, 0, 4, "cells", "",
        "no self-shadowing where sdfgi_visibility is probe_depth", "light leaks through thin walls there",
        "How much further than a probe's mean depth a point may be without counting as hidden. Only "
        "probe_depth reads it."),
    RECREATE(ray_count, "sdfgi_ray_count", INT, 25, 1, 128, "rays per probe and frame", "",
        "less noise, and light that follows changes sooner", "tracing time in proportion",
        "Rays that each probe sends in a frame while it has not converged."),
    RECREATE(frames_to_converge, "sdfgi_frames_to_converge", INT, 20, 1, 64, "frames", "",
        "accuracy: more directions per probe", "frames until light has settled, and memory for the ray cache",
        "Length of the sample cycle: light is averaged over it. A static scene repeats after one cycle per "
        "bounce, and then stops costing anything."),
    LIVE(frames_to_update_lights, "sdfgi_frames_to_update_lights", INT, 1, 1, 16, "frames", "",
        "less time per frame", "frames until bounced light is seen",
        "Probes show what they have gathered, and hand it to surfaces, once in so many frames. Direct "
        "light is made in the frame in which a light changes."),
    LIVE(max_scroll_cells, "sdfgi_max_scroll_cells_per_frame", INT, 4194304, 524288, 134217728, "cells", "",
        "fine cascades that keep up with faster cameras, and changed geometry that is seen sooner",
        "time of the frames in which cascades step or geometry changes, in proportion",
        "At most so many cells are voxelised or given distances in a frame, once there is anything to "
        "show, or from the start after sdfgi_prepare. A step of a cascade of 128 cells takes 2,228,224. "
        "Where the camera is faster, fine cascades wait and coarser ones answer."),
    RECREATE(resolution, "sdfgi_resolution", INT, 128, 32, 256, "cells", "32,64,128,256",
        "range at the same cell size, or detail at the same range", "memory and time with the third power",
        "Cells along a side of each cascade, a power of two."),
    RECREATE(visibility, "sdfgi_visibility", ENUM, SDFGI_VISIBILITY_CELL_MASK, 0, 1, "",
        "cell_mask,probe_depth",
        "nothing: they differ in kind",
        "probe_depth needs 16x16 depths per probe and leaks more behind thin walls",
        "How a light cell learns which probes it sees: cell_mask traces a ray to each of its eight probes "
        "once; probe_depth compares with mean depths around each probe."),
    RECREATE(surface_light, "sdfgi_surface_light", ENUM, SDFGI_SURFACE_LIGHT_CELLS, 0, 1, "", "probes,cells",
        "accuracy on surfaces: contact shadows, and light that changes within the distance between probes",
        "cells: sdfgi_cell_rays_per_frame rays in each frame until light has converged, and 128 bytes per "
        "light cell",
        "What lights surfaces. cells: each light cell gathers light with rays of its own. probes: light "
        "cells read the probes around them, and send no rays."),
    RECREATE(cell_rays, "sdfgi_cell_rays", INT, 512, 16, 2048, "rays per surface", "",
        "less noise between neighbouring light cells", "frames until light has settled, in proportion",
        "Rays that a light cell sends for each of its surfaces in a gather cycle. Every cycle repeats the "
        "same directions. A cell that sdfgi_gather shows goes on to four times as many, at most 2048."),
    LIVE(cell_rays_per_frame, "sdfgi_cell_rays_per_frame", INT, 131072, 1024, 16777216, "rays", "",
        "light on surfaces that follows changes sooner", "tracing time in proportion",
        "Rays that light cells send in a frame, until light has converged. Near cascades get most of them. "
        "Where sdfgi_gather is used, most go to what pictures show and to what lights it. In the first 20 "
        "frames, and after a teleport, new cells send four times as many: smooth walls on arrival. So do "
        "cells that a change of lights wakes after 120 frames without one."),
    LOOKUPS(reflection_blend, "sdfgi_reflection_blend", FLOAT, 0.5, 0, 1, "roughness", "",
        "rays for rougher surfaces: reflections that follow what is near", "a little noise on these",
        "Surfaces up to this roughness reflect what rays meet. From here to sdfgi_reflection_end irradiance "
        "takes over. At or above that there is no blend: rays stop at once."),
    LOOKUPS(reflection_end, "sdfgi_reflection_end", FLOAT, 0.75, 0, 1, "roughness", "",
        "rays for rougher surfaces: reflections that follow what is near",
        "rays for pixels that are smoother, and noise on the roughest",
        "Surfaces of this roughness and above send no rays: they reflect their irradiance. 0 switches rays "
        "off, and views make no reflections then."),
    LIVE(rough_lobes, "sdfgi_rough_lobes", BOOL, 1, 0, 1, "", "",
        "sheen on rough floors and walls: light at small angles that dielectrics reflect most",
        "a lookup for each square of 4 x 4 pixels, and 24 bytes per light cell, where there are reflections",
        "Rough dielectrics reflect their light by where it comes from. Light cells keep that then, since a "
        "view, or a frame with forward_reflections, has asked for it. Off, rough surfaces reflect their "
        "irradiance."),
    RECREATE(sdf_method, "sdfgi_sdf_method", ENUM, SDFGI_SDF_EXACT, 0, 1, "", "exact,flood",
        "nothing: the two differ in kind",
        "flood oversteps by up to 0.14 cell, and its cost does not fall where a cascade is empty",
        "How distances are made: exact searches the solid bits axis by axis, as far as 16 cells; flood is a "
        "jump flood with a closing pair of passes."),
    RECREATE(voxelizer, "sdfgi_voxelizer", ENUM, SDFGI_VOXELIZER_COMPUTE, 0, 1, "", "compute,raster",
        "nothing: the two differ in kind",
        "raster needs a queue with graphics, and depends on the rasteriser's rules",
        "How triangles become sub-voxels."),
};
/* clang-format on */

enum { ROW_COUNT = sizeof rows / sizeof rows[0], CHOICE_BYTES = 24 };

static const struct row *row_find(const char *name)
{
    for (uint32_t i = 0; i < ROW_COUNT; i++)
        if (strcmp(rows[i].info.name, name) == 0)
            return &rows[i];
    return NULL;
}

/* ---- Values ----------------------------------------------------------------------------------------- */

static double row_get(const struct row *row, const struct sdfgi_settings *settings)
{
    if (row->factor)
        return settings->min_cell_size_m * row->factor(settings);
    const unsigned char *field = (const unsigned char *)settings + row->offset;
    switch (row->info.type) {
    case SDFGI_PROPERTY_BOOL:
        return *(const bool *)field;
    case SDFGI_PROPERTY_INT:
        return *(const uint32_t *)(const void *)field;
    case SDFGI_PROPERTY_FLOAT:
        return *(const float *)(const void *)field;
    case SDFGI_PROPERTY_ENUM:
        break;
    }
    return *(const int *)(const void *)field;
}

static void row_set(const struct row *row, struct sdfgi_settings *settings, double value)
{
    if (row->factor) {
        settings->min_cell_size_m = (float)(value / row->factor(settings));
        return;
    }
    unsigned char *field = (unsigned char *)settings + row->offset;
    switch (row->info.type) {
    case SDFGI_PROPERTY_BOOL:
        *(bool *)field = value != 0;
        break;
    case SDFGI_PROPERTY_INT:
        *(uint32_t *)(void *)field = (uint32_t)value;
        break;
    case SDFGI_PROPERTY_FLOAT:
        *(float *)(void *)field = (float)value;
        break;
    case SDFGI_PROPERTY_ENUM:
        *(int *)(void *)field = (int)value;
        break;
    }
}

/* Copies the choice `index` into `text`; false past the last one. */
static bool choice_name(const char *choices, int index, char text[CHOICE_BYTES])
{
    for (; index > 0 && choices; index--) {
        choices = strchr(choices, ',');
        choices = choices ? choices + 1 : NULL;
    }
    if (!choices || index < 0)
        return false;
    snprintf(text, CHOICE_BYTES, "%.*s", (int)strcspn(choices, ","), choices);
    return true;
}

static bool choice_parse(const char *choices, const char *text, double *value)
{
    char name[CHOICE_BYTES];
    for (int i = 0; choice_name(choices, i, name); i++)
        if (strcmp(name, text) == 0) {
            *value = i;
            return true;
        }
    return false;
}

static bool bool_parse(const char *text, double *value)
{
    *value = strcmp(text, "true") == 0 || strcmp(text, "on") == 0;
    return *value != 0 || strcmp(text, "false") == 0 || strcmp(text, "off") == 0;
}

/* Limits are compared as floats: 0.01f lies below 0.01. Integers of the table are exact either way. */
static bool row_accepts(const struct row *row, double value)
{
    const struct sdfgi_property_info *info = &row->info;
    if (!(isfinite(value) && (float)value >= (float)info->minimum && (float)value <= (float)info->maximum))
        return false;
    if (info->type != SDFGI_PROPERTY_INT)
        return true;
    char text[CHOICE_BYTES];
    double index;
    snprintf(text, sizeof text, "%.9g", value);
    return value == floor(value) && (info->choices[0] == '\0' || choice_parse(info->choices, text, &index));
}

static bool row_parse(const struct row *row, const char *text, double *value)
{
    switch (row->info.type) {
    case SDFGI_PROPERTY_BOOL:
        return bool_parse(text, value);
    case SDFGI_PROPERTY_ENUM:
        return choice_parse(row->info.choices, text, value);
    case SDFGI_PROPERTY_INT:
    case SDFGI_PROPERTY_FLOAT:
        break;
    }
    return base_text_to_double(text, value);
}

/* ---- Messages --------------------------------------------------------------------------------------- */

static bool refuse(const struct row *row, const char *value, char *error, size_t error_size)
{
    const struct sdfgi_property_info *info = &row->info;
    if (info->type == SDFGI_PROPERTY_BOOL)
        return base_text_error(error, error_size, "%s is \"%s\", expected true or false", info->name, value);
    if (info->choices[0] != '\0')
        return base_text_error(error, error_size, "%s is \"%s\", expected one of %s", info->name, value,
                               info->choices);
    return base_text_error(error, error_size, "%s is \"%s\", expected a %snumber from %g to %.9g%s%s",
                           info->name, value, info->type == SDFGI_PROPERTY_INT ? "whole " : "", info->minimum,
                           info->maximum, info->unit[0] ? " " : "", info->unit);
}

static bool refuse_derived(const struct row *row, const char *value, double cell_size_m, char *error,
                           size_t error_size)
{
    return base_text_error(
        error, error_size,
        "%s is \"%s\", which needs cells of %g m, expected sdfgi_min_cell_size from %g to %g m",
        row->info.name, value, cell_size_m, row_find("sdfgi_min_cell_size")->info.minimum,
        row_find("sdfgi_min_cell_size")->info.maximum);
}

/* The shortest decimal number that reads back as the same float. */
static void format_float(double value, char *text, size_t text_size)
{
    const float wanted = (float)value;
    for (int digits = 6; digits <= 9; digits++) {
        char trial[32];
        double back;
        snprintf(trial, sizeof trial, "%.*g", digits, (double)wanted);
        snprintf(text, text_size, "%s", trial);
        if (base_text_to_double(trial, &back) && (float)back == wanted)
            return;
    }
}

static void row_format(const struct row *row, double value, char *text, size_t text_size)
{
    char choice[CHOICE_BYTES];
    if (row->info.type == SDFGI_PROPERTY_BOOL)
        snprintf(text, text_size, "%s", value != 0 ? "true" : "false");
    else if (row->info.type == SDFGI_PROPERTY_ENUM && choice_name(row->info.choices, (int)value, choice))
        snprintf(text, text_size, "%s", choice);
    else if (row->info.type == SDFGI_PROPERTY_INT)
        snprintf(text, text_size, "%.0f", value);
    else
        format_float(value, text, text_size);
}

/* ---- Public ----------------------------------------------------------------------------------------- */

void sdfgi_settings_default(struct sdfgi_settings *settings)
{
    memset(settings, 0, sizeof *settings);
    for (uint32_t i = 0; i < ROW_COUNT; i++)
        if (!rows[i].info.derived)
            row_set(&rows[i], settings, rows[i].info.default_value);
}

const struct sdfgi_property_info *sdfgi_property_get_info(uint32_t index)
{
    return index < ROW_COUNT ? &rows[index].info : NULL;
}

bool sdfgi_settings_set(struct sdfgi_settings *settings, const char *name, const char *value, char *error,
                        size_t error_size)
{
    const struct row *row = row_find(name);
    if (!row)
        return base_text_error(error, error_size, "there is no property \"%s\", see `sdfgi properties`",
                               name);
    double number;
    if (!row_parse(row, value, &number) || !row_accepts(row, number))
        return refuse(row, value, error, error_size);
    struct sdfgi_settings changed = *settings;
    row_set(row, &changed, number);
    if (row->factor && !row_accepts(row_find("sdfgi_min_cell_size"), changed.min_cell_size_m))
        return refuse_derived(row, value, changed.min_cell_size_m, error, error_size);
    *settings = changed;
    return true;
}

double sdfgi_settings_get(const struct sdfgi_settings *settings, const char *name)
{
    const struct row *row = row_find(name);
    return row ? row_get(row, settings) : (double)NAN;
}

bool sdfgi_settings_format(const struct sdfgi_settings *settings, const char *name, char *text,
                           size_t text_size)
{
    const struct row *row = row_find(name);
    if (!row)
        return false;
    row_format(row, row_get(row, settings), text, text_size);
    return true;
}

bool sdfgi_settings_validate(const struct sdfgi_settings *settings, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < ROW_COUNT; i++) {
        const double value = row_get(&rows[i], settings);
        if (rows[i].info.derived || row_accepts(&rows[i], value))
            continue;
        char text[32];
        row_format(&rows[i], value, text, sizeof text);
        return refuse(&rows[i], text, error, error_size);
    }
    return true;
}

static bool row_differs(const struct row *row, const struct sdfgi_settings *a, const struct sdfgi_settings *b)
{
    return !row->info.derived && row_get(row, a) != row_get(row, b);
}

enum settings_change sdfgi_settings_change(const struct sdfgi_settings *a, const struct sdfgi_settings *b)
{
    enum settings_change change = SETTINGS_SAME;
    for (uint32_t i = 0; i < ROW_COUNT; i++)
        if (row_differs(&rows[i], a, b) && rows[i].change > change)
            change = rows[i].change;
    return change;
}
