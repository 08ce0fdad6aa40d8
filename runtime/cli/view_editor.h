/* SPDX-License-Identifier: MIT
 * The panel of editor_stub as an overlay of a window. */
#ifndef RUNTIME_VIEW_EDITOR_H
#define RUNTIME_VIEW_EDITOR_H

#include "host/host.h"

struct editor;

struct view_editor {
    struct editor *editor; /* while a window is open */
};

/* An overlay that uses `editor`, which outlives it. */
struct host_overlay view_editor_overlay(struct view_editor *editor);

#endif
