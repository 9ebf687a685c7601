/* SPDX-License-Identifier: Apache-2.0 */
/* report_figures.h -- the charts of a panel under their headings, each with the values that a
 * reader sees at the pointer.
 *
 * Memory   the arena's. Threads: one at a time per arena. Fails: with cairo's reason.
 */
#pragma once
#include <jansson.h>

#include "plot/panel/panel_chart.h"

/* Sets "chapters" of the page's values. */
bool report_figures(json_t *values, const PanelChartList *list, bool is_dark, Arena *arena,
                    Error *err);
