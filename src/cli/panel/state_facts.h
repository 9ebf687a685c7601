/* SPDX-License-Identifier: Apache-2.0 */
/* state_facts.h -- what `panel fit` and `panel info` say of each state of a file, and which of
 * a set's states a panel is of.
 *
 * Threads  one at a time. Fails with the file.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "cli/panel/panel_level.h"
#include "panel/query/panel.h"
#include "panel/query/panel_info.h"
#include "panel/set/measurement.h"
#include "plot/panel/plot_data.h"

/* "states" of the report: of each its name, verdict, reasons, total, tables and display. A file
 * of one state adds nothing. panel: the file's, any of its states; path: as the user named
 * it. */
bool state_facts_add(const Panel *panel, const char *path, json_t *report, Arena *arena,
                     Error *err);

/* The panel's own state, a copy; NULL: its file has one, without a name. */
const char *state_facts_name(const Panel *panel, Arena *arena);

/* A set of several states that the panel was fitted from becomes that of the panel's. */
bool state_facts_take(const Panel *panel, Measurement *measured, Error *err);

/* Opens every state of the panel's file, and reads it as coarse as that one is. */
typedef struct StatePanels {
    PlotState one[PANEL_INFO_STATES_MAX];
    int       count;
} StatePanels;
bool state_facts_open(const Panel *panel, const char *path, const PanelLevel *level,
                      Arena *arena, StatePanels *out, Error *err);
void state_facts_close(StatePanels *states);
