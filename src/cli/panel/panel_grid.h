/* SPDX-License-Identifier: Apache-2.0 */
/* panel_grid.h -- a panel's values on a grid of directions: what `panel eval --grid` prints.
 *
 * Units    as panel_question.h.
 * Fails    naming the option, what was found and what was wanted; a stdout that is full.
 */
#pragma once
#include "base/arena.h"
#include "cli/panel/panel_question.h"

typedef enum PanelGridFormat {
    PANEL_GRID_LIST,   /* a row a direction: a table that `panel fit` reads */
    PANEL_GRID_MATRIX, /* theta down, phi across, one quantity */
    PANEL_GRID_JSON
} PanelGridFormat;

/* first, first + step, ... up to last (degrees). */
typedef struct PanelRange {
    double first, last, step;
} PanelRange;

typedef struct PanelGrid {
    PanelRange theta, phi;
} PanelGrid;

/* "THETA0:THETA1:STEP,PHI0:PHI1:STEP"; theta within 0..90, phi within -360..360. */
bool panel_grid_parse(const char *text, PanelGrid *out, Error *err);

/* The quantities of a matrix: the names of --quantity. */
#define PANEL_QUANTITIES "X|Y|Z|u|v|brdf"

/* question: everything but theta and phi. quantity: index of PANEL_QUANTITIES. */
bool panel_grid_print(const Panel *panel, const PanelQuestion *question, const PanelGrid *grid,
                      PanelGridFormat format, int quantity, Error *err);
