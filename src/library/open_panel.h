/* SPDX-License-Identifier: Apache-2.0 */
/* open_panel.h -- opens a panel for another program, which goes on where memory runs out.
 *
 * Memory   an arena of the panel's own, the caller's to release; none where it fails.
 * Threads  any number. Fails: ERROR_MEMORY where memory is short; else as panel_open.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "library/emission_draw.h"
#include "panel/query/panel.h"

typedef struct PanelSource {
    const char *path; /* NULL: bytes */
    const void *bytes;
    size_t size;
} PanelSource;

typedef struct OpenedPanel {
    Arena arena; /* holds all the others */
    const Panel *panel;
    EmissionDraw draw;
    void *room; /* for the caller, as many bytes as it said, zero */
} OpenedPanel;

bool open_panel(const PanelSource *from, size_t room, OpenedPanel *out, Error *err);
