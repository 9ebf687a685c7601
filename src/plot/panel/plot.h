/* SPDX-License-Identifier: Apache-2.0 */
/* plot.h -- pictures of a measured panel, as display engineers draw them.
 *
 * Output   SVG or PNG from the same drawing; the same bytes for the same input and library.
 * Memory   the arena's; the picture appears under its name only when it is whole.
 * Threads  one call at a time per arena; `threads` of the options sample the panel.
 * Fails    with the file and what cannot be drawn or written.
 */
#pragma once
#include <jansson.h>

#include "plot/panel/panel_chart.h"

typedef struct PlotOptions {
    PlotKind kind;
    int width, height; /* of the picture, pixels (SVG: its units); 0: chosen */
    bool is_dark;
    double incidence_phi;   /* azimuth of the light, radians; PI: from the left */
    int threads;            /* at least 1 */
    PlotContours contours;  /* of luminance and contrast; none: chosen */
    PlotAmbient ambient;    /* contrast also under these */
    bool wants_reflectance; /* of PlotSource */
} PlotOptions;

typedef struct PlotInput {
    const Panel *panel;
    const char *file;            /* the panel's, as the user named it */
    const Measurement *measured; /* NULL: none */
    const char *reading;         /* how the panel is read, for headings; NULL: as it is */
} PlotInput;

/* By the ending of path: .svg or .png. *charts: how many it shows. */
bool plot_write(const PlotInput *input, const PlotOptions *options, const char *path, Arena *arena,
                int *charts, Error *err);

/* Evaluates the panel for what options->kind shows; *report is the caller's to release. NULL:
 * *err has the reason. */
PlotData *plot_query(const PlotInput *input, const PlotOptions *options, Arena *arena,
                     json_t **report, Error *err);

/* Every chart that this panel's data allow, in the order of the page. */
PanelChartList *plot_charts(const PlotData *data, PlotKind kind, Arena *arena);
