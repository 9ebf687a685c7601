/* SPDX-License-Identifier: Apache-2.0 */
/* report_figures.h -- the charts of a panel under their headings, each with the values that a
 * reader sees at the pointer.
 *
 * Memory   the arena's. Threads: one at a time per arena. Fails: with cairo's reason.
 */
#pragma once
#include <jansson.h>

#include "plot/panel/panel_chart.h"
#include "table/table.h"

/* Belongs the chart to the report? What was assumed and not measured is for panel plot. */
bool report_has_chart(const PanelChart *chart);

/* What the chart shows, as numbers: a row for each point of its series, for each direction of
 * every 2 degrees of theta and 6 of phi, or for each cell of the display. */
Table *report_chart_table(const PanelChart *chart, Arena *arena);

/* Sets "chapters" of the page's values. */
bool report_figures(json_t *values, const PanelChartList *list, bool is_dark, Arena *arena,
                    Error *err);
