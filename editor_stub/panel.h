/* SPDX-License-Identifier: MIT
 * The parts of the panel: each lays out its widgets in the window that is open. */
#ifndef EDITOR_PANEL_H
#define EDITOR_PANEL_H

#include "editor.h"

#include <imgui.h>

#include <map>
#include <string>
#include <vector>

enum { PANEL_FRAMES = 160, PANEL_PROPERTIES_MAX = 64 };

/* Milliseconds of the last frames; the oldest is the one that is replaced next. */
struct panel_times {
    float ms[PANEL_FRAMES];
};

/* A number that the user drags, and that is not applied yet. */
struct panel_edit {
    bool active;
    double value;
};

struct panel_place {
    std::string name;
    ImVec2 middle;
};

struct panel {
    panel_times passes[SDFGI_MAX_PASSES], all;
    int next; /* in all times */
    panel_edit edits[PANEL_PROPERTIES_MAX];
    std::string error; /* of the last value that a property refused */
    std::vector<panel_place> places;
    std::map<std::string, std::string> before; /* by property: its value before its effect was switched off */
};

/* Notes where the last widget is: kind:name. */
void panel_place_add(panel &panel, const char *kind, const char *name);

/* Gives a property a value; why it was refused is kept in the panel. */
void panel_set(panel &panel, editor_frame &frame, const char *property, const char *value);

/* Text in the style of printf, broken into lines where the window ends: grey, and the colour of a warning. */
void panel_small_print(const char *format, ...) IM_FMTARGS(1);
void panel_warning(const char *format, ...) IM_FMTARGS(1);

/* Takes over the times of a report; in every frame, whether the panel is open or not. */
void panel_times_add(panel &panel, const sdfgi_report &report);

typedef void panel_part(panel &panel, editor_frame &frame);
panel_part panel_effects, panel_views, panel_properties, panel_passes, panel_health, panel_memory;

#endif
